//! Every vector unit gives the same result to rounding. In a process of its own: the level is global.

mod common;

use common::{Scene, advance, by_id, free_drop, periodic_box, tank};
use kolk::kernel::KernelName;
use kolk::simd::{available_levels, force_level};
use kolk::simulation::{Entries, Precision};
use serde_json::json;
use std::time::Duration;

/// Rates of the given state, before any step.
fn rates(scene: &Scene, precision: Precision) -> Entries {
    let mut simulation = scene.start(precision, 2);
    simulation.advance(1.0, 0, Duration::MAX).unwrap();
    simulation.save()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

fn assert_close(a: &Entries, b: &Entries, name: &str, bound: f64, what: &str) {
    let (a, b) = (by_id(a, name), by_id(b, name));
    let difference = largest(&a.iter().zip(&b).map(|(a, b)| a - b).collect::<Vec<_>>());
    assert!(
        difference <= bound * largest(&a),
        "{what}: {name} differs by {difference:e} of {:e}",
        largest(&a)
    );
}

#[test]
fn levels_agree() {
    let levels = available_levels();
    let effects = |form: &str| {
        json!({
            "density_diffusion": {"form": form, "delta": 0.1},
            "artificial_viscosity": {"alpha": 0.1, "beta": 0.2},
            "laminar_viscosity": {"kinematic": 1e-4},
            "shifting": {"form": "sun", "free_surface": true},
        })
    };
    let no_slip = json!({"wall": {"method": "adami", "slip": "no"}});
    let mut scenes = vec![
        ("drop 3D", free_drop::<3>(14).with(effects("molteni"))),
        (
            "tank 2D",
            tank::<2>(30, 24).with(effects("antuono")).with(no_slip),
        ),
        ("tank 3D", tank::<3>(10, 8).with(effects("fourtakas"))),
        (
            "periodic 2D",
            periodic_box::<2>(25).with(effects("antuono")),
        ),
    ];
    for kernel in KernelName::ALL {
        scenes.push((
            kernel.as_str(),
            tank::<2>(16, 12).with(json!({"kernel": kernel.as_str()})),
        ));
    }
    for (name, scene) in &scenes {
        for (precision, at_once, later) in [
            (Precision::F64, 1e-12, 1e-9),
            (Precision::Mixed, 3e-5, 1e-3),
        ] {
            let run = |level| {
                force_level(level);
                let mut simulation = scene.start(precision, 2);
                advance(&mut simulation, 20);
                (rates(scene, precision), simulation.save())
            };
            let (first, end) = run(levels[0]);
            for &level in &levels[1..] {
                let (other, other_end) = run(level);
                let what = format!("{name}, {precision:?}, {}", level.name());
                assert_close(&first, &other, "acceleration_0", at_once, &what);
                assert_close(&first, &other, "density_rate", at_once, &what);
                assert_close(&end, &other_end, "velocity_0", later, &what);
                assert_close(&end, &other_end, "position_1", later, &what);
            }
        }
    }
}

#[test]
fn mixed_precision_is_double_precision_to_single_rounding() {
    for (name, scene) in [("tank", tank::<2>(30, 24)), ("drop", free_drop::<2>(40))] {
        let (double, mixed) = (
            rates(&scene, Precision::F64),
            rates(&scene, Precision::Mixed),
        );
        for column in [
            "acceleration_0",
            "acceleration_1",
            "density_rate",
            "pressure",
        ] {
            assert_close(&double, &mixed, column, 1e-4, name);
        }
    }
}
