//! Density diffusion: `δ h c0 Σ V_j ψ_ij·∇W_ij` added to the rate of density, which keeps the pressure of a weakly
//! compressible fluid free of checkerboard noise.
//!
//! All forms share `ψ_ij = 2 [(ρ_j - ρ_i) - expected] r_ji/r²` and differ in the difference of density that they
//! expect. Since `r_ji·∇W_ij/r² = -F`, no division is left. The pair term is antisymmetric: `Σ V_i D_i = 0`. A
//! diffusivity of `δ h c0`: dissipates compression energy; use δ = 0.1.

use super::{Declaration, PairTerm, Quantity};
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Pair, Splat, Sums, Tally, Uses};

/// The rate for a difference of condensation of 1 beyond the expected one.
#[inline(always)]
fn diffusion<L: Lanes, const D: usize>(strength: f64, pair: &Pair<L, D>) -> L {
    L::constant(-2.0 * strength) * pair.slope
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
        let excess = other.condensation() - own.condensation();
        tally.exchange(diffusion(self.strength, pair) * excess);
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Antuono {
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
        tally.exchange(diffusion(self.strength, pair) * excess);
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Fourtakas<D> {
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
        let x = -dot(&self.slope.map(L::constant), &pair.separation);
        let rate = diffusion(self.strength, pair);
        tally.exchange(rate * (other.condensation() - own.condensation() - x));
        // The second order is the same seen from either.
        tally.source(-(rate * L::constant(self.curvature) * x * x));
    }
}

/// Sums for the renormalised gradient of the condensation, `L_i Σ V_j (s_j - s_i) ∇W_ij` with
/// `L_i⁻¹ = -Σ V_j r_ij ⊗ ∇W_ij` (Randles & Libersky 1996): exact for linear fields.
#[derive(Clone, Copy, Debug)]
pub struct DensityGradient;

impl<R: Real, const D: usize> PairTerm<R, D> for DensityGradient {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            gradient: true,
            moment: true,
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
        tally.gradient(
            pair.slope * (other.condensation() - own.condensation()),
            pair,
        );
        tally.moment(-pair.slope, pair);
    }
}

impl DensityGradient {
    /// The gradient from its sums; not renormalised where the neighbours do not span the space.
    #[inline(always)]
    pub fn finish<R: Real, const D: usize>(sums: &Sums<R, D>) -> [R; D] {
        sums.renormalise(sums.gradient)
    }
}

/// What the effect is, in the form of Antuono or another.
pub const fn density_diffusion(antuono: bool) -> Declaration {
    Declaration {
        name: "density diffusion",
        columns: if antuono {
            &[Quantity::Vector("gradient of density")]
        } else {
            &[]
        },
        sweeps: 0,
        limit: None,
        dissipates: "energy of sound near the spacing",
        source: "Antuono, Colagrossi, Marrone & Molteni 2010; Molteni & Colagrossi 2009; Fourtakas et al. 2019; Zhang, Hu & Adams 2017",
    }
}
