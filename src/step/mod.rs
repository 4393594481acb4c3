//! The stages of a step.

mod motion;
mod passes;
mod shift;
mod time_step;

pub use motion::{Motion, State};
pub use passes::{DensityRate, Forces, ShiftTerm, WallDensityRate};
pub use shift::apply_shift;
pub use time_step::{Limit, Limits};
