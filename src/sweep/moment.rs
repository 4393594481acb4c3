//! The symmetric moment matrix `Σ w r ⊗ r` of a particle's neighbours, and its inverse.

use super::Sums;
use crate::simd::{Lanes, Real};

/// Below this determinant (1 in the interior, where the trace is D) neighbours do not span the space well enough.
const SINGULAR: f64 = 1e-3;

impl<L: Lanes, const D: usize> Sums<L, D> {
    /// Adds `weight r ⊗ r`.
    #[inline(always)]
    pub fn add_moment(&mut self, weight: L, r: &[L; D]) {
        let m = &mut self.moment;
        let w: [L; D] = std::array::from_fn(|a| weight * r[a]);
        m[0] = w[0].mul_add(r[0], m[0]);
        m[1] = w[1].mul_add(r[1], m[1]);
        m[2] = w[0].mul_add(r[1], m[2]);
        if D == 3 {
            m[3] = w[2].mul_add(r[2], m[3]);
            m[4] = w[1].mul_add(r[2], m[4]);
            m[5] = w[0].mul_add(r[2], m[5]);
        }
    }

    /// The inverse of the moment matrix times `v`; `v` itself where the matrix is singular.
    #[inline(always)]
    pub fn renormalise(&self, v: [L::Real; D]) -> [L::Real; D] {
        let singular = L::Real::from_f64(SINGULAR);
        let one = L::Real::from_f64(1.0);
        let (xx, yy, xy) = (
            self.moment[0].sum(),
            self.moment[1].sum(),
            self.moment[2].sum(),
        );
        let mut out = v;
        if D == 2 {
            let determinant = xx * yy - xy * xy;
            if determinant > singular {
                let inverse = one / determinant;
                out[0] = (yy * v[0] - xy * v[1]) * inverse;
                out[1] = (xx * v[1] - xy * v[0]) * inverse;
            }
        } else {
            let (zz, yz, xz) = (
                self.moment[3].sum(),
                self.moment[4].sum(),
                self.moment[5].sum(),
            );
            // Cofactors of the symmetric matrix.
            let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
            let (d, e, f) = (xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy);
            let determinant = xx * a + xy * b + xz * c;
            if determinant > singular {
                let inverse = one / determinant;
                out[0] = (a * v[0] + b * v[1] + c * v[2]) * inverse;
                out[1] = (b * v[0] + d * v[1] + e * v[2]) * inverse;
                out[2] = (c * v[0] + e * v[1] + f * v[2]) * inverse;
            }
        }
        out
    }

    /// The trace of the moment matrix: D in the interior.
    #[inline(always)]
    pub fn trace(&self) -> L::Real {
        let plane = self.moment[0].sum() + self.moment[1].sum();
        if D == 3 {
            plane + self.moment[3].sum()
        } else {
            plane
        }
    }

    /// The least eigenvalue of the moment matrix, 1 in the interior and small at a free surface; `most` where it is above.
    #[inline(always)]
    pub fn least_moment(&self, most: f64) -> L::Real {
        let half = L::Real::from_f64(0.5);
        let (xx, yy, xy) = (
            self.moment[0].sum(),
            self.moment[1].sum(),
            self.moment[2].sum(),
        );
        if D == 2 {
            let (mean, difference) = (half * (xx + yy), half * (xx - yy));
            let least = mean - (difference * difference + xy * xy).sqrt();
            return Lanes::min(least, L::Real::from_f64(most));
        }
        let (zz, yz, xz) = (
            self.moment[3].sum(),
            self.moment[4].sum(),
            self.moment[5].sum(),
        );
        let [xx, yy, zz, xy, yz, xz] = [xx, yy, zz, xy, yz, xz].map(Real::to_f64);
        // Most particles are far from a surface: there the matrix less `most` is positive definite, as its leading minors
        // tell (Sylvester), and the cubic need not be solved.
        let (a, b, c) = (xx - most, yy - most, zz - most);
        let plane = a * b - xy * xy;
        let determinant = c * plane - yz * (a * yz - xy * xz) + xz * (xy * yz - b * xz);
        if a > 0.0 && plane > 0.0 && determinant > 0.0 {
            return L::Real::from_f64(most);
        }
        // Trigonometric solution of the cubic (Smith 1961), in double precision.
        let mean = (xx + yy + zz) / 3.0;
        let off = xy * xy + yz * yz + xz * xz;
        let p2 = (xx - mean).powi(2) + (yy - mean).powi(2) + (zz - mean).powi(2) + 2.0 * off;
        if p2 <= 1e-20 {
            return L::Real::from_f64(mean.min(most));
        }
        let p = (p2 / 6.0).sqrt();
        let (a, b, c) = ((xx - mean) / p, (yy - mean) / p, (zz - mean) / p);
        let (d, e, f) = (xy / p, yz / p, xz / p);
        let half_determinant =
            0.5 * (a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f));
        let angle = half_determinant.clamp(-1.0, 1.0).acos() / 3.0;
        let least = mean + 2.0 * p * (angle + 2.0 * std::f64::consts::PI / 3.0).cos();
        L::Real::from_f64(least.min(most))
    }
}
