//! Shifting: its formula, and the volume of fluid that has splashed about for long.

mod common;

use common::{advance, periodic_box, tank};
use kolk::kernel::KernelName;
use kolk::operators::{Cloud, Shift, particle_shift};
use kolk::simulation::{Precision, Simulation};
use serde_json::json;
use std::time::Duration;

/// Level of what was a column in a corner of a tank after it has come down and sloshed, over the level of its volume.
fn level_after(changes: serde_json::Value) -> f64 {
    const ACROSS: usize = 48;
    const WIDE: usize = 24;
    const DEEP: usize = 16;
    let mut scene = tank::<2>(ACROSS, 2 * DEEP).with(changes);
    let water = &mut scene.bodies[0].particles;
    let kept: Vec<usize> = (0..water.mass.len())
        .filter(|&i| {
            water.position[2 * i] < WIDE as f64 * 0.01
                && water.position[2 * i + 1] < DEEP as f64 * 0.01
        })
        .collect();
    let vectors = |v: &[f64]| {
        kept.iter()
            .flat_map(|&i| [v[2 * i], v[2 * i + 1]])
            .collect()
    };
    let numbers = |v: &[f64]| kept.iter().map(|&i| v[i]).collect();
    water.position = vectors(&water.position);
    water.velocity = vec![0.0; 2 * kept.len()];
    water.mass = numbers(&water.mass);
    water.density = vec![1000.0; kept.len()];
    let mut simulation = scene.start(Precision::F64, 2);
    simulation.advance(4.0, u64::MAX, Duration::MAX).unwrap();
    let mut heights: Vec<f64> = simulation
        .body("water")
        .unwrap()
        .position
        .chunks_exact(2)
        .map(|x| x[1])
        .collect();
    heights.sort_by(f64::total_cmp);
    // Half of the water is below half of its level; what still flies does not matter.
    let level = 2.0 * heights[heights.len() / 2];
    level / ((WIDE * DEEP) as f64 / ACROSS as f64 * 0.01)
}

#[test]
fn shifted_fluid_keeps_its_volume() {
    for (form, every) in [("sun", 1), ("lind", 1), ("sun", 2), ("sun", 3)] {
        let level = level_after(json!({
            "smoothing_length": 0.02,
            "density_diffusion": {"form": "antuono", "delta": 0.1},
            "acoustic_damper": 0.3,
            "shifting": {"form": form, "every": every},
        }));
        assert!(
            (level - 1.0).abs() < 0.05,
            "{form}, every {every}: {level} of the level at rest"
        );
    }
}

/// Mean pressure over `ρU²` of disordered fluid that fills a periodic box, after it has gone once around, less that of its start.
fn rise_of_pressure<const D: usize>(across: usize, form: &str) -> f64 {
    let scene = periodic_box::<D>(across).with(json!({
        "smoothing_length": 2.0 / across as f64,
        "density_diffusion": {"form": "molteni", "delta": 0.1},
        "laminar_viscosity": {"kinematic": 0.01, "form": "morris"},
        "shifting": {"form": form, "free_surface": false},
    }));
    let c = scene.config["sound_speed"].as_f64().unwrap();
    let mut simulation = scene.start(Precision::Mixed, 2);
    let volume = |simulation: &Simulation| {
        let fluid = simulation.body("fluid").unwrap();
        let parts = fluid.mass.iter().zip(&fluid.density);
        parts.map(|(m, density)| m / density).sum::<f64>()
    };
    let start = volume(&simulation);
    simulation.advance(1.0, u64::MAX, Duration::MAX).unwrap();
    (start / volume(&simulation) - 1.0) * c * c
}

/// Density follows the concentration, and that of particles in disorder is higher than a lattice's: it must not squeeze
/// the fluid as a whole.
#[test]
fn fluid_without_a_surface_keeps_its_mean_pressure() {
    for form in ["sun", "consistent"] {
        let (plane, space) = (
            rise_of_pressure::<2>(24, form),
            rise_of_pressure::<3>(12, form),
        );
        assert!(
            plane.abs() < 0.1 && space.abs() < 0.1,
            "{form}: {plane} and {space} of ρU²"
        );
    }
}

/// At rest relative to each other and without pressure, particles move by the common drift and by their shift alone, which
/// for `every` steps comes in the last of them.
fn engine_and_array<const D: usize>(kernel: KernelName, every: u32) {
    const ACROSS: usize = 12;
    const STEP: f64 = 1e-6;
    const SPEED: f64 = 3.0;
    let (spacing, h) = (1.0 / ACROSS as f64, 1.3 / ACROSS as f64);
    let mut scene = periodic_box::<D>(ACROSS).with(json!({
        "background_pressure": 0.0, "kernel": kernel.as_str(), "time_step": STEP,
        "shifting": {"form": "sun", "free_surface": false, "every": every},
    }));
    let fluid = scene.fluid();
    for (i, u) in fluid.velocity.iter_mut().enumerate() {
        *u = if i % D == 0 { SPEED } else { 0.0 };
    }
    fluid.density.fill(1000.0);
    let mass = fluid.mass.clone();
    let density = fluid.density.clone();
    let start: Vec<[f64; D]> = fluid.position.as_chunks::<D>().0.to_vec();
    let mut simulation = scene.start(Precision::F64, 2);
    let (mut before, steps) = (start.as_flattened().to_vec(), f64::from(every));
    for step in 1..every {
        advance(&mut simulation, 1);
        before = simulation.body("fluid").unwrap().position;
        for (i, (x, y)) in start.as_flattened().iter().zip(&before).enumerate() {
            let drift = if i % D == 0 { SPEED * STEP } else { 0.0 };
            let moved = y - x - f64::from(step) * drift;
            assert!(
                (moved - moved.round()).abs() < 1e-14,
                "step {step}: {moved:e}"
            );
        }
    }
    advance(&mut simulation, 1);
    let end = simulation.body("fluid").unwrap().position;

    let cloud = Cloud::new(&start, &mass, &density, kernel, h, &[Some([0.0, 1.0]); D]);
    let form = Shift::Sun {
        time_step: STEP,
        speed: SPEED,
    };
    let wanted = particle_shift(&cloud, form, spacing, false);
    let mut largest = 0.0f64;
    for ((x, y), shift) in before.chunks_exact(D).zip(end.chunks_exact(D)).zip(&wanted) {
        for a in 0..D {
            let drift = if a == 0 { SPEED * STEP } else { 0.0 };
            let moved = y[a] - x[a] - drift;
            let moved = moved - moved.round();
            assert!(
                (moved - steps * shift[a]).abs() < 1e-12 * spacing,
                "{kernel}, {D}D, every {every}: {moved:e} instead of {:e}",
                steps * shift[a]
            );
            largest = largest.max(shift[a].abs());
        }
    }
    assert!(largest > 1e-7 * spacing, "nothing was shifted: {largest:e}");
}

#[test]
fn the_engine_shifts_as_the_array_function_does() {
    for kernel in KernelName::ALL {
        engine_and_array::<2>(kernel, 1);
        engine_and_array::<3>(kernel, 1);
    }
    engine_and_array::<2>(KernelName::default(), 3);
    engine_and_array::<3>(KernelName::default(), 2);
}
