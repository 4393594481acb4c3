//! The neighbour search against comparing every point with every other.

use kolk::neighbours::brute::all_pairs;
use kolk::neighbours::search::{Neighbours, Periods, neighbours};
use proptest::prelude::*;
use std::time::Instant;

fn same<const D: usize>(position: &[[f64; D]], radius: f64, periodic: Periods<D>) -> Neighbours {
    let found = neighbours(position, radius, &periodic);
    assert_eq!(found, all_pairs(position, radius, &periodic));
    assert_eq!(found.offsets.len(), position.len() + 1);
    for i in 0..position.len() {
        assert!(
            found.row(i).windows(2).all(|pair| pair[0] < pair[1]),
            "row {i} is not ascending"
        );
        for &j in found.row(i) {
            assert!(
                found.row(j as usize).binary_search(&(i as u32)).is_ok(),
                "{i}-{j} is one-sided"
            );
        }
    }
    found
}

/// Points spread evenly, crowded around few places, in the same places, on a lattice, or far away.
fn points<const D: usize>() -> impl Strategy<Value = Vec<[f64; D]>> {
    let place = || prop::array::uniform::<_, D>(-2.0..3.0_f64);
    let crowded = (place(), prop::array::uniform::<_, D>(-1e-3..1e-3_f64))
        .prop_map(|(x, d): ([f64; D], [f64; D])| std::array::from_fn(|a| x[a].round() + d[a]));
    let node = place().prop_map(|x: [f64; D]| x.map(|x| (4.0 * x).round() / 4.0));
    let far = place().prop_map(|x: [f64; D]| x.map(|x| 1e6 * x));
    let point = prop_oneof![4 => place(), 3 => crowded, 3 => node, 1 => far];
    prop::collection::vec(point, 0..300)
}

fn axis() -> impl Strategy<Value = Option<[f64; 2]>> {
    prop::option::of((-3.0..0.0, 1.6..6.0).prop_map(|(low, period)| [low, low + period]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..Default::default() })]

    #[test]
    fn one_dimension(x in points::<1>(), radius in 0.01..0.8, periodic in prop::array::uniform::<_, 1>(axis())) {
        same(&x, radius, periodic);
    }

    #[test]
    fn two_dimensions(x in points::<2>(), radius in 0.01..0.8, periodic in prop::array::uniform::<_, 2>(axis())) {
        same(&x, radius, periodic);
    }

    #[test]
    fn three_dimensions(x in points::<3>(), radius in 0.01..0.8, periodic in prop::array::uniform::<_, 3>(axis())) {
        same(&x, radius, periodic);
    }

    #[test]
    fn a_radius_beyond_everything(x in points::<2>()) {
        same(&x, 1e8, [None; 2]);
    }

    #[test]
    fn a_radius_that_ends_on_lattice_nodes(shift in -1e3..1e3_f64, periodic in any::<bool>()) {
        let x: Vec<[f64; 2]> =
            (0..144).map(|k| [shift + 0.25 * f64::from(k % 12), 0.25 * f64::from(k / 12)]).collect();
        same(&x, 0.5, [periodic.then_some([shift, shift + 3.0]), None]);
    }
}

#[test]
fn coincident_points_are_neighbours_of_each_other_but_not_of_themselves() {
    let found = same(&[[0.5, 0.5]; 4], 0.1, [None; 2]);
    assert_eq!(found.row(2), [0, 1, 3]);
}

#[test]
fn periodic_axes_join_their_ends() {
    let x = [[0.05], [0.95], [0.5], [1.05], [-7.96]];
    let found = same(&x, 0.11, [Some([0.0, 1.0])]);
    assert_eq!(found.row(0), [1, 3, 4]);
    assert!(found.row(2).is_empty());
}

#[test]
fn points_a_million_billion_periods_away_are_where_they_are_in_the_period() {
    // Found by fuzzing: cell and distance were rounded to different places.
    let x = [[2_251_799_280_436_250.0], [0.0], [-3e15], [0.5], [1e300]];
    let found = same(&x, 0.125, [Some([0.0, 1.0])]);
    assert_eq!(found.row(1), [0, 2, 4]);
    assert!(found.row(3).is_empty());
}

#[test]
fn no_points_one_point_and_points_that_are_not_numbers() {
    assert_eq!(same::<2>(&[], 1.0, [None; 2]).offsets, [0]);
    assert_eq!(same(&[[1.0, 2.0]], 1.0, [None; 2]).offsets, [0, 0]);
    let found = same(
        &[
            [0.0, 0.0],
            [f64::NAN, 0.0],
            [f64::INFINITY, 0.0],
            [0.1, 0.0],
        ],
        1.0,
        [None; 2],
    );
    assert_eq!(found.offsets, [0, 1, 1, 1, 2]);
}

/// Seconds for a cube of `side`³ points with about 32 neighbours each, and a stray point.
fn seconds(side: usize, stray: f64) -> f64 {
    let mut x: Vec<[f64; 3]> = (0..side.pow(3))
        .map(|k| [k % side, k / side % side, k / side / side].map(|n| n as f64))
        .collect();
    x[0] = [stray; 3];
    let best = (0..3).map(|_| {
        let start = Instant::now();
        let found = neighbours(&x, 2.0, &[None; 3]);
        assert!(found.indices.len() > 25 * x.len());
        start.elapsed().as_secs_f64()
    });
    best.fold(f64::INFINITY, f64::min)
}

#[test]
fn a_stray_point_costs_nothing_and_the_cost_is_linear() {
    // Wide bounds: what they must catch is a quadratic search, 64 times slower here.
    let (small, large, stray) = (seconds(16, 0.0), seconds(64, 0.0), seconds(64, 1e12));
    assert!(
        large < 64.0 * 8.0 * small,
        "{small} s for 16³ points, {large} s for 64³"
    );
    assert!(
        stray < 8.0 * large,
        "{large} s without, {stray} s with a stray point"
    );
}
