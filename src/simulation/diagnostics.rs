//! What a run reports of itself.

use super::solver::Solver;
use crate::eos::EquationOfState;
use crate::particles::{for_ranges, sum};
use crate::simd::Real;

/// Sums and extremes over the fluid. Energies in J, per metre of depth in 2D.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    /// Simulated time in s.
    pub time: f64,
    /// `Σ ½ m u²`.
    pub kinetic_energy: f64,
    /// `-Σ m g·x`.
    pub potential_energy: f64,
    /// `Σ m e(ρ)`, the work done by pressure from the density at rest.
    pub compression_energy: f64,
    /// `Σ m u` in kg m/s.
    pub momentum: Vec<f64>,
    /// `Σ m x × u` about the origin in kg m²/s: one number in 2D, three in 3D.
    pub angular_momentum: Vec<f64>,
    /// Smallest density in kg/m³.
    pub density_min: f64,
    /// Largest density.
    pub density_max: f64,
    /// Largest speed in m/s.
    pub speed_max: f64,
    /// Largest speed over the speed of sound.
    pub mach: f64,
    /// Smallest pressure in Pa.
    pub pressure_min: f64,
    /// Largest pressure.
    pub pressure_max: f64,
    /// Distance of the closest pair of fluid particles in initial spacings; infinite if no two are near.
    pub closest_pair: f64,
    /// Particles brought back from behind a wall since the start.
    pub leaks: u64,
    /// Energy that effects have taken since the start, in J.
    pub dissipated: Vec<(&'static str, f64)>,
    /// Particles with another nearer than half a spacing.
    pub crowded: u64,
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// The present state in numbers.
    pub fn diagnostics(&self) -> Diagnostics {
        let (fluid, eos) = (&self.fluid, &self.motion.eos);
        let gravity = self.motion.gravity;
        // kinetic, potential, compression, momentum (3), angular momentum (3)
        let sums: [f64; 9] = sum(fluid.len(), |i| {
            let m = fluid.mass[i].to_f64();
            let (x, v) = (fluid.at(i), fluid.velocity_of(i));
            let mut s = [0.0; 9];
            for a in 0..D {
                s[0] += 0.5 * m * v[a] * v[a];
                s[1] -= m * gravity[a] * x[a];
                s[3 + a] = m * v[a];
            }
            s[2] = m * eos.energy(fluid.density[i]);
            if D == 3 {
                s[6] = m * (x[1] * v[2] - x[2] * v[1]);
                s[7] = m * (x[2] * v[0] - x[0] * v[2]);
            }
            s[8] = m * (x[0] * v[1] - x[1] * v[0]);
            s
        });
        let extremes = for_ranges(
            fluid.len(),
            || (f64::INFINITY, f64::NEG_INFINITY, 0.0f64),
            |a, b| (a.0.min(b.0), a.1.max(b.1), a.2.max(b.2)),
            |range| {
                let mut e = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
                for i in range {
                    let v = fluid.velocity_of(i);
                    e.0 = e.0.min(fluid.density[i]);
                    e.1 = e.1.max(fluid.density[i]);
                    e.2 = e.2.max(v.iter().map(|v| v * v).sum());
                }
                e
            },
        );
        let crowding = self.crowding();
        let speed = extremes.2.sqrt();
        let (low, high) = if fluid.is_empty() {
            let rest = self.config.reference_density;
            (rest, rest)
        } else {
            (extremes.0, extremes.1)
        };
        Diagnostics {
            time: self.time,
            kinetic_energy: sums[0],
            potential_energy: sums[1],
            compression_energy: sums[2],
            momentum: sums[3..3 + D].to_vec(),
            angular_momentum: if D == 3 {
                sums[6..9].to_vec()
            } else {
                vec![sums[8]]
            },
            density_min: low,
            density_max: high,
            speed_max: speed,
            mach: speed / self.config.sound_speed,
            pressure_min: eos.pressure_at(low),
            pressure_max: eos.pressure_at(high),
            closest_pair: crowding.closest,
            crowded: crowding.crowded,
            leaks: self.boundary.as_ref().map_or(0, |b| b.leaks),
            dissipated: self.dissipated(),
        }
    }
}
