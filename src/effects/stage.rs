//! Effects that few scenes call for: stages with sweeps of their own, which add to the acceleration.
//!
//! Fused into the sweep of forces, each would double the number of its compiled variants. A scene without them has an
//! empty list of stages.

use super::Declaration;
use crate::kernel::KernelName;
use crate::neighbours::Grid;
use crate::particles::{Column, Fluid, Wall};
use crate::simd::Real;
use crate::sweep::{Output, Pass, SLOTS, Single, Source, Sweep, Sweeper};

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

/// An effect with sweeps of its own.
pub trait Stage<R: Real, const D: usize>: Send + Sync {
    /// What it is.
    fn declaration(&self) -> Declaration;

    /// Adds to the acceleration of the fluid, behind the sweep of forces.
    fn run(&mut self, around: Around<R, D>);

    /// The longest stable time step in s, as of the last run.
    fn longest_step(&self) -> f64;

    /// The force per volume of a wall particle with the fields `wall` by the fluid particle `j` with the fields `fluid`, at
    /// `separation = r_wall - r_fluid` in reach: the reaction to what the stage does to the fluid there.
    fn reaction(
        &self,
        single: &Single<D>,
        separation: &[f64; D],
        wall: &[f64; SLOTS],
        fluid: &[f64; SLOTS],
        j: usize,
    ) -> [f64; D];

    /// Puts what it keeps of each particle in the order of the fluid, which was sorted within a step.
    fn follow(&mut self, _fluid: &mut Fluid<R, D>) {}

    /// Bytes held.
    fn bytes(&self) -> usize;
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
