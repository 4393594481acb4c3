//! Distances and kernel values of a particle and vectors of neighbours.

use super::gather::Buffer;
use super::{Other, Own, Pair, Pass, Splat, Sums};
use crate::kernel::KernelName;
use crate::simd::{Lanes, dot};

/// Constants of the kernel as lanes.
pub(super) struct Geometry<L, const D: usize> {
    inverse_h: L,
    support2: L,
    value: L,
    slope: L,
    tiny: L,
    kernel: KernelName,
}

impl<L: Lanes, const D: usize> Geometry<L, D> {
    #[inline(always)]
    pub(super) fn new(kernel: KernelName, h: f64) -> Self {
        let sigma = kernel.normalisation(D);
        Geometry {
            inverse_h: L::constant(1.0 / h),
            support2: L::constant((h * kernel.support()).powi(2)),
            value: L::constant(sigma / h.powi(D as i32)),
            slope: L::constant(sigma / h.powi(D as i32 + 2)),
            tiny: L::constant(1e-18 * h * h),
            kernel,
        }
    }

    /// Adds to `sums` what `pass` makes of every vector of `others` around `x`, which are walls if `WALL`.
    #[inline(always)]
    pub(super) fn add<P: Pass<L::Real, D>, const WALL: bool>(
        &self,
        pass: &P,
        x: &[L; D],
        own: &Own<L::Real, D>,
        others: &Buffer<L::Real>,
        sums: &mut Sums<L, D>,
    ) {
        // One loop for the default kernel, and one for all others with a branch per vector: read as if the name could
        // change, for the compiler would otherwise make a copy of the loop per kernel, and of every sweep five.
        let step = L::N;
        match self.kernel {
            KernelName::WendlandC2 => {
                for k in (0..others.len()).step_by(step) {
                    self.vector::<P, WALL>(KernelName::WendlandC2, pass, x, own, others, k, sums);
                }
            }
            _ => {
                for k in (0..others.len()).step_by(step) {
                    // SAFETY: a reference is valid for reads.
                    let kernel = unsafe { std::ptr::read_volatile(&self.kernel) };
                    self.vector::<P, WALL>(kernel, pass, x, own, others, k, sums);
                }
            }
        }
    }

    #[inline(always)]
    fn vector<P: Pass<L::Real, D>, const WALL: bool>(
        &self,
        kernel: KernelName,
        pass: &P,
        x: &[L; D],
        own: &Own<L::Real, D>,
        others: &Buffer<L::Real>,
        k: usize,
        sums: &mut Sums<L, D>,
    ) {
        let stride = others.stride();
        let other = Other::<L, D> {
            at: others.column(0).wrapping_add(k),
            stride,
        };
        // SAFETY: the buffer is closed by a whole vector of particles out of reach.
        let separation =
            std::array::from_fn(|a| x[a] - unsafe { L::load(other.at.add(a * stride)) });
        let squared = dot(&separation, &separation);
        let inside = squared.less(self.support2);
        let q = squared.max(self.tiny).sqrt() * self.inverse_h;
        let slope = (self.slope * kernel.slope_over_q(q)).only(inside);
        let pair = Pair {
            separation,
            squared,
            slope,
            q,
            inside,
            normalisation: self.value,
            kernel,
        };
        if WALL {
            pass.wall(&pair, &Splat(own), &other, sums);
        } else {
            pass.fluid(&pair, &Splat(own), &other, sums);
        }
    }
}
