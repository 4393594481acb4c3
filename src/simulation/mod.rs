//! A simulation: assembled from a configuration and particles, advanced in time, looked at.

mod assembly;
mod config;
mod solver;
mod timers;

pub use config::{
    ArtificialViscosityConfig, Config, DensityDiffusionConfig, DiffusionForm, EosName,
    LaminarViscosityConfig, ShiftingConfig, ShiftingForm, WallConfig,
};
pub use solver::{Body, Progress, Solver};
pub use timers::{PHASES, Phase, Timers};
