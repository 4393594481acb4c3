//! Every option runs beside every other: short runs that stay finite and lose no particle and no mass.

mod common;

use common::{Scene, advance, all_finite, integers, periodic_box, tank};
use kolk::kernel::KernelName;
use kolk::simulation::Precision;
use serde_json::{Value, json};

/// Every value of one option, as changes to a configuration.
type Choice = (&'static str, Value);

fn diffusions() -> Vec<Choice> {
    let form = |name| json!({"density_diffusion": {"form": name, "delta": 0.1}});
    vec![
        ("none", json!({})),
        ("molteni", form("molteni")),
        ("antuono", form("antuono")),
        ("fourtakas", form("fourtakas")),
    ]
}

fn viscosities() -> Vec<Choice> {
    let laminar = |form| json!({"artificial_viscosity": null, "laminar_viscosity": {"kinematic": 1e-4, "form": form}});
    let both = json!({
        "artificial_viscosity": {"alpha": 0.02, "beta": 0.04}, "laminar_viscosity": {"kinematic": 1e-5},
        "acoustic_damper": 0.3,
    });
    vec![
        ("none", json!({"artificial_viscosity": null})),
        (
            "artificial",
            json!({"artificial_viscosity": {"alpha": 0.05}}),
        ),
        ("morris", laminar("morris")),
        ("monaghan-gingold", laminar("monaghan-gingold")),
        ("both", both),
    ]
}

fn shiftings() -> Vec<Choice> {
    let form = |name, surface| json!({"shifting": {"form": name, "free_surface": surface}});
    vec![
        ("none", json!({})),
        ("sun", form("sun", true)),
        ("gentle", form("gentle", true)),
        ("lind", form("lind", true)),
        ("sun inside", form("sun", false)),
    ]
}

fn walls() -> Vec<Choice> {
    let wall = |method, slip| json!({"wall": {"method": method, "slip": slip}});
    vec![
        ("adami", wall("adami", "free")),
        ("adami no slip", wall("adami", "no")),
        ("dynamic", wall("dynamic", "free")),
        ("dynamic no slip", wall("dynamic", "no")),
    ]
}

fn run_briefly(mut scene: Scene, precision: Precision, what: &str) {
    let given = scene.fluid().mass.clone();
    let body = scene.bodies[0].name.clone();
    let mut simulation = scene.start(precision, 1);
    advance(&mut simulation, 6);
    let state = simulation.body(&body).unwrap();
    assert!(all_finite(&simulation.save()), "{what}: not finite");
    for (mass, given) in state.mass.iter().zip(&given) {
        assert!(
            (mass - given).abs() <= 1e-7 * given,
            "{what}: a mass changed"
        );
    }
    let mut ids = integers(&simulation.save(), "id").to_vec();
    ids.sort_unstable();
    assert!(ids.into_iter().eq(0..given.len() as u64), "{what}: ids");
    let seen = simulation.diagnostics();
    assert!(
        seen.density_min > 900.0 && seen.density_max < 1100.0,
        "{what}: {seen:?}"
    );
    assert!(seen.speed_max < 4.0, "{what}: {seen:?}");
}

/// All pairs of options, and with the coprime stride most combinations of three.
#[test]
fn every_pair_of_options_runs() {
    let (kernels, mut count) = (KernelName::ALL, 0usize);
    for kernel in kernels {
        for (d, diffusion) in diffusions() {
            for (v, viscosity) in viscosities() {
                for (s, shift) in shiftings() {
                    for (w, wall) in walls() {
                        count += 1;
                        if count % 3 != 0 {
                            continue;
                        }
                        let precision = if count % 2 == 0 {
                            Precision::Mixed
                        } else {
                            Precision::F64
                        };
                        let name = kernel.as_str();
                        let what = format!(
                            "{name}, {precision:?}, diffusion {d}, viscosity {v}, shifting {s}, wall {w}"
                        );
                        let scene = if count % 21 == 0 {
                            tank::<3>(6, 4)
                        } else {
                            tank::<2>(12, 8)
                        };
                        let scene = scene.with(json!({"kernel": name})).with(diffusion.clone());
                        let scene = scene
                            .with(viscosity.clone())
                            .with(shift.clone())
                            .with(wall.clone());
                        run_briefly(scene, precision, &what);
                    }
                }
            }
        }
    }
}

#[test]
fn every_effect_runs_in_three_dimensions_and_in_a_periodic_box() {
    for precision in [Precision::F64, Precision::Mixed] {
        for (k, kernel) in KernelName::ALL.into_iter().enumerate() {
            for (d, diffusion) in diffusions() {
                let (s, shift) = &shiftings()[k % 4];
                let (v, viscosity) = &viscosities()[(k + d.len()) % 5];
                let what = format!(
                    "{kernel}, {precision:?}, diffusion {d}, viscosity {v}, shifting {s}, periodic"
                );
                let change = |scene: Scene| {
                    let scene = scene.with(json!({"kernel": kernel.as_str(), "eos": "linear"}));
                    scene
                        .with(diffusion.clone())
                        .with(viscosity.clone())
                        .with(shift.clone())
                };
                run_briefly(change(periodic_box::<2>(16)), precision, &what);
                run_briefly(
                    change(periodic_box::<3>(8)),
                    precision,
                    &format!("{what}, 3D"),
                );
            }
        }
    }
}

#[test]
fn a_period_of_one_and_of_two_cells_runs() {
    // The support radius is 2.6 spacings: one cell per period at 4 and 5 particles, two at 6 and 8.
    for across in [3, 4, 5, 6, 8, 9] {
        for precision in [Precision::F64, Precision::Mixed] {
            run_briefly(
                periodic_box::<2>(across),
                precision,
                &format!("{across} across"),
            );
            run_briefly(
                periodic_box::<3>(across),
                precision,
                &format!("{across} across, 3D"),
            );
        }
    }
}
