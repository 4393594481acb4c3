//! A step of several stages: what an integrator asks for, done by the sweeps of the simulation.
//!
//! Each stage evaluates both sweeps on one state of one time: walls where they are then, gravity as it is then. Density
//! diffusion sees the gradient of its own stage; the acoustic damper sees the rate of density of the stage before, for
//! pressure is needed before the rate.

use super::retry::Trouble;
use super::solver::Solver;
use super::timers::Phase;
use crate::simd::Real;
use crate::step::{Stage, System};

impl<R: Real, const D: usize> Solver<R, D> {
    /// Refuses a stage that a sweep would spread, and sorts where one may leave the skin.
    fn accept(&mut self, stage: Stage) -> Result<(), Trouble> {
        self.timers.book(Phase::Integrate);
        if !stage.finite {
            return Err(Trouble::NotFinite);
        }
        if 2.0 * (self.travelled + stage.way) > self.skin {
            self.sort(true);
            // The start of the step is as far from the cells as this stage is from the start.
            self.travelled = stage.way;
        }
        Ok(())
    }
}

impl<R: Real, const D: usize> System for Solver<R, D> {
    type Trouble = Trouble;

    fn begin(&mut self) -> Result<(), Trouble> {
        if let Some(wall) = &mut self.wall {
            wall.keep_density();
        }
        let stage = self.motion.begin(&mut self.fluid);
        self.accept(stage)
    }

    fn stage(&mut self, ahead: f64, weight: f64) -> Result<(), Trouble> {
        if let Some(wall) = &mut self.wall {
            wall.stage_density(Some(ahead), weight, self.config.reference_density);
        }
        let stage = self.motion.stage(&mut self.fluid, ahead, weight);
        self.accept(stage)
    }

    fn rates(&mut self, since: f64, dt: f64) {
        self.set_gravity(self.time + since);
        self.move_walls(self.time + since);
        self.update_walls();
        self.sum_forces();
        self.run_stages();
        self.sum_density_rates(dt);
    }

    fn middle(&mut self, dt: f64) {
        self.begin_audit();
        self.rates(0.5 * dt, dt);
        self.audit_pairs();
        // The rates of a later stage are not of the middle.
        self.budget.listens = false;
    }

    fn arrive(&mut self, weight: f64, dt: f64) {
        if let Some(wall) = &mut self.wall {
            wall.stage_density(None, weight, self.config.reference_density);
        }
        let (state, way) = self.motion.arrive(&mut self.fluid, weight);
        self.state = state;
        self.travelled += way;
        self.move_walls(self.time + dt);
        self.timers.book(Phase::Integrate);
    }
}
