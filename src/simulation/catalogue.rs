//! The list of effects, and from a configuration to those with stages of their own: one line each.

use super::config::{Config, DiffusionForm, TensileForm};
use super::solver::Solver;
use super::timers::Phase;
use crate::effects::{
    ACOUSTIC_DAMPER, ARTIFICIAL_STRESS, ARTIFICIAL_VISCOSITY, Added, Around, ArtificialStress,
    CONTACT, Declaration, GRAVITY, HerschelBulkley, LAMINAR_VISCOSITY, LinearDrag, PRESSURE,
    PairTerm, RIEMANN_VISCOSITY, Rheology, RiemannViscosity, SURFACE_TENSION, Smagorinsky, Stage,
    SurfaceTension, TENSILE_CONTROL, TensileControl, TensileStage, VariableViscosity,
    density_diffusion, fastest_decay, particle_shifting,
};
use crate::simd::Real;
use crate::step::Limit;
use crate::walls::{MOVING_WALLS, Slip, WALLS};

/// Most stages that a scene may have.
pub(super) const MOST_STAGES: usize = 6;

/// The effects with sweeps of their own that the configuration calls for: one line each.
pub(super) fn stages<R: Real, const D: usize>(
    config: &Config,
    n: usize,
) -> Vec<Box<dyn Stage<R, D>>> {
    let c = config;
    let mut stages: Vec<Box<dyn Stage<R, D>>> = Vec::new();
    let mut add = |stage: Option<Box<dyn Stage<R, D>>>| stages.extend(stage);
    add(c
        .turbulence
        .map(|t| thickened(c, n, Smagorinsky::new(t, c.spacing, c.reference_density))));
    add(c
        .herschel_bulkley
        .map(|v| thickened(c, n, HerschelBulkley::new(v, costless_viscosity::<D>(c)))));
    add(c.riemann_viscosity.then(|| {
        let term = RiemannViscosity::new(c.reference_density, c.sound_speed);
        alone(c, term, RIEMANN_VISCOSITY, false)
    }));
    add(c.surface_tension.map(|sigma| {
        let (kernel, rho) = ((c.kernel, c.smoothing_length), c.reference_density);
        Box::new(SurfaceTension::new(sigma, n, kernel, c.spacing, rho)) as Box<dyn Stage<R, D>>
    }));
    add(c
        .linear_drag
        .map(|rate| Box::new(LinearDrag::new(rate)) as Box<dyn Stage<R, D>>));
    add(c.tensile_control.map(|t| match t.form {
        TensileForm::Sun => {
            let control = TensileControl::new(c.reference_density, t.free_surface);
            Box::new(TensileStage::new(control, n)) as Box<dyn Stage<R, D>>
        }
        TensileForm::Monaghan => {
            let term = ArtificialStress::new::<D>(c.kernel, c.smoothing_length, c.spacing);
            alone(c, term, ARTIFICIAL_STRESS, true)
        }
    }));
    stages
}

/// A pair term in sweeps of its own.
fn alone<R: Real, T: PairTerm<R, D> + PairTerm<f64, D> + 'static, const D: usize>(
    c: &Config,
    term: T,
    declaration: Declaration,
    at_walls: bool,
) -> Box<dyn Stage<R, D>> {
    Box::new(Added::new(term, declaration, c.reference_density, at_walls))
}

/// A liquid whose viscosity depends on the flow.
fn thickened<R: Real, M: Rheology, const D: usize>(
    c: &Config,
    n: usize,
    rheology: M,
) -> Box<dyn Stage<R, D>> {
    let (h, rho) = (c.smoothing_length, c.reference_density);
    Box::new(VariableViscosity::new(
        rheology,
        n,
        h,
        rho,
        c.wall.is_some_and(|w| w.slip == Slip::No),
        fastest_decay::<D>(c.kernel, h, c.spacing, true),
        c.laminar_viscosity.map_or(0.0, |v| v.kinematic * rho),
    ))
}

/// The viscosity in Pa s whose step is as long as that of sound.
fn costless_viscosity<const D: usize>(c: &Config) -> f64 {
    let h = c.smoothing_length;
    let decay = fastest_decay::<D>(c.kernel, h, c.spacing, true);
    c.reference_density * c.sound_speed / (h * decay)
}

/// Every effect that kolk knows, and whether the configuration calls for it.
pub(super) fn effects(c: &Config, walls: bool) -> Vec<(Declaration, bool)> {
    let gravity = c.gravity.is_some() || !c.gravity_over_time.is_empty();
    let form = c.density_diffusion.map(|d| d.form);
    let riemann = form == Some(DiffusionForm::Riemann);
    let gradient = riemann || form == Some(DiffusionForm::Antuono);
    let remedy = |form| c.tensile_control.is_some_and(|t| t.form == form);
    vec![
        (PRESSURE, true),
        (GRAVITY, gravity),
        (ARTIFICIAL_VISCOSITY, c.artificial_viscosity.is_some()),
        (LAMINAR_VISCOSITY, c.laminar_viscosity.is_some()),
        (HerschelBulkley::DECLARATION, c.herschel_bulkley.is_some()),
        (Smagorinsky::DECLARATION, c.turbulence.is_some()),
        (SURFACE_TENSION, c.surface_tension.is_some()),
        (LinearDrag::DECLARATION, c.linear_drag.is_some()),
        (
            Declaration {
                limit: riemann.then_some(Limit::Viscous),
                ..density_diffusion(gradient)
            },
            c.density_diffusion.is_some(),
        ),
        (ACOUSTIC_DAMPER, c.acoustic_damper.is_some()),
        (
            particle_shifting(c.shifting.is_some_and(|s| s.form.transport().is_some())),
            c.shifting.is_some(),
        ),
        (RIEMANN_VISCOSITY, c.riemann_viscosity),
        (TENSILE_CONTROL, remedy(TensileForm::Sun)),
        (ARTIFICIAL_STRESS, remedy(TensileForm::Monaghan)),
        (CONTACT, true),
        (WALLS, walls),
        (MOVING_WALLS, !c.motion.is_empty()),
    ]
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Effects that few scenes call for add to the acceleration, and may limit the next step.
    pub(super) fn run_stages(&mut self) {
        if self.stages.is_empty() {
            return;
        }
        let mut least: Option<(f64, Limit)> = None;
        for k in 0..self.stages.len() {
            self.audited(Some(k), |solver| {
                solver.stages[k].run(Around {
                    grid: &solver.grid,
                    sweeper: &solver.sweeper,
                    kernel: solver.kernel,
                    fluid: &mut solver.fluid,
                    wall: solver.wall.as_ref(),
                });
            });
            let stage = &self.stages[k];
            let longest = stage.longest_step();
            if let Some(limit) = stage.declaration().limit
                && least.is_none_or(|l| longest < l.0)
            {
                least = Some((longest, limit));
            }
        }
        self.limits.stages = least;
        self.timers.book(Phase::Stages);
    }
}
