//! Small displacements that keep the particles evenly spread.

use super::free_surface::norm;
use super::{Cloud, free_surface};
use crate::effects::sun_strength;
use rayon::prelude::*;

/// How far particles move down the gradient of their concentration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shift {
    /// `-½ dt U H²/Δp Σ_j [1 + R (W/W(Δp))⁴] ∇W m_j/(ρ_i + ρ_j)`, `R = 0.2`, support radius `H`, at most `½ U dt`
    /// ([`sun_strength`]; Sun et al. 2017).
    Sun {
        /// Time step `dt` [s].
        time_step: f64,
        /// Largest speed `U` of the flow [m/s].
        speed: f64,
    },
    /// `-½ h² Σ_j [1 + R (W/W(Δp))⁴] V_j ∇W`, at most `0.2 h` (Lind et al. 2012).
    Lind,
}

/// Below this eigenvalue a particle near the surface is not shifted at all (Sun et al. 2017).
const FREE: f64 = 0.4;

/// Displacement [m] of every particle. `spacing` [m] is the particles' distance at rest, below the support radius.
///
/// With `surface`, particles of the free surface and their neighbours move along it only, and those in spray not at
/// all; without it all particles are shifted as inside the fluid.
pub fn particle_shift<const D: usize>(
    cloud: &Cloud<D>,
    form: Shift,
    spacing: f64,
    surface: bool,
) -> Vec<[f64; D]> {
    let at_rest = cloud.kernel.value(spacing);
    let (scale, limit) = match form {
        Shift::Sun { time_step, speed } => (
            sun_strength(cloud.kernel.radius(), spacing, speed, time_step),
            0.5 * speed * time_step,
        ),
        Shift::Lind => (0.5 * cloud.h * cloud.h, 0.2 * cloud.h),
    };
    let mut shift = cloud.map(|i| {
        let mut sum = [0.0; D];
        cloud.for_each_neighbour(i, |j, d, r, slope| {
            let closeness = cloud.kernel.value(r) / at_rest;
            let share = match form {
                Shift::Sun { .. } => 2.0 * cloud.mass[j] / (cloud.density[i] + cloud.density[j]),
                Shift::Lind => cloud.volume[j],
            };
            let weight = (1.0 + 0.2 * closeness.powi(4)) * share * slope;
            for a in 0..D {
                sum[a] += weight * d[a];
            }
        });
        let step = sum.map(|s| -scale * s);
        let length = norm(&step);
        if length > limit {
            step.map(|s| s * (limit / length))
        } else {
            step
        }
    });
    if surface {
        keep_to_surface(cloud, &mut shift);
    }
    shift
}

/// Takes out what would push particles through the free surface.
fn keep_to_surface<const D: usize>(cloud: &Cloud<D>, shift: &mut [[f64; D]]) {
    let surface = free_surface(cloud);
    shift
        .par_iter_mut()
        .enumerate()
        .with_min_len(256)
        .for_each(|(i, shift)| {
            let mut near = surface.on[i];
            cloud.for_each_neighbour(i, |j, _, _, _| near |= surface.on[j]);
            if !near {
                return;
            }
            if surface.eigenvalue[i] < FREE {
                *shift = [0.0; D];
                return;
            }
            let normal = &surface.normal[i];
            let through: f64 = (0..D).map(|a| normal[a] * shift[a]).sum();
            for a in 0..D {
                shift[a] -= through * normal[a];
            }
        });
}
