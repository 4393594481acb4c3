//! A kernel chosen at run time with its smoothing length, for single numbers in double precision.

use super::{Kernel, KernelName};
use crate::with_kernel;

/// A kernel in `D` dimensions with one smoothing length: powers of `h` are worked out once.
#[derive(Clone, Copy, Debug)]
pub struct Scaled<const D: usize> {
    name: KernelName,
    inverse_h: f64,
    support: f64,
    radius: f64,
    of_value: f64,
    of_slope: f64,
}

impl<const D: usize> Scaled<D> {
    /// With smoothing length `h` [m], positive.
    pub fn new(name: KernelName, h: f64) -> Self {
        let inverse_h = 1.0 / h;
        let of_value = with_kernel!(name, K => K::normalisation(D)) * inverse_h.powi(D as i32);
        Self {
            name,
            inverse_h,
            support: name.support(),
            radius: name.support() * h,
            of_value,
            of_slope: of_value * inverse_h * inverse_h,
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
        if q >= self.support {
            return 0.0;
        }
        let shape = with_kernel!(self.name, K => if D == 1 { K::shape_1d(q) } else { K::shape(q) });
        self.of_value * shape
    }

    /// `F = W'(r) / r` [m^-(D+2)], so that `∇_i W_ij = F (r_i - r_j)`; zero beyond the support.
    #[inline]
    pub fn slope_over_r(&self, r: f64) -> f64 {
        let q = r * self.inverse_h;
        if q >= self.support {
            return 0.0;
        }
        let slope = with_kernel!(self.name, K =>
            if D == 1 { K::slope_over_q_1d(q) } else { K::slope_over_q(q) });
        self.of_slope * slope
    }
}
