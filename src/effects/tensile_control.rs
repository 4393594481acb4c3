//! Tensile instability control: fluid under tension is not torn into clumps.
//!
//! Where pressure is negative, `p_i + p_j` pulls particles together pair by pair, and a lattice gives way to clumps and
//! voids (Swegle, Hicks & Attaway 1995). The difference `p_j - p_i` has no such pull, and is as good a gradient wherever
//! particles are surrounded; at a free surface it would hold the fluid to nothing.

use super::stage::{Around, Stage, Touch, sweep_pairs};
use super::{Declaration, PairTerm, Quantity};
use crate::particles::{Column, Fluid, Shared, for_each_range};
use crate::simd::{Lanes, Real};
use crate::sweep::{
    Other, Own, Pair, PairPass, Source, Splat, SumColumns, Sums, Tally, Uses, slot,
};

/// Least eigenvalue of the moment matrix from which a particle is away from a free surface (Marrone et al. 2010; Sun et
/// al. 2018).
const INTERIOR: f64 = 0.75;

/// What is taken off beyond a tension, as a share of it: it acts like a slight pressure, which keeps particles evenly
/// spread. Without it nothing does where a fluid under tension is at rest, and rounding in single precision lets
/// particles wander within some ten thousand steps.
const BEYOND: f64 = 0.02;

/// What turns `p_j + p_i` into `p_j - p_i` in the sweep of forces, for particles with negative pressure away from a free
/// surface: the acceleration `2 p_i Σ V_j ∇W_ij / ρ_i` (Sun, Colagrossi, Marrone, Antuono & Zhang 2018), times 1.02. It
/// vanishes in particles evenly spread. Not antisymmetric: momentum drifts by what pressure and spread are uneven.
#[derive(Clone, Copy, Debug)]
pub struct TensileControl {
    free_surface: bool,
    specific_volume: f64,
}

impl TensileControl {
    /// For a density at rest, with a free surface or none.
    pub fn new(reference_density: f64, free_surface: bool) -> Self {
        TensileControl {
            free_surface,
            specific_volume: 1.0 / reference_density,
        }
    }

    /// The tension that is taken off a particle: its negative pressure in the interior, else nothing.
    #[inline(always)]
    fn tension<R: Real, const D: usize>(&self, pressure: R, sums: &Sums<R, D>) -> R {
        let zero = R::default();
        if self.free_surface && sums.least_moment(INTERIOR) < R::from_f64(INTERIOR) {
            return zero;
        }
        Lanes::min(pressure, zero)
    }
}

impl<R: Real, const D: usize> PairPass<R, D> for TensileControl {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            scalar: true,
            vector: true,
            moment: self.free_surface,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        _: &Splat<L, D>,
        _: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        tally.push(pair.slope);
        if self.free_surface {
            tally.moment(-pair.slope, pair);
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
        self.fluid(pair, own, other, tally);
    }

    #[inline(always)]
    fn finish(&self, own: &Own<R, D>, sums: &mut Sums<R, D>) {
        let own = own.values();
        let tension = self.tension(own.pressure(), sums);
        let density = R::from_f64(1.0) + own.condensation();
        let scale = R::from_f64((2.0 + 2.0 * BEYOND) * self.specific_volume) * tension / density;
        sums.vector = sums.vector.map(|v| v * scale);
        sums.scalar = tension;
    }
}

/// The reaction of a wall to what is taken off the fluid at it.
#[derive(Clone, Copy, Debug)]
struct AtWall;

impl<R: Real, const D: usize> PairTerm<R, D> for AtWall {
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
        _: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        tally.push(L::constant(2.0 + 2.0 * BEYOND) * other.pressure() * pair.slope);
    }
}

/// [`TensileControl`] behind the sweep of forces: a sweep of its own over pairs, and one over the particles.
pub struct TensileStage<R> {
    control: TensileControl,
    /// Tension taken off, in Pa.
    tension: Column<R>,
}

impl<R: Real> TensileStage<R> {
    /// For `n` particles.
    pub fn new(control: TensileControl, n: usize) -> Self {
        TensileStage {
            control,
            tension: Column::new(n),
        }
    }
}

impl<R: Real, const D: usize> Stage<R, D> for TensileStage<R> {
    fn declaration(&self) -> Declaration {
        TENSILE_CONTROL
    }

    fn run(&mut self, around: Around<R, D>) {
        let with = (around.grid, around.sweeper, around.kernel);
        let Fluid {
            position,
            cells,
            volume,
            condensation,
            pressure,
            acceleration,
            sums,
            ..
        } = around.fluid;
        let source = Source::new(position, cells)
            .with(slot::VOLUME, volume)
            .with(slot::PRESSURE, pressure)
            .with(slot::CONDENSATION, condensation);
        let wall = around
            .wall
            .map(|w| Source::new(&w.position, &w.cells).with(slot::VOLUME, &w.volume));
        let (moment, push) = sums.split_at_mut(D * (D + 1) / 2);
        let columns = SumColumns::default()
            .scalar(&mut self.tension)
            .vector(push.iter_mut().map(|c| &mut c[..]))
            .moment(moment.iter_mut().map(|c| &mut c[..]));
        sweep_pairs(with, &source, wall.as_ref(), &self.control, &columns);
        let push: &[Column<R>] = push;
        let n = volume.len();
        for (to, from) in acceleration.iter_mut().zip(push) {
            let to = Shared::new(to);
            for_each_range(n, |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let to = unsafe { to.range(&range) };
                for (a, b) in to.iter_mut().zip(&from[range]) {
                    *a += *b;
                }
            });
        }
    }

    fn reaction(&self, at: &Touch<D>) -> [f64; D] {
        let mut fluid = *at.fluid;
        fluid[slot::PRESSURE] = self.tension[at.j].to_f64();
        at.single.vector(&AtWall, at.separation, at.wall, &fluid)
    }

    fn follow(&mut self, fluid: &mut Fluid<R, D>) {
        fluid.reorder(&mut self.tension);
    }

    fn bytes(&self) -> usize {
        self.tension.bytes()
    }
}

/// What the effect is.
pub const TENSILE_CONTROL: Declaration = Declaration {
    name: "tensile control",
    columns: &[Quantity::Scalar("tension")],
    sweeps: 1,
    limit: None,
    dissipates: "",
    source: "Sun, Colagrossi, Marrone, Antuono & Zhang 2018",
};
