//! Resistance in proportion to the velocity.

use super::Declaration;
use super::stage::{Around, Stage};
use crate::particles::{Fluid, Shared, for_each_range};
use crate::simd::Real;
use crate::step::Limit;

/// Share of `1/k` that a step may take, as of the friction of viscosities.
const SHARE: f64 = 0.8;

/// `a = -k u`: the resistance of a porous bed at rest with the permeability `K`, `k = ν/K` (Darcy 1856), of a bed under shallow
/// water (Rayleigh friction), or what brings fluid to rest before a run (Monaghan 1994). It takes `k u²` per mass.
#[derive(Clone, Copy, Debug)]
pub struct LinearDrag {
    /// In 1/s.
    rate: f64,
}

impl LinearDrag {
    /// What the effect is.
    pub const DECLARATION: Declaration = Declaration {
        name: "linear drag",
        columns: &[],
        sweeps: 0,
        limit: Some(Limit::Viscous),
        dissipates: "k u² per mass",
        source: "Darcy 1856",
    };

    /// For a rate in 1/s.
    pub fn new(rate: f64) -> Self {
        LinearDrag { rate }
    }
}

impl<R: Real, const D: usize> Stage<R, D> for LinearDrag {
    fn declaration(&self) -> Declaration {
        Self::DECLARATION
    }

    fn run(&mut self, around: Around<R, D>) {
        let Fluid {
            acceleration,
            pair_velocity,
            ..
        } = around.fluid;
        let factor = R::from_f64(-self.rate);
        for (to, velocity) in acceleration.iter_mut().zip(pair_velocity.iter()) {
            let to = Shared::new(to);
            for_each_range(velocity.len(), |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let to = unsafe { to.range(&range) };
                for (a, &u) in to.iter_mut().zip(&velocity[range]) {
                    *a += factor * u;
                }
            });
        }
    }

    fn longest_step(&self) -> f64 {
        SHARE / self.rate
    }

    fn bytes(&self) -> usize {
        0
    }
}
