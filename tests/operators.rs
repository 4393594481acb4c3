//! The operators: exact where they should be, convergent elsewhere, conservative where they claim it.

mod common;

use common::{Noise, points, with_cloud};
use kolk::kernel::KernelName;
use kolk::operators::{
    Cloud, Diffusion, Shift, corrections, density_diffusion, divergence, gradient, interpolate,
    laplacian, particle_shift, smallest_eigenvalue,
};
use std::f64::consts::TAU;

fn linear_fields_are_exact<const D: usize>(side: usize, kernel: KernelName) {
    let position = points::<D>(side, 0.4);
    with_cloud(&position, 1.0 / side as f64, false, kernel, |cloud| {
        let slope = [[2.0, -3.0, 0.5], [0.7, 1.1, -4.0], [-1.3, 0.2, 0.9]];
        let field = |c: usize, x: &[f64; D]| 5.0 + (0..D).map(|a| slope[c][a] * x[a]).sum::<f64>();
        let vector: Vec<[f64; D]> = position
            .iter()
            .map(|x| std::array::from_fn(|c| field(c, x)))
            .collect();
        let found = gradient(cloud, vector.as_flattened(), D, true);
        for (k, found) in found.iter().enumerate() {
            let expected = slope[k / D % D][k % D];
            assert!(
                (found - expected).abs() < 1e-10,
                "{kernel} {D}D gradient {found}, {expected}"
            );
        }
        let expected: f64 = (0..D).map(|a| slope[a][a]).sum();
        for found in divergence(cloud, &vector, true) {
            assert!(
                (found - expected).abs() < 1e-10,
                "{kernel} {D}D divergence {found}, {expected}"
            );
        }
        for found in laplacian(cloud, vector.as_flattened(), D, true) {
            assert!(found.abs() < 1e-9, "{kernel} {D}D Laplacian {found}");
        }
    });
}

#[test]
fn corrected_operators_are_exact_for_linear_fields_on_disordered_particles() {
    for kernel in KernelName::ALL {
        linear_fields_are_exact::<1>(50, kernel);
        linear_fields_are_exact::<2>(24, kernel);
        linear_fields_are_exact::<3>(9, kernel);
    }
}

#[test]
fn operators_converge_on_a_wave() {
    let error = |side: usize| {
        let (position, spacing) = (points::<2>(side, 0.0), 1.0 / side as f64);
        let (mass, density) = (vec![spacing * spacing; side * side], vec![1.0; side * side]);
        let periodic = [Some([0.0, 1.0]); 2];
        // Enough neighbours that the smoothing, which is of second order, is all of the error.
        let cloud = Cloud::new(
            &position,
            &mass,
            &density,
            KernelName::WendlandC4,
            2.5 * spacing,
            &periodic,
        );
        let wave: Vec<f64> = position
            .iter()
            .map(|x| (TAU * x[0]).sin() * (TAU * x[1]).cos())
            .collect();
        let mut worst = [0.0_f64; 2];
        for corrected in [false, true] {
            let slope = gradient(&cloud, &wave, 1, corrected);
            let curvature = laplacian(&cloud, &wave, 1, corrected);
            for (i, x) in position.iter().enumerate() {
                let expected = TAU * (TAU * x[0]).cos() * (TAU * x[1]).cos();
                worst[0] = worst[0].max((slope[2 * i] - expected).abs() / TAU);
                let expected = -2.0 * TAU * TAU * wave[i];
                worst[1] = worst[1].max((curvature[i] - expected).abs() / (2.0 * TAU * TAU));
            }
        }
        worst
    };
    let (coarse, fine) = (error(24), error(48));
    for k in 0..2 {
        assert!(
            fine[k] < 0.03 && fine[k] < 0.3 * coarse[k],
            "{coarse:?} to {fine:?}"
        );
    }
}

#[test]
fn interpolation_is_exact_for_constants_and_says_where_nothing_is() {
    let position = points::<3>(8, 0.3);
    with_cloud(&position, 0.125, false, KernelName::Quintic, |cloud| {
        let value: Vec<f64> = (0..2 * position.len())
            .map(|k| if k % 2 == 0 { 4.5 } else { -1.0 })
            .collect();
        let found = interpolate(
            cloud,
            &[[0.5; 3], [0.0; 3], [9.0; 3]],
            &value,
            2,
            true,
            f64::NAN,
        );
        for (found, expected) in found.iter().zip([4.5, -1.0, 4.5, -1.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert!(found[4].is_nan() && found[5].is_nan());
        let plain = interpolate(
            cloud,
            &[[0.5; 3], [0.0; 3]],
            &vec![1.0; position.len()],
            1,
            false,
            0.0,
        );
        assert!((plain[0] - 1.0).abs() < 0.1 && plain[1] < 0.3, "{plain:?}");
    });
}

#[test]
fn singular_arrangements_give_the_gradient_that_can_be_known() {
    let line: Vec<[f64; 3]> = (0..9)
        .map(|k| [0.6 * f64::from(k), 0.8 * f64::from(k), 1.0])
        .collect();
    with_cloud(&line, 1.0, false, KernelName::WendlandC2, |cloud| {
        let value: Vec<f64> = line.iter().map(|x| 3.0 * x[0] + x[2]).collect();
        for slope in gradient(cloud, &value, 1, true).chunks(3) {
            // The part of (3, 0, 1) along the line.
            for (found, expected) in slope.iter().zip([1.8 * 0.6, 1.8 * 0.8, 0.0]) {
                assert!((found - expected).abs() < 1e-10, "{slope:?}");
            }
        }
    });
    with_cloud(
        &[[0.0, 0.0], [0.0, 0.0], [50.0, 0.0]],
        1.0,
        false,
        KernelName::Cubic,
        |cloud| {
            let value = [1.0, 2.0, 3.0];
            assert_eq!(corrections(cloud), [[[0.0; 2]; 2]; 3]);
            assert_eq!(gradient(cloud, &value, 1, true), [0.0; 6]);
            assert!(
                laplacian(cloud, &value, 1, true)
                    .iter()
                    .all(|x| x.is_finite())
            );
            let between = interpolate(cloud, &[[0.0, 0.0]], &value, 1, true, 0.0)[0];
            assert!((between - 1.5).abs() < 0.05, "{between}");
        },
    );
    assert!((smallest_eigenvalue(&[[2.0, 1.0], [1.0, 2.0]]) - 1.0).abs() < 1e-14);
}

/// A column of water at rest: Tait's density under gravity.
fn hydrostatic(position: &[[f64; 2]], sound_speed: f64) -> Vec<f64> {
    let stiffness = 1000.0 * sound_speed * sound_speed / 7.0;
    position
        .iter()
        .map(|x| 1000.0 * (1.0 + 9810.0 * (1.0 - x[1]) / stiffness).powf(1.0 / 7.0))
        .collect()
}

#[test]
fn density_diffusion_leaves_alone_what_it_should_and_conserves_mass() {
    let (position, c) = (points::<2>(20, 0.35), 45.0);
    let mass = vec![2.5; position.len()];
    let density = hydrostatic(&position, c);
    let fourtakas = Diffusion::Fourtakas {
        gravity: [0.0, -9.81],
        reference_density: 1000.0,
        gamma: 7.0,
    };
    let worst = |density: &[f64], form| {
        let cloud = Cloud::new(
            &position,
            &mass,
            density,
            KernelName::WendlandC2,
            0.075,
            &[None; 2],
        );
        let rate = density_diffusion(&cloud, form, 0.1, c);
        let sum: f64 = rate.iter().zip(&cloud.volume).map(|(d, v)| d * v).sum();
        (
            rate.iter().fold(0.0, |worst: f64, d| worst.max(d.abs())),
            sum,
        )
    };
    let linear: Vec<f64> = position
        .iter()
        .map(|x| 1000.0 + 2.0 * x[0] - 3.0 * x[1])
        .collect();
    assert!(worst(&linear, Diffusion::Antuono).0 < 1e-9);
    // At rest Molteni's form raises the surface's density; the others balance.
    let molteni = worst(&density, Diffusion::Molteni).0;
    assert!(worst(&density, Diffusion::Antuono).0 < 0.02 * molteni);
    // Hydrostatics relative to ρ0 rather than to the pair's density: 3 % off at this depth.
    assert!(worst(&density, fourtakas).0 < 0.05 * molteni);
    let mut noise = Noise(5);
    let rough: Vec<f64> = density.iter().map(|d| d + noise.number()).collect();
    for form in [Diffusion::Molteni, Diffusion::Antuono] {
        let (rate, sum) = worst(&rough, form);
        assert!(
            rate > 1.0 && sum.abs() < 1e-10 * rate,
            "{form:?}: {rate}, {sum}"
        );
    }
}

#[test]
fn density_diffusion_smooths_at_the_rate_of_its_diffusivity() {
    let (side, c, delta) = (40, 30.0, 0.1);
    let position = points::<2>(side, 0.0);
    let spacing = 1.0 / side as f64;
    let density: Vec<f64> = position
        .iter()
        .map(|x| 1000.0 + (TAU * x[0]).sin())
        .collect();
    let mass: Vec<f64> = density.iter().map(|d| d * spacing * spacing).collect();
    let h = 1.5 * spacing;
    let cloud = Cloud::new(
        &position,
        &mass,
        &density,
        KernelName::WendlandC2,
        h,
        &[Some([0.0, 1.0]); 2],
    );
    let rate = density_diffusion(&cloud, Diffusion::Molteni, delta, c);
    for (rate, density) in rate.iter().zip(&density) {
        // δ h c0 ∇²ρ
        let expected = -delta * h * c * TAU * TAU * (density - 1000.0);
        assert!(
            (rate - expected).abs() < 0.03 * delta * h * c * TAU * TAU,
            "{rate}, {expected}"
        );
    }
}

fn unevenness<const D: usize>(position: &[[f64; D]], side: usize) -> f64 {
    let mut sum = 0.0;
    with_cloud(
        position,
        1.0 / side as f64,
        true,
        KernelName::WendlandC2,
        |cloud| {
            let value = vec![1.0; position.len()];
            let whole = interpolate(cloud, position, &value, 1, false, 0.0);
            let mean = whole.iter().sum::<f64>() / whole.len() as f64;
            sum = whole.iter().map(|w| (w - mean).powi(2)).sum::<f64>() / whole.len() as f64;
        },
    );
    sum.sqrt()
}

fn shifting_spreads_particles<const D: usize>(side: usize) {
    let spacing = 1.0 / side as f64;
    let sun = Shift::Sun {
        time_step: 0.1 * spacing,
        speed: 1.0,
    };
    for (form, steps) in [(sun, 60), (Shift::Lind, 20)] {
        let mut position = points::<D>(side, 0.3);
        let before = unevenness(&position, side);
        for _ in 0..steps {
            let mut shift = Vec::new();
            with_cloud(&position, spacing, true, KernelName::WendlandC2, |cloud| {
                shift = particle_shift(cloud, form, spacing, true);
            });
            for (x, d) in position.iter_mut().zip(&shift) {
                *x = std::array::from_fn(|a| x[a] + d[a]);
            }
        }
        let after = unevenness(&position, side);
        assert!(
            after < 0.5 * before,
            "{form:?} in {D}D: {before} to {after}"
        );
    }
}

#[test]
fn shifting_spreads_particles_evenly() {
    shifting_spreads_particles::<2>(20);
    shifting_spreads_particles::<3>(9);
}
