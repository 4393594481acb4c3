//! A number as a function of time.

use super::Spline;
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A signal as a scene gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SignalConfig {
    /// `rate t`.
    Rate {
        /// Per second.
        rate: f64,
    },
    /// `amplitude sin(2π frequency t + phase)`.
    Sinus {
        /// Its amplitude.
        amplitude: f64,
        /// In Hz.
        frequency: f64,
        /// In rad.
        #[serde(default)]
        phase: f64,
    },
    /// Points of a curve.
    Table {
        /// Ascending times in s.
        time: Vec<f64>,
        /// The values there.
        value: Vec<f64>,
        /// What lies between them.
        #[serde(default)]
        interpolation: Interpolation,
    },
}

/// What lies between the points of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// A cubic spline: velocity and acceleration have no jumps.
    #[default]
    Cubic,
    /// Straight lines.
    Linear,
}

/// A signal ready to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// `rate t`.
    Rate(f64),
    /// `amplitude sin(ω t + phase)`: amplitude, ω, phase.
    Sinus(f64, f64, f64),
    /// A table.
    Table(Spline),
}

impl SignalConfig {
    /// The signal; `key` names it in messages.
    ///
    /// # Errors
    /// Numbers that are not finite, tables that are too short or not ascending.
    pub fn build(&self, key: &str) -> Result<Signal> {
        let finite = |values: &[f64]| match values.iter().find(|v| !v.is_finite()) {
            Some(v) => Err(Error::Input(format!(
                "{key}: found {v}, allowed are finite numbers"
            ))),
            None => Ok(()),
        };
        match self {
            SignalConfig::Rate { rate } => {
                finite(&[*rate])?;
                Ok(Signal::Rate(*rate))
            }
            SignalConfig::Sinus {
                amplitude,
                frequency,
                phase,
            } => {
                finite(&[*amplitude, *frequency, *phase])?;
                Ok(Signal::Sinus(*amplitude, TAU * frequency, *phase))
            }
            SignalConfig::Table {
                time,
                value,
                interpolation,
            } => {
                finite(time)?;
                finite(value)?;
                if time.len() < 2 || time.len() != value.len() {
                    return Err(Error::Input(format!(
                        "{key}: found {} times and {} values, allowed are as many of each, at least 2",
                        time.len(),
                        value.len()
                    )));
                }
                if let Some(k) = time.windows(2).position(|t| t[1] <= t[0]) {
                    return Err(Error::Input(format!(
                        "{key}: found the time {} after {}, allowed are ascending times",
                        time[k + 1],
                        time[k]
                    )));
                }
                let make = match interpolation {
                    Interpolation::Cubic => Spline::new,
                    Interpolation::Linear => Spline::straight,
                };
                Ok(Signal::Table(make(time.clone(), value.clone())))
            }
        }
    }
}

impl Signal {
    /// Value, first and second derivative at `t` (s).
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            Signal::Rate(rate) => [rate * t, *rate, 0.0],
            Signal::Sinus(amplitude, omega, phase) => {
                let (sin, cos) = (omega * t + phase).sin_cos();
                [
                    amplitude * sin,
                    amplitude * omega * cos,
                    -amplitude * omega * omega * sin,
                ]
            }
            Signal::Table(spline) => spline.at(t),
        }
    }
}
