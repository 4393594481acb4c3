//! Buffers of one thread, kept between sweeps.

use super::gather::{Buffer, Hit, Line, stride_for};
use super::sums::{SUMS, SumColumns, Sums};
use crate::particles::PAD;
use crate::simd::{Lanes, Real};
use std::ops::Range;

/// Buffers of one thread.
pub(super) struct Workspace<R> {
    /// Fluid and wall particles around a cell.
    pub(super) candidates: [Buffer<R>; 2],
    /// Those in reach of a cluster.
    pub(super) selected: [Buffer<R>; 2],
    /// Where the selected came from.
    pub(super) hits: [Vec<Hit>; 2],
    /// Sums of the fluid candidates and of the selected ones.
    pub(super) reactions: [Reactions<R>; 2],
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
            hits: std::array::from_fn(|_| vec![Hit::default(); room + PAD]),
            reactions: std::array::from_fn(|_| Reactions::new(room)),
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
        let buffers = self.candidates.iter().chain(&self.selected);
        buffers.map(Buffer::bytes).sum::<usize>()
            + self
                .hits
                .iter()
                .map(|h| h.capacity() * size_of::<Hit>())
                .sum::<usize>()
            + self.reactions.iter().map(Reactions::bytes).sum::<usize>()
    }
}

/// What the particles of a buffer get from others: sums side by side.
pub(super) struct Reactions<R> {
    data: Vec<Line<R>>,
    stride: usize,
}

impl<R: Real> Reactions<R> {
    fn new(particles: usize) -> Self {
        let stride = stride_for(particles);
        Reactions {
            data: vec![Line::default(); stride / PAD * SUMS],
            stride,
        }
    }

    fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<Line<R>>()
    }

    #[inline(always)]
    fn column(&mut self, c: usize) -> *mut R {
        self.data
            .as_mut_ptr()
            .cast::<R>()
            .wrapping_add(c * self.stride)
    }

    /// Nothing yet, for `particles` in the columns `used`.
    #[inline(always)]
    pub(super) fn clear<L: Lanes<Real = R>>(&mut self, used: &[bool; SUMS], particles: usize) {
        if particles + PAD > self.stride {
            *self = Reactions::new(particles * 3 / 2);
        }
        for c in 0..SUMS {
            if used[c] {
                let column = self.column(c);
                for k in (0..particles).step_by(L::N) {
                    // SAFETY: there is room for `particles` and a vector more.
                    unsafe { L::zero().store(column.add(k)) };
                }
            }
        }
    }

    /// The sums of the vector of particles at `k`.
    ///
    /// # Safety
    /// `k` must be below the number of particles cleared.
    #[inline(always)]
    pub(super) unsafe fn load<L: Lanes<Real = R>, const D: usize>(
        &mut self,
        used: &[bool; SUMS],
        k: usize,
    ) -> Sums<L, D> {
        let mut sums = Sums::zero();
        for c in 0..SUMS {
            if used[c] {
                // SAFETY: promised by the caller.
                *sums.column_mut(c) = unsafe { L::load(self.column(c).add(k)) };
            }
        }
        sums
    }

    /// Puts them back.
    ///
    /// # Safety
    /// As for [`Reactions::load`].
    #[inline(always)]
    pub(super) unsafe fn store<L: Lanes<Real = R>, const D: usize>(
        &mut self,
        used: &[bool; SUMS],
        k: usize,
        sums: &mut Sums<L, D>,
    ) {
        for c in 0..SUMS {
            if used[c] {
                // SAFETY: promised by the caller.
                unsafe { sums.column_mut(c).store(self.column(c).add(k)) };
            }
        }
    }

    /// Gives the sums of `selected`, but for its first `cluster` particles, to the candidates from which `hits` chose
    /// them.
    #[inline(always)]
    pub(super) fn take_back<L: Lanes<Real = R>>(
        &mut self,
        selected: &mut Reactions<R>,
        used: &[bool; SUMS],
        hits: &[Hit],
        cluster: usize,
    ) {
        for c in 0..SUMS {
            if !used[c] {
                continue;
            }
            let (from, to) = (selected.column(c), self.column(c));
            // SAFETY: both were cleared for as many particles as `hits` speaks of.
            unsafe {
                for k in 0..cluster {
                    *from.add(k) = R::default();
                }
                let mut at = 0;
                for hit in hits {
                    let place = to.add(hit.at as usize);
                    (L::load(place) + L::expand_load(hit.bits, from.add(at))).store(place);
                    at += hit.bits.count_ones() as usize;
                }
            }
        }
    }

    /// Adds the sums from place `at` on to the particles `range` of `columns`.
    ///
    /// # Safety
    /// Nobody else may touch the particles `range` of `columns`.
    #[inline(always)]
    pub(super) unsafe fn add_to<L: Lanes<Real = R>>(
        &mut self,
        used: &[bool; SUMS],
        at: usize,
        range: Range<usize>,
        columns: &SumColumns<R>,
    ) {
        for c in 0..SUMS {
            if !used[c] {
                continue;
            }
            // SAFETY: promised by the caller.
            unsafe {
                let (from, to) = (self.column(c).add(at), columns.0[c].add(range.start));
                let whole = range.len() / L::N * L::N;
                for k in (0..whole).step_by(L::N) {
                    (L::load(to.add(k)) + L::load(from.add(k))).store(to.add(k));
                }
                L::load(from.add(whole)).add_first(range.len() - whole, to.add(whole));
            }
        }
    }
}
