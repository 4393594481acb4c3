//! Density diffusion: `δ h c0 Σ V_j ψ_ij·∇W_ij` added to the rate of density, which keeps the pressure of a weakly
//! compressible fluid free of checkerboard noise.
//!
//! All forms share `ψ_ij = 2 [(ρ_j - ρ_i) - expected] r_ji/r²` and differ in the difference of density that they
//! expect. Since `r_ji·∇W_ij/r² = -F`, no division is left. The pair term is antisymmetric: `Σ V_i D_i = 0`. A
//! diffusivity of `δ h c0`: dissipates compression energy; use δ = 0.1.

use super::PairTerm;
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Pair, Splat, Sums};

/// The term for a difference of condensation beyond the expected one.
#[inline(always)]
fn diffuse<L: Lanes, const D: usize>(
    strength: f64,
    pair: &Pair<L, D>,
    other: &Other<L, D>,
    excess: L,
    sums: &mut Sums<L, D>,
) {
    let rate = L::constant(-2.0 * strength) * other.volume() * pair.slope;
    sums.scalar = rate.mul_add(excess, sums.scalar);
}

/// Molteni & Colagrossi 2009: expects no difference. One pass and the cheapest, but it drives fluid at rest under
/// gravity upwards at the free surface; choose it without gravity.
#[derive(Clone, Copy, Debug)]
pub struct Molteni {
    strength: f64,
}

/// Antuono et al. 2010 (δ-SPH): expects the mean renormalised gradient, so that it vanishes for linear density up to
/// the free surface. Needs [`DensityGradient`]; the default.
#[derive(Clone, Copy, Debug)]
pub struct Antuono {
    strength: f64,
}

/// Fourtakas et al. 2019: expects the hydrostatic difference. No gradients, for uniform gravity only.
#[derive(Clone, Copy, Debug)]
pub struct Fourtakas<const D: usize> {
    strength: f64,
    slope: [f64; D],
    curvature: f64,
}

impl Molteni {
    /// With coefficient `delta`, smoothing length `h` in m and sound speed `c0` in m/s.
    pub fn new(delta: f64, h: f64, c0: f64) -> Self {
        Molteni {
            strength: delta * h * c0,
        }
    }
}

impl Antuono {
    /// With coefficient `delta`, smoothing length `h` in m and sound speed `c0` in m/s.
    pub fn new(delta: f64, h: f64, c0: f64) -> Self {
        Antuono {
            strength: delta * h * c0,
        }
    }
}

impl<const D: usize> Fourtakas<D> {
    /// With coefficient `delta`, smoothing length `h` in m, sound speed `c0` in m/s, the exponent `gamma` of Tait's
    /// equation and gravity in m/s².
    pub fn new(delta: f64, h: f64, c0: f64, gamma: f64, gravity: [f64; D]) -> Self {
        // (1 + x)^(1/γ) - 1 with x = γ g·(r_j - r_i)/c0², to second order: x is below 1e-2 within a support radius.
        Fourtakas {
            strength: delta * h * c0,
            slope: gravity.map(|g| g / (c0 * c0)),
            curvature: 0.5 * (1.0 - gamma),
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Molteni {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        diffuse(
            self.strength,
            pair,
            other,
            other.condensation() - own.condensation(),
            sums,
        );
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Antuono {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let (g, k) = (own.gradient(), other.gradient());
        let gradients: [L; D] = std::array::from_fn(|a| g[a] + k[a]);
        let expected = L::constant(-0.5) * dot(&gradients, &pair.separation);
        diffuse(
            self.strength,
            pair,
            other,
            other.condensation() - own.condensation() - expected,
            sums,
        );
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Fourtakas<D> {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let x = -dot(&self.slope.map(L::constant), &pair.separation);
        let expected = x * x.mul_add(L::constant(self.curvature), L::constant(1.0));
        diffuse(
            self.strength,
            pair,
            other,
            other.condensation() - own.condensation() - expected,
            sums,
        );
    }
}

/// Sums for the renormalised gradient of the condensation, `L_i Σ V_j (s_j - s_i) ∇W_ij` with
/// `L_i⁻¹ = -Σ V_j r_ij ⊗ ∇W_ij` (Randles & Libersky 1996): exact for linear fields.
#[derive(Clone, Copy, Debug)]
pub struct DensityGradient;

impl<R: Real, const D: usize> PairTerm<R, D> for DensityGradient {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let r = &pair.separation;
        let weight = other.volume() * pair.slope;
        let difference = weight * (other.condensation() - own.condensation());
        for a in 0..D {
            sums.gradient[a] = difference.mul_add(r[a], sums.gradient[a]);
        }
        sums.add_moment(-weight, r);
    }
}

impl DensityGradient {
    /// The gradient from its sums; not renormalised where the neighbours do not span the space.
    #[inline(always)]
    pub fn finish<L: Lanes, const D: usize>(sums: &Sums<L, D>) -> [L::Real; D] {
        sums.renormalise(sums.gradient.map(|g| g.sum()))
    }
}
