//! The energy budget: what each effect has dissipated.
//!
//! Powers are summed in the middle of a step, with what its forces read, once in some steps and in all steps of a
//! collision, and integrated over time by the trapezoidal rule.

use super::config::{DiffusionForm, ViscosityForm};
use super::solver::Solver;
use super::timers::Phase;
use crate::effects::{
    Antuono, ArtificialViscosity, Contact, Diffusion, Dissipation, Fourtakas, Laminar, Molteni,
    MonaghanGingold, Morris, POWERS, RiemannDiffusion,
};
use crate::particles::sum;
use crate::simd::Real;
use crate::sweep::{Pairs, Source, slot};
use crate::walls::Slip;

/// Steps from one audit to the next.
const EVERY: u64 = 32;

/// Acceleration, in units of `c0²/Δp`, that only contacts and impacts reach.
const COLLISION: f64 = 0.01;

/// Number of entries: those of pairs, and the shift.
pub(super) const ENTRIES: usize = POWERS.len() + 1;

/// Energy that effects have taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Budget {
    /// Taken up to `time`, in J.
    pub(super) taken: [f64; ENTRIES],
    /// Powers at `time`, in W.
    pub(super) power: [f64; ENTRIES],
    /// Time of the last audit in s.
    pub(super) time: f64,
    /// Whether particles collided in the last step audited.
    pub(super) collided: bool,
}

impl Budget {
    fn book(&mut self, time: f64, power: [f64; ENTRIES]) {
        // The first powers hold from the start.
        let before = if self.time > 0.0 { self.power } else { power };
        for k in 0..ENTRIES {
            self.taken[k] += 0.5 * (before[k] + power[k]) * (time - self.time);
        }
        (self.time, self.power) = (time, power);
    }

    /// What has been taken up to `time`, in J, by name.
    pub(super) fn until(&self, time: f64) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        POWERS
            .into_iter()
            .chain(std::iter::once("particle shifting"))
            .enumerate()
            .map(move |(k, name)| (name, self.taken[k] + self.power[k] * (time - self.time)))
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Books the powers of the present step, of which half of `dt` is over, if it is its turn: in every step while
    /// particles collide, for contacts last a few steps only.
    pub(super) fn audit(&mut self, dt: f64) {
        let c = &self.config;
        let collision = COLLISION * c.sound_speed * c.sound_speed / c.spacing;
        let collides = self.state.acceleration > collision;
        if !(self.step.is_multiple_of(EVERY) || collides || self.budget.collided) {
            return;
        }
        if collides && !self.budget.collided {
            // What was found last holds up to the collision.
            self.budget.book(self.time - 0.5 * dt, self.budget.power);
        }
        self.budget.collided = collides;
        let mut power = [0.0; ENTRIES];
        power[..POWERS.len()].copy_from_slice(&self.powers());
        power[POWERS.len()] = self.power_of_shift();
        self.budget.book(self.time + 0.5 * dt, power);
        self.timers.book(Phase::Budget);
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
            damper: self.motion.bulk_viscosity,
            core: (!matches!(laminar, Some(Laminar::Morris(_))))
                .then(|| Contact::fluid(c.spacing, D, c0, rho)),
            laminar,
            contact: Contact::wall(c.spacing, D, c0, rho),
        }
    }

    /// Powers of pairs in W.
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

    /// Potential energy that the shift of the last step has taken, per time of that step, in W.
    fn power_of_shift(&self) -> f64 {
        let Some(shift) = self.fluid.shift.as_ref().filter(|_| self.time_step > 0.0) else {
            return 0.0;
        };
        let (mass, gravity) = (&self.fluid.mass, self.motion.gravity);
        let [taken] = sum(mass.len(), |i| {
            let along: f64 = (0..D).map(|a| gravity[a] * shift[a][i].to_f64()).sum();
            [mass[i].to_f64() * along]
        });
        taken / self.time_step
    }
}
