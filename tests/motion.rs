//! What is prescribed over time: signals, rigid motions, moving walls, gravity.

mod common;

use common::{advance, body, by_id, lattice, tank};
use kolk::prescribed::{MotionConfig, Path, Signal, SignalConfig, Spline};
use kolk::simulation::Precision;
use serde_json::json;
use std::time::Duration;

fn close(found: f64, wanted: f64, within: f64, what: &str) {
    assert!(
        (found - wanted).abs() <= within,
        "{what}: found {found}, wanted {wanted}"
    );
}

#[test]
fn a_table_of_a_cubic_is_met_exactly_between_its_points() {
    let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t + 3.0 * t * t * t;
    let slope = |t: f64| -2.0 + t + 9.0 * t * t;
    let time = vec![-0.3, 0.0, 0.4, 0.5, 1.1, 1.7];
    let spline = Spline::new(time.clone(), time.iter().map(|&t| cubic(t)).collect());
    for k in 0..=200 {
        let t = -0.3 + 0.01 * f64::from(k);
        let [value, rate, second] = spline.at(t);
        close(value, cubic(t), 1e-12, "value");
        close(rate, slope(t), 1e-11, "slope");
        close(second, 1.0 + 18.0 * t, 1e-10, "curvature");
    }
    assert_eq!(
        spline.at(2.0),
        [cubic(1.7), 0.0, 0.0],
        "beyond its end it stands still"
    );
}

#[test]
fn short_tables_and_straight_ones_are_met_exactly() {
    let parabola = |t: f64| 2.0 + t - 4.0 * t * t;
    let time = vec![0.0, 0.3, 1.0];
    let three = Spline::new(time.clone(), time.iter().map(|&t| parabola(t)).collect());
    let two = Spline::new(vec![0.0, 2.0], vec![1.0, 5.0]);
    let straight = Spline::straight(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, -2.0]);
    for k in 0..=100 {
        let t = 0.01 * f64::from(k);
        close(three.at(t)[0], parabola(t), 1e-13, "parabola");
        close(two.at(t)[0], 1.0 + 2.0 * t, 1e-14, "two points");
        close(straight.at(t)[0], 2.0 * t, 1e-14, "first line");
        close(
            straight.at(1.0 + 2.0 * t)[0],
            2.0 - 4.0 * t,
            1e-13,
            "second line",
        );
    }
}

#[test]
fn tables_that_cannot_be_are_named() {
    let table = |time: Vec<f64>, value: Vec<f64>| {
        let config = SignalConfig::Table {
            time,
            value,
            interpolation: Default::default(),
        };
        config.build("motion.gate").unwrap_err().to_string()
    };
    assert!(table(vec![0.0], vec![0.0]).contains("1 times and 1 values"));
    assert!(table(vec![0.0, 0.0], vec![0.0, 1.0]).contains("ascending"));
    assert!(table(vec![0.0, 1.0], vec![0.0, f64::NAN]).contains("motion.gate: found NaN"));
}

/// A motion of two rotations and two translations, some of them for a while only.
fn involved() -> MotionConfig {
    serde_json::from_value(json!({"body": "gear", "parts": [
        {"path": {"kind": "translate", "direction": [0.3, -0.2, 0.1]},
         "signal": {"kind": "sinus", "amplitude": 1.0, "frequency": 0.7, "phase": 0.4}},
        {"path": {"kind": "rotate", "centre": [0.1, 0.2, -0.3], "axis": [1.0, 2.0, -1.0]},
         "signal": {"kind": "sinus", "amplitude": 0.8, "frequency": 0.5}},
        {"path": {"kind": "rotate", "centre": [1.0, 0.0, 0.0], "axis": [0.0, 0.0, 2.0]},
         "signal": {"kind": "rate", "rate": 1.3}, "start": 0.2, "end": 2.5},
        {"path": {"kind": "translate", "direction": [0.0, 0.0, 2.0]},
         "signal": {"kind": "table", "time": [0.0, 0.5, 1.0, 3.0], "value": [0.3, 0.4, 0.9, 1.0]}},
    ]}))
    .expect("a motion")
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_the_position() {
    let motion = involved().build(3).expect("a motion");
    let start = [0.4, -0.7, 0.9];
    let at = |t: f64| motion.at(t).of(&start)[0];
    assert_eq!(at(0.0), start, "it starts where the scene puts it");
    let step = 1e-4;
    for t in [0.1, 0.3, 1.0, 1.7, 2.4, 2.9] {
        let [x, v, a] = motion.at(t).of(&start);
        let (before, after) = (at(t - step), at(t + step));
        for k in 0..3 {
            close(
                (after[k] - before[k]) / (2.0 * step),
                v[k],
                1e-6,
                "velocity",
            );
            let second = (after[k] - 2.0 * x[k] + before[k]) / (step * step);
            close(second, a[k], 1e-5, "acceleration");
        }
    }
}

#[test]
fn rigid_motion_keeps_distances_and_turns_once_in_its_period() {
    let motion = involved().build(3).expect("a motion");
    let (a, b) = ([0.4, -0.7, 0.9], [-0.2, 0.1, 0.3]);
    let distance =
        |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
    for k in 0..30 {
        let pose = motion.at(0.1 * f64::from(k));
        close(
            distance(pose.of(&a)[0], pose.of(&b)[0]),
            distance(a, b),
            1e-14,
            "distance",
        );
    }
    let wheel: MotionConfig = serde_json::from_value(json!({"body": "wheel", "parts": [
        {"path": {"kind": "rotate", "centre": [1.0, 0.5]}, "signal": {"kind": "rate", "rate": 2.0}},
    ]}))
    .expect("a motion");
    let wheel = wheel.build(2).expect("a motion");
    let [x, v, a] = wheel.at(std::f64::consts::FRAC_PI_4).of(&[1.2, 0.5]);
    // A quarter turn, counter-clockwise.
    for (found, wanted) in [(x, [1.0, 0.7]), (v, [-0.4, 0.0]), (a, [0.0, -0.8])] {
        close(found[0], wanted[0], 1e-14, "x");
        close(found[1], wanted[1], 1e-14, "y");
    }
}

#[test]
fn motions_that_cannot_be_are_named() {
    let wrong = |path: serde_json::Value| {
        let motion: MotionConfig = serde_json::from_value(json!({"body": "gate", "parts": [
            {"path": path, "signal": {"kind": "rate", "rate": 1.0}, "start": 1.0},
        ]}))
        .expect("a motion");
        motion.build(2).unwrap_err().to_string()
    };
    assert!(
        wrong(json!({"kind": "translate", "direction": [1.0]})).contains("motion.gate.direction")
    );
    let tilted = json!({"kind": "rotate", "centre": [0.0, 0.0], "axis": [1.0, 0.0, 0.0]});
    assert!(wrong(tilted).contains("along z in 2D"));
    let scene = tank::<2>(10, 10).with(json!({"motion": [{"body": "water", "parts": []}]}));
    let message = kolk::simulation::Simulation::new(
        scene.configuration(),
        scene.bodies.clone(),
        Precision::F64,
        1,
    )
    .err()
    .expect("a fluid has no motion")
    .to_string();
    assert!(message.contains("names of walls"), "{message}");
    let path = Path::Rotate {
        centre: vec![0.0; 2],
        axis: None,
    };
    assert_ne!(
        path,
        Path::Translate {
            direction: vec![0.0; 2]
        }
    );
    assert_eq!(Signal::Rate(2.0).at(3.0), [6.0, 2.0, 0.0]);
}

#[test]
fn an_accelerated_tank_is_a_tank_under_more_gravity() {
    // By the principle of equivalence the flow in a tank with the acceleration a is that of a tank at rest under g - a.
    let a = [3.0, 2.0];
    let scene =
        tank::<2>(30, 20).with(json!({"density_diffusion": {"form": "antuono", "delta": 0.1}}));
    let square = |a: f64| {
        json!({"path": {"kind": "translate", "direction": [f64::from(u8::from(a == 3.0)), f64::from(u8::from(a == 2.0))]},
               "signal": {"kind": "table", "time": [0.0, 0.5, 1.0], "value": [0.0, 0.125 * a, 0.5 * a]}})
    };
    let moving = scene.clone().with(json!({
        "motion": [{"body": "tank", "parts": [square(a[0]), square(a[1])]}], "time_step": 2e-4,
    }));
    let still = scene.with(json!({"gravity": [-a[0], -9.81 - a[1]], "time_step": 2e-4}));
    let mut moving = moving.start(Precision::F64, 1);
    let mut still = still.start(Precision::F64, 1);
    for simulation in [&mut moving, &mut still] {
        advance(simulation, 400);
    }
    let t = moving.status().time;
    let (x, y) = (
        moving.body("water").expect("water"),
        still.body("water").expect("water"),
    );
    let (mut moved, mut worst) = (0.0f64, 0.0f64);
    let first = tank::<2>(30, 20).bodies[0].particles.position.clone();
    for k in 0..x.position.len() {
        let relative = x.position[k] - 0.5 * a[k % 2] * t * t;
        worst = worst.max((relative - y.position[k]).abs());
        moved = moved.max((y.position[k] - first[k]).abs());
    }
    // The drift of the step's splitting, a Δt²/8, is far below; what is left is that of rounding in disorder.
    assert!(moved > 5e-3 && worst < 1e-3 * moved, "{worst} of {moved}");
    let (force, _) = moving.force_on("tank").expect("a wall");
    let (expected, _) = still.force_on("tank").expect("a wall");
    for k in 0..2 {
        close(
            force[k],
            expected[k],
            0.01 * expected[1].abs(),
            "force on the tank",
        );
    }
}

#[test]
fn what_walls_feel_is_what_they_do_to_the_fluid() {
    // Pressure, contact and friction of a tank that shears its fluid, against the fluid's own momentum.
    for form in ["morris", "monaghan-gingold"] {
        let scene = tank::<2>(30, 20).with(json!({
            "artificial_viscosity": null, "gravity": null, "time_step": 1e-5,
            "laminar_viscosity": {"kinematic": 1e-3, "form": form},
            "wall": {"method": "adami", "slip": "no"},
            "motion": [{"body": "tank", "parts": [{
                "path": {"kind": "translate", "direction": [1.0, 0.0]}, "signal": {"kind": "rate", "rate": 0.5},
            }]}],
        }));
        let mut simulation = scene.start(Precision::F64, 1);
        advance(&mut simulation, 20);
        let before = simulation.diagnostics();
        advance(&mut simulation, 1);
        let after = simulation.diagnostics();
        let (force, moment) = simulation.force_on("tank").expect("a wall");
        let dt = after.time - before.time;
        for k in 0..2 {
            let rate = (after.momentum[k] - before.momentum[k]) / dt;
            close(-force[k], rate, 2e-3 * rate.abs().max(1.0), form);
        }
        let torque = (after.angular_momentum[0] - before.angular_momentum[0]) / dt;
        close(-moment[0], torque, 1e-2 * torque.abs().max(0.1), form);
    }
}

#[test]
fn a_particle_alone_falls_exactly_under_changing_gravity() {
    let spacing = 0.01;
    let alone = body(
        "drop",
        true,
        spacing,
        &lattice([0.0; 2], [1, 1], spacing, 0.0),
        |_| [0.0; 2],
        |_| 1000.0,
    );
    let mut scene = tank::<2>(4, 4);
    scene.bodies = vec![alone];
    // g = (0.5 t, -9.81 + 3 t): linear, so that the middle of a step has its mean.
    let scene = scene.with(json!({"gravity_over_time": [
        {"direction": [0.5, 3.0], "signal": {"kind": "rate", "rate": 1.0}},
    ], "time_step": 1e-3}));
    let mut simulation = scene.start(Precision::F64, 1);
    simulation
        .advance(0.5, u64::MAX, Duration::MAX)
        .expect("a fall");
    let t = 0.5;
    let entries = simulation.save();
    let wanted = [
        (0.25 * t * t, t * t * t / 12.0),
        (-9.81 * t + 1.5 * t * t, -4.905 * t * t + 0.5 * t * t * t),
    ];
    for (a, (speed, way)) in wanted.into_iter().enumerate() {
        close(
            by_id(&entries, &format!("velocity_{a}"))[0],
            speed,
            1e-12,
            "velocity",
        );
        let fallen = by_id(&entries, &format!("position_{a}"))[0] - 0.5 * spacing;
        // Half drifts with the velocities at the ends of a step: Δt² t dg/dt / 12.
        close(fallen, way, 1e-6 * t, "position");
    }
}

#[test]
fn a_motion_of_nothing_changes_no_bit() {
    let rest = json!({"motion": [{"body": "tank", "parts": [
        {"path": {"kind": "translate", "direction": [1.0, 0.0]}, "signal": {"kind": "rate", "rate": 0.0}},
    ]}]});
    let (mut with, mut without) = (
        tank::<2>(20, 15).with(rest).start(Precision::Mixed, 2),
        tank::<2>(20, 15).start(Precision::Mixed, 2),
    );
    for simulation in [&mut with, &mut without] {
        advance(simulation, 60);
    }
    let (a, b) = (
        with.body("water").expect("water"),
        without.body("water").expect("water"),
    );
    assert_eq!(a.position, b.position);
    assert_eq!(a.density, b.density);
}
