//! The fluid's fields at points, and its force on walls.

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

    fn sample_point(&self, x: &[f64; D]) -> Sample<D> {
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

    /// Force and moment about the origin that the fluid's pressure exerts on the wall particles `ids`, by action and
    /// reaction of the pair forces on the fluid: `Σ_w Σ_f V_f V_w (p_f + p_w) ∇W_fw`. Moment: one number in 2D.
    pub fn force_on(&self, ids: &std::ops::Range<u32>) -> ([f64; D], Vec<f64>) {
        let moments = if D == 3 { 3 } else { 1 };
        let Some(wall) = self.wall.as_ref().filter(|_| self.primed) else {
            return ([0.0; D], vec![0.0; moments]);
        };
        let (fluid, kernel, h) = (&self.fluid, self.kernel, self.config.smoothing_length);
        let reach2 = (h * kernel.support()).powi(2);
        let cells = &wall.cells;
        let per_cell: Vec<[f64; 6]> = (0..cells.count())
            .into_par_iter()
            .map(|cell| {
                let mut total = [0.0; 6];
                let own = cells.particles(cell, cell + 1);
                if own.is_empty() {
                    return total;
                }
                for run in self.grid.around(cell).iter() {
                    for j in fluid.cells.particles(run.first, run.end) {
                        let y: [f64; D] =
                            std::array::from_fn(|a| fluid.position[a][j] + run.shift[a]);
                        for i in own.clone().filter(|&i| ids.contains(&wall.id[i])) {
                            let d: [f64; D] = std::array::from_fn(|a| y[a] - wall.position[a][i]);
                            let r2: f64 = d.iter().map(|d| d * d).sum();
                            if r2 >= reach2 || r2 == 0.0 {
                                continue;
                            }
                            let r = r2.sqrt();
                            let strength = (fluid.volume[j] * wall.volume[i]).to_f64()
                                * (fluid.pressure[j] + wall.pressure[i]).to_f64()
                                * kernel.gradient(D, r, h)
                                / r;
                            let f: [f64; D] = std::array::from_fn(|a| strength * d[a]);
                            for a in 0..D {
                                total[a] += f[a];
                            }
                            let x: [f64; D] = std::array::from_fn(|a| wall.position[a][i]);
                            if D == 3 {
                                total[3] += x[1] * f[2] - x[2] * f[1];
                                total[4] += x[2] * f[0] - x[0] * f[2];
                            }
                            total[5] += x[0] * f[1] - x[1] * f[0];
                        }
                    }
                }
                total
            })
            .collect();
        let mut total = [0.0; 6];
        for cell in &per_cell {
            for k in 0..6 {
                total[k] += cell[k];
            }
        }
        let force = std::array::from_fn(|a| total[a]);
        (
            force,
            if D == 3 {
                total[3..].to_vec()
            } else {
                vec![total[5]]
            },
        )
    }
}
