//! Gravity that depends on time.

use super::config::Config;
use super::solver::Solver;
use crate::error::Result;
use crate::prescribed::Signal;
use crate::simd::Real;

/// `g(t)`: a constant part and signals along directions.
pub(super) struct Gravity<const D: usize> {
    constant: [f64; D],
    parts: Vec<([f64; D], Signal)>,
}

impl<const D: usize> Gravity<D> {
    /// As the configuration has it; `None` where gravity is constant.
    pub(super) fn new(config: &Config) -> Result<Option<Self>> {
        let mut parts = Vec::new();
        for part in &config.gravity_over_time {
            let direction = std::array::from_fn(|a| part.direction[a]);
            parts.push((direction, part.signal.build("gravity_over_time")?));
        }
        let constant = config.gravity();
        Ok((!parts.is_empty()).then_some(Gravity { constant, parts }))
    }

    /// In m/s² at `time` (s).
    pub(super) fn at(&self, time: f64) -> [f64; D] {
        let mut g = self.constant;
        for (direction, signal) in &self.parts {
            let [strength, ..] = signal.at(time);
            for a in 0..D {
                g[a] += strength * direction[a];
            }
        }
        g
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Lets the stages of a step see gravity as it is at `time`.
    pub(super) fn set_gravity(&mut self, time: f64) {
        if let Some(gravity) = &self.gravity {
            self.motion.gravity = gravity.at(time);
        }
    }
}
