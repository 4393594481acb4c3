//! Particles: one column per quantity, in cell order.

mod column;
mod fluid;
mod parallel;
mod wall;

pub use column::{Column, PAD};
pub use fluid::Fluid;
pub use parallel::{GRAIN, Shared, for_ranges, permute, sum};
pub use wall::Wall;

use crate::simd::Real;

/// Particles as a scene gives them: shapes `(n)`, SI units.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// Positions, one vector per particle, flattened.
    pub position: Vec<f64>,
    /// Velocities, likewise.
    pub velocity: Vec<f64>,
    /// Densities.
    pub density: Vec<f64>,
    /// Masses.
    pub mass: Vec<f64>,
}

/// Columns of the components of a vector quantity.
pub(crate) fn vector_columns<T: Copy + Default, const D: usize>(n: usize) -> [Column<T>; D] {
    std::array::from_fn(|_| Column::new(n))
}

/// Component `a` of flattened vectors.
pub(crate) fn component<const D: usize>(flat: &[f64], a: usize) -> Column<f64> {
    Column::from_values(flat.iter().skip(a).step_by(D).copied())
}

pub(crate) fn rounded<R: Real>(values: &[f64]) -> Column<R> {
    Column::from_values(values.iter().map(|&x| R::from_f64(x)))
}
