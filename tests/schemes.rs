//! Remedies against tensile instability, and the Riemann form: against their formulae, and what they keep.

mod common;

use common::disorder::{C0, Case, RHO, SPACING, assert_close, dot, rates, wavy};
use common::{Noise, Scene, body, by_id, lattice, periodic_box, tank};
use kolk::kernel::KernelName;
use kolk::operators::{free_surface, gradient};
use kolk::simulation::Precision;
use serde_json::{Value, json};

/// What is taken off a tension.
const TAKEN: f64 = 2.04;

fn remedy(form: &str, free_surface: bool) -> Value {
    json!({"tensile_control": {"form": form, "free_surface": free_surface}})
}

/// Pressure minus what is taken off its sum, by the operators.
fn differences_of_pressure<const D: usize>(surface: bool) {
    let case = Case::<D>::new(KernelName::WendlandC2, wavy, false, remedy("sun", surface));
    let (cloud, pressure) = (case.cloud(), case.pressure());
    let eigenvalue = free_surface(&cloud).eigenvalue;
    let mut wanted = case.pressure_acceleration();
    let mut relieved = 0;
    for (i, sum) in wanted.iter_mut().enumerate() {
        if pressure[i] >= 0.0 || surface && eigenvalue[i] < 0.75 {
            continue;
        }
        relieved += 1;
        cloud.for_each_neighbour(i, |j, d, _, slope| {
            for a in 0..D {
                sum[a] += TAKEN * pressure[i] * cloud.volume[j] * slope * d[a] / case.density[i];
            }
        });
    }
    assert!(relieved > cloud.len() / 20, "{relieved}");
    case.assert_acceleration(&wanted, &format!("tensile control, {D}D"));
}

#[test]
fn tensile_control_takes_differences_of_negative_pressures() {
    for surface in [false, true] {
        differences_of_pressure::<2>(surface);
        differences_of_pressure::<3>(surface);
    }
}

fn stress<const D: usize>() {
    let kernel = KernelName::WendlandC2;
    let case = Case::<D>::new(kernel, wavy, true, remedy("monaghan", true));
    let p = case.pressure();
    let at_spacing = kernel.value(D, SPACING, case.h);
    let wanted = case.viscous_acceleration(|_, i, j, d, r, slope| {
        let mut stress = 0.2 * (-p[i]).max(0.0) + 0.2 * (-p[j]).max(0.0);
        if p[i] > 0.0 && p[j] > 0.0 {
            stress += 0.01 * (p[i] + p[j]);
        }
        let nearness = (kernel.value(D, r, case.h) / at_spacing).powi(4);
        d.map(|d| -stress * nearness * slope * d)
    });
    case.assert_acceleration(&wanted, &format!("artificial stress, {D}D"));
}

#[test]
fn artificial_stress_is_that_of_monaghan() {
    stress::<2>();
    stress::<3>();
}

fn riemann<const D: usize>() {
    let case = Case::<D>::new(
        KernelName::WendlandC2,
        wavy,
        true,
        json!({"riemann_viscosity": true}),
    );
    let wanted = case.viscous_acceleration(|_, i, j, d, r, slope| {
        let approach = (-dot(&case.relative_velocity(i, j), &d) / r).max(0.0);
        let limiter = (3.0 * approach / C0).min(1.0);
        d.map(|d| -RHO * C0 * limiter * approach * slope * d)
    });
    case.assert_acceleration(&wanted, &format!("Riemann dissipation, {D}D"));
}

#[test]
fn particles_meet_as_in_a_riemann_problem() {
    riemann::<2>();
    riemann::<3>();
}

fn riemann_diffusion<const D: usize>() {
    let case = Case::<D>::new(
        KernelName::WendlandC2,
        wavy,
        false,
        json!({"density_diffusion": {"form": "riemann", "delta": 0.7}}),
    );
    let cloud = case.cloud();
    let slopes = gradient(&cloud, &case.density, 1, true);
    let slopes = slopes.as_chunks::<D>().0;
    let wanted: Vec<f64> = (0..cloud.len())
        .map(|i| {
            let mut rate = 0.0;
            cloud.for_each_neighbour(i, |j, d, r, slope| {
                let mean: [f64; D] = std::array::from_fn(|a| 0.5 * (slopes[i][a] + slopes[j][a]));
                let excess = case.density[j] - case.density[i] + dot(&mean, &d);
                rate -= cloud.volume[j] * 0.7 * C0 * r * slope * excess;
            });
            rate
        })
        .collect();
    assert_close(
        &by_id(&case.rates, "density_rate"),
        &wanted,
        "Riemann diffusion",
    );
}

#[test]
fn density_flows_as_in_a_riemann_problem() {
    riemann_diffusion::<2>();
    riemann_diffusion::<3>();
}

/// A disordered patch whose pressure waves about a tension.
fn stretched<const D: usize>(moving: bool, changes: Value) -> Scene {
    let across = if D == 2 { 20 } else { 9 };
    let position = lattice([-0.7; D], [across; D], SPACING, 0.19);
    let mut noise = Noise(5);
    let mut fluid = body(
        "fluid",
        true,
        SPACING,
        &position,
        |_| [0.0; D],
        |x| wavy(x) - 20.0,
    );
    if moving {
        let velocity = &mut fluid.particles.velocity;
        velocity.iter_mut().for_each(|u| *u = noise.number());
    }
    let config = json!({
        "dimension": D, "spacing": SPACING, "smoothing_length": 1.3 * SPACING,
        "reference_density": RHO, "sound_speed": C0,
    });
    Scene {
        config,
        bodies: vec![fluid],
    }
    .with(changes)
}

/// Acceleration times mass of each particle that `changes` add, and each particle's velocity.
fn added<const D: usize>(changes: Value) -> Vec<([f64; D], [f64; D])> {
    let (with, without) = (
        rates(&stretched::<D>(true, changes)),
        rates(&stretched::<D>(true, json!({}))),
    );
    let column = |entries, name: &str| -> [Vec<f64>; D] {
        std::array::from_fn(|a| by_id(entries, &format!("{name}_{a}")))
    };
    let (after, before) = (
        column(&with, "acceleration"),
        column(&without, "acceleration"),
    );
    let (mass, velocity) = (by_id(&with, "mass"), column(&with, "velocity"));
    (0..mass.len())
        .map(|i| {
            (
                std::array::from_fn(|a| mass[i] * (after[a][i] - before[a][i])),
                std::array::from_fn(|a| velocity[a][i]),
            )
        })
        .collect()
}

#[test]
fn pairs_keep_momentum() {
    for changes in [remedy("monaghan", true), json!({"riemann_viscosity": true})] {
        let forces = added::<3>(changes);
        for a in 0..3 {
            let sum: f64 = forces.iter().map(|(f, _)| f[a]).sum();
            let all: f64 = forces.iter().map(|(f, _)| f[a].abs()).sum();
            assert!(sum.abs() < 1e-12 * all && all > 0.0, "{sum} of {all}");
        }
    }
}

#[test]
fn a_riemann_problem_takes_energy() {
    let power: f64 = added::<2>(json!({"riemann_viscosity": true}))
        .iter()
        .map(|(f, u)| dot(f, u))
        .sum();
    assert!(power < 0.0, "{power}");
}

#[test]
fn what_flows_in_a_riemann_problem_is_neither_made_nor_steep_for_long() {
    // A density that differs from particle to particle, without order.
    let rough = |x: &[f64; 2]| RHO * (1.0 + 0.01 * (97.0 * x[0] + 61.0 * x[1]).sin());
    let form = json!({"density_diffusion": {"form": "riemann", "delta": 1.0}});
    let case = Case::<2>::new(KernelName::WendlandC2, rough, false, form);
    let rate = by_id(&case.rates, "density_rate");
    let volume: Vec<f64> = case
        .mass
        .iter()
        .zip(&case.density)
        .map(|(m, rho)| m / rho)
        .collect();
    let sum = |weight: &dyn Fn(usize) -> f64| -> f64 {
        (0..rate.len())
            .map(|i| volume[i] * weight(i) * rate[i])
            .sum()
    };
    let all = sum(&|i| rate[i].signum());
    assert!(sum(&|_| 1.0).abs() < 1e-12 * all);
    assert!(sum(&|i| case.density[i] - RHO) < 0.0);
}

#[test]
fn nothing_is_added_where_the_state_is_uniform() {
    let across = 24;
    let uniform = |changes: Value| {
        let spacing = 1.0 / across as f64;
        let position = lattice([0.0; 2], [across; 2], spacing, 0.0);
        let mut scene = periodic_box::<2>(across).with(changes);
        let drift = |_: &[f64; 2]| [1.0, -2.0];
        scene.bodies = vec![body("fluid", true, spacing, &position, drift, |_| {
            0.9 * RHO
        })];
        rates(&scene.with(json!({"background_pressure": 0.0})))
    };
    let changes = [
        remedy("sun", false),
        remedy("monaghan", false),
        json!({"riemann_viscosity": true}),
        json!({"density_diffusion": {"form": "riemann", "delta": 1.0}}),
    ];
    let pressure = 0.1 * RHO * C0 * C0;
    for changes in changes {
        let found = uniform(changes);
        for name in ["acceleration_0", "acceleration_1"] {
            let largest = by_id(&found, name)
                .into_iter()
                .fold(0.0, |m: f64, a| m.max(a.abs()));
            assert!(
                largest < 1e-11 * pressure * across as f64 / RHO,
                "{largest}"
            );
        }
        let rate = by_id(&found, "density_rate");
        assert!(rate.iter().all(|r| r.abs() < 1e-9 * RHO * C0), "{rate:?}");
    }
}

#[test]
fn water_at_rest_is_left_alone_by_the_reconstructed_states() {
    // Pressure linear in depth, up to the free surface: what flows is only by the curvature of Tait's equation.
    let linear = |x: &[f64; 2]| RHO * (1.0 - 0.02 * x[1]);
    let form = |form: &str| json!({"density_diffusion": {"form": form, "delta": 0.1}});
    let largest = |changes: Value| {
        let case = Case::<2>::new(KernelName::WendlandC2, linear, false, changes);
        by_id(&case.rates, "density_rate")
            .into_iter()
            .fold(0.0, |m: f64, r| m.max(r.abs()))
    };
    let (riemann, molteni) = (largest(form("riemann")), largest(form("molteni")));
    assert!(riemann < 1e-10 * molteni, "{riemann} and {molteni}");
}

#[test]
fn remedies_give_the_same_bits_for_any_number_of_threads_and_over_restart() {
    let scenes = [
        tank::<2>(60, 40).with(remedy("sun", true)),
        tank::<2>(50, 40).with(json!({
            "riemann_viscosity": true, "density_diffusion": {"form": "riemann", "delta": 1.0},
        })),
        tank::<3>(14, 10).with(remedy("monaghan", true)),
        stretched::<3>(true, remedy("sun", true)),
    ];
    for scene in scenes {
        for precision in [Precision::F64, Precision::Mixed] {
            let mut one = scene.start(precision, 1);
            common::advance(&mut one, 30);
            let mut three = scene.start(precision, 3);
            common::advance(&mut three, 17);
            let saved = three.save();
            let mut again = scene.start(precision, 2);
            again.restore(&saved).expect("its own state");
            common::advance(&mut again, 13);
            common::assert_same_bits(&one.save(), &again.save(), "remedies");
        }
    }
}

#[test]
fn what_walls_feel_of_fluid_under_tension_is_what_they_do_to_it() {
    for form in ["sun", "monaghan"] {
        let mut scene = tank::<2>(30, 20).with(remedy(form, false)).with(json!({
            "artificial_viscosity": null, "gravity": null, "time_step": 1e-7,
            "wall": {"method": "adami", "slip": "free", "suction": true},
        }));
        // The same tension everywhere: what fluid particles give each other is then balanced in either form.
        scene.fluid().velocity.fill(0.0);
        scene.fluid().density.fill(RHO - 20.0);
        let mut simulation = scene.start(Precision::F64, 1);
        common::advance(&mut simulation, 2);
        let before = simulation.diagnostics();
        common::advance(&mut simulation, 1);
        let after = simulation.diagnostics();
        let (force, _) = simulation.force_on("tank").expect("a wall");
        let time = after.time - before.time;
        let rate = [0, 1].map(|k| (after.momentum[k] - before.momentum[k]) / time);
        let scale = rate[0].hypot(rate[1]);
        assert!(scale > 1.0, "{form}: {rate:?}");
        for k in 0..2 {
            let lost = force[k] + rate[k];
            assert!(lost.abs() < 2e-3 * scale, "{form}: {force:?}, not {rate:?}");
        }
    }
}
