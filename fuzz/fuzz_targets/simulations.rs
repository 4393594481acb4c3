//! Any configuration and any particles: refused with a reason, or some steps that leave finite numbers. A checkpoint
//! with any damage is refused or taken over, never a panic.
#![no_main]

use arbitrary::Arbitrary;
use kolk::particles::Given;
use kolk::simulation::{BodyInput, Config, Entry, Precision, Simulation};
use libfuzzer_sys::fuzz_target;
use serde_json::json;
use std::time::Duration;

#[derive(Arbitrary, Debug)]
struct Input {
    fluid: Vec<([f64; 2], [f64; 2], f64, f64)>,
    wall: Vec<([f64; 2], f64)>,
    numbers: [f64; 6],
    choices: [u8; 4],
    mixed: bool,
    damage: Option<(u8, u16, f64, u64)>,
}

fn body(
    name: &str,
    fluid: bool,
    rows: impl Iterator<Item = ([f64; 2], [f64; 2], f64, f64)>,
) -> BodyInput {
    let mut particles = Given::default();
    for (x, v, density, mass) in rows {
        particles.position.extend(x);
        particles.velocity.extend(v);
        particles.density.push(density);
        particles.mass.push(mass);
    }
    BodyInput {
        name: name.to_owned(),
        fluid,
        particles,
    }
}

fuzz_target!(|input: Input| {
    if input.fluid.len() + input.wall.len() > 200 {
        return;
    }
    let [spacing, ratio, sound, gravity, alpha, courant] = input.numbers;
    let [kernel, diffusion, shifting, walls] = input.choices;
    let kernel = [
        "wendland-c2",
        "wendland-c4",
        "wendland-c6",
        "cubic",
        "quintic",
    ][kernel as usize % 5];
    let config = json!({
        "dimension": 2, "spacing": spacing, "smoothing_length": spacing * ratio, "kernel": kernel,
        "gravity": [0.0, gravity], "reference_density": 1000.0, "sound_speed": sound, "courant": courant,
        "artificial_viscosity": {"alpha": alpha},
        "density_diffusion": match diffusion % 4 {
            0 => json!(null),
            k => json!({"form": (["molteni", "antuono", "fourtakas"][k as usize - 1]), "delta": 0.1}),
        },
        "surface_tension": (shifting % 7 == 6).then_some(0.07),
        "shifting": match shifting % 4 {
            0 => json!(null),
            k => json!({"form": (["sun", "lind", "gentle"][k as usize - 1]), "free_surface": true}),
        },
        "wall": {"method": (["adami", "dynamic"][walls as usize % 2]), "slip": "no"},
    });
    let Ok(config) = serde_json::from_value::<Config>(config) else {
        return;
    };
    let bodies = vec![
        body("water", true, input.fluid.into_iter()),
        body(
            "tank",
            false,
            input
                .wall
                .into_iter()
                .map(|(x, m)| (x, [0.0; 2], 1000.0, m)),
        ),
    ];
    let precision = if input.mixed {
        Precision::Mixed
    } else {
        Precision::F64
    };
    let Ok(mut simulation) = Simulation::new(config, bodies, precision, 1) else {
        return;
    };
    if simulation.advance(1e300, 6, Duration::from_secs(5)).is_ok() {
        let state = simulation.body("water").expect("the body just made");
        let numbers = state
            .position
            .iter()
            .chain(&state.velocity)
            .chain(&state.density);
        assert!(numbers.copied().all(f64::is_finite));
    }
    if let Some((entry, index, real, integer)) = input.damage {
        let mut state = simulation.save();
        let k = entry as usize % state.len();
        match &mut state[k].1 {
            Entry::Reals(v) if !v.is_empty() => {
                let i = index as usize % v.len();
                v[i] = real;
            }
            Entry::Integers(v) if !v.is_empty() => {
                let i = index as usize % v.len();
                v[i] = integer;
            }
            _ => {
                state.remove(k);
            }
        }
        if simulation.restore(&state).is_ok() {
            let _ = simulation.advance(1e300, 3, Duration::from_secs(5));
        }
    }
});
