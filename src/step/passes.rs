//! The two sweeps of a step.

use crate::effects::{Contact, Continuity, DensityGradient, PairTerm, Pressure, Shift};
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Output, Own, Pair, Pass, Splat, Sums};

/// Acceleration by pressure and by the effects `V`, at walls by `W`; with `G`, the gradient of the condensation too.
pub struct Forces<V, W, G> {
    /// Effects between fluid particles.
    pub effects: V,
    /// Friction between fluid and a wall to which it sticks, or `()`.
    pub friction: W,
    /// `DensityGradient` or `()`.
    pub gradient: G,
    /// What keeps the fluid out of walls.
    pub contact: Contact,
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

impl<
    R: Real,
    V: PairTerm<R, D>,
    W: PairTerm<R, D>,
    G: PairTerm<R, D> + GradientTerm,
    const D: usize,
> Pass<R, D> for Forces<V, W, G>
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
        self.effects.add(pair, own, other, sums);
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
        self.contact.add(pair, own, other, sums);
        self.friction.add(pair, own, other, sums);
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

/// What the sweep of continuity may also sum up for: the shift of particles.
pub trait ShiftTerm<R: Real, const D: usize>: PairTerm<R, D> {
    /// Writes the shift of particle `i`, if there is one.
    fn write<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    );
}

impl<R: Real, const D: usize> ShiftTerm<R, D> for () {
    #[inline(always)]
    fn write<L: Lanes<Real = R>>(
        &self,
        _: &Own<R, D>,
        _: &Sums<L, D>,
        _: usize,
        _: &mut Output<R>,
    ) {
    }
}

impl<R: Real, const D: usize> ShiftTerm<R, D> for Shift {
    #[inline(always)]
    fn write<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        let shift = self.finish(own, sums);
        for a in 0..D {
            out[3 + a][i] = shift[a];
        }
    }
}

/// Rate of density by continuity and by density diffusion (`T`), the latter between fluid particles only; and the shift
/// (`S`) of particles.
pub struct DensityRate<T, S> {
    /// Density diffusion or `()`.
    pub diffusion: T,
    /// Particle shifting or `()`.
    pub shift: S,
    /// `ρ0`.
    pub reference_density: f64,
}

impl<R: Real, T: PairTerm<R, D>, S: ShiftTerm<R, D>, const D: usize> Pass<R, D>
    for DensityRate<T, S>
{
    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        Continuity.add(pair, own, other, sums);
        self.diffusion.add(pair, own, other, sums);
        self.shift.add(pair, own, other, sums);
    }

    #[inline(always)]
    fn wall<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        Continuity.add(pair, own, other, sums);
        self.shift.add(pair, own, other, sums);
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        out[0][i] = sums.scalar.sum() * R::from_f64(self.reference_density);
        self.shift.write(own, sums, i, out);
    }
}
