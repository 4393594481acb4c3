//! The stage of liquids whose viscosity depends on the flow: rate of shear, viscosity, friction.

use super::stage::{Around, Stage, Touch, sweep};
use super::{Declaration, PairTerm, ShearRate};
use crate::particles::{Column, Fluid, Shared, for_ranges};
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{
    Other, Output, Own, Pair, Pass, Source, Splat, Sums, Tally, Uses, relative_velocity, slot,
};

/// What keeps `1/r²` finite for coincident particles, in `h²`, as in the laminar forms.
const ETA2: f64 = 1e-6;
/// Share of the stability limit (a decay of 1 per step) that a viscous step uses.
const SHARE: f64 = 0.8;

/// How the viscosity depends on the rate of shear.
pub trait Rheology: Copy + Send + Sync + 'static {
    /// What it is.
    const DECLARATION: Declaration;

    /// Dynamic viscosity in Pa s at a rate of shear in 1/s.
    fn viscosity(&self, shear_rate: f64) -> f64;
}

/// Three steps behind the sweep of forces: the rate of shear by a sweep, the viscosity of each particle, and by a
/// second sweep the force density `2 (D+2) Σ V_j μ_ij (u_ij·r_ij) / (r² + η²) ∇W_ij` (Monaghan & Gingold 1983) with the harmonic
/// mean `μ_ij = 2 μ_i μ_j / (μ_i + μ_j)` (Cleary & Monaghan 1999), which keeps the stress continuous where the viscosity
/// jumps, as at the edge of a plug. Conserves linear and angular momentum.
pub struct VariableViscosity<R, M> {
    rheology: M,
    /// Rate of shear, then viscosity.
    viscosity: Column<R>,
    friction: Friction,
    /// Whether the fluid sticks to walls.
    no_slip: bool,
    /// The fastest decay that kinematic viscosity 1 gives, in 1/s.
    fastest_decay: f64,
    /// Viscosity in Pa s that acts beside it.
    beside: f64,
    largest: f64,
}

impl<R: Real, M: Rheology> VariableViscosity<R, M> {
    /// For `n` particles. `fastest_decay` is that of the lattice (1/s per m²/s), `beside` a viscosity in Pa s that acts
    /// besides.
    pub fn new(
        rheology: M,
        n: usize,
        h: f64,
        reference_density: f64,
        no_slip: bool,
        fastest_decay: f64,
        beside: f64,
    ) -> Self {
        VariableViscosity {
            rheology,
            viscosity: Column::new(n),
            friction: Friction {
                eta2: ETA2 * h * h,
                specific_volume: 1.0 / reference_density,
            },
            no_slip,
            fastest_decay,
            beside,
            largest: 0.0,
        }
    }

    /// The viscosity from the rate of shear, in place; gives the largest.
    fn thicken(&mut self) -> f64 {
        let (n, rheology) = (self.viscosity.len(), self.rheology);
        let column = Shared::new(&mut self.viscosity);
        for_ranges(
            n,
            || 0.0,
            f64::max,
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let values = unsafe { column.range(&range) };
                let mut largest = 0.0f64;
                for value in values {
                    let viscosity = rheology.viscosity(value.to_f64());
                    *value = R::from_f64(viscosity);
                    largest = largest.max(viscosity);
                }
                largest
            },
        )
    }
}

impl<R: Real, M: Rheology, const D: usize> Stage<R, D> for VariableViscosity<R, M> {
    fn declaration(&self) -> Declaration {
        M::DECLARATION
    }

    fn run(&mut self, around: Around<R, D>) {
        let with = (around.grid, around.sweeper, around.kernel);
        let Fluid {
            position,
            cells,
            volume,
            condensation,
            pair_velocity,
            acceleration,
            ..
        } = around.fluid;
        let flow = Source::new(position, cells)
            .with(slot::VOLUME, volume)
            .with_vector(slot::VELOCITY, pair_velocity);
        sweep(with, &flow, &flow, &ShearRate, [&mut self.viscosity]);
        self.largest = self.thicken();
        let fluid = flow
            .with(slot::CONDENSATION, condensation)
            .with(slot::VISCOSITY, &self.viscosity);
        sweep(
            with,
            &fluid,
            &fluid,
            &Within(self.friction),
            acceleration.iter_mut(),
        );
        if let Some(w) = around.wall.filter(|_| self.no_slip) {
            let velocity = w.slip_velocity.as_ref().unwrap_or(&w.pair_velocity);
            let wall = Source::new(&w.position, &w.cells)
                .with(slot::VOLUME, &w.volume)
                .with_vector(slot::VELOCITY, velocity);
            let friction = AtWall(self.friction);
            sweep(with, &fluid, &wall, &friction, acceleration.iter_mut());
        }
    }

    fn longest_step(&self) -> f64 {
        let kinematic = (self.largest + self.beside) * self.friction.specific_volume;
        SHARE / (kinematic * self.fastest_decay)
    }

    fn reaction(&self, at: &Touch<D>) -> [f64; D] {
        if !self.no_slip {
            return [0.0; D];
        }
        // A wall has the viscosity of the fluid at it.
        let (mut wall, mut fluid) = (*at.wall, *at.fluid);
        wall[slot::VISCOSITY] = self.viscosity[at.j].to_f64();
        fluid[slot::VISCOSITY] = self.viscosity[at.j].to_f64();
        at.single
            .vector(&self.friction, at.separation, &wall, &fluid)
    }

    fn follow(&mut self, fluid: &mut Fluid<R, D>) {
        fluid.reorder(&mut self.viscosity);
    }

    fn bytes(&self) -> usize {
        self.viscosity.bytes()
    }
}

/// Friction between particles of different viscosity.
#[derive(Clone, Copy, Debug)]
struct Friction {
    eta2: f64,
    specific_volume: f64,
}

impl Friction {
    /// `c` of the force density `c r_ij`, per volume of the other.
    #[inline(always)]
    fn strength<L: Lanes, const D: usize>(
        &self,
        viscosity: L,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
    ) -> L {
        let regularised = (pair.squared + L::constant(self.eta2)).recip();
        let approach = dot(&relative_velocity(own, other), &pair.separation);
        L::constant(2.0 * (D as f64 + 2.0)) * viscosity * approach * regularised * pair.slope
    }

    /// Adds the acceleration to what is there.
    #[inline(always)]
    fn accelerate<L: Lanes, const D: usize>(
        &self,
        own: &Own<L::Real, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<L::Real>,
    ) {
        let density = L::Real::from_f64(1.0) + own.values().condensation();
        let scale = L::Real::from_f64(self.specific_volume) / density;
        for a in 0..D {
            out[a][i] += sums.vector[a].sum() * scale;
        }
    }
}

/// `2 a b / (a + b)`.
#[inline(always)]
fn harmonic_mean<L: Lanes>(a: L, b: L) -> L {
    // Where neither is viscous there is nothing to divide. Lanes out of reach hold what another sweep has left there, a
    // pressure of any sign: nothing may come of it that is not finite.
    let (a, b) = (a.max(L::zero()), b.max(L::zero()));
    L::constant(2.0) * a * b * (a + b).max(L::constant(1e-30)).recip()
}

/// Adds `strength r_ij` per volume of the other.
#[inline(always)]
fn rub<L: Lanes, const D: usize>(
    strength: L,
    pair: &Pair<L, D>,
    other: &Other<L, D>,
    sums: &mut Sums<L, D>,
) {
    let push = strength * other.volume();
    for a in 0..D {
        sums.vector[a] = push.mul_add(pair.separation[a], sums.vector[a]);
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Friction {
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
        let viscosity = harmonic_mean(own.viscosity(), other.viscosity());
        tally.push(self.strength(viscosity, pair, own, other));
    }
}

/// Friction within the liquid.
#[derive(Clone, Copy, Debug)]
struct Within(Friction);

impl<R: Real, const D: usize> Pass<R, D> for Within {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let viscosity = harmonic_mean(own.viscosity(), other.viscosity());
        rub(
            self.0.strength(viscosity, pair, own, other),
            pair,
            other,
            sums,
        );
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        self.0.accelerate(own, sums, i, out);
    }
}

/// Friction at a wall to which the liquid sticks, and which has the viscosity of the liquid at it.
#[derive(Clone, Copy, Debug)]
struct AtWall(Friction);

impl<R: Real, const D: usize> Pass<R, D> for AtWall {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        rub(
            self.0.strength(own.viscosity(), pair, own, other),
            pair,
            other,
            sums,
        );
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        self.0.accelerate(own, sums, i, out);
    }
}

#[cfg(test)]
mod tests {
    use super::harmonic_mean;

    #[test]
    fn the_harmonic_mean_is_finite_beside_what_lanes_out_of_reach_hold() {
        assert_eq!(harmonic_mean(3.0f32, 6.0), 4.0);
        assert_eq!(harmonic_mean(0.0f32, 0.0), 0.0);
        for pressure in [-99.295_425f32, -99.295_42, -1e9, 1e9, 0.0] {
            let mean = harmonic_mean(99.295_425, pressure);
            assert!(
                (0.0..=2.0 * 99.295_425).contains(&mean),
                "{mean} beside {pressure}"
            );
        }
    }
}
