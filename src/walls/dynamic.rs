//! Dynamic boundary particles (Crespo, Gómez-Gesteira & Dalrymple 2007).
//!
//! Wall particles stay in place and follow the equation of continuity; their pressure comes from the equation of
//! state. Simple and cheap, at the price of a gap of about a smoothing length and of pressure noise: a baseline.

use crate::eos::{AnyEos, EquationOfState};
use crate::particles::Wall;
use crate::simd::Real;

impl<R: Real, const D: usize> Wall<R, D> {
    /// Condensation, volume and pressure from the density.
    pub fn follow_density(&mut self, eos: &AnyEos) {
        let Some((density, _)) = &self.density else {
            return;
        };
        let reference = eos.reference_density();
        for i in 0..density.len() {
            self.condensation[i] = R::from_f64((density[i] - reference) / reference);
            self.volume[i] = R::from_f64(self.mass[i].to_f64() / density[i]);
            self.pressure[i] = eos.pressure(self.condensation[i]);
        }
    }

    /// A step of the density, kept from falling below rest: a wall of this kind must not pull.
    pub fn advance_density(&mut self, dt: f64, reference: f64) {
        let Some((density, rate)) = &mut self.density else {
            return;
        };
        for (d, r) in density.iter_mut().zip(rate.iter()) {
            *d = (*d + dt * r.to_f64()).max(reference);
        }
    }
}
