//! Candidates side by side: what lets the pair loop read whole vectors.

use super::{SLOTS, Source};
use crate::neighbours::Grid;
use crate::particles::PAD;
use crate::simd::{Lanes, Real};

/// A position out of everybody's reach, whose square is still finite in single precision.
const FAR: f64 = 1e15;

/// Distance of columns with room for `particles`: an odd number of vectors, so that columns do not meet in the same lines
/// of the cache.
fn stride_for(particles: usize) -> usize {
    ((particles / PAD + 4) | 1) * PAD
}

/// Columns of candidates: positions relative to a frame, then the fields of the source.
pub(crate) struct Buffer<R> {
    data: Vec<R>,
    stride: usize,
    len: usize,
}

impl<R: Real> Buffer<R> {
    /// Room for `particles` in `dimension` dimensions, so that a thread that comes to a sweep late need not make it.
    pub(crate) fn new(particles: usize, dimension: usize) -> Self {
        let stride = stride_for(particles);
        Buffer {
            data: vec![R::default(); stride * (dimension + SLOTS)],
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
        self.data.as_ptr().wrapping_add(c * self.stride)
    }

    #[inline(always)]
    fn column_mut(&mut self, c: usize) -> *mut R {
        self.data.as_mut_ptr().wrapping_add(c * self.stride)
    }

    pub(crate) fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<R>()
    }

    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// Forgets all numbers, so that nothing left of a broken state can be read again.
    pub(crate) fn wipe(&mut self) {
        self.data.fill(R::default());
    }

    #[cold]
    #[inline(never)]
    fn grow<const D: usize>(&mut self, needed: usize) {
        // The numbers already there move along.
        let stride = stride_for(needed * 3 / 2);
        let mut data = vec![R::default(); stride * (D + SLOTS)];
        for c in 0..D + SLOTS {
            let from = c * self.stride;
            data[c * stride..c * stride + self.len]
                .copy_from_slice(&self.data[from..from + self.len]);
        }
        (self.data, self.stride) = (data, stride);
    }

    #[inline(always)]
    fn reserve<const D: usize>(&mut self, more: usize) {
        if self.len + more + PAD > self.stride {
            self.grow::<D>(self.len + more + PAD);
        }
    }

    /// Puts particles out of reach behind the last, so that the last vector can be read whole.
    #[inline(always)]
    fn close<L: Lanes<Real = R>, const D: usize>(&mut self, slots: &[(usize, *const R)]) {
        // SAFETY: `reserve` keeps PAD numbers of room behind the last.
        unsafe {
            for a in 0..D {
                L::constant(FAR).store(self.column_mut(a).add(self.len));
            }
            for &(slot, _) in slots {
                L::zero().store(self.column_mut(D + slot).add(self.len));
            }
        }
    }

    /// All particles of `source` in the cells around `cell`, relative to `frame`.
    #[inline(always)]
    pub(crate) fn gather<L: Lanes<Real = R>, const D: usize>(
        &mut self,
        source: &Source<R, D>,
        grid: &Grid<D>,
        cell: usize,
        frame: &[f64; D],
    ) {
        self.len = 0;
        for run in grid.around(cell).iter() {
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
        self.close::<L, D>(source.fields());
    }

    /// Those of `all` within `reach` of the box from `low` to `high`.
    #[inline(always)]
    pub(crate) fn select<L: Lanes<Real = R>, const D: usize>(
        &mut self,
        all: &Buffer<R>,
        source: &Source<R, D>,
        low: &[R; D],
        high: &[R; D],
        reach: R,
    ) {
        self.len = 0;
        self.reserve::<D>(all.len);
        let reach2 = L::splat(reach * reach);
        for k in (0..all.len).step_by(L::N) {
            // SAFETY: `k` is below the length of `all`, which is closed by a vector of particles out of reach; there
            // is room for all of them here.
            unsafe {
                let x: [L; D] = std::array::from_fn(|a| L::load(all.column(a).add(k)));
                let mut r2 = L::zero();
                for a in 0..D {
                    let d = (L::splat(low[a]) - x[a])
                        .max(x[a] - L::splat(high[a]))
                        .max(L::zero());
                    r2 = d.mul_add(d, r2);
                }
                let near = r2.less(reach2);
                let count = L::count(near);
                if count == 0 {
                    continue;
                }
                for a in 0..D {
                    x[a].compress_store(near, self.column_mut(a).add(self.len));
                }
                for &(slot, _) in source.fields() {
                    let v = L::load(all.column(D + slot).add(k));
                    v.compress_store(near, self.column_mut(D + slot).add(self.len));
                }
                self.len += count;
            }
        }
        self.close::<L, D>(source.fields());
    }
}
