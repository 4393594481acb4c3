//! The force of the fluid on walls.

use super::config::ViscosityForm;
use super::solver::Solver;
use crate::effects::{Contact, MonaghanGingold, Morris, PairTerm, Pressure, Touch};
use crate::simd::Real;
use crate::sweep::{SLOTS, Single, slot};
use crate::walls::Slip;
use rayon::prelude::*;
use std::ops::Range;

impl<R: Real, const D: usize> Solver<R, D> {
    /// Force and moment about the origin that the fluid exerts on the wall particles `ids`: the reaction to everything by
    /// which walls accelerate the fluid, pressure, contact and friction, by the same pair terms. Moment: one number in
    /// 2D, in the plane.
    pub fn force_on(&self, ids: &Range<u32>) -> ([f64; D], Vec<f64>) {
        let c = &self.config;
        let (h, rho) = (c.smoothing_length, c.reference_density);
        let sticks = c.wall.is_some_and(|w| w.slip == Slip::No);
        if c.wall.is_some_and(|w| !w.method.uses_particles()) {
            let total = self.force_on_facets(ids);
            let moment = if D == 3 { &total[3..] } else { &total[5..] };
            return (std::array::from_fn(|a| total[a]), moment.to_vec());
        }
        let total = match c.laminar_viscosity.filter(|_| sticks) {
            None => self.reaction(ids, ()),
            // As in the sweep of forces: beside artificial viscosity there is one form.
            Some(v) if v.form == ViscosityForm::Morris && c.artificial_viscosity.is_none() => {
                self.reaction(ids, Morris::new(v.kinematic, h, rho))
            }
            Some(v) => self.reaction(ids, MonaghanGingold::new(v.kinematic, h, rho)),
        };
        let moment = if D == 3 { &total[3..] } else { &total[5..] };
        (std::array::from_fn(|a| total[a]), moment.to_vec())
    }

    /// Force (3) and moment (3) on the wall particles `ids`, with `friction` at the wall.
    fn reaction(&self, ids: &Range<u32>, friction: impl PairTerm<f64, D>) -> [f64; 6] {
        let Some(wall) = self.wall.as_ref().filter(|_| self.primed) else {
            return [0.0; 6];
        };
        let c = &self.config;
        let contact = Contact::wall(c.spacing, D, c.sound_speed, c.reference_density);
        let terms = (Pressure, (contact, friction));
        let single = Single::<D>::new(self.kernel, c.smoothing_length);
        let (cells, stages) = (&wall.cells, &self.stages);
        let per_cell: Vec<[f64; 6]> = (0..cells.count())
            .into_par_iter()
            .map(|cell| {
                let mut total = [0.0; 6];
                for i in cells.particles(cell, cell + 1) {
                    if !ids.contains(&wall.id[i]) {
                        continue;
                    }
                    let x: [f64; D] = std::array::from_fn(|a| wall.position[a][i]);
                    let own = self.wall_fields(i);
                    let mut force = [0.0; D];
                    for run in self.grid.around(cell).iter() {
                        for j in self.fluid.cells.particles(run.first, run.end) {
                            let d: [f64; D] = std::array::from_fn(|a| {
                                x[a] - self.fluid.position[a][j] - run.shift[a]
                            });
                            if single.reaches(&d) {
                                let other = self.fluid_fields(j);
                                let f = single.vector(&terms, &d, &own, &other);
                                let at = Touch {
                                    single: &single,
                                    separation: &d,
                                    wall: &own,
                                    fluid: &other,
                                    j,
                                };
                                for a in 0..D {
                                    force[a] += f[a];
                                }
                                for stage in stages {
                                    let f = stage.reaction(&at);
                                    for a in 0..D {
                                        force[a] += f[a];
                                    }
                                }
                            }
                        }
                    }
                    let volume = own[slot::VOLUME];
                    let f = force.map(|f| f * volume);
                    for a in 0..D {
                        total[a] += f[a];
                    }
                    if D == 3 {
                        total[3] += x[1] * f[2] - x[2] * f[1];
                        total[4] += x[2] * f[0] - x[0] * f[2];
                    }
                    total[5] += x[0] * f[1] - x[1] * f[0];
                }
                total
            })
            .collect();
        per_cell.iter().fold([0.0; 6], |sum, cell| {
            std::array::from_fn(|k| sum[k] + cell[k])
        })
    }

    /// What pairs read of a fluid particle.
    fn fluid_fields(&self, j: usize) -> [f64; SLOTS] {
        let fluid = &self.fluid;
        let mut fields = [0.0; SLOTS];
        fields[slot::VOLUME] = fluid.volume[j].to_f64();
        fields[slot::PRESSURE] = fluid.pressure[j].to_f64();
        fields[slot::CONDENSATION] = fluid.condensation[j].to_f64();
        for a in 0..D {
            fields[slot::VELOCITY + a] = fluid.velocity[a][j];
        }
        fields
    }

    /// What pairs read of a wall particle.
    fn wall_fields(&self, i: usize) -> [f64; SLOTS] {
        let mut fields = [0.0; SLOTS];
        let Some(wall) = &self.wall else {
            return fields;
        };
        fields[slot::VOLUME] = wall.volume[i].to_f64();
        fields[slot::PRESSURE] = wall.pressure[i].to_f64();
        fields[slot::CONDENSATION] = wall.condensation[i].to_f64();
        let velocity = wall.slip_velocity.as_ref().unwrap_or(&wall.pair_velocity);
        for a in 0..D {
            fields[slot::VELOCITY + a] = velocity[a][i].to_f64();
        }
        fields
    }
}
