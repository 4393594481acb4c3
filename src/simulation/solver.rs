//! The loop: one step is a screen.

use super::budget::Budget;
use super::config::{Config, ShiftingForm, ViscosityForm};
use super::gravity::Gravity;
use super::timers::{Phase, Timers};
use crate::effects::{Surroundings, fastest_decay};
use crate::error::{Error, Instability, Result};
use crate::kernel::KernelName;
use crate::neighbours::Grid;
use crate::particles::{Fluid, Given, Moving, Wall};
use crate::simd::Real;
use crate::step::{Limit, Limits, Motion, State, apply_shift, apply_shift_of_free_fluid};
use crate::sweep::Sweeper;
use crate::walls::{Slip, WallMethod};
use std::time::{Duration, Instant};

/// Cells are wider than the support radius by this share, so that the order lasts for some steps.
const SKIN: f64 = 0.06;
/// Largest stable Courant number of the symplectic step, times a margin.
const COURANT: f64 = 0.5;

/// Share of the stability limit (a decay of 1 per step) that a viscous step uses.
const VISCOUS: f64 = 0.8;

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
    pub(super) motion: Motion<D>,
    /// Where gravity depends on time.
    pub(super) gravity: Option<Gravity<D>>,
    pub(super) sweeper: Sweeper<R>,
    pub(super) limits: Limits,
    pub(super) kernel: KernelName,
    pub(super) shifting: Option<(ShiftingForm, Surroundings)>,
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
        let motions = super::assembly::motions(&config, &bodies)?;
        if let Some(set) = &mut set_of_walls
            && !motions.is_empty()
        {
            set.moving = Some(Moving::new(wall, motions));
        }
        Ok(Solver {
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
                courant: config.courant.unwrap_or(COURANT),
                smoothing_length: h,
                viscous: config.laminar_viscosity.map_or(f64::INFINITY, |v| {
                    let angular = v.form == ViscosityForm::MonaghanGingold;
                    let decay = fastest_decay::<D>(config.kernel, h, config.spacing, angular);
                    VISCOUS / (v.kinematic * decay)
                }),
                fixed: config.time_step,
            },
            kernel: config.kernel,
            shifting: super::assembly::shifting::<D>(&config),
            fluid: Fluid::new(
                fluid,
                &grid,
                super::assembly::optional_columns::<D>(&config),
            ),
            wall: set_of_walls,
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
            timers: Timers::default(),
        })
    }

    /// Steps until `until` exactly, or until `max_steps` or `patience` is used up.
    pub fn advance(
        &mut self,
        until: f64,
        max_steps: u64,
        patience: Duration,
    ) -> Result<(u64, Progress)> {
        let (started, first) = (Instant::now(), self.step);
        if !self.primed {
            self.prime()?;
        }
        while self.time < until {
            if self.step - first >= max_steps {
                return Ok((self.step - first, Progress::Steps));
            }
            if started.elapsed() >= patience {
                return Ok((self.step - first, Progress::Paused));
            }
            let (dt, limit, last) = self.choose_time_step(until);
            self.one_step(dt)?;
            self.time = if last { until } else { self.time + dt };
            self.set_gravity(self.time);
            self.time_step = dt;
            self.limit = limit;
            self.steps_by_limit[limit as usize] += 1;
            self.step += 1;
        }
        Ok((self.step - first, Progress::Done))
    }

    /// The next time step, what limits it, and whether it ends at `until`.
    fn choose_time_step(&self, until: f64) -> (f64, Limit, bool) {
        let sound = self.motion.sound_speed(self.state.density_max);
        let (dt, limit) = self
            .limits
            .time_step(sound, self.state.speed, self.state.acceleration);
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
    fn prime(&mut self) -> Result<()> {
        self.timers.start();
        self.set_gravity(self.time);
        self.move_walls(self.time);
        self.sort(false);
        if !self.motion.first_half(&mut self.fluid, 0.0) {
            return Err(self.trouble());
        }
        self.update_walls();
        self.sum_forces();
        self.motion.second_half(&mut self.fluid, 0.0);
        self.sum_density_rates(0.0);
        self.state = self.motion.finish(&mut self.fluid, 0.0);
        self.check()?;
        self.primed = true;
        Ok(())
    }

    /// One step of `dt`: sort → drift → walls → forces → kick and drift → continuity → check.
    fn one_step(&mut self, dt: f64) -> Result<()> {
        self.timers.start();
        if 2.0 * (self.travelled + 1.5 * dt * self.state.speed) > self.skin {
            self.sort(false);
        }
        self.set_gravity(self.time + 0.5 * dt);
        if !self.motion.first_half(&mut self.fluid, dt) {
            return Err(self.trouble());
        }
        self.travelled += 0.5 * dt * self.state.speed;
        self.timers.book(Phase::Integrate);
        self.move_walls(self.time + 0.5 * dt);
        self.update_walls();
        self.sum_forces();
        self.audit(dt);
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
        if let Some(shift) = &self.fluid.shift {
            self.travelled += if self.wall.is_none() && !self.grid.is_periodic() {
                apply_shift_of_free_fluid(&mut self.fluid)
            } else {
                apply_shift(&mut self.fluid.position, shift)
            };
            self.timers.book(Phase::Shift);
        }
        self.check()?;
        self.timers.book(Phase::Guard);
        Ok(())
    }

    /// Walls as they are prescribed at `time`.
    pub(super) fn move_walls(&mut self, time: f64) {
        if let Some(wall) = &mut self.wall
            && wall.moving.is_some()
        {
            wall.move_to(time, &self.grid, self.skin);
            self.timers.book(Phase::Walls);
        }
    }

    fn sort(&mut self, mid_step: bool) {
        self.fluid.sort(&self.grid, mid_step);
        self.travelled = 0.0;
        self.timers.book(Phase::Sort);
    }

    /// Stops at what is not finite or not physical.
    fn check(&mut self) -> Result<()> {
        let reference = self.config.reference_density;
        let mach = self.state.speed / self.config.sound_speed;
        self.mach_max = self.mach_max.max(mach);
        let density_ok =
            self.state.density_min > 0.5 * reference && self.state.density_max < 1.5 * reference;
        if (self.state.finite && density_ok) || self.fluid.is_empty() {
            return Ok(());
        }
        Err(self.trouble())
    }

    /// What is wrong with the particle that is most wrong: numbers that are not finite in the state come before those
    /// that follow from them, and among equals the lowest id.
    fn trouble(&self) -> Error {
        let fluid = &self.fluid;
        let reference = self.config.reference_density;
        let mut found: Option<(usize, u32, usize, &'static str, f64)> = None;
        for i in 0..fluid.len() {
            let (x, v, density) = (fluid.at(i), fluid.velocity_of(i), fluid.density[i]);
            let rates: [f64; D] = std::array::from_fn(|a| fluid.acceleration[a][i].to_f64());
            let outside = density <= 0.5 * reference || density >= 1.5 * reference;
            let suspects: [(&'static str, &[f64], bool); 6] = [
                ("position", &x, false),
                ("velocity", &v, false),
                ("density", &[density], false),
                ("acceleration", &rates, false),
                ("rate of density", &[fluid.density_rate[i].to_f64()], false),
                ("density", &[density], outside),
            ];
            for (rank, (quantity, values, wrong)) in suspects.into_iter().enumerate() {
                let value = values.iter().copied().find(|v| wrong || !v.is_finite());
                if let Some(value) = value
                    && found.is_none_or(|f| (rank, fluid.id[i]) < (f.0, f.1))
                {
                    found = Some((rank, fluid.id[i], i, quantity, value));
                }
            }
        }
        let (_, particle, i, quantity, value) = found.unwrap_or((0, 0, 0, "state", f64::NAN));
        let (cause, remedy) = if value.is_finite() {
            (
                format!(
                    "the density left the range of a weakly compressible fluid (0.5 to 1.5 of {reference}); the \
                     largest speed was {:.3e} m/s at a sound speed of {:.3e} m/s",
                    self.state.speed, self.config.sound_speed
                ),
                "raise the sound speed, or lower the Courant number or the time step".to_owned(),
            )
        } else {
            (
                "a number that is not finite, from a time step too long for the flow or from the input".to_owned(),
                "lower the Courant number or the time step; check the initial state".to_owned(),
            )
        };
        Error::Instability(Box::new(Instability {
            time: self.time,
            step: self.step,
            particle,
            position: fluid.at(i).to_vec(),
            quantity,
            value,
            cause,
            remedy,
        }))
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
