//! The two sweeps of a step.

use crate::effects::{DensityGradient, PairTerm, Pressure};
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Output, Own, Pair, Pass, Splat, Sums};

/// Acceleration by pressure and by the effects `V` (viscosities); with `G`, the gradient of the condensation too.
pub struct Forces<V, G> {
    /// Viscous effects.
    pub viscosity: V,
    /// `DensityGradient` or `()`.
    pub gradient: G,
    /// Whether viscosity acts between fluid and wall.
    pub no_slip: bool,
    /// `1/ρ0`.
    pub specific_volume: f64,
}

/// Whether a gradient is among the sums of [`Forces`].
pub trait GradientTerm {
    /// Whether it is.
    const PRESENT: bool;
}
impl GradientTerm for () {
    const PRESENT: bool = false;
}
impl GradientTerm for DensityGradient {
    const PRESENT: bool = true;
}

impl<R: Real, V: PairTerm<R, D>, G: PairTerm<R, D> + GradientTerm, const D: usize> Pass<R, D>
    for Forces<V, G>
{
    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        Pressure.add(pair, own, other, sums);
        self.viscosity.add(pair, own, other, sums);
        self.gradient.add(pair, own, other, sums);
    }

    #[inline(always)]
    fn wall<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        Pressure.add(pair, own, other, sums);
        if self.no_slip {
            self.viscosity.add(pair, own, other, sums);
        }
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        let density = R::from_f64(1.0) + own.values().condensation();
        let scale = R::from_f64(self.specific_volume) / density;
        for a in 0..D {
            out[a][i] = sums.vector[a].sum() * scale;
        }
        if G::PRESENT {
            let gradient = DensityGradient::finish(sums);
            for a in 0..D {
                out[3 + a][i] = gradient[a];
            }
        }
    }
}

/// Rate of density by continuity (`C`) and by density diffusion (`T`), the latter between fluid particles only.
pub struct DensityRate<C, T> {
    /// Continuity.
    pub continuity: C,
    /// Density diffusion or `()`.
    pub diffusion: T,
    /// `ρ0`.
    pub reference_density: f64,
}

impl<R: Real, C: PairTerm<R, D>, T: PairTerm<R, D>, const D: usize> Pass<R, D>
    for DensityRate<C, T>
{
    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        self.continuity.add(pair, own, other, sums);
        self.diffusion.add(pair, own, other, sums);
    }

    #[inline(always)]
    fn wall<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        self.continuity.add(pair, own, other, sums);
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        _own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        out[0][i] = sums.scalar.sum() * R::from_f64(self.reference_density);
    }
}
