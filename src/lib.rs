//! Smoothed particle hydrodynamics.
pub mod kernel;
pub mod simd;
