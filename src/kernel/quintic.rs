//! The quintic B-spline M6 (Schoenberg 1946; as an SPH kernel: Morris, Fox & Zhu 1997). Smooth and wide: about
//! twice the neighbours of a kernel of support 2h in 2D, three times in 3D.

use super::{Kernel, KernelName};
use crate::simd::Lanes;
use std::f64::consts::PI;

/// `w = (3 - q)⁵ - 6 (2 - q)₊⁵ + 15 (1 - q)₊⁵` on `q < 3`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quintic;

#[inline(always)]
fn fourth<L: Lanes>(x: L) -> L {
    x.squared().squared()
}

impl Kernel for Quintic {
    const SUPPORT: f64 = 3.0;
    const NAME: KernelName = KernelName::Quintic;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 1.0 / 120.0,
            2 => 7.0 / (478.0 * PI),
            _ => 1.0 / (120.0 * PI),
        }
    }

    #[inline(always)]
    fn shape<L: Lanes>(q: L) -> L {
        let a = L::constant(3.0) - q;
        let b = (L::constant(2.0) - q).max(L::zero());
        let c = (L::constant(1.0) - q).max(L::zero());
        let sum = (fourth(b) * b).mul_add(L::constant(-6.0), fourth(a) * a);
        (fourth(c) * c).mul_add(L::constant(15.0), sum)
    }

    #[inline(always)]
    fn slope_over_q<L: Lanes>(q: L) -> L {
        let one = L::constant(1.0);
        // Inside q < 1 the three powers cancel to a polynomial that q divides.
        let cubic = q.mul_add(L::constant(-50.0), L::constant(120.0));
        let inner = (q * q).mul_add(cubic, L::constant(-120.0));
        let a = fourth(L::constant(3.0) - q) * L::constant(-5.0);
        let b = (L::constant(2.0) - q).max(L::zero());
        let outer = fourth(b).mul_add(L::constant(30.0), a) * q.max(one).recip();
        inner.select(q.less(one), outer)
    }
}
