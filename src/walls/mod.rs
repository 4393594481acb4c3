//! Solid walls: one file per boundary method.

mod adami;
mod dynamic;
mod facet;
mod leaks;
mod mirror;
mod modified_dynamic;
mod penalty;
mod planes;
mod semi_analytical;
mod shift;
mod surface;
mod wall_factor;

pub use adami::Extrapolation;
pub use facet::Facet;
pub use leaks::DEPTH;
pub use mirror::{Mirror, MirroredForces};
pub use modified_dynamic::{Ghosts, NodeValues, NodeWeights};
pub use penalty::Penalty;
pub use planes::check_planes;
pub use semi_analytical::SemiAnalytical;
pub use surface::{Foot, Surface};
pub use wall_factor::{Share, WallFactor};

use crate::effects::{Declaration, Quantity};
use crate::eos::{AnyEos, EquationOfState};
use crate::simd::dot;
use serde::{Deserialize, Serialize};

/// How walls act on the fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WallMethod {
    /// Dummy particles with pressure extrapolated from the fluid (Adami, Hu & Adams 2012).
    Adami,
    /// Particles that follow the equation of continuity in place (Crespo, Gómez-Gesteira & Dalrymple 2007).
    Dynamic,
    /// Pressure extrapolated to first order from ghost nodes mirrored into the fluid (English et al. 2021).
    ModifiedDynamic,
    /// Integrals over facets of what a wall cuts off the support (Ferrand et al. 2013; Mayrhofer et al. 2015).
    SemiAnalytical,
    /// Contact with facets (Hallquist 2006).
    Penalty,
    /// Images of the fluid behind planes (Libersky et al. 1993; Colagrossi & Landrini 2003).
    Mirror,
}

impl WallMethod {
    /// Whether it stands on the surface of the walls.
    pub fn needs_surface(self) -> bool {
        !self.uses_particles() || self == WallMethod::ModifiedDynamic
    }

    /// Whether the fluid feels the particles of walls; else it feels their facets.
    pub fn uses_particles(self) -> bool {
        !matches!(
            self,
            WallMethod::SemiAnalytical | WallMethod::Penalty | WallMethod::Mirror
        )
    }
}

/// What the fluid does along a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Slip {
    /// It slides: no viscous force between fluid and wall.
    Free,
    /// It sticks.
    No,
}

/// Condensation and volume of a wall particle of some `pressure` and `mass`; `at_rest` is the condensation without
/// pressure: most of a tank's walls are dry, and cost no power function.
#[inline(always)]
fn follow_pressure(eos: &AnyEos, at_rest: f64, pressure: f64, mass: f64) -> (f64, f64) {
    let condensation = if pressure == 0.0 {
        at_rest
    } else {
        eos.condensation(pressure)
    };
    let volume = mass / (eos.reference_density() * (1.0 + condensation));
    (condensation, volume)
}

/// The hydrostatic difference of pressure along `way`, `ρ g·way`.
#[inline(always)]
fn head<const D: usize>(density: f64, gravity: &[f64; D], way: &[f64; D]) -> f64 {
    density * dot(gravity, way)
}

/// What the effect is.
pub const WALLS: Declaration = Declaration {
    name: "walls",
    columns: &[],
    sweeps: 1,
    limit: None,
    dissipates: "",
    source: "Adami, Hu & Adams 2012; Crespo, Gómez-Gesteira & Dalrymple 2007",
};

/// Walls in prescribed motion.
pub const MOVING_WALLS: Declaration = Declaration {
    name: "moving walls",
    columns: &[Quantity::Vector("acceleration of walls")],
    sweeps: 0,
    limit: None,
    dissipates: "",
    source: "",
};
