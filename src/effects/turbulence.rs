//! Turbulence below the particle scale.

use super::{Declaration, Quantity, Rheology};
use crate::step::Limit;
use serde::{Deserialize, Serialize};

/// A turbulence model, as a scene gives it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TurbulenceConfig {
    /// Smagorinsky's constant; 0.12 is customary.
    pub smagorinsky: f64,
}

/// The eddy viscosity `ν_t = (C_s Δ)² |S|` with the particle spacing `Δ` and `|S| = √(2 S:S)` of the sub-particle-scale model
/// (Gotoh, Shibahara & Sakai 2001; Dalrymple & Rogers 2006, after Smagorinsky 1963). It dissipates `(C_s Δ)² |S|³` per
/// mass, and vanishes where the flow does not shear. The isotropic part of the model, `2/3 C_I Δ² |S|²`, acts as a pressure of some
/// per cent of `ρ (Δ |S|)²` and is left out.
#[derive(Clone, Copy, Debug)]
pub struct Smagorinsky {
    /// `ρ0 (C_s Δ)²`.
    factor: f64,
}

impl Smagorinsky {
    /// For a particle spacing in m and the density at rest.
    pub fn new(config: TurbulenceConfig, spacing: f64, reference_density: f64) -> Self {
        Smagorinsky {
            factor: reference_density * (config.smagorinsky * spacing).powi(2),
        }
    }
}

impl Rheology for Smagorinsky {
    const DECLARATION: Declaration = Declaration {
        name: "turbulence",
        columns: &[Quantity::Scalar("eddy viscosity")],
        sweeps: 2,
        limit: Some(Limit::Viscous),
        dissipates: "kinetic energy of eddies near the spacing: (Cs Δ)² |S|³ per mass",
        source: "Dalrymple & Rogers 2006",
    };

    #[inline(always)]
    fn viscosity(&self, shear_rate: f64) -> f64 {
        self.factor * shear_rate
    }
}
