//! What a scene prescribes as a function of time: signals, and rigid motions made of them.

mod rigid;
mod signal;
mod spline;

pub use rigid::{MotionConfig, PartConfig, Path, Pose, RigidMotion};
pub use signal::{Interpolation, Signal, SignalConfig};
pub use spline::Spline;
