//! A simulation: assembled from a configuration and particles, advanced in time, looked at.

mod assembly;
mod boundary;
mod budget;
mod catalogue;
mod checkpoint;
mod config;
mod crowding;
mod density_rates;
mod diagnosis;
mod diagnostics;
mod engine;
mod facet_walls;
mod foreign;
mod gravity;
mod guard;
mod inspect;
mod multistage;
mod reaction;
mod retry;
mod sample;
mod snapshot;
mod solver;
mod surfaces;
mod timers;
mod transport;
mod wall_values;

pub use checkpoint::{Entries, Entry};
pub use config::{
    ArtificialViscosityConfig, Config, DensityDiffusionConfig, DiffusionForm, EosName,
    GravityConfig, LaminarViscosityConfig, ShiftingConfig, ShiftingForm, ViscosityForm, WallConfig,
};
pub use crowding::Crowding;
pub use diagnostics::Diagnostics;
pub use engine::{BodyInput, BodyState, EffectState, Precision, Samples, Simulation, Status};
pub use retry::{Retries, Trouble};
pub use sample::Sample;
pub use solver::{Body, Progress, Solver};
pub use surfaces::SurfaceInput;
pub use timers::{PHASES, Phase, Timers};
