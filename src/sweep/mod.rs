//! The pair sweep: the only hot loop.
//!
//! Cell by cell, the candidates of the cells around are copied side by side, relative to a frame at the cell (positions
//! are in double precision, their differences in the pair precision lose nothing). For each small cluster of the cell's
//! particles those within reach of its bounding box are compacted, and each particle of the cluster then runs over them
//! in whole vectors: no list is stored, nothing is gathered by index.
//!
//! A [`Pass`] sums something for every particle of a target set over another set. A [`PairPass`] sums over pairs of one
//! set, each computed once for both of its particles, and over the walls around. Every sum has an order that depends on
//! the grid alone, so that its bits do not depend on threads.

mod colours;
mod gather;
mod geometry;
mod moment;
mod pair;
mod pairs;
mod single;
mod slab;
mod sums;
mod workspace;

pub use pair::{Other, Own, Pair, Splat, relative_velocity, slot};
pub use pairs::{PairPass, Pairs, Totals};
pub use single::Single;
pub use sums::{ALONE, SumColumns, Sums, Tally, Uses};

use crate::kernel::KernelName;
use crate::neighbours::{CellSet, Cells, Grid};
use crate::particles::{Column, for_each_range};
use crate::simd::{Lanes, Real, dispatch};
use colours::{BlockOfCells, Blocks, Inhabited};
use pairs::Block;
use slab::Slab;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use workspace::Workspace;

/// Fields that a source can carry (`slot`).
pub const SLOTS: usize = 10;
/// Particles that should share one selection of candidates: a larger cluster selects more that not all of it need, a
/// smaller one selects too often.
const CLUSTER: f64 = 6.0;
/// Least particles of one task.
const TASK: usize = 512;

/// Most columns that a pass writes.
pub const OUTPUTS: usize = 6;

/// What is summed over neighbours in another set, and what is made of the sums. Methods must be `#[inline(always)]`.
pub trait Pass<R: Real, const D: usize>: Sync {
    /// Adds a vector of neighbours.
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    );

    /// Whether particle `i` of a task, which has no neighbours, has its output from before.
    #[inline(always)]
    fn is_settled(&self, _i: usize, _out: &Output<R>) -> bool {
        false
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
#[derive(Clone, Copy)]
pub struct Source<'a, R, const D: usize> {
    /// Positions in m.
    pub position: &'a [Column<f64>; D],
    /// Particles by cell.
    pub cells: &'a Cells,
    only: Option<&'a CellSet>,
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
            only: None,
            fields: [(0, std::ptr::null()); SLOTS],
            count: 0,
        }
    }

    /// As a target of a [`Pass`]: only its particles in the cells of a set get sums; the others keep their output.
    pub fn only_in(mut self, cells: &'a CellSet) -> Self {
        self.only = Some(cells);
        self
    }

    /// The first cell from `cell` on that may have particles to work for, `end` if there is none before that.
    #[inline(always)]
    fn next_cell(&self, cell: usize, end: usize) -> usize {
        self.only.map_or(cell, |only| only.next(cell, end))
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
    per_cell: f64,
    blocks: Mutex<Inhabited>,
}

/// One pass from a set to another.
pub struct Sweep<'a, R, P, const D: usize> {
    /// The grid of both sets.
    pub grid: &'a Grid<D>,
    /// For whom sums are made.
    pub target: &'a Source<'a, R, D>,
    /// Their neighbours.
    pub source: &'a Source<'a, R, D>,
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
            per_cell,
            blocks: Mutex::default(),
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

    /// Runs a pass over pairs with `kernel`; what it leaves stands in `columns`, which belong to the set. Gives its totals.
    pub fn run_pairs<P: PairPass<R, D>, const D: usize>(
        &self,
        kernel: KernelName,
        pairs: &Pairs<R, P, D>,
        columns: &SumColumns<R>,
    ) -> Totals {
        let n = pairs.fluid.position[0].len();
        let used = pairs.pass.uses().columns::<D>();
        let each = |work: &(dyn Fn(Range<usize>) + Sync)| for_each_range(n, work);
        for c in 0..used.len() {
            assert!(!used[c] || !columns.0[c].is_null());
        }
        each(&|range| {
            for c in 0..used.len() {
                if used[c] {
                    // SAFETY: the ranges of a pass are disjoint, and columns are as long as the set.
                    unsafe { columns.of(c).range(&range) }.fill(R::default());
                }
            }
        });
        let totals = self.blocks(kernel, pairs, columns);
        each(&|range| {
            // Known here again, for the compiler to see which are used.
            let used = pairs.pass.uses().columns::<D>();
            for i in range {
                let mut sums = Sums::zero();
                for c in 0..used.len() {
                    if used[c] {
                        // SAFETY: as above.
                        *sums.column_mut(c) = unsafe { *columns.0[c].add(i) };
                    }
                }
                pairs.pass.finish(&pairs.fluid.own(i), &mut sums);
                for c in 0..used.len() {
                    if used[c] {
                        // SAFETY: as above.
                        unsafe { *columns.0[c].add(i) = *sums.column_mut(c) };
                    }
                }
            }
        });
        totals
    }

    /// Sums over all pairs, by a pass that [collects](PairPass::collect) them.
    pub fn total<P: PairPass<R, D>, const D: usize>(
        &self,
        kernel: KernelName,
        pairs: &Pairs<R, P, D>,
    ) -> Totals {
        self.blocks(kernel, pairs, &SumColumns::default())
    }

    /// Runs a pass block by block. Totals are added in the order of blocks, whoever computed them.
    fn blocks<P: PairPass<R, D>, const D: usize>(
        &self,
        kernel: KernelName,
        pairs: &Pairs<R, P, D>,
        columns: &SumColumns<R>,
    ) -> Totals {
        let blocks = Blocks::new(pairs.grid, self.per_cell, pairs.fluid.position[0].len());
        let mut inhabited = self.blocks.lock().unwrap_or_else(PoisonError::into_inner);
        inhabited.follow(&blocks, pairs.fluid.cells);
        inhabited.for_each(&blocks, |cells| self.block(kernel, pairs, cells, columns))
    }

    /// The work of a block of cells.
    fn block<P: PairPass<R, D>, const D: usize>(
        &self,
        kernel: KernelName,
        pairs: &Pairs<R, P, D>,
        cells: &BlockOfCells<D>,
        columns: &SumColumns<R>,
    ) -> Totals {
        let mut workspace = self.workspace();
        dispatch(Block {
            pairs,
            h: self.smoothing_length,
            cells,
            workspace: &mut *workspace,
            columns,
            kernel,
            parts_per_cluster: self.parts_per_cluster,
        })
    }

    /// The buffers of this thread.
    fn workspace(&self) -> std::sync::MutexGuard<'_, Workspace<R>> {
        let thread = rayon::current_thread_index().unwrap_or(0) % self.workspaces.len();
        self.workspaces[thread]
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
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
        if first == end || sweep.target.next_cell(first, end) == end {
            return;
        }
        if tasks.len() == 1 {
            let mut workspace = self.workspace();
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
