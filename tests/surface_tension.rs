//! Surface tension: the balance with an even pressure, momentum, bits. Oscillating drops: tests/python/test_surface_tension.py.

mod common;

use common::disorder::rates;
use common::{Noise, Scene, advance, assert_same_bits, body, by_id};
use kolk::simulation::Precision;
use serde_json::json;

const RHO: f64 = 1000.0;
const TENSION: f64 = 0.072;
const SOUND: f64 = 4.0;

/// Points on rings in 2D, on shells in 3D, a spacing apart: as round as a drop can be.
fn round<const D: usize>(across: usize, spacing: f64) -> Vec<[f64; D]> {
    let golden = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    let mut points = Vec::new();
    for shell in 0..across {
        let r = (shell as f64 + 0.5) * spacing;
        let around = std::f64::consts::TAU * r / spacing;
        let count = if D == 2 {
            around.round()
        } else {
            (around * 2.0 * r / spacing).round()
        };
        for k in 0..count as usize {
            let part = (k as f64 + 0.5) / count;
            let (angle, height) = if D == 2 {
                (std::f64::consts::TAU * part + shell as f64, 0.0)
            } else {
                (golden * k as f64 + shell as f64, 1.0 - 2.0 * part)
            };
            let (sine, cosine) = angle.sin_cos();
            let level = r * (1.0 - height * height).sqrt();
            points.push(std::array::from_fn(|a| {
                [level * cosine, level * sine, r * height][a]
            }));
        }
    }
    points
}

/// A round drop of radius 1 mm and `across` spacings, of particles displaced by up to `jitter` spacings, at the pressure `p`,
/// squeezed along the first axis by the factor `1 - squeeze`.
fn drop<const D: usize>(across: usize, jitter: f64, p: f64, squeeze: f64) -> Scene {
    let radius = 1e-3;
    let spacing = radius / across as f64;
    let mut position = round::<D>(across, spacing);
    let mut noise = Noise(3);
    for x in &mut position {
        for x in x.iter_mut() {
            *x += jitter * spacing * noise.number();
        }
        x[0] *= 1.0 - squeeze;
    }
    let density = RHO + p / (SOUND * SOUND);
    let mut drop = body(
        "drop",
        true,
        spacing,
        &position,
        |_| [0.0; D],
        move |_| density,
    );
    for mass in &mut drop.particles.mass {
        *mass = density * spacing.powi(D as i32);
    }
    let config = json!({
        "dimension": D, "spacing": spacing, "smoothing_length": if D == 2 { 2.0 } else { 1.7 } * spacing,
        "reference_density": RHO, "sound_speed": SOUND, "eos": "linear",
    });
    Scene {
        config,
        bodies: vec![drop],
    }
}

fn accelerations<const D: usize>(scene: &Scene) -> Vec<[f64; D]> {
    let entries = rates(scene);
    let columns: [Vec<f64>; D] =
        std::array::from_fn(|a| by_id(&entries, &format!("acceleration_{a}")));
    (0..columns[0].len())
        .map(|i| std::array::from_fn(|a| columns[a][i]))
        .collect()
}

/// What the tension alone gives particles at no pressure.
fn tension<const D: usize>(across: usize, jitter: f64, squeeze: f64) -> (Scene, Vec<[f64; D]>) {
    let scene = drop::<D>(across, jitter, 0.0, squeeze);
    let with = scene.clone().with(json!({"surface_tension": TENSION}));
    let found = accelerations(&with);
    assert!(
        accelerations::<D>(&scene)
            .iter()
            .flatten()
            .all(|a| a.abs() < 1e-9)
    );
    (scene, found)
}

/// The pressure that balances the tension of a round drop, over `(D - 1) σ/R`, and what is then left of the acceleration of
/// particles, over that of the tension (RMS).
fn balance<const D: usize>(across: usize) -> (f64, f64) {
    let exact = (D as f64 - 1.0) * TENSION / 1e-3;
    let (_, inwards) = tension::<D>(across, 0.0, 0.0);
    let outwards = accelerations::<D>(&drop::<D>(across, 0.0, exact, 0.0));
    let (mut both, mut square) = (0.0, 0.0);
    for (a, b) in inwards.iter().zip(&outwards) {
        for k in 0..D {
            both -= a[k] * b[k];
            square += b[k] * b[k];
        }
    }
    let share = both / square;
    let (mut left, mut all) = (0.0, 0.0);
    for (a, b) in inwards.iter().zip(&outwards) {
        for k in 0..D {
            left += (a[k] + share * b[k]).powi(2);
            all += a[k] * a[k];
        }
    }
    (share, (left / all).sqrt())
}

#[test]
fn an_even_pressure_balances_it_particle_by_particle() {
    let found = [balance::<2>(20), balance::<3>(9), balance::<3>(14)];
    let [disc, coarse, ball] = found.map(|(pressure, _)| (pressure - 1.0).abs());
    assert!(disc < 0.04, "disc: {disc}");
    assert!(coarse < 0.15, "ball: {coarse}");
    assert!(ball < coarse, "ball: {ball} is not below {coarse}");
    assert!(found.iter().all(|(_, left)| *left < 0.05), "{found:?}");
}

/// `Σ m a` and `Σ m x × a` over the sums of their lengths.
fn moments<const D: usize>(across: usize) -> (f64, f64) {
    let (scene, acceleration) = tension::<D>(across, 0.15, 0.2);
    let place = &scene.bodies[0].particles.position;
    let (mut momentum, mut turning) = ([0.0; D], [0.0; 3]);
    let (mut length, mut lever) = (0.0, 0.0);
    for (x, a) in place.chunks_exact(D).zip(&acceleration) {
        let size = a.iter().map(|a| a * a).sum::<f64>().sqrt();
        length += size;
        lever += size * x.iter().map(|x| x * x).sum::<f64>().sqrt();
        for k in 0..D {
            momentum[k] += a[k];
            for l in 0..D {
                if k < l {
                    turning[k + l - 1] += x[k] * a[l] - x[l] * a[k];
                }
            }
        }
    }
    let most = |v: &[f64]| v.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    (most(&momentum) / length, most(&turning) / lever)
}

#[test]
fn it_gives_a_liquid_no_momentum_and_no_spin() {
    for (momentum, turning) in [moments::<2>(15), moments::<3>(7)] {
        assert!(momentum < 1e-13, "{momentum}");
        assert!(turning < 1e-13, "{turning}");
    }
}

#[test]
fn an_oval_drop_is_pulled_round() {
    let (scene, acceleration) = tension::<2>(20, 0.0, 0.2);
    let place = &scene.bodies[0].particles.position;
    let along = |k: usize| -> f64 {
        let each = place.chunks_exact(2).zip(&acceleration);
        each.map(|(x, a)| x[k] * a[k]).sum()
    };
    // Along an axis the virial of a surface is -σ ∮ t² ds, with the component t of its tangent: here of an ellipse.
    let (mut exact, steps) = ([0.0; 2], 1000);
    for k in 0..steps {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / f64::from(steps)).sin_cos();
        let tangent = [-0.8 * sine, cosine];
        let length = tangent[0].hypot(tangent[1]);
        for a in 0..2 {
            exact[a] += tangent[a] * tangent[a] / length;
        }
    }
    let (found, wanted) = (along(1) / along(0), exact[1] / exact[0]);
    assert!(wanted > 1.2);
    assert!((found / wanted - 1.0).abs() < 0.05, "{found} and {wanted}");
}

#[test]
fn drops_have_the_same_bits_for_any_number_of_threads_and_over_restart() {
    let numerics = json!({
        "surface_tension": TENSION, "shifting": {"form": "gentle"}, "acoustic_damper": 0.3,
        "density_diffusion": {"form": "antuono", "delta": 0.1}, "artificial_viscosity": {"alpha": 0.02},
    });
    let scenes = [
        drop::<2>(40, 0.2, 0.0, 0.3).with(numerics.clone()),
        drop::<3>(10, 0.2, 0.0, 0.3).with(numerics),
    ];
    for scene in scenes {
        for precision in [Precision::F64, Precision::Mixed] {
            let mut one = scene.start(precision, 1);
            advance(&mut one, 30);
            let mut three = scene.start(precision, 3);
            advance(&mut three, 17);
            let mut again = scene.start(precision, 2);
            again.restore(&three.save()).expect("its own state");
            advance(&mut again, 13);
            assert_same_bits(&one.save(), &again.save(), "surface tension");
        }
    }
}
