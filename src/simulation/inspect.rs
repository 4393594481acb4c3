//! A solver seen from outside: bodies, status, memory, effects.

use super::engine::{BodyState, EffectState, Status};
use super::solver::{Body, Solver};
use crate::effects::Declaration;
use crate::eos::EquationOfState;
use crate::simd::Real;

impl<R: Real, const D: usize> Solver<R, D> {
    /// The arrays of a body in the order of its ids.
    pub(super) fn body_state(&self, body: &Body) -> BodyState {
        let n = body.ids.len();
        let mut out = BodyState {
            position: vec![0.0; n * D],
            velocity: vec![0.0; n * D],
            density: vec![0.0; n],
            pressure: vec![0.0; n],
            mass: vec![0.0; n],
        };
        let eos = &self.motion.eos;
        let place = |id: u32| {
            body.ids
                .contains(&id)
                .then(|| (id - body.ids.start) as usize)
        };
        if body.fluid {
            let fluid = &self.fluid;
            for i in 0..fluid.len() {
                let Some(k) = place(fluid.id[i]) else {
                    continue;
                };
                for a in 0..D {
                    out.position[k * D + a] = fluid.position[a][i];
                    out.velocity[k * D + a] = fluid.velocity[a][i];
                }
                out.density[k] = fluid.density[i];
                out.pressure[k] = eos.pressure_at(fluid.density[i]);
                out.mass[k] = fluid.mass[i].to_f64();
            }
        } else if let Some(wall) = &self.wall {
            for i in 0..wall.len() {
                let Some(k) = place(wall.id[i]) else { continue };
                for a in 0..D {
                    out.position[k * D + a] = wall.position[a][i];
                    out.velocity[k * D + a] = wall.pair_velocity[a][i].to_f64();
                }
                out.pressure[k] = wall.pressure[i].to_f64();
                out.density[k] = eos.reference_density() * (1.0 + wall.condensation[i].to_f64());
                out.mass[k] = wall.mass[i].to_f64();
            }
        }
        out
    }

    pub(super) fn status(&self) -> Status {
        Status {
            time: self.time,
            step: self.step,
            time_step: self.time_step,
            limit: self.limit,
            steps_by_limit: self.steps_by_limit,
            mach_max: self.mach_max,
            retries: self.guard.memory.record,
            kept: self.guard.snapshot.as_ref().map(|s| s.scalars.time),
            fluid: self.fluid.len(),
            wall: self.wall.as_ref().map_or(0, |w| w.len()),
        }
    }

    pub(super) fn memory(&self) -> Vec<(&'static str, usize)> {
        let mut groups = self.fluid.memory().to_vec();
        if let Some(stages) = &self.fluid.stages {
            groups.push(("integrator", stages.bytes()));
        }
        if let Some(wall) = &self.wall {
            groups.push(("walls", wall.bytes()));
        }
        if let Some(boundary) = &self.boundary {
            groups.push(("wall surface", boundary.bytes()));
        }
        let stages: usize = self.stages.iter().map(|s| s.bytes()).sum();
        if stages > 0 {
            groups.push(("stages", stages));
        }
        if let Some(transport) = &self.transport {
            groups.push(("shift transport", transport.bytes()));
        }
        groups.push(("buffers", self.sweeper.bytes()));
        groups.push(("guard", self.guard.bytes()));
        groups
    }

    pub(super) fn effects(&self) -> Vec<EffectState> {
        let known = super::catalogue::effects(&self.config, self.wall.is_some());
        let state = |(about, on): (Declaration, bool)| EffectState {
            name: about.name,
            on,
            columns: if on {
                about.columns.iter().map(|c| c.name()).collect()
            } else {
                Vec::new()
            },
            bytes_per_particle: if on {
                about.columns.iter().map(|c| c.numbers(D)).sum::<usize>() * size_of::<R>()
            } else {
                0
            },
            sweeps: if on { about.sweeps } else { 0 },
            limit: about.limit.filter(|_| on),
            dissipates: about.dissipates,
            source: about.source,
        };
        known.into_iter().map(state).collect()
    }
}
