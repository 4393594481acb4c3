//! Mirroring walls: against the images themselves, and what cannot mirror.

mod common;

use common::disorder::{assert_close, dot};
use common::faces::{faces, surface_of};
use common::{Scene, body, by_id, lattice};
use kolk::kernel::KernelName;
use kolk::operators::Cloud;
use kolk::simulation::{Precision, Simulation, SurfaceInput};
use serde_json::json;
use std::time::Duration;

const RHO: f64 = 1000.0;
const C0: f64 = 20.0;
const NU: f64 = 0.1;

/// Disordered fluid that fills a box from 0 to 1 m, in a disordered motion, with walls that mirror.
fn full_box<const D: usize>(across: usize, slip: &str, gravity: [f64; D]) -> Scene {
    let spacing = 1.0 / across as f64;
    // No particle is so near to a wall or to another that a contact acts.
    let position = lattice([0.0; D], [across; D], spacing, 0.19);
    let velocity =
        |x: &[f64; D]| std::array::from_fn(|a| (7.0 * x[a] + 3.0 * x[(a + 1) % D]).sin() + 0.3);
    let density = |x: &[f64; D]| RHO * (1.0 + 0.01 * (5.0 * x[0] + 3.0 * x[D - 1]).sin());
    let fluid = body("water", true, spacing, &position, velocity, density);
    // The particles of the wall stand for nothing.
    let wall = lattice([-spacing; D], [1; D], spacing, 0.0);
    let wall = body("tank", false, spacing, &wall, |_| [0.0; D], |_| RHO);
    Scene {
        config: json!({
            "dimension": D, "spacing": spacing, "smoothing_length": 1.5 * spacing,
            "reference_density": RHO, "sound_speed": C0, "eos": "linear", "gravity": gravity.to_vec(),
            "laminar_viscosity": {"kinematic": NU, "form": "morris"},
            "wall": {"method": "mirror", "slip": slip, "suction": true},
        }),
        bodies: vec![fluid, wall],
    }
}

fn start(scene: &Scene, surfaces: &[SurfaceInput]) -> kolk::error::Result<Simulation> {
    Simulation::with_surfaces(
        scene.configuration(),
        scene.bodies.clone(),
        surfaces,
        Precision::F64,
        2,
    )
}

/// The rates of a fluid that fills a box, against those among its particles and all their images.
fn images<const D: usize>(across: usize, slip: &str, gravity: [f64; D]) {
    let mut scene = full_box::<D>(across, slip, gravity);
    let tank = [surface_of("tank", &faces([0.0; D], [1.0; D], true, &[]))];
    let mut simulation = start(&scene, &tank).unwrap();
    simulation.advance(1.0, 0, Duration::MAX).unwrap();
    let rates = simulation.save();

    let given = scene.fluid();
    let n = given.mass.len();
    let (mut x, mut u, mut slid) = (Vec::new(), Vec::new(), Vec::new());
    let (mut mass, mut density, mut pressure) = (Vec::new(), Vec::new(), Vec::new());
    // Each axis: as it is, behind the low wall, behind the high wall; the fluid itself comes first.
    for image in 0..3usize.pow(D as u32) {
        let side: [usize; D] = std::array::from_fn(|a| image / 3usize.pow(a as u32) % 3);
        let odd = side.iter().filter(|&&s| s > 0).count() % 2 == 1;
        for j in 0..n {
            let at: [f64; D] = std::array::from_fn(|a| given.position[j * D + a]);
            let to: [f64; D] = std::array::from_fn(|a| match side[a] {
                0 => at[a],
                1 => -at[a],
                _ => 2.0 - at[a],
            });
            let v: [f64; D] = std::array::from_fn(|a| given.velocity[j * D + a]);
            let way: [f64; D] = std::array::from_fn(|a| to[a] - at[a]);
            let rho = given.density[j];
            slid.push(std::array::from_fn::<f64, D, _>(|a| {
                if side[a] > 0 { -v[a] } else { v[a] }
            }));
            u.push(if odd { v.map(|v| -v) } else { v });
            x.push(to);
            mass.push(given.mass[j]);
            density.push(rho);
            pressure.push(C0 * C0 * (rho - RHO) + rho * dot(&gravity, &way));
        }
    }
    let h = 1.5 / across as f64;
    let cloud = Cloud::new(&x, &mass, &density, KernelName::WendlandC2, h, &[None; D]);
    let eta2 = 1e-6 * h * h;
    let (mut acceleration, mut rate) = (vec![vec![0.0; n]; D], vec![0.0; n]);
    for i in 0..n {
        cloud.for_each_neighbour(i, |j, d, r, slope| {
            let weight = cloud.volume[j] * slope;
            // Friction where the fluid sticks, and among the fluid itself.
            let felt = if slip == "no" || j < n { 1.0 } else { 0.0 };
            let drag = felt * NU * (density[i] + density[j]) * r * r / (r * r + eta2);
            let mut approach = 0.0;
            for a in 0..D {
                let push = -(pressure[i] + pressure[j]) * d[a] + drag * (u[i][a] - u[j][a]);
                acceleration[a][i] += weight * push / density[i];
                approach += (slid[i][a] - slid[j][a]) * d[a];
            }
            rate[i] += density[i] * weight * approach;
        });
    }
    let what = format!("{D}D, slip {slip}");
    for a in 0..D {
        let found = by_id(&rates, &format!("acceleration_{a}"));
        assert_close(&found, &acceleration[a], &what);
    }
    assert_close(&by_id(&rates, "density_rate"), &rate, &what);
}

#[test]
fn fluid_in_a_box_moves_as_among_its_images() {
    for slip in ["free", "no"] {
        images::<2>(16, slip, [0.0; 2]);
        images::<2>(16, slip, [3.0, -9.81]);
        images::<3>(9, slip, [1.0, 2.0, -9.81]);
    }
}

/// The message with which walls are refused.
fn refused<const D: usize>(across: usize, surfaces: &[SurfaceInput]) -> String {
    let scene = full_box::<D>(across, "free", [0.0; D]);
    let message = start(&scene, surfaces).err().expect("refused").to_string();
    assert!(
        message.contains("mirror") && message.contains("adami"),
        "{message}"
    );
    message
}

#[test]
fn what_cannot_mirror_is_refused() {
    // A wedge.
    let wedge = [[[0.2, 0.0], [0.4, 0.1]], [[0.4, 0.1], [0.6, 0.0]]];
    let message = refused::<2>(20, &[surface_of("tank", &wedge)]);
    assert!(message.contains("right angle"), "{message}");
    // A disc.
    let at = |k: usize| {
        let turn = std::f64::consts::TAU * k as f64 / 40.0;
        [0.5 + 0.2 * turn.cos(), 0.5 + 0.2 * turn.sin()]
    };
    let disc: Vec<[[f64; 2]; 2]> = (0..40).map(|k| [at(k), at(k + 1)]).collect();
    let message = refused::<2>(20, &[surface_of("tank", &disc)]);
    assert!(message.contains("curved"), "{message}");
    // A plate of less than the support radius, and a channel.
    for inwards in [false, true] {
        let mut low = [0.0; 3];
        low[0] = 0.4;
        let mut high = [1.0; 3];
        high[0] = 0.5;
        let plate = faces(low, high, inwards, &[]);
        let message = refused::<3>(10, &[surface_of("tank", &plate)]);
        let why = if inwards { "gap" } else { "both sides" };
        assert!(
            message.contains(why) && message.contains("0.1"),
            "{message}"
        );
    }
    // The same as thick as the support radius of 0.3 m.
    let thick = faces([0.2, 0.0, 0.0], [0.5, 1.0, 1.0], false, &[]);
    let scene = full_box::<3>(10, "free", [0.0; 3]);
    assert!(start(&scene, &[surface_of("tank", &thick)]).is_ok());
}
