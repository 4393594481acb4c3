//! The motion of a rigid body as a function of time.

use super::{Signal, SignalConfig};
use crate::error::{Error, Result};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use serde::{Deserialize, Serialize};

/// A body that moves, as a scene gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionConfig {
    /// Name of the body.
    pub body: String,
    /// What its motion is made of: first the rotations, in this order, then the translations.
    pub parts: Vec<PartConfig>,
}

/// A part of a motion: along a path, as far as a signal says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartConfig {
    /// Where to.
    pub path: Path,
    /// How far: rad, or m per m of the direction, since the start.
    pub signal: SignalConfig,
    /// When it begins, in s.
    #[serde(default)]
    pub start: f64,
    /// When it ends, in s: the body then stays where it came to. Absent: never.
    #[serde(default)]
    pub end: Option<f64>,
}

/// A line or a circle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Path {
    /// Along a direction.
    Translate {
        /// Need not be of length 1.
        direction: Vec<f64>,
    },
    /// About an axis.
    Rotate {
        /// A point of the axis, in m.
        centre: Vec<f64>,
        /// Its direction; in 2D it points at the reader.
        #[serde(default)]
        axis: Option<[f64; 3]>,
    },
}

#[derive(Clone, Debug)]
enum Way {
    Translate(Vector3<f64>),
    Rotate(Vector3<f64>, Unit<Vector3<f64>>),
}

#[derive(Clone, Debug)]
struct Part {
    way: Way,
    signal: Signal,
    start: f64,
    end: f64,
}

/// A motion ready to be evaluated.
#[derive(Clone, Debug)]
pub struct RigidMotion {
    parts: Vec<Part>,
}

/// Where a body is and how it moves: a point that was at `X` is at `x = turn X + offset`, with the velocity
/// `spin × (x - offset) + drift` and its derivative. Vectors have three components, in 2D the last is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Rotation since the start.
    pub turn: Matrix3<f64>,
    /// Displacement of the origin in m.
    pub offset: Vector3<f64>,
    /// Angular velocity in rad/s.
    pub spin: Vector3<f64>,
    /// Rate of the offset in m/s.
    pub drift: Vector3<f64>,
    /// Angular acceleration in rad/s².
    pub spin_rate: Vector3<f64>,
    /// Second derivative of the offset in m/s².
    pub drift_rate: Vector3<f64>,
}

impl Pose {
    /// Of a body at its start, at rest.
    pub fn rest() -> Self {
        let zero = Vector3::zeros();
        Pose {
            turn: Matrix3::identity(),
            offset: zero,
            spin: zero,
            drift: zero,
            spin_rate: zero,
            drift_rate: zero,
        }
    }

    /// This motion, all of it carried along by `outer`.
    pub fn carried_by(&self, outer: &Pose) -> Pose {
        let (offset, drift) = (outer.turn * self.offset, outer.turn * self.drift);
        let (w, spin) = (outer.spin, outer.turn * self.spin);
        Pose {
            turn: outer.turn * self.turn,
            offset: offset + outer.offset,
            spin: w + spin,
            drift: w.cross(&offset) + drift + outer.drift,
            spin_rate: outer.spin_rate + outer.turn * self.spin_rate + w.cross(&spin),
            drift_rate: outer.spin_rate.cross(&offset)
                + w.cross(&w.cross(&offset))
                + 2.0 * w.cross(&drift)
                + outer.turn * self.drift_rate
                + outer.drift_rate,
        }
    }

    /// Where the point that is at `x` now was at the start.
    #[inline]
    pub fn home_of<const D: usize>(&self, x: &[f64; D]) -> [f64; D] {
        let arm = Vector3::from_fn(|a, _| x.get(a).copied().unwrap_or(0.0)) - self.offset;
        let home = self.turn.tr_mul(&arm);
        std::array::from_fn(|a| home[a])
    }

    /// A direction of the start as it is now.
    #[inline]
    pub fn turned<const D: usize>(&self, direction: &[f64; D]) -> [f64; D] {
        let now = self.turn * Vector3::from_fn(|a, _| direction.get(a).copied().unwrap_or(0.0));
        std::array::from_fn(|a| now[a])
    }

    /// Position, velocity and acceleration of the point that was at `start`.
    #[inline]
    pub fn of<const D: usize>(&self, start: &[f64; D]) -> [[f64; D]; 3] {
        let mut at = Vector3::zeros();
        for a in 0..D {
            at[a] = start[a];
        }
        let arm = self.turn * at;
        let swing = self.spin.cross(&arm);
        let velocity = swing + self.drift;
        let acceleration = self.spin_rate.cross(&arm) + self.spin.cross(&swing) + self.drift_rate;
        [arm + self.offset, velocity, acceleration].map(|v| std::array::from_fn(|a| v[a]))
    }
}

impl MotionConfig {
    /// The motion in `dimension` dimensions.
    ///
    /// # Errors
    /// Vectors of the wrong length, an axis without direction, an end before the start, signals that cannot be.
    pub fn build(&self, dimension: usize) -> Result<RigidMotion> {
        let key = format!("motion.{}", self.body);
        let vector = |what: &str, v: &[f64]| {
            if v.len() != dimension || v.iter().any(|v| !v.is_finite()) {
                return Err(Error::Input(format!(
                    "{key}.{what}: found {v:?}, allowed are {dimension} finite numbers"
                )));
            }
            Ok(Vector3::from_fn(|a, _| v.get(a).copied().unwrap_or(0.0)))
        };
        let mut parts = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let way = match &part.path {
                Path::Translate { direction } => Way::Translate(vector("direction", direction)?),
                Path::Rotate { centre, axis } => {
                    let axis = Vector3::from(axis.unwrap_or([0.0, 0.0, 1.0]));
                    let flat = dimension == 2 && (axis[0] != 0.0 || axis[1] != 0.0);
                    let unit = Unit::try_new(axis, 1e-30)
                        .filter(|u| u.iter().all(|v| v.is_finite()) && !flat);
                    let Some(unit) = unit else {
                        return Err(Error::Input(format!(
                            "{key}.axis: found {:?}, allowed is a direction{}",
                            axis.as_slice(),
                            if dimension == 2 { " along z in 2D" } else { "" }
                        )));
                    };
                    Way::Rotate(vector("centre", centre)?, unit)
                }
            };
            let end = part.end.unwrap_or(f64::INFINITY);
            if !part.start.is_finite() || end.is_nan() || end < part.start {
                return Err(Error::Input(format!(
                    "{key}: found a start at {} s and an end at {end} s, allowed is an end after the start",
                    part.start
                )));
            }
            parts.push(Part {
                way,
                signal: part.signal.build(&key)?,
                start: part.start,
                end,
            });
        }
        // Rotations are about points of the body at its start: translations come last.
        parts.sort_by_key(|p| matches!(p.way, Way::Translate(_)));
        Ok(RigidMotion { parts })
    }
}

impl RigidMotion {
    /// Where the body is at `time` (s), and how it moves then.
    pub fn at(&self, time: f64) -> Pose {
        self.parts
            .iter()
            .fold(Pose::rest(), |pose, part| pose.carried_by(&part.at(time)))
    }
}

impl Part {
    fn at(&self, time: f64) -> Pose {
        let clock = time.clamp(self.start, self.end) - self.start;
        let [value, mut rate, mut second] = self.signal.at(clock);
        if time < self.start || time > self.end {
            (rate, second) = (0.0, 0.0);
        }
        let way = value - self.signal.at(0.0)[0];
        match &self.way {
            Way::Translate(direction) => Pose {
                offset: direction * way,
                drift: direction * rate,
                drift_rate: direction * second,
                ..Pose::rest()
            },
            Way::Rotate(centre, axis) => {
                let turn = *Rotation3::from_axis_angle(axis, way).matrix();
                let (spin, spin_rate) = (axis.scale(rate), axis.scale(second));
                // x = c + T (X - c): the offset is c - T c.
                let arm = -(turn * centre);
                let swing = spin.cross(&arm);
                Pose {
                    turn,
                    offset: centre + arm,
                    spin,
                    drift: swing,
                    spin_rate,
                    drift_rate: spin_rate.cross(&arm) + spin.cross(&swing),
                }
            }
        }
    }
}
