//! Laminar viscosity.

use super::PairTerm;
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Pair, Splat, Sums, relative_velocity};

/// Viscosity of a Newtonian fluid in the form of Morris, Fox & Zhu 1997: the force density
/// `Σ V_j (μ_i + μ_j) (r_ij·∇W_ij) / (r² + 0.01 h²) u_ij`. Conserves linear momentum exactly, angular momentum to the
/// order of the discretisation. Limits the time step to `0.125 h²/ν`.
#[derive(Clone, Copy, Debug)]
pub struct LaminarViscosity {
    viscosity: f64,
    eta2: f64,
}

impl LaminarViscosity {
    /// For kinematic viscosity `nu` in m²/s, smoothing length `h` in m, and the density at rest.
    pub fn new(nu: f64, h: f64, reference_density: f64) -> Self {
        LaminarViscosity {
            viscosity: nu * reference_density,
            eta2: 0.01 * h * h,
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for LaminarViscosity {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let densities = L::constant(2.0) + own.condensation() + other.condensation();
        let regularised = (pair.squared + L::constant(self.eta2)).recip();
        let drag = L::constant(self.viscosity)
            * densities
            * other.volume()
            * pair.slope
            * pair.squared
            * regularised;
        let u = relative_velocity(own, other);
        for a in 0..D {
            sums.vector[a] = drag.mul_add(u[a], sums.vector[a]);
        }
    }
}
