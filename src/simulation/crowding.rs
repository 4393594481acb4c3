//! How close particles come to each other.
//!
//! Only pairs much nearer than a spacing matter, and the parts that cells are sorted into are wider than that: a particle
//! looks into the parts that touch its own.

use super::solver::Solver;
use crate::neighbours::Grid;
use crate::particles::for_ranges;
use crate::simd::Real;

/// Particles nearer than this share of a spacing to another are crowded.
const CROWDED: f64 = 0.5;

/// How close particles of the fluid are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowding {
    /// Distance of the closest pair in initial spacings; infinite if no two are near.
    pub closest: f64,
    /// Particles with another nearer than half a spacing.
    pub crowded: u64,
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// How close the fluid's particles are; pairs further apart than a spacing may be overlooked.
    pub fn crowding(&self) -> Crowding {
        let limit = (CROWDED * self.config.spacing).powi(2);
        let (nearest, crowded) = self.reduce_near(true, |nearest| u64::from(nearest < limit));
        Crowding {
            closest: nearest.sqrt() / self.config.spacing,
            crowded,
        }
    }

    /// Distance of the closest pair in spacings.
    pub(super) fn closest_pair(&self) -> f64 {
        self.reduce_near(false, |_| 0).0.sqrt() / self.config.spacing
    }

    /// The least squared distance of two particles, and the sum of `count` over particles of the least squared distance
    /// to others: to all, or of each pair to one.
    fn reduce_near(&self, all: bool, count: impl Fn(f64) -> u64 + Sync + Send) -> (f64, u64) {
        if !self.primed {
            // Not sorted yet: there are no cells to search.
            return (f64::INFINITY, 0);
        }
        for_ranges(
            self.fluid.cells.count(),
            || (f64::INFINITY, 0),
            |a: (f64, u64), b: (f64, u64)| (a.0.min(b.0), a.1 + b.1),
            |range| {
                let mut sum = (f64::INFINITY, 0);
                for cell in range {
                    if self.fluid.cells.particles(cell, cell + 1).is_empty() {
                        continue;
                    }
                    for part in 0..Grid::<D>::PARTS {
                        self.look_around(cell, part, all, |nearest| {
                            sum = (sum.0.min(nearest), sum.1 + count(nearest));
                        });
                    }
                }
                sum
            },
        )
    }

    /// Hands out the least squared distance of each particle of a part of a cell to those in the parts that touch it.
    fn look_around(&self, cell: usize, part: usize, all: bool, mut found: impl FnMut(f64)) {
        let (fluid, cells) = (&self.fluid, &self.fluid.cells);
        let own = cells.bins(cell, part, part + 1);
        if own.is_empty() {
            return;
        }
        let mut near = [(0, 0, [0.0; D]); 27];
        let mut count = 0;
        let mut offset = 0;
        for run in self.grid.around(cell).iter() {
            for other in run.first..run.end {
                // The runs list the 3^D cells in the order of their offsets; of each, parts side by side are one range.
                if touches::<D>(part, offset) {
                    for bin in (0..Grid::<D>::PARTS).filter(|&bin| meets::<D>(part, offset, bin)) {
                        let range = cells.bins(other, bin, bin + 1);
                        if count > 0
                            && near[count - 1].1 == range.start
                            && near[count - 1].2 == run.shift
                        {
                            near[count - 1].1 = range.end;
                        } else {
                            near[count] = (range.start, range.end, run.shift);
                            count += 1;
                        }
                    }
                }
                offset += 1;
            }
        }
        for i in own {
            let x = fluid.at(i);
            let mut nearest = f64::INFINITY;
            for &(start, end, shift) in &near[..count] {
                let start = if all { start } else { start.max(i + 1) };
                for j in start..end {
                    let mut r2 = 0.0;
                    for a in 0..D {
                        let d = x[a] - fluid.position[a][j] - shift[a];
                        r2 += d * d;
                    }
                    if r2 < nearest && j != i {
                        nearest = r2;
                    }
                }
            }
            found(nearest);
        }
    }
}

/// Whether the cell at `offset` (the digits 0, 1, 2 of each axis, the first fastest) touches a part of the middle one.
#[inline(always)]
fn touches<const D: usize>(part: usize, mut offset: usize) -> bool {
    (0..D).all(|a| {
        let step = offset % 3;
        offset /= 3;
        // Lower halves touch what is below, upper halves what is above.
        step == 1 || (step == 2) == (part >> a & 1 == 1)
    })
}

/// Whether the part `other` of the cell at `offset` touches `part` of the middle one.
#[inline(always)]
fn meets<const D: usize>(part: usize, mut offset: usize, other: usize) -> bool {
    (0..D).all(|a| {
        let step = offset % 3;
        offset /= 3;
        step == 1 || (other >> a & 1) != (part >> a & 1)
    })
}
