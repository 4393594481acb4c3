//! The particles of a fluid.

use super::{
    Column, Given, Shared, StageColumns, component, for_each_range, permute, rounded,
    vector_columns,
};
use crate::neighbours::{Cells, Grid, Sorter};
use crate::simd::Real;

/// A fluid: its state in double precision, its rates and what pairs read in the pair precision `R`.
pub struct Fluid<R, const D: usize> {
    /// Position in m.
    pub position: [Column<f64>; D],
    /// Velocity in m/s.
    pub velocity: [Column<f64>; D],
    /// Density in kg/m³ (kg/m² in 2D).
    pub density: Column<f64>,
    /// Mass in kg (kg/m in 2D).
    pub mass: Column<R>,
    /// The order in which the particles were given.
    pub id: Column<u32>,
    /// Acceleration by pairs in m/s², without gravity.
    pub acceleration: [Column<R>; D],
    /// Rate of density in kg/m³/s.
    pub density_rate: Column<R>,
    /// Velocity at the time of the sweep.
    pub pair_velocity: [Column<R>; D],
    /// Volume in m³ (m² in 2D) at the time of the sweep.
    pub volume: Column<R>,
    /// Pressure in Pa.
    pub pressure: Column<R>,
    /// `ρ/ρ0 - 1`, which keeps small differences of density exact in single precision.
    pub condensation: Column<R>,
    /// Renormalised gradient of the condensation in 1/m, if the density diffusion calls for it.
    pub gradient: Option<[Column<R>; D]>,
    /// Shift of the present step in m, if the scene calls for particle shifting.
    pub shift: Option<[Column<R>; D]>,
    /// Sums that a sweep needs on the way and that are of no use afterwards: a symmetric matrix, then a vector, if the
    /// scene has a sweep that needs them.
    pub sums: Vec<Column<R>>,
    /// What an integrator of several stages keeps of the step's start, if the scene calls for one.
    pub stages: Option<StageColumns<D>>,
    /// Particles by cell.
    pub cells: Cells,
    sorter: Sorter,
    scratch: Column<f64>,
}

/// What a scene calls for beyond the columns that every fluid has.
#[derive(Clone, Copy, Debug, Default)]
pub struct OptionalColumns {
    /// [`Fluid::gradient`].
    pub gradient: bool,
    /// [`Fluid::shift`].
    pub shift: bool,
    /// Number of [`Fluid::sums`].
    pub sums: usize,
    /// Sets of columns in [`Fluid::stages`]: 0 for none.
    pub stages: usize,
}

impl<R: Real, const D: usize> Fluid<R, D> {
    /// Takes over the particles given.
    pub fn new(given: &Given, grid: &Grid<D>, columns: OptionalColumns) -> Self {
        let n = given.mass.len();
        Fluid {
            position: std::array::from_fn(|a| component::<D>(&given.position, a)),
            velocity: std::array::from_fn(|a| component::<D>(&given.velocity, a)),
            density: Column::from_values(given.density.iter().copied()),
            mass: rounded(&given.mass),
            id: Column::from_values(0..n as u32),
            acceleration: vector_columns(n),
            density_rate: Column::new(n),
            pair_velocity: vector_columns(n),
            volume: Column::new(n),
            pressure: Column::new(n),
            condensation: Column::new(n),
            gradient: columns.gradient.then(|| vector_columns(n)),
            shift: columns.shift.then(|| vector_columns(n)),
            sums: (0..columns.sums).map(|_| Column::new(n)).collect(),
            stages: (columns.stages > 0).then(|| StageColumns::new(n, columns.stages > 1)),
            cells: Cells::new(grid.count(), Grid::<D>::PARTS),
            sorter: Sorter::new(n),
            scratch: Column::new(n),
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Position of particle `i`.
    #[inline(always)]
    pub fn at(&self, i: usize) -> [f64; D] {
        std::array::from_fn(|a| self.position[a][i])
    }

    /// Velocity of particle `i`.
    #[inline(always)]
    pub fn velocity_of(&self, i: usize) -> [f64; D] {
        std::array::from_fn(|a| self.velocity[a][i])
    }

    /// Sorts the particles into the cells of `grid`; with `mid_step`, what the sweep of forces left for the sweep of
    /// continuity moves along, and what a step of several stages has kept.
    pub fn sort(&mut self, grid: &Grid<D>, mid_step: bool) {
        if grid.is_periodic() {
            if let Some(stages) = self.stages.as_mut().filter(|_| mid_step) {
                stages.wrap_along(&self.position, grid);
            }
            let position = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut self.position[a]));
            for_each_range(self.id.len(), |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let x = position.map(|p| unsafe { p.range(&range) });
                for i in 0..range.len() {
                    let mut at = std::array::from_fn(|a| x[a][i]);
                    grid.wrap(&mut at);
                    for a in 0..D {
                        x[a][i] = at[a];
                    }
                }
            });
        }
        let position = &self.position;
        self.sorter.sort(&mut self.cells, |i| {
            grid.bin(&std::array::from_fn(|a| position[a][i]))
        });
        let order = &self.sorter.order;
        let doubles = &mut self.scratch[..];
        for a in 0..D {
            permute(&mut self.position[a], order, doubles);
            permute(&mut self.velocity[a], order, doubles);
        }
        permute(&mut self.density, order, doubles);
        if let Some(stages) = self.stages.as_mut().filter(|_| mid_step) {
            stages.permute(order, doubles);
        }
        let reals = reinterpret::<R>(doubles);
        for a in 0..D {
            permute(&mut self.acceleration[a], order, reals);
        }
        permute(&mut self.density_rate, order, reals);
        permute(&mut self.mass, order, reals);
        if mid_step {
            for a in 0..D {
                permute(&mut self.pair_velocity[a], order, reals);
                if let Some(gradient) = &mut self.gradient {
                    permute(&mut gradient[a], order, reals);
                }
            }
            permute(&mut self.volume, order, reals);
            permute(&mut self.condensation, order, reals);
            permute(&mut self.pressure, order, reals);
        }
        permute(&mut self.id, order, reinterpret::<u32>(&mut self.scratch));
    }

    /// Puts a column that was in the order from before the last [`sort`](Self::sort) in the present one.
    pub fn reorder(&mut self, column: &mut Column<R>) {
        permute(column, &self.sorter.order, reinterpret(&mut self.scratch));
    }

    /// Bytes held, by what they serve.
    pub fn memory(&self) -> [(&'static str, usize); 4] {
        let state = D * (self.position[0].bytes() + self.velocity[0].bytes())
            + self.density.bytes()
            + self.mass.bytes()
            + self.id.bytes();
        let rates = D * self.acceleration[0].bytes() + self.density_rate.bytes();
        let pairs = D * self.pair_velocity[0].bytes()
            + 3 * self.volume.bytes()
            + self.gradient.as_ref().map_or(0, |g| D * g[0].bytes())
            + self.shift.as_ref().map_or(0, |s| D * s[0].bytes())
            + self.sums.iter().map(Column::bytes).sum::<usize>();
        let sort = self.cells.bytes() + self.sorter.bytes() + self.scratch.bytes();
        [
            ("fluid state", state),
            ("fluid rates", rates),
            ("fluid pair columns", pairs),
            ("fluid sort", sort),
        ]
    }
}

/// The scratch column of doubles as room for the same number of smaller numbers.
pub(super) fn reinterpret<T: Copy>(doubles: &mut [f64]) -> &mut [T] {
    const { assert!(size_of::<T>() <= size_of::<f64>() && align_of::<T>() <= align_of::<f64>()) };
    // SAFETY: no larger, no stricter aligned, and every bit pattern of a double is one of an f32, f64 or u32.
    unsafe { std::slice::from_raw_parts_mut(doubles.as_mut_ptr().cast(), doubles.len()) }
}
