//! What a pair term sees: the geometry of a vector of pairs, the particle itself, and its neighbours.

use super::SLOTS;
use crate::kernel::KernelName;
use crate::simd::{Lanes, Real};

/// Names of the fields that a source may carry.
pub mod slot {
    /// Volume.
    pub const VOLUME: usize = 0;
    /// Pressure.
    pub const PRESSURE: usize = 1;
    /// Dynamic viscosity, in sweeps that read no pressure.
    pub const VISCOSITY: usize = 1;
    /// How near a surface, in sweeps that read no pressure.
    pub const NEARNESS: usize = 1;
    /// `ρ/ρ0 - 1`.
    pub const CONDENSATION: usize = 2;
    /// First component of the velocity.
    pub const VELOCITY: usize = 3;
    /// First component of the gradient of the condensation, or of another vector.
    pub const GRADIENT: usize = 6;
    /// Rate of density.
    pub const RATE: usize = 9;
}

/// Geometry of one particle and a vector of neighbours.
pub struct Pair<L: Lanes, const D: usize> {
    /// `r_i - r_j`.
    pub separation: [L; D],
    /// `|r_i - r_j|²`.
    pub squared: L,
    /// `F` of `∇W = F (r_i - r_j)`, zero out of reach.
    pub slope: L,
    pub(super) q: L,
    pub(super) inside: L::Mask,
    pub(super) normalisation: L,
    pub(super) kernel: KernelName,
}

impl<L: Lanes, const D: usize> Pair<L, D> {
    /// `|r_i - r_j|`.
    #[inline(always)]
    pub fn distance(&self) -> L {
        self.squared.sqrt()
    }

    /// `1/|r_i - r_j|`, finite for particles in the same place.
    #[inline(always)]
    pub fn inverse_distance(&self) -> L {
        self.squared.max(L::constant(1e-30)).sqrt().recip()
    }

    /// `W`, zero out of reach.
    #[inline(always)]
    pub fn weight(&self) -> L {
        (self.normalisation * self.kernel.shape(self.q)).only(self.inside)
    }
}

/// The particle for which a sum is made.
pub struct Own<R, const D: usize> {
    pub(super) fields: [R; SLOTS],
}

/// A vector of its neighbours.
pub struct Other<L: Lanes, const D: usize> {
    pub(super) at: *const L::Real,
    pub(super) stride: usize,
}

macro_rules! fields {
    ($field:ident) => {
        /// Volume in m³.
        #[inline(always)]
        pub fn volume(&self) -> L {
            self.$field(slot::VOLUME)
        }
        /// Pressure in Pa.
        #[inline(always)]
        pub fn pressure(&self) -> L {
            self.$field(slot::PRESSURE)
        }
        /// Dynamic viscosity in Pa s, where a sweep reads that.
        #[inline(always)]
        pub fn viscosity(&self) -> L {
            self.$field(slot::VISCOSITY)
        }
        /// How near a surface, where a sweep reads that.
        #[inline(always)]
        pub fn nearness(&self) -> L {
            self.$field(slot::NEARNESS)
        }
        /// `ρ/ρ0 - 1`.
        #[inline(always)]
        pub fn condensation(&self) -> L {
            self.$field(slot::CONDENSATION)
        }
        /// Velocity in m/s.
        #[inline(always)]
        pub fn velocity(&self) -> [L; D] {
            std::array::from_fn(|a| self.$field(slot::VELOCITY + a))
        }
        /// Rate of density in kg/m³/s.
        #[inline(always)]
        pub fn rate(&self) -> L {
            self.$field(slot::RATE)
        }
        /// Renormalised gradient of the condensation in 1/m, or what else a sweep has there.
        #[inline(always)]
        pub fn gradient(&self) -> [L; D] {
            std::array::from_fn(|a| self.$field(slot::GRADIENT + a))
        }
    };
}

impl<L: Lanes, const D: usize> Other<L, D> {
    #[inline(always)]
    fn load(&self, slot: usize) -> L {
        // SAFETY: the sweep makes this view for a whole vector of a buffer with SLOTS fields behind D positions.
        unsafe { L::load(self.at.add((D + slot) * self.stride)) }
    }
    fields!(load);
}

/// [`Own`] as lanes.
pub struct Splat<'a, L: Lanes, const D: usize>(pub(super) &'a Own<L::Real, D>);

impl<L: Lanes, const D: usize> Splat<'_, L, D> {
    #[inline(always)]
    fn splat(&self, slot: usize) -> L {
        L::splat(self.0.fields[slot])
    }
    fields!(splat);
}

impl<R: Real, const D: usize> Own<R, D> {
    /// The particle's own fields as plain numbers.
    #[inline(always)]
    pub fn values(&self) -> Splat<'_, R, D> {
        Splat(self)
    }
}

/// `u_i - u_j`.
#[inline(always)]
pub fn relative_velocity<L: Lanes, const D: usize>(
    own: &Splat<L, D>,
    other: &Other<L, D>,
) -> [L; D] {
    let (u, v) = (own.velocity(), other.velocity());
    std::array::from_fn(|a| u[a] - v[a])
}
