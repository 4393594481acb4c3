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

    /// The start of a step that integrates the density in several stages.
    pub fn keep_density(&mut self) {
        if let (Some((density, _)), Some([start, sum])) = (&self.density, &mut self.stages) {
            start.copy_from_slice(density);
            sum.fill(0.0);
        }
    }

    /// The density of the next stage, `ahead` (s) of the start by the present rate, which enters the outcome with the
    /// weight `weight` (s). The last stage has an `ahead` of none: it ends at the outcome.
    pub fn stage_density(&mut self, ahead: Option<f64>, weight: f64, reference: f64) {
        let (Some((density, rate)), Some([start, sum])) = (&mut self.density, &mut self.stages)
        else {
            return;
        };
        for i in 0..density.len() {
            let rate = rate[i].to_f64();
            sum[i] += weight * rate;
            let change = ahead.map_or(sum[i], |ahead| ahead * rate);
            density[i] = (start[i] + change).max(reference);
        }
    }
}
