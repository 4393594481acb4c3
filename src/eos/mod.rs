//! Equations of state of a weakly compressible liquid: pressure from density and back, one file each.
//!
//! The engine works with the condensation `s = ρ/ρ0 - 1`, from which the pressure follows without cancellation even
//! in single precision: at a Mach number of 0.01, `s` is 1e-4, and `(ρ/ρ0)^γ - 1` would keep three digits.

mod linear;
mod tait;

pub use linear::Linear;
pub use tait::Tait;

use crate::simd::Lanes;

/// Pressure as a function of density alone.
pub trait EquationOfState: Copy + Send + Sync + 'static {
    /// Density at rest `ρ0` [kg/m^D].
    fn reference_density(&self) -> f64;
    /// Pressure [Pa] from the condensation `s = ρ/ρ0 - 1`.
    fn pressure<L: Lanes>(&self, condensation: L) -> L;
    /// Condensation from the pressure [Pa]: the inverse of [`Self::pressure`]; not a number below the pressure of
    /// zero density.
    fn condensation(&self, pressure: f64) -> f64;
    /// Speed of sound `√(dp/dρ)` [m/s] at a density.
    fn sound_speed(&self, density: f64) -> f64;
    /// Energy of compression per mass [J/kg] at a density, `∫ p/ρ² dρ` from `ρ0`; zero at `ρ0`.
    fn energy(&self, density: f64) -> f64;

    /// Pressure [Pa] at a density [kg/m^D].
    fn pressure_at(&self, density: f64) -> f64 {
        self.pressure((density - self.reference_density()) / self.reference_density())
    }
    /// Density [kg/m^D] at a pressure [Pa].
    fn density_at(&self, pressure: f64) -> f64 {
        self.reference_density() * (1.0 + self.condensation(pressure))
    }
}

/// Any of the equations of state, chosen at run time: one predictable branch per call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyEos {
    /// Tait's.
    Tait(Tait),
    /// The linear one.
    Linear(Linear),
}

macro_rules! each {
    ($self:ident, $eos:ident => $body:expr) => {
        match $self {
            AnyEos::Tait($eos) => $body,
            AnyEos::Linear($eos) => $body,
        }
    };
}

impl EquationOfState for AnyEos {
    fn reference_density(&self) -> f64 {
        each!(self, eos => eos.reference_density())
    }
    #[inline(always)]
    fn pressure<L: Lanes>(&self, condensation: L) -> L {
        each!(self, eos => eos.pressure(condensation))
    }
    fn condensation(&self, pressure: f64) -> f64 {
        each!(self, eos => eos.condensation(pressure))
    }
    fn sound_speed(&self, density: f64) -> f64 {
        each!(self, eos => eos.sound_speed(density))
    }
    fn energy(&self, density: f64) -> f64 {
        each!(self, eos => eos.energy(density))
    }
}

/// `∫_0^s [(1+t)^γ - 1] / (1+t)² dt`: the energy of compression in units of `B/ρ0`.
///
/// Closed form: `x^(γ-1)/(γ-1) + 1/x - γ/(γ-1)` with `x = 1 + s`. Near zero its terms cancel to `γ s²/2`, so the
/// series `Σ_k [C(γ-2, k) - C(-2, k)] s^(k+1)/(k+1)` stands in there.
fn compression(gamma: f64, s: f64) -> f64 {
    if s.abs() < 0.02 {
        let (mut a, mut b, mut power, mut sum) = (1.0, 1.0, s, 0.0);
        for k in 1..16 {
            let k = f64::from(k);
            a *= (gamma - 1.0 - k) / k;
            b *= (-1.0 - k) / k;
            power *= s;
            sum += (a - b) * power / (k + 1.0);
        }
        return sum;
    }
    let log = s.ln_1p();
    let n = gamma - 1.0;
    let expansion = if n == 0.0 {
        log
    } else {
        (n * log).exp_m1() / n
    };
    expansion - s / (1.0 + s)
}

#[cfg(test)]
mod tests;
