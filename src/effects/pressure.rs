//! Pressure.

use super::{Declaration, PairTerm};
use crate::simd::{Lanes, Real};
use crate::step::Limit;
use crate::sweep::{Other, Pair, Splat, Tally, Uses};

/// Force density of the pressure, `-Σ V_j (p_i + p_j) ∇W_ij`: the form that is variationally consistent with the
/// continuity equation of [`super::Continuity`] (Bonet & Lok 1999), antisymmetric for every pair.
#[derive(Clone, Copy, Debug)]
pub struct Pressure;

impl<R: Real, const D: usize> PairTerm<R, D> for Pressure {
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
        tally.push(-((own.pressure() + other.pressure()) * pair.slope));
    }
}

/// What the effect is.
pub const PRESSURE: Declaration = Declaration {
    name: "pressure",
    columns: &[],
    sweeps: 1,
    limit: Some(Limit::Acoustic),
    dissipates: "",
    source: "Bonet & Lok 1999",
};
