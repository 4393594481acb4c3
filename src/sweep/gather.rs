//! Candidates side by side: what lets the pair loop read whole vectors.

use super::{Own, SLOTS, Source};
use crate::neighbours::Run;
use crate::particles::PAD;
use crate::simd::{Lanes, Real};
use std::ops::Range;

/// A position out of everybody's reach, whose square is still finite in single precision.
const FAR: f64 = 1e15;

/// A vector of candidates of which some are within reach: where it starts, and which.
#[derive(Clone, Copy, Default)]
pub(crate) struct Hit {
    pub(crate) at: u32,
    pub(crate) bits: u32,
}

/// Distance of columns with room for `particles`: an odd number of vectors, so that columns do not meet in the same lines
/// of the cache.
pub(crate) fn stride_for(particles: usize) -> usize {
    ((particles / PAD + 4) | 1) * PAD
}

/// Numbers that start at a line of the cache: whole vectors are then read from one line.
#[derive(Clone, Copy, Default)]
#[repr(C, align(64))]
pub(crate) struct Line<R>([R; PAD]);

/// Columns of candidates: positions relative to a frame, then the fields of the source.
pub(crate) struct Buffer<R> {
    data: Vec<Line<R>>,
    /// Distance of columns in numbers, whole lines.
    stride: usize,
    len: usize,
}

impl<R: Real> Buffer<R> {
    /// Room for `particles` in `dimension` dimensions, so that a thread that comes to a sweep late need not make it.
    pub(crate) fn new(particles: usize, dimension: usize) -> Self {
        let stride = stride_for(particles);
        Buffer {
            data: vec![Line::default(); stride / PAD * (dimension + SLOTS)],
            stride,
            len: 0,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// First number of column `c`.
    #[inline(always)]
    pub(crate) fn column(&self, c: usize) -> *const R {
        debug_assert!(self.stride > 0 || self.len == 0);
        self.data.as_ptr().cast::<R>().wrapping_add(c * self.stride)
    }

    #[inline(always)]
    fn column_mut(&mut self, c: usize) -> *mut R {
        self.data
            .as_mut_ptr()
            .cast::<R>()
            .wrapping_add(c * self.stride)
    }

    pub(crate) fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<Line<R>>()
    }

    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// Forgets all numbers, so that nothing left of a broken state can be read again.
    pub(crate) fn wipe(&mut self) {
        self.data.fill(Line::default());
    }

    #[cold]
    #[inline(never)]
    fn grow<const D: usize>(&mut self, needed: usize) {
        // The numbers already there move along.
        let stride = stride_for(needed * 3 / 2);
        let mut data = vec![Line::default(); stride / PAD * (D + SLOTS)];
        for c in 0..D + SLOTS {
            let (from, to) = (c * self.stride / PAD, c * stride / PAD);
            let lines = self.len.div_ceil(PAD);
            data[to..to + lines].copy_from_slice(&self.data[from..from + lines]);
        }
        (self.data, self.stride) = (data, stride);
    }

    #[inline(always)]
    fn reserve<const D: usize>(&mut self, more: usize) {
        if self.len + more + PAD > self.stride {
            self.grow::<D>(self.len + more + PAD);
        }
    }

    /// Puts particles out of reach behind the last, so that the last vector can be read whole. Their fields are numbers
    /// that were there before, and count for nothing.
    #[inline(always)]
    fn close<L: Lanes<Real = R>>(&mut self) {
        // SAFETY: `reserve` keeps PAD numbers of room behind the last.
        unsafe { L::constant(FAR).store(self.column_mut(0).add(self.len)) };
    }

    /// All particles of `source` in the cells of `runs`, relative to `frame`.
    #[inline(always)]
    pub(crate) fn gather<L: Lanes<Real = R>, const D: usize>(
        &mut self,
        source: &Source<R, D>,
        runs: &[Run<D>],
        frame: &[f64; D],
    ) {
        self.len = 0;
        for run in runs {
            let range = source.cells.particles(run.first, run.end);
            if range.is_empty() {
                continue;
            }
            self.reserve::<D>(range.len());
            for a in 0..D {
                let origin = frame[a] - run.shift[a];
                let to = self.column_mut(a).wrapping_add(self.len);
                // SAFETY: columns are readable PAD numbers beyond their end, and there is room for as many.
                unsafe {
                    let from = source.position[a].as_ptr().add(range.start);
                    for k in (0..range.len()).step_by(L::N) {
                        L::load_relative(from.add(k), origin).store(to.add(k));
                    }
                }
            }
            for &(slot, column) in source.fields() {
                let to = self.column_mut(D + slot).wrapping_add(self.len);
                // SAFETY: as above.
                unsafe {
                    let from = column.add(range.start);
                    for k in (0..range.len()).step_by(L::N) {
                        L::load(from.add(k)).store(to.add(k));
                    }
                }
            }
            self.len += range.len();
        }
        self.reserve::<D>(0);
        self.close::<L>();
    }

    /// Position and fields of a particle.
    #[inline(always)]
    pub(crate) fn particle<const D: usize>(&self, k: usize) -> ([R; D], Own<R, D>) {
        // SAFETY: callers name a particle of the buffer; columns without a field hold zeros or what is not looked at.
        let at = |c: usize| unsafe { *self.column(c).add(k) };
        let fields = std::array::from_fn(|slot| at(D + slot));
        (std::array::from_fn(at), Own { fields })
    }

    /// The box around the particles `range`, of which there is at least one.
    #[inline(always)]
    pub(crate) fn bounds<const D: usize>(&self, range: Range<usize>) -> ([R; D], [R; D]) {
        let mut low = [R::default(); D];
        let mut high = low;
        for a in 0..D {
            let x = self.column(a).wrapping_add(range.start);
            // SAFETY: callers name particles of the buffer.
            unsafe {
                (low[a], high[a]) = (*x, *x);
                for k in 1..range.len() {
                    low[a] = Lanes::min(*x.add(k), low[a]);
                    high[a] = Lanes::max(*x.add(k), high[a]);
                }
            }
        }
        (low, high)
    }

    /// Puts the particles `range` out of everybody's reach.
    #[inline(always)]
    pub(crate) fn banish(&mut self, range: Range<usize>) {
        for k in range {
            // SAFETY: callers name particles of the buffer.
            unsafe { *self.column_mut(0).add(k) = R::from_f64(FAR) };
        }
    }

    /// Those of `all`, from the vector that holds place `from` on, within `reach` of the box from `low` to `high`.
    /// Leaves in `hits` the vectors where they were, and gives their number.
    #[inline(always)]
    pub(crate) fn select<L: Lanes<Real = R>, const D: usize>(
        &mut self,
        all: &Buffer<R>,
        from: usize,
        source: &Source<R, D>,
        low: &[R; D],
        high: &[R; D],
        reach: R,
        hits: &mut Vec<Hit>,
    ) -> usize {
        self.len = 0;
        self.reserve::<D>(all.len);
        if hits.len() < all.len / L::N + 1 {
            hits.resize(all.len + PAD, Hit::default());
        }
        let reach2 = L::splat(reach * reach);
        let (low, high) = (low.map(L::splat), high.map(L::splat));
        // Every other vector is out of reach and no branch could predict which: those that hold anybody near are found
        // first, then compacted.
        let mut found = 0;
        for k in (from / L::N * L::N..all.len).step_by(L::N) {
            let mut r2 = L::zero();
            for a in 0..D {
                // SAFETY: `k` is below the length of `all`, which is closed by a vector of particles out of reach.
                let x = unsafe { L::load(all.column(a).add(k)) };
                let d = (low[a] - x).max(x - high[a]).max(L::zero());
                r2 = d.mul_add(d, r2);
            }
            let bits = L::bits(r2.less(reach2));
            // SAFETY: `hits` has a place for every vector of `all`.
            unsafe {
                *hits.get_unchecked_mut(found) = Hit { at: k as u32, bits };
            }
            found += usize::from(bits != 0);
        }
        for hit in &hits[..found] {
            let k = hit.at as usize;
            // SAFETY: as above, and there is room for all particles here.
            unsafe {
                for a in 0..D {
                    L::load(all.column(a).add(k))
                        .compress_store(hit.bits, self.column_mut(a).add(self.len));
                }
                for &(slot, _) in source.fields() {
                    let v = L::load(all.column(D + slot).add(k));
                    v.compress_store(hit.bits, self.column_mut(D + slot).add(self.len));
                }
            }
            self.len += hit.bits.count_ones() as usize;
        }
        self.close::<L>();
        found
    }
}
