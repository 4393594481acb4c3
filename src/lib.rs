//! Smoothed particle hydrodynamics: weakly compressible fluids, walls, and the effects that a scene calls for.
//!
//! A [`simulation::Simulation`] owns the particles of all bodies as columns in cell order and advances them by a
//! symplectic step of two pair sweeps: forces, then continuity (`ARCHITECTURE.md` says why). The arithmetic of every
//! effect is written once for [`simd::Lanes`] and compiled for each vector unit; the widest is chosen at run time. The
//! feature `python` adds the extension module behind the Python package; without it the crate needs no Python.
//!
//! A dam break:
//!
//! ```
//! use kolk::simulation::{BodyInput, Config, Precision, Simulation};
//! use kolk::particles::Given;
//! use std::time::Duration;
//!
//! let dx = 0.05;
//! let lattice = |x: std::ops::Range<i32>, y: std::ops::Range<i32>, keep: fn(i32, i32) -> bool| {
//!     let mut given = Given::default();
//!     for (i, j) in x.flat_map(|i| y.clone().map(move |j| (i, j))).filter(|&(i, j)| keep(i, j)) {
//!         given.position.extend([(f64::from(i) + 0.5) * dx, (f64::from(j) + 0.5) * dx]);
//!         given.velocity.extend([0.0, 0.0]);
//!         given.density.push(1000.0);
//!         given.mass.push(1000.0 * dx * dx);
//!     }
//!     given
//! };
//! let water = lattice(0..20, 0..20, |_, _| true);
//! let tank = lattice(-4..64, -4..40, |i, j| i < 0 || i >= 60 || j < 0);
//! let config: Config = serde_json::from_str(
//!     r#"{"dimension": 2, "spacing": 0.05, "smoothing_length": 0.1, "gravity": [0.0, -9.81],
//!         "reference_density": 1000.0, "sound_speed": 60.0, "artificial_viscosity": {"alpha": 0.02},
//!         "density_diffusion": {"form": "antuono", "delta": 0.1}, "wall": {"method": "adami", "slip": "free"}}"#,
//! )?;
//! let bodies = vec![
//!     BodyInput { name: "water".into(), fluid: true, particles: water },
//!     BodyInput { name: "tank".into(), fluid: false, particles: tank },
//! ];
//! let mut simulation = Simulation::new(config, bodies, Precision::Mixed, 0)?;
//! simulation.advance(0.1, u64::MAX, Duration::MAX)?;
//! assert!(simulation.diagnostics().kinetic_energy > 100.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod effects;
pub mod eos;
pub mod error;
pub mod kernel;
pub mod neighbours;
pub mod operators;
pub mod particles;
pub mod prescribed;
pub mod simd;
pub mod simulation;
pub mod step;
pub mod sweep;
pub mod walls;

#[cfg(feature = "python")]
mod python;
