//! A pair term in sweeps of its own: how an effect that few scenes call for is written as a term and costs no variant of
//! the sweep of forces.

use super::stage::{Around, Stage, Touch, sweep};
use super::{Declaration, PairTerm};
use crate::particles::Fluid;
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Output, Own, Pair, Pass, Source, Splat, Sums, Tally, slot};

/// The force density of a pair term between fluid particles, and between fluid and wall, added to the acceleration.
pub struct Added<T> {
    term: T,
    declaration: Declaration,
    /// `1/ρ0`.
    specific_volume: f64,
    /// Whether it acts between fluid and wall, too.
    at_walls: bool,
}

impl<T> Added<T> {
    /// A term that is described by its declaration, for a density at rest.
    pub fn new(term: T, declaration: Declaration, reference_density: f64, at_walls: bool) -> Self {
        Added {
            term,
            declaration,
            specific_volume: 1.0 / reference_density,
            at_walls,
        }
    }
}

impl<R: Real, T, const D: usize> Stage<R, D> for Added<T>
where
    T: PairTerm<R, D> + PairTerm<f64, D>,
{
    fn declaration(&self) -> Declaration {
        self.declaration
    }

    fn run(&mut self, around: Around<R, D>) {
        let with = (around.grid, around.sweeper, around.kernel);
        let Fluid {
            position,
            cells,
            volume,
            pressure,
            condensation,
            pair_velocity,
            acceleration,
            ..
        } = around.fluid;
        let pass = Adding {
            term: self.term,
            specific_volume: self.specific_volume,
        };
        let fluid = Source::new(position, cells)
            .with(slot::VOLUME, volume)
            .with(slot::PRESSURE, pressure)
            .with(slot::CONDENSATION, condensation)
            .with_vector(slot::VELOCITY, pair_velocity);
        sweep(with, &fluid, &fluid, &pass, acceleration.iter_mut());
        if let Some(w) = around.wall.filter(|_| self.at_walls) {
            let wall = Source::new(&w.position, &w.cells)
                .with(slot::VOLUME, &w.volume)
                .with(slot::PRESSURE, &w.pressure)
                .with(slot::CONDENSATION, &w.condensation)
                .with_vector(slot::VELOCITY, &w.pair_velocity);
            sweep(with, &fluid, &wall, &pass, acceleration.iter_mut());
        }
    }

    fn reaction(&self, at: &Touch<D>) -> [f64; D] {
        if self.at_walls {
            at.single
                .vector(&self.term, at.separation, at.wall, at.fluid)
        } else {
            [0.0; D]
        }
    }

    fn bytes(&self) -> usize {
        0
    }
}

/// The pass of [`Added`].
#[derive(Clone, Copy, Debug)]
struct Adding<T> {
    term: T,
    specific_volume: f64,
}

impl<R: Real, T: PairTerm<R, D>, const D: usize> Pass<R, D> for Adding<T> {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let (force, _, _) = Tally::of(&self.term, pair, own, other);
        for a in 0..D {
            sums.vector[a] = other.volume().mul_add(force[a], sums.vector[a]);
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
            out[a][i] += sums.vector[a].sum() * scale;
        }
    }
}
