//! Whole-array passes on the simulation's threads.

use rayon::prelude::*;
use std::ops::Range;

/// Particles per task of a whole-array pass. Fixed, so that reductions group the same way for any number of threads.
pub const GRAIN: usize = 4096;

/// A column shared by tasks that write to ranges of their own.
#[derive(Clone, Copy)]
pub struct Shared<T>(*mut T);

// SAFETY: `range` is the only access, and its callers promise disjoint ranges.
unsafe impl<T: Send> Send for Shared<T> {}
// SAFETY: as above.
unsafe impl<T: Send> Sync for Shared<T> {}

impl<T> Shared<T> {
    /// Shares a column for the duration of one parallel pass.
    pub fn new(column: &mut [T]) -> Self {
        Shared(column.as_mut_ptr())
    }

    /// The same, of a column known by its first number.
    pub(crate) fn from_raw(column: *mut T) -> Self {
        Shared(column)
    }

    /// The part of the column that a task works on.
    ///
    /// # Safety
    /// The column must outlive the pass, `range` must lie inside it, and no two tasks may hold overlapping ranges.
    #[inline(always)]
    pub unsafe fn range<'a>(&self, range: &Range<usize>) -> &'a mut [T] {
        // SAFETY: promised by the caller.
        unsafe { std::slice::from_raw_parts_mut(self.0.add(range.start), range.len()) }
    }

    /// Writes one number.
    ///
    /// # Safety
    /// `index` must lie inside the column and be written by one task only.
    #[inline(always)]
    pub unsafe fn write(&self, index: usize, value: T) {
        // SAFETY: promised by the caller.
        unsafe { self.0.add(index).write(value) }
    }
}

/// The `k`-th grain of `n` particles.
#[inline]
fn grain(k: usize, n: usize) -> Range<usize> {
    k * GRAIN..((k + 1) * GRAIN).min(n)
}

/// Runs `work` over `0..n` in ranges of [`GRAIN`] and folds the results with `join`, which must be associative and
/// commutative to the bit (minimum, maximum, and).
pub fn for_ranges<T: Send>(
    n: usize,
    identity: impl Fn() -> T + Sync + Send,
    join: impl Fn(T, T) -> T + Sync + Send,
    work: impl Fn(Range<usize>) -> T + Sync + Send,
) -> T {
    (0..n.div_ceil(GRAIN))
        .into_par_iter()
        .map(|k| work(grain(k, n)))
        .reduce(identity, join)
}

/// Runs `work` over `0..n` in ranges of [`GRAIN`].
#[inline(always)]
pub fn for_each_range(n: usize, work: impl Fn(Range<usize>) + Sync + Send) {
    for_ranges(n, || (), |(), ()| (), work);
}

/// Reorders `column` so that its `k`-th entry is the former `order[k]`-th, by way of `scratch`.
pub fn permute<T: Copy + Send + Sync>(column: &mut [T], order: &[u32], scratch: &mut [T]) {
    scratch
        .par_chunks_mut(GRAIN)
        .zip(order.par_chunks(GRAIN))
        .for_each(|(out, order)| {
            for (o, &k) in out.iter_mut().zip(order) {
                *o = column[k as usize];
            }
        });
    column
        .par_chunks_mut(GRAIN)
        .zip(scratch.par_chunks(GRAIN))
        .for_each(|(c, s)| c.copy_from_slice(s));
}

/// Sum of `term` over `0..n` in double precision, in an order that does not depend on the number of threads.
pub fn sum<const M: usize>(n: usize, term: impl Fn(usize) -> [f64; M] + Sync + Send) -> [f64; M] {
    fn tree<const M: usize>(
        range: Range<usize>,
        term: &(impl Fn(usize) -> [f64; M] + Sync + Send),
    ) -> [f64; M] {
        if range.len() <= GRAIN {
            let mut s = [0.0; M];
            for i in range {
                let t = term(i);
                for k in 0..M {
                    s[k] += t[k];
                }
            }
            return s;
        }
        let grains = range.len().div_ceil(GRAIN);
        let middle = range.start + grains / 2 * GRAIN;
        let (a, b) = rayon::join(
            || tree(range.start..middle, term),
            || tree(middle..range.end, term),
        );
        std::array::from_fn(|k| a[k] + b[k])
    }
    tree(0..n, &term)
}
