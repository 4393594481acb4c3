//! What a low-dissipation Riemann solver between particles adds to the mean of their states (Zhang, Hu & Adams 2017).
//!
//! Along the line of centres `e` from `i` to `j` the states of the two meet: `p* = ½(p_i + p_j) + ½ β ρ0 c0 ΔU` with `ΔU
//! = (u_i - u_j)·e` and the limiter `β = min(3 max(ΔU, 0)/c0, 1)`, and `U* = ½(U_i + U_j) + ½(p_i - p_j)/(ρ0 c0)`. The means
//! are pressure and continuity as kolk has them anyway; the differences are dissipation: of the velocity of pairs that
//! approach, and of density.

use super::{Declaration, PairTerm};
use crate::kernel::KernelName;
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Pair, Splat, Tally, Uses, relative_velocity};

/// Of the limiter: the less, the less dissipation.
const LIMITER: f64 = 3.0;

/// The part of `p*` beyond the mean, as a force density `-Σ V_j β ρ0 c0 ΔU ∇W_ij`. Dissipates kinetic energy; conserves linear
/// and angular momentum.
#[derive(Clone, Copy, Debug)]
pub struct RiemannViscosity {
    impedance: f64,
    steepness: f64,
}

impl RiemannViscosity {
    /// For a density at rest and the speed of sound in m/s.
    pub fn new(reference_density: f64, c0: f64) -> Self {
        RiemannViscosity {
            impedance: reference_density * c0,
            steepness: LIMITER / c0,
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for RiemannViscosity {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            vector: true,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        let parting = dot(&relative_velocity(own, other), &pair.separation);
        let approach = -parting.min(L::zero()) * pair.inverse_distance();
        let limiter = (L::constant(self.steepness) * approach).min(L::constant(1.0));
        tally.push(-(L::constant(self.impedance) * limiter * approach * pair.slope));
    }
}

/// What the effect is.
pub const RIEMANN_VISCOSITY: Declaration = Declaration {
    name: "Riemann dissipation",
    columns: &[],
    sweeps: 1,
    limit: None,
    dissipates: "kinetic energy of approaching pairs",
    source: "Zhang, Hu & Adams 2017",
};

/// The part of `U*` beyond the mean, as a rate of density `-ρ0 Σ V_j c0 r (s_j - s_i - expected) F_ij` with the condensation
/// `s`, `p = ρ0 c0² s`: of the form of density diffusion with `δ h` replaced by half the distance. The states meet half-way, extrapolated by their
/// renormalised gradients (van Leer 1979), without which water at rest is lifted at its surface; a linear pressure is then
/// left alone. Dissipates energy of sound; `Σ V_i D_i = 0`. Needs [`super::DensityGradient`].
#[derive(Clone, Copy, Debug)]
pub struct RiemannDiffusion {
    strength: f64,
}

impl RiemannDiffusion {
    /// For the speed of sound in m/s and a coefficient, 1 for the whole.
    pub fn new(coefficient: f64, c0: f64) -> Self {
        RiemannDiffusion {
            strength: coefficient * c0,
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for RiemannDiffusion {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            scalar: true,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        let (g, k) = (own.gradient(), other.gradient());
        let gradients: [L; D] = std::array::from_fn(|a| g[a] + k[a]);
        let expected = L::constant(-0.5) * dot(&gradients, &pair.separation);
        let excess = other.condensation() - own.condensation() - expected;
        tally.exchange(L::constant(-self.strength) * pair.distance() * pair.slope * excess);
    }
}

/// The fastest decay in 1/s of [`RiemannDiffusion`] on a lattice, for a coefficient and a speed of sound of 1: the step must not
/// be longer than its inverse.
pub fn fastest_diffusion<const D: usize>(kernel: KernelName, h: f64, spacing: f64) -> f64 {
    const WAVES: i32 = 8;
    let reach = (h * kernel.support() / spacing).ceil() as i32;
    let lattice = |side: i32, low: i32| {
        (0..side.pow(D as u32)).map(move |k| {
            std::array::from_fn::<f64, D, _>(|a| f64::from(low + k / side.pow(a as u32) % side))
        })
    };
    let decay = |k: &[f64; D]| -> f64 {
        lattice(2 * reach + 1, -reach)
            .map(|x| {
                let r = dot(&x, &x).sqrt() * spacing;
                if r > 0.0 && r < h * kernel.support() {
                    let phase = dot(k, &x) * std::f64::consts::PI / f64::from(WAVES);
                    -kernel.gradient(D, r, h) * spacing.powi(D as i32) * (1.0 - phase.cos())
                } else {
                    0.0
                }
            })
            .sum()
    };
    lattice(WAVES + 1, 0).map(|k| decay(&k)).fold(0.0, f64::max)
}
