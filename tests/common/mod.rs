//! Small scenes for tests and benches of the engine.
// Every test binary uses a part of it, and is a crate from which nothing can be reached.
#![allow(dead_code, unreachable_pub)]

pub mod disorder;
pub mod faces;

use kolk::kernel::KernelName;
use kolk::operators::Cloud;
use kolk::particles::Given;
use kolk::simulation::{BodyInput, Config, Entries, Entry, Precision, Simulation};
use serde_json::{Value, json};
use std::time::Duration;

/// A generator of numbers in -1..1, the same in every run.
pub struct Noise(pub u64);

impl Noise {
    /// The next number.
    pub fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A scene: what [`Simulation::new`] takes.
#[derive(Clone)]
pub struct Scene {
    /// The configuration, to be changed by key.
    pub config: Value,
    /// The particles.
    pub bodies: Vec<BodyInput>,
}

impl Scene {
    /// The scene with other values of some keys.
    pub fn with(mut self, changes: Value) -> Self {
        for (key, value) in changes.as_object().expect("an object") {
            self.config[key] = value.clone();
        }
        self
    }

    /// The configuration.
    pub fn configuration(&self) -> Config {
        serde_json::from_value(self.config.clone()).expect("a configuration")
    }

    /// The simulation of this scene.
    pub fn start(&self, precision: Precision, threads: usize) -> Simulation {
        Simulation::new(
            self.configuration(),
            self.bodies.clone(),
            precision,
            threads,
        )
        .expect("a good scene")
    }

    /// The fluid's particles.
    pub fn fluid(&mut self) -> &mut Given {
        &mut self.bodies[0].particles
    }
}

/// Takes `steps` steps.
pub fn advance(simulation: &mut Simulation, steps: u64) {
    let (taken, _) = simulation
        .advance(1e9, steps, Duration::MAX)
        .expect("a stable run");
    assert_eq!(taken, steps);
}

/// The real numbers of a checkpoint's entry.
pub fn reals<'a>(entries: &'a Entries, name: &str) -> &'a [f64] {
    match &entries.iter().find(|(n, _)| n == name).expect(name).1 {
        Entry::Reals(values) => values,
        Entry::Integers(_) => panic!("{name} holds integers"),
    }
}

/// The integers of a checkpoint's entry.
pub fn integers<'a>(entries: &'a Entries, name: &str) -> &'a [u64] {
    match &entries.iter().find(|(n, _)| n == name).expect(name).1 {
        Entry::Integers(values) => values,
        Entry::Reals(_) => panic!("{name} holds reals"),
    }
}

/// A column of a checkpoint in the order in which the particles were given.
pub fn by_id(entries: &Entries, name: &str) -> Vec<f64> {
    let (values, ids) = (reals(entries, name), integers(entries, "id"));
    let mut column = vec![0.0; values.len()];
    for (value, &id) in values.iter().zip(ids) {
        column[id as usize] = *value;
    }
    column
}

/// Whether all real numbers of a checkpoint are finite.
pub fn all_finite(entries: &Entries) -> bool {
    entries.iter().all(|(_, e)| match e {
        Entry::Reals(values) => values.iter().all(|v| v.is_finite()),
        Entry::Integers(_) => true,
    })
}

/// Says which entry of two checkpoints differs first in its bits.
pub fn assert_same_bits(a: &Entries, b: &Entries, what: &str) {
    assert_eq!(a.len(), b.len(), "{what}");
    for ((name, x), (other, y)) in a.iter().zip(b) {
        assert_eq!(name, other);
        let same = match (x, y) {
            (Entry::Reals(x), Entry::Reals(y)) => x
                .iter()
                .map(|x| x.to_bits())
                .eq(y.iter().map(|y| y.to_bits())),
            (x, y) => x == y,
        };
        assert!(same, "{what}: {name} differs");
    }
}

/// Points of a lattice of `count` nodes per axis from `from`, each displaced by up to `jitter` spacings.
pub fn lattice<const D: usize>(
    from: [f64; D],
    count: [usize; D],
    spacing: f64,
    jitter: f64,
) -> Vec<[f64; D]> {
    let mut noise = Noise(7);
    (0..count.iter().product())
        .map(|k: usize| {
            let mut rest = k;
            std::array::from_fn(|a| {
                let node = rest % count[a];
                rest /= count[a];
                from[a] + spacing * (node as f64 + 0.5 + jitter * noise.number())
            })
        })
        .collect()
}

/// `side`^D points of the unit cube's lattice, each displaced by up to `jitter` spacings.
pub fn points<const D: usize>(side: usize, jitter: f64) -> Vec<[f64; D]> {
    lattice([0.0; D], [side; D], 1.0 / side as f64, jitter)
}

/// Runs `test` on a cloud of density 1000 and of masses that differ by a tenth.
pub fn with_cloud<const D: usize>(
    position: &[[f64; D]],
    spacing: f64,
    periodic: bool,
    kernel: KernelName,
    test: impl FnOnce(&Cloud<D>),
) {
    let mut noise = Noise(3);
    let density = vec![1000.0; position.len()];
    let mass: Vec<f64> = (0..position.len())
        .map(|_| {
            1000.0
                * spacing.powi(D as i32)
                * (1.0 + if periodic { 0.0 } else { 0.05 * noise.number() })
        })
        .collect();
    let periods = [periodic.then_some([0.0, 1.0]); D];
    test(&Cloud::new(
        position,
        &mass,
        &density,
        kernel,
        1.5 * spacing,
        &periods,
    ));
}

/// A body of particles at `position` with velocity and density as functions of it, and masses of a lattice.
pub fn body<const D: usize>(
    name: &str,
    fluid: bool,
    spacing: f64,
    position: &[[f64; D]],
    velocity: impl Fn(&[f64; D]) -> [f64; D],
    density: impl Fn(&[f64; D]) -> f64,
) -> BodyInput {
    let particles = Given {
        position: position.as_flattened().to_vec(),
        velocity: position.iter().flat_map(velocity).collect(),
        density: position.iter().map(density).collect(),
        mass: vec![1000.0 * spacing.powi(D as i32); position.len()],
    };
    BodyInput {
        name: name.to_owned(),
        fluid,
        particles,
    }
}

fn base(dimension: usize, spacing: f64) -> Value {
    json!({
        "dimension": dimension, "spacing": spacing, "smoothing_length": 1.3 * spacing,
        "reference_density": 1000.0, "sound_speed": 20.0,
    })
}

/// A disc or ball of about `across` particles in diameter that turns and stretches, with nothing around it.
pub fn free_drop<const D: usize>(across: usize) -> Scene {
    let spacing = 1.0 / across as f64;
    let mut position = lattice([-0.5; D], [across; D], spacing, 0.1);
    position.retain(|x| x.iter().map(|x| x * x).sum::<f64>() < 0.25);
    let velocity = |x: &[f64; D]| {
        // A turn about the last axis, a stretch, and a drift.
        std::array::from_fn(|a| match a {
            0 => -1.5 * x[1] + 0.5 * x[0] + 0.3,
            1 => 1.5 * x[0] - 0.5 * x[1] - 0.2,
            _ => 0.4 * x[0] + 0.1,
        })
    };
    let fluid = body("drop", true, spacing, &position, velocity, |x| {
        1000.0 + 2.0 * x[0]
    });
    Scene {
        config: base(D, spacing),
        bodies: vec![fluid],
    }
    .with(json!({"artificial_viscosity": {"alpha": 0.02, "beta": 0.04}}))
}

/// A tank of `across` particles per horizontal axis and `deep` up, filled and under gravity; the walls have four
/// layers. The fluid starts out of order and moving.
pub fn tank<const D: usize>(across: usize, deep: usize) -> Scene {
    tank_of::<D>(across, deep, 0.01, 0.1)
}

/// A [`tank`] with another spacing in m, its particles displaced by up to `jitter` spacings.
pub fn tank_of<const D: usize>(across: usize, deep: usize, spacing: f64, jitter: f64) -> Scene {
    const LAYERS: usize = 4;
    let mut count = [across; D];
    count[D - 1] = deep;
    let extent = count.map(|n| n as f64 * spacing);
    let depth = extent[D - 1];
    let position = lattice([0.0; D], count, spacing, jitter);
    let outside = -(LAYERS as f64) * spacing;
    let mut wall = lattice([outside; D], count.map(|n| n + 2 * LAYERS), spacing, 0.0);
    wall.retain(|x| {
        x[D - 1] < depth + 2.0 * spacing && (0..D).any(|a| x[a] < 0.0 || x[a] > extent[a])
    });
    wall.retain(|x| x[D - 1] < 0.0 || (0..D - 1).any(|a| x[a] < 0.0 || x[a] > extent[a]));
    let velocity = |x: &[f64; D]| {
        let mut u = [0.0; D];
        u[0] = 0.1 * (x[D - 1] / depth);
        u
    };
    let hydrostatic = |x: &[f64; D]| {
        let pressure = 1000.0 * 9.81 * (depth - x[D - 1]).max(0.0);
        1000.0 * (1.0 + 7.0 * pressure / (400.0 * 1000.0)).powf(1.0 / 7.0)
    };
    let fluid = body("water", true, spacing, &position, velocity, hydrostatic);
    let walls = body("tank", false, spacing, &wall, |_| [0.0; D], |_| 1000.0);
    let mut gravity = vec![0.0; D];
    gravity[D - 1] = -9.81;
    Scene {
        config: base(D, spacing),
        bodies: vec![fluid, walls],
    }
    .with(json!({
        "gravity": gravity,
        "artificial_viscosity": {"alpha": 0.02},
        "wall": {"method": "adami", "slip": "free"},
    }))
}

/// A periodic box of `across` particles per axis with a shear wave along the first axis.
pub fn periodic_box<const D: usize>(across: usize) -> Scene {
    let spacing = 1.0 / across as f64;
    let position = lattice([0.0; D], [across; D], spacing, 0.2);
    let wave = |x: f64| (std::f64::consts::TAU * x).sin();
    let velocity = |x: &[f64; D]| {
        let mut u = [0.0; D];
        u[0] = wave(x[1]);
        u[1] = 0.5 * wave(x[0]);
        u
    };
    let fluid = body("fluid", true, spacing, &position, velocity, |x| {
        1000.0 + wave(x[0]) * 3.0
    });
    let axis = json!([0.0, 1.0]);
    Scene {
        config: base(D, spacing),
        bodies: vec![fluid],
    }
    .with(json!({
        "periodic": vec![axis; D],
        "background_pressure": 4000.0,
    }))
}
