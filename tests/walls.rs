//! Walls: their surface, what gets behind it, and what each method makes exactly.

mod common;

use common::faces::{faces, facets, surface_of};
use common::{Scene, advance, body, lattice};
use kolk::neighbours::Grid;
use kolk::simulation::{Precision, Simulation, SurfaceInput};
use kolk::walls::Surface;
use serde_json::json;
use std::time::Duration;

/// A tank with the inside from 0 to 1 per axis.
fn unit_tank<const D: usize>(open: &[(usize, usize)], reach: f64) -> (Surface<D>, Grid<D>) {
    let grid = Grid::new([-0.5; D], [1.5; D], 0.2, [None; D], 10_000);
    let faces = facets(&faces([0.0; D], [1.0; D], true, open));
    (Surface::new(faces, &grid, reach), grid)
}

fn near<'a, const D: usize>(surface: &'a Surface<D>, grid: &Grid<D>, x: &[f64; D]) -> &'a [u32] {
    surface.near_cell(grid.bin(x) as usize / Grid::<D>::PARTS)
}

fn feet_of_a_tank<const D: usize>() {
    let (surface, grid) = unit_tank::<D>(&[(D - 1, 1)], 0.3);
    let up = |x: f64| {
        let mut at = [0.5; D];
        at[D - 1] = x;
        at
    };
    for height in [0.2, 1e-3, -1e-3, -0.2] {
        let x = up(height);
        let foot = surface.foot(&x, near(&surface, &grid, &x)).unwrap();
        assert!((foot.distance - height).abs() < 1e-14 && foot.faces);
        assert_eq!(foot.normal[D - 1], 1.0);
        assert!(foot.point[D - 1].abs() < 1e-15);
    }
    // Behind an edge, and behind a corner: the way to it is between the normals.
    let x = [-0.1; D];
    let foot = surface.foot(&x, near(&surface, &grid, &x)).unwrap();
    assert!((foot.distance + 0.1 * (D as f64).sqrt()).abs() < 1e-14 && foot.faces);
    assert_eq!(foot.point, [0.0; D]);
    // Beyond the rim, outside of the tank: nothing has passed the wall there.
    let mut x = up(1.02);
    x[0] = 1.05;
    let foot = surface.foot(&x, near(&surface, &grid, &x)).unwrap();
    assert!(!foot.faces);
    x[D - 2] = 1.05;
    x[0] = 1.05;
    assert!(!surface.foot(&x, near(&surface, &grid, &x)).unwrap().faces);
    // Out of reach.
    let x = up(0.5);
    assert!(surface.foot(&x, near(&surface, &grid, &x)).is_none());
}

#[test]
fn the_nearest_point_of_a_tank_is_known_on_both_sides() {
    feet_of_a_tank::<2>();
    feet_of_a_tank::<3>();
}

fn feet_of_an_obstacle<const D: usize>() {
    // A plate thinner than any spacing, and the space around it: every point against brute force.
    let grid = Grid::new([-0.5; D], [1.5; D], 0.1, [None; D], 10_000);
    let mut high = [0.7; D];
    high[0] = 0.31;
    let mut low = [0.2; D];
    low[0] = 0.3;
    let faces = facets(&faces(low, high, false, &[]));
    let all: Vec<u32> = (0..faces.len() as u32).collect();
    let surface = Surface::new(faces, &grid, 0.15);
    let mut found = 0;
    for x in lattice::<D>([0.0; D], [12; D], 1.0 / 12.0, 0.4) {
        let beyond: [f64; D] = std::array::from_fn(|a| (low[a] - x[a]).max(x[a] - high[a]));
        let outside = beyond
            .iter()
            .map(|b| b.max(0.0).powi(2))
            .sum::<f64>()
            .sqrt();
        let exact = outside
            + beyond
                .iter()
                .copied()
                .fold(f64::NEG_INFINITY, f64::max)
                .min(0.0);
        let foot = surface.foot(&x, near(&surface, &grid, &x));
        assert_eq!(foot.is_some(), exact.abs() < 0.15, "{x:?}");
        if let Some(foot) = foot {
            found += 1;
            assert!((foot.distance - exact).abs() < 1e-12 && foot.faces, "{x:?}");
            assert_eq!(surface.foot(&x, &all).unwrap().point, foot.point);
        }
    }
    assert!(found > 20);
}

#[test]
fn distances_from_a_thin_plate_are_exact_on_both_sides() {
    feet_of_an_obstacle::<2>();
    feet_of_an_obstacle::<3>();
}

/// Fluid from 0 to 1 m in a closed box with walls of four layers; `position` of the fluid and its density.
fn closed_box<const D: usize>(across: usize, density: impl Fn(&[f64; D]) -> f64) -> Scene {
    let spacing = 1.0 / across as f64;
    let position = lattice([0.0; D], [across; D], spacing, 0.2);
    let mut wall = lattice([-4.0 * spacing; D], [across + 8; D], spacing, 0.0);
    wall.retain(|x| (0..D).any(|a| x[a] < 0.0 || x[a] > 1.0));
    let fluid = body("water", true, spacing, &position, |_| [0.0; D], density);
    let walls = body("tank", false, spacing, &wall, |_| [0.0; D], |_| 1000.0);
    Scene {
        config: json!({
            "dimension": D, "spacing": spacing, "smoothing_length": 1.5 * spacing,
            "reference_density": 1000.0, "sound_speed": 20.0, "eos": "linear",
            "wall": {"method": "modified-dynamic", "slip": "free", "suction": true},
        }),
        bodies: vec![fluid, walls],
    }
}

fn start(scene: &Scene, surfaces: &[SurfaceInput], precision: Precision) -> Simulation {
    Simulation::with_surfaces(
        scene.configuration(),
        scene.bodies.clone(),
        surfaces,
        precision,
        2,
    )
    .expect("a good scene")
}

fn linear_pressure<const D: usize>() {
    // Pressure 4e5 (x + 2 y - z) / 100 Pa about its mean: nothing but a consistent extrapolation makes it.
    let slopes = [1.0, 2.0, -1.0];
    let condensation = |x: &[f64]| {
        x.iter()
            .zip(slopes)
            .map(|(x, s)| 0.01 * s * (x - 0.3))
            .sum::<f64>()
    };
    let across = if D == 2 { 16 } else { 10 };
    let scene = closed_box::<D>(across, |x| 1000.0 * (1.0 + condensation(x)));
    let tank = [surface_of("tank", &faces([0.0; D], [1.0; D], true, &[]))];
    for (precision, bound) in [(Precision::F64, 1e-10), (Precision::Mixed, 2e-4)] {
        let mut simulation = start(&scene, &tank, precision);
        simulation.advance(1.0, 0, Duration::MAX).unwrap();
        let wall = simulation.body("tank").unwrap();
        let spacing = 1.0 / across as f64;
        let mut checked = 0;
        for (x, p) in wall.position.chunks_exact(D).zip(&wall.pressure) {
            // Two layers, whose ghost nodes have fluid all around them or a wall behind them.
            let depth = x.iter().map(|&x| (-x).max(x - 1.0)).fold(0.0, f64::max);
            if depth < 2.0 * spacing {
                let exact = 4e5 * condensation(x);
                assert!(
                    (p - exact).abs() < bound * 4e5 * 0.04,
                    "{x:?}: {p} for {exact} ({precision:?})"
                );
                checked += 1;
            }
        }
        assert!(checked > 4 * across);
    }
}

#[test]
fn modified_dynamic_walls_continue_a_linear_pressure_exactly() {
    linear_pressure::<2>();
    linear_pressure::<3>();
}

#[test]
fn a_method_that_needs_a_surface_says_so() {
    let scene = closed_box::<2>(10, |_| 1000.0);
    let missing = Simulation::new(
        scene.configuration(),
        scene.bodies.clone(),
        Precision::F64,
        1,
    );
    let message = missing.err().unwrap().to_string();
    assert!(
        message.contains("tank") && message.contains("surface"),
        "{message}"
    );
    for surface in [
        SurfaceInput {
            body: "water".to_owned(),
            corners: vec![0.0; 4],
        },
        SurfaceInput {
            body: "tank".to_owned(),
            corners: vec![0.0; 5],
        },
        SurfaceInput {
            body: "tank".to_owned(),
            corners: vec![f64::NAN; 4],
        },
    ] {
        let found = Simulation::with_surfaces(
            scene.configuration(),
            scene.bodies.clone(),
            &[surface],
            Precision::F64,
            1,
        );
        assert!(found.err().unwrap().to_string().contains("surfaces"));
    }
}

fn leaks<const D: usize>() {
    let mut scene =
        closed_box::<D>(10, |_| 1000.0).with(json!({"wall": {"method": "adami", "slip": "free"}}));
    let tank = [surface_of("tank", &faces([0.0; D], [1.0; D], true, &[]))];
    let position = &mut scene.fluid().position;
    // Half a spacing behind the low side, behind the far corner, and hardly behind: a contact gives as much.
    position[0] = -0.05;
    position[5 * D..6 * D].fill(1.03);
    position[7 * D + 1] = -0.004;
    let mut simulation = start(&scene, &tank, Precision::F64);
    advance(&mut simulation, 1);
    assert_eq!(simulation.diagnostics().leaks, 2);
    let water = simulation.body("water").unwrap();
    assert!(water.position.iter().all(|x| (-0.011..1.011).contains(x)));
    assert!(water.position[0] > 0.03);
    // What led into the wall is taken from the velocity.
    assert!(water.velocity[0] >= 0.0);
    assert!((0..D).all(|a| water.velocity[5 * D + a] <= 0.0));
    // The count goes on over a checkpoint.
    let state = simulation.save();
    let mut again = start(&scene, &tank, Precision::F64);
    again.restore(&state).unwrap();
    assert_eq!(again.diagnostics().leaks, 2);
}

#[test]
fn what_is_behind_a_wall_is_brought_back_and_counted() {
    leaks::<2>();
    leaks::<3>();
}

#[test]
fn a_moving_wall_takes_along_what_is_in_its_way() {
    // The face of a plate sweeps over a particle at rest; the particles of the plate are out of its reach.
    let mut scene =
        closed_box::<2>(10, |_| 1000.0).with(json!({"wall": {"method": "adami", "slip": "free"}}));
    let spacing = 0.1;
    let plate = lattice([5.0, 5.0], [1, 4], 0.1, 0.0);
    scene.bodies[0] = body(
        "water",
        true,
        spacing,
        &[[0.55, 0.9]],
        |_| [0.0; 2],
        |_| 1000.0,
    );
    scene.bodies[1] = body("plate", false, spacing, &plate, |_| [0.0; 2], |_| 1000.0);
    let signal = json!({"kind": "rate", "rate": -1.0});
    let path = json!({"kind": "translate", "direction": [1.0, 0.0]});
    let scene = scene.with(json!({
        "motion": [{"body": "plate", "parts": [{"path": path, "signal": signal}]}],
        "time_step": 0.02,
    }));
    let surface = surface_of("plate", &faces([0.6, 0.8], [0.8, 1.0], false, &[]));
    let mut simulation = Simulation::with_surfaces(
        scene.configuration(),
        scene.bodies.clone(),
        &[surface],
        Precision::F64,
        1,
    )
    .expect("a good scene");
    advance(&mut simulation, 30);
    let water = simulation.body("water").unwrap();
    // The face has gone from 0.6 to 0.
    assert!(water.position[0] < 0.01, "{:?}", water.position);
    assert!(water.velocity[0] <= -1.0 + 1e-9);
}

#[test]
fn walls_without_particles_carry_the_weight_of_the_fluid() {
    // Hydrostatic pressure in a tank filled to the brim: the force on its floor is the weight, on its sides ρ g H²/2.
    for method in ["semi-analytical", "penalty", "mirror"] {
        let mut scene = common::tank_of::<2>(40, 20, 0.05, 0.0)
            .with(json!({"wall": {"method": method, "slip": "free"}, "smoothing_length": 0.1}));
        scene.fluid().velocity.fill(0.0);
        let tank = [surface_of(
            "tank",
            &faces([0.0; 2], [2.0, 1.0], true, &[(1, 1)]),
        )];
        let mut simulation = start(&scene, &tank, Precision::F64);
        simulation.advance(1.0, 0, Duration::MAX).unwrap();
        let (force, _) = simulation.force_on("tank").unwrap();
        assert!(
            (force[1] / (-1000.0 * 9.81 * 2.0) - 1.0).abs() < 0.02,
            "{method}: {force:?}"
        );
        assert!(
            force[0].abs() < 1e-6 * force[1].abs(),
            "{method}: {force:?}"
        );
    }
}

fn same_bits<const D: usize>() {
    let tank = [surface_of("tank", &faces([0.0; D], [1.0; D], true, &[]))];
    for method in ["modified-dynamic", "semi-analytical", "penalty", "mirror"] {
        for precision in [Precision::F64, Precision::Mixed] {
            let scene = closed_box::<D>(if D == 2 { 24 } else { 10 }, |x| 1000.0 + 2.0 * x[0])
                .with(json!({"wall": {"method": method, "slip": "free"}}));
            let run = |threads: usize, steps: u64| {
                let mut simulation = Simulation::with_surfaces(
                    scene.configuration(),
                    scene.bodies.clone(),
                    &tank,
                    precision,
                    threads,
                )
                .expect("a good scene");
                advance(&mut simulation, steps);
                simulation
            };
            let whole = run(1, 24).save();
            common::assert_same_bits(&whole, &run(3, 24).save(), method);
            let half = run(2, 12).save();
            let mut rest = run(2, 1);
            rest.restore(&half).unwrap();
            advance(&mut rest, 12);
            common::assert_same_bits(&whole, &rest.save(), method);
            assert!(common::all_finite(&whole));
        }
    }
}

#[test]
fn walls_have_the_same_bits_for_any_threads_and_over_a_restart() {
    same_bits::<2>();
    same_bits::<3>();
}
