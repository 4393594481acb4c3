//! Effects that few scenes call for: stages with sweeps of their own, which add to the acceleration.
//!
//! Fused into the sweep of forces, each would double the number of its compiled variants. A scene without them has an
//! empty list of stages.

use super::Declaration;
use crate::kernel::KernelName;
use crate::neighbours::Grid;
use crate::particles::{Column, Fluid, Wall};
use crate::simd::Real;
use crate::sweep::{
    Output, PairPass, Pairs, Pass, SLOTS, Single, Source, SumColumns, Sweep, Sweeper,
};

/// The particles and what sweeps need.
pub struct Around<'a, R, const D: usize> {
    /// The grid of all particles.
    pub grid: &'a Grid<D>,
    /// Buffers of the sweeps.
    pub sweeper: &'a Sweeper<R>,
    /// The smoothing kernel.
    pub kernel: KernelName,
    /// The fluid, with the acceleration that the sweep of forces has left.
    pub fluid: &'a mut Fluid<R, D>,
    /// The walls, with their values of this step.
    pub wall: Option<&'a Wall<R, D>>,
}

/// A wall particle with a fluid particle in reach.
pub struct Touch<'a, const D: usize> {
    /// Evaluates a pair term for one pair.
    pub single: &'a Single<D>,
    /// `r_wall - r_fluid` in m.
    pub separation: &'a [f64; D],
    /// Fields of the wall particle.
    pub wall: &'a [f64; SLOTS],
    /// Fields of the fluid particle.
    pub fluid: &'a [f64; SLOTS],
    /// The fluid particle.
    pub j: usize,
}

/// An effect with sweeps of its own.
pub trait Stage<R: Real, const D: usize>: Send + Sync {
    /// What it is.
    fn declaration(&self) -> Declaration;

    /// Adds to the acceleration of the fluid, behind the sweep of forces.
    fn run(&mut self, around: Around<R, D>);

    /// The longest stable time step in s, as of the last run; infinite where it sets no limit.
    fn longest_step(&self) -> f64 {
        f64::INFINITY
    }

    /// The force per volume of a wall particle by a fluid particle: the reaction to what the stage does to the fluid there,
    /// none where walls take no part.
    fn reaction(&self, _at: &Touch<D>) -> [f64; D] {
        [0.0; D]
    }

    /// Puts what it keeps of each particle in the order of the fluid, which was sorted within a step.
    fn follow(&mut self, _fluid: &mut Fluid<R, D>) {}

    /// Bytes held.
    fn bytes(&self) -> usize;
}

/// Runs a pass of a stage over pairs of `fluid`, with the walls around.
pub(super) fn sweep_pairs<R: Real, P: PairPass<R, D>, const D: usize>(
    (grid, sweeper, kernel): (&Grid<D>, &Sweeper<R>, KernelName),
    fluid: &Source<R, D>,
    wall: Option<&Source<R, D>>,
    pass: &P,
    columns: &SumColumns<R>,
) {
    let pairs = Pairs {
        grid,
        fluid,
        wall,
        pass,
    };
    sweeper.run_pairs(kernel, &pairs, columns);
}

/// Runs a pass of a stage from `source` to `target`; `columns` are those that it writes, in its order.
pub(super) fn sweep<'a, R: Real, P: Pass<R, D>, const D: usize>(
    (grid, sweeper, kernel): (&Grid<D>, &Sweeper<R>, KernelName),
    target: &Source<R, D>,
    source: &Source<R, D>,
    pass: &P,
    columns: impl IntoIterator<Item = &'a mut Column<R>>,
) {
    let mut out: Output<R> = std::array::from_fn(|_| Default::default());
    for (to, column) in out.iter_mut().zip(columns) {
        *to = &mut column[..];
    }
    let sweep = Sweep {
        grid,
        target,
        source,
        pass,
    };
    sweeper.run(kernel, &sweep, out);
}
