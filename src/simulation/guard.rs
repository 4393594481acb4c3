//! Watches a run: on trouble back to a snapshot and on with a smaller step, or an end with a reason.
//!
//! Every step is checked by what its last pass reduces anyway: numbers that are finite, the range of density, and
//! whether the step was short enough for the speeds and accelerations that came of it. Every [`INTERVAL`] steps, and
//! whenever a time asked for is reached, the energy is summed, the closest pair is found and the state kept. A state once handed out is never taken
//! back. All decisions rest on the state alone, and what they remember is in the checkpoint: same bits for any number
//! of threads and over restart.

use super::config::Config;
use super::retry::{MEMORY, Memory, Trouble, UNKNOWN, Verdict};
use super::snapshot::Snapshot;
use super::solver::Solver;
use crate::eos::AnyEos;
use crate::error::{Error, Result};
use crate::particles::{Given, sum};
use crate::simd::Real;
use crate::step::Limit;
use crate::walls::WallMethod;

/// Steps between two snapshots.
const INTERVAL: u64 = 16;
/// Steps after which a snapshot is taken of a state that it would rather not keep.
const LONGEST: u64 = 4 * INTERVAL;
/// Distance in spacings below which a pair is too close, if it was not at the last snapshot.
const TOO_CLOSE: f64 = 0.1;
/// How far a step may exceed what its own outcome allows.
const OVERSHOOT: f64 = 2.0;
/// A step this much shorter than sound at rest asks for leads nowhere.
const HOPELESS: f64 = 1e-5;
/// Growth of energy between snapshots, in units of kinetic and elastic energy, that nothing but an instability makes.
const GROWTH: f64 = 0.05;
/// The same, in units of `m c0²`, where there is little energy.
const GROWTH_FLOOR: f64 = 1e-5;
/// Density, as a share of that at rest: outside, the state is given up.
pub(super) const DENSITY_RANGE: (f64, f64) = (0.5, 1.5);
/// The same: outside, a state is not one to go back to.
const CALM_RANGE: (f64, f64) = (0.8, 1.2);

/// The guard's memory.
pub(super) struct Guard<const D: usize> {
    /// Present if the guard is on.
    pub(super) snapshot: Option<Box<Snapshot<D>>>,
    /// Whether nothing but gravity works on the fluid, so that its energy cannot grow.
    closed: bool,
    pub(super) memory: Memory,
}

/// Whether nothing but gravity works on the fluid. A wall in motion does, and so does surface tension; and where gravity changes, or acts along a
/// period, potential energy is not a function of position.
fn is_closed(config: &Config, wall: &Given) -> bool {
    let falls = |axis: usize| config.gravity.as_ref().is_some_and(|g| g[axis] != 0.0);
    let steady = config.motion.is_empty() && config.gravity_over_time.is_empty();
    let mut periods = config.periodic.iter().enumerate();
    steady
        && config.surface_tension.is_none()
        && wall.velocity.iter().all(|&v| v == 0.0)
        && !periods.any(|(a, p)| p.is_some() && falls(a))
}

impl<const D: usize> Guard<D> {
    /// Watching if `config` says so, with room for a state of the particles given.
    pub(super) fn new(config: &Config, fluid: &Given, wall: &Given) -> Self {
        let follows = config
            .wall
            .is_some_and(|w| w.method == WallMethod::Dynamic)
            .then_some(wall.mass.len());
        let room = || Box::new(Snapshot::new(fluid.mass.len(), follows));
        Guard {
            snapshot: config.guard.then(room),
            closed: is_closed(config, wall),
            memory: Memory::default(),
        }
    }

    /// The time step as the guard allows it.
    pub(super) fn shorten(&self, dt: f64, limit: Limit) -> (f64, Limit) {
        if self.memory.factor < 1.0 {
            (dt * self.memory.factor, Limit::Guard)
        } else {
            (dt, limit)
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.snapshot.as_ref().map_or(0, |s| s.bytes())
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// What is wrong after a step of `dt`, by what the step reduced.
    pub(super) fn check(&mut self, dt: f64) -> std::result::Result<(), Trouble> {
        if self.fluid.is_empty() {
            return Ok(());
        }
        let (state, rest) = (&self.state, self.config.reference_density);
        self.mach_max = self.mach_max.max(state.speed / self.config.sound_speed);
        if !state.finite {
            return Err(Trouble::NotFinite);
        }
        if state.density_min <= DENSITY_RANGE.0 * rest
            || state.density_max >= DENSITY_RANGE.1 * rest
        {
            return Err(Trouble::Density);
        }
        if self.guard.snapshot.is_some() && dt > OVERSHOOT * self.allowed() {
            return self.found(Trouble::Overshoot);
        }
        Ok(())
    }

    /// A trouble, unless its check is silent.
    fn found(&self, trouble: Trouble) -> std::result::Result<(), Trouble> {
        if self.step < self.guard.memory.silent_until[trouble as usize] {
            Ok(())
        } else {
            Err(trouble)
        }
    }

    /// The time step that the present state allows, in s; infinite if the scene fixed it.
    fn allowed(&self) -> f64 {
        let sound = self.motion.sound_speed(self.state.density_max);
        let (dt, limit) = self
            .limits
            .time_step(sound, self.state.speed, self.state.acceleration);
        if limit == Limit::Fixed {
            f64::INFINITY
        } else {
            dt
        }
    }

    /// Whether `dt` is so short that the run leads nowhere; a step that ends at an output may be.
    pub(super) fn hopeless(&self, dt: f64, limit: Limit) -> bool {
        let regular = self.limits.courant * self.limits.smoothing_length / self.config.sound_speed;
        let by_flow = matches!(limit, Limit::Force | Limit::Acoustic | Limit::Guard);
        (by_flow && dt < HOPELESS * regular) || self.time + dt <= self.time
    }

    /// After a step without trouble: the checks that are not made every step, and the snapshot. `arrived`: at a time
    /// asked for.
    pub(super) fn after_step(&mut self, arrived: bool) -> Result<()> {
        let Some(kept) = &self.guard.snapshot else {
            return Ok(());
        };
        let since = self.step - kept.scalars.step;
        self.guard.memory.recover();
        let due = since >= INTERVAL && self.time >= self.guard.memory.passes;
        if !(arrived || (due && (self.is_calm() || since >= LONGEST))) {
            return Ok(());
        }
        let energy = self.energy();
        let closest = self.closest_pair().min(UNKNOWN);
        let checked = self
            .check_energy(energy)
            .and_then(|()| self.check_closeness(closest));
        if let Err(trouble) = checked
            && self.goes_back(trouble)?
        {
            return Ok(());
        }
        self.keep(energy, closest);
        Ok(())
    }

    /// Whether the state is one to go back to.
    fn is_calm(&self) -> bool {
        let rest = self.config.reference_density;
        self.state.density_min > CALM_RANGE.0 * rest && self.state.density_max < CALM_RANGE.1 * rest
    }

    /// Keeps the state, and starts to count attempts anew.
    fn keep(&mut self, energy: [f64; 3], closest: f64) {
        self.take_snapshot();
        let memory = &mut self.guard.memory;
        (memory.closest, memory.passes) = (closest, 0.0);
        memory.attempts = 0;
        memory.energies.rotate_right(1);
        memory.energies[0] = energy[0];
    }

    /// Keeps a state that was put in from outside, with no memory of energies before.
    pub(super) fn keep_first(&mut self) {
        if self.guard.snapshot.is_none() {
            return;
        }
        self.guard.memory.energies = [UNKNOWN; MEMORY];
        let energy = self.energy();
        let closest = self.closest_pair().min(UNKNOWN);
        self.keep(energy, closest);
    }

    /// Energy, the part of it that is kinetic or elastic (J), and mass (kg).
    fn energy(&self) -> [f64; 3] {
        let (fluid, gravity, c) = (&self.fluid, self.motion.gravity, &self.config);
        let rest = c.reference_density;
        let (gamma, background) = match self.motion.eos {
            AnyEos::Tait(eos) => (eos.gamma, eos.background),
            AnyEos::Linear(eos) => (1.0, eos.background),
        };
        let stiffness = c.sound_speed * c.sound_speed;
        // Two terms of the series of the compression energy: enough to notice a change of some hundredths.
        let third = (gamma - 5.0) / 6.0;
        sum(fluid.len(), |i| {
            let (x, v) = (fluid.at(i), fluid.velocity_of(i));
            let s = fluid.density[i] / rest - 1.0;
            let mut moving = stiffness * s * s * (0.5 + third * s);
            let mut all = background / rest * s / (1.0 + s);
            for a in 0..D {
                moving += 0.5 * v[a] * v[a];
                all -= gravity[a] * x[a];
            }
            let m = fluid.mass[i].to_f64();
            [m * (all + moving), m * moving, m]
        })
    }

    /// Whether more energy is there than at any of the last snapshots.
    fn check_energy(&self, [all, moving, mass]: [f64; 3]) -> std::result::Result<(), Trouble> {
        if !self.guard.closed {
            return Ok(());
        }
        let most = self
            .guard
            .memory
            .energies
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max);
        let floor = GROWTH_FLOOR * mass * self.config.sound_speed.powi(2);
        if all - most > GROWTH * moving + floor {
            return self.found(Trouble::Energy);
        }
        Ok(())
    }

    /// Whether a pair has come too close since the last snapshot.
    fn check_closeness(&self, closest: f64) -> std::result::Result<(), Trouble> {
        if closest < TOO_CLOSE && self.guard.memory.closest >= TOO_CLOSE {
            return self.found(Trouble::Closeness);
        }
        Ok(())
    }

    /// Deals with trouble: goes back, to go on with half the step (true), lets it pass (false), or stops.
    pub(super) fn goes_back(&mut self, trouble: Trouble) -> Result<bool> {
        if self.guard.snapshot.is_none() {
            return Err(self.diagnose(trouble));
        }
        match self.guard.memory.judge(trouble) {
            Verdict::Retry => {}
            Verdict::LetPass => {
                self.guard.memory.let_pass(trouble, self.step);
                return Ok(false);
            }
            Verdict::Stop => return Err(self.stop(trouble)),
        }
        let (step, time) = (self.step, self.time);
        self.put_snapshot_back();
        self.guard.memory.passes = time;
        // The failed step counts as well.
        self.guard.memory.shorten(trouble, step - self.step + 1);
        match self.prime() {
            Ok(()) => Ok(true),
            Err(trouble) => Err(self.stop(trouble)),
        }
    }

    /// The end of a run: names what is wrong, and leaves the last good state.
    pub(super) fn stop(&mut self, trouble: Trouble) -> Error {
        let error = self.diagnose(trouble);
        if self.guard.snapshot.is_some() {
            self.put_snapshot_back();
            let memory = &mut self.guard.memory;
            (memory.factor, memory.attempts, memory.calm) = (1.0, 0, 0);
        }
        error
    }
}
