//! Artificial stress.

use super::{Declaration, PairTerm};
use crate::kernel::KernelName;
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Pair, Splat, Tally, Uses};

/// Share of a tension that is turned into a repulsion.
const TENSION: f64 = 0.2;
/// The same of a pressure.
const COMPRESSION: f64 = 0.01;

/// Repulsion of pairs nearer than the spacing where pressure is negative, so that tension does not draw them together
/// (Monaghan 2000): the force density `-Σ V_j R_ij f⁴ ∇W_ij` with `f = W_ij/W(Δp)`, where a particle under tension adds `0.2 |p_i|`
/// to `R_ij`, and two under pressure give `0.01 (p_i + p_j)`; densities are taken as equal, as they nearly are in a weakly
/// compressible fluid. Conserves linear and angular momentum, and is the gradient of nothing: it turns no energy into heat
/// by design. For smoothing lengths up to about 1.5 Δp, where `f⁴` is small for all but the nearest.
#[derive(Clone, Copy, Debug)]
pub struct ArtificialStress {
    /// `1 / W(Δp)`.
    inverse_weight: f64,
}

impl ArtificialStress {
    /// For a kernel with smoothing length `h` in m, and a spacing in m in `D` dimensions.
    pub fn new<const D: usize>(kernel: KernelName, h: f64, spacing: f64) -> Self {
        ArtificialStress {
            inverse_weight: 1.0 / kernel.value(D, spacing, h),
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for ArtificialStress {
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
        let (p, q) = (own.pressure(), other.pressure());
        let tension = p.min(L::zero()) + q.min(L::zero());
        let compression = (p + q).only(L::zero().less(p.min(q)));
        let stress = L::constant(COMPRESSION) * compression - L::constant(TENSION) * tension;
        let nearness = (pair.weight() * L::constant(self.inverse_weight))
            .squared()
            .squared();
        tally.push(-(stress * nearness * pair.slope));
    }
}

/// What the effect is.
pub const ARTIFICIAL_STRESS: Declaration = Declaration {
    name: "artificial stress",
    columns: &[],
    sweeps: 1,
    limit: None,
    dissipates: "",
    source: "Monaghan 2000",
};
