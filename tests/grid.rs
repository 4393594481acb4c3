//! The grid of cells: whatever the particles do, the cells around a particle's cell hold all its neighbours, once.

use kolk::neighbours::{Cells, Grid, Sorter};
use proptest::prelude::*;
use std::collections::{BTreeSet, HashMap};

/// A neighbour: its index, and by how many periods it is shifted on each axis.
type Image<const D: usize> = (usize, [i64; D]);

/// The grid with its particles, sorted.
struct Sorted<const D: usize> {
    grid: Grid<D>,
    cells: Cells,
    order: Vec<u32>,
    position: Vec<[f64; D]>,
    period: [f64; D],
}

impl<const D: usize> Sorted<D> {
    /// Lays the grid over the `laid` first particles and sorts all of them, as a simulation does.
    fn new(
        position: &[[f64; D]],
        laid: usize,
        reach: f64,
        periodic: [Option<[f64; 2]>; D],
    ) -> Self {
        let extreme = |fold: fn(f64, f64) -> f64, start: f64| {
            std::array::from_fn(|a| position[..laid].iter().map(|x| x[a]).fold(start, fold))
        };
        let (low, high) = (
            extreme(f64::min, f64::INFINITY),
            extreme(f64::max, f64::NEG_INFINITY),
        );
        let grid = Grid::new(low, high, reach, periodic, laid);
        let mut position = position.to_vec();
        position.iter_mut().for_each(|x| grid.wrap(x));
        let mut cells = Cells::new(grid.count(), Grid::<D>::PARTS);
        let mut sorter = Sorter::new(position.len());
        sorter.sort(&mut cells, |i| grid.bin(&position[i]));
        let period = std::array::from_fn(|a| periodic[a].map_or(0.0, |[low, high]| high - low));
        Sorted {
            grid,
            cells,
            order: sorter.order,
            position,
            period,
        }
    }

    /// All that is near particle `i` by way of the cells around its own.
    fn candidates(&self, i: usize) -> Vec<Image<D>> {
        let cell = self.grid.bin(&self.position[i]) as usize / Grid::<D>::PARTS;
        let mut found = Vec::new();
        for run in self.grid.around(cell).iter() {
            let turns = std::array::from_fn(|a| {
                if self.period[a] > 0.0 {
                    (run.shift[a] / self.period[a]).round() as i64
                } else {
                    0
                }
            });
            for a in 0..D {
                assert!(
                    (run.shift[a] - turns[a] as f64 * self.period[a]).abs()
                        <= 1e-12 * self.period[a]
                );
            }
            let members = self.cells.particles(run.first, run.end);
            found.extend(members.map(|k| (self.order[k] as usize, turns)));
        }
        found
    }

    /// All images within `reach` of particle `i`, by looking at every particle.
    fn in_reach(&self, i: usize, reach: f64) -> BTreeSet<Image<D>> {
        let mut found = BTreeSet::new();
        let images = 3usize.pow(D as u32);
        for (j, y) in self.position.iter().enumerate() {
            for image in 0..images {
                let turns: [i64; D] =
                    std::array::from_fn(|a| (image / 3usize.pow(a as u32) % 3) as i64 - 1);
                if (0..D).any(|a| turns[a] != 0 && self.period[a] == 0.0) {
                    continue;
                }
                let squared: f64 = (0..D)
                    .map(|a| self.position[i][a] - y[a] - turns[a] as f64 * self.period[a])
                    .map(|d| d * d)
                    .sum();
                if squared <= reach * reach {
                    found.insert((j, turns));
                }
            }
        }
        found
    }
}

/// Checks every particle; the distance test of a sweep reaches a little less far than the cells are wide.
fn check<const D: usize>(
    position: &[[f64; D]],
    laid: usize,
    reach: f64,
    periodic: [Option<[f64; 2]>; D],
) {
    let sorted = Sorted::new(position, laid, reach, periodic);
    for i in 0..position.len() {
        let mut times: HashMap<Image<D>, usize> = HashMap::new();
        for image in sorted.candidates(i) {
            *times.entry(image).or_default() += 1;
        }
        if let Some((image, n)) = times.iter().find(|(_, n)| **n > 1) {
            panic!(
                "particle {i} at {:?} sees {image:?} {n} times",
                sorted.position[i]
            );
        }
        for image in sorted.in_reach(i, reach / 1.1) {
            assert!(
                times.contains_key(&image),
                "particle {i} at {:?} misses {} at {:?}, periods {:?}, axes {periodic:?}, reach {reach}",
                sorted.position[i],
                image.0,
                sorted.position[image.0],
                image.1,
            );
        }
    }
}

/// Points of every kind: anywhere, crowded, on cell faces, and escaped.
fn points<const D: usize>() -> impl Strategy<Value = Vec<[f64; D]>> {
    let place = || prop::array::uniform::<_, D>(-3.0..3.0_f64);
    let crowded = (place(), prop::array::uniform::<_, D>(-1e-3..1e-3_f64))
        .prop_map(|(x, d)| std::array::from_fn(|a| x[a].round() + d[a]));
    let node = place().prop_map(|x: [f64; D]| x.map(|x| (4.0 * x).round() / 4.0));
    // Pairs of escaped particles, which must still find each other.
    let far = (0..6u8, prop::array::uniform::<_, D>(-0.4..0.4_f64)).prop_map(|(k, d)| {
        std::array::from_fn(|a| d[a] + [1e6, -1e6, 1e9, -4e5, 0.0, 77.0][(k as usize + a) % 6])
    });
    let point = prop_oneof![4 => place(), 3 => crowded, 2 => node, 2 => far];
    prop::collection::vec(point, 2..120)
}

/// An axis that is periodic or not; at a reach of 0.5 it has 1, 2, 3 or more cells.
fn axis() -> impl Strategy<Value = Option<[f64; 2]>> {
    prop::option::weighted(
        0.6,
        (-3.0..0.0_f64, 0.5..3.0_f64).prop_map(|(low, period)| [low, low + period]),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..Default::default() })]

    #[test]
    fn cells_hold_all_neighbours_in_2d(
        x in points::<2>(), share in 0.2..1.0_f64, periodic in prop::array::uniform::<_, 2>(axis())
    ) {
        let laid = ((x.len() as f64 * share) as usize).max(1);
        check(&x, laid, 0.5, periodic);
    }

    #[test]
    fn cells_hold_all_neighbours_in_3d(
        x in points::<3>(), share in 0.2..1.0_f64, periodic in prop::array::uniform::<_, 3>(axis())
    ) {
        let laid = ((x.len() as f64 * share) as usize).max(1);
        check(&x, laid, 0.5, periodic);
    }

    #[test]
    fn no_more_cells_than_the_particles_pay_for(
        x in points::<3>(), reach in 1e-6..1.0_f64, periodic in prop::array::uniform::<_, 3>(axis())
    ) {
        let sorted = Sorted::new(&x, x.len(), reach.min(0.5), periodic);
        prop_assert!(sorted.grid.count() <= 4 * x.len().max(27));
    }
}

#[test]
fn one_and_two_cells_per_period_give_every_image_once() {
    for period in [0.5, 0.9, 1.0, 1.2, 1.49, 1.5] {
        let x: Vec<[f64; 2]> = (0..60)
            .map(|k| [0.017 * f64::from(k), 0.031 * f64::from(k % 17)])
            .collect();
        check(&x, x.len(), 0.5, [Some([0.0, period]), Some([-0.1, 0.5])]);
    }
}

#[test]
fn a_particle_on_the_face_of_a_period_keeps_its_neighbours() {
    // Periods whose cells do not divide them evenly in binary, and positions on, just below and just above both faces.
    for (low, high) in [
        (0.0, 1.0),
        (0.0, 0.7),
        (-0.3, 1.9),
        (0.1, 3.4),
        (-1e3, -1e3 + 1.7),
    ] {
        for face in [low, high] {
            for x in [
                face,
                f64::next_down(face),
                f64::next_up(face),
                face - 1e-17,
                face + 1e-14,
                face - 1e-14,
            ] {
                let points = [
                    [x, 0.0],
                    [low + 0.05, 0.1],
                    [high - 0.05, 0.0],
                    [low + 0.2, 0.0],
                    [high - 0.3, 0.1],
                ];
                check(&points, points.len(), 0.5, [Some([low, high]), None]);
            }
        }
    }
}

#[test]
fn positions_that_are_not_numbers_stay_in_the_table_and_disturb_nobody() {
    let mut x: Vec<[f64; 2]> = (0..50)
        .map(|k| [0.1 * f64::from(k % 8), 0.1 * f64::from(k / 8)])
        .collect();
    let laid = x.len();
    for bad in [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        -f64::MAX,
        1e300,
        -1e-300,
    ] {
        x.push([bad, 0.3]);
        x.push([0.2, bad]);
        x.push([bad, bad]);
    }
    for periodic in [
        [None; 2],
        [Some([0.0, 1.0]), None],
        [Some([0.0, 0.6]), Some([0.0, 0.9])],
    ] {
        let sorted = Sorted::new(&x, laid, 0.25, periodic);
        let cells = sorted.grid.count();
        assert_eq!(sorted.cells.particles(0, cells), 0..x.len());
        check(&x, laid, 0.25, periodic);
    }
}

#[test]
fn particles_farther_apart_than_numbers_of_cells_go_have_a_grid() {
    // Found by fuzzing: one cell more than the largest number of cells overflowed.
    let grid = Grid::<2>::new([0.0, 0.0], [1e300, 1.0], 1e-3, [None; 2], 2);
    assert!(grid.count() <= 27);
    assert!((grid.bin(&[1e300, 0.5]) as usize) < grid.count() * Grid::<2>::PARTS);
}
