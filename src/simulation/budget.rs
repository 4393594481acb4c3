//! The energy budget: what each effect has dissipated.
//!
//! Powers are summed in the middle of a step, with what its forces read, and integrated over time by the trapezoidal
//! rule. That costs half a step: it is done rarely where powers change little, and often where they jump, for contacts
//! and impacts last a few steps only.

use super::assembly::matrix;
use super::catalogue::MOST_STAGES;
use super::config::{DiffusionForm, ViscosityForm};
use super::solver::Solver;
use super::timers::Phase;
use crate::effects::{
    Antuono, ArtificialViscosity, Diffusion, Dissipation, Fourtakas, Laminar, Molteni,
    MonaghanGingold, Morris, POWERS, RiemannDiffusion, WALL_POWER,
};
use crate::eos::EquationOfState;
use crate::particles::sum;
use crate::simd::Real;
use crate::sweep::{Pairs, Source, Sums, slot};
use crate::walls::Slip;

/// Most steps from one audit to the next.
const LONGEST: u64 = 32;
/// There are no more audits than one in so many steps, and some ahead of their time: each costs half a step.
const ON_AVERAGE: u64 = 24;
const AHEAD: u64 = 8;
/// Change of the powers over an interval, times its length, as a share of all that was taken so far, beyond which the
/// next interval is an eighth of it; below a quarter of that it is twice as long.
const TOLERANCE: f64 = 0.01;

/// The entry of shifting, and the first of stages.
const SHIFTING: usize = POWERS.len() - 1;
const STAGES: usize = POWERS.len();

/// Number of entries: those of pairs, and as many stages as a scene may have.
const ENTRIES: usize = STAGES + MOST_STAGES;

/// Energy that effects have taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Budget {
    /// Taken up to `time`, in J.
    taken: [f64; ENTRIES],
    /// Powers at `time`, in W.
    power: [f64; ENTRIES],
    /// Time of the last audit in s.
    time: f64,
    /// Steps from one audit to the next.
    interval: u64,
    /// The step of the next audit.
    next: u64,
    /// Audits so far.
    audits: u64,
    /// Power of contact and pressure at walls in the present step, in W.
    pub(super) walls: f64,
    /// Whether what runs now is audited.
    pub(super) listens: bool,
    /// Powers of the present step, if it is audited.
    audit: Option<[f64; ENTRIES]>,
}

impl Budget {
    /// As many numbers as it is saved in.
    pub(super) const NUMBERS: usize = 2 * ENTRIES + 4;

    /// To be saved between two steps.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let counts = [self.interval, self.next, self.audits].map(|n| n as f64);
        let sums = self.taken.into_iter().chain(self.power);
        sums.chain([self.time]).chain(counts)
    }

    /// As it was saved.
    pub(super) fn saved(numbers: &[f64]) -> Self {
        let rest = &numbers[2 * ENTRIES..];
        Budget {
            taken: std::array::from_fn(|k| numbers[k]),
            power: std::array::from_fn(|k| numbers[ENTRIES + k]),
            time: rest[0],
            interval: rest[1] as u64,
            next: rest[2] as u64,
            audits: rest[3] as u64,
            walls: 0.0,
            listens: false,
            audit: None,
        }
    }

    fn book(&mut self, time: f64, power: [f64; ENTRIES]) {
        // The first powers hold from the start.
        let before = if self.time > 0.0 { self.power } else { power };
        let (mut taken, mut change) = (0.0, 0.0);
        for k in 0..ENTRIES {
            let half = 0.5 * (time - self.time);
            self.taken[k] += half * (before[k] + power[k]);
            taken += self.taken[k].abs();
            change += half * (power[k] - before[k]).abs();
        }
        (self.time, self.power) = (time, power);
        if change > TOLERANCE * taken {
            self.interval = (self.interval / 8).max(1);
        } else if change < 0.25 * TOLERANCE * taken {
            self.interval = (2 * self.interval).clamp(1, LONGEST);
        }
        self.audits += 1;
        let earned = ON_AVERAGE * self.audits.saturating_sub(AHEAD);
        self.next = (self.next + self.interval).max(earned);
    }

    /// What has been taken up to `time`, in J, by entry.
    fn until(&self, time: f64) -> [f64; ENTRIES] {
        std::array::from_fn(|k| self.taken[k] + self.power[k] * (time - self.time))
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// What effects have taken so far, in J, by name.
    pub(super) fn dissipated(&self) -> Vec<(&'static str, f64)> {
        let stages = self.stages.iter().map(|s| s.declaration().name);
        POWERS
            .into_iter()
            .chain(stages)
            .zip(self.budget.until(self.time))
            .filter(|&(_, energy)| energy != 0.0)
            .collect()
    }

    /// Begins the audit of a step, if it is its turn: of a step with a shift, then of one after it, and so on, for what a
    /// shift disorders is taken in the steps that follow.
    pub(super) fn begin_audit(&mut self) {
        let every = self.config.shifting.map_or(1, |s| u64::from(s.every.get()));
        let turn = (self.step + 1 + self.budget.audits).is_multiple_of(every);
        if turn && self.step >= self.budget.next {
            self.budget.next = self.step;
            self.budget.audit = Some([0.0; ENTRIES]);
            self.budget.listens = true;
        }
    }

    /// Sums the powers of pairs in the middle of the step, with what its forces have read.
    pub(super) fn audit_pairs(&mut self) {
        if self.budget.audit.is_some() {
            let powers = self.powers();
            self.take(0, &powers);
            self.timers.book(Phase::Budget);
        }
    }

    /// Books what walls took in a step of `dt`, and ends its audit, after its shift.
    pub(super) fn end_audit(&mut self, dt: f64) {
        self.budget.taken[WALL_POWER] += self.budget.walls * dt;
        if self.budget.audit.is_none() {
            return;
        }
        // Between shifts as at the last.
        let shifted = if self.shifts_now() {
            self.power_of_shift(dt) + self.power_of_following()
        } else {
            self.budget.power[SHIFTING]
        };
        self.take(SHIFTING, &[shifted]);
        self.budget.listens = false;
        if let Some(power) = self.budget.audit.take() {
            self.budget.book(self.time + 0.5 * dt, power);
        }
        self.timers.book(Phase::Budget);
    }

    fn take(&mut self, first: usize, powers: &[f64]) {
        for power in self.budget.audit.iter_mut() {
            for (entry, p) in power[first..].iter_mut().zip(powers) {
                *entry += p;
            }
        }
    }

    /// Runs what adds to accelerations or rates of density, and in an audit books what it takes as that of stage `k`, or
    /// of the walls.
    pub(super) fn audited(&mut self, stage: Option<usize>, run: impl FnOnce(&mut Self)) {
        if !self.budget.listens {
            return run(self);
        }
        let before = self.mechanical_power();
        run(self);
        let entry = stage.map_or(WALL_POWER, |k| STAGES + k);
        self.take(entry, &[before - self.mechanical_power()]);
    }

    /// `Σ m u·a + Σ V p/ρ dρ/dt` in W, with the velocity and the pressure that the last sweep has read.
    fn mechanical_power(&self) -> f64 {
        let f = &self.fluid;
        let rho = self.config.reference_density;
        let [power] = sum(f.len(), |i| {
            let along: f64 = (0..D)
                .map(|a| f.pair_velocity[a][i].to_f64() * f.acceleration[a][i].to_f64())
                .sum();
            let density = rho * (1.0 + f.condensation[i].to_f64());
            let pressure: R = self.motion.eos.pressure(f.condensation[i]);
            let squeezed = pressure.to_f64() * f.density_rate[i].to_f64() / density;
            [f.mass[i].to_f64() * along + f.volume[i].to_f64() * squeezed]
        });
        power
    }

    /// Energy that density takes as it follows the concentration of particles beneath a free surface, in W; what it takes
    /// elsewhere is summed over pairs.
    fn power_of_following(&self) -> f64 {
        let fluid = &self.fluid;
        let shift = self.shift_of_a_step(0.0).filter(|s| s.keeps_a_surface());
        let Some(shift) = shift else {
            return 0.0;
        };
        let [power] = sum(fluid.len(), |i| {
            let mut sums = Sums::<R, D>::zero();
            for (k, column) in fluid.sums[..matrix::<D>()].iter().enumerate() {
                sums.moment[k] = column[i];
            }
            let pressure: R = self.motion.eos.pressure(fluid.condensation[i]);
            let source = shift.source(&sums, shift.surroundings(&sums));
            let stored = fluid.volume[i] * pressure * source;
            [-stored.to_f64() / (1.0 + fluid.condensation[i].to_f64())]
        });
        power
    }

    /// The effects of the scene whose powers are summed.
    fn dissipation(&self) -> Dissipation<D> {
        let c = &self.config;
        let (h, rho, c0) = (c.smoothing_length, c.reference_density, c.sound_speed);
        let artificial = c
            .artificial_viscosity
            .map(|v| ArtificialViscosity::new(v.alpha, v.beta, c0, h, rho));
        let laminar = c.laminar_viscosity.map(|v| match v.form {
            ViscosityForm::Morris if artificial.is_none() => {
                Laminar::Morris(Morris::new(v.kinematic, h, rho))
            }
            _ => Laminar::MonaghanGingold(MonaghanGingold::new(v.kinematic, h, rho)),
        });
        Dissipation {
            artificial,
            friction: c.wall.is_some_and(|w| w.slip == Slip::No),
            diffusion: c.density_diffusion.map(|d| match d.form {
                DiffusionForm::Molteni => Diffusion::Molteni(Molteni::new(d.delta, h, c0)),
                DiffusionForm::Antuono => Diffusion::Antuono(Antuono::new(d.delta, h, c0)),
                DiffusionForm::Riemann => Diffusion::Riemann(RiemannDiffusion::new(d.delta, c0)),
                DiffusionForm::Fourtakas => Diffusion::Fourtakas(Fourtakas::new(
                    d.delta,
                    h,
                    c0,
                    c.gamma,
                    self.motion.gravity,
                )),
            }),
            following: self.shift_of_a_step(0.0).filter(|s| !s.keeps_a_surface()),
            damper: self.motion.bulk_viscosity,
            core: (!matches!(laminar, Some(Laminar::Morris(_))))
                .then(|| super::assembly::core::<D>(c)),
            laminar,
        }
    }

    /// The powers of pairs, in W.
    fn powers(&self) -> [f64; POWERS.len()] {
        let fluid = &self.fluid;
        let mut source = Source::new(&fluid.position, &fluid.cells)
            .with(slot::VOLUME, &fluid.volume)
            .with(slot::PRESSURE, &fluid.pressure)
            .with(slot::CONDENSATION, &fluid.condensation)
            .with_vector(slot::VELOCITY, &fluid.pair_velocity)
            .with(slot::RATE, &fluid.density_rate);
        if let Some(gradient) = &fluid.gradient {
            source = source.with_vector(slot::GRADIENT, gradient);
        }
        let wall = self.wall.as_ref().map(|w| {
            let velocity = w.slip_velocity.as_ref().unwrap_or(&w.pair_velocity);
            Source::new(&w.position, &w.cells)
                .with(slot::VOLUME, &w.volume)
                .with(slot::PRESSURE, &w.pressure)
                .with(slot::CONDENSATION, &w.condensation)
                .with_vector(slot::VELOCITY, velocity)
                .with_vector(slot::GRADIENT, &w.pair_velocity)
        });
        let pairs = Pairs {
            grid: &self.grid,
            fluid: &source,
            wall: wall.as_ref(),
            pass: &self.dissipation(),
        };
        self.sweeper.total(self.kernel, &pairs)
    }

    /// Energy that the shift over `dt` has taken, per time, in W: potential energy, and what particles took along.
    fn power_of_shift(&self, dt: f64) -> f64 {
        let Some(shift) = self.fluid.shift.as_ref().filter(|_| dt > 0.0) else {
            return 0.0;
        };
        let (mass, gravity) = (&self.fluid.mass, self.motion.gravity);
        let [taken] = sum(mass.len(), |i| {
            let along: f64 = (0..D).map(|a| gravity[a] * shift[a][i].to_f64()).sum();
            [mass[i].to_f64() * along]
        });
        let steps = self.config.shifting.map_or(1, |s| s.every.get());
        (taken - self.energy_transported()) / (dt * f64::from(steps))
    }
}
