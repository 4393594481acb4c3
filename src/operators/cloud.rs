//! Particles, their kernel and their search grid: what every operator sums over.

use crate::kernel::{KernelName, Scaled};
use crate::neighbours::search::{Periods, PointGrid};
use rayon::prelude::*;

/// Particles ready to be summed over.
#[derive(Clone, Debug)]
pub struct Cloud<'a, const D: usize> {
    /// Positions [m].
    pub position: &'a [[f64; D]],
    /// Masses [kg].
    pub mass: &'a [f64],
    /// Densities [kg/m^D].
    pub density: &'a [f64],
    /// Volumes `m/ρ` [m^D].
    pub volume: Vec<f64>,
    /// Smoothing length [m].
    pub h: f64,
    /// The kernel at this smoothing length.
    pub kernel: Scaled<D>,
    grid: PointGrid<D>,
}

impl<'a, const D: usize> Cloud<'a, D> {
    /// Sorts the particles for sums with `kernel` of smoothing length `h` [m].
    ///
    /// # Panics
    /// If the arrays differ in length.
    pub fn new(
        position: &'a [[f64; D]],
        mass: &'a [f64],
        density: &'a [f64],
        kernel: KernelName,
        h: f64,
        periodic: &Periods<D>,
    ) -> Self {
        assert_eq!(position.len(), mass.len());
        assert_eq!(position.len(), density.len());
        let kernel = Scaled::new(kernel, h);
        Self {
            position,
            mass,
            density,
            volume: mass.iter().zip(density).map(|(m, rho)| m / rho).collect(),
            h,
            kernel,
            grid: PointGrid::new(position, kernel.radius(), periodic),
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Calls `visit(j, x - x_j, |x - x_j|)` for every particle whose kernel reaches `x`.
    #[inline]
    pub fn for_each_near(&self, x: &[f64; D], mut visit: impl FnMut(usize, [f64; D], f64)) {
        self.grid
            .for_each_near(x, |j, d, squared| visit(j, d, squared.sqrt()));
    }

    /// Calls `visit(j, r_ij, |r_ij|, F_ij)` with `∇_i W_ij = F_ij r_ij` for every neighbour of particle `i`.
    #[inline]
    pub fn for_each_neighbour(&self, i: usize, mut visit: impl FnMut(usize, [f64; D], f64, f64)) {
        self.for_each_near(&self.position[i], |j, d, r| {
            if j != i {
                visit(j, d, r, self.kernel.slope_over_r(r));
            }
        });
    }

    /// `f(i)` of every particle, in parallel.
    pub(super) fn map<T: Send>(&self, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        (0..self.len())
            .into_par_iter()
            .with_min_len(256)
            .map(f)
            .collect()
    }
}
