//! Effects: one file each, with its parameters, its pair term, what it needs and what it limits.
//!
//! A pair term adds to the sums of a sweep. Terms are combined statically, so that a scene without an effect runs code
//! that does not know it.

mod added;
mod artificial_stress;
mod artificial_viscosity;
mod contact;
mod continuity;
mod declaration;
mod density_diffusion;
mod dissipation;
mod herschel_bulkley;
mod inner_forces;
mod laminar_viscosity;
mod linear_drag;
mod particle_shifting;
mod pressure;
mod riemann;
mod shear_rate;
mod stage;
mod surface_tension;
mod tensile_control;
mod transport;
mod turbulence;
mod variable_viscosity;
mod whole_array;

pub use added::Added;
pub use artificial_stress::{ARTIFICIAL_STRESS, ArtificialStress};
pub use artificial_viscosity::{ARTIFICIAL_VISCOSITY, ArtificialViscosity};
pub use contact::{CONTACT, Contact};
pub use continuity::Continuity;
pub use declaration::{Declaration, Quantity};
pub use density_diffusion::{Antuono, DensityGradient, Fourtakas, Molteni, density_diffusion};
pub use dissipation::{Diffusion, Dissipation, Laminar, POWERS, WALL_POWER};
pub use herschel_bulkley::{HerschelBulkley, HerschelBulkleyConfig};
pub use laminar_viscosity::{LAMINAR_VISCOSITY, MonaghanGingold, Morris, fastest_decay};
pub use linear_drag::LinearDrag;
pub use particle_shifting::{
    Shift, Surroundings, lattice_concentration, particle_shifting, sun_strength,
};
pub use pressure::{PRESSURE, Pressure};
pub use riemann::{RIEMANN_VISCOSITY, RiemannDiffusion, RiemannViscosity, fastest_diffusion};
pub use shear_rate::ShearRate;
pub use stage::{Around, Stage, Touch};
pub use surface_tension::{SURFACE_TENSION, SurfaceTension};
pub use tensile_control::{TENSILE_CONTROL, TensileControl, TensileStage};
pub use transport::{Carry, Transport};
pub use turbulence::{Smagorinsky, TurbulenceConfig};
pub use variable_viscosity::{Rheology, VariableViscosity};
pub use whole_array::{ACOUSTIC_DAMPER, GRAVITY};

use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Pair, Splat, Tally, Uses};

/// A term of a pair sum. Methods must be `#[inline(always)]`.
pub trait PairTerm<R: Real, const D: usize>: Copy + Send + Sync {
    /// Which sums it adds to.
    fn uses(&self) -> Uses;

    /// Adds what a vector of pairs gives.
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    );
}

/// An effect that the scene does not call for.
impl<R: Real, const D: usize> PairTerm<R, D> for () {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses::NONE
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        _: &Pair<L, D>,
        _: &Splat<L, D>,
        _: &Other<L, D>,
        _: &mut Tally<L, D>,
    ) {
    }
}

/// An effect that depends on the walls of a scene: one test per vector.
impl<R: Real, A: PairTerm<R, D>, const D: usize> PairTerm<R, D> for Option<A> {
    #[inline(always)]
    fn uses(&self) -> Uses {
        self.as_ref().map_or(Uses::NONE, A::uses)
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        if let Some(effect) = self {
            effect.add(pair, own, other, tally);
        }
    }
}

/// Two effects together.
impl<R: Real, A: PairTerm<R, D>, B: PairTerm<R, D>, const D: usize> PairTerm<R, D> for (A, B) {
    #[inline(always)]
    fn uses(&self) -> Uses {
        self.0.uses().and(self.1.uses())
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        self.0.add(pair, own, other, tally);
        self.1.add(pair, own, other, tally);
    }
}
