//! The fluid's fields at points.

use super::solver::Solver;
use crate::kernel::KernelName;
use crate::simd::Real;
use rayon::prelude::*;

/// Fields of the fluid at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<const D: usize> {
    /// Pressure in Pa.
    pub pressure: f64,
    /// Density in kg/m³.
    pub density: f64,
    /// Velocity in m/s.
    pub velocity: [f64; D],
    /// `Σ V W`, the share of the support that is filled: about 1 inside, ½ at a surface or a plane wall.
    pub fill: f64,
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Weighted means over the fluid in reach of each point (Shepard 1968), zero where there is none. Pressure is
    /// carried to the point along the hydrostatic gradient, `Σ V (p + ρ g·(x - x_j)) W / Σ V W`, so that a probe may
    /// stand on a wall: the fluid at rest is read exactly. Where neither fluid nor wall fills the support, the rest is
    /// air without pressure: a sensor that a jet has only begun to wet reads the mean over its neighbourhood.
    pub fn sample(&self, points: &[[f64; D]]) -> Vec<Sample<D>> {
        points.par_iter().map(|x| self.sample_point(x)).collect()
    }

    pub(super) fn sample_point(&self, x: &[f64; D]) -> Sample<D> {
        use crate::eos::EquationOfState;
        let (fluid, kernel, h) = (&self.fluid, self.kernel, self.config.smoothing_length);
        let reach2 = (h * kernel.support()).powi(2);
        let mut sum = Sample {
            pressure: 0.0,
            density: 0.0,
            velocity: [0.0; D],
            fill: 0.0,
        };
        let mut at = *x;
        self.grid.wrap(&mut at);
        let mut add = |j: usize, shift: &[f64; D]| {
            let d: [f64; D] = std::array::from_fn(|a| at[a] - fluid.position[a][j] - shift[a]);
            let r2: f64 = d.iter().map(|d| d * d).sum();
            if r2 >= reach2 {
                return;
            }
            let density = fluid.density[j];
            let weight =
                fluid.mass[j].to_f64() / density * KernelName::value(kernel, D, r2.sqrt(), h);
            let head: f64 = (0..D).map(|a| self.motion.gravity[a] * d[a]).sum();
            sum.fill += weight;
            sum.pressure += weight * (self.motion.eos.pressure_at(density) + density * head);
            sum.density += weight * density;
            for a in 0..D {
                sum.velocity[a] += weight * fluid.velocity[a][j];
            }
        };
        if self.primed {
            let cell = self.grid.bin(&at) as usize / crate::neighbours::Grid::<D>::PARTS;
            for run in self.grid.around(cell).iter() {
                for j in fluid.cells.particles(run.first, run.end) {
                    add(j, &run.shift);
                }
            }
        } else {
            for j in 0..fluid.len() {
                let d = self.grid.separation(&at, &fluid.at(j));
                let shift = std::array::from_fn(|a| at[a] - fluid.position[a][j] - d[a]);
                add(j, &shift);
            }
        }
        if sum.fill > 1e-12 {
            // Particles in disorder fill a support to within some per cent: less than 0.9 means air.
            let free = 1.0 - self.wall_fill(&at);
            sum.pressure /= sum.fill.max(0.9 * free);
            sum.density /= sum.fill;
            sum.velocity = sum.velocity.map(|v| v / sum.fill);
        }
        sum
    }

    /// The share of the support at a point that walls fill.
    fn wall_fill(&self, at: &[f64; D]) -> f64 {
        let Some(wall) = &self.wall else { return 0.0 };
        let (h, volume) = (
            self.config.smoothing_length,
            1.0 / self.config.reference_density,
        );
        let reach2 = (h * self.kernel.support()).powi(2);
        let cell = self.grid.bin(at) as usize / crate::neighbours::Grid::<D>::PARTS;
        let mut fill = 0.0;
        for run in self.grid.around(cell).iter() {
            for j in wall.cells.particles(run.first, run.end) {
                let r2: f64 = (0..D)
                    .map(|a| (at[a] - wall.position[a][j] - run.shift[a]).powi(2))
                    .sum();
                if r2 < reach2 {
                    fill += wall.mass[j].to_f64() * volume * self.kernel.value(D, r2.sqrt(), h);
                }
            }
        }
        fill
    }
}
