//! The integrators in flows: order, stability, conservation, and that nothing is paid for those that are not asked for.

mod common;

use common::{
    Noise, Scene, advance, assert_same_bits, body, free_drop, lattice, periodic_box, tank, tank_of,
};
use kolk::error::Error;
use kolk::simulation::{Precision, Simulation};
use kolk::step::Integrator;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::time::Duration;

const IN_STAGES: [Integrator; 3] = [
    Integrator::PredictorCorrector,
    Integrator::RungeKutta2,
    Integrator::RungeKutta4,
];

fn named(integrator: Integrator) -> Value {
    json!({"integrator": integrator.name()})
}

/// A Taylor-Green flow on a lattice, with forces as smooth as a kernel makes them.
fn vortices() -> Scene {
    const ACROSS: usize = 16;
    let spacing = 1.0 / ACROSS as f64;
    let position = lattice([0.0; 2], [ACROSS; 2], spacing, 0.0);
    let velocity = |x: &[f64; 2]| {
        let (s, c) = (x.map(|x| (TAU * x).sin()), x.map(|x| (TAU * x).cos()));
        [-c[0] * s[1], s[0] * c[1]]
    };
    let density = |x: &[f64; 2]| 1000.0 + 2.0 * (TAU * x[0]).cos();
    let fluid = body("fluid", true, spacing, &position, velocity, density);
    Scene {
        config: periodic_box::<2>(ACROSS).config,
        bodies: vec![fluid],
    }
    .with(json!({
        "kernel": "wendland-c6", "smoothing_length": 2.2 * spacing, "guard": false,
        "laminar_viscosity": {"kinematic": 0.01},
    }))
}

/// The state after `steps` equal steps over `time`: positions, velocities and condensations times the sound speed.
fn end(scene: &Scene, integrator: Integrator, time: f64, steps: u32) -> Vec<f64> {
    let step = json!({"time_step": time / f64::from(steps)});
    let scene = scene.clone().with(named(integrator)).with(step);
    let mut simulation = scene.start(Precision::F64, 2);
    advance(&mut simulation, u64::from(steps));
    let state = simulation.body("fluid").unwrap();
    let condensation = state.density.iter().map(|d| 20.0 * (d / 1000.0 - 1.0));
    // Wherever a period has put them.
    let position = state.position.iter().map(|x| (TAU * x).sin());
    position.chain(state.velocity).chain(condensation).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (square / a.len() as f64).sqrt()
}

#[test]
fn of_a_smooth_flow_each_has_its_order_and_all_have_one_limit() {
    let scene = vortices();
    let time = 0.1;
    let exact = end(&scene, Integrator::RungeKutta4, time, 640);
    for (integrator, order) in Integrator::ALL.into_iter().zip([2.0, 2.0, 2.0, 4.0]) {
        let errors: Vec<f64> = [40, 80, 160]
            .into_iter()
            .map(|steps| distance(&end(&scene, integrator, time, steps), &exact))
            .collect();
        let observed: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
        assert!(
            observed.iter().all(|o| (o - order).abs() < 0.25),
            "{integrator:?}: {errors:?} {observed:?}"
        );
    }
}

/// Noise of velocity on a periodic lattice with the default density diffusion.
fn noise_on_a_lattice() -> Scene {
    const ACROSS: usize = 20;
    let spacing = 1.0 / ACROSS as f64;
    let position = lattice([0.0; 2], [ACROSS; 2], spacing, 0.0);
    let mut fluid = body("fluid", true, spacing, &position, |_| [0.0; 2], |_| 1000.0);
    let mut noise = Noise(3);
    for v in &mut fluid.particles.velocity {
        *v = 1e-6 * noise.number();
    }
    Scene {
        config: periodic_box::<2>(ACROSS).config,
        bodies: vec![fluid],
    }
    .with(json!({
        "smoothing_length": 2.0 * spacing, "guard": false, "background_pressure": 0.0,
        "density_diffusion": {"form": "antuono", "delta": 0.1},
    }))
}

/// By what the energy of sound grows: over the second half of a run, or over the whole of it. Growth without end comes to a
/// halt where particles begin to collide, far above where it began.
fn growth_of_energy(scene: &Scene) -> f64 {
    let mut simulation = scene.start(Precision::F64, 2);
    let energy = |simulation: &Simulation| {
        let seen = simulation.diagnostics();
        seen.kinetic_energy + seen.compression_energy
    };
    let mut energies = [energy(&simulation), 0.0, 0.0];
    for k in 1..3 {
        // Or it is stopped by the check of density.
        if simulation.advance(1e9, 500, Duration::MAX).is_err() {
            return f64::INFINITY;
        }
        energies[k] = energy(&simulation);
    }
    (energies[2] / energies[1]).max(energies[2] / energies[0])
}

#[test]
fn the_stability_limit_of_each_is_the_one_it_says_and_its_courant_number_is_well_below() {
    for integrator in Integrator::ALL {
        let limit = integrator.stability_limit();
        let changes = |courant: f64| {
            let plain = noise_on_a_lattice()
                .with(named(integrator))
                .with(json!({"courant": courant}));
            let damped = plain.clone().with(json!({"acoustic_damper": 0.3}));
            let molteni = json!({"density_diffusion": {"form": "molteni", "delta": 0.1}});
            [&plain, &damped, &plain.clone().with(molteni)].map(growth_of_energy)
        };
        let below = changes(0.93 * limit);
        assert!(below.iter().all(|c| *c < 1.0), "{integrator:?}: {below:?}");
        let above = changes(1.1 * limit);
        assert!(above.iter().any(|c| *c > 1.0), "{integrator:?}: {above:?}");
        let share = integrator.courant() / limit;
        assert!((0.35..=0.4).contains(&share), "{integrator:?}: {share}");
    }
}

#[test]
fn a_scene_without_a_courant_number_gets_that_of_its_integrator() {
    let mut steps = Integrator::ALL.map(|integrator| {
        let scene = noise_on_a_lattice().with(named(integrator));
        let mut simulation = scene.start(Precision::F64, 1);
        advance(&mut simulation, 1);
        simulation.status().time_step / integrator.courant()
    });
    steps.sort_by(f64::total_cmp);
    assert!((steps[3] / steps[0] - 1.0).abs() < 1e-6, "{steps:?}");
}

/// Everything that the default numerics switch on.
fn with_defaults(scene: Scene, smoothing_length: f64) -> Scene {
    scene.with(json!({
        "smoothing_length": smoothing_length,
        "density_diffusion": {"form": "antuono", "delta": 0.1},
        "shifting": {"form": "sun", "free_surface": true},
        "acoustic_damper": 0.3,
    }))
}

#[test]
fn a_free_drop_keeps_its_momentum() {
    for integrator in Integrator::ALL {
        let scene = with_defaults(free_drop::<2>(24), 2.0 / 24.0).with(named(integrator));
        let mut simulation = scene.start(Precision::F64, 2);
        let before = simulation.diagnostics().momentum;
        let drop = simulation.body("drop").unwrap();
        let scale: f64 = drop
            .velocity
            .chunks_exact(2)
            .zip(&drop.mass)
            .map(|(u, m)| m * u[0].hypot(u[1]))
            .sum();
        advance(&mut simulation, 500);
        let after = simulation.diagnostics().momentum;
        let drift = (after[0] - before[0]).hypot(after[1] - before[1]) / scale;
        assert!(drift < 1e-12, "{integrator:?}: {drift:e}");
    }
}

#[test]
fn a_flow_that_is_carried_along_is_the_same_flow() {
    // Over a whole period, so that particles are sorted and wrapped between the stages of a step.
    for integrator in Integrator::ALL {
        let flow = |carried: f64| {
            let mut scene = vortices().with(named(integrator));
            for u in scene.fluid().velocity.chunks_exact_mut(2) {
                u[0] += carried;
            }
            let scene = scene.with(json!({"time_step": 0.002}));
            let mut simulation = scene.start(Precision::F64, 2);
            advance(&mut simulation, 125);
            let sorts = simulation
                .timings()
                .iter()
                .find(|t| t.0 == "sort")
                .unwrap()
                .2;
            (simulation.body("fluid").unwrap(), sorts)
        };
        let (at_rest, _) = flow(0.0);
        // A quarter of a second at 4 m/s: one period.
        let (carried, sorts) = flow(4.0);
        assert!(sorts >= 125, "{integrator:?}: {sorts} sorts");
        for (a, b) in at_rest.position.iter().zip(&carried.position) {
            let apart = ((a - b + 0.5).rem_euclid(1.0) - 0.5).abs();
            assert!(apart < 1e-9, "{integrator:?}: {apart:e}");
        }
        for (k, (a, b)) in at_rest.velocity.iter().zip(&carried.velocity).enumerate() {
            let apart = (a + if k % 2 == 0 { 4.0 } else { 0.0 } - b).abs();
            assert!(apart < 1e-8, "{integrator:?}: {apart:e}");
        }
    }
}

#[test]
fn still_water_stays_still() {
    for integrator in Integrator::ALL {
        for precision in [Precision::F64, Precision::Mixed] {
            let mut scene = with_defaults(tank::<2>(20, 14), 0.02).with(named(integrator));
            scene.fluid().velocity.fill(0.0);
            let mut simulation = scene.start(precision, 2);
            simulation.advance(0.4, u64::MAX, Duration::MAX).unwrap();
            let seen = simulation.diagnostics();
            let weight: f64 = simulation.body("water").unwrap().mass.iter().sum::<f64>() * 9.81;
            let moving = seen.kinetic_energy / (weight * 0.14);
            assert!(moving < 1e-4, "{integrator:?}, {precision:?}: {moving:e}");
            let low = seen.density_min / 1000.0 - 1.0;
            assert!(low > -1e-3, "{integrator:?}, {precision:?}: {low:e}");
            let retries: u64 = simulation.status().retries.retries.iter().sum();
            assert_eq!(retries, 0, "{integrator:?}, {precision:?}");
        }
    }
}

#[test]
fn a_dam_breaks_and_loses_energy() {
    let mut default = None;
    for integrator in Integrator::ALL {
        for precision in [Precision::F64, Precision::Mixed] {
            let mut scene =
                with_defaults(tank_of::<2>(40, 20, 0.01, 0.0), 0.02).with(named(integrator));
            let fluid = scene.fluid();
            // What stands left of x = 0.1 is the column; c0 = 20 m/s is ten times the speed of its front.
            let column: Vec<usize> = (0..fluid.mass.len())
                .filter(|&i| fluid.position[2 * i] < 0.1)
                .collect();
            fluid.position = column
                .iter()
                .flat_map(|&i| [fluid.position[2 * i], fluid.position[2 * i + 1]])
                .collect();
            fluid.velocity = vec![0.0; 2 * column.len()];
            fluid.density = column.iter().map(|&i| fluid.density[i]).collect();
            fluid.mass = column.iter().map(|&i| fluid.mass[i]).collect();
            let mut simulation = scene.start(precision, 2);
            let energy = |simulation: &Simulation| {
                let seen = simulation.diagnostics();
                seen.kinetic_energy + seen.potential_energy + seen.compression_energy
            };
            let before = energy(&simulation);
            // On the dry bed every front goes alike; then it strikes the other wall, and runs up on it.
            simulation.advance(0.2, u64::MAX, Duration::MAX).unwrap();
            let water = simulation.body("water").unwrap();
            let front = water
                .position
                .iter()
                .step_by(2)
                .copied()
                .fold(0.0, f64::max);
            let ahead = front - *default.get_or_insert(front);
            assert!(ahead.abs() < 0.01, "{integrator:?}, {precision:?}: {ahead}");
            simulation.advance(0.4, u64::MAX, Duration::MAX).unwrap();
            let seen = simulation.diagnostics();
            let what = format!("{integrator:?}, {precision:?}: {seen:?}");
            assert!(energy(&simulation) < before, "{what}");
            assert!(
                seen.density_min > 950.0 && seen.density_max < 1050.0,
                "{what}"
            );
        }
    }
}

/// Scenes with all that stages have to keep: walls that move, walls with a density, shifts, periods.
fn involved() -> Vec<Scene> {
    let rolling = json!({
        "motion": [{"body": "tank", "parts": [{
            "path": {"kind": "translate", "direction": [0.1, 0.1]},
            "signal": {"kind": "sinus", "amplitude": 0.2, "frequency": 4.0},
        }]}],
        "gravity_over_time": [{
            "direction": [1.0, 0.2], "signal": {"kind": "sinus", "amplitude": 2.0, "frequency": 3.0},
        }],
    });
    let walls = |method: &str| json!({"wall": {"method": method, "slip": "no"}, "laminar_viscosity": {"kinematic": 1e-4}});
    let yielding =
        json!({"herschel_bulkley": {"yield_stress": 1.0, "consistency": 0.1, "index": 0.8}});
    vec![
        with_defaults(tank::<2>(80, 60), 0.02)
            .with(rolling.clone())
            .with(walls("adami")),
        tank::<2>(40, 20)
            .with(rolling)
            .with(walls("dynamic"))
            .with(yielding),
        with_defaults(periodic_box::<2>(70), 1.5 / 70.0),
        with_defaults(tank::<3>(10, 8), 0.017),
    ]
}

#[test]
fn the_same_bits_for_any_number_of_threads_and_over_restart() {
    for integrator in IN_STAGES {
        for (k, scene) in involved().into_iter().enumerate() {
            let scene = scene.with(named(integrator));
            let precision = [Precision::F64, Precision::Mixed][k % 2];
            let what = format!("{integrator:?}, scene {k}");
            let mut one = scene.start(precision, 1);
            advance(&mut one, 9);
            let middle = one.save();
            advance(&mut one, 9);
            let end = one.save();
            for threads in [2, 3] {
                let mut other = scene.start(precision, threads);
                advance(&mut other, 18);
                assert_same_bits(&end, &other.save(), &format!("{what}, {threads} threads"));
            }
            let mut resumed = scene.start(precision, 2);
            advance(&mut resumed, 3);
            resumed.restore(&middle).unwrap();
            advance(&mut resumed, 9);
            assert_same_bits(&end, &resumed.save(), &format!("{what}, resumed"));
        }
    }
}

#[test]
fn the_guard_mends_what_a_shorter_step_mends() {
    for integrator in IN_STAGES {
        let courant = 3.0 * integrator.stability_limit();
        let scene = with_defaults(tank::<2>(20, 14), 0.02)
            .with(named(integrator))
            .with(json!({"courant": courant}));
        let mut simulation = scene.start(Precision::Mixed, 1);
        simulation.advance(0.2, 5000, Duration::MAX).unwrap();
        let status = simulation.status();
        assert!((status.time - 0.2).abs() < 1e-12, "{integrator:?}");
        assert!(status.retries.undone > 0, "{integrator:?}");
        assert!(simulation.diagnostics().speed_max < 0.5, "{integrator:?}");
    }
}

#[test]
fn what_is_not_finite_stops_the_run_and_is_not_spread() {
    for integrator in IN_STAGES {
        // One particle flies off so fast that its next place is none.
        let mut scene = tank::<2>(20, 14)
            .with(named(integrator))
            .with(json!({"guard": false, "time_step": 1e200}));
        scene.fluid().velocity[0] = 1e150;
        let mut simulation = scene.start(Precision::F64, 1);
        let error = simulation.advance(1e201, 10, Duration::MAX).unwrap_err();
        let Error::Instability(what) = error else {
            panic!("{integrator:?}: {error}");
        };
        assert_eq!(
            (what.particle, what.quantity),
            (0, "position"),
            "{integrator:?}"
        );
        let position = simulation.body("water").unwrap().position;
        let lost = position.iter().filter(|x| !x.is_finite()).count();
        assert_eq!(lost, 1, "{integrator:?}");
    }
}

#[test]
fn only_those_of_several_stages_have_columns_of_their_own() {
    let bytes = |scene: Scene| {
        let simulation = scene.start(Precision::Mixed, 1);
        let memory = simulation.memory();
        memory
            .iter()
            .find(|(name, _)| *name == "integrator")
            .map(|(_, bytes)| *bytes)
    };
    let scene = || tank::<3>(10, 8);
    assert_eq!(bytes(scene()), None);
    for integrator in Integrator::ALL {
        let expected = integrator.columns() * 7 * 8 * 800;
        let found = bytes(scene().with(named(integrator)));
        let padding = integrator.columns() * 7 * 8 * kolk::particles::PAD;
        assert_eq!(found.unwrap_or(0), expected + padding, "{integrator:?}");
    }
}
