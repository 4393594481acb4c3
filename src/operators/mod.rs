//! SPH operators as functions of whole arrays: for analysis, for tests, and for users' own schemes.
//!
//! They take particles in any order, in one, two or three dimensions, and work in double precision on rayon's threads.
//! The time step has its own, fused code; these are the same formulae one at a time.

mod cloud;
mod correction;
mod density_diffusion;
mod derivatives;
mod free_surface;
mod interpolate;
mod particle_shift;

pub use cloud::Cloud;
pub use correction::{Matrix, corrections, smallest_eigenvalue};
pub use density_diffusion::{Diffusion, density_diffusion};
pub use derivatives::{divergence, gradient, laplacian};
pub use free_surface::{FreeSurface, free_surface};
pub use interpolate::interpolate;
pub use particle_shift::{Shift, particle_shift};
