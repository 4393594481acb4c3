//! A simulation: assembled from a configuration and particles, advanced in time, looked at.

mod assembly;
mod budget;
mod catalogue;
mod checkpoint;
mod config;
mod diagnostics;
mod engine;
mod gravity;
mod inspect;
mod reaction;
mod sample;
mod solver;
mod timers;

pub use checkpoint::{Entries, Entry};
pub use config::{
    ArtificialViscosityConfig, Config, DensityDiffusionConfig, DiffusionForm, EosName,
    GravityConfig, LaminarViscosityConfig, ShiftingConfig, ShiftingForm, ViscosityForm, WallConfig,
};
pub use diagnostics::Diagnostics;
pub use engine::{BodyInput, BodyState, EffectState, Precision, Samples, Simulation, Status};
pub use sample::Sample;
pub use solver::{Body, Progress, Solver};
pub use timers::{PHASES, Phase, Timers};
