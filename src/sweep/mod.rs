//! The pair sweep: the only hot loop.
//!
//! A pass sums something over the neighbours of every particle of a target set. Cell by cell, the candidates of the
//! 3^D cells around are copied side by side, relative to a frame at the cell (positions are in double precision, their
//! differences in the pair precision lose nothing). For each small cluster of the cell's particles those within reach
//! of its bounding box are compacted, and each particle of the cluster then runs over them in whole vectors: no list
//! is stored, nothing is gathered by index, and every particle's sum is its own, so that its bits do not depend on
//! threads.

mod gather;
mod geometry;
mod moment;
mod pair;
mod single;
mod slab;

pub use pair::{Other, Own, Pair, Splat, relative_velocity, slot};
pub use single::Single;

use crate::kernel::KernelName;
use crate::neighbours::{Cells, Grid};
use crate::particles::Column;
use crate::simd::{Lanes, Real, dispatch};
use slab::{Slab, Workspace};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Fields that a source can carry (`slot`).
pub const SLOTS: usize = 9;
/// Particles that should share one selection of candidates: a larger cluster selects more that not all of it need, a
/// smaller one selects too often.
const CLUSTER: f64 = 6.0;
/// Least particles of one task.
const TASK: usize = 512;

/// Most columns that a pass writes.
pub const OUTPUTS: usize = 6;

/// Running sums of a pass over the neighbours of one particle; those that a pass does not use cost nothing.
pub struct Sums<L, const D: usize> {
    /// A scalar.
    pub scalar: L,
    /// A vector.
    pub vector: [L; D],
    /// A second vector.
    pub gradient: [L; D],
    /// A symmetric matrix: xx, yy, xy, then zz, yz, xz.
    pub moment: [L; 6],
}

impl<L: Lanes, const D: usize> Sums<L, D> {
    #[inline(always)]
    /// Nothing summed yet.
    pub fn zero() -> Self {
        Sums {
            scalar: L::zero(),
            vector: [L::zero(); D],
            gradient: [L::zero(); D],
            moment: [L::zero(); 6],
        }
    }
}

/// What is summed over neighbours, and what is made of the sums. Methods must be `#[inline(always)]`.
pub trait Pass<R: Real, const D: usize>: Sync {
    /// Adds a vector of fluid neighbours.
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    );

    /// Adds a vector of wall neighbours.
    fn wall<L: Lanes<Real = R>>(
        &self,
        _pair: &Pair<L, D>,
        _own: &Splat<L, D>,
        _other: &Other<L, D>,
        _sums: &mut Sums<L, D>,
    ) {
    }

    /// Makes the output of particle `i` of a task from its sums.
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    );
}

/// The columns that a pass writes: the first `D` for its vector, and so on, as the pass defines.
pub type Output<'a, R> = [&'a mut [R]; OUTPUTS];

/// A set of particles as pairs see it.
pub struct Source<'a, R, const D: usize> {
    /// Positions in m.
    pub position: &'a [Column<f64>; D],
    /// Particles by cell.
    pub cells: &'a Cells,
    fields: [(usize, *const R); SLOTS],
    count: usize,
}

// SAFETY: the pointers are to columns borrowed for 'a and only read.
unsafe impl<R: Sync, const D: usize> Sync for Source<'_, R, D> {}

impl<'a, R: Real, const D: usize> Source<'a, R, D> {
    /// A set without fields.
    pub fn new(position: &'a [Column<f64>; D], cells: &'a Cells) -> Self {
        Source {
            position,
            cells,
            fields: [(0, std::ptr::null()); SLOTS],
            count: 0,
        }
    }

    /// Adds a scalar field.
    pub fn with(mut self, slot: usize, column: &'a Column<R>) -> Self {
        assert_eq!(column.len(), self.position[0].len());
        self.fields[self.count] = (slot, column.as_ptr());
        self.count += 1;
        self
    }

    /// Adds the components of a vector field.
    pub fn with_vector(self, slot: usize, columns: &'a [Column<R>; D]) -> Self {
        (0..D).fold(self, |s, a| s.with(slot + a, &columns[a]))
    }

    #[inline(always)]
    fn fields(&self) -> &[(usize, *const R)] {
        &self.fields[..self.count]
    }

    #[inline(always)]
    fn own(&self, i: usize) -> Own<R, D> {
        let mut fields = [R::default(); SLOTS];
        for &(slot, column) in self.fields() {
            // SAFETY: `i` is a particle of this set.
            fields[slot] = unsafe { *column.add(i) };
        }
        Own { fields }
    }
}

/// What stays between sweeps: buffers per thread, the kernel's constants.
pub struct Sweeper<R> {
    workspaces: Vec<Mutex<Workspace<R>>>,
    smoothing_length: f64,
    parts_per_cluster: usize,
}

/// One pass over a target set.
pub struct Sweep<'a, R, P, const D: usize> {
    /// The grid of both sets.
    pub grid: &'a Grid<D>,
    /// For whom sums are made.
    pub target: &'a Source<'a, R, D>,
    /// Its fluid neighbours.
    pub fluid: Option<&'a Source<'a, R, D>>,
    /// Its wall neighbours.
    pub wall: Option<&'a Source<'a, R, D>>,
    /// What is summed.
    pub pass: &'a P,
}

impl<R: Real> Sweeper<R> {
    /// Buffers for `threads` threads, and clusters for `per_cell` particles in each cell of `parts` parts.
    pub fn new(threads: usize, smoothing_length: f64, per_cell: f64, parts: usize) -> Self {
        let mut parts_per_cluster = parts;
        while parts_per_cluster > 1
            && per_cell * (parts_per_cluster as f64) > 1.4 * CLUSTER * parts as f64
        {
            parts_per_cluster /= 2;
        }
        Sweeper {
            workspaces: (0..threads.max(1))
                .map(|_| Mutex::new(Workspace::new(per_cell, parts.ilog2() as usize)))
                .collect(),
            smoothing_length,
            parts_per_cluster,
        }
    }

    /// Forgets what the buffers hold.
    pub fn wipe(&self) {
        for workspace in &self.workspaces {
            workspace
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .wipe();
        }
    }

    /// Runs a pass with `kernel`; `out` are columns of the target.
    pub fn run<P: Pass<R, D>, const D: usize>(
        &self,
        kernel: KernelName,
        sweep: &Sweep<R, P, D>,
        out: Output<R>,
    ) {
        let n = sweep.target.position[0].len();
        let tasks = (n / TASK).clamp(1, 4096);
        self.split(kernel, sweep, 0..tasks, n, tasks, out);
    }

    /// Halves the tasks until one is left; every half gets its own part of the output.
    fn split<P: Pass<R, D>, const D: usize>(
        &self,
        kernel: KernelName,
        sweep: &Sweep<R, P, D>,
        tasks: Range<usize>,
        n: usize,
        of: usize,
        out: Output<R>,
    ) {
        let cells = sweep.target.cells;
        let boundary = |task: usize| {
            if task == of {
                cells.count()
            } else {
                cells.cell_from(task * n / of)
            }
        };
        let (first, end) = (boundary(tasks.start), boundary(tasks.end));
        if first == end {
            return;
        }
        if tasks.len() == 1 {
            let thread = rayon::current_thread_index().unwrap_or(0) % self.workspaces.len();
            let mut workspace = self.workspaces[thread]
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            dispatch(Slab {
                sweep,
                h: self.smoothing_length,
                cells: first..end,
                workspace: &mut *workspace,
                out,
                kernel,
                parts_per_cluster: self.parts_per_cluster,
            });
            return;
        }
        let middle = tasks.start + tasks.len() / 2;
        let at = cells.particles(first, boundary(middle)).len();
        let mut right: Output<R> = std::array::from_fn(|_| Default::default());
        let mut left: Output<R> = std::array::from_fn(|_| Default::default());
        for (k, column) in out.into_iter().enumerate() {
            (left[k], right[k]) = if column.is_empty() {
                (column, Default::default())
            } else {
                column.split_at_mut(at)
            };
        }
        rayon::join(
            || self.split(kernel, sweep, tasks.start..middle, n, of, left),
            || self.split(kernel, sweep, middle..tasks.end, n, of, right),
        );
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.workspaces
            .iter()
            .map(|w| w.lock().unwrap_or_else(PoisonError::into_inner).bytes())
            .sum()
    }
}
