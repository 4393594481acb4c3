//! Disordered particles with a disordered state, to compare the engine's rates with plain sums.

use super::{Noise, Scene, body, by_id, lattice};
use kolk::eos::{EquationOfState, Tait};
use kolk::kernel::KernelName;
use kolk::operators::{Cloud, gradient};
use kolk::simulation::{Entries, Precision};
use serde_json::{Value, json};
use std::time::Duration;

/// Density at rest in kg/m³.
pub const RHO: f64 = 1000.0;
/// Speed of sound in m/s.
pub const C0: f64 = 20.0;
/// Coefficient of density diffusion.
pub const DELTA: f64 = 0.1;
/// Spacing in m.
pub const SPACING: f64 = 0.1;

/// Disordered particles with a disordered state, and what the engine makes of it.
pub struct Case<const D: usize> {
    /// Smoothing kernel.
    pub kernel: KernelName,
    /// Smoothing length.
    pub h: f64,
    /// Positions, velocities, densities and masses as given.
    pub position: Vec<[f64; D]>,
    pub velocity: Vec<[f64; D]>,
    pub density: Vec<f64>,
    pub mass: Vec<f64>,
    /// The engine's state with its rates.
    pub rates: Entries,
}

/// Rates of the given state, before any step.
pub fn rates(scene: &Scene) -> Entries {
    let mut simulation = scene.start(Precision::F64, 2);
    simulation.advance(1.0, 0, Duration::MAX).unwrap();
    simulation.save()
}

impl<const D: usize> Case<D> {
    /// Particles with this density, `moving` or at rest, under a configuration with `changes`.
    pub fn new(
        kernel: KernelName,
        density: impl Fn(&[f64; D]) -> f64,
        moving: bool,
        changes: Value,
    ) -> Self {
        // No pair is nearer than 0.6 spacings, where the soft core would add to the forces.
        Self::displaced(0.19, kernel, density, moving, changes)
    }

    /// The same with particles displaced by up to `jitter` spacings.
    pub fn displaced(
        jitter: f64,
        kernel: KernelName,
        density: impl Fn(&[f64; D]) -> f64,
        moving: bool,
        changes: Value,
    ) -> Self {
        let spacing = SPACING;
        let across = if D == 2 { 20 } else { 9 };
        let position = lattice([-0.7; D], [across; D], spacing, jitter);
        let mut noise = Noise(5);
        let velocity: Vec<[f64; D]> = position
            .iter()
            .map(|_| [0.0; D].map(|_: f64| if moving { noise.number() } else { 0.0 }))
            .collect();
        let mut fluid = body("fluid", true, spacing, &position, |_| [0.0; D], &density);
        fluid.particles.velocity = velocity.as_flattened().to_vec();
        for mass in &mut fluid.particles.mass {
            *mass *= 1.0 + 0.1 * noise.number();
        }
        let h = 1.3 * spacing;
        let config = json!({
            "dimension": D, "spacing": spacing, "smoothing_length": h, "kernel": kernel.as_str(),
            "reference_density": RHO, "sound_speed": C0,
        });
        let scene = Scene {
            config,
            bodies: vec![fluid],
        }
        .with(changes);
        let given = &scene.bodies[0].particles;
        Case {
            kernel,
            h,
            density: given.density.clone(),
            mass: given.mass.clone(),
            rates: rates(&scene),
            position,
            velocity,
        }
    }

    /// The particles for the operators.
    pub fn cloud(&self) -> Cloud<'_, D> {
        Cloud::new(
            &self.position,
            &self.mass,
            &self.density,
            self.kernel,
            self.h,
            &[None; D],
        )
    }

    /// Pressures by Tait's equation.
    pub fn pressure(&self) -> Vec<f64> {
        let eos = Tait {
            reference_density: RHO,
            sound_speed: C0,
            gamma: 7.0,
            background: 0.0,
        };
        self.density
            .iter()
            .map(|&rho| eos.pressure_at(rho))
            .collect()
    }

    /// `-Σ V_j (p_i + p_j) ∇W_ij / ρ_i`, from the operator of the gradient.
    pub fn pressure_acceleration(&self) -> Vec<[f64; D]> {
        let (cloud, p) = (self.cloud(), self.pressure());
        let differences = gradient(&cloud, &p, 1, false);
        (0..cloud.len())
            .map(|i| {
                let mut surface = [0.0; D];
                cloud.for_each_neighbour(i, |j, d, _, slope| {
                    for a in 0..D {
                        surface[a] += cloud.volume[j] * slope * d[a];
                    }
                });
                std::array::from_fn(|a| {
                    -(differences[i * D + a] + 2.0 * p[i] * surface[a]) / self.density[i]
                })
            })
            .collect()
    }

    /// What the pair term `force(i, j, r_ij, r, F_ij)`, a force density per volume of `j`, adds to the acceleration.
    pub fn viscous_acceleration(
        &self,
        force: impl Fn(&Cloud<D>, usize, usize, [f64; D], f64, f64) -> [f64; D],
    ) -> Vec<[f64; D]> {
        let cloud = self.cloud();
        let mut total = self.pressure_acceleration();
        for (i, sum) in total.iter_mut().enumerate() {
            cloud.for_each_neighbour(i, |j, d, r, slope| {
                let f = force(&cloud, i, j, d, r, slope);
                for a in 0..D {
                    sum[a] += cloud.volume[j] * f[a] / self.density[i];
                }
            });
        }
        total
    }

    /// `u_i - u_j`.
    pub fn relative_velocity(&self, i: usize, j: usize) -> [f64; D] {
        std::array::from_fn(|a| self.velocity[i][a] - self.velocity[j][a])
    }

    /// Checks the engine's acceleration.
    pub fn assert_acceleration(&self, wanted: &[[f64; D]], what: &str) {
        for a in 0..D {
            let wanted: Vec<f64> = wanted.iter().map(|w| w[a]).collect();
            assert_close(
                &by_id(&self.rates, &format!("acceleration_{a}")),
                &wanted,
                what,
            );
        }
    }
}

/// Equal to 1e-10 of the largest.
pub fn assert_close(found: &[f64], wanted: &[f64], what: &str) {
    let largest = wanted.iter().fold(0.0f64, |m, w| m.max(w.abs()));
    assert!(largest > 0.0);
    for (i, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        let error = (found - wanted).abs();
        assert!(
            error <= 1e-10 * largest,
            "{what}: particle {i} has {found}, not {wanted} (largest {largest})"
        );
    }
}

/// Scalar product.
pub fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|k| a[k] * b[k]).sum()
}

/// A density that waves by a hundredth.
pub fn wavy<const D: usize>(x: &[f64; D]) -> f64 {
    RHO * (1.0 + 0.01 * (3.0 * x[0] + 5.0 * x[D - 1]).sin())
}
