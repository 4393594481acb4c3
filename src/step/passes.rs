//! The two sweeps of a step.

use crate::effects::{Contact, Continuity, DensityGradient, PairTerm, Pressure, Shift};
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{
    ALONE, Other, Output, Own, Pair, PairPass, Pass, Splat, Sums, Tally, Totals, Uses,
    relative_velocity,
};

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

impl<R: Real, V: PairTerm<R, D>, W: PairTerm<R, D>, G: PairTerm<R, D>, const D: usize>
    PairPass<R, D> for Forces<V, W, G>
{
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            vector: true,
            ..self.gradient.uses()
        }
    }

    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        Pressure.add(pair, own, other, tally);
        self.effects.add(pair, own, other, tally);
        self.gradient.add(pair, own, other, tally);
    }

    #[inline(always)]
    fn wall<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        Pressure.add(pair, own, other, tally);
        let push = self.contact.push(pair, own, other);
        tally.push(push);
        let out = dot(&own.velocity(), &pair.separation);
        tally.account(ALONE, (pair.slope * other.pressure() - push) * out);
        self.friction.add(pair, own, other, tally);
    }

    #[inline(always)]
    fn finish(&self, own: &Own<R, D>, sums: &mut Sums<R, D>) {
        let density = R::from_f64(1.0) + own.values().condensation();
        let scale = R::from_f64(self.specific_volume) / density;
        sums.vector = sums.vector.map(|v| v * scale);
        if self.gradient.uses().gradient {
            sums.gradient = DensityGradient::finish(sums);
        }
    }

    /// What walls take, in W, by contact and by pressure: it flickers too fast for the audits of other effects.
    #[inline(always)]
    fn collect(&self, own: &Own<R, D>, sums: &Sums<R, D>, totals: &mut Totals) {
        totals[0] += own.values().volume().to_f64() * sums.scalar.to_f64();
    }
}

/// What the sweep of continuity may also sum up for: the shift of particles.
pub trait ShiftTerm<R: Real, const D: usize>: PairTerm<R, D> {
    /// Puts the shift of a particle, if there is one, in the place of the second vector, and adds its source of density
    /// to the scalar, in units of `ρ0`.
    fn write(&self, own: &Own<R, D>, sums: &mut Sums<R, D>);
}

impl<R: Real, const D: usize> ShiftTerm<R, D> for () {
    #[inline(always)]
    fn write(&self, _: &Own<R, D>, _: &mut Sums<R, D>) {}
}

impl<R: Real, const D: usize> ShiftTerm<R, D> for Shift {
    #[inline(always)]
    fn write(&self, own: &Own<R, D>, sums: &mut Sums<R, D>) {
        let least = self.surroundings(sums);
        sums.scalar += self.source(sums, least);
        sums.gradient = self.finish(own, sums, least);
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

impl<R: Real, T: PairTerm<R, D>, S: ShiftTerm<R, D>, const D: usize> PairPass<R, D>
    for DensityRate<T, S>
{
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            scalar: true,
            ..self.shift.uses()
        }
    }

    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        Continuity.add(pair, own, other, tally);
        self.diffusion.add(pair, own, other, tally);
        self.shift.add(pair, own, other, tally);
    }

    #[inline(always)]
    fn wall<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        Continuity.add(pair, own, other, tally);
        self.shift.add(pair, own, other, tally);
    }

    #[inline(always)]
    fn finish(&self, own: &Own<R, D>, sums: &mut Sums<R, D>) {
        self.shift.write(own, sums);
        sums.scalar = sums.scalar * R::from_f64(self.reference_density);
    }
}

/// Rate of density of wall particles that follow the equation of continuity, over the fluid.
pub struct WallDensityRate {
    /// `ρ0`.
    pub reference_density: f64,
}

impl<R: Real, const D: usize> Pass<R, D> for WallDensityRate {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let compression = dot(&relative_velocity(own, other), &pair.separation) * pair.slope;
        sums.scalar = other.volume().mul_add(compression, sums.scalar);
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
        out[0][i] = sums.scalar.sum() * density * R::from_f64(self.reference_density);
    }
}
