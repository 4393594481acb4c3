//! The stages of a step.

mod integrator;
mod motion;
mod passes;
mod predictor_corrector;
pub(crate) mod projection;
mod runge_kutta_2;
mod runge_kutta_4;
mod shift;
mod stages;
mod time_step;
mod transport;

pub use integrator::{Integrator, System};
pub use motion::{Motion, State};
pub use passes::{DensityRate, Forces, ShiftTerm, WallDensityRate};
pub use predictor_corrector::predictor_corrector;
pub use runge_kutta_2::runge_kutta_2;
pub use runge_kutta_4::runge_kutta_4;
pub use shift::{apply_shift, apply_shift_of_free_fluid};
pub use stages::Stage;
pub use time_step::{Limit, Limits};
pub use transport::take_along;
