//! Contact: what keeps particles apart, and out of walls, where pressure does not.

use super::{Declaration, PairTerm};
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Pair, Splat, Tally, Uses, relative_velocity};

/// Strength in units of `c0²`: particles that approach at a tenth of the speed of sound are kept apart.
const STRENGTH: f64 = 0.3;
/// Share of the approach taken up, in units of `Δp c0`: about critical damping for that strength.
const DAMPING: f64 = 7.0;

/// A soft core: the force density `ρ0 k c0² (V_j/Δp^D) (1 - r²/d²) r_ij / Δp²` between particles nearer than `d`.
///
/// Pressure keeps a fluid from clumping on the average; in splashes, where it vanishes, pairs could close up to nothing
/// and single particles could pass between those of a wall. The core is not felt by particles in order: `d` is 0.4 Δp
/// between fluid particles (0.6 with surface tension), and 0.9 Δp from wall particles, which half a spacing behind the surface are a spacing away.
/// A dashpot along the line of centres takes up the approach, so that what hits a wall does not bounce. Conserves linear
/// and angular momentum; dissipates kinetic energy. In the manner of the collision models of particle methods (Koshizuka, Nobe & Oka
/// 1998) and of penalty contact in finite elements.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    inverse_reach2: f64,
    strength: f64,
    damping: f64,
}

impl Contact {
    /// Between fluid particles, for a spacing in m in `dimension` dimensions, the sound speed in m/s and the density at
    /// rest.
    pub fn fluid(spacing: f64, dimension: usize, c0: f64, reference_density: f64) -> Self {
        Self::new(0.4 * spacing, spacing, dimension, c0, reference_density)
    }

    /// The same in a liquid with surface tension, which balances the pressure in the layers of a surface, so that nothing
    /// else keeps pairs apart there: in the manner of the particle collisions of Kruisbrink, Korzilius, Pearce & Morvan 2018.
    pub fn under_tension(spacing: f64, dimension: usize, c0: f64, reference_density: f64) -> Self {
        Self::new(0.6 * spacing, spacing, dimension, c0, reference_density)
    }

    /// Between fluid and wall particles.
    pub fn wall(spacing: f64, dimension: usize, c0: f64, reference_density: f64) -> Self {
        Self::new(0.9 * spacing, spacing, dimension, c0, reference_density)
    }

    fn new(reach: f64, spacing: f64, dimension: usize, c0: f64, reference_density: f64) -> Self {
        Contact {
            inverse_reach2: 1.0 / (reach * reach),
            strength: STRENGTH * c0 * c0 * reference_density / spacing.powi(2 + dimension as i32),
            damping: DAMPING / (c0 * spacing),
        }
    }
}

impl Contact {
    /// `c` of the force density `c r_ij`, per volume of the other.
    #[inline(always)]
    pub fn push<L: Lanes, const D: usize>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
    ) -> L {
        let depth = L::constant(1.0) - pair.squared * L::constant(self.inverse_reach2);
        let approach = dot(&relative_velocity(own, other), &pair.separation);
        // Never a pull: a dashpot must not hold together what parts.
        let dashpot = (L::constant(1.0) - L::constant(self.damping) * approach).max(L::zero());
        L::constant(self.strength) * depth.max(L::zero()) * dashpot
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Contact {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            vector: true,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        tally.push(self.push(pair, own, other));
    }
}

/// What the effect is.
pub const CONTACT: Declaration = Declaration {
    name: "contact",
    columns: &[],
    sweeps: 0,
    limit: None,
    dissipates: "kinetic energy of particles that close up or hit a wall",
    source: "Koshizuka, Nobe & Oka 1998",
};
