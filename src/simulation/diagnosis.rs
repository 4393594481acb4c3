//! Names what is wrong: which particle, where, which quantity, the probable cause and what to change.

use super::guard::DENSITY_RANGE;
use super::retry::Trouble;
use super::solver::Solver;
use crate::error::{Error, Instability};
use crate::simd::Real;

/// How far beyond the integrator's own Courant number sound is probably what the time step does not resolve.
const HIGH_COURANT: f64 = 1.2;
/// Mach number beyond which the speed of sound is probably too low.
const HIGH_MACH: f64 = 0.3;

/// What was found, where.
struct Finding {
    particle: u32,
    position: Vec<f64>,
    quantity: &'static str,
    value: f64,
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// The error that names a trouble, from the state as it is.
    pub(super) fn diagnose(&self, trouble: Trouble) -> Error {
        let finding = match trouble {
            Trouble::NotFinite => self.not_finite(),
            Trouble::Density => self.worst("density", |s, i| {
                let rest = s.config.reference_density;
                (s.fluid.density[i] / rest).max(rest / s.fluid.density[i])
            }),
            Trouble::TimeStep | Trouble::Overshoot => self.worst("acceleration", |s, i| {
                let pulls =
                    (0..D).map(|a| s.fluid.acceleration[a][i].to_f64() + s.motion.gravity[a]);
                pulls.map(|a| a * a).sum::<f64>().sqrt()
            }),
            Trouble::Energy | Trouble::Closeness => self.worst("velocity", |s, i| {
                s.fluid
                    .velocity_of(i)
                    .iter()
                    .map(|v| v * v)
                    .sum::<f64>()
                    .sqrt()
            }),
        };
        let (cause, remedy) = self.cause(trouble, &finding);
        Error::Instability(Box::new(Instability {
            time: self.time,
            step: self.step,
            particle: finding.particle,
            position: finding.position,
            quantity: finding.quantity,
            value: finding.value,
            cause,
            remedy,
        }))
    }

    /// The particle for which `measure` is largest; of equals the lowest id. The value told of a density is itself.
    fn worst(&self, quantity: &'static str, measure: impl Fn(&Self, usize) -> f64) -> Finding {
        let fluid = &self.fluid;
        let mut found = (0, f64::NEG_INFINITY);
        for i in 0..fluid.len() {
            let value = measure(self, i);
            let equal = value == found.1 && fluid.id[i] < fluid.id[found.0];
            if value > found.1 || equal {
                found = (i, value);
            }
        }
        Finding {
            particle: fluid.id[found.0],
            position: fluid.at(found.0).to_vec(),
            quantity,
            value: if quantity == "density" {
                fluid.density[found.0]
            } else {
                found.1
            },
        }
    }

    /// Numbers that are not finite in the state come before those that follow from them, and among equals the lowest id.
    fn not_finite(&self) -> Finding {
        let fluid = &self.fluid;
        let mut found: Option<(usize, u32, usize, &'static str, f64)> = None;
        for i in 0..fluid.len() {
            let (x, v) = (fluid.at(i), fluid.velocity_of(i));
            let rates: [f64; D] = std::array::from_fn(|a| fluid.acceleration[a][i].to_f64());
            let suspects: [(&'static str, &[f64]); 6] = [
                ("mass", &[fluid.mass[i].to_f64()]),
                ("position", &x),
                ("velocity", &v),
                ("density", &[fluid.density[i]]),
                ("acceleration", &rates),
                ("rate of density", &[fluid.density_rate[i].to_f64()]),
            ];
            for (rank, (quantity, values)) in suspects.into_iter().enumerate() {
                let value = values.iter().copied().find(|v| !v.is_finite());
                if let Some(value) = value
                    && found.is_none_or(|f| (rank, fluid.id[i]) < (f.0, f.1))
                {
                    found = Some((rank, fluid.id[i], i, quantity, value));
                }
            }
        }
        // A pressure may overflow where all that it comes from is finite.
        let (_, particle, i, quantity, value) =
            found.unwrap_or((0, fluid.id[0], 0, "pressure", f64::NAN));
        Finding {
            particle,
            position: fluid.at(i).to_vec(),
            quantity,
            value,
        }
    }

    /// The probable cause, and what to change.
    fn cause(&self, trouble: Trouble, finding: &Finding) -> (String, String) {
        let c = &self.config;
        let (speed, sound) = (self.state.speed, c.sound_speed);
        let what = match trouble {
            Trouble::NotFinite => "a number that is not finite".to_owned(),
            Trouble::Density => format!(
                "the density left the range of a weakly compressible fluid ({} to {} of {})",
                DENSITY_RANGE.0, DENSITY_RANGE.1, c.reference_density
            ),
            Trouble::Overshoot => "a step too long for what it led to".to_owned(),
            Trouble::TimeStep => {
                "accelerations so large that the time step has shrunk to nothing".to_owned()
            }
            Trouble::Energy => "energy that came from nowhere".to_owned(),
            Trouble::Closeness => "particles that came much too close".to_owned(),
        };
        let again = if self.guard.snapshot.is_some() && self.guard.memory.attempts > 0 {
            let tries = self.guard.memory.attempts;
            format!(", again after {tries} attempts with ever shorter steps")
        } else {
            String::new()
        };
        let own = c.integrator.courant();
        let high = HIGH_COURANT * own;
        let regular =
            self.limits.smoothing_length / (sound + if speed.is_finite() { speed } else { 0.0 });
        let (why, remedy) = if !finding.value.is_finite() && self.step == 0 {
            (
                "from the initial state".to_owned(),
                "check the initial positions, velocities and densities".to_owned(),
            )
        } else if trouble == Trouble::Density && self.step == 0 {
            (
                "already in the initial state".to_owned(),
                "raise sound_speed, if it is too low for the depth; check the initial densities and pressures"
                    .to_owned(),
            )
        } else if c.time_step.is_some_and(|dt| dt > high * regular) {
            let limit = high * regular;
            (
                format!("the fixed time step is longer than sound allows ({limit:.3e} s)"),
                format!("leave out numerics.time_step, or give less than {limit:.3e}"),
            )
        } else if c.courant.is_some_and(|courant| courant > high) {
            (
                format!("the Courant number {} is too high", self.limits.courant),
                format!("leave out numerics.courant, or give {own} or less"),
            )
        } else if speed > HIGH_MACH * sound {
            (
                format!(
                    "the flow reaches {speed:.3e} m/s, too fast for a sound speed of {sound:.3e} m/s"
                ),
                format!(
                    "raise sound_speed to {:.2e} m/s, ten times the speed, if the flow is meant to be that fast",
                    10.0 * speed
                ),
            )
        } else {
            (
                "overlapping bodies, or a flow that this spacing does not resolve".to_owned(),
                "see what `kolk check` says, lower numerics.courant, or refine spacing".to_owned(),
            )
        };
        (format!("{what}{again}: {why}"), remedy)
    }
}
