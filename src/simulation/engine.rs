//! A simulation of any dimension and precision, with threads of its own.

use super::checkpoint::Entries;
use super::config::Config;
use super::diagnostics::Diagnostics;
use super::retry::Retries;
use super::sample::Sample;
use super::solver::{Body, Progress, Solver};
use super::surfaces::{SurfaceInput, check_mirrors, check_surfaces, facets};
use crate::error::{Error, Result};
use crate::particles::Given;
use crate::prescribed::Pose;
use crate::simd::Real;
use crate::step::Limit;
use std::time::Duration;

/// The precision of pair arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Everything in double precision.
    F64,
    /// State in double precision, pairs in single precision relative to their cell.
    Mixed,
}

/// A body with its particles.
#[derive(Clone, Debug)]
pub struct BodyInput {
    /// Its name.
    pub name: String,
    /// Whether it is fluid; else wall.
    pub fluid: bool,
    /// Its particles.
    pub particles: Given,
}

/// The arrays of a body in the order in which its particles were given, vectors flattened.
#[derive(Clone, Debug, Default)]
pub struct BodyState {
    /// Positions in m.
    pub position: Vec<f64>,
    /// Velocities in m/s.
    pub velocity: Vec<f64>,
    /// Densities in kg/m³.
    pub density: Vec<f64>,
    /// Pressures in Pa; of a wall: those extrapolated from the fluid.
    pub pressure: Vec<f64>,
    /// Masses in kg.
    pub mass: Vec<f64>,
}

/// Fields at points, vectors flattened.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    /// Pressures in Pa.
    pub pressure: Vec<f64>,
    /// Densities in kg/m³.
    pub density: Vec<f64>,
    /// Velocities in m/s.
    pub velocity: Vec<f64>,
    /// `Σ V W` over the fluid.
    pub fill: Vec<f64>,
    /// `Σ V W` over the particles of walls.
    pub wall_fill: Vec<f64>,
}

/// An effect as a scene has it.
#[derive(Clone, Debug)]
pub struct EffectState {
    /// Its name.
    pub name: &'static str,
    /// Whether it runs.
    pub on: bool,
    /// Columns that only it needs.
    pub columns: Vec<&'static str>,
    /// Their bytes per particle.
    pub bytes_per_particle: usize,
    /// Sweeps over pairs of its own in each step.
    pub sweeps: usize,
    /// The time-step criterion that it brings.
    pub limit: Option<Limit>,
    /// What it turns into heat; empty for nothing.
    pub dissipates: &'static str,
    /// Where its formula comes from.
    pub source: &'static str,
}

/// What every solver can do, whatever its dimension and precision.
trait Engine: Send + Sync {
    fn advance(
        &mut self,
        until: f64,
        max_steps: u64,
        patience: Duration,
    ) -> Result<(u64, Progress)>;
    fn body(&self, body: &Body) -> BodyState;
    fn diagnostics(&self) -> Diagnostics;
    fn sample(&self, points: &[f64]) -> Samples;
    fn force_on(&self, ids: &std::ops::Range<u32>) -> (Vec<f64>, Vec<f64>);
    fn pose(&self, body: &Body) -> Option<Pose>;
    fn save(&self) -> Entries;
    fn restore(&mut self, entries: &Entries) -> Result<()>;
    fn status(&self) -> Status;
    fn timings(&self) -> Vec<(&'static str, f64, u64)>;
    fn memory(&self) -> Vec<(&'static str, usize)>;
    fn effects(&self) -> Vec<EffectState>;
    fn bodies(&self) -> &[Body];
}

/// Where a simulation stands.
#[derive(Clone, Copy, Debug)]
pub struct Status {
    /// Simulated time in s.
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// The last time step in s.
    pub time_step: f64,
    /// What limited it.
    pub limit: Limit,
    /// Steps by limit, in the order of [`Limit::ALL`].
    pub steps_by_limit: [u64; Limit::ALL.len()],
    /// Largest Mach number so far.
    pub mach_max: f64,
    /// What the guard did.
    pub retries: Retries,
    /// Time of the state that it keeps, in s.
    pub kept: Option<f64>,
    /// Fluid particles.
    pub fluid: usize,
    /// Wall particles.
    pub wall: usize,
}

impl<R: Real, const D: usize> Engine for Solver<R, D> {
    fn advance(
        &mut self,
        until: f64,
        max_steps: u64,
        patience: Duration,
    ) -> Result<(u64, Progress)> {
        Solver::advance(self, until, max_steps, patience)
    }
    fn body(&self, body: &Body) -> BodyState {
        self.body_state(body)
    }
    fn diagnostics(&self) -> Diagnostics {
        Solver::diagnostics(self)
    }
    fn sample(&self, points: &[f64]) -> Samples {
        let points: Vec<[f64; D]> = points
            .chunks_exact(D)
            .map(|p| std::array::from_fn(|a| p[a]))
            .collect();
        let samples: Vec<Sample<D>> = Solver::sample(self, &points);
        Samples {
            pressure: samples.iter().map(|s| s.pressure).collect(),
            density: samples.iter().map(|s| s.density).collect(),
            velocity: samples.iter().flat_map(|s| s.velocity).collect(),
            fill: samples.iter().map(|s| s.fill).collect(),
            wall_fill: samples.iter().map(|s| s.wall_fill).collect(),
        }
    }
    fn force_on(&self, ids: &std::ops::Range<u32>) -> (Vec<f64>, Vec<f64>) {
        let (force, moment) = Solver::force_on(self, ids);
        (force.to_vec(), moment)
    }
    fn pose(&self, body: &Body) -> Option<Pose> {
        let moving = self.wall.as_ref()?.moving.as_ref()?;
        moving.pose(body.ids.start, self.now())
    }
    fn save(&self) -> Entries {
        Solver::save(self)
    }
    fn restore(&mut self, entries: &Entries) -> Result<()> {
        Solver::restore(self, entries)
    }
    fn status(&self) -> Status {
        Solver::status(self)
    }
    fn timings(&self) -> Vec<(&'static str, f64, u64)> {
        self.timers.report().collect()
    }
    fn memory(&self) -> Vec<(&'static str, usize)> {
        Solver::memory(self)
    }
    fn effects(&self) -> Vec<EffectState> {
        Solver::effects(self)
    }
    fn bodies(&self) -> &[Body] {
        &self.bodies
    }
}

/// A simulation.
pub struct Simulation {
    engine: Box<dyn Engine>,
    pool: rayon::ThreadPool,
    dimension: usize,
    precision: Precision,
}

impl Simulation {
    /// Assembles the simulation that `config` and `bodies` describe, on `threads` threads (0: all cores).
    ///
    /// # Errors
    /// Numbers out of range, arrays that do not fit or are not finite, no fluid at all.
    pub fn new(
        config: Config,
        bodies: Vec<BodyInput>,
        precision: Precision,
        threads: usize,
    ) -> Result<Self> {
        Self::with_surfaces(config, bodies, &[], precision, threads)
    }

    /// The same with surfaces of walls, through which no particle passes.
    ///
    /// # Errors
    /// As [`Self::new`]; a surface that is none, or none where the walls' method needs one.
    pub fn with_surfaces(
        config: Config,
        bodies: Vec<BodyInput>,
        surfaces: &[SurfaceInput],
        precision: Precision,
        threads: usize,
    ) -> Result<Self> {
        config.validate()?;
        let dimension = config.dimension;
        let mut fluid = Given::default();
        let mut wall = Given::default();
        let mut table: Vec<Body> = Vec::new();
        for body in bodies {
            body.particles.validate(&body.name, dimension)?;
            if table.iter().any(|b| b.name == body.name) {
                return Err(Error::Input(format!(
                    "bodies: two are named {:?}; give each its own name",
                    body.name
                )));
            }
            let set = if body.fluid { &mut fluid } else { &mut wall };
            let first = set.mass.len() as u32;
            set.append(&body.particles);
            if set.mass.len() > (u32::MAX / 8) as usize {
                return Err(Error::Input(format!(
                    "bodies: more than {} particles",
                    u32::MAX / 8
                )));
            }
            table.push(Body {
                name: body.name,
                fluid: body.fluid,
                ids: first..set.mass.len() as u32,
            });
        }
        if fluid.mass.is_empty() {
            return Err(Error::Input(
                "bodies: there is no fluid particle; add a fluid".to_owned(),
            ));
        }
        check_surfaces(&config, &table, surfaces)?;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|k| format!("kolk-{k}"))
            .build()
            .map_err(|e| Error::Input(format!("threads: {threads} could not be started: {e}")))?;
        let threads = pool.current_num_threads();
        let engine: Box<dyn Engine> = pool.install(|| -> Result<Box<dyn Engine>> {
            macro_rules! solver {
                ($real:ty, $dimension:literal) => {{
                    let facets = facets(&table, surfaces);
                    check_mirrors::<$dimension>(&config, &table, &facets)?;
                    let solver =
                        Solver::<$real, $dimension>::new(config, table, &fluid, &wall, threads)?;
                    Box::new(solver.with_surface(facets))
                }};
            }
            Ok(match (dimension, precision) {
                (2, Precision::F64) => solver!(f64, 2),
                (2, Precision::Mixed) => solver!(f32, 2),
                (_, Precision::F64) => solver!(f64, 3),
                (_, Precision::Mixed) => solver!(f32, 3),
            })
        })?;
        Ok(Simulation {
            engine,
            pool,
            dimension,
            precision,
        })
    }

    /// Steps until the time `until` (s) exactly, or until `max_steps` or the wall time `patience` is used up.
    ///
    /// # Errors
    /// [`Error::Instability`] when the state can no longer be trusted.
    pub fn advance(
        &mut self,
        until: f64,
        max_steps: u64,
        patience: Duration,
    ) -> Result<(u64, Progress)> {
        let engine = &mut self.engine;
        self.pool
            .install(|| engine.advance(until, max_steps, patience))
    }

    /// The arrays of a body.
    pub fn body(&self, name: &str) -> Result<BodyState> {
        let body = self.find(name)?;
        Ok(self.engine.body(body))
    }

    fn find(&self, name: &str) -> Result<&Body> {
        let bodies = self.engine.bodies();
        bodies.iter().find(|b| b.name == name).ok_or_else(|| {
            let names: Vec<_> = bodies.iter().map(|b| b.name.as_str()).collect();
            Error::Input(format!(
                "body: there is no {name:?}; there are {}",
                names.join(", ")
            ))
        })
    }

    /// Sums and extremes of the state.
    pub fn diagnostics(&self) -> Diagnostics {
        self.pool.install(|| self.engine.diagnostics())
    }

    /// Fields at points, flattened.
    pub fn sample(&self, points: &[f64]) -> Samples {
        self.pool.install(|| self.engine.sample(points))
    }

    /// Force (N) and moment about the origin (N m) of the fluid on a wall body.
    pub fn force_on(&self, name: &str) -> Result<(Vec<f64>, Vec<f64>)> {
        let body = self.find(name)?;
        if body.fluid {
            return Err(Error::Input(format!(
                "body: {name:?} is a fluid; forces are summed on walls"
            )));
        }
        Ok(self.pool.install(|| self.engine.force_on(&body.ids)))
    }

    /// Where a wall body in prescribed motion is and how it moves; `None` for one at rest.
    pub fn pose(&self, name: &str) -> Result<Option<Pose>> {
        let body = self.find(name)?;
        Ok((!body.fluid).then(|| self.engine.pose(body)).flatten())
    }

    /// The whole state.
    pub fn save(&self) -> Entries {
        self.engine.save()
    }

    /// Goes on from a saved state of the same scene.
    pub fn restore(&mut self, entries: &Entries) -> Result<()> {
        self.engine.restore(entries)
    }

    /// Where it stands.
    pub fn status(&self) -> Status {
        self.engine.status()
    }

    /// Name, seconds and calls of each phase.
    pub fn timings(&self) -> Vec<(&'static str, f64, u64)> {
        self.engine.timings()
    }

    /// Bytes held, by what they serve.
    pub fn memory(&self) -> Vec<(&'static str, usize)> {
        self.engine.memory()
    }

    /// All effects that the engine knows, on or off.
    pub fn effects(&self) -> Vec<EffectState> {
        self.engine.effects()
    }

    /// 2 or 3.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Precision of pairs.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Threads in use.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }
}
