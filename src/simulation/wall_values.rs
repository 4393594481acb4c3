//! What walls of particles have: values from the fluid before the sweep of forces, and densities of their own.

use super::assembly::{Stage, force_source, outputs};
use super::solver::Solver;
use super::timers::Phase;
use crate::eos::EquationOfState;
use crate::simd::Real;
use crate::sweep::{Source, slot};
use crate::walls::{Extrapolation, Slip, WallMethod};

impl<R: Real, const D: usize> Solver<R, D> {
    /// Wall values from the fluid as it is before the sweep of forces.
    pub(super) fn update_walls(&mut self) {
        let (Some(wall), Some(config)) = (&mut self.wall, self.config.wall) else {
            return;
        };
        match config.method {
            WallMethod::Adami => {
                let fluid = &self.fluid;
                let source = force_source(
                    &fluid.position,
                    &fluid.cells,
                    &fluid.volume,
                    &fluid.pressure,
                    &fluid.condensation,
                    &fluid.pair_velocity,
                );
                let due = wall.reached.due(&self.grid, &wall.cells, &fluid.cells);
                let mut target = Source::new(&wall.position, &wall.cells)
                    .only_in(due)
                    .with(slot::VOLUME, &wall.mass)
                    .with_vector(slot::VELOCITY, &wall.pair_velocity);
                if let Some(moving) = &wall.moving {
                    target = target.with_vector(slot::GRADIENT, &moving.acceleration);
                }
                let pass = Extrapolation {
                    gravity: self.motion.gravity,
                    eos: self.motion.eos,
                    at_rest: self.motion.eos.condensation(0.0),
                    suction: config.suction.unwrap_or(self.grid.is_periodic()),
                    no_slip: config.slip == Slip::No,
                    accelerated: wall.moving.is_some(),
                };
                let columns = [&mut wall.pressure, &mut wall.condensation, &mut wall.volume];
                let slip = wall
                    .slip_velocity
                    .iter_mut()
                    .flatten()
                    .enumerate()
                    .map(|(a, c)| (3 + a, c));
                let out = outputs(columns.into_iter().enumerate().chain(slip));
                let stage = Stage {
                    grid: &self.grid,
                    sweeper: &self.sweeper,
                    target: &target,
                    source: &source,
                };
                stage.run(self.kernel, &pass, out);
            }
            WallMethod::Dynamic => wall.follow_density(&self.motion.eos),
            WallMethod::ModifiedDynamic => self.extrapolate_from_ghosts(),
            WallMethod::SemiAnalytical | WallMethod::Penalty | WallMethod::Mirror => {}
        }
        self.timers.book(Phase::Walls);
    }

    /// Density of walls that follow the equation of continuity.
    pub(super) fn advance_walls(&mut self, dt: f64) {
        if let Some(wall) = &mut self.wall {
            wall.advance_density(dt, self.config.reference_density);
        }
    }
}
