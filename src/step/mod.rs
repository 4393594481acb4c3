//! The stages of a step.

mod motion;
mod passes;
mod time_step;

pub use motion::{Motion, State};
pub use passes::{DensityRate, Forces, GradientTerm};
pub use time_step::{Limit, Limits};
