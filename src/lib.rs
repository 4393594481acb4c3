//! Smoothed particle hydrodynamics.
pub mod effects;
pub mod eos;
pub mod error;
pub mod kernel;
pub mod neighbours;
pub mod operators;
pub mod particles;
pub mod simd;
pub mod simulation;
pub mod step;
pub mod sweep;
pub mod walls;

#[cfg(feature = "python")]
mod python;
