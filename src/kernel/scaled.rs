//! A kernel with its smoothing length, for single numbers in double precision.

use super::Kernel;
use std::marker::PhantomData;

/// Kernel `K` in `D` dimensions with one smoothing length: powers of `h` are worked out once.
#[derive(Clone, Copy, Debug)]
pub struct Scaled<K, const D: usize> {
    inverse_h: f64,
    radius: f64,
    of_value: f64,
    of_slope: f64,
    kernel: PhantomData<K>,
}

impl<K: Kernel, const D: usize> Scaled<K, D> {
    /// With smoothing length `h` [m], positive.
    pub fn new(h: f64) -> Self {
        let inverse_h = 1.0 / h;
        let of_value = K::normalisation(D) * inverse_h.powi(D as i32);
        Self {
            inverse_h,
            radius: K::SUPPORT * h,
            of_value,
            of_slope: of_value * inverse_h * inverse_h,
            kernel: PhantomData,
        }
    }

    /// Support radius [m].
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// `W(r)` [m^-D]; zero beyond the support.
    #[inline]
    pub fn value(&self, r: f64) -> f64 {
        let q = r * self.inverse_h;
        if q >= K::SUPPORT {
            return 0.0;
        }
        self.of_value * if D == 1 { K::shape_1d(q) } else { K::shape(q) }
    }

    /// `F = W'(r) / r` [m^-(D+2)], so that `∇_i W_ij = F (r_i - r_j)`; zero beyond the support.
    #[inline]
    pub fn slope_over_r(&self, r: f64) -> f64 {
        let q = r * self.inverse_h;
        if q >= K::SUPPORT {
            return 0.0;
        }
        self.of_slope
            * if D == 1 {
                K::slope_over_q_1d(q)
            } else {
                K::slope_over_q(q)
            }
    }
}
