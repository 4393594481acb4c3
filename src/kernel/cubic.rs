//! The cubic B-spline M4 (Schoenberg 1946; as an SPH kernel: Monaghan & Lattanzio 1985). Particles pair above about
//! `h = 1.5` spacings.

use super::{Kernel, KernelName};
use crate::simd::Lanes;
use std::f64::consts::PI;

/// `w = 1 - 3/2 q² + 3/4 q³` on `q < 1`, `1/4 (2 - q)³` on `1 <= q < 2`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cubic;

impl Kernel for Cubic {
    const SUPPORT: f64 = 2.0;
    const NAME: KernelName = KernelName::Cubic;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 2.0 / 3.0,
            2 => 10.0 / (7.0 * PI),
            _ => 1.0 / PI,
        }
    }

    #[inline(always)]
    fn shape<L: Lanes>(q: L) -> L {
        let outer = (L::constant(2.0) - q).cubed() * L::constant(0.25);
        let inner = L::constant(1.0) - q;
        // Truncated powers: one comparison instead of two branches.
        outer - inner.max(L::zero()).cubed()
    }

    #[inline(always)]
    fn slope_over_q<L: Lanes>(q: L) -> L {
        let one = L::constant(1.0);
        let inner = q.mul_add(L::constant(2.25), L::constant(-3.0));
        let outer = (L::constant(2.0) - q).squared() * L::constant(-0.75) * q.max(one).recip();
        inner.select(q.less(one), outer)
    }
}
