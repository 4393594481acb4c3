//! What an integrator of several stages keeps of a step, beside the state that moves from stage to stage.

use super::{Column, permute, vector_columns};
use crate::neighbours::Grid;

/// A state in double precision.
pub struct StateColumns<const D: usize> {
    /// Position in m.
    pub position: [Column<f64>; D],
    /// Velocity in m/s.
    pub velocity: [Column<f64>; D],
    /// Density in kg/m³ (kg/m² in 2D).
    pub density: Column<f64>,
}

impl<const D: usize> StateColumns<D> {
    fn new(n: usize) -> Self {
        StateColumns {
            position: vector_columns(n),
            velocity: vector_columns(n),
            density: Column::new(n),
        }
    }

    fn permute(&mut self, order: &[u32], scratch: &mut [f64]) {
        let vectors = self.position.iter_mut().chain(&mut self.velocity);
        for column in vectors.chain([&mut self.density]) {
            permute(column, order, scratch);
        }
    }

    fn bytes(&self) -> usize {
        2 * D * self.density.bytes() + self.density.bytes()
    }
}

/// The state at the start of a step, and the weighted sum of the rates so far times the step, if more than one stage
/// enters the outcome. Of no use between steps.
pub struct StageColumns<const D: usize> {
    /// The state at the start of the step.
    pub start: StateColumns<D>,
    /// What the stages so far have added to the outcome.
    pub sum: Option<StateColumns<D>>,
}

impl<const D: usize> StageColumns<D> {
    /// Room for `n` particles.
    pub fn new(n: usize, with_sum: bool) -> Self {
        StageColumns {
            start: StateColumns::new(n),
            sum: with_sum.then(|| StateColumns::new(n)),
        }
    }

    /// Moves the start of the step by the periods by which `position` is about to be wrapped.
    pub(super) fn wrap_along(&mut self, position: &[Column<f64>; D], grid: &Grid<D>) {
        for i in 0..position[0].len() {
            let from: [f64; D] = std::array::from_fn(|a| position[a][i]);
            let mut to = from;
            grid.wrap(&mut to);
            for a in 0..D {
                self.start.position[a][i] += to[a] - from[a];
            }
        }
    }

    /// Follows the particles into a new order.
    pub(super) fn permute(&mut self, order: &[u32], scratch: &mut [f64]) {
        self.start.permute(order, scratch);
        if let Some(sum) = &mut self.sum {
            sum.permute(order, scratch);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.start.bytes() + self.sum.as_ref().map_or(0, StateColumns::bytes)
    }
}
