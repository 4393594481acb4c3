//! Effects without a term of their own: whole-array stages apply them.

use super::Declaration;
use crate::step::Limit;

/// Gravity, constant or over time: added to the acceleration by the kick.
pub const GRAVITY: Declaration = Declaration {
    name: "gravity",
    columns: &[],
    sweeps: 0,
    limit: Some(Limit::Force),
    dissipates: "",
    source: "",
};

/// A bulk viscosity in the pressure that pairs see.
pub const ACOUSTIC_DAMPER: Declaration = Declaration {
    name: "acoustic damper",
    columns: &[],
    sweeps: 0,
    limit: None,
    dissipates: "energy of sound: a bulk viscosity",
    source: "Sun, Pilloton, Antuono & Colagrossi 2023",
};
