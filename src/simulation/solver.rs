//! The loop: one step is a screen.

use super::boundary::Boundary;
use super::budget::Budget;
use super::config::{Config, ShiftingForm};
use super::gravity::Gravity;
use super::guard::Guard;
use super::retry::Trouble;
use super::timers::{Phase, Timers};
use super::transport::Changes;
use crate::effects::{Stage, Surroundings};
use crate::error::{Error, Result};
use crate::kernel::KernelName;
use crate::neighbours::Grid;
use crate::particles::{Column, Fluid, Given, Moving, Wall};
use crate::simd::Real;
use crate::step::{
    Integrator, Limit, Limits, Motion, State, apply_shift, apply_shift_of_free_fluid,
    predictor_corrector, runge_kutta_2, runge_kutta_4,
};
use crate::sweep::Sweeper;
use crate::walls::{Slip, WallMethod};
use std::time::{Duration, Instant};

/// Cells are wider than the support radius by this share, so that the order lasts for some steps.
const SKIN: f64 = 0.06;

/// A named range of particles as they were given.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Whether it is fluid; else wall.
    pub fluid: bool,
    /// Ids within its set.
    pub ids: std::ops::Range<u32>,
}

/// A simulation in `D` dimensions with pairs in `R`.
pub struct Solver<R, const D: usize> {
    pub(super) config: Config,
    pub(super) bodies: Vec<Body>,
    pub(super) grid: Grid<D>,
    pub(super) fluid: Fluid<R, D>,
    pub(super) wall: Option<Wall<R, D>>,
    pub(super) boundary: Option<Boundary<R, D>>,
    pub(super) motion: Motion<D>,
    /// Where gravity depends on time.
    pub(super) gravity: Option<Gravity<D>>,
    pub(super) sweeper: Sweeper<R>,
    /// Effects that few scenes call for, behind the sweep of forces.
    pub(super) stages: Vec<Box<dyn Stage<R, D>>>,
    pub(super) limits: Limits,
    pub(super) kernel: KernelName,
    pub(super) shifting: Option<(ShiftingForm, Surroundings)>,
    /// What shifts change, in forms that ask for it.
    pub(super) transport: Option<Changes<R, D>>,
    pub(super) time: f64,
    pub(super) step: u64,
    pub(super) time_step: f64,
    pub(super) limit: Limit,
    pub(super) steps_by_limit: [u64; Limit::ALL.len()],
    pub(super) state: State,
    /// Whether rates of the present state exist.
    pub(super) primed: bool,
    /// Upper bound of the way that any particle has gone since the last sort.
    pub(super) travelled: f64,
    pub(super) skin: f64,
    pub(super) mach_max: f64,
    pub(super) budget: Budget,
    pub(super) guard: Guard<D>,
    /// What is wrong with a state that was put in from outside.
    pub(super) foreign: Option<Error>,
    pub(super) timers: Timers,
}

/// Why `advance` returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The time asked for is reached.
    Done,
    /// The number of steps is used up.
    Steps,
    /// The wall time is used up.
    Paused,
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Assembles a simulation; `fluid` and `wall` hold the bodies one after the other.
    pub fn new(
        config: Config,
        bodies: Vec<Body>,
        fluid: &Given,
        wall: &Given,
        threads: usize,
    ) -> Result<Self> {
        let h = config.smoothing_length;
        let support = h * config.kernel.support();
        let mut low = [f64::INFINITY; D];
        let mut high = [f64::NEG_INFINITY; D];
        for x in fluid
            .position
            .chunks_exact(D)
            .chain(wall.position.chunks_exact(D))
        {
            for a in 0..D {
                low[a] = low[a].min(x[a]);
                high[a] = high[a].max(x[a]);
            }
        }
        let n = fluid.mass.len() + wall.mass.len();
        let grid = Grid::new(low, high, support * (1.0 + SKIN), config.period(), n);
        let wall_config = config.wall.filter(|_| !wall.mass.is_empty());
        let mut set_of_walls = wall_config.map(|w| {
            Wall::new(
                wall,
                &grid,
                w.slip == Slip::No,
                w.method == WallMethod::Dynamic,
            )
        });
        if let Some(wall) = &mut set_of_walls
            && let (Some((density, _)), true) = (&wall.density, config.integrator.columns() > 0)
        {
            wall.stages = Some(std::array::from_fn(|_| Column::new(density.len())));
        }
        let motions = super::assembly::motions(&config, &bodies)?;
        let shifting = super::assembly::shifting::<D>(&config, fluid, !motions.is_empty());
        if let Some(set) = &mut set_of_walls
            && !motions.is_empty()
        {
            set.moving = Some(Moving::new(wall, motions));
        }
        let guard = Guard::new(&config, fluid, wall);
        let mut solver = Solver {
            stages: super::catalogue::stages(&config, fluid.mass.len()),
            gravity: Gravity::new(&config)?,
            motion: Motion {
                gravity: config.gravity(),
                eos: super::assembly::equation_of_state(&config),
                bulk_viscosity: config.acoustic_damper.unwrap_or(0.0) * h * config.sound_speed,
            },
            sweeper: {
                let per_cell = grid.edge().iter().map(|e| e / config.spacing).product();
                Sweeper::new(threads, h, per_cell, Grid::<D>::PARTS)
            },
            limits: Limits {
                courant: config.courant.unwrap_or(config.integrator.courant()),
                smoothing_length: h,
                viscous: super::assembly::longest_dissipative_step::<D>(&config),
                stages: None,
                fixed: config.time_step,
            },
            kernel: config.kernel,
            shifting,
            transport: Changes::new(&config, fluid.mass.len()),
            fluid: Fluid::new(
                fluid,
                &grid,
                super::assembly::optional_columns::<D>(&config),
            ),
            wall: set_of_walls,
            boundary: None,
            grid,
            bodies,
            config,
            time: 0.0,
            step: 0,
            time_step: 0.0,
            limit: Limit::default(),
            steps_by_limit: Default::default(),
            state: State::EMPTY,
            primed: false,
            travelled: 0.0,
            skin: SKIN * support,
            mach_max: 0.0,
            budget: Budget::default(),
            guard,
            foreign: None,
            timers: Timers::default(),
        };
        solver.keep_first();
        Ok(solver)
    }

    /// Steps until `until` exactly, or until `max_steps` or `patience` is used up; gives the steps computed, those
    /// taken back among them.
    pub fn advance(
        &mut self,
        until: f64,
        max_steps: u64,
        patience: Duration,
    ) -> Result<(u64, Progress)> {
        let (started, mut taken) = (Instant::now(), 0);
        self.refuse_foreign()?;
        if !self.primed {
            if let Err(trouble) = self.prime() {
                return Err(self.diagnose(trouble));
            }
            self.keep_first();
        }
        while self.time < until {
            if taken >= max_steps {
                return Ok((taken, Progress::Steps));
            }
            if started.elapsed() >= patience {
                return Ok((taken, Progress::Paused));
            }
            taken += 1;
            let (dt, limit, last) = self.choose_time_step(until);
            if let Err(trouble) = self.one_step(dt, limit)
                && self.goes_back(trouble)?
            {
                continue;
            }
            self.time = if last { until } else { self.time + dt };
            self.set_gravity(self.time);
            self.time_step = dt;
            self.limit = limit;
            self.steps_by_limit[limit as usize] += 1;
            self.step += 1;
            self.after_step(last)?;
            self.timers.book(Phase::Guard);
        }
        Ok((taken, Progress::Done))
    }

    /// The next time step, what limits it, and whether it ends at `until`.
    fn choose_time_step(&self, until: f64) -> (f64, Limit, bool) {
        let sound = self.motion.sound_speed(self.state.density_max);
        let (dt, limit) = self
            .limits
            .time_step(sound, self.state.speed, self.state.acceleration);
        let (dt, limit) = self.guard.shorten(dt, limit);
        let left = until - self.time;
        if dt >= left {
            (left, Limit::Output, true)
        } else if 2.0 * dt > left && self.limits.fixed.is_none() {
            // Two even steps rather than a long and a tiny one.
            (0.5 * left, Limit::Output, false)
        } else {
            (dt, limit, false)
        }
    }

    /// Rates of the state at the start, so that the first step is like all others.
    pub(super) fn prime(&mut self) -> std::result::Result<(), Trouble> {
        self.timers.start();
        self.set_gravity(self.time);
        self.move_walls(self.time);
        self.sort(false);
        if !self.motion.first_half(&mut self.fluid, 0.0) {
            return Err(Trouble::NotFinite);
        }
        self.update_walls();
        self.sum_forces();
        self.run_stages();
        self.motion.second_half(&mut self.fluid, 0.0);
        self.sum_density_rates(0.0);
        self.state = self.motion.finish(&mut self.fluid, 0.0);
        self.check(0.0)?;
        self.primed = true;
        Ok(())
    }

    /// One step of `dt`: the integrator → shift → check.
    fn one_step(&mut self, dt: f64, limit: Limit) -> std::result::Result<(), Trouble> {
        self.timers.start();
        if self.hopeless(dt, limit) {
            return Err(Trouble::TimeStep);
        }
        match self.config.integrator {
            Integrator::Symplectic => self.symplectic(dt)?,
            Integrator::PredictorCorrector => predictor_corrector(self, dt)?,
            Integrator::RungeKutta2 => runge_kutta_2(self, dt)?,
            Integrator::RungeKutta4 => runge_kutta_4(self, dt)?,
        }
        if self.shifts_now() {
            self.shift();
        }
        self.end_audit(dt);
        self.keep_inside(self.time + dt);
        self.check(dt)
    }

    /// Moves particles by their shift.
    fn shift(&mut self) {
        self.sum_transport();
        let longest = match &self.fluid.shift {
            None => return,
            Some(_) if self.is_free() => apply_shift_of_free_fluid(&mut self.fluid),
            Some(shift) => apply_shift(&mut self.fluid.position, shift),
        };
        self.apply_transport();
        self.state.finite &= longest.is_finite();
        self.travelled += longest;
        self.timers.book(Phase::Shift);
    }

    /// The default: sort → drift → walls → forces → kick and drift → continuity → drift of density.
    fn symplectic(&mut self, dt: f64) -> std::result::Result<(), Trouble> {
        if 2.0 * (self.travelled + 1.5 * dt * self.state.speed) > self.skin {
            self.sort(false);
        }
        self.set_gravity(self.time + 0.5 * dt);
        if !self.motion.first_half(&mut self.fluid, dt) {
            return Err(Trouble::NotFinite);
        }
        self.travelled += 0.5 * dt * self.state.speed;
        self.timers.book(Phase::Integrate);
        self.move_walls(self.time + 0.5 * dt);
        self.update_walls();
        self.begin_audit();
        self.sum_forces();
        self.run_stages();
        self.audit_pairs();
        let speed = self.motion.second_half(&mut self.fluid, dt);
        self.travelled += 0.5 * dt * speed;
        self.timers.book(Phase::Integrate);
        if 2.0 * self.travelled > self.skin {
            self.sort(true);
        }
        self.move_walls(self.time + dt);
        self.sum_density_rates(dt);
        self.advance_walls(dt);
        self.state = self.motion.finish(&mut self.fluid, dt);
        self.timers.book(Phase::Integrate);
        Ok(())
    }

    /// Walls as they are prescribed at `time`.
    pub(super) fn move_walls(&mut self, time: f64) {
        if let Some(wall) = &mut self.wall
            && wall.moving.is_some()
        {
            wall.move_to(time, &self.grid, self.skin);
            self.move_ghosts();
            self.timers.book(Phase::Walls);
        }
    }

    pub(super) fn sort(&mut self, mid_step: bool) {
        self.fluid.sort(&self.grid, mid_step);
        if mid_step {
            for stage in &mut self.stages {
                stage.follow(&mut self.fluid);
            }
        }
        self.travelled = 0.0;
        self.timers.book(Phase::Sort);
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Simulated time in s.
    pub fn now(&self) -> f64 {
        self.time
    }

    /// Time by phase.
    pub fn timers(&self) -> &Timers {
        &self.timers
    }
}
