//! Shifts that take the fields along: against their formulae, and what they keep.

mod common;

use common::{Scene, advance, assert_same_bits, free_drop, periodic_box};
use kolk::kernel::KernelName;
use kolk::operators::Cloud;
use kolk::simulation::{BodyState, Precision, Simulation};
use serde_json::{Value, json};

const ACROSS: usize = 14;
const SPACING: f64 = 1.0 / ACROSS as f64;
const H: f64 = 1.3 * SPACING;
const STEP: f64 = 1e-7;

fn shifted(form: &str) -> Value {
    json!({"shifting": {"form": form, "free_surface": false}})
}

/// A periodic box of waves of velocity and density with one tiny step, in which nothing moves by much.
fn waves<const D: usize>() -> Scene {
    periodic_box::<D>(ACROSS).with(json!({"background_pressure": 0.0, "time_step": STEP}))
}

/// The fluid after a step.
fn stepped(scene: &Scene) -> BodyState {
    let mut simulation = scene.start(Precision::F64, 2);
    advance(&mut simulation, 1);
    simulation.body("fluid").unwrap()
}

fn vectors<const D: usize>(flat: &[f64]) -> &[[f64; D]] {
    flat.as_chunks::<D>().0
}

/// The ways from the particles of one state to those of another, over the period.
fn ways(from: &BodyState, to: &BodyState) -> Vec<f64> {
    let both = to.position.iter().zip(&from.position);
    both.map(|(a, b)| (a - b) - (a - b).round()).collect()
}

fn length<const D: usize>(v: &[f64; D]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|k| a[k] * b[k]).sum()
}

/// Checks `a - b`, component by component, to a share of the largest wanted: particles do move in the step.
fn assert_difference(a: &[f64], b: &[f64], wanted: &[f64], what: &str) {
    let largest = wanted.iter().fold(0.0f64, |m, w| m.max(w.abs()));
    assert!(largest > 1e-12, "{what}: {largest}");
    for (k, wanted) in wanted.iter().enumerate() {
        let found = a[k] - b[k];
        assert!(
            (found - wanted).abs() < 1e-4 * largest,
            "{what}: {found:e} for {wanted:e} of {largest:e}"
        );
    }
}

/// The sum over pairs `Σ V_j term(i, j, r_ij F_ij)`.
fn pair_sum<const D: usize, const K: usize>(
    cloud: &Cloud<D>,
    term: impl Fn(usize, usize, &[f64; D]) -> [f64; K],
) -> Vec<[f64; K]> {
    (0..cloud.len())
        .map(|i| {
            let mut sum = [0.0; K];
            cloud.for_each_neighbour(i, |j, d, _, slope| {
                let term = term(i, j, &d.map(|d| d * slope));
                for k in 0..K {
                    sum[k] += cloud.volume[j] * term[k];
                }
            });
            sum
        })
        .collect()
}

fn consistent<const D: usize>() {
    let mut scene = waves::<D>();
    let plain = stepped(&scene.clone().with(shifted("sun")));
    let moved = ways(&stepped(&scene), &plain);
    let taken = stepped(&scene.clone().with(shifted("consistent")));
    assert_eq!(plain.position, taken.position);
    let given = scene.fluid();
    let (x, u) = (vectors::<D>(&given.position), vectors::<D>(&given.velocity));
    let (mass, rho) = (&given.mass, &given.density);
    let periods = [Some([0.0, 1.0]); D];
    let cloud = Cloud::new(x, mass, rho, KernelName::WendlandC2, H, &periods);
    let shift = vectors::<D>(&moved);
    let along = |i: usize, j: usize, w: &[f64; D]| 0.5 * (dot(&shift[i], w) + dot(&shift[j], w));
    let mut change = pair_sum(&cloud, |i, j, w| -> [f64; D] {
        std::array::from_fn(|a| (u[j][a] - u[i][a]) * along(i, j, w))
    });
    let thicker = pair_sum(&cloud, |i, j, w| [(rho[j] - rho[i]) * along(i, j, w)]);
    assert_difference(
        &taken.density,
        &plain.density,
        thicker.as_flattened(),
        &format!("density, {D}D"),
    );
    // Freed of their momentum, by the least change.
    let weight: f64 = change.iter().zip(mass).map(|(c, m)| m * length(c)).sum();
    let momentum: [f64; D] =
        std::array::from_fn(|a| change.iter().zip(mass).map(|(c, m)| m * c[a]).sum());
    assert!(length(&momentum) > 1e-3 * weight, "nothing to be freed of");
    for c in &mut change {
        let share = length(c) / weight;
        *c = std::array::from_fn(|a| c[a] - share * momentum[a]);
    }
    assert_difference(
        &taken.velocity,
        &plain.velocity,
        change.as_flattened(),
        &format!("velocity, {D}D"),
    );
}

#[test]
fn consistent_shifts_take_velocity_and_density_along() {
    consistent::<2>();
    consistent::<3>();
}

fn transport_velocity<const D: usize>() {
    const C0: f64 = 20.0;
    let mut scene = waves::<D>();
    let (plain, moved) = (
        stepped(&scene),
        stepped(&scene.clone().with(shifted("transport-velocity"))),
    );
    let given = scene.fluid();
    let (x, u) = (vectors::<D>(&given.position), vectors::<D>(&given.velocity));
    let (mass, rho) = (&given.mass, &given.density);
    let periods = [Some([0.0, 1.0]); D];
    let cloud = Cloud::new(x, mass, rho, KernelName::WendlandC2, H, &periods);
    let strength = (C0 * STEP).powi(2);
    let shift = pair_sum(&cloud, |_, _, w| w.map(|w| -strength * w));
    let apart = ways(&plain, &moved);
    let none = vec![0.0; apart.len()];
    assert_difference(&apart, &none, shift.as_flattened(), &format!("place, {D}D"));
    let stress = pair_sum(&cloud, |i, j, w| -> [f64; D] {
        let (ours, theirs) = (rho[i] * dot(&shift[i], w), rho[j] * dot(&shift[j], w));
        std::array::from_fn(|a| (ours * u[i][a] + theirs * u[j][a]) / rho[i])
    });
    assert_difference(
        &moved.velocity,
        &plain.velocity,
        stress.as_flattened(),
        &format!("stress, {D}D"),
    );
}

#[test]
fn the_transport_velocity_is_that_of_the_background_pressure() {
    transport_velocity::<2>();
    transport_velocity::<3>();
}

#[test]
fn a_uniform_flow_stays_uniform_whatever_is_shifted() {
    let mut scene = waves::<2>().with(shifted("consistent"));
    let fluid = scene.fluid();
    fluid.density.fill(1000.0);
    for (k, u) in fluid.velocity.iter_mut().enumerate() {
        *u = [3.0, -2.0][k % 2];
    }
    let found = stepped(&scene);
    for u in vectors::<2>(&found.velocity) {
        assert!(length(&[u[0] - 3.0, u[1] + 2.0]) < 1e-13, "{u:?}");
    }
}

/// Momentum and angular momentum.
fn momenta(simulation: &Simulation) -> Vec<f64> {
    let found = simulation.diagnostics();
    [found.momentum, found.angular_momentum].concat()
}

fn assert_kept(before: &[f64], after: &[f64], scale: f64, what: &str) {
    for (a, b) in before.iter().zip(after) {
        assert!((a - b).abs() < 1e-12 * scale, "{what}: {a} became {b}");
    }
}

fn momentum<const D: usize>() {
    for form in ["consistent", "transport-velocity"] {
        let scene = periodic_box::<D>(ACROSS).with(shifted(form));
        let mut simulation = scene.start(Precision::F64, 2);
        let before = momenta(&simulation);
        advance(&mut simulation, 20);
        let after = momenta(&simulation);
        // The mass is 1000 kg, the speed about 1 m/s.
        assert_kept(&before[..D], &after[..D], 1000.0, form);
    }
    let scene = free_drop::<D>(16).with(json!({"shifting": {"form": "consistent"}}));
    let mut simulation = scene.start(Precision::F64, 2);
    let before = momenta(&simulation);
    advance(&mut simulation, 20);
    assert_kept(&before, &momenta(&simulation), 1000.0, "free drop");
}

#[test]
fn what_is_taken_along_keeps_momentum_to_rounding() {
    momentum::<2>();
    momentum::<3>();
}

#[test]
fn transported_runs_have_the_same_bits_with_any_threads_and_over_a_restart() {
    for form in ["consistent", "transport-velocity"] {
        for precision in [Precision::F64, Precision::Mixed] {
            let scene = periodic_box::<2>(40).with(shifted(form));
            let run = |threads: usize, steps: u64| {
                let mut simulation = scene.start(precision, threads);
                advance(&mut simulation, steps);
                simulation
            };
            let whole = run(1, 16).save();
            assert_same_bits(&whole, &run(3, 16).save(), form);
            let half = run(2, 8).save();
            let mut rest = run(2, 1);
            rest.restore(&half).unwrap();
            advance(&mut rest, 8);
            assert_same_bits(&whole, &rest.save(), form);
        }
    }
}

#[test]
fn a_background_pressure_is_refused_under_a_free_surface() {
    let scene = free_drop::<2>(10).with(json!({"shifting": {"form": "transport-velocity"}}));
    let found = Simulation::new(
        scene.configuration(),
        scene.bodies.clone(),
        Precision::F64,
        1,
    );
    let message = found.err().unwrap().to_string();
    assert!(
        message.contains("transport-velocity") && message.contains("free surface"),
        "{message}"
    );
}
