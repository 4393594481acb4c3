//! The fused sweeps against the same formulae summed plainly, on disordered particles with a free surface.

mod common;

use common::disorder::{C0, Case, DELTA, RHO, SPACING, assert_close, dot, wavy};
use common::{Scene, by_id, integers, reals, tank};
use kolk::kernel::KernelName;
use kolk::operators::{Cloud, divergence, gradient};
use kolk::simulation::{Entries, Precision};
use serde_json::{Value, json};
use std::time::Duration;

fn pressure_and_continuity<const D: usize>() {
    for kernel in KernelName::ALL {
        let case = Case::<D>::new(kernel, wavy, true, json!({}));
        case.assert_acceleration(
            &case.pressure_acceleration(),
            &format!("pressure, {kernel}, {D}D"),
        );
        let compression = divergence(&case.cloud(), &case.velocity, false);
        let wanted: Vec<f64> = compression
            .iter()
            .zip(&case.density)
            .map(|(d, rho)| -rho * d)
            .collect();
        assert_close(
            &by_id(&case.rates, "density_rate"),
            &wanted,
            &format!("continuity, {kernel}, {D}D"),
        );
    }
}

#[test]
fn pressure_and_continuity_are_the_operators() {
    pressure_and_continuity::<2>();
    pressure_and_continuity::<3>();
}

fn artificial_viscosity<const D: usize>() {
    let (alpha, beta) = (0.3, 0.7);
    let changes = json!({"artificial_viscosity": {"alpha": alpha, "beta": beta}});
    let case = Case::<D>::new(KernelName::WendlandC2, wavy, true, changes);
    let wanted = case.viscous_acceleration(|cloud, i, j, d, r, slope| {
        let approach = dot(&case.relative_velocity(i, j), &d).min(0.0);
        let mu = cloud.h * approach / (r * r + 0.01 * cloud.h * cloud.h);
        let mean = 0.5 * (case.density[i] + case.density[j]);
        let pi = (-alpha * C0 * mu + beta * mu * mu) / mean;
        d.map(|d| -case.density[i] * case.density[j] * pi * slope * d)
    });
    case.assert_acceleration(&wanted, &format!("artificial viscosity, {D}D"));
}

fn laminar_viscosity<const D: usize>() {
    let nu = 0.02;
    let form = |name| json!({"laminar_viscosity": {"kinematic": nu, "form": name}});
    let case = Case::<D>::new(KernelName::WendlandC2, wavy, true, form("morris"));
    let eta2 = 1e-6 * case.h * case.h;
    let wanted = case.viscous_acceleration(|_, i, j, _, r, slope| {
        let strength = nu * (case.density[i] + case.density[j]) * r * r * slope / (r * r + eta2);
        case.relative_velocity(i, j).map(|u| strength * u)
    });
    case.assert_acceleration(&wanted, &format!("Morris, {D}D"));

    let case = Case::<D>::new(KernelName::WendlandC2, wavy, true, form("monaghan-gingold"));
    let wanted = case.viscous_acceleration(|_, i, j, d, r, slope| {
        let densities = case.density[i] + case.density[j];
        let approach = dot(&case.relative_velocity(i, j), &d) / (r * r + eta2);
        d.map(|d| (D as f64 + 2.0) * nu * densities * approach * slope * d)
    });
    case.assert_acceleration(&wanted, &format!("Monaghan and Gingold, {D}D"));
}

fn soft_core<const D: usize>() {
    // At rest, so that what pressure does not explain is the core alone.
    let case = Case::<D>::displaced(0.45, KernelName::WendlandC2, wavy, false, json!({}));
    let (cloud, pressure) = (case.cloud(), case.pressure_acceleration());
    let found: [Vec<f64>; D] =
        std::array::from_fn(|a| by_id(&case.rates, &format!("acceleration_{a}")));
    let (mut pushed, mut scale, mut work) = (0, 0.0, 0.0);
    let (mut force, mut torque) = ([0.0; D], 0.0);
    for i in 0..cloud.len() {
        let core: [f64; D] = std::array::from_fn(|a| case.mass[i] * (found[a][i] - pressure[i][a]));
        let size = dot(&core, &core).sqrt();
        let mut nearest = f64::INFINITY;
        cloud.for_each_neighbour(i, |_, _, r, _| nearest = nearest.min(r));
        if nearest > 0.6 * SPACING {
            assert!(size < 1e-9, "{D}D: particle {i} in order feels {size} N");
        }
        pushed += usize::from(size > 1e-9);
        scale += size;
        work += dot(&core, &case.position[i]);
        for a in 0..D {
            force[a] += core[a];
        }
        torque += case.position[i][0] * core[1] - case.position[i][1] * core[0];
    }
    assert!(
        pushed > 10 && work > 0.0,
        "{D}D: {pushed} particles pushed, virial {work}"
    );
    assert!(
        dot(&force, &force).sqrt() < 1e-10 * scale,
        "{D}D: {force:?} of {scale}"
    );
    assert!(torque.abs() < 1e-10 * scale, "{D}D: {torque} of {scale}");
}

#[test]
fn the_soft_core_parts_close_pairs_and_keeps_momenta() {
    soft_core::<2>();
    soft_core::<3>();
}

#[test]
fn viscosities_are_their_formulae() {
    artificial_viscosity::<2>();
    artificial_viscosity::<3>();
    laminar_viscosity::<2>();
    laminar_viscosity::<3>();
}

fn gravity<const D: usize>() -> [f64; D] {
    std::array::from_fn(|a| if a == D - 1 { -9.81 } else { 0.5 })
}

fn diffusion_config<const D: usize>(form: &str) -> Value {
    json!({"density_diffusion": {"form": form, "delta": DELTA}, "gravity": gravity::<D>().to_vec()})
}

/// `2 δ h c0 Σ V_j (ρ_j - ρ_i - explained) r_ji/r² · ∇W_ij`.
fn diffusion<const D: usize>(
    case: &Case<D>,
    explained: impl Fn(usize, usize, [f64; D]) -> f64,
) -> Vec<f64> {
    let cloud = case.cloud();
    (0..cloud.len())
        .map(|i| {
            let mut sum = 0.0;
            cloud.for_each_neighbour(i, |j, d, _, slope| {
                let difference = case.density[j] - case.density[i] - explained(i, j, d);
                sum -= 2.0 * DELTA * cloud.h * C0 * cloud.volume[j] * difference * slope;
            });
            sum
        })
        .collect()
}

fn density_diffusion<const D: usize>() {
    for kernel in KernelName::ALL {
        let run = |form| Case::<D>::new(kernel, wavy, false, diffusion_config::<D>(form));
        let found = |case: &Case<D>| by_id(&case.rates, "density_rate");

        let case = run("molteni");
        assert_close(
            &found(&case),
            &diffusion(&case, |_, _, _| 0.0),
            &format!("Molteni, {kernel}, {D}D"),
        );

        let case = run("antuono");
        let slopes = gradient(&case.cloud(), &case.density, 1, true);
        let wanted = diffusion(&case, |i, j, d| {
            -(0..D)
                .map(|a| 0.5 * (slopes[i * D + a] + slopes[j * D + a]) * d[a])
                .sum::<f64>()
        });
        assert_close(&found(&case), &wanted, &format!("Antuono, {kernel}, {D}D"));

        let case = run("fourtakas");
        let wanted = diffusion(&case, |_, _, d| {
            // To the second order in x: what the engine's formula says it is.
            let x = -dot(&gravity::<D>(), &d) / (C0 * C0);
            RHO * x * (1.0 - 3.0 * x)
        });
        assert_close(
            &found(&case),
            &wanted,
            &format!("Fourtakas, {kernel}, {D}D"),
        );
    }
}

#[test]
fn density_diffusion_is_its_formula() {
    density_diffusion::<2>();
    density_diffusion::<3>();
}

fn largest(rates: &Entries) -> f64 {
    reals(rates, "density_rate")
        .iter()
        .fold(0.0, |m, r| m.max(r.abs()))
}

fn antuono_vanishes<const D: usize>() {
    let linear = |x: &[f64; D]| RHO + 4.0 * x[0] - 7.0 * x[D - 1];
    let run = |form| {
        Case::<D>::new(
            KernelName::WendlandC2,
            linear,
            false,
            diffusion_config::<D>(form),
        )
        .rates
    };
    let (antuono, molteni) = (largest(&run("antuono")), largest(&run("molteni")));
    assert!(
        antuono < 1e-11 * molteni,
        "{D}D: {antuono:e} of {molteni:e}"
    );
}

#[test]
fn antuono_diffusion_vanishes_for_linear_density_up_to_the_surface() {
    antuono_vanishes::<2>();
    antuono_vanishes::<3>();
}

/// Hydrostatic density over Molteni's diffusion, at a sound speed.
fn fourtakas_residual(sound_speed: f64) -> f64 {
    let g = gravity::<2>();
    let hydrostatic = |x: &[f64; 2]| {
        let head = g[0] * (x[0] - 1.3) + g[1] * (x[1] - 1.3);
        RHO * (1.0 + 7.0 * head / (sound_speed * sound_speed)).powf(1.0 / 7.0)
    };
    let run = |form| {
        let changes = diffusion_config::<2>(form);
        let mut changes = changes;
        changes["sound_speed"] = json!(sound_speed);
        largest(&Case::<2>::new(KernelName::WendlandC2, hydrostatic, false, changes).rates)
    };
    run("fourtakas") / run("molteni")
}

#[test]
fn fourtakas_diffusion_vanishes_for_fluid_at_rest_to_its_order() {
    // It expects the slope of density at the surface: what is left is (γ - 1) g H / c0² of the whole, here H = 2.
    let (coarse, fine) = (fourtakas_residual(40.0), fourtakas_residual(80.0));
    assert!(coarse < 7.0 * 9.81 * 2.0 / (40.0 * 40.0), "{coarse}");
    assert!((coarse / fine - 4.0).abs() < 0.8, "{coarse} {fine}");
}

fn adami<const D: usize>(scene: &Scene) {
    let mut simulation = scene.start(Precision::F64, 2);
    simulation.advance(1.0, 0, Duration::MAX).unwrap();
    let (water, tank) = (
        simulation.body("water").unwrap(),
        simulation.body("tank").unwrap(),
    );
    let position = water.position.as_chunks::<D>().0;
    let h = scene.configuration().smoothing_length;
    let cloud = Cloud::new(
        position,
        &water.mass,
        &water.density,
        KernelName::WendlandC2,
        h,
        &[None; D],
    );
    let mut wanted = Vec::new();
    for x in tank.position.as_chunks::<D>().0 {
        let (mut weight, mut sum) = (0.0, 0.0);
        cloud.for_each_near(x, |j, d, r| {
            let w = cloud.volume[j] * cloud.kernel.value(r);
            weight += w;
            sum += w * (water.pressure[j] - 9.81 * water.density[j] * d[D - 1]);
        });
        wanted.push(if weight > 1e-12 {
            (sum / weight).max(0.0)
        } else {
            0.0
        });
    }
    assert_close(&tank.pressure, &wanted, &format!("wall pressure, {D}D"));
}

#[test]
fn pressure_at_walls_is_extrapolated() {
    adami::<2>(&tank::<2>(16, 12));
    adami::<3>(&tank::<3>(8, 6));
}

#[test]
fn the_force_on_a_wall_is_the_reaction_to_its_force_on_the_fluid() {
    for precision in [Precision::F64, Precision::Mixed] {
        let scene = tank::<2>(16, 12).with(json!({"artificial_viscosity": null}));
        let mut simulation = scene.start(precision, 2);
        simulation.advance(1.0, 0, Duration::MAX).unwrap();
        let state = simulation.save();
        let (force, moment) = simulation.force_on("tank").unwrap();
        let bound = if precision == Precision::F64 {
            1e-11
        } else {
            1e-5
        };
        let n = integers(&state, "id").len();
        let column = |name| reals(&state, name);
        let pull = |i: usize| {
            ["acceleration_0", "acceleration_1"].map(|a| column(a)[i] * column("mass")[i])
        };
        let mut total = [0.0; 3];
        for i in 0..n {
            let f = pull(i);
            let x = [column("position_0")[i], column("position_1")[i]];
            total[0] += f[0];
            total[1] += f[1];
            total[2] += x[0] * f[1] - x[1] * f[0];
        }
        let scale = force[1].abs();
        for (found, reaction) in [force[0], force[1], moment[0]].into_iter().zip(total) {
            assert!(
                (found + reaction).abs() < bound * scale,
                "{precision:?}: {found} against {reaction}"
            );
        }
    }
}
