//! Which blocks of cells can be worked on at the same time when a block also adds to its neighbours.

use super::Totals;
use crate::neighbours::{Cells, Grid};
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
    fn count(&self) -> usize {
        self.count.iter().product()
    }

    /// The cells of a block, and its colour.
    fn block(&self, number: usize) -> (BlockOfCells<D>, usize) {
        let mut rest = number;
        let at: [usize; D] = std::array::from_fn(|a| {
            let place = rest % self.count[a];
            rest /= self.count[a];
            place
        });
        let cut = |a: usize, b: usize| b * self.cells[a] / self.count[a];
        let block = BlockOfCells {
            cells: self.cells,
            from: std::array::from_fn(|a| cut(a, at[a])),
            to: std::array::from_fn(|a| cut(a, at[a] + 1)),
        };
        (block, (0..D).fold(0, |c, a| c | (at[a] & 1) << a))
    }
}

/// The blocks that have particles, until these are sorted again, and what each adds to the totals.
#[derive(Default)]
pub(super) struct Inhabited {
    /// Of the particles' cells.
    edition: u64,
    /// By colour.
    blocks: [Vec<(u32, Totals)>; 8],
    /// Colour and place there, in the order of blocks.
    order: Vec<(u8, u32)>,
}

impl Inhabited {
    /// Finds the blocks that have particles, where these were sorted since it last did.
    pub(super) fn follow<const D: usize>(&mut self, blocks: &Blocks<D>, cells: &Cells) {
        if cells.edition() == self.edition {
            return;
        }
        self.edition = cells.edition();
        // Room for all at once: nothing is allocated later.
        self.order.clear();
        self.order.reserve(blocks.count());
        let members: usize = blocks.count.iter().map(|c| c.div_ceil(2)).product();
        for list in &mut self.blocks[..1 << D] {
            list.clear();
            list.reserve(members);
        }
        let has_any = |row: Range<usize>| !cells.particles(row.start, row.end).is_empty();
        for number in 0..blocks.count() {
            let (block, colour) = blocks.block(number);
            if (0..block.rows()).any(|k| has_any(block.row(k))) {
                let list = &mut self.blocks[colour];
                self.order.push((colour as u8, list.len() as u32));
                list.push((number as u32, Totals::default()));
            }
        }
    }

    /// Runs `work` on every block, colour by colour. Totals are added in the order of blocks, whoever computed them.
    pub(super) fn for_each<const D: usize>(
        &mut self,
        blocks: &Blocks<D>,
        work: impl Fn(&BlockOfCells<D>) -> Totals + Sync,
    ) -> Totals {
        for list in &mut self.blocks {
            list.par_iter_mut()
                .with_max_len(1)
                .for_each(|(number, totals)| *totals = work(&blocks.block(*number as usize).0));
        }
        let mut sum = Totals::default();
        for &(colour, place) in &self.order {
            let (_, totals) = &self.blocks[colour as usize][place as usize];
            for (s, t) in sum.iter_mut().zip(totals) {
                *s += t;
            }
        }
        sum
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
