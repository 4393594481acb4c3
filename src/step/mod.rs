//! The stages of a step.

mod motion;
mod passes;
mod shift;
mod time_step;

pub use motion::{Motion, State};
pub use passes::{DensityRate, Forces, ShiftTerm, WallDensityRate};
pub use shift::{apply_shift, apply_shift_of_free_fluid};
pub use time_step::{Limit, Limits};
