//! The wall factor `γ_i = ∫ W dV` over the fluid side of a surface, and its gradient (Ferrand et al. 2013; Mayrhofer,
//! Ferrand, Kassiotis, Violeau & Morel 2015).
//!
//! By the divergence theorem a volume integral of the kernel becomes one over the facets. Its integrand is singular on
//! the wall; taken apart into the solid angle, which has a closed form, and a smooth rest, it is exact to rounding in
//! corners, on edges and on the wall itself: with `𝓗(r) = r^-D ∫_r^H W x^(D-1) dx = 1/(S_D r^D) - 𝓖(r)` and
//! `𝓖(r) = r^-D ∫_0^r W x^(D-1) dx`, `γ = 1 - Σ_s [Ω_s/S_D - d_s ∫_s 𝓖 dS]` over the part of each facet within the support,
//! where `d_s` is the height of the particle over its plane; and `∇γ_s = n_s ∫_s W dS`, with the normal into the fluid.
//! On a triangle both are integrals along its edges: in polar coordinates about the foot of the particle the radial
//! integral is a function of the distance alone.

use super::facet::{Facet, cross, minus, plus};
use crate::kernel::KernelName;
use crate::simd::dot;
use std::f64::consts::PI;

/// Nodes and weights of Gauss-Legendre quadrature on 0..1.
const NODES: [(f64, f64); 10] = [
    (0.013_046_735_741_414_128, 0.033_335_672_154_344_07),
    (0.067_468_316_655_507_73, 0.074_725_674_575_290_3),
    (0.160_295_215_850_487_8, 0.109_543_181_257_991_02),
    (0.283_302_302_935_376_4, 0.134_633_359_654_998_17),
    (0.425_562_830_509_184_4, 0.147_762_112_357_376_43),
    (0.574_437_169_490_815_6, 0.147_762_112_357_376_43),
    (0.716_697_697_064_623_6, 0.134_633_359_654_998_17),
    (0.839_704_784_149_512_2, 0.109_543_181_257_991_02),
    (0.932_531_683_344_492_3, 0.074_725_674_575_290_3),
    (0.986_953_264_258_585_9, 0.033_335_672_154_344_07),
];

/// Intervals of the tables: the pieces of every kernel begin at one of their ends.
const INTERVALS: usize = 1536;

/// Radial integrals of a kernel of some smoothing length.
#[derive(Clone, Debug)]
pub struct WallFactor<const D: usize> {
    support: f64,
    kernel: KernelName,
    smoothing_length: f64,
    inverse_step: f64,
    /// At the ends of the intervals, each with its change over an interval at the slope there: `𝓖`, `N = ∫_0^r 𝓖 x dx`,
    /// `Q = ∫_r^H W x dx`.
    table: Vec<[[f64; 2]; 3]>,
}

/// What a facet takes of the support of a kernel.
#[derive(Clone, Copy, Debug)]
pub struct Share<const D: usize> {
    /// `1 - γ` by this facet alone.
    pub cut: f64,
    /// `∫_s W dS`: the length of `∇γ_s`.
    pub gradient: f64,
    /// `∫_s W (r_s - r_foot) dS`, along the facet.
    pub moment: [f64; D],
    /// Height over the facet's plane in m.
    pub height: f64,
}

impl<const D: usize> WallFactor<D> {
    /// Tables for a kernel of smoothing length `h` in m.
    pub fn new(kernel: KernelName, h: f64) -> Self {
        let support = h * kernel.support();
        let step = support / INTERVALS as f64;
        let weight = |r: f64| kernel.value(D, r, h);
        let integral = |from: f64, f: &dyn Fn(f64) -> f64| -> f64 {
            NODES
                .iter()
                .map(|(x, w)| w * step * f(from + x * step))
                .sum()
        };
        let mut table = vec![[[0.0; 2]; 3]; INTERVALS + 1];
        table[0][0][0] = weight(0.0) / D as f64;
        let mut mass = 0.0;
        for k in 0..INTERVALS {
            let r = k as f64 * step;
            mass += integral(r, &|x| weight(x) * x.powi(D as i32 - 1));
            let (r, d) = (r + step, D as i32);
            let value = mass / r.powi(d);
            table[k + 1][0] = [value, step * (weight(r) - f64::from(d) * value) / r];
        }
        let mut factor = WallFactor {
            support,
            kernel,
            smoothing_length: h,
            inverse_step: 1.0 / step,
            table,
        };
        for k in 0..INTERVALS {
            let r = k as f64 * step;
            let more = integral(r, &|x| factor.read(0, x) * x);
            let slope = step * factor.table[k + 1][0][0] * (r + step);
            factor.table[k + 1][1] = [factor.table[k][1][0] + more, slope];
        }
        for k in (0..INTERVALS).rev() {
            let r = k as f64 * step;
            let more = integral(r, &|x| weight(x) * x);
            factor.table[k][2] = [factor.table[k + 1][2][0] + more, -step * weight(r) * r];
        }
        factor
    }

    /// Radius of the support in m.
    pub fn support(&self) -> f64 {
        self.support
    }

    fn weight(&self, r: f64) -> f64 {
        self.kernel.value(D, r, self.smoothing_length)
    }

    /// Table `c` at `r` within the support: the cubic through values and slopes at the ends of the interval.
    fn read(&self, c: usize, r: f64) -> f64 {
        let t = (r * self.inverse_step).clamp(0.0, INTERVALS as f64);
        let k = (t as usize).min(INTERVALS - 1);
        let t = t - k as f64;
        let ([a, u], [b, v]) = (self.table[k][c], self.table[k + 1][c]);
        let (t2, t3) = (t * t, t * t * t);
        a * (2.0 * t3 - 3.0 * t2 + 1.0)
            + u * (t3 - 2.0 * t2 + t)
            + b * (3.0 * t2 - 2.0 * t3)
            + v * (t3 - t2)
    }

    /// Visits the nodes of a quadrature along a line at the distance `√far2` from `from` to `to`, with their weights: in parts
    /// where the nearest point of the line, or an end of a piece of the kernel, lies between.
    #[inline]
    fn for_nodes(&self, from: f64, to: f64, far2: f64, mut visit: impl FnMut(f64, f64)) {
        let pieces = match self.kernel {
            KernelName::Cubic => 1,
            KernelName::Quintic => 2,
            _ => 0,
        };
        let mut ends = [0.0; 5];
        for k in 0..pieces {
            let r = (k + 1) as f64 * self.smoothing_length;
            let t = (r * r - far2).max(0.0).sqrt();
            (ends[1 - k], ends[3 + k]) = (-t, t);
        }
        let mut a = from;
        for end in ends[2 - pieces..3 + pieces].iter().copied().chain([to]) {
            let b = end.clamp(a, to);
            if b > a {
                for (x, w) in NODES {
                    visit(a + x * (b - a), w * (b - a));
                }
            }
            a = b;
        }
    }

    /// What `facet` takes of the support around `x`; `None` where it does not reach into it.
    pub fn share(&self, facet: &Facet<D>, x: &[f64; D]) -> Option<Share<D>> {
        let height = dot(&minus(x, &facet.corners[0]), &facet.normal);
        if height.abs() >= self.support {
            return None;
        }
        let mut share = Share {
            cut: 0.0,
            gradient: 0.0,
            moment: [0.0; D],
            height,
        };
        if D == 2 {
            self.add_segment(facet, x, &mut share);
        } else {
            self.add_triangle(facet, x, &mut share);
        }
        if height < 0.0 {
            // Behind the wall the angle has the other sign.
            share.cut = -share.cut;
        }
        Some(share)
    }

    /// `γ` at `x` in front of `facets`, and `∇γ`.
    pub fn of(&self, facets: &[Facet<D>], x: &[f64; D]) -> (f64, [f64; D]) {
        let (mut factor, mut gradient) = (1.0, [0.0; D]);
        for facet in facets {
            if let Some(share) = self.share(facet, x) {
                factor -= share.cut;
                gradient = plus(&gradient, share.gradient, &facet.normal);
            }
        }
        (factor, gradient)
    }

    fn add_segment(&self, facet: &Facet<D>, x: &[f64; D], share: &mut Share<D>) {
        let d = share.height.abs();
        let [a, b] = [&facet.corners[0], &facet.corners[1]];
        let edge = minus(b, a);
        let length = dot(&edge, &edge).sqrt();
        let along = |p: &[f64; D]| dot(&minus(p, x), &edge) / length;
        let half = (self.support * self.support - d * d).sqrt();
        let (from, to) = (along(a).max(-half), along(b).min(half));
        if from >= to {
            return;
        }
        let radius = |t: f64| (d * d + t * t).sqrt();
        share.cut = (to.atan2(d) - from.atan2(d)) / (2.0 * PI);
        let moment = self.read(2, radius(from)) - self.read(2, radius(to));
        share.moment = edge.map(|e| moment * e / length);
        self.for_nodes(from, to, d * d, |t, w| {
            let r = radius(t);
            share.cut -= w * d * self.read(0, r);
            share.gradient += w * self.weight(r);
        });
    }

    fn add_triangle(&self, facet: &Facet<D>, x: &[f64; D], share: &mut Share<D>) {
        let (c, h, d) = (&facet.corners, self.support, share.height.abs());
        let foot = plus(x, -share.height, &facet.normal);
        let half2 = h * h - d * d;
        let (n_d, n_h, q_d) = (self.read(1, d), self.read(1, h), self.read(2, d));
        for k in 0..D {
            let (a, b) = (&c[k], &c[(k + 1) % D]);
            let edge = minus(b, a);
            let length = dot(&edge, &edge).sqrt();
            let inward = cross(&facet.normal, &edge);
            // The edge as the foot sees it: its distance, positive where the foot is on the side of the triangle.
            let signed = dot(&minus(&foot, a), &inward) / length;
            let (e, side) = (signed.abs(), if signed < 0.0 { -1.0 } else { 1.0 });
            let along = |p: &[f64; D]| dot(&minus(p, &foot), &edge) / length;
            let (ta, tb) = (along(a), along(b));
            // All around the foot: radial integrals from the foot to the edge of the support.
            let angle = side * (tb.atan2(e) - ta.atan2(e));
            share.cut += angle * ((1.0 - d / h) / (4.0 * PI) - d * (n_h - n_d));
            share.gradient += angle * q_d;
            // Less what lies beyond the edge of the triangle.
            if e * e >= half2 {
                continue;
            }
            let half = (half2 - e * e).sqrt();
            let (from, to) = (ta.max(-half), tb.min(half));
            if from >= to {
                continue;
            }
            let clipped = side * (to.atan2(e) - from.atan2(e));
            let far = (d * d + e * e).sqrt();
            let sine = |t: f64| {
                let rho = (e * e + t * t).sqrt();
                if rho > 0.0 && far > 0.0 {
                    (d * t / (rho * far)).clamp(-1.0, 1.0).asin()
                } else {
                    0.0
                }
            };
            share.cut -= side * (sine(to) - sine(from)) / (4.0 * PI);
            share.cut += clipped * d * (1.0 / (4.0 * PI * h) + n_h - n_d);
            share.gradient -= clipped * q_d;
            let mut moment = 0.0;
            self.for_nodes(from, to, d * d + e * e, |t, w| {
                let rho2 = e * e + t * t;
                let r = (d * d + rho2).sqrt();
                let q_r = self.read(2, r);
                let (n, q) = if rho2 > 1e-9 * h * h {
                    ((self.read(1, r) - n_d) / rho2, (q_d - q_r) / rho2)
                } else {
                    (0.5 * self.read(0, r), 0.5 * self.weight(r))
                };
                share.cut -= side * w * e * d * n;
                share.gradient += side * w * e * q;
                moment += w * q_r;
            });
            share.moment = plus(&share.moment, moment / length, &inward);
        }
    }
}
