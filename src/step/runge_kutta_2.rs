//! The Runge–Kutta method of second order.

use super::System;

/// One step of `dt` by the midpoint method (Runge 1895): two evaluations, second order. Sound grows as `(ω Δt)⁴/8` a
/// step, as in all methods of two stages and second order, and has to be held by the scheme's own dissipation.
///
/// # Errors
/// A stage that is not finite.
pub fn runge_kutta_2<S: System>(system: &mut S, dt: f64) -> Result<(), S::Trouble> {
    system.begin()?;
    system.rates(0.0, dt);
    system.stage(0.5 * dt, 0.0)?;
    system.middle(dt);
    system.arrive(dt, dt);
    Ok(())
}
