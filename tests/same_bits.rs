//! The same bits: for any number of threads, over restart, and wherever a run is stopped.

mod common;

use common::{Scene, advance, assert_same_bits, free_drop, periodic_box, tank};
use kolk::simulation::{Entries, Precision};
use serde_json::json;
use std::time::Duration;

/// A tank that turns and is shaken, far enough to be sorted on the way.
fn rolling(dimension: usize) -> serde_json::Value {
    json!({"motion": [{"body": "tank", "parts": [
        {
            "path": {"kind": "rotate", "centre": vec![0.1; dimension]},
            "signal": {"kind": "table", "time": [0.0, 0.05, 0.1, 1.0], "value": [0.0, 0.1, 0.3, 1.0]},
        },
        {
            "path": {"kind": "translate", "direction": vec![0.1; dimension]},
            "signal": {"kind": "sinus", "amplitude": 0.2, "frequency": 4.0},
            "start": 0.01,
        },
    ]}]})
}

/// The scenes in which bits are compared: each with stages that the others lack.
fn scenes() -> Vec<(&'static str, Scene)> {
    let diffusion = |form: &str| json!({"density_diffusion": {"form": form, "delta": 0.1}});
    let shifting = |form: &str| json!({"shifting": {"form": form, "free_surface": true}});
    let no_slip = json!({"wall": {"method": "adami", "slip": "no"}, "laminar_viscosity": {"kinematic": 1e-5}});
    let damper = json!({"acoustic_damper": 0.3});
    let dynamic = json!({"wall": {"method": "dynamic", "slip": "free"}});
    vec![
        (
            "drop 2D",
            free_drop::<2>(90)
                .with(diffusion("antuono"))
                .with(shifting("sun")),
        ),
        ("drop 3D", free_drop::<3>(22).with(diffusion("molteni"))),
        (
            "tank 2D",
            tank::<2>(80, 60).with(diffusion("antuono")).with(no_slip),
        ),
        (
            "tank 3D",
            tank::<3>(14, 10)
                .with(diffusion("fourtakas"))
                .with(damper.clone()),
        ),
        (
            "dynamic tank 2D",
            tank::<2>(60, 40)
                .with(dynamic)
                .with(damper)
                .with(shifting("lind")),
        ),
        (
            "rolling tank 2D",
            tank::<2>(60, 40).with(rolling(2)).with(json!({
                "wall": {"method": "adami", "slip": "no"}, "laminar_viscosity": {"kinematic": 1e-5},
                "gravity_over_time": [{
                    "direction": [1.0, 0.2], "signal": {"kind": "sinus", "amplitude": 2.0, "frequency": 3.0},
                }],
            })),
        ),
        (
            "rolling tank 3D",
            tank::<3>(14, 10).with(rolling(3)).with(
                json!({"wall": {"method": "dynamic", "slip": "free"}}),
            ),
        ),
        (
            "periodic 2D",
            periodic_box::<2>(70)
                .with(diffusion("antuono"))
                .with(json!({"shifting": {"form": "sun", "every": 3}})),
        ),
        (
            "periodic 3D",
            periodic_box::<3>(16).with(diffusion("antuono")),
        ),
    ]
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for (name, scene) in scenes() {
        for precision in [Precision::F64, Precision::Mixed] {
            let end = |threads| {
                let mut simulation = scene.start(precision, threads);
                advance(&mut simulation, 25);
                simulation.save()
            };
            let one = end(1);
            for threads in [2, 3] {
                assert_same_bits(
                    &one,
                    &end(threads),
                    &format!("{name}, {precision:?}, {threads} threads"),
                );
            }
        }
    }
}

#[test]
fn a_run_resumed_at_any_step_gives_the_same_bits() {
    const STEPS: u64 = 15;
    for (name, scene) in scenes() {
        for precision in [Precision::F64, Precision::Mixed] {
            let mut whole = scene.start(precision, 2);
            // Long enough for re-sorts to fall among the steps compared.
            advance(&mut whole, 15);
            let saved: Vec<Entries> = (0..STEPS)
                .map(|_| {
                    let state = whole.save();
                    advance(&mut whole, 1);
                    state
                })
                .collect();
            let end = whole.save();
            for (step, state) in saved.iter().enumerate().step_by(5) {
                let mut resumed = scene.start(precision, 1);
                resumed.restore(state).unwrap();
                assert_same_bits(
                    state,
                    &resumed.save(),
                    &format!("{name}: restored and saved again"),
                );
                advance(&mut resumed, STEPS - step as u64);
                assert_same_bits(
                    &end,
                    &resumed.save(),
                    &format!("{name}, {precision:?}, from step {step}"),
                );
            }
            // A simulation that has been elsewhere forgets it.
            let mut used = scene.start(precision, 2);
            advance(&mut used, 37);
            used.restore(&saved[3]).unwrap();
            advance(&mut used, STEPS - 3);
            assert_same_bits(
                &end,
                &used.save(),
                &format!("{name}, {precision:?}, in a used simulation"),
            );
        }
    }
}

#[test]
fn stopping_between_steps_changes_nothing() {
    let scene = tank::<2>(30, 20);
    let (mut whole, mut halting) = (
        scene.start(Precision::F64, 2),
        scene.start(Precision::F64, 2),
    );
    whole.advance(0.01, u64::MAX, Duration::MAX).unwrap();
    while halting.advance(0.01, 1, Duration::MAX).unwrap().0 > 0 {}
    assert_same_bits(&whole.save(), &halting.save(), "one step at a time");
    assert_eq!(whole.status().time, 0.01);
}
