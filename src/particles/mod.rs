//! Particles: one column per quantity, in cell order.

mod column;
mod fluid;
mod moving;
mod parallel;
mod stage_columns;
mod wall;

pub use column::{Column, PAD};
pub use fluid::{Fluid, OptionalColumns};
pub use moving::Moving;
pub use parallel::{GRAIN, Shared, for_each_range, for_ranges, permute, sum};
pub use stage_columns::{StageColumns, StateColumns};
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

impl Given {
    /// Checks shapes and values; the message names the body and the array.
    ///
    /// # Errors
    /// Arrays of different lengths, numbers that are not finite, densities or masses that are not positive.
    pub fn validate(&self, body: &str, dimension: usize) -> crate::error::Result<()> {
        use crate::error::Error;
        let n = self.mass.len();
        let shapes = [
            ("position", self.position.len(), n * dimension),
            ("velocity", self.velocity.len(), n * dimension),
            ("density", self.density.len(), n),
        ];
        for (array, found, wanted) in shapes {
            if found != wanted {
                return Err(Error::Input(format!(
                    "{body}.{array}: found {found} numbers, {n} particles in {dimension}D need {wanted}"
                )));
            }
        }
        let check = |array: &str, values: &[f64], stride: usize, positive: bool| match values
            .iter()
            .position(|v| !v.is_finite() || (positive && *v <= 0.0))
        {
            Some(k) => Err(Error::Input(format!(
                "{body}.{array}: found {} at particle {}, allowed are finite numbers{}",
                values[k],
                k / stride,
                if positive { " above 0" } else { "" }
            ))),
            None => Ok(()),
        };
        check("position", &self.position, dimension, false)?;
        check("velocity", &self.velocity, dimension, false)?;
        check("density", &self.density, 1, true)?;
        check("mass", &self.mass, 1, true)
    }

    /// Adds the particles of `other` behind these.
    pub fn append(&mut self, other: &Given) {
        self.position.extend_from_slice(&other.position);
        self.velocity.extend_from_slice(&other.velocity);
        self.density.extend_from_slice(&other.density);
        self.mass.extend_from_slice(&other.mass);
    }
}
