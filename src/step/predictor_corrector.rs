//! Predictor–corrector: the implicit midpoint rule, predicted and corrected twice.

use super::System;

/// One step of `dt`: the middle is predicted with the rates of the last step's, and corrected with its own
/// (Monaghan 1989, whose corrector is the implicit midpoint rule; as P(EC)² in the notation of Lambert 1991). Second
/// order with two evaluations, and sound decays a little, where a single correction would let it grow: that would be
/// the method of Adams and Bashforth.
///
/// # Errors
/// A stage that is not finite.
pub fn predictor_corrector<S: System>(system: &mut S, dt: f64) -> Result<(), S::Trouble> {
    system.begin()?;
    system.stage(0.5 * dt, 0.0)?;
    system.rates(0.5 * dt, dt);
    system.stage(0.5 * dt, 0.0)?;
    system.middle(dt);
    system.arrive(dt, dt);
    Ok(())
}
