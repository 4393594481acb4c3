//! Wendland's C4 function (Wendland 1995; as an SPH kernel: Dehnen & Aly 2012). Smoother than C2; use it with more
//! neighbours.

use super::{Kernel, KernelName};
use crate::simd::Lanes;
use std::f64::consts::PI;

/// `w = (1 - q/2)⁶ (1 + 3q + 35/12 q²)` on `q < 2`; in one dimension `(1 - q/2)⁵ (1 + 5/2 q + 2q²)`.
#[derive(Clone, Copy, Debug, Default)]
pub struct WendlandC4;

impl Kernel for WendlandC4 {
    const SUPPORT: f64 = 2.0;
    const NAME: KernelName = KernelName::WendlandC4;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 3.0 / 4.0,
            2 => 9.0 / (4.0 * PI),
            _ => 495.0 / (256.0 * PI),
        }
    }

    #[inline(always)]
    fn shape<L: Lanes>(q: L) -> L {
        let s = q.mul_add(L::constant(-0.5), L::constant(1.0));
        let polynomial = q.mul_add(L::constant(35.0 / 12.0), L::constant(3.0));
        s.squared().cubed() * q.mul_add(polynomial, L::constant(1.0))
    }

    #[inline(always)]
    fn slope_over_q<L: Lanes>(q: L) -> L {
        let s = q.mul_add(L::constant(-0.5), L::constant(1.0));
        let fifth = s.squared().squared() * s;
        q.mul_add(L::constant(-35.0 / 3.0), L::constant(-14.0 / 3.0)) * fifth
    }

    fn shape_1d(q: f64) -> f64 {
        (1.0 - 0.5 * q).powi(5) * (1.0 + q * (2.5 + q * 2.0))
    }

    fn slope_over_q_1d(q: f64) -> f64 {
        -3.5 * (1.0 - 0.5 * q).powi(4) * (1.0 + 2.0 * q)
    }
}
