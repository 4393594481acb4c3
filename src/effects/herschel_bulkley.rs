//! Liquids with a yield stress: mud, paste, fresh concrete.

use super::{Declaration, Quantity, Rheology};
use crate::step::Limit;
use serde::{Deserialize, Serialize};

/// A Herschel-Bulkley liquid, as a scene gives it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HerschelBulkleyConfig {
    /// Yield stress in Pa.
    #[serde(default)]
    pub yield_stress: f64,
    /// Consistency in Pa s^index.
    pub consistency: f64,
    /// Flow index: 1 for a Bingham liquid, below for one that thins under shear.
    pub index: f64,
    /// Viscosity in Pa s at which a plug creeps; absent: the largest that leaves the time step to sound.
    #[serde(default)]
    pub max_viscosity: Option<f64>,
}

/// `μ(γ̇) = min(τ_y/γ̇ + K γ̇^(n-1), μ_max)` (Herschel & Bulkley 1926; bounded after O'Donovan & Tanner 1984): above the rate at which
/// the bound is met the law is exact, below it the liquid creeps as one of viscosity `μ_max`.
#[derive(Clone, Copy, Debug)]
pub struct HerschelBulkley {
    yield_stress: f64,
    consistency: f64,
    index: f64,
    max_viscosity: f64,
}

impl HerschelBulkley {
    /// With the bound `max_viscosity` in Pa s where the scene gives none.
    pub fn new(config: HerschelBulkleyConfig, max_viscosity: f64) -> Self {
        HerschelBulkley {
            yield_stress: config.yield_stress,
            consistency: config.consistency,
            index: config.index,
            max_viscosity: config.max_viscosity.unwrap_or(max_viscosity),
        }
    }
}

impl Rheology for HerschelBulkley {
    const DECLARATION: Declaration = Declaration {
        name: "Herschel-Bulkley",
        columns: &[Quantity::Scalar("viscosity")],
        sweeps: 2,
        limit: Some(Limit::Viscous),
        dissipates: "kinetic energy: τ_y γ̇ + K γ̇^(n+1) per volume",
        source: "Herschel & Bulkley 1926; Cleary & Monaghan 1999",
    };

    #[inline(always)]
    fn viscosity(&self, shear_rate: f64) -> f64 {
        // At rest the bound holds, but for a liquid without yield stress that does not thin.
        let rate = shear_rate.max(1e-12);
        let stress = self.yield_stress + self.consistency * rate.powf(self.index);
        (stress / rate).min(self.max_viscosity)
    }
}
