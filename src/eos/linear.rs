//! The linear equation of state (Monaghan & Kos 1999; Morris, Fox & Zhu 1997).

use super::{EquationOfState, compression};
use crate::simd::Lanes;

/// `p = c0² (ρ - ρ0) + p_b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// Density at rest `ρ0` [kg/m^D].
    pub reference_density: f64,
    /// Speed of sound `c0` [m/s].
    pub sound_speed: f64,
    /// Pressure at rest `p_b` [Pa].
    pub background: f64,
}

impl Linear {
    #[inline(always)]
    fn stiffness(&self) -> f64 {
        self.sound_speed * self.sound_speed * self.reference_density
    }
}

impl EquationOfState for Linear {
    fn reference_density(&self) -> f64 {
        self.reference_density
    }

    #[inline(always)]
    fn pressure<L: Lanes>(&self, condensation: L) -> L {
        condensation.mul_add(L::constant(self.stiffness()), L::constant(self.background))
    }

    fn condensation(&self, pressure: f64) -> f64 {
        (pressure - self.background) / self.stiffness()
    }

    fn sound_speed(&self, _density: f64) -> f64 {
        self.sound_speed
    }

    fn energy(&self, density: f64) -> f64 {
        let s = (density - self.reference_density) / self.reference_density;
        // Tait's with exponent one.
        let elastic = self.stiffness() * compression(1.0, s);
        (elastic + self.background * s / (1.0 + s)) / self.reference_density
    }
}
