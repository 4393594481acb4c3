//! The classical Runge–Kutta method of fourth order.

use super::System;

/// One step of `dt` (Kutta 1901): four evaluations, fourth order. Sound decays as `(ω Δt)⁶/144` a step, up to
/// `ω Δt = 2 √2`.
///
/// # Errors
/// A stage that is not finite.
pub fn runge_kutta_4<S: System>(system: &mut S, dt: f64) -> Result<(), S::Trouble> {
    system.begin()?;
    system.rates(0.0, dt);
    system.stage(0.5 * dt, dt / 6.0)?;
    system.rates(0.5 * dt, dt);
    system.stage(0.5 * dt, dt / 3.0)?;
    system.middle(dt);
    system.stage(dt, dt / 3.0)?;
    system.rates(dt, dt);
    system.arrive(dt / 6.0, dt);
    Ok(())
}
