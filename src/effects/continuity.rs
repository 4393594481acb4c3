//! Continuity.

use super::PairTerm;
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Pair, Splat, Tally, Uses, relative_velocity};

/// Rate of density in units of `ρ0`: `(ρ_i/ρ0) Σ V_j u_ij·∇W_ij` (Monaghan 2005).
#[derive(Clone, Copy, Debug)]
pub struct Continuity;

impl<R: Real, const D: usize> PairTerm<R, D> for Continuity {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            scalar: true,
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
        tally.compress(dot(&relative_velocity(own, other), &pair.separation) * pair.slope);
    }
}
