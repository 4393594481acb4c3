//! Numerical diffusion of density, which keeps the pressure of a weakly compressible fluid smooth.

use super::{Cloud, gradient};

/// What of the density difference of a pair is smoothed away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Diffusion<const D: usize> {
    /// All of it (Molteni & Colagrossi 2009). Lifts fluid at rest under gravity near its surface.
    Molteni,
    /// What a linear field with the corrected gradients does not explain (Antuono et al. 2010): nothing for a
    /// hydrostatic fluid.
    Antuono,
    /// What hydrostatics does not explain (Fourtakas et al. 2019), with Tait's equation: cheaper than the above, right
    /// for uniform gravity.
    Fourtakas {
        /// Acceleration of gravity [m/s²].
        gravity: [f64; D],
        /// Density at rest [kg/m^D].
        reference_density: f64,
        /// Exponent of Tait's equation.
        gamma: f64,
    },
}

/// Rate of change of density [kg/m^D/s]:
/// `D_i = δ h c0 Σ_j V_j ψ_ij · ∇W_ij` with `ψ_ij = 2 (ρ_j - ρ_i - explained) r_ji / r²`: finite at no
/// distance, where `r_ji · ∇W_ij / r²` is `-F_ij`.
///
/// Antisymmetric in a pair for the first two forms: `Σ V_i D_i = 0`.
pub fn density_diffusion<const D: usize>(
    cloud: &Cloud<D>,
    form: Diffusion<D>,
    delta: f64,
    sound_speed: f64,
) -> Vec<f64> {
    let slopes = match form {
        Diffusion::Antuono => gradient(cloud, cloud.density, 1, true),
        _ => Vec::new(),
    };
    let slopes = slopes.as_chunks::<D>().0;
    let explained = |i: usize, j: usize, d: &[f64; D]| match form {
        Diffusion::Molteni => 0.0,
        // r_ji = -d
        Diffusion::Antuono => {
            -0.5 * (0..D)
                .map(|a| (slopes[i][a] + slopes[j][a]) * d[a])
                .sum::<f64>()
        }
        Diffusion::Fourtakas {
            gravity,
            reference_density,
            gamma,
        } => {
            let deeper = -(0..D).map(|a| gravity[a] * d[a]).sum::<f64>();
            let ratio = gamma * deeper / (sound_speed * sound_speed);
            reference_density * (ratio.max(-1.0).ln_1p() / gamma).exp_m1()
        }
    };
    let scale = 2.0 * delta * cloud.h * sound_speed;
    cloud.map(|i| {
        let mut sum = 0.0;
        cloud.for_each_neighbour(i, |j, d, _, slope| {
            let difference = cloud.density[j] - cloud.density[i] - explained(i, j, &d);
            sum -= cloud.volume[j] * difference * slope;
        });
        scale * sum
    })
}
