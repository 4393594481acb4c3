//! Some of a grid's cells, and which of them one set of particles has near another.

use super::grid::{Cells, Grid};
use rayon::prelude::*;

const BITS: usize = u64::BITS as usize;
/// Words of a task: as many cells as are worth one.
const TASK: usize = 64;

/// Some cells, a bit each.
#[derive(Clone, Debug, Default)]
pub struct CellSet(Vec<u64>);

impl CellSet {
    /// The first cell of the set from `cell` on, `end` if there is none before that.
    #[inline(always)]
    pub fn next(&self, cell: usize, end: usize) -> usize {
        let mut word = cell / BITS;
        let mut bits = self.0.get(word).map_or(0, |w| w >> (cell % BITS));
        if bits != 0 {
            return (cell + bits.trailing_zeros() as usize).min(end);
        }
        while (word + 1) * BITS < end {
            word += 1;
            bits = self.0.get(word).map_or(0, |&w| w);
            if bits != 0 {
                return (word * BITS + bits.trailing_zeros() as usize).min(end);
            }
        }
        end
    }
}

/// The cells of a set of particles that another set reaches, until one of them is sorted again. Few particles of a tank's
/// walls are near the fluid: work is done for these, and once more for those that the fluid has left.
#[derive(Clone, Debug, Default)]
pub struct Reached {
    now: CellSet,
    due: CellSet,
    /// Editions of the cells of the set and of those of the other.
    of: [u64; 2],
}

impl Reached {
    /// The cells of `own` for which something is to be done: those with particles of `other` in or beside them, and those
    /// that had some when last asked; all of them where `own` has changed.
    pub fn due<const D: usize>(&mut self, grid: &Grid<D>, own: &Cells, other: &Cells) -> &CellSet {
        let of = [own.edition(), other.edition()];
        if of == self.of {
            self.due.0.copy_from_slice(&self.now.0);
            return &self.due;
        }
        let unknown = self.of[0] != of[0];
        self.of = of;
        let words = own.count().div_ceil(BITS);
        self.now.0.resize(words, 0);
        self.due.0.resize(words, 0);
        let now = self.now.0.par_iter_mut().with_min_len(TASK);
        now.zip(&mut self.due.0)
            .enumerate()
            .for_each(|(word, (now, due))| {
                let before = if unknown { u64::MAX } else { *now };
                *now = reached(word, grid, own, other);
                *due = before | *now;
            });
        &self.due
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        8 * (self.now.0.capacity() + self.due.0.capacity())
    }
}

/// The cells of a word in which `own` has particles and around which `other` has.
fn reached<const D: usize>(word: usize, grid: &Grid<D>, own: &Cells, other: &Cells) -> u64 {
    let (first, end) = (word * BITS, ((word + 1) * BITS).min(own.count()));
    if own.particles(first, end).is_empty() {
        return 0;
    }
    let inhabited = |cells: &Cells, first, end| !cells.particles(first, end).is_empty();
    (first..end).fold(0, |bits, cell| {
        let near = inhabited(own, cell, cell + 1)
            && (grid.around(cell).iter()).any(|run| inhabited(other, run.first, run.end));
        bits | u64::from(near) << (cell - first)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::neighbours::Sorter;

    /// Particles at `x` in a row of 200 cells with an edge of 1.
    fn sorted(grid: &Grid<2>, x: &[f64]) -> Cells {
        let mut cells = Cells::new(grid.count(), Grid::<2>::PARTS);
        Sorter::new(x.len()).sort(&mut cells, |i| grid.bin(&[x[i], 1.5]));
        cells
    }

    fn members(set: &CellSet, from: usize, end: usize) -> Vec<usize> {
        let mut found = Vec::new();
        let mut cell = set.next(from, end);
        while cell < end {
            found.push(cell);
            cell = set.next(cell + 1, end);
        }
        found
    }

    #[test]
    fn only_cells_within_reach_are_due_and_once_those_just_left() {
        let grid = Grid::<2>::new([0.0, 0.0], [199.5, 2.5], 1.0, [None; 2], 10_000);
        let wall: Vec<f64> = (0..200).map(|k| f64::from(k) + 0.5).collect();
        let wall = sorted(&grid, &wall);
        let at =
            |cells: std::ops::RangeInclusive<usize>| cells.map(|c| 200 + c).collect::<Vec<_>>();
        let mut reached = Reached::default();

        let fluid = sorted(&grid, &[63.2, 64.7]);
        let all = reached.due(&grid, &wall, &fluid);
        assert_eq!(members(all, 200, 400), at(0..=199));
        let due = reached.due(&grid, &wall, &fluid);
        assert_eq!(members(due, 0, 600), at(62..=65));
        assert_eq!(members(due, 264, 265), [264]);

        let gone = sorted(&grid, &[130.1]);
        let due = reached.due(&grid, &wall, &gone);
        let both: Vec<usize> = at(62..=65).into_iter().chain(at(129..=131)).collect();
        assert_eq!(members(due, 0, 600), both);
        let due = reached.due(&grid, &wall, &gone);
        assert_eq!(members(due, 0, 600), at(129..=131));
        assert_eq!(due.next(0, 200), 200);
    }
}
