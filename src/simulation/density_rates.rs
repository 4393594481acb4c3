//! The sweep of continuity: which pair terms it fuses.

use super::assembly::{Stage, felt, matrix, outputs, slices};
use super::config::{DiffusionForm, ShiftingForm};
use super::solver::Solver;
use super::timers::Phase;
use crate::effects::{Antuono, Fourtakas, Molteni, PairTerm, RiemannDiffusion, Shift};
use crate::particles::sum;
use crate::simd::Real;
use crate::step::{DensityRate, ShiftTerm, WallDensityRate};
use crate::sweep::{Pairs, Source, SumColumns, slot};

impl<R: Real, const D: usize> Solver<R, D> {
    /// The sweep of continuity, and of the shift over the step `dt`.
    pub(super) fn sum_density_rates(&mut self, dt: f64) {
        let c = &self.config;
        let (h, c0) = (c.smoothing_length, c.sound_speed);
        match c.density_diffusion.map(|d| (d.form, d.delta)) {
            None => self.rates_with((), dt),
            Some((DiffusionForm::Molteni, delta)) => {
                self.rates_with(Molteni::new(delta, h, c0), dt)
            }
            Some((DiffusionForm::Antuono, delta)) => {
                self.rates_with(Antuono::new(delta, h, c0), dt)
            }
            Some((DiffusionForm::Riemann, delta)) => {
                self.rates_with(RiemannDiffusion::new(delta, c0), dt)
            }
            Some((DiffusionForm::Fourtakas, delta)) => {
                self.rates_with(
                    Fourtakas::<D>::new(delta, h, c0, c.gamma, self.motion.gravity),
                    dt,
                );
            }
        }
        self.timers.book(Phase::Continuity);
        self.audited(None, Self::add_facet_rates);
    }

    fn rates_with<T: PairTerm<R, D>>(&mut self, diffusion: T, dt: f64) {
        match self.shift_over(dt) {
            None => self.run_density_rates(diffusion, ()),
            Some(shift) => self.run_density_rates(diffusion, shift),
        }
    }

    /// Whether particles are shifted at the end of the present step.
    pub(super) fn shifts_now(&self) -> bool {
        let every = self.config.shifting.map(|s| u64::from(s.every.get()));
        every.is_some_and(|every| (self.step + 1).is_multiple_of(every))
    }

    /// The shift of this step of `dt`, for all steps since the last one, if it is its turn.
    pub(super) fn shift_over(&self, dt: f64) -> Option<Shift> {
        let config = self.config.shifting.filter(|_| self.shifts_now())?;
        let shift = self.shift_of_a_step(dt)?;
        Some(shift.for_steps(f64::from(config.every.get()), self.config.smoothing_length))
    }

    /// Shifting over a step of `dt` as if there were a shift in every one, if there is any.
    pub(super) fn shift_of_a_step(&self, dt: f64) -> Option<Shift> {
        let speed = self.state.speed;
        let (form, around) = self.shifting?;
        let shift = match form {
            ShiftingForm::Sun | ShiftingForm::Consistent => Shift::sun::<D>(&around, speed, dt),
            ShiftingForm::Gentle => Shift::gentle::<D>(&around, speed, dt),
            ShiftingForm::Lind => Shift::lind::<D>(&around, speed, dt),
            ShiftingForm::TransportVelocity => {
                Shift::transport_velocity::<D>(&around, speed, self.config.sound_speed, dt)
            }
        };
        Some(match around.closed {
            None => shift,
            Some(closed) => {
                let volume = &self.fluid.volume;
                let [filled] = sum(volume.len(), |i| [volume[i].to_f64()]);
                shift.keeping_volume(closed / filled - 1.0)
            }
        })
    }

    fn run_density_rates<T: PairTerm<R, D>, S: ShiftTerm<R, D>>(&mut self, diffusion: T, shift: S) {
        let reference_density = self.config.reference_density;
        let pass = DensityRate {
            diffusion,
            shift,
            reference_density,
        };
        let fluid = &mut self.fluid;
        let mut source = Source::new(&fluid.position, &fluid.cells)
            .with(slot::VOLUME, &fluid.volume)
            .with(slot::CONDENSATION, &fluid.condensation)
            .with_vector(slot::VELOCITY, &fluid.pair_velocity);
        if let Some(gradient) = &fluid.gradient {
            source = source.with_vector(slot::GRADIENT, gradient);
        }
        let wall = felt(&self.config, &self.wall).map(|w| {
            Source::new(&w.position, &w.cells)
                .with(slot::VOLUME, &w.volume)
                .with(slot::CONDENSATION, &w.condensation)
                .with_vector(slot::VELOCITY, &w.pair_velocity)
        });
        let mut columns = SumColumns::default().scalar(&mut fluid.density_rate);
        if let Some(shift) = &mut fluid.shift {
            columns = columns.gradient(slices(shift));
        }
        if fluid.sums.len() > matrix::<D>() {
            let (moment, vector) = fluid.sums.split_at_mut(matrix::<D>());
            columns = columns.moment(slices(moment)).vector(slices(vector));
        }
        let pairs = Pairs {
            grid: &self.grid,
            fluid: &source,
            wall: wall.as_ref(),
            pass: &pass,
        };
        self.sweeper.run_pairs(self.kernel, &pairs, &columns);
        // Walls that follow the equation of continuity: the same sum, over the fluid.
        if let Some(w) = &mut self.wall
            && let Some((_, rate)) = &mut w.density
        {
            let target = Source::new(&w.position, &w.cells)
                .with(slot::VOLUME, &w.volume)
                .with(slot::CONDENSATION, &w.condensation)
                .with_vector(slot::VELOCITY, &w.pair_velocity);
            let pass = WallDensityRate { reference_density };
            let stage = Stage {
                grid: &self.grid,
                sweeper: &self.sweeper,
                target: &target,
                source: &source,
            };
            stage.run(self.kernel, &pass, outputs([(0, rate)]));
        }
    }
}
