//! The fluid's fields at points.

use super::solver::Solver;
use crate::kernel::KernelName;
use crate::neighbours::{Cells, Grid, Sorter};
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
    /// The same of the particles of walls.
    pub wall_fill: f64,
}

/// Particles by cell that are not yet sorted into cells: before the first step.
pub(super) struct Order {
    cells: Cells,
    sorter: Sorter,
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Weighted means over the fluid in reach of each point (Shepard 1968), zero where there is none. Pressure is
    /// carried to the point along the hydrostatic gradient, `Σ V (p + ρ g·(x - x_j)) W / Σ V W`, so that a probe may
    /// stand on a wall: the fluid at rest is read exactly. Where neither fluid nor wall fills the support, the rest is
    /// air without pressure: a sensor that a jet has only begun to wet reads the mean over its neighbourhood.
    pub fn sample(&self, points: &[[f64; D]]) -> Vec<Sample<D>> {
        let order = self.order();
        let one = |x| self.sample_point(x, order.as_ref());
        points.par_iter().map(one).collect()
    }

    /// The particles by cell, unless they are sorted.
    pub(super) fn order(&self) -> Option<Order> {
        if self.primed {
            return None;
        }
        let (n, parts) = (self.fluid.len(), Grid::<D>::PARTS);
        let mut order = Order {
            cells: Cells::new(self.grid.count(), parts),
            sorter: Sorter::new(n),
        };
        order.sorter.sort(&mut order.cells, |i| {
            let mut x = self.fluid.at(i);
            self.grid.wrap(&mut x);
            self.grid.bin(&x)
        });
        Some(order)
    }

    /// Fields at `x`; `order` is that of [`Self::order`].
    pub(super) fn sample_point(&self, x: &[f64; D], order: Option<&Order>) -> Sample<D> {
        use crate::eos::EquationOfState;
        let (fluid, kernel, h) = (&self.fluid, self.kernel, self.config.smoothing_length);
        let reach2 = (h * kernel.support()).powi(2);
        let mut sum = Sample {
            pressure: 0.0,
            density: 0.0,
            velocity: [0.0; D],
            fill: 0.0,
            wall_fill: 0.0,
        };
        let mut at = *x;
        self.grid.wrap(&mut at);
        let mut add = |j: usize, d: [f64; D]| {
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
        let cell = self.grid.bin(&at) as usize / Grid::<D>::PARTS;
        for run in self.grid.around(cell).iter() {
            match order {
                None => {
                    for j in fluid.cells.particles(run.first, run.end) {
                        add(
                            j,
                            std::array::from_fn(|a| at[a] - fluid.position[a][j] - run.shift[a]),
                        );
                    }
                }
                Some(Order { cells, sorter }) => {
                    for k in cells.particles(run.first, run.end) {
                        let j = sorter.order[k] as usize;
                        add(j, self.grid.separation(&at, &fluid.at(j)));
                    }
                }
            }
        }
        sum.wall_fill = self.wall_fill(&at, cell);
        if sum.fill > 1e-12 {
            // Particles in disorder fill a support to within some per cent: less than 0.9 means air.
            sum.pressure /= sum.fill.max(0.9 * (1.0 - sum.wall_fill));
            sum.density /= sum.fill;
            sum.velocity = sum.velocity.map(|v| v / sum.fill);
        }
        sum
    }

    /// The share of the support at a point in `cell` that walls fill.
    fn wall_fill(&self, at: &[f64; D], cell: usize) -> f64 {
        let Some(wall) = &self.wall else { return 0.0 };
        let (h, volume) = (
            self.config.smoothing_length,
            1.0 / self.config.reference_density,
        );
        let reach2 = (h * self.kernel.support()).powi(2);
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
