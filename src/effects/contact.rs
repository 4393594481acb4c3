//! Contact: what keeps the fluid out of walls.

use super::PairTerm;
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Pair, Splat, Sums};

/// Reach of the contact in spacings. A particle half a spacing in front of a wall is at least one spacing from every
/// wall particle: the contact is not felt there, only by particles that are being pressed into the wall.
const REACH: f64 = 0.9;
/// Strength in units of `c0²`: a particle that hits a wall at 0.2 c0 is stopped before the wall.
const STRENGTH: f64 = 0.3;

/// A linear repulsion between a fluid particle and wall particles nearer than `d = 0.9 Δp`, the force density
/// `ρ0 k c0² / Δp (1 - r/d)` along the line of centres, as in the penalty contact of finite elements. The pressure of a
/// wall keeps a fluid out on the average; this keeps out the single particle of a splash. Conserves energy.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    reach: f64,
    strength: f64,
}

impl Contact {
    /// For a spacing in m, the sound speed in m/s and the density at rest.
    pub fn new(spacing: f64, c0: f64, reference_density: f64) -> Self {
        Contact {
            reach: REACH * spacing,
            strength: STRENGTH * c0 * c0 * reference_density / spacing,
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Contact {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        _own: &Splat<L, D>,
        _other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        // (1 - r/d)/r = 1/r - 1/d, positive within reach only.
        let excess = pair.distance().recip() - L::constant(1.0 / self.reach);
        let push = L::constant(self.strength) * excess.max(L::zero());
        for a in 0..D {
            sums.vector[a] = push.mul_add(pair.separation[a], sums.vector[a]);
        }
    }
}
