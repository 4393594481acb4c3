//! The work of one task of a pass from one set to another: some consecutive cells of the target.

use super::geometry::{Geometry, Visit};
use super::workspace::Workspace;
use super::{Other, Output, Own, Pair, Pass, Splat, Sums, Sweep};
use crate::kernel::KernelName;
use crate::neighbours::Grid;
use crate::simd::{Lanes, Real, Task};
use std::ops::Range;

/// Some consecutive cells: the work of one task.
pub(super) struct Slab<'a, 'b, R, P, const D: usize> {
    pub(super) sweep: &'a Sweep<'a, R, P, D>,
    pub(super) h: f64,
    pub(super) cells: Range<usize>,
    pub(super) workspace: &'a mut Workspace<R>,
    pub(super) out: Output<'b, R>,
    pub(super) kernel: KernelName,
    pub(super) parts_per_cluster: usize,
}

/// Adds a vector of neighbours to a particle.
struct One<'a, L: Lanes, P, const D: usize> {
    pass: &'a P,
    own: &'a Own<L::Real, D>,
    sums: &'a mut Sums<L, D>,
}

impl<L: Lanes, P: Pass<L::Real, D>, const D: usize> Visit<L, D> for One<'_, L, P, D> {
    #[inline(always)]
    fn vector(&mut self, pair: &Pair<L, D>, other: &Other<L, D>, _: usize) {
        self.pass.add(pair, &Splat(self.own), other, self.sums);
    }
}

impl<R: Real, P: Pass<R, D>, const D: usize> Task<R> for Slab<'_, '_, R, P, D> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(mut self) {
        let Sweep {
            grid,
            target,
            source,
            pass,
        } = self.sweep;
        let geometry = Geometry::<L, D>::new(self.kernel, self.h);
        let reach = R::from_f64(self.h * self.kernel.support() * (1.0 + 1e-5));
        let edge = grid.edge();
        let start = target
            .cells
            .particles(self.cells.start, self.cells.start)
            .start;
        let Workspace {
            candidates: [around, _],
            selected: [near, _],
            hits: [hits, _],
            ..
        } = &mut *self.workspace;
        let mut next = self.cells.start;
        loop {
            let cell = target.next_cell(next, self.cells.end);
            if cell >= self.cells.end {
                break;
            }
            next = cell + 1;
            if target.cells.particles(cell, cell + 1).is_empty() {
                continue;
            }
            let mut frame: Option<[f64; D]> = None;
            for part in (0..Grid::<D>::PARTS).step_by(self.parts_per_cluster) {
                let particles = target.cells.bins(cell, part, part + self.parts_per_cluster);
                let mut first = particles.start;
                while first < particles.end {
                    let at =
                        |i: usize| -> [f64; D] { std::array::from_fn(|a| target.position[a][i]) };
                    let beside = |frame: &[f64; D], i: usize| {
                        // Written so that a position that is not a number is near nothing.
                        (0..D).all(|a| (target.position[a][i] - frame[a]).abs() <= 2.0 * edge[a])
                    };
                    let origin = match frame {
                        Some(origin) if beside(&origin, first) => origin,
                        _ => at(first),
                    };
                    if frame != Some(origin) {
                        around.gather::<L, D>(source, &grid.around(cell), &origin);
                        frame = Some(origin);
                    }
                    let mut end = first + 1;
                    while end < particles.end && beside(&origin, end) {
                        end += 1;
                    }
                    if around.len() == 0
                        && (first..end).all(|i| pass.is_settled(i - start, &self.out))
                    {
                        first = end;
                        continue;
                    }
                    let relative = |i: usize| -> [R; D] {
                        std::array::from_fn(|a| R::from_f64(target.position[a][i] - origin[a]))
                    };
                    let mut low = relative(first);
                    let mut high = low;
                    for i in first + 1..end {
                        let x = relative(i);
                        for a in 0..D {
                            low[a] = Lanes::min(x[a], low[a]);
                            high[a] = Lanes::max(x[a], high[a]);
                        }
                    }
                    near.select::<L, D>(around, 0, source, &low, &high, reach, hits);
                    for i in first..end {
                        let own = target.own(i);
                        let x = relative(i).map(L::splat);
                        let mut sums = Sums::zero();
                        geometry.each(
                            &x,
                            near,
                            &mut One {
                                pass: *pass,
                                own: &own,
                                sums: &mut sums,
                            },
                        );
                        pass.finish(&own, &sums, i - start, &mut self.out);
                    }
                    first = end;
                }
            }
        }
    }
}
