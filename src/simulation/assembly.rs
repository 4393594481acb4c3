//! From a configuration to the passes of a step: which pair terms the sweep of forces fuses (`density_rates.rs`: that of
//! continuity; `catalogue.rs` has the list of all effects, and those with stages of their own).

use super::config::{Config, DiffusionForm, EosName, ShiftingForm, ViscosityForm};
use super::solver::{Body, Solver};
use super::timers::Phase;
use crate::effects::{
    ArtificialViscosity, Contact, DensityGradient, MonaghanGingold, Morris, PairTerm, Surroundings,
    fastest_decay, fastest_diffusion, lattice_concentration,
};
use crate::eos::{AnyEos, Linear, Tait};
use crate::error::{Error, Result};
use crate::kernel::KernelName;
use crate::neighbours::{Cells, Grid};
use crate::particles::{Column, Given, OptionalColumns, Wall};
use crate::prescribed::RigidMotion;
use crate::simd::Real;
use crate::step::Forces;
use crate::sweep::{Output, Pairs, Pass, Source, SumColumns, Sweep, Sweeper, slot};
use crate::walls::{Slip, WallMethod};

/// Components of a symmetric matrix.
pub(super) const fn matrix<const D: usize>() -> usize {
    D * (D + 1) / 2
}

/// The columns that the configuration calls for.
pub(super) fn optional_columns<const D: usize>(config: &Config) -> OptionalColumns {
    let gradient = config
        .density_diffusion
        .is_some_and(|d| matches!(d.form, DiffusionForm::Antuono | DiffusionForm::Riemann));
    let vector =
        config.shifting.is_some_and(|s| s.free_surface) || config.tensile_control.is_some();
    OptionalColumns {
        gradient,
        shift: config.shifting.is_some(),
        sums: match (gradient, vector) {
            (_, true) => matrix::<D>() + D,
            (true, false) => matrix::<D>(),
            (false, false) => 0,
        },
        stages: config.integrator.columns(),
    }
}

/// Columns as a sweep takes them.
pub(super) fn slices<R: Real>(columns: &mut [Column<R>]) -> impl Iterator<Item = &mut [R]> {
    columns.iter_mut().map(|c| &mut c[..])
}

/// The form of shifting asked for, and what it needs to know.
pub(super) fn shifting<const D: usize>(
    config: &Config,
    fluid: &Given,
    moving_walls: bool,
) -> Option<(ShiftingForm, Surroundings)> {
    let (kernel, h, spacing) = (config.kernel, config.smoothing_length, config.spacing);
    config.shifting.map(|s| {
        let around = Surroundings {
            kernel,
            h,
            spacing,
            concentration: lattice_concentration::<D>(kernel, h, spacing),
            free_surface: s.free_surface,
            closed: (!s.free_surface && !moving_walls).then(|| {
                fluid
                    .mass
                    .iter()
                    .zip(&fluid.density)
                    .map(|(m, d)| m / d)
                    .sum()
            }),
        };
        (s.form, around)
    })
}

/// What keeps fluid particles apart.
pub(super) fn core<const D: usize>(config: &Config) -> Contact {
    let of = if config.surface_tension.is_some() {
        Contact::under_tension
    } else {
        Contact::fluid
    };
    of(
        config.spacing,
        D,
        config.sound_speed,
        config.reference_density,
    )
}

/// Share of the stability limit (a decay of 1 per step) that a step limited by dissipation uses.
const VISCOUS: f64 = 0.8;

/// The longest step in s that the laminar viscosity and the diffusion of the Riemann form allow; the other forms of density
/// diffusion are slower than sound.
pub(super) fn longest_dissipative_step<const D: usize>(config: &Config) -> f64 {
    let (kernel, h, spacing) = (config.kernel, config.smoothing_length, config.spacing);
    let viscous = config.laminar_viscosity.map_or(0.0, |v| {
        let angular = v.form == ViscosityForm::MonaghanGingold;
        v.kinematic * fastest_decay::<D>(kernel, h, spacing, angular)
    });
    let riemann = config
        .density_diffusion
        .filter(|d| d.form == DiffusionForm::Riemann);
    let diffusive = riemann.map_or(0.0, |d| {
        d.delta * config.sound_speed * fastest_diffusion::<D>(kernel, h, spacing)
    });
    VISCOUS / viscous.max(diffusive)
}

/// The equation of state asked for.
pub(super) fn equation_of_state(config: &Config) -> AnyEos {
    match config.eos {
        EosName::Tait => AnyEos::Tait(Tait {
            reference_density: config.reference_density,
            sound_speed: config.sound_speed,
            gamma: config.gamma,
            background: config.background_pressure,
        }),
        EosName::Linear => AnyEos::Linear(Linear {
            reference_density: config.reference_density,
            sound_speed: config.sound_speed,
            background: config.background_pressure,
        }),
    }
}

/// The motions of walls, each with the ids of its body.
pub(super) fn motions(
    config: &Config,
    bodies: &[Body],
) -> Result<Vec<(std::ops::Range<u32>, RigidMotion)>> {
    let mut found: Vec<(std::ops::Range<u32>, RigidMotion)> = Vec::new();
    for motion in &config.motion {
        let body = bodies.iter().find(|b| b.name == motion.body && !b.fluid);
        let Some(body) = body else {
            return Err(Error::Input(format!(
                "motion: found {:?}, allowed are the names of walls",
                motion.body
            )));
        };
        if found.iter().any(|(ids, _)| *ids == body.ids) {
            return Err(Error::Input(format!(
                "motion: found a second motion of {:?}, allowed is one with several parts",
                motion.body
            )));
        }
        if found.len() == usize::from(u16::MAX) {
            return Err(Error::Input(format!(
                "motion: found more than {} moving walls; make one wall of those that move alike",
                u16::MAX
            )));
        }
        found.push((body.ids.clone(), motion.build(config.dimension)?));
    }
    Ok(found)
}

/// Columns to be written, the rest empty.
pub(super) fn outputs<'a, R: Real>(
    columns: impl IntoIterator<Item = (usize, &'a mut Column<R>)>,
) -> Output<'a, R> {
    let mut out: Output<R> = std::array::from_fn(|_| Default::default());
    for (k, column) in columns {
        out[k] = &mut column[..];
    }
    out
}

/// The walls, if the fluid feels their particles.
pub(super) fn felt<'a, R: Real, const D: usize>(
    config: &Config,
    wall: &'a Option<Wall<R, D>>,
) -> Option<&'a Wall<R, D>> {
    let method = config.wall.map(|w| w.method);
    wall.as_ref()
        .filter(|_| method.is_some_and(WallMethod::uses_particles))
}

/// What a sweep works with.
pub(super) struct Stage<'a, R, const D: usize> {
    pub(super) grid: &'a Grid<D>,
    pub(super) sweeper: &'a Sweeper<R>,
    pub(super) target: &'a Source<'a, R, D>,
    pub(super) source: &'a Source<'a, R, D>,
}

impl<R: Real, const D: usize> Stage<'_, R, D> {
    pub(super) fn run<P: Pass<R, D>>(&self, kernel: KernelName, pass: &P, out: Output<R>) {
        let sweep = Sweep {
            grid: self.grid,
            target: self.target,
            source: self.source,
            pass,
        };
        self.sweeper.run(kernel, &sweep, out);
    }
}

/// Fields of the fluid that the sweep of forces reads.
pub(super) fn force_source<'a, R: Real, const D: usize>(
    position: &'a [Column<f64>; D],
    cells: &'a Cells,
    volume: &'a Column<R>,
    pressure: &'a Column<R>,
    condensation: &'a Column<R>,
    velocity: &'a [Column<R>; D],
) -> Source<'a, R, D> {
    Source::new(position, cells)
        .with(slot::VOLUME, volume)
        .with(slot::PRESSURE, pressure)
        .with(slot::CONDENSATION, condensation)
        .with_vector(slot::VELOCITY, velocity)
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// The sweep of forces.
    pub(super) fn sum_forces(&mut self) {
        let c = &self.config;
        let (h, rho) = (c.smoothing_length, c.reference_density);
        let artificial = c
            .artificial_viscosity
            .map(|v| ArtificialViscosity::new(v.alpha, v.beta, c.sound_speed, h, rho));
        let laminar = c.laminar_viscosity.map(|v| (v.form, v.kinematic));
        // Between walls, where pressure is everywhere and shifting keeps the order, particles need no core. Artificial
        // viscosity is for the inside of a fluid: it has no part in the friction at a wall.
        let core = core::<D>(c);
        let no_slip = c.wall.is_some_and(|w| w.slip == Slip::No);
        match (artificial, laminar) {
            (None, None) => self.forces_with(core, ()),
            (Some(a), None) => self.forces_with((core, a), ()),
            (None, Some((ViscosityForm::Morris, nu))) => {
                let viscosity = Morris::new(nu, h, rho);
                self.forces_with(viscosity, no_slip.then_some(viscosity));
            }
            (None, Some((ViscosityForm::MonaghanGingold, nu))) => {
                let viscosity = MonaghanGingold::new(nu, h, rho);
                self.forces_with((core, viscosity), no_slip.then_some(viscosity));
            }
            // Artificial viscosity means a free surface: one form is enough beside it.
            (Some(a), Some((_, nu))) => {
                let viscosity = MonaghanGingold::new(nu, h, rho);
                self.forces_with((core, (a, viscosity)), no_slip.then_some(viscosity));
            }
        }
        self.timers.book(Phase::Forces);
        self.audited(None, Self::add_facet_forces);
    }

    fn forces_with<V: PairTerm<R, D>, W: PairTerm<R, D>>(&mut self, effects: V, friction: W) {
        if self.fluid.gradient.is_some() {
            self.run_forces(effects, friction, DensityGradient);
        } else {
            self.run_forces(effects, friction, ());
        }
    }

    fn run_forces<V: PairTerm<R, D>, W: PairTerm<R, D>, G: PairTerm<R, D>>(
        &mut self,
        effects: V,
        friction: W,
        gradient: G,
    ) {
        let pass = Forces {
            effects,
            friction,
            gradient,
            contact: Contact::wall(
                self.config.spacing,
                D,
                self.config.sound_speed,
                self.config.reference_density,
            ),
            specific_volume: 1.0 / self.config.reference_density,
        };
        let fluid = &mut self.fluid;
        let source = force_source(
            &fluid.position,
            &fluid.cells,
            &fluid.volume,
            &fluid.pressure,
            &fluid.condensation,
            &fluid.pair_velocity,
        );
        let wall = felt(&self.config, &self.wall).map(|w| {
            let velocity = w.slip_velocity.as_ref().unwrap_or(&w.pair_velocity);
            force_source(
                &w.position,
                &w.cells,
                &w.volume,
                &w.pressure,
                &w.condensation,
                velocity,
            )
        });
        let mut columns = SumColumns::default().vector(slices(&mut fluid.acceleration));
        if let Some(gradient) = &mut fluid.gradient {
            columns = columns
                .gradient(slices(gradient))
                .moment(slices(&mut fluid.sums).take(matrix::<D>()));
        }
        let pairs = Pairs {
            grid: &self.grid,
            fluid: &source,
            wall: wall.as_ref(),
            pass: &pass,
        };
        [self.budget.walls, ..] = self.sweeper.run_pairs(self.kernel, &pairs, &columns);
    }
}
