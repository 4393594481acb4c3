//! Artificial viscosity.

use super::{Declaration, PairTerm};
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Pair, Splat, Tally, Uses, relative_velocity};

/// Monaghan's artificial viscosity (Monaghan 1992): between approaching particles
/// `Π_ij = (-α c0 μ_ij + β μ_ij²) / ρ̄` with `μ_ij = h u_ij·r_ij / (r² + 0.01 h²)`, and the force density
/// `-ρ_i Σ m_j Π_ij ∇W_ij`. Choose α 0.01 to 0.05 for free-surface flow; β = 2 α for shocks only. Dissipates kinetic
/// energy; conserves linear and angular momentum.
#[derive(Clone, Copy, Debug)]
pub struct ArtificialViscosity {
    /// `2 ρ0 α c0 h`.
    linear: f64,
    /// `2 ρ0 β h²`.
    quadratic: f64,
    h: f64,
}

impl ArtificialViscosity {
    /// With coefficients `alpha` and `beta`, for sound speed `c0` in m/s and smoothing length `h` in m.
    pub fn new(alpha: f64, beta: f64, c0: f64, h: f64, reference_density: f64) -> Self {
        ArtificialViscosity {
            linear: 2.0 * reference_density * alpha * c0 * h,
            quadratic: 2.0 * reference_density * beta * h * h,
            h,
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for ArtificialViscosity {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            vector: true,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        let approach = dot(&relative_velocity(own, other), &pair.separation).min(L::zero());
        let one = L::constant(1.0);
        let (own_density, other_density) = (one + own.condensation(), one + other.condensation());
        // One division serves the regularised distance and the mean density; densities are in units of ρ0.
        let regularised = pair.squared + L::constant(0.01 * self.h * self.h);
        let densities = own_density + other_density;
        let inverse = (regularised * densities).recip();
        let approach = approach * inverse;
        let mut viscous = L::constant(self.linear) * approach;
        if self.quadratic != 0.0 {
            viscous = viscous - L::constant(self.quadratic) * approach.squared() * densities;
        }
        tally.push(own_density * other_density * (viscous * pair.slope));
    }
}

/// What the effect is.
pub const ARTIFICIAL_VISCOSITY: Declaration = Declaration {
    name: "artificial viscosity",
    columns: &[],
    sweeps: 0,
    limit: None,
    dissipates: "kinetic energy of approaching pairs",
    source: "Monaghan 1992",
};
