//! No particle shifting beside walls without particles.

use super::facet::minus;
use super::surface::Surface;
use crate::neighbours::Grid;
use crate::particles::{Fluid, Shared};
use crate::simd::{Real, dot};
use rayon::prelude::*;

/// Cells per task.
const CELLS: usize = 32;

impl<const D: usize> Surface<D> {
    /// Takes away the shift of every particle within `support` (m) of a facet: where the wall cuts off the support, particles
    /// seem to be few, and would be shifted into it.
    pub fn stop_shift<R: Real>(&self, fluid: &mut Fluid<R, D>, grid: &Grid<D>, support: f64) {
        let Some(shift) = &mut fluid.shift else {
            return;
        };
        let shift = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut shift[a]));
        let fluid = &*fluid;
        (0..self.cells().len())
            .into_par_iter()
            .with_min_len(CELLS)
            .for_each(|k| {
                let cell = self.cells()[k] as usize;
                for i in fluid.cells.particles(cell, cell + 1) {
                    let mut x = fluid.at(i);
                    if grid.is_periodic() {
                        grid.wrap(&mut x);
                    }
                    let near = self.near(k).iter().any(|&f| {
                        let d = minus(&x, &self.facets()[f as usize].closest(&x));
                        dot(&d, &d) < support * support
                    });
                    if near {
                        for column in &shift {
                            // SAFETY: every cell has particles of its own, and is listed once.
                            unsafe { column.write(i, R::default()) };
                        }
                    }
                }
            });
    }
}
