//! Wendland's C2 function (Wendland 1995; as an SPH kernel: Dehnen & Aly 2012). No pairing at any number of
//! neighbours; the default.

use super::{Kernel, KernelName};
use crate::simd::Lanes;
use std::f64::consts::PI;

/// `w = (1 - q/2)⁴ (1 + 2q)` on `q < 2`; in one dimension `(1 - q/2)³ (1 + 3/2 q)`.
#[derive(Clone, Copy, Debug, Default)]
pub struct WendlandC2;

impl Kernel for WendlandC2 {
    const SUPPORT: f64 = 2.0;
    const NAME: KernelName = KernelName::WendlandC2;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 5.0 / 8.0,
            2 => 7.0 / (4.0 * PI),
            _ => 21.0 / (16.0 * PI),
        }
    }

    #[inline(always)]
    fn shape<L: Lanes>(q: L) -> L {
        let s = q.mul_add(L::constant(-0.5), L::constant(1.0));
        s.squared().squared() * q.mul_add(L::constant(2.0), L::constant(1.0))
    }

    #[inline(always)]
    fn slope_over_q<L: Lanes>(q: L) -> L {
        let s = q.mul_add(L::constant(-0.5), L::constant(1.0));
        L::constant(-5.0) * s.cubed()
    }

    fn shape_1d(q: f64) -> f64 {
        (1.0 - 0.5 * q).powi(3) * (1.0 + 1.5 * q)
    }

    fn slope_over_q_1d(q: f64) -> f64 {
        -3.0 * (1.0 - 0.5 * q).powi(2)
    }
}
