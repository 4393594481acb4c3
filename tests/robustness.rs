//! What must not break a simulation, and what must stop it: particles that fly away, particles in one place, numbers
//! that are none, checkpoints that do not fit.

mod common;

use common::{advance, all_finite, by_id, integers, reals, tank};
use kolk::error::Error;
use kolk::simulation::{Entries, Entry, Precision};
use serde_json::json;
use std::time::Duration;

#[test]
fn a_particle_that_flies_away_breaks_nothing() {
    for precision in [Precision::F64, Precision::Mixed] {
        for distance in [1e3, 1e9, 1e15] {
            let scene = tank::<2>(20, 12)
                .with(json!({"density_diffusion": {"form": "antuono", "delta": 0.1}}));
            let mut near = scene.start(precision, 2);
            let mut simulation = scene.start(precision, 2);
            advance(&mut near, 40);
            advance(&mut simulation, 20);
            let mut state = simulation.save();
            let stray = spoil(&mut state, "position_0", 100, distance);
            simulation.restore(&state).unwrap();
            advance(&mut simulation, 20);
            let end = simulation.save();
            assert!(all_finite(&end), "{distance:e} {precision:?}");
            assert!((by_id(&end, "position_0")[stray] / distance - 1.0).abs() < 1e-3);
            // Who was far from its old place has not noticed.
            let (a, b) = (by_id(&near.save(), "position_1"), by_id(&end, "position_1"));
            let home = by_id(&near.save(), "position_0");
            let others = (0..a.len()).filter(|&i| (home[i] - home[stray]).abs() > 0.12);
            assert!(others.clone().count() > 20);
            for i in others {
                assert!(
                    (a[i] - b[i]).abs() < 1e-6,
                    "{distance:e} {precision:?}: particle {i} at {} or {}",
                    a[i],
                    b[i]
                );
            }
        }
    }
}

#[test]
fn a_scene_with_a_particle_a_million_kilometres_away_runs() {
    let mut scene = tank::<3>(8, 6);
    scene.fluid().position[0] = 1e9;
    scene.fluid().position[7] = -1e9;
    let mut simulation = scene.start(Precision::Mixed, 2);
    advance(&mut simulation, 30);
    assert!(all_finite(&simulation.save()));
    let bytes: usize = simulation.memory().iter().map(|(_, bytes)| bytes).sum();
    assert!(bytes < 4_000_000, "{bytes} bytes");
}

#[test]
fn a_support_of_more_particles_than_memory_holds_is_refused() {
    // Found by fuzzing: the lattice within the support is summed once, and its numbers overflowed.
    let mut config = tank::<2>(20, 12).configuration();
    assert!(config.validate().is_ok());
    config.smoothing_length = 1e9 * config.spacing;
    let refused = config.validate();
    assert!(matches!(refused, Err(Error::Input(text)) if text.starts_with("smoothing_length")));
}

#[test]
fn coincident_particles_stay_finite() {
    for precision in [Precision::F64, Precision::Mixed] {
        for apart in [0.0, 1e-300, 1e-16, 1e-12] {
            for form in ["molteni", "antuono", "fourtakas"] {
                for viscosity in ["artificial", "morris", "monaghan-gingold"] {
                    let laminar = json!({"kinematic": 1e-4, "form": viscosity});
                    let viscosities = match viscosity {
                        "artificial" => {
                            json!({"artificial_viscosity": {"alpha": 0.05, "beta": 0.1}})
                        }
                        _ => json!({"artificial_viscosity": null, "laminar_viscosity": laminar}),
                    };
                    let mut scene = tank::<2>(10, 8).with(viscosities).with(json!({
                        "density_diffusion": {"form": form, "delta": 0.1},
                        "shifting": {"form": "sun", "free_surface": true},
                        "wall": {"method": "adami", "slip": "no"},
                    }));
                    // Two particles of the fluid in one place, one on a wall particle, and a heap of four.
                    let wall = scene.bodies[1].particles.position[..2].to_vec();
                    let x = &mut scene.fluid().position;
                    for (i, j) in [(40, 41), (60, 61), (60, 62), (60, 63)] {
                        (x[2 * i], x[2 * i + 1]) = (x[2 * j] + apart, x[2 * j + 1]);
                    }
                    (x[0], x[1]) = (wall[0] + apart, wall[1]);
                    let what = format!("{apart:e} apart, {precision:?}, {form}, {viscosity}");
                    let mut simulation = scene.start(precision, 1);
                    match simulation.advance(1e9, 4, Duration::MAX) {
                        Ok(_) => assert!(all_finite(&simulation.save()), "{what}"),
                        Err(error) => panic!("{what}: {error}"),
                    }
                }
            }
        }
    }
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
fn what_is_not_a_number_is_found_in_the_same_step_and_blamed_on_its_particle() {
    let mut wrong = Vec::new();
    for (name, quantity) in [
        ("position_1", "position"),
        ("velocity_0", "velocity"),
        ("density", "density"),
    ] {
        for value in [f64::NAN, f64::INFINITY] {
            for precision in [Precision::F64, Precision::Mixed] {
                let scene = tank::<2>(20, 14)
                    .with(json!({"density_diffusion": {"form": "antuono", "delta": 0.1}}));
                let mut simulation = scene.start(precision, 2);
                advance(&mut simulation, 5);
                let mut state = simulation.save();
                let id = spoil(&mut state, name, 170, value);
                // A checkpoint may be refused at once, or the next step stops; both name the particle.
                let refused = simulation.restore(&state).err();
                let stopped = refused.or_else(|| simulation.advance(1e9, 1, Duration::MAX).err());
                let Some(Error::Instability(found)) = stopped else {
                    panic!("{name} = {value} is not found: {stopped:?}");
                };
                assert_eq!(found.step, 5);
                if found.particle as usize != id {
                    wrong.push(format!(
                        "{name} = {value} of particle {id} ({precision:?}, {quantity}) blamed on particle {} ({} = {})",
                        found.particle, found.quantity, found.value
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_checkpoint_that_does_not_fit_is_refused() {
    let mut simulation = tank::<2>(10, 8).start(Precision::F64, 1);
    advance(&mut simulation, 2);
    let good = simulation.save();
    let other = tank::<2>(10, 9).start(Precision::F64, 1).save();
    assert!(simulation.restore(&other).is_err());
    for missing in 0..good.len() {
        let mut bad = good.clone();
        bad.remove(missing);
        assert!(
            simulation.restore(&bad).is_err(),
            "without {}",
            good[missing].0
        );
    }
    let mut bad = good.clone();
    set_integer(&mut bad, "id", 0, 1 << 40);
    assert!(simulation.restore(&bad).is_err());
    let mut bad = good.clone();
    let cells = integers(&good, "cells").len();
    set_integer(&mut bad, "cells", cells / 2, 1 << 20);
    assert!(simulation.restore(&bad).is_err());
    simulation.restore(&good).unwrap();
    advance(&mut simulation, 2);
    assert_eq!(reals(&simulation.save(), "density").len(), 80);
}

fn set_integer(state: &mut Entries, name: &str, index: usize, value: u64) {
    match &mut state.iter_mut().find(|(n, _)| n == name).unwrap().1 {
        Entry::Integers(values) => values[index] = value,
        Entry::Reals(_) => panic!("{name} holds reals"),
    }
}
