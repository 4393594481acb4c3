//! Particle shifting: moves particles a little towards where they are few, so that they stay evenly spread.
//!
//! The sums share the sweep of continuity. The shift is of position only: volume and angular momentum are kept to its
//! order, not exactly. Choose it for flows without violent free surfaces (vortices, channels), and where pressure turns
//! negative.

use super::{Declaration, PairTerm, Quantity};
use crate::kernel::KernelName;
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Own, Pair, Splat, Sums, Tally, Uses};

/// Strength of the term against pairing, and its exponent (Monaghan 2000; Sun et al. 2017).
const PAIRING: f64 = 0.2;
/// Least eigenvalue of the moment matrix at the free surface and in the interior (Marrone et al. 2010; Sun et al. 2017).
const SURFACE: f64 = 0.4;
const INTERIOR: f64 = 0.75;

/// One step of shifting along `-Σ V_j [1 + 0.2 (W_ij/W(Δp))⁴] ∇W_ij`.
#[derive(Clone, Copy, Debug)]
pub struct Shift {
    /// `δr = -strength Σ…` of Sun et al. 2017, in m²; 0 for Lind's form.
    strength: f64,
    /// The same per speed of the particle, of Lind et al. 2012 with the coefficient of Skillen et al. 2013, in m s.
    strength_per_speed: f64,
    /// No particle is moved further, in m.
    limit: f64,
    /// `1 / W(Δp)`.
    inverse_weight: f64,
    free_surface: bool,
}

impl Shift {
    /// Sun, Colagrossi, Marrone, Antuono & Zhang 2017: `2 U h Δt`, where `U` is the largest speed of the flow; limited
    /// to `U Δt / 2`.
    pub fn sun<const D: usize>(
        kernel: KernelName,
        h: f64,
        spacing: f64,
        speed: f64,
        dt: f64,
        free_surface: bool,
    ) -> Self {
        Shift {
            strength: 2.0 * speed * h * dt,
            strength_per_speed: 0.0,
            limit: 0.5 * speed * dt,
            inverse_weight: 1.0 / kernel.value(D, spacing, h),
            free_surface,
        }
    }

    /// Lind, Xu, Stansby & Rogers 2012 with the strength `2 h |u_i| Δt` of Skillen, Lind, Stansby & Rogers 2013;
    /// limited to `0.2 h`.
    pub fn lind<const D: usize>(
        kernel: KernelName,
        h: f64,
        spacing: f64,
        dt: f64,
        free_surface: bool,
    ) -> Self {
        Shift {
            strength: 0.0,
            strength_per_speed: 2.0 * h * dt,
            limit: 0.2 * h,
            inverse_weight: 1.0 / kernel.value(D, spacing, h),
            free_surface,
        }
    }

    /// The shift of a particle in m, from its sums.
    #[inline(always)]
    pub fn finish<R: Real, const D: usize>(&self, own: &Own<R, D>, sums: &Sums<R, D>) -> [R; D] {
        let zero = R::default();
        let mut shift = sums.gradient.map(|g| -g);
        if self.free_surface {
            let least = sums.least_moment();
            if least < R::from_f64(SURFACE) {
                return [zero; D];
            }
            if least < R::from_f64(INTERIOR) {
                // Along the surface only: the gradient of the concentration is its normal.
                let normal = sums.vector;
                let (mut square, mut along) = (zero, zero);
                for a in 0..D {
                    square += normal[a] * normal[a];
                    along += normal[a] * shift[a];
                }
                if square > zero {
                    for a in 0..D {
                        shift[a] = shift[a] - along / square * normal[a];
                    }
                }
            }
        }
        let (mut square, mut speed2) = (zero, zero);
        let u = own.values().velocity();
        for a in 0..D {
            square += shift[a] * shift[a];
            speed2 += u[a] * u[a];
        }
        let strength =
            R::from_f64(self.strength) + R::from_f64(self.strength_per_speed) * speed2.sqrt();
        let length = strength * square.sqrt();
        let limit = R::from_f64(self.limit);
        let factor = if length > limit {
            strength * limit / length
        } else {
            strength
        };
        shift.map(|s| s * factor)
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Shift {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            vector: self.free_surface,
            gradient: true,
            moment: self.free_surface,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        _own: &Splat<L, D>,
        _other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        let ratio = pair.weight() * L::constant(self.inverse_weight);
        let pairing = ratio
            .squared()
            .squared()
            .mul_add(L::constant(PAIRING), L::constant(1.0));
        tally.push(pair.slope);
        tally.repel(pair.slope * pairing, pair);
        if self.free_surface {
            tally.moment(-pair.slope, pair);
        }
    }
}

/// What the effect is.
pub const PARTICLE_SHIFTING: Declaration = Declaration {
    name: "particle shifting",
    columns: &[Quantity::Vector("shift")],
    sweeps: 0,
    limit: None,
    dissipates: "",
    source: "Sun, Colagrossi, Marrone, Antuono & Zhang 2017; Lind, Xu, Stansby & Rogers 2012",
};
