//! Particle shifting: moves particles a little towards where they are few, so that they stay evenly spread.
//!
//! The sums share the sweep of continuity. Density does not feel a shift, so that the spacing of the particles would
//! drift away from it: violent flows would swell by a third and more. A weak source of density takes it back to what
//! the particles' concentration says, wherever that is defined; see [`Shift::source`].

use super::{Declaration, PairTerm, Quantity};
use crate::kernel::KernelName;
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Own, Pair, Splat, Sums, Tally, Uses};

/// Strength of the term against pairing, and its exponent (Monaghan 2000; Sun et al. 2017).
const PAIRING: f64 = 0.2;
/// Least eigenvalue of the moment matrix at the free surface and in the interior (Marrone et al. 2010; Sun et al. 2017).
const SURFACE: f64 = 0.4;
const INTERIOR: f64 = 0.75;
/// From one to the other without a transition, for all eigenvalues that differ.
const AT_ONCE: f64 = 1e30;

/// No shift is longer, in smoothing lengths.
const LONGEST: f64 = 0.2;

/// Rate in units of `U/h` at which density follows the concentration of particles under a free surface, with the largest
/// speed `U` of the flow: shifts go with the same speed, and fluid at rest is left alone.
const FOLLOWING: f64 = 0.1;
/// The same without a free surface, where fluid cannot swell: it evens out what shifts leave in the pressure.
const FOLLOWING_INSIDE: f64 = 0.03;
/// How strongly fluid that fills a closed volume keeps it, over the rate at which density follows the concentration. Particles
/// in disorder are more concentrated than a lattice, and density that follows would raise the pressure of all the fluid:
/// by 2.5 ρU² in a lid-driven cavity, whose forces on disordered particles act as friction.
const HOLDING: f64 = 50.0;
/// Least eigenvalue from which a particle is wholly surrounded by others.
const SURROUNDED: f64 = 0.95;

/// Of the gentle form: its strength over that of Sun et al., and the least eigenvalues from which it begins to shift through
/// the layers of a surface, and does so wholly.
const GENTLE: f64 = 0.3;
const GENTLE_FROM: f64 = 0.9;
const GENTLE_WHOLLY: f64 = 1.0;

/// Coefficient of `Σ V_j [1 + 0.2 (W_ij/W(Δp))⁴] ∇W_ij` in m²: `½ U Δt H²/(2Δp)`, with the support radius `H`, the largest
/// speed `U` of the flow, and `m_j/(ρ_i + ρ_j)` taken as half the volume (Sun, Colagrossi, Marrone, Antuono & Zhang 2017,
/// with the product of Courant and Mach number written as `U Δt / 2Δp`).
pub fn sun_strength(support: f64, spacing: f64, speed: f64, dt: f64) -> f64 {
    0.25 * speed * dt * support * support / spacing
}

/// Concentration `-Σ V_j r_ij·∇W_ij / D` of a lattice: 1 but for the sum's difference from the integral.
pub fn lattice_concentration<const D: usize>(kernel: KernelName, h: f64, spacing: f64) -> f64 {
    let reach = (h * kernel.support() / spacing).ceil() as i32;
    let side = 2 * reach + 1;
    (0..side.pow(D as u32))
        .map(|k| {
            let squares = (0..D).map(|a| f64::from(k / side.pow(a as u32) % side - reach).powi(2));
            let r = squares.sum::<f64>().sqrt() * spacing;
            if r > 0.0 && r < h * kernel.support() {
                -kernel.gradient(D, r, h) * r * spacing.powi(D as i32) / D as f64
            } else {
                0.0
            }
        })
        .sum()
}

/// What shifting needs to know of a simulation that does not change.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    /// Smoothing kernel.
    pub kernel: KernelName,
    /// Smoothing length in m.
    pub h: f64,
    /// Spacing in m.
    pub spacing: f64,
    /// Concentration of the lattice.
    pub concentration: f64,
    /// Whether there is a free surface to keep.
    pub free_surface: bool,
    /// The volume in m² or m³ that the fluid fills, where nothing can change it.
    pub closed: Option<f64>,
}

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
    /// Strength of the term against pairing.
    pairing: f64,
    free_surface: bool,
    /// Least eigenvalue from which a particle is shifted at all.
    kept: f64,
    /// From which it is shifted every way, below along the surface only.
    inside: f64,
    /// How fast the one becomes the other, per eigenvalue.
    steepness: f64,
    /// The largest eigenvalue that matters.
    enough: f64,
    /// Rate in 1/s at which density follows the concentration.
    following: f64,
    /// Concentration at which it rests.
    concentration: f64,
}

impl Shift {
    /// Sun, Colagrossi, Marrone, Antuono & Zhang 2017, with [`sun_strength`]; limited to `U Δt / 2`.
    pub fn sun<const D: usize>(around: &Surroundings, speed: f64, dt: f64) -> Self {
        let support = around.h * around.kernel.support();
        Shift {
            strength: sun_strength(support, around.spacing, speed, dt),
            limit: 0.5 * speed * dt,
            ..Self::none::<D>(around, speed)
        }
    }

    /// As [`Self::sun`] with 0.3 of the strength, and near a surface only along it, by and by less so with the depth. For
    /// a liquid with surface tension: a shift through the layer in which the tension acts carries mass against it, energy
    /// of the surface that is taken from nothing; without any, voids open under a surface that is stretched. The pressure
    /// that the tension gives keeps particles evenly spread, too.
    pub fn gentle<const D: usize>(around: &Surroundings, speed: f64, dt: f64) -> Self {
        let sun = Self::sun::<D>(around, speed, dt);
        Shift {
            strength: GENTLE * sun.strength,
            kept: 0.0,
            inside: GENTLE_WHOLLY,
            steepness: 1.0 / (GENTLE_WHOLLY - GENTLE_FROM),
            enough: GENTLE_WHOLLY,
            ..sun
        }
    }

    /// Lind, Xu, Stansby & Rogers 2012 with the strength `2 h |u_i| Δt` of Skillen, Lind, Stansby & Rogers 2013;
    /// limited to `0.2 h`.
    pub fn lind<const D: usize>(around: &Surroundings, speed: f64, dt: f64) -> Self {
        Shift {
            strength_per_speed: 2.0 * around.h * dt,
            limit: LONGEST * around.h,
            ..Self::none::<D>(around, speed)
        }
    }

    /// What the background pressure `ρ c0²` of the transport-velocity formulation moves particles by in a step:
    /// `-(c0 Δt)² Σ V_j ∇W_ij` (Adami, Hu & Adams 2013, for volumes that are equal); limited to `0.2 h`. For fluid without a
    /// free surface, which it would drive apart.
    pub fn transport_velocity<const D: usize>(
        around: &Surroundings,
        speed: f64,
        sound_speed: f64,
        dt: f64,
    ) -> Self {
        Shift {
            strength: (sound_speed * dt).powi(2),
            limit: LONGEST * around.h,
            pairing: 0.0,
            ..Self::none::<D>(around, speed)
        }
    }

    /// The same for fluid in a closed volume that is compressed by the share `excess` as a whole: density follows the
    /// concentration but for its mean.
    pub fn keeping_volume(self, excess: f64) -> Self {
        Shift {
            concentration: self.concentration + HOLDING * excess,
            ..self
        }
    }

    /// What one shift must do where there is only one in so many `steps`. None is longer than `0.2 h`.
    pub fn for_steps(self, steps: f64, h: f64) -> Self {
        Shift {
            strength: self.strength * steps,
            strength_per_speed: self.strength_per_speed * steps,
            limit: (self.limit * steps).min(LONGEST * h),
            following: self.following * steps,
            ..self
        }
    }

    /// Whether there is a free surface, which shifts must keep.
    pub fn keeps_a_surface(&self) -> bool {
        self.free_surface
    }

    /// Rate in 1/s at which density follows the concentration where pairs tell it; 0 with a free surface.
    pub fn following_inside(&self) -> f64 {
        if self.free_surface {
            0.0
        } else {
            self.following
        }
    }

    fn none<const D: usize>(around: &Surroundings, speed: f64) -> Self {
        Shift {
            strength: 0.0,
            strength_per_speed: 0.0,
            limit: 0.0,
            inverse_weight: 1.0 / around.kernel.value(D, around.spacing, around.h),
            pairing: PAIRING,
            free_surface: around.free_surface,
            kept: SURFACE,
            inside: INTERIOR,
            steepness: AT_ONCE,
            enough: SURROUNDED,
            following: speed / around.h
                * if around.free_surface {
                    FOLLOWING
                } else {
                    FOLLOWING_INSIDE
                },
            concentration: around.concentration,
        }
    }

    /// Rate of density over `ρ0` that takes it to the concentration `c_i = -Σ V_j r_ij·∇W_ij / D` of the particles
    /// around: `k (U/h) (c_i - c)` with that of the lattice, `c`. Where there is a free surface the sum is the trace of
    /// the moment matrix, and particles near the surface, where it says nothing of the spacing, are left out; else it is
    /// among the pairs' terms but for its last part. A relaxed form of taking density anew from the kernel sum
    /// (Colagrossi & Landrini 2003; Zhang, Hu & Adams 2017).
    ///
    /// `least` is of [`Self::surroundings`].
    #[inline(always)]
    pub fn source<R: Real, const D: usize>(&self, sums: &Sums<R, D>, least: R) -> R {
        let following = R::from_f64(self.following);
        let at_rest = R::from_f64(self.concentration);
        if !self.free_surface {
            return -following * at_rest;
        }
        let (low, high) = (R::from_f64(INTERIOR), R::from_f64(SURROUNDED));
        let surrounded = (least - low) / (high - low);
        let excess = sums.trace() * R::from_f64(1.0 / D as f64) - at_rest;
        following * Lanes::max(surrounded, R::default()) * excess
    }

    /// How far a particle is surrounded by others: the least eigenvalue of its moment matrix, as far as it matters here.
    #[inline(always)]
    pub fn surroundings<R: Real, const D: usize>(&self, sums: &Sums<R, D>) -> R {
        if self.free_surface {
            sums.least_moment(self.enough)
        } else {
            R::from_f64(self.enough)
        }
    }

    /// The shift of a particle in m, from its sums; `least` is of [`Self::surroundings`].
    #[inline(always)]
    pub fn finish<R: Real, const D: usize>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<R, D>,
        least: R,
    ) -> [R; D] {
        let zero = R::default();
        let mut shift = sums.gradient.map(|g| -g);
        if self.free_surface {
            if least < R::from_f64(self.kept) {
                return [zero; D];
            }
            let inside = R::from_f64(self.inside);
            if least < inside {
                // Along the surface only: the gradient of the concentration is its normal.
                let steepness = R::from_f64(self.steepness);
                let part = Lanes::min((inside - least) * steepness, R::from_f64(1.0));
                let normal = sums.vector;
                let (mut square, mut along) = (zero, zero);
                for a in 0..D {
                    square += normal[a] * normal[a];
                    along += normal[a] * shift[a];
                }
                if square > zero {
                    for a in 0..D {
                        shift[a] = shift[a] - along / square * normal[a] * part;
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
            scalar: true,
            vector: self.free_surface,
            gradient: true,
            moment: self.free_surface,
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
            .mul_add(L::constant(self.pairing), L::constant(1.0));
        tally.push(pair.slope);
        tally.repel(pair.slope * pairing, pair);
        if self.free_surface {
            tally.moment(-pair.slope, pair);
        } else {
            let share = L::constant(-self.following / D as f64);
            tally.source(share * pair.slope * pair.squared);
        }
    }
}

/// What the effect is; with `transport`, particles take the fields along that they find.
pub fn particle_shifting(transport: bool) -> Declaration {
    Declaration {
        name: "particle shifting",
        columns: if transport {
            &[
                Quantity::Vector("shift"),
                Quantity::Vector("change of velocity"),
                Quantity::Scalar("change of density"),
            ]
        } else {
            &[Quantity::Vector("shift")]
        },
        sweeps: usize::from(transport),
        limit: None,
        dissipates: "",
        source: if transport {
            "Sun, Colagrossi, Marrone, Antuono & Zhang 2019; Adami, Hu & Adams 2013"
        } else {
            "Sun, Colagrossi, Marrone, Antuono & Zhang 2017; Lind, Xu, Stansby & Rogers 2012"
        },
    }
}
