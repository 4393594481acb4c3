//! Tait's equation (as used for water by Cole 1948 and in SPH by Monaghan 1994).

use super::{EquationOfState, compression};
use crate::simd::{Lanes, Real};

/// `p = B [(ρ/ρ0)^γ - 1] + p_b` with `B = c0² ρ0 / γ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tait {
    /// Density at rest `ρ0` [kg/m^D].
    pub reference_density: f64,
    /// Speed of sound at rest `c0` [m/s].
    pub sound_speed: f64,
    /// Exponent `γ`; 7 for water, which is also the fast case.
    pub gamma: f64,
    /// Pressure at rest `p_b` [Pa].
    pub background: f64,
}

/// Lanes of the widest vector that exists (512 bits of f32).
const WIDEST: usize = 16;

impl Tait {
    /// `B` [Pa].
    #[inline(always)]
    pub fn stiffness(&self) -> f64 {
        self.sound_speed * self.sound_speed * self.reference_density / self.gamma
    }
}

/// `(1+s)^7 - 1` by its binomial expansion: every digit of `s` survives.
#[inline(always)]
fn seventh_power_less_one<L: Lanes>(s: L) -> L {
    let mut sum = s + L::constant(7.0);
    for coefficient in [21.0, 35.0, 35.0, 21.0, 7.0] {
        sum = sum.mul_add(s, L::constant(coefficient));
    }
    sum * s
}

/// `(1+s)^γ - 1` for any exponent, lane by lane in double precision.
#[inline(always)]
fn power_less_one<L: Lanes>(s: L, gamma: f64) -> L {
    assert!(L::N <= WIDEST);
    let mut lanes = [L::Real::default(); WIDEST];
    // SAFETY: the array has at least `L::N` places.
    unsafe { s.store(lanes.as_mut_ptr()) };
    powers_less_one(&mut lanes[..L::N], gamma);
    // SAFETY: as above.
    unsafe { L::load(lanes.as_ptr()) }
}

#[inline(never)]
fn powers_less_one<R: Real>(lanes: &mut [R], gamma: f64) {
    for lane in lanes {
        *lane = R::from_f64((gamma * lane.to_f64().ln_1p()).exp_m1());
    }
}

impl EquationOfState for Tait {
    fn reference_density(&self) -> f64 {
        self.reference_density
    }

    #[inline(always)]
    fn pressure<L: Lanes>(&self, condensation: L) -> L {
        let power = if self.gamma == 7.0 {
            seventh_power_less_one(condensation)
        } else {
            power_less_one(condensation, self.gamma)
        };
        power.mul_add(L::constant(self.stiffness()), L::constant(self.background))
    }

    fn condensation(&self, pressure: f64) -> f64 {
        let over = (pressure - self.background) / self.stiffness();
        (over.ln_1p() / self.gamma).exp_m1()
    }

    fn sound_speed(&self, density: f64) -> f64 {
        self.sound_speed * (density / self.reference_density).powf(0.5 * (self.gamma - 1.0))
    }

    fn energy(&self, density: f64) -> f64 {
        let s = (density - self.reference_density) / self.reference_density;
        let elastic = self.stiffness() * compression(self.gamma, s);
        (elastic + self.background * s / (1.0 + s)) / self.reference_density
    }
}
