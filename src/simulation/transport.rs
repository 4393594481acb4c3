//! Fields that particles take along where a shift moves them.

use super::assembly::{Stage, outputs};
use super::config::Config;
use super::solver::Solver;
use crate::effects::{Carry, Transport};
use crate::eos::EquationOfState;
use crate::particles::{Column, sum, vector_columns};
use crate::simd::Real;
use crate::step::take_along;
use crate::sweep::{Source, slot};

/// What a shift changes, where the scene's form of shifting asks for it. Of no use between steps.
pub(super) struct Changes<R, const D: usize> {
    form: Transport,
    /// Of the velocity, in m/s.
    velocity: [Column<R>; D],
    /// Of the density over that at rest.
    condensation: Option<Column<R>>,
}

impl<R: Real, const D: usize> Changes<R, D> {
    /// For `n` particles, if the configuration calls for it.
    pub(super) fn new(config: &Config, n: usize) -> Option<Self> {
        let form = config.shifting?.form.transport()?;
        Some(Changes {
            form,
            velocity: vector_columns(n),
            condensation: (form == Transport::Differences).then(|| Column::new(n)),
        })
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        D * self.velocity[0].bytes() + self.condensation.as_ref().map_or(0, Column::bytes)
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Sums what the shift of this step changes, before particles move.
    pub(super) fn sum_transport(&mut self) {
        let (Some(changes), Some(shift)) = (&mut self.transport, &self.fluid.shift) else {
            return;
        };
        let fluid = &self.fluid;
        let source = Source::new(&fluid.position, &fluid.cells)
            .with(slot::VOLUME, &fluid.volume)
            .with(slot::CONDENSATION, &fluid.condensation)
            .with_vector(slot::VELOCITY, &fluid.pair_velocity)
            .with_vector(slot::GRADIENT, shift);
        let columns = changes.velocity.iter_mut().chain(&mut changes.condensation);
        let out = outputs(columns.enumerate());
        let stage = Stage {
            grid: &self.grid,
            sweeper: &self.sweeper,
            target: &source,
            source: &source,
        };
        match changes.form {
            Transport::Differences => stage.run(self.kernel, &Carry::<false>, out),
            Transport::Stress => stage.run(self.kernel, &Carry::<true>, out),
        }
    }

    /// Gives particles what they find where they have been moved.
    pub(super) fn apply_transport(&mut self) {
        let free = self.is_free();
        if let Some(changes) = &mut self.transport {
            take_along(
                &mut self.fluid,
                &mut changes.velocity,
                changes.condensation.as_ref(),
                self.config.reference_density,
                changes.form == Transport::Stress,
                free,
            );
        }
    }

    /// Whether neither wall nor period holds the fluid.
    pub(super) fn is_free(&self) -> bool {
        self.wall.is_none() && !self.grid.is_periodic()
    }

    /// Energy that the changes have given in the last step, in J.
    pub(super) fn energy_transported(&self) -> f64 {
        let Some(changes) = &self.transport else {
            return 0.0;
        };
        let fluid = &self.fluid;
        let rho = self.config.reference_density;
        let [given] = sum(fluid.len(), |i| {
            let m = fluid.mass[i].to_f64();
            let kinetic: f64 = (0..D)
                .map(|a| {
                    let change = changes.velocity[a][i].to_f64();
                    m * change * (fluid.velocity[a][i] - 0.5 * change)
                })
                .sum();
            let Some(condensation) = &changes.condensation else {
                return [kinetic];
            };
            let density = fluid.density[i];
            let change = rho * condensation[i].to_f64();
            let pressure = self.motion.eos.pressure_at(density - 0.5 * change);
            [kinetic + m * pressure * change / (density * density)]
        });
        given
    }
}
