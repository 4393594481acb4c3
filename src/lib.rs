//! Smoothed particle hydrodynamics.
pub mod eos;
pub mod kernel;
pub mod simd;
