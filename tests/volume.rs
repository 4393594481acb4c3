//! Fluid takes up its volume, however long it has splashed about.

mod common;

use common::tank;
use kolk::simulation::Precision;
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
    for form in ["sun", "lind"] {
        let level = level_after(json!({
            "smoothing_length": 0.02,
            "density_diffusion": {"form": "antuono", "delta": 0.1},
            "acoustic_damper": 0.3,
            "shifting": {"form": form},
        }));
        assert!(
            (level - 1.0).abs() < 0.05,
            "{form}: {level} of the level at rest"
        );
    }
}
