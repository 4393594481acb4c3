//! One pair at a time, in double precision: for sums outside the sweep that must agree with it.

use super::{Other, Own, Pair, SLOTS, Splat, Sums, Tally};
use crate::effects::PairTerm;
use crate::kernel::KernelName;
use crate::simd::{Lanes, dot};

/// Constants of the kernel.
#[derive(Clone, Copy, Debug)]
pub struct Single<const D: usize> {
    kernel: KernelName,
    h: f64,
    support2: f64,
}

impl<const D: usize> Single<D> {
    /// For a kernel with smoothing length `h` in m.
    pub fn new(kernel: KernelName, h: f64) -> Self {
        Single {
            kernel,
            h,
            support2: (h * kernel.support()).powi(2),
        }
    }

    /// Whether two particles a `separation` apart see each other.
    #[inline]
    pub fn reaches(&self, separation: &[f64; D]) -> bool {
        dot(separation, separation) < self.support2
    }

    /// What `term` adds to the vector sum of the particle with the fields `own` for the neighbour with the fields
    /// `other`, at `separation = r_own - r_other`.
    #[inline]
    pub fn vector<T: PairTerm<f64, D>>(
        &self,
        term: &T,
        separation: &[f64; D],
        own: &[f64; SLOTS],
        other: &[f64; SLOTS],
    ) -> [f64; D] {
        let squared = dot(separation, separation);
        let q = squared.max(1e-18 * self.h * self.h).sqrt() / self.h;
        let sigma = self.kernel.normalisation(D);
        let pair = Pair::<f64, D> {
            separation: *separation,
            squared,
            slope: sigma / self.h.powi(D as i32 + 2) * self.kernel.slope_over_q(q),
            q,
            inside: squared.less(self.support2),
            normalisation: sigma / self.h.powi(D as i32),
            kernel: self.kernel,
        };
        // Fields behind D positions, one number each, as in the sweep's buffers.
        let mut buffer = [0.0; 3 + SLOTS];
        buffer[D..D + SLOTS].copy_from_slice(other);
        let other = Other::<f64, D> {
            at: buffer.as_ptr(),
            stride: 1,
        };
        let own = Own { fields: *own };
        let own = Splat(&own);
        let (mut sums, mut opposite) = (Sums::zero(), Sums::zero());
        let mut tally = Tally::new(&mut sums, &mut opposite, own.volume(), other.volume());
        term.add(&pair, &own, &other, &mut tally);
        tally.close(term.uses(), &pair, 1.0, 1.0);
        sums.vector
    }
}
