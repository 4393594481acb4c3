//! The whole state of a simulation, out and in again to the bit.
//!
//! The order of the particles and the cells they were sorted into belong to it: they decide the order of every sum.

use super::budget::Budget;
use super::solver::Solver;
use crate::error::{Error, Result};
use crate::particles::Column;
use crate::simd::Real;
use crate::step::{Limit, State};

/// One entry of a checkpoint. Single-precision columns are widened, which loses nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// Doubles.
    Reals(Vec<f64>),
    /// Whole numbers.
    Integers(Vec<u64>),
}

/// A checkpoint by name.
pub type Entries = Vec<(String, Entry)>;

pub(super) fn widen<R: Real>(column: &[R]) -> Entry {
    Entry::Reals(column.iter().map(|x| x.to_f64()).collect())
}

pub(super) fn integers(column: &[u32]) -> Entry {
    Entry::Integers(column.iter().map(|&x| u64::from(x)).collect())
}

/// Takes entries out of a checkpoint, checking that they fit.
pub(super) struct Reader<'a>(&'a Entries);

impl Reader<'_> {
    fn find(&self, name: &str) -> Result<&Entry> {
        let entry = self.0.iter().find(|(n, _)| n == name).map(|(_, e)| e);
        entry.ok_or_else(|| {
            Error::Input(format!(
                "checkpoint: {name} is missing; it was written by another version"
            ))
        })
    }

    pub(super) fn reals(&self, name: &str, n: usize) -> Result<&[f64]> {
        match self.find(name)? {
            Entry::Reals(v) if v.len() == n => Ok(v),
            Entry::Reals(v) => Err(misfit(name, v.len(), n)),
            Entry::Integers(_) => Err(Error::Input(format!(
                "checkpoint: {name} holds integers, allowed are reals"
            ))),
        }
    }

    pub(super) fn integers(&self, name: &str, n: usize) -> Result<&[u64]> {
        match self.find(name)? {
            Entry::Integers(v) if v.len() == n => Ok(v),
            Entry::Integers(v) => Err(misfit(name, v.len(), n)),
            Entry::Reals(_) => Err(Error::Input(format!(
                "checkpoint: {name} holds reals, allowed are integers"
            ))),
        }
    }

    pub(super) fn column<R: Real>(&self, name: &str, to: &mut Column<R>) -> Result<()> {
        let from = self.reals(name, to.len())?;
        for (t, f) in to.iter_mut().zip(from) {
            *t = R::from_f64(*f);
        }
        Ok(())
    }

    /// The order of particles: each id once.
    pub(super) fn order(&self, name: &str, to: &mut [u32]) -> Result<()> {
        let n = to.len();
        self.table(name, to, n.saturating_sub(1))?;
        let mut seen = vec![false; n];
        for &id in to.iter() {
            if std::mem::replace(&mut seen[id as usize], true) {
                return Err(Error::Input(format!(
                    "checkpoint: {name} holds {id} twice; the file is damaged"
                )));
            }
        }
        Ok(())
    }

    /// Offsets into `limit` particles.
    pub(super) fn table(&self, name: &str, to: &mut [u32], limit: usize) -> Result<()> {
        let from = self.integers(name, to.len())?;
        for (t, &f) in to.iter_mut().zip(from) {
            if f > limit as u64 {
                return Err(Error::Input(format!(
                    "checkpoint: {name} holds {f}, allowed is at most {limit}"
                )));
            }
            *t = f as u32;
        }
        Ok(())
    }
}

/// A column in the order in which the particles were given.
fn by_id<R: Real>(column: &[R], id: &[u32]) -> Vec<R> {
    let mut sorted = column.to_vec();
    for (value, &id) in column.iter().zip(id) {
        sorted[id as usize] = *value;
    }
    sorted
}

/// The entry that tells whether a checkpoint is as it was saved.
const SEAL: &str = "seal";

/// A number that changes if any other entry does, whatever their order.
fn seal(entries: &Entries) -> u64 {
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |seal: u64, bits: u64| (seal ^ bits).wrapping_mul(FACTOR).rotate_left(29);
    let of = |(name, entry): &(String, Entry)| {
        let start = name.bytes().map(u64::from).fold(FACTOR, mix);
        match entry {
            Entry::Reals(values) => values.iter().map(|v| v.to_bits()).fold(start, mix),
            Entry::Integers(values) => values.iter().copied().fold(start, mix),
        }
    };
    let others = entries.iter().filter(|(name, _)| name != SEAL);
    // 0 stands for no seal.
    others.map(of).fold(0, u64::wrapping_add).max(1)
}

fn misfit(name: &str, found: usize, wanted: usize) -> Error {
    Error::Input(format!(
        "checkpoint: {name} has {found} entries, the scene needs {wanted}; it belongs to another scene or version"
    ))
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// The state, complete.
    pub fn save(&self) -> Entries {
        let fluid = &self.fluid;
        let mut out: Entries = Vec::new();
        let mut put = |name: &str, entry: Entry| out.push((name.to_owned(), entry));
        for a in 0..D {
            put(
                &format!("position_{a}"),
                Entry::Reals(fluid.position[a].to_vec()),
            );
            put(
                &format!("velocity_{a}"),
                Entry::Reals(fluid.velocity[a].to_vec()),
            );
            put(&format!("acceleration_{a}"), widen(&fluid.acceleration[a]));
        }
        put("density", Entry::Reals(fluid.density.to_vec()));
        put("density_rate", widen(&fluid.density_rate));
        put("mass", widen(&fluid.mass));
        put("id", integers(&fluid.id));
        put("cells", integers(&fluid.cells.offsets));
        // What was read by pairs last: shown by probes until the next step.
        put("volume", widen(&fluid.volume));
        put("pressure", widen(&fluid.pressure));
        if let Some(wall) = &self.wall {
            put("wall_pressure", widen(&wall.pressure));
            put("wall_volume", widen(&wall.volume));
            put("wall_condensation", widen(&wall.condensation));
            for (a, column) in wall.slip_velocity.iter().flatten().enumerate() {
                put(&format!("wall_slip_velocity_{a}"), widen(column));
            }
            if let Some(moving) = &wall.moving {
                for a in 0..D {
                    put(
                        &format!("wall_position_{a}"),
                        Entry::Reals(wall.position[a].to_vec()),
                    );
                    put(&format!("wall_velocity_{a}"), widen(&wall.pair_velocity[a]));
                }
                put("wall_travelled", Entry::Reals(vec![moving.travelled]));
                put("wall_mass", widen(&wall.mass));
                put("wall_id", integers(&wall.id));
                put("wall_cells", integers(&wall.cells.offsets));
            }
            if let Some((density, rate)) = &wall.density {
                put("wall_density", Entry::Reals(density.to_vec()));
                put("wall_density_rate", widen(rate));
            }
        }
        if let Some(boundary) = &self.boundary {
            put("leaks", Entry::Integers(vec![boundary.leaks]));
        }
        let s = &self.state;
        put(
            "scalars",
            Entry::Reals(vec![
                self.time,
                self.time_step,
                self.travelled,
                self.mach_max,
                s.speed,
                s.acceleration,
                s.density_min,
                s.density_max,
            ]),
        );
        put("budget", Entry::Reals(self.budget.numbers().collect()));
        if !self.stages.is_empty() {
            let (longest, limit) = self
                .limits
                .stages
                .unwrap_or((f64::INFINITY, Limit::Acoustic));
            put(
                "stages",
                Entry::Reals(vec![longest, f64::from(limit as u8)]),
            );
        }
        let mut counters = vec![
            self.step,
            u64::from(self.primed),
            self.limit as u64,
            u64::from(s.finite),
        ];
        counters.extend(self.steps_by_limit);
        put("counters", Entry::Integers(counters));
        self.save_guard(&mut out);
        // No seal for a state that has been put in and is wrong: whoever takes it over shall look at it again.
        let seal = if self.foreign.is_some() {
            0
        } else {
            seal(&out)
        };
        out.push((SEAL.to_owned(), Entry::Integers(vec![seal])));
        out
    }

    /// Goes on from a saved state.
    ///
    /// # Errors
    /// An entry that is missing, or does not fit this scene; the simulation must not be used then.
    pub fn restore(&mut self, entries: &Entries) -> Result<()> {
        let from = Reader(entries);
        let fluid = &mut self.fluid;
        let n = fluid.len();
        for a in 0..D {
            from.column(&format!("position_{a}"), &mut fluid.position[a])?;
            from.column(&format!("velocity_{a}"), &mut fluid.velocity[a])?;
            from.column(&format!("acceleration_{a}"), &mut fluid.acceleration[a])?;
        }
        from.column("density", &mut fluid.density)?;
        from.column("density_rate", &mut fluid.density_rate)?;
        let own_mass = by_id(&fluid.mass, &fluid.id);
        let own_wall_mass = self.wall.as_ref().map(|w| by_id(&w.mass, &w.id));
        from.column("mass", &mut fluid.mass)?;
        from.order("id", &mut fluid.id)?;
        from.table("cells", &mut fluid.cells.offsets, n)?;
        from.column("volume", &mut fluid.volume)?;
        from.column("pressure", &mut fluid.pressure)?;
        if !fluid.cells.offsets.is_sorted() {
            return Err(Error::Input(
                "checkpoint: cells are not in order; the file is damaged".to_owned(),
            ));
        }
        fluid.cells.renew();
        if let Some(wall) = &mut self.wall {
            wall.cells.renew();
            from.column("wall_pressure", &mut wall.pressure)?;
            from.column("wall_volume", &mut wall.volume)?;
            from.column("wall_condensation", &mut wall.condensation)?;
            for (a, column) in wall.slip_velocity.iter_mut().flatten().enumerate() {
                from.column(&format!("wall_slip_velocity_{a}"), column)?;
            }
            let n = wall.len();
            if let Some(moving) = &mut wall.moving {
                for a in 0..D {
                    from.column(&format!("wall_position_{a}"), &mut wall.position[a])?;
                    from.column(&format!("wall_velocity_{a}"), &mut wall.pair_velocity[a])?;
                }
                moving.travelled = from.reals("wall_travelled", 1)?[0];
                from.column("wall_mass", &mut wall.mass)?;
                from.order("wall_id", &mut wall.id)?;
                from.table("wall_cells", &mut wall.cells.offsets, n)?;
                if !wall.cells.offsets.is_sorted() {
                    return Err(Error::Input(
                        "checkpoint: the walls' cells are not in order; the file is damaged"
                            .to_owned(),
                    ));
                }
            }
            if let Some((density, rate)) = &mut wall.density {
                from.column("wall_density", density)?;
                from.column("wall_density_rate", rate)?;
            }
        }
        if let Some(boundary) = &mut self.boundary {
            boundary.leaks = from.integers("leaks", 1)?[0];
        }
        let s = from.reals("scalars", 8)?;
        (self.time, self.time_step, self.travelled, self.mach_max) = (s[0], s[1], s[2], s[3]);
        let budget = from.reals("budget", Budget::NUMBERS)?;
        if !budget.iter().all(|x| x.is_finite()) {
            return Err(Error::Input(
                "checkpoint: the energy budget holds numbers that are none; the file is damaged"
                    .to_owned(),
            ));
        }
        self.budget = Budget::saved(budget);
        if !self.stages.is_empty() {
            let stages = from.reals("stages", 2)?;
            self.limits.stages = Limit::ALL.get(stages[1] as usize).map(|l| (stages[0], *l));
        }
        let c = from.integers("counters", 4 + Limit::ALL.len())?;
        self.step = c[0];
        self.primed = c[1] != 0;
        self.limit = Limit::from_index(c[2]);
        self.state = State {
            speed: s[4],
            acceleration: s[5],
            density_min: s[6],
            density_max: s[7],
            finite: c[3] != 0,
        };
        self.steps_by_limit.copy_from_slice(&c[4..]);
        self.set_gravity(self.time);
        self.sweeper.wipe();
        let kept = self.restore_guard(&from)?;
        self.foreign = None;
        if from.integers(SEAL, 1)?[0] != seal(entries) {
            // Someone has changed the state: what was kept of it before is past.
            self.foreign = self.inspect_foreign();
            if self.foreign.is_none() {
                self.keep_first();
            } else {
                // Masses are no part of the state kept: those from before stay.
                for (mass, &id) in self.fluid.mass.iter_mut().zip(self.fluid.id.iter()) {
                    *mass = own_mass[id as usize];
                }
                if let (Some(wall), Some(own)) = (&mut self.wall, own_wall_mass) {
                    for (mass, &id) in wall.mass.iter_mut().zip(wall.id.iter()) {
                        *mass = own[id as usize];
                    }
                }
            }
        } else if !kept {
            self.keep_first();
        }
        Ok(())
    }
}
