//! Wendland's C6 function (Wendland 1995; as an SPH kernel: Dehnen & Aly 2012). The smoothest of the family; use it
//! with many neighbours.

use super::{Kernel, KernelName};
use crate::simd::Lanes;
use std::f64::consts::PI;

/// `w = (1 - q/2)⁸ (1 + 4q + 25/4 q² + 4q³)` on `q < 2`; in one dimension
/// `(1 - q/2)⁷ (1 + 7/2 q + 19/4 q² + 21/8 q³)`.
#[derive(Clone, Copy, Debug, Default)]
pub struct WendlandC6;

impl Kernel for WendlandC6 {
    const SUPPORT: f64 = 2.0;
    const NAME: KernelName = KernelName::WendlandC6;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 55.0 / 64.0,
            2 => 39.0 / (14.0 * PI),
            _ => 1365.0 / (512.0 * PI),
        }
    }

    #[inline(always)]
    fn shape<L: Lanes>(q: L) -> L {
        let s = q.mul_add(L::constant(-0.5), L::constant(1.0));
        let quadratic = q.mul_add(L::constant(4.0), L::constant(25.0 / 4.0));
        let linear = q.mul_add(quadratic, L::constant(4.0));
        s.squared().squared().squared() * q.mul_add(linear, L::constant(1.0))
    }

    #[inline(always)]
    fn slope_over_q<L: Lanes>(q: L) -> L {
        let s = q.mul_add(L::constant(-0.5), L::constant(1.0));
        let seventh = s.squared().cubed() * s;
        let linear = q.mul_add(L::constant(-22.0), L::constant(-77.0 / 4.0));
        q.mul_add(linear, L::constant(-11.0 / 2.0)) * seventh
    }

    fn shape_1d(q: f64) -> f64 {
        (1.0 - 0.5 * q).powi(7) * (1.0 + q * (3.5 + q * (4.75 + q * 2.625)))
    }

    fn slope_over_q_1d(q: f64) -> f64 {
        -0.375 * (1.0 - 0.5 * q).powi(6) * (12.0 + q * (36.0 + q * 35.0))
    }
}
