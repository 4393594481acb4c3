//! The time step: the least of what the effects allow, and who set it.

use serde::{Deserialize, Serialize};

/// What limited a time step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// Sound crosses a smoothing length: `C h / (c + |u|)`.
    #[default]
    Acoustic,
    /// The shortest wave decays by viscosity.
    Viscous,
    /// Acceleration moves a particle: `0.25 √(h/|a|)` (Monaghan 1992).
    Force,
    /// The scene fixed it.
    Fixed,
    /// A time of output came first.
    Output,
    /// The guard goes carefully after trouble.
    Guard,
    /// The shortest capillary wave crosses a spacing.
    Capillary,
}

impl Limit {
    /// All limits.
    pub const ALL: [Limit; 7] = [
        Limit::Acoustic,
        Limit::Viscous,
        Limit::Force,
        Limit::Fixed,
        Limit::Output,
        Limit::Guard,
        Limit::Capillary,
    ];

    /// The limit that a checkpoint counts as `index`.
    pub fn from_index(index: u64) -> Limit {
        let known = usize::try_from(index).ok().and_then(|k| Self::ALL.get(k));
        known.copied().unwrap_or_default()
    }

    /// Its name in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Limit::Acoustic => "acoustic",
            Limit::Viscous => "viscous",
            Limit::Force => "force",
            Limit::Fixed => "fixed",
            Limit::Output => "output",
            Limit::Guard => "guard",
            Limit::Capillary => "capillary",
        }
    }
}

/// Constants of the criteria.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Courant number `C` of the acoustic criterion.
    pub courant: f64,
    /// Smoothing length in m.
    pub smoothing_length: f64,
    /// The longest step that viscosity allows, in s; infinite without.
    pub viscous: f64,
    /// The longest step that the stages allow, in s, and which criterion says so.
    pub stages: Option<(f64, Limit)>,
    /// A fixed time step in s.
    pub fixed: Option<f64>,
}

impl Limits {
    /// The time step for the largest sound speed, speed (m/s) and acceleration (m/s²), and its limit.
    pub fn time_step(&self, sound_speed: f64, speed: f64, acceleration: f64) -> (f64, Limit) {
        if let Some(dt) = self.fixed {
            return (dt, Limit::Fixed);
        }
        let h = self.smoothing_length;
        let mut best = (self.courant * h / (sound_speed + speed), Limit::Acoustic);
        if self.viscous < best.0 {
            best = (self.viscous, Limit::Viscous);
        }
        if let Some(stages) = self.stages
            && stages.0 < best.0
        {
            best = stages;
        }
        let force = 0.25 * (h / acceleration).sqrt();
        if force < best.0 {
            best = (force, Limit::Force);
        }
        best
    }
}
