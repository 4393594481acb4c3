//! Distances and kernel values of a particle and vectors of neighbours.

use super::gather::Buffer;
use super::{Other, Pair};
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

/// What is done with each vector of pairs. `vector` must be `#[inline(always)]`.
pub(super) trait Visit<L: Lanes, const D: usize> {
    /// Whether few vectors are visited: not worth code of their own for the default kernel.
    const RARE: bool = false;

    /// With the vector of neighbours that starts at place `k` of the buffer.
    fn vector(&mut self, pair: &Pair<L, D>, other: &Other<L, D>, k: usize);
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

    /// Shows `visit` every vector of `others` around `x`.
    #[inline(always)]
    pub(super) fn each<V: Visit<L, D>>(&self, x: &[L; D], others: &Buffer<L::Real>, visit: &mut V) {
        // One loop for the default kernel, and one for all others with a branch per vector: read as if the name could
        // change, for the compiler would otherwise make a copy of the loop per kernel, and of every sweep five.
        let step = L::N;
        match self.kernel {
            KernelName::WendlandC2 if !V::RARE => {
                for k in (0..others.len()).step_by(step) {
                    self.vector(KernelName::WendlandC2, x, others, k, visit);
                }
            }
            _ => {
                for k in (0..others.len()).step_by(step) {
                    // SAFETY: a reference is valid for reads.
                    let kernel = unsafe { std::ptr::read_volatile(&self.kernel) };
                    self.vector(kernel, x, others, k, visit);
                }
            }
        }
    }

    #[inline(always)]
    fn vector<V: Visit<L, D>>(
        &self,
        kernel: KernelName,
        x: &[L; D],
        others: &Buffer<L::Real>,
        k: usize,
        visit: &mut V,
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
        visit.vector(&pair, &other, k);
    }
}
