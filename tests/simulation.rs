//! Whole simulations: what is conserved, what must not matter, and what fluid at rest shows.

mod common;

use common::{Noise, Scene, advance, free_drop, periodic_box, tank};
use kolk::simulation::{BodyState, Precision, Simulation};
use serde_json::json;
use std::time::Duration;

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// `Σ m |u|` and `Σ m |x| |u|`: what momenta are measured against.
fn scales(state: &BodyState, dimension: usize) -> (f64, f64) {
    let (x, u) = (
        state.position.chunks_exact(dimension),
        state.velocity.chunks_exact(dimension),
    );
    x.zip(u)
        .zip(&state.mass)
        .fold((0.0, 0.0), |(p, l), ((x, u), m)| {
            let momentum = m * norm(u);
            (p + momentum, l + norm(x) * momentum)
        })
}

/// Drift of momentum and of angular momentum over `steps` steps, in units of their scales.
fn drift<const D: usize>(scene: &Scene, precision: Precision, steps: u64) -> (f64, f64) {
    let mut simulation = scene.start(precision, 2);
    let before = simulation.diagnostics();
    let (p, l) = scales(&simulation.body("drop").unwrap(), D);
    advance(&mut simulation, steps);
    let after = simulation.diagnostics();
    let change =
        |a: &[f64], b: &[f64]| norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
    (
        change(&after.momentum, &before.momentum) / p,
        change(&after.angular_momentum, &before.angular_momentum) / l,
    )
}

#[test]
fn a_free_drop_keeps_its_momenta() {
    let viscous = json!({"laminar_viscosity": {"kinematic": 1e-3, "form": "monaghan-gingold"}});
    let shifted = json!({"shifting": {"form": "sun"}});
    for (name, changes) in [
        ("artificial", json!({})),
        ("laminar", viscous),
        ("shifted", shifted),
    ] {
        let (linear, angular) = drift::<2>(
            &free_drop::<2>(30).with(changes.clone()),
            Precision::F64,
            1000,
        );
        assert!(
            linear < 1e-12 && angular < 1e-12,
            "2D, {name}: {linear:e} {angular:e}"
        );
        let (linear, angular) = drift::<3>(&free_drop::<3>(10).with(changes), Precision::F64, 1000);
        assert!(
            linear < 1e-12 && angular < 1e-12,
            "3D, {name}: {linear:e} {angular:e}"
        );
    }
    let (linear, angular) = drift::<2>(&free_drop::<2>(30), Precision::Mixed, 1000);
    assert!(
        linear < 1e-5 && angular < 1e-5,
        "2D, mixed: {linear:e} {angular:e}"
    );
}

#[test]
fn morris_viscosity_keeps_linear_momentum() {
    let scene = free_drop::<2>(30).with(json!({
        "artificial_viscosity": null, "laminar_viscosity": {"kinematic": 1e-3, "form": "morris"},
    }));
    let (linear, _) = drift::<2>(&scene, Precision::F64, 1000);
    assert!(linear < 1e-12, "{linear:e}");
}

#[test]
fn a_flow_as_fast_as_sound_keeps_its_momentum() {
    // Particles cross a good part of a cell in a step: no pair may be seen from one side only.
    for (speed, what) in [
        (4.0, "a fifth"),
        (15.0, "three quarters"),
        (30.0, "one and a half"),
    ] {
        let mut scene = periodic_box::<2>(24).with(json!({"artificial_viscosity": {"alpha": 0.2}}));
        scene
            .fluid()
            .velocity
            .iter_mut()
            .skip(1)
            .step_by(2)
            .for_each(|v| *v = 0.0);
        scene.fluid().velocity.iter_mut().for_each(|v| *v *= speed);
        let mut simulation = scene.start(Precision::F64, 2);
        let before = simulation.diagnostics().momentum;
        let (scale, _) = scales(&simulation.body("fluid").unwrap(), 2);
        advance(&mut simulation, 15);
        let after = simulation.diagnostics().momentum;
        for a in 0..2 {
            let change = (after[a] - before[a]).abs() / scale;
            assert!(change < 1e-12, "{what} of the speed of sound: {change:e}");
        }
    }
}

#[test]
fn a_periodic_box_keeps_its_momentum() {
    for form in ["molteni", "antuono", "fourtakas"] {
        let scene = periodic_box::<2>(24).with(json!({
            "density_diffusion": {"form": form, "delta": 0.1},
            "artificial_viscosity": {"alpha": 0.1},
        }));
        let mut simulation = scene.start(Precision::F64, 2);
        let before = simulation.diagnostics().momentum;
        let (scale, _) = scales(&simulation.body("fluid").unwrap(), 2);
        advance(&mut simulation, 300);
        let after = simulation.diagnostics().momentum;
        for a in 0..2 {
            assert!(
                (after[a] - before[a]).abs() < 1e-12 * scale,
                "{form}: {before:?} {after:?}"
            );
        }
    }
}

/// Fluid given in another order, and moved as a whole, gives the same flow to rounding.
#[test]
fn neither_the_order_nor_the_place_of_the_particles_matters() {
    let scene =
        tank::<2>(20, 14).with(json!({"density_diffusion": {"form": "antuono", "delta": 0.1}}));
    let mut turned = scene.clone();
    let given = turned.fluid();
    let n = given.mass.len();
    let mut noise = Noise(11);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_cached_key(|_| (noise.number() * 1e9) as i64);
    let pick = |values: &[f64], d: usize| -> Vec<f64> {
        order
            .iter()
            .flat_map(|&i| values[d * i..d * (i + 1)].to_vec())
            .collect()
    };
    (given.position, given.velocity) = (pick(&given.position, 2), pick(&given.velocity, 2));
    (given.density, given.mass) = (pick(&given.density, 1), pick(&given.mass, 1));
    for body in &mut turned.bodies {
        body.particles
            .position
            .iter_mut()
            .for_each(|x| *x += 1000.0);
    }
    for (precision, bound) in [(Precision::F64, 1e-10), (Precision::Mixed, 3e-6)] {
        let end = |scene: &Scene| {
            let mut simulation = scene.start(precision, 2);
            advance(&mut simulation, 30);
            simulation.body("water").unwrap()
        };
        let (a, b) = (end(&scene), end(&turned));
        for (k, &i) in order.iter().enumerate() {
            for axis in 0..2 {
                let (x, y) = (a.position[2 * i + axis], b.position[2 * k + axis] - 1000.0);
                assert!(
                    (x - y).abs() < bound,
                    "{precision:?}: particle {i} at {x} or {y}"
                );
            }
        }
    }
}

#[test]
fn samples_and_forces_are_those_of_fluid_at_rest() {
    let depth = 0.3;
    let scene = tank::<2>(40, 30).with(json!({
        "density_diffusion": {"form": "antuono", "delta": 0.1}, "artificial_viscosity": {"alpha": 0.5},
    }));
    let mut simulation: Simulation = scene.start(Precision::F64, 2);
    let heights = [0.1, 0.1, 0.0];
    let points = [0.2, heights[0], 0.0, heights[1], 0.2, heights[2], 0.2, 5.0];
    // Sound rings for long: means over many of its periods of 4 H / c0 = 0.06 s.
    const SAMPLES: u32 = 120;
    let (mut lift, mut pressure) = (0.0, [0.0; 3]);
    for k in 0..SAMPLES {
        simulation
            .advance(0.3 + 0.003 * f64::from(k), u64::MAX, Duration::MAX)
            .unwrap();
        lift -= simulation.force_on("tank").unwrap().0[1] / f64::from(SAMPLES);
        let seen = simulation.sample(&points);
        assert_eq!((seen.pressure[3], seen.fill[3]), (0.0, 0.0));
        assert!(
            seen.fill[0] > 0.9 && seen.fill[1] > 0.4 && seen.fill[1] < 0.7,
            "{:?}",
            seen.fill
        );
        for (sum, seen) in pressure.iter_mut().zip(&seen.pressure) {
            *sum += seen / f64::from(SAMPLES);
        }
    }
    let weight = 9.81 * simulation.body("water").unwrap().mass.iter().sum::<f64>();
    assert!((lift / weight - 1.0).abs() < 0.03, "{lift} N of {weight} N");
    for (found, y) in pressure.into_iter().zip(heights) {
        // The start was out of order: the arrangement at a wall is worth some hundredths of the depth.
        let (hydrostatic, bound) = (1000.0 * 9.81 * (depth - y), 0.05 * 1000.0 * 9.81 * depth);
        assert!(
            (found - hydrostatic).abs() < bound,
            "{found} Pa at {y} m, not {hydrostatic}"
        );
    }
}
