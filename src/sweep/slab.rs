//! The work of one task: some consecutive cells.

use super::gather::Buffer;
use super::geometry::Geometry;
use super::{Output, Pass, Sums, Sweep};
use crate::kernel::KernelName;
use crate::neighbours::Grid;
use crate::simd::{Lanes, Real, Task};
use std::ops::Range;

/// Buffers of one thread.
pub(super) struct Workspace<R> {
    candidates: [Buffer<R>; 2],
    selected: [Buffer<R>; 2],
}

impl<R: Real> Workspace<R> {
    /// For cells of `per_cell` particles in order.
    pub(super) fn new(per_cell: f64, dimension: usize) -> Self {
        // The cells around a cell, and half as much again: disorder crowds some of them.
        let room = (1.5 * per_cell.min(1000.0) * 3f64.powi(dimension as i32)) as usize;
        let pair = || [Buffer::new(room, dimension), Buffer::new(room, dimension)];
        Workspace {
            candidates: pair(),
            selected: pair(),
        }
    }

    /// Forgets all numbers.
    pub(super) fn wipe(&mut self) {
        self.candidates
            .iter_mut()
            .chain(&mut self.selected)
            .for_each(Buffer::wipe);
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.candidates
            .iter()
            .chain(&self.selected)
            .map(Buffer::bytes)
            .sum()
    }
}

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

impl<R: Real, P: Pass<R, D>, const D: usize> Task<R> for Slab<'_, '_, R, P, D> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(mut self) {
        let Sweep {
            grid,
            target,
            fluid,
            wall,
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
            candidates,
            selected,
        } = &mut *self.workspace;
        let sources = [*fluid, *wall];
        for cell in self.cells.clone() {
            let mut frame: Option<[f64; D]> = None;
            for part in (0..Grid::<D>::PARTS).step_by(self.parts_per_cluster) {
                let particles = target.cells.bins(cell, part, part + self.parts_per_cluster);
                let mut first = particles.start;
                while first < particles.end {
                    let at =
                        |i: usize| -> [f64; D] { std::array::from_fn(|a| target.position[a][i]) };
                    let near = |frame: &[f64; D], i: usize| {
                        // Written so that a position that is not a number is near nothing.
                        (0..D).all(|a| (target.position[a][i] - frame[a]).abs() <= 2.0 * edge[a])
                    };
                    let origin = match frame {
                        Some(origin) if near(&origin, first) => origin,
                        _ => {
                            let origin = at(first);
                            for (buffer, source) in candidates.iter_mut().zip(sources) {
                                if let Some(source) = source {
                                    buffer.gather::<L, D>(source, grid, cell, &origin);
                                }
                            }
                            frame = Some(origin);
                            origin
                        }
                    };
                    let mut end = first + 1;
                    while end < particles.end && near(&origin, end) {
                        end += 1;
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
                    for s in 0..2 {
                        if let Some(source) = sources[s] {
                            selected[s].select::<L, D>(&candidates[s], source, &low, &high, reach);
                        }
                    }
                    for i in first..end {
                        let own = target.own(i);
                        let x = relative(i).map(L::splat);
                        let mut sums = Sums::zero();
                        if fluid.is_some() {
                            geometry.add::<P, false>(pass, &x, &own, &selected[0], &mut sums);
                        }
                        if wall.is_some() {
                            geometry.add::<P, true>(pass, &x, &own, &selected[1], &mut sums);
                        }
                        pass.finish(&own, &sums, i - start, &mut self.out);
                    }
                    first = end;
                }
            }
        }
    }
}
