//! What the guard makes of trouble: it mends what a shorter step mends, stops what it does not, names it, and comes to
//! the same bits however it got there.

mod common;

use common::{Noise, Scene, advance, all_finite, by_id, integers, reals, tank};
use kolk::error::{Error, Instability};
use kolk::simulation::{Entries, Entry, Precision, Simulation};
use serde_json::json;
use std::time::Duration;

/// A tank whose time step is far beyond what sound allows.
fn hasty(courant: f64) -> Scene {
    tank::<2>(20, 14).with(json!({
        "density_diffusion": {"form": "antuono", "delta": 0.1},
        "shifting": {"form": "sun", "free_surface": true},
        "courant": courant,
    }))
}

fn retries(simulation: &Simulation) -> u64 {
    simulation.status().retries.retries.iter().sum()
}

fn unstable(result: Result<(u64, kolk::simulation::Progress), Error>) -> Box<Instability> {
    match result {
        Err(Error::Instability(what)) => what,
        other => panic!("not stopped: {other:?}"),
    }
}

#[test]
fn a_courant_number_too_high_is_mended() {
    for precision in [Precision::F64, Precision::Mixed] {
        let mut simulation = hasty(3.0).start(precision, 1);
        let mut without = hasty(3.0).with(json!({"guard": false})).start(precision, 1);
        let stopped = without.advance(0.5, 5000, Duration::MAX);
        let seen = without.diagnostics();
        assert!(stopped.is_err() || seen.speed_max > 1.0, "{seen:?}");
        simulation.advance(0.5, 5000, Duration::MAX).unwrap();
        let status = simulation.status();
        assert!((status.time - 0.5).abs() < 1e-12);
        assert!(retries(&simulation) > 0 && status.retries.undone > 0);
        let seen = simulation.diagnostics();
        // Still water, hardly moved.
        assert!(
            seen.density_min > 950.0 && seen.density_max < 1050.0,
            "{seen:?}"
        );
        assert!(seen.speed_max < 0.5, "{seen:?}");
    }
}

#[test]
fn trouble_and_its_mending_have_the_same_bits_for_any_threads_and_over_restart() {
    for precision in [Precision::F64, Precision::Mixed] {
        let run = |threads, restarts: bool| {
            let scene = hasty(3.0);
            let mut simulation = scene.start(precision, threads);
            for _ in 0..60 {
                simulation.advance(1e9, 2, Duration::MAX).unwrap();
                if restarts {
                    let state = simulation.save();
                    simulation = scene.start(precision, threads);
                    simulation.restore(&state).unwrap();
                }
            }
            assert!(retries(&simulation) > 0);
            simulation.save()
        };
        let one = run(1, false);
        assert!(one == run(2, false), "{precision:?}: threads");
        assert!(one == run(1, true), "{precision:?}: restart");
    }
}

#[test]
fn a_time_that_was_reached_is_never_taken_back() {
    let mut simulation = hasty(3.0).start(Precision::F64, 1);
    let mut reached = 0.0;
    for k in 1..40 {
        let target = 0.01 * f64::from(k);
        simulation.advance(target, u64::MAX, Duration::MAX).unwrap();
        assert_eq!(simulation.status().time, target);
        assert!(simulation.status().kept == Some(target));
        reached = target;
    }
    assert!(retries(&simulation) > 0 && reached > 0.3);
}

#[test]
fn what_cannot_be_mended_stops_with_the_last_good_state() {
    // Sound so slow that the fluid cannot bear its own weight.
    let mut simulation = tank::<2>(20, 30)
        .with(json!({"sound_speed": 0.5}))
        .start(Precision::F64, 1);
    let stopped = unstable(simulation.advance(5.0, 100_000, Duration::MAX));
    assert_eq!(stopped.quantity, "density");
    assert!(stopped.cause.contains("sound speed") && stopped.remedy.contains("sound_speed"));
    assert!(stopped.value < 500.0 || stopped.value > 1500.0, "{stopped}");
    let status = simulation.status();
    assert!(status.time <= stopped.time);
    assert!(all_finite(&simulation.save()));
    let seen = simulation.diagnostics();
    assert!(
        seen.density_min > 500.0 && seen.density_max < 1500.0,
        "{seen:?}"
    );
    // The state left can be saved, taken over and continued, to stop again.
    let state = simulation.save();
    let mut again = tank::<2>(20, 30)
        .with(json!({"sound_speed": 0.5}))
        .start(Precision::F64, 1);
    again.restore(&state).unwrap();
    unstable(again.advance(5.0, 100_000, Duration::MAX));
}

/// Sets the number of some particle in a checkpoint; gives the particle's id.
fn spoil(state: &mut Entries, name: &str, index: usize, value: f64) -> usize {
    let id = integers(state, "id")[index] as usize;
    match &mut state.iter_mut().find(|(n, _)| n == name).unwrap().1 {
        Entry::Reals(values) => values[index] = value,
        Entry::Integers(_) => panic!("{name} holds integers"),
    }
    id
}

#[test]
fn a_number_that_is_none_is_named_in_any_array_at_any_step() {
    let mut noise = Noise(7);
    for method in ["adami", "dynamic"] {
        let scene = hasty(0.5).with(json!({"wall": {"method": method, "slip": "no"}}));
        for precision in [Precision::F64, Precision::Mixed] {
            let mut simulation = scene.start(precision, 2);
            for step in [0u64, 1, 7, 30] {
                let done = simulation.status().step;
                advance(&mut simulation, step - done);
                let good = simulation.save();
                let columns: Vec<String> = good
                    .iter()
                    .filter(|(name, entry)| {
                        matches!(entry, Entry::Reals(v) if v.len() > 8)
                            && !name.starts_with("guard")
                            // Sums of what was, of which nothing comes.
                            && name != "budget"
                    })
                    .map(|(name, _)| name.clone())
                    .collect();
                assert!(columns.len() > 10, "{columns:?}");
                for name in &columns {
                    for value in [f64::NAN, f64::INFINITY] {
                        let n = reals(&good, name).len();
                        let index = ((0.5 + 0.5 * noise.number()) * (n - 1) as f64) as usize;
                        let mut bad = good.clone();
                        let what =
                            format!("{name} = {value}, {method}, {precision:?}, step {step}");
                        let wall = name.starts_with("wall");
                        let id = if wall {
                            match &mut bad.iter_mut().find(|(n, _)| n == name).unwrap().1 {
                                Entry::Reals(values) => values[index] = value,
                                Entry::Integers(_) => unreachable!(),
                            }
                            None
                        } else {
                            Some(spoil(&mut bad, name, index, value))
                        };
                        simulation.restore(&bad).unwrap();
                        // Handed on before anyone has looked: still found. But for masses, of which those from before
                        // are handed on.
                        if !name.ends_with("mass") {
                            let handed = simulation.save();
                            simulation.restore(&handed).unwrap();
                        }
                        let found = unstable(simulation.advance(1e9, 1, Duration::MAX));
                        assert_eq!(found.step, step, "{what}");
                        assert!(!found.value.is_finite(), "{what}: {found}");
                        assert_eq!(found.quantity.contains("wall"), wall, "{what}: {found}");
                        if let Some(id) = id {
                            assert_eq!(found.particle as usize, id, "{what}: {found}");
                        }
                        // What is left is the state kept before.
                        assert!(all_finite(&simulation.save()), "{what}");
                        simulation.advance(1e9, 2, Duration::MAX).unwrap();
                        simulation.restore(&good).unwrap();
                    }
                }
            }
        }
    }
}

#[test]
fn a_mass_that_is_none_is_named() {
    for value in [0.0, -1.0] {
        let mut simulation = hasty(0.5).start(Precision::Mixed, 1);
        advance(&mut simulation, 3);
        let mut state = simulation.save();
        let id = spoil(&mut state, "mass", 50, value);
        simulation.restore(&state).unwrap();
        let found = unstable(simulation.advance(1e9, 1, Duration::MAX));
        assert_eq!((found.quantity, found.particle as usize), ("mass", id));
    }
}

#[test]
fn a_kick_from_outside_stays_and_shortens_the_step() {
    // Faster than the step before allows: what is taken back is the step, not the kick.
    let mut simulation = hasty(0.5).start(Precision::F64, 1);
    advance(&mut simulation, 10);
    let mut state = simulation.save();
    let ids = integers(&state, "id").to_vec();
    for index in 0..ids.len() {
        let speed = reals(&state, "velocity_0")[index];
        spoil(&mut state, "velocity_0", index, speed + 100.0);
    }
    simulation.restore(&state).unwrap();
    let before = simulation.status();
    simulation.advance(1e9, 3, Duration::MAX).unwrap();
    let after = simulation.status();
    assert!(retries(&simulation) > 0);
    assert!(after.time_step < 0.5 * before.time_step);
    let speeds = by_id(&simulation.save(), "velocity_0");
    let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
    assert!(mean > 50.0, "{mean}");
}

#[test]
fn a_calm_run_is_left_alone() {
    for precision in [Precision::F64, Precision::Mixed] {
        let mut simulation = hasty(0.5).start(precision, 1);
        simulation.advance(1.0, 100_000, Duration::MAX).unwrap();
        let record = simulation.status().retries;
        assert_eq!(record, kolk::simulation::Retries::default());
    }
}

#[test]
fn without_a_guard_there_is_no_memory_of_it() {
    let bytes = |on: bool| {
        let scene = tank::<3>(10, 8).with(json!({"guard": on}));
        let simulation = scene.start(Precision::Mixed, 1);
        let memory = simulation.memory();
        let n = simulation.status().fluid;
        (
            memory.iter().find(|(name, _)| *name == "guard").unwrap().1,
            n,
        )
    };
    assert_eq!(bytes(false).0, 0);
    let (held, n) = bytes(true);
    // Positions, velocities, density, and the order; and some room behind each column.
    assert!(held >= 60 * n && held <= 60 * n + 2048, "{held} for {n}");
}

#[test]
fn a_state_of_a_run_without_guard_is_taken_over_with_one_and_back() {
    let with = hasty(0.5);
    let without = with.clone().with(json!({"guard": false}));
    let (mut a, mut b) = (
        with.start(Precision::F64, 1),
        without.start(Precision::F64, 1),
    );
    advance(&mut a, 20);
    advance(&mut b, 20);
    let (from_a, from_b) = (a.save(), b.save());
    a.restore(&from_b).unwrap();
    b.restore(&from_a).unwrap();
    advance(&mut a, 20);
    advance(&mut b, 20);
    assert_eq!(
        by_id(&a.save(), "position_1"),
        by_id(&b.save(), "position_1")
    );
}

#[test]
fn the_closest_pair_and_the_crowded_are_those_of_all_pairs() {
    use common::periodic_box;
    for scene in [
        tank::<2>(14, 10),
        periodic_box::<2>(12),
        periodic_box::<2>(5),
    ] {
        check_crowding::<2>(scene);
    }
    for scene in [tank::<3>(7, 6), periodic_box::<3>(6)] {
        check_crowding::<3>(scene);
    }
}

fn check_crowding<const D: usize>(mut scene: Scene) {
    let spacing = scene.configuration().spacing;
    // Each pulled towards the origin of its cell, by chance up to most of the way: all distances occur.
    let mut noise = Noise(3);
    for x in &mut scene.fluid().position {
        *x += 0.45 * spacing * noise.number();
    }
    let periods = scene.configuration().period::<D>();
    let mut simulation = scene.with(json!({"guard": false})).start(Precision::F64, 2);
    // A step so short that nothing moves: particles are sorted, and what is read is what was given.
    simulation.advance(1e-12, 1, Duration::MAX).unwrap();
    let state = simulation.save();
    let x: Vec<Vec<f64>> = (0..D)
        .map(|a| by_id(&state, &format!("position_{a}")))
        .collect();
    let n = x[0].len();
    let mut nearest = vec![f64::INFINITY; n];
    for i in 0..n {
        for j in 0..i {
            let mut r2 = 0.0;
            for a in 0..D {
                let mut d = x[a][i] - x[a][j];
                if let Some([low, high]) = periods[a] {
                    d -= (d / (high - low)).round() * (high - low);
                }
                r2 += d * d;
            }
            nearest[i] = nearest[i].min(r2.sqrt() / spacing);
            nearest[j] = nearest[j].min(r2.sqrt() / spacing);
        }
    }
    let closest = nearest.iter().copied().fold(f64::INFINITY, f64::min);
    let crowded = nearest.iter().filter(|&&d| d < 0.5).count();
    let seen = simulation.diagnostics();
    assert!(crowded > 5 && crowded < n);
    assert_eq!(seen.crowded as usize, crowded);
    assert!(
        (seen.closest_pair - closest).abs() < 1e-9,
        "{} or {closest}",
        seen.closest_pair
    );
}
