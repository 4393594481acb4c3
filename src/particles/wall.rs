//! The particles of walls.

use super::fluid::reinterpret;
use super::{Column, Given, Moving, component, permute, rounded, vector_columns};
use crate::neighbours::{Cells, Grid, Reached, Sorter};
use crate::simd::Real;

/// All walls of a scene. Those at rest are sorted once.
pub struct Wall<R, const D: usize> {
    /// Position in m.
    pub position: [Column<f64>; D],
    /// Mass in kg of the fluid that a wall particle stands for.
    pub mass: Column<R>,
    /// The order in which the particles were given.
    pub id: Column<u32>,
    /// Velocity of the wall itself in m/s.
    pub pair_velocity: [Column<R>; D],
    /// Velocity that viscosity sees: mirrored at a no-slip wall.
    pub slip_velocity: Option<[Column<R>; D]>,
    /// Volume.
    pub volume: Column<R>,
    /// Pressure in Pa.
    pub pressure: Column<R>,
    /// `ρ/ρ0 - 1`.
    pub condensation: Column<R>,
    /// Density and its rate, where walls follow the equation of continuity.
    pub density: Option<(Column<f64>, Column<R>)>,
    /// Their density at the start of a step, and what its stages have added so far, where it is integrated in several.
    pub stages: Option<[Column<f64>; 2]>,
    /// What walls need that move, if any does.
    pub moving: Option<Moving<R, D>>,
    /// Particles by cell.
    pub cells: Cells,
    /// Cells that the fluid reaches, where wall values follow from it.
    pub reached: Reached,
}

impl<R: Real, const D: usize> Wall<R, D> {
    /// Takes over and sorts the particles given.
    pub fn new(given: &Given, grid: &Grid<D>, no_slip: bool, dynamic: bool) -> Self {
        let n = given.mass.len();
        let mut wall = Wall {
            position: std::array::from_fn(|a| component::<D>(&given.position, a)),
            mass: rounded(&given.mass),
            id: Column::from_values(0..n as u32),
            pair_velocity: std::array::from_fn(|a| {
                Column::from_values(
                    given
                        .velocity
                        .iter()
                        .skip(a)
                        .step_by(D)
                        .map(|&v| R::from_f64(v)),
                )
            }),
            slip_velocity: no_slip.then(|| vector_columns(n)),
            volume: Column::new(n),
            pressure: Column::new(n),
            condensation: Column::new(n),
            density: dynamic.then(|| {
                (
                    Column::from_values(given.density.iter().copied()),
                    Column::new(n),
                )
            }),
            stages: None,
            moving: None,
            cells: Cells::new(grid.count(), Grid::<D>::PARTS),
            reached: Reached::default(),
        };
        let n = wall.len();
        wall.sort(grid, &mut Sorter::new(n), &mut Column::new(n));
        wall
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Sorts the particles into the cells of `grid`.
    fn sort(&mut self, grid: &Grid<D>, sorter: &mut Sorter, scratch: &mut Column<f64>) {
        if grid.is_periodic() {
            for i in 0..self.len() {
                let mut x = std::array::from_fn(|a| self.position[a][i]);
                grid.wrap(&mut x);
                for a in 0..D {
                    self.position[a][i] = x[a];
                }
            }
        }
        let position = &self.position;
        sorter.sort(&mut self.cells, |i| {
            grid.bin(&std::array::from_fn(|a| position[a][i]))
        });
        let (order, doubles) = (&sorter.order, &mut scratch[..]);
        for column in &mut self.position {
            permute(column, order, doubles);
        }
        if let Some((density, rate)) = &mut self.density {
            permute(density, order, doubles);
            permute(rate, order, reinterpret::<R>(doubles));
        }
        for column in self.stages.iter_mut().flatten() {
            permute(column, order, doubles);
        }
        let reals = reinterpret::<R>(doubles);
        let scalars = [
            &mut self.mass,
            &mut self.volume,
            &mut self.pressure,
            &mut self.condensation,
        ];
        let vectors = self
            .pair_velocity
            .iter_mut()
            .chain(self.slip_velocity.iter_mut().flatten());
        for column in scalars.into_iter().chain(vectors) {
            permute(column, order, reals);
        }
        permute(&mut self.id, order, reinterpret::<u32>(&mut scratch[..]));
    }

    /// Sorts walls that have moved.
    pub(super) fn sort_again(&mut self, grid: &Grid<D>) {
        let Some(mut moving) = self.moving.take() else {
            return;
        };
        self.sort(grid, &mut moving.sorter, &mut moving.scratch);
        for column in &mut moving.acceleration {
            let reals = reinterpret::<R>(&mut moving.scratch);
            permute(column, &moving.sorter.order, reals);
        }
        moving.travelled = 0.0;
        self.moving = Some(moving);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        D * (self.position[0].bytes() + self.pair_velocity[0].bytes())
            + self.mass.bytes()
            + self.id.bytes()
            + 3 * self.volume.bytes()
            + self.slip_velocity.as_ref().map_or(0, |s| D * s[0].bytes())
            + self
                .density
                .as_ref()
                .map_or(0, |(d, r)| d.bytes() + r.bytes())
            + self.stages.as_ref().map_or(0, |s| 2 * s[0].bytes())
            + self.moving.as_ref().map_or(0, Moving::bytes)
            + self.cells.bytes()
            + self.reached.bytes()
    }
}
