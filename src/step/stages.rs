//! The whole-array passes of integrators of several stages.

use super::motion::{Columns, Motion, State};
use crate::eos::EquationOfState;
use crate::particles::{Fluid, Shared, StageColumns, StateColumns, for_ranges};
use crate::simd::Real;
use std::ops::Range;

/// What a pass has found of a stage.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// Whether all of it is finite: asked before a sweep, which would spread what is not.
    pub finite: bool,
    /// The longest way in m that a particle has gone since the start of the step.
    pub way: f64,
}

/// The columns of a state as tasks share them.
struct Kept<const D: usize> {
    position: [Shared<f64>; D],
    velocity: [Shared<f64>; D],
    density: Shared<f64>,
}

/// Parts of them that belong to one task.
struct Part<'a, const D: usize> {
    position: [&'a mut [f64]; D],
    velocity: [&'a mut [f64]; D],
    density: &'a mut [f64],
}

impl<const D: usize> Kept<D> {
    fn new(columns: &mut StateColumns<D>) -> Self {
        Kept {
            position: std::array::from_fn(|a| Shared::new(&mut columns.position[a])),
            velocity: std::array::from_fn(|a| Shared::new(&mut columns.velocity[a])),
            density: Shared::new(&mut columns.density),
        }
    }

    /// # Safety
    /// Ranges held at the same time must be disjoint, and inside the columns, which must outlive the pass.
    unsafe fn part<'a>(&self, range: &Range<usize>) -> Part<'a, D> {
        // SAFETY: promised by the caller.
        unsafe {
            Part {
                position: std::array::from_fn(|a| self.position[a].range(range)),
                velocity: std::array::from_fn(|a| self.velocity[a].range(range)),
                density: self.density.range(range),
            }
        }
    }
}

/// Zero if a number is finite, else not a number: a sum of these is one test for all of them.
#[inline(always)]
fn trace(x: f64) -> f64 {
    0.0 * x
}

impl<const D: usize> Motion<D> {
    /// The start of a step: keeps the state, and leaves what the sweeps read.
    pub fn begin<R: Real>(&self, fluid: &mut Fluid<R, D>) -> Stage {
        let Some(mut stages) = fluid.stages.take() else {
            return Stage {
                finite: true,
                way: 0.0,
            };
        };
        for a in 0..D {
            stages.start.position[a].copy_from_slice(&fluid.position[a]);
            stages.start.velocity[a].copy_from_slice(&fluid.velocity[a]);
        }
        stages.start.density.copy_from_slice(&fluid.density);
        if let Some(sum) = &mut stages.sum {
            for a in 0..D {
                sum.position[a].fill(0.0);
                sum.velocity[a].fill(0.0);
            }
            sum.density.fill(0.0);
        }
        fluid.stages = Some(stages);
        self.stage(fluid, 0.0, 0.0)
    }

    /// Goes `ahead` (s) of the start of the step with the present rates, adds them times `weight` (s) to the sum, and
    /// leaves what the sweeps read.
    pub fn stage<R: Real>(&self, fluid: &mut Fluid<R, D>, ahead: f64, weight: f64) -> Stage {
        let Some(mut stages) = fluid.stages.take() else {
            return Stage {
                finite: true,
                way: 0.0,
            };
        };
        let found = self.run_stage(fluid, &mut stages, ahead, weight);
        fluid.stages = Some(stages);
        found
    }

    fn run_stage<R: Real>(
        &self,
        fluid: &mut Fluid<R, D>,
        stages: &mut StageColumns<D>,
        ahead: f64,
        weight: f64,
    ) -> Stage {
        let n = fluid.len();
        let columns = Columns::new(fluid);
        let start = Kept::new(&mut stages.start);
        let sum = stages.sum.as_mut().map(Kept::new);
        let (acceleration, rate, mass) = (&fluid.acceleration, &fluid.density_rate, &fluid.mass);
        let damper = R::from_f64(self.bulk_viscosity);
        let (zero, square) = for_ranges(
            n,
            || (0.0, 0.0),
            |a, b| (a.0 + b.0, f64::max(a.1, b.1)),
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let (part, start) = unsafe { (columns.part(&range), start.part(&range)) };
                // SAFETY: as above.
                let mut sum = sum.as_ref().map(|s| unsafe { s.part(&range) });
                let m = &mass[range.clone()];
                let rate = &rate[range.clone()];
                let acceleration: [&[R]; D] =
                    std::array::from_fn(|a| &acceleration[a][range.clone()]);
                let (mut zero, mut longest) = (0.0, 0.0f64);
                for i in 0..m.len() {
                    let mut square = 0.0;
                    for a in 0..D {
                        let v = part.velocity[a][i];
                        let total = acceleration[a][i].to_f64() + self.gravity[a];
                        if let Some(sum) = &mut sum {
                            sum.position[a][i] += weight * v;
                            sum.velocity[a][i] += weight * total;
                        }
                        let way = ahead * v;
                        let velocity = start.velocity[a][i] + ahead * total;
                        part.position[a][i] = start.position[a][i] + way;
                        part.velocity[a][i] = velocity;
                        part.pair_velocity[a][i] = R::from_f64(velocity);
                        square += way * way;
                        zero += trace(part.position[a][i] + velocity);
                    }
                    longest = longest.max(square);
                    if let Some(sum) = &mut sum {
                        sum.density[i] += weight * rate[i].to_f64();
                    }
                    let density = start.density[i] + ahead * rate[i].to_f64();
                    part.density[i] = density;
                    self.pair_state(density, m[i], i, &mut *part.condensation, &mut *part.volume);
                    let pressure: R = self.eos.pressure(part.condensation[i]);
                    part.pressure[i] = pressure + damper * rate[i];
                    zero += trace(part.pressure[i].to_f64() + part.volume[i].to_f64());
                }
                (zero, longest)
            },
        );
        Stage {
            finite: zero == 0.0,
            way: square.sqrt(),
        }
    }

    /// The outcome of a step: the state at its start, the sum, and the present rates times `weight` (s).
    pub fn arrive<R: Real>(&self, fluid: &mut Fluid<R, D>, weight: f64) -> (State, f64) {
        let Some(mut stages) = fluid.stages.take() else {
            return (State::EMPTY, 0.0);
        };
        let n = fluid.len();
        let columns = Columns::new(fluid);
        let start = Kept::new(&mut stages.start);
        let sum = stages.sum.as_mut().map(Kept::new);
        let (acceleration, rate) = (&fluid.acceleration, &fluid.density_rate);
        let (mut state, square) = for_ranges(
            n,
            || (State::EMPTY, 0.0),
            |a, b| (a.0.join(b.0), f64::max(a.1, b.1)),
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let (part, start) = unsafe { (columns.part(&range), start.part(&range)) };
                // SAFETY: as above.
                let sum = sum.as_ref().map(|s| unsafe { s.part(&range) });
                let rate = &rate[range.clone()];
                let acceleration: [&[R]; D] =
                    std::array::from_fn(|a| &acceleration[a][range.clone()]);
                let mut state = State::EMPTY;
                let (mut zero, mut longest) = (0.0, 0.0f64);
                for i in 0..rate.len() {
                    let (mut v2, mut a2, mut square) = (0.0, 0.0, 0.0);
                    for a in 0..D {
                        let total = acceleration[a][i].to_f64() + self.gravity[a];
                        let mut way = weight * part.velocity[a][i];
                        let mut change = weight * total;
                        if let Some(sum) = &sum {
                            way += sum.position[a][i];
                            change += sum.velocity[a][i];
                        }
                        let velocity = start.velocity[a][i] + change;
                        part.position[a][i] = start.position[a][i] + way;
                        part.velocity[a][i] = velocity;
                        v2 += velocity * velocity;
                        a2 += total * total;
                        square += way * way;
                        zero += trace(part.position[a][i]);
                    }
                    let mut density = start.density[i] + weight * rate[i].to_f64();
                    if let Some(sum) = &sum {
                        density += sum.density[i];
                    }
                    part.density[i] = density;
                    zero += trace(v2 + a2 + density);
                    longest = longest.max(square);
                    state.speed = state.speed.max(v2);
                    state.acceleration = state.acceleration.max(a2);
                    state.density_min = state.density_min.min(density);
                    state.density_max = state.density_max.max(density);
                }
                state.finite = zero == 0.0;
                (state, longest)
            },
        );
        state.speed = state.speed.sqrt();
        state.acceleration = state.acceleration.sqrt();
        fluid.stages = Some(stages);
        (state, square.sqrt())
    }
}
