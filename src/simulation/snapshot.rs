//! A state a few steps old, in memory, to go back to.
//!
//! It holds what a state is made of and nothing that follows from it: positions, velocities and densities in double
//! precision, with the order of the particles; 60 bytes per fluid particle in three dimensions, 44 in two. Rates are
//! summed anew when it is put back, and masses belong to particles, not to moments.

use super::budget::Budget;
use super::checkpoint::{Entries, Entry, Reader, integers};
use super::retry::{MEMORY, Memory, Retries, Trouble};
use super::solver::Solver;
use crate::error::Result;
use crate::particles::{Column, GRAIN, vector_columns};
use crate::simd::Real;
use crate::step::Limit;
use rayon::prelude::*;

/// The state of a fluid at the end of some step.
pub(super) struct Snapshot<const D: usize> {
    pub(super) position: [Column<f64>; D],
    pub(super) velocity: [Column<f64>; D],
    pub(super) density: Column<f64>,
    pub(super) id: Column<u32>,
    /// Densities of walls that follow the equation of continuity, by id: walls in motion are sorted anew.
    pub(super) wall_density: Option<Column<f64>>,
    pub(super) scalars: Scalars,
}

/// What else belongs to that moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Scalars {
    pub(super) time: f64,
    pub(super) time_step: f64,
    pub(super) mach_max: f64,
    pub(super) step: u64,
    pub(super) limit: Limit,
    pub(super) steps_by_limit: [u64; Limit::ALL.len()],
    pub(super) budget: Budget,
}

impl<const D: usize> Snapshot<D> {
    /// Room for `fluid` particles, and for the density of `wall` particles where these have one of their own.
    pub(super) fn new(fluid: usize, wall: Option<usize>) -> Self {
        Snapshot {
            position: vector_columns(fluid),
            velocity: vector_columns(fluid),
            density: Column::new(fluid),
            id: Column::new(fluid),
            wall_density: wall.map(Column::new),
            scalars: Scalars::default(),
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        2 * D * self.position[0].bytes()
            + self.density.bytes()
            + self.id.bytes()
            + self.wall_density.as_ref().map_or(0, Column::bytes)
    }
}

/// Copies a column on all threads.
fn copy<T: Copy + Send + Sync>(from: &[T], to: &mut [T]) {
    to.par_chunks_mut(GRAIN)
        .zip(from.par_chunks(GRAIN))
        .for_each(|(to, from)| to.copy_from_slice(from));
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Keeps the present state.
    pub(super) fn take_snapshot(&mut self) {
        let Some(kept) = &mut self.guard.snapshot else {
            return;
        };
        let fluid = &self.fluid;
        for a in 0..D {
            copy(&fluid.position[a], &mut kept.position[a]);
            copy(&fluid.velocity[a], &mut kept.velocity[a]);
        }
        copy(&fluid.density, &mut kept.density);
        copy(&fluid.id, &mut kept.id);
        if let Some(wall) = &self.wall
            && let (Some((density, _)), Some(to)) = (&wall.density, &mut kept.wall_density)
        {
            for (&id, density) in wall.id.iter().zip(density.iter()) {
                to[id as usize] = *density;
            }
        }
        kept.scalars = Scalars {
            time: self.time,
            time_step: self.time_step,
            mach_max: self.mach_max,
            step: self.step,
            limit: self.limit,
            steps_by_limit: self.steps_by_limit,
            budget: self.budget,
        };
    }

    /// Goes back to the state kept. Its rates have to be summed anew.
    pub(super) fn put_snapshot_back(&mut self) {
        let Some(kept) = &self.guard.snapshot else {
            return;
        };
        let fluid = &mut self.fluid;
        // Masses are in the present order: by id, then in the order of the snapshot.
        for (&id, mass) in fluid.id.iter().zip(fluid.mass.iter()) {
            fluid.volume[id as usize] = *mass;
        }
        for (mass, &id) in fluid.mass.iter_mut().zip(kept.id.iter()) {
            *mass = fluid.volume[id as usize];
        }
        for a in 0..D {
            copy(&kept.position[a], &mut fluid.position[a]);
            copy(&kept.velocity[a], &mut fluid.velocity[a]);
            fluid.acceleration[a].fill(R::from_f64(0.0));
        }
        copy(&kept.density, &mut fluid.density);
        copy(&kept.id, &mut fluid.id);
        fluid.density_rate.fill(R::from_f64(0.0));
        for column in fluid.shift.iter_mut().flatten() {
            column.fill(R::from_f64(0.0));
        }
        // Not read before they are computed anew, but shown and saved.
        fluid.volume.fill(R::from_f64(0.0));
        fluid.pressure.fill(R::from_f64(0.0));
        if let Some(wall) = &mut self.wall
            && let (Some((density, rate)), Some(from)) = (&mut wall.density, &kept.wall_density)
        {
            for (&id, density) in wall.id.iter().zip(density.iter_mut()) {
                *density = from[id as usize];
            }
            rate.fill(R::from_f64(0.0));
        }
        if let Some(wall) = &mut self.wall {
            wall.pressure.fill(R::from_f64(0.0));
            wall.volume.fill(R::from_f64(0.0));
            wall.condensation.fill(R::from_f64(0.0));
            for column in wall.slip_velocity.iter_mut().flatten() {
                column.fill(R::from_f64(0.0));
            }
        }
        let s = kept.scalars;
        (self.time, self.time_step, self.mach_max) = (s.time, s.time_step, s.mach_max);
        (self.step, self.limit, self.steps_by_limit) = (s.step, s.limit, s.steps_by_limit);
        self.budget = s.budget;
        self.primed = false;
        self.sweeper.wipe();
    }
}

const KINDS: usize = Trouble::ALL.len();
const LIMITS: usize = Limit::ALL.len();

impl<R: Real, const D: usize> Solver<R, D> {
    /// Adds the guard's memory to a checkpoint.
    pub(super) fn save_guard(&self, out: &mut Entries) {
        let Some(kept) = &self.guard.snapshot else {
            out.push(("guard".to_owned(), Entry::Integers(Vec::new())));
            return;
        };
        let (m, s) = (&self.guard.memory, &kept.scalars);
        let mut put = |name: String, entry: Entry| out.push((name, entry));
        let mut counters = vec![m.attempts, m.calm, m.patience, m.record.undone, s.step];
        counters.push(s.limit as u64);
        counters.extend(s.steps_by_limit);
        counters.extend(m.silent_until);
        counters.extend(m.record.retries);
        counters.extend(m.record.passed);
        put("guard".to_owned(), Entry::Integers(counters));
        let mut scalars = vec![
            m.factor,
            m.closest,
            m.passes,
            s.time,
            s.time_step,
            s.mach_max,
        ];
        scalars.extend(m.energies);
        scalars.extend(s.budget.numbers());
        put("guard_scalars".to_owned(), Entry::Reals(scalars));
        for a in 0..D {
            let (x, v) = (&kept.position[a], &kept.velocity[a]);
            put(format!("guard_position_{a}"), Entry::Reals(x.to_vec()));
            put(format!("guard_velocity_{a}"), Entry::Reals(v.to_vec()));
        }
        put(
            "guard_density".to_owned(),
            Entry::Reals(kept.density.to_vec()),
        );
        put("guard_id".to_owned(), integers(&kept.id));
        if let Some(density) = &kept.wall_density {
            put(
                "guard_wall_density".to_owned(),
                Entry::Reals(density.to_vec()),
            );
        }
    }

    /// Takes the guard's memory out of a checkpoint. Gives whether it held one: a run without a guard leaves none.
    pub(super) fn restore_guard(&mut self, from: &Reader) -> Result<bool> {
        let Some(kept) = &mut self.guard.snapshot else {
            return Ok(false);
        };
        self.guard.memory = Memory::default();
        if from.integers("guard", 0).is_ok() {
            return Ok(false);
        }
        let counters = from.integers("guard", 6 + LIMITS + 3 * KINDS)?;
        let reals = from.reals("guard_scalars", 6 + MEMORY + Budget::NUMBERS)?;
        let (head, rest) = counters.split_at(6);
        let (by_limit, rest) = rest.split_at(LIMITS);
        let table = |k: usize| std::array::from_fn(|t| rest[k * KINDS + t]);
        self.guard.memory = Memory {
            factor: reals[0],
            closest: reals[1],
            passes: reals[2],
            energies: std::array::from_fn(|k| reals[6 + k]),
            attempts: head[0],
            calm: head[1],
            patience: head[2],
            silent_until: table(0),
            record: Retries {
                retries: table(1),
                passed: table(2),
                undone: head[3],
            },
        };
        kept.scalars = Scalars {
            time: reals[3],
            time_step: reals[4],
            mach_max: reals[5],
            step: head[4],
            limit: Limit::from_index(head[5]),
            steps_by_limit: std::array::from_fn(|k| by_limit[k]),
            budget: Budget::saved(&reals[6 + MEMORY..]),
        };
        for a in 0..D {
            from.column(&format!("guard_position_{a}"), &mut kept.position[a])?;
            from.column(&format!("guard_velocity_{a}"), &mut kept.velocity[a])?;
        }
        from.column("guard_density", &mut kept.density)?;
        from.order("guard_id", &mut kept.id)?;
        if let Some(density) = &mut kept.wall_density {
            from.column("guard_wall_density", density)?;
        }
        Ok(true)
    }
}
