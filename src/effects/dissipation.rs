//! What each effect takes out of the mechanical energy.
//!
//! Of every pair: a force density `f` on the one and its opposite on the other, per volume of both, has the power
//! `f·(u_i - u_j)`; a rate of density `D` has the power `p D / ρ`, for `ρ de/dt = p/ρ dρ/dt` is what compression stores.
//! Pressure and continuity themselves hand energy to and fro and lose none (Bonet & Lok 1999); at walls the two do not
//! balance, and what is handed to walls is counted as theirs.

use super::{
    Antuono, ArtificialViscosity, Contact, Fourtakas, Molteni, MonaghanGingold, Morris,
    RiemannDiffusion, Shift,
};
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{
    Other, Own, Pair, PairPass, Splat, Sums, Tally, Totals, Uses, relative_velocity,
};

/// Laminar viscosity in the form that the scene calls for.
#[derive(Clone, Copy, Debug)]
pub enum Laminar {
    /// See [`Morris`].
    Morris(Morris),
    /// See [`MonaghanGingold`].
    MonaghanGingold(MonaghanGingold),
}

/// Density diffusion in the form that the scene calls for.
#[derive(Clone, Copy, Debug)]
pub enum Diffusion<const D: usize> {
    /// See [`Molteni`].
    Molteni(Molteni),
    /// See [`Antuono`].
    Antuono(Antuono),
    /// See [`Fourtakas`].
    Fourtakas(Fourtakas<D>),
    /// See [`RiemannDiffusion`].
    Riemann(RiemannDiffusion),
}

/// The effects of a scene whose powers are summed. Pairs are not counted one by one here: this pass runs rarely.
#[derive(Clone, Copy, Debug)]
pub struct Dissipation<const D: usize> {
    /// Artificial viscosity.
    pub artificial: Option<ArtificialViscosity>,
    /// Laminar viscosity.
    pub laminar: Option<Laminar>,
    /// Whether it also acts at walls.
    pub friction: bool,
    /// Density diffusion.
    pub diffusion: Option<Diffusion<D>>,
    /// Shifting without a free surface, where density follows the particles' concentration by pairs.
    pub following: Option<Shift>,
    /// Bulk viscosity over density of the acoustic damper in m²/s.
    pub damper: f64,
    /// The core of fluid particles.
    pub core: Option<Contact>,
}

/// What the powers are of, in the order of the totals.
pub const POWERS: [&str; 7] = [
    "artificial viscosity",
    "laminar viscosity",
    "density diffusion",
    "acoustic damper",
    "contact",
    "walls",
    "particle shifting",
];

/// The entry of walls: here what moving ones hand over; contact and pressure at walls are a total of the sweep of forces.
pub const WALL_POWER: usize = 5;

impl<const D: usize> Dissipation<D> {
    #[inline(always)]
    fn laminar_force<L: Lanes>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
    ) -> Option<[L; D]> {
        match self.laminar? {
            Laminar::Morris(m) => Some(Tally::of(&m, pair, own, other).0),
            Laminar::MonaghanGingold(m) => Some(Tally::of(&m, pair, own, other).0),
        }
    }

    /// Power that rates of density over `ρ0` of a pair store, per volume of both.
    #[inline(always)]
    fn stored<L: Lanes>(
        &self,
        [ours, theirs]: [L; 2],
        own: &Splat<L, D>,
        other: &Other<L, D>,
    ) -> L {
        let one = L::constant(1.0);
        let p = self.pressure(own.pressure(), own.rate());
        let q = self.pressure(other.pressure(), other.rate());
        ours * p * (one + own.condensation()).recip()
            + theirs * q * (one + other.condensation()).recip()
    }

    /// Pressure of a particle without the part of the damper.
    #[inline(always)]
    fn pressure<L: Lanes>(&self, pressure: L, rate: L) -> L {
        pressure - L::constant(self.damper) * rate
    }
}

impl<R: Real, const D: usize> PairPass<R, D> for Dissipation<D> {
    const COLLECTS: bool = true;

    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses::NONE
    }

    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        let u = relative_velocity(own, other);
        if let Some(artificial) = &self.artificial {
            tally.account(0, -dot(&Tally::of(artificial, pair, own, other).0, &u));
        }
        if let Some(force) = self.laminar_force(pair, own, other) {
            tally.account(1, -dot(&force, &u));
        }
        if let Some(diffusion) = &self.diffusion {
            let (_, ours, theirs) = match diffusion {
                Diffusion::Molteni(d) => Tally::of(d, pair, own, other),
                Diffusion::Antuono(d) => Tally::of(d, pair, own, other),
                Diffusion::Riemann(d) => Tally::of(d, pair, own, other),
                Diffusion::Fourtakas(d) => Tally::of(d, pair, own, other),
            };
            tally.account(2, -self.stored([ours, theirs], own, other));
        }
        if let Some(shift) = &self.following {
            let (_, ours, theirs) = Tally::of(shift, pair, own, other);
            tally.account(6, -self.stored([ours, theirs], own, other));
        }
        if self.damper != 0.0 {
            let compression = pair.slope * dot(&u, &pair.separation);
            let damping = L::constant(self.damper) * (own.rate() + other.rate());
            tally.account(3, damping * compression);
        }
        if let Some(core) = &self.core {
            tally.account(4, -dot(&Tally::of(core, pair, own, other).0, &u));
        }
    }

    #[inline(always)]
    fn wall<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        // What the wall sees of itself; the velocity that viscosity sees is another where the fluid sticks.
        let moves = other.gradient();
        let slides: [L; D] = {
            let u = own.velocity();
            std::array::from_fn(|a| u[a] - moves[a])
        };
        let mut given = L::zero();
        if self.friction
            && let Some(force) = self.laminar_force(pair, own, other)
        {
            tally.account(1, -dot(&force, &slides));
            given = dot(&force, &moves);
        }
        let fluid_pressure = self.pressure(own.pressure(), own.rate());
        if let Some(shift) = &self.following {
            let rate = Tally::of(shift, pair, own, other).1;
            let density = L::constant(1.0) + own.condensation();
            tally.account(6, -(rate * fluid_pressure * density.recip()));
        }
        let (out, back) = (
            dot(&own.velocity(), &pair.separation),
            dot(&moves, &pair.separation),
        );
        tally.account(3, L::constant(self.damper) * own.rate() * pair.slope * out);
        tally.account(5, pair.slope * fluid_pressure * back - given);
    }

    #[inline(always)]
    fn finish(&self, _: &Own<R, D>, _: &mut Sums<R, D>) {}

    #[inline(always)]
    fn collect(&self, own: &Own<R, D>, sums: &Sums<R, D>, totals: &mut Totals) {
        let volume = own.values().volume().to_f64();
        for (total, power) in totals
            .iter_mut()
            .zip(sums.moment.iter().chain([&sums.scalar]))
        {
            *total += volume * power.to_f64();
        }
        if let Some(shift) = &self.following {
            let own = own.values();
            let pressure = self.pressure(own.pressure(), own.rate()).to_f64();
            let density = 1.0 + own.condensation().to_f64();
            let rate: R = shift.source(sums, shift.surroundings(sums));
            totals[6] -= volume * pressure * rate.to_f64() / density;
        }
    }
}
