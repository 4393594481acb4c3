//! Which blocks of cells can be worked on at the same time when a block also adds to its neighbours.

use crate::neighbours::Grid;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks of a colour that there should be: several for each thread of a large machine.
const SHARE: f64 = 24.0;
/// Particles of a block, at most: with those around they fit in a core's cache.
const MOST: f64 = 8192.0;
/// Particles of a block, at least: fewer are not worth a task.
const LEAST: f64 = 256.0;

/// The grid in blocks, of two colours along each axis. With the cells ahead of them, blocks reach one cell further than
/// they are, so that blocks of one colour never add to the same particles.
///
/// Blocks and colours depend on the grid and on the number of particles alone, so that sums have the same order for any
/// number of threads.
pub(super) struct Blocks<const D: usize> {
    cells: [usize; D],
    /// Blocks along each axis: one, or an even number, since the grid is a torus.
    count: [usize; D],
}

/// The cells of a block.
pub(super) struct BlockOfCells<const D: usize> {
    cells: [usize; D],
    from: [usize; D],
    to: [usize; D],
}

impl<const D: usize> Blocks<D> {
    /// For `particles` particles, `per_cell` in each cell.
    pub(super) fn new(grid: &Grid<D>, per_cell: f64, particles: usize) -> Self {
        let cells = grid.shape();
        let share = particles as f64 / (SHARE * f64::from(1 << D as u32));
        let volume = (share.clamp(LEAST, MOST) / per_cell.max(1.0)).max(1.0);
        // Twice as long as wide: what a row reads is contiguous.
        let side = (0.5 * volume).powf(1.0 / D as f64);
        let count = std::array::from_fn(|a| {
            let edge = if a == 0 { 2.0 * side } else { side };
            // Two cells at least, for a block also adds to the cells before it, but on the last axis.
            let blocks = cells[a] / (edge.round() as usize).max(2);
            (blocks & !1).max(1)
        });
        Blocks { cells, count }
    }

    /// Number of blocks.
    pub(super) fn count(&self) -> usize {
        self.count.iter().product()
    }

    /// Runs `work` on every block with its number, colour by colour.
    pub(super) fn for_each(&self, work: impl Fn(usize, &BlockOfCells<D>) + Sync) {
        for colour in 0..1usize << D {
            let of_axis = |a: usize| colour >> a & 1;
            if (0..D).any(|a| self.count[a] == 1 && of_axis(a) == 1) {
                continue;
            }
            let members = self.count.map(|c| c.div_ceil(2));
            (0..members.iter().product::<usize>())
                .into_par_iter()
                .with_max_len(1)
                .for_each(|k| {
                    let mut rest = k;
                    let at: [usize; D] = std::array::from_fn(|a| {
                        let m = rest % members[a];
                        rest /= members[a];
                        2 * m + of_axis(a)
                    });
                    let cut = |a: usize, b: usize| b * self.cells[a] / self.count[a];
                    let block = BlockOfCells {
                        cells: self.cells,
                        from: std::array::from_fn(|a| cut(a, at[a])),
                        to: std::array::from_fn(|a| cut(a, at[a] + 1)),
                    };
                    let number = (0..D).rev().fold(0, |n, a| n * self.count[a] + at[a]);
                    work(number, &block);
                });
        }
    }
}

impl<const D: usize> BlockOfCells<D> {
    /// Number of rows of cells along the first axis.
    pub(super) fn rows(&self) -> usize {
        (1..D).map(|a| self.to[a] - self.from[a]).product()
    }

    /// The cells of a row.
    pub(super) fn row(&self, k: usize) -> Range<usize> {
        let (mut rest, mut base, mut stride) = (k, 0, self.cells[0]);
        for a in 1..D {
            let extent = self.to[a] - self.from[a];
            base += (self.from[a] + rest % extent) * stride;
            rest /= extent;
            stride *= self.cells[a];
        }
        base + self.from[0]..base + self.to[0]
    }
}
