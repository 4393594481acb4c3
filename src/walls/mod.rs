//! Solid walls: one file per boundary method.

mod adami;
mod dynamic;

pub use adami::Extrapolation;

use crate::effects::{Declaration, Quantity};
use serde::{Deserialize, Serialize};

/// How walls act on the fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WallMethod {
    /// Dummy particles with pressure extrapolated from the fluid (Adami, Hu & Adams 2012).
    Adami,
    /// Particles that follow the equation of continuity in place (Crespo, Gómez-Gesteira & Dalrymple 2007).
    Dynamic,
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
