//! Penalty contact of particles with facets, as of nodes with surfaces in finite elements (Hallquist 2006, LS-DYNA's
//! nodes-to-surface contact): a force `k d n` for the depth `d` to which a particle is nearer than its own radius.

use super::facet::minus;
use super::surface::Surface;
use crate::neighbours::Grid;
use crate::particles::{Fluid, Shared};
use crate::simd::{Real, dot};
use rayon::prelude::*;

/// Stiffness in units of `m c0²/Δp²`: that of the fluid itself, so that the time step of sound keeps it stable.
const STIFFNESS: f64 = 1.0;
/// Damping of the approach in units of the critical one.
const DAMPING: f64 = 0.5;
/// Directions nearer than this cosine are one contact: neighbouring facets of a plane, of a curve, or of an edge.
const SAME: f64 = 0.9;
/// Cells per task.
const CELLS: usize = 64;

/// Contact with a surface.
pub struct Penalty<const D: usize> {
    /// Facets, found within the radius of a particle at least.
    pub surface: Surface<D>,
    radius: f64,
    stiffness: f64,
    damping: f64,
}

impl<const D: usize> Penalty<D> {
    /// For particles of a `radius` in m, the spacing in m and the speed of sound in m/s.
    pub fn new(surface: Surface<D>, radius: f64, spacing: f64, sound_speed: f64) -> Self {
        let rate = sound_speed / spacing;
        Penalty {
            surface,
            radius,
            stiffness: STIFFNESS * rate * rate,
            damping: 2.0 * DAMPING * STIFFNESS.sqrt() * rate,
        }
    }

    /// Adds the contacts to the accelerations.
    pub fn add_forces<R: Real>(&self, fluid: &mut Fluid<R, D>, grid: &Grid<D>) {
        let acceleration =
            std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.acceleration[a]));
        let fluid = &*fluid;
        let surface = &self.surface;
        (0..surface.cells().len())
            .into_par_iter()
            .with_min_len(CELLS)
            .for_each(|k| {
                let cell = surface.cells()[k] as usize;
                let facets = surface.near(k);
                for i in fluid.cells.particles(cell, cell + 1) {
                    let mut x = fluid.at(i);
                    if grid.is_periodic() {
                        grid.wrap(&mut x);
                    }
                    let u = std::array::from_fn(|a| fluid.pair_velocity[a][i].to_f64());
                    let push = self.push(&x, &u, facets);
                    for a in 0..D {
                        // SAFETY: every particle is visited once.
                        unsafe {
                            let own = acceleration[a].range(&(i..i + 1));
                            own[0] += R::from_f64(push[a]);
                        }
                    }
                }
            });
    }

    /// Acceleration of a particle at `x` with velocity `u`: the nearest contact, then others along other directions, as in
    /// a corner. Never a pull.
    pub fn push(&self, x: &[f64; D], u: &[f64; D], facets: &[u32]) -> [f64; D] {
        let mut total = [0.0; D];
        let mut used = [[0.0; D]; D];
        for known in 0..D {
            let mut nearest = (self.radius, None);
            for &k in facets {
                let facet = &self.surface.facets()[k as usize];
                let height = dot(&minus(x, &facet.corners[0]), &facet.normal);
                if height.abs() >= self.radius {
                    continue;
                }
                let away = minus(x, &facet.closest(x));
                let distance = dot(&away, &away).sqrt();
                // Behind the surface the way out is forward.
                let (gap, out) = if height < 0.0 {
                    (-distance, facet.normal)
                } else if distance > 1e-9 * self.radius {
                    (distance, away.map(|v| v / distance))
                } else {
                    (distance, facet.normal)
                };
                let new = used[..known].iter().all(|d| dot(d, &out) < SAME);
                if new && distance < self.radius && gap < nearest.0 {
                    nearest = (gap, Some(out));
                }
            }
            let (gap, Some(out)) = nearest else { break };
            let strength = self.stiffness * (self.radius - gap) - self.damping * dot(u, &out);
            for a in 0..D {
                total[a] += strength.max(0.0) * out[a];
            }
            used[known] = out;
        }
        total
    }
}
