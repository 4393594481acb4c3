//! The whole-array stages of the symplectic step.
//!
//! Position Verlet, with density staggered like position: half a drift, kick by the sweep of forces at the middle,
//! half a drift, rate of density by the sweep of continuity at the end with the new velocity. Both sweeps are
//! explicit, each rate is evaluated once a step, and an acoustic oscillation neither grows nor decays: velocity always
//! sees the newest density, and density the newest velocity (as in Zhang, Hu & Adams 2017, SPHinXsys). Dissipative
//! terms, which depend on what they change, see it extrapolated from the last rates, which keeps second order.

use crate::eos::{AnyEos, EquationOfState};
use crate::particles::{Fluid, Shared, for_ranges};
use crate::simd::Real;
use std::ops::Range;

/// Constants of the stages.
#[derive(Clone, Copy, Debug)]
pub struct Motion<const D: usize> {
    /// Gravity in m/s².
    pub gravity: [f64; D],
    /// Equation of state.
    pub eos: AnyEos,
    /// Bulk viscosity over density in m²/s, which damps sound: `p + ν_b dρ/dt`. 0 without.
    pub bulk_viscosity: f64,
}

/// Largest values after a step, for the next time step and for the guard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Largest speed in m/s.
    pub speed: f64,
    /// Largest acceleration in m/s².
    pub acceleration: f64,
    /// Smallest density in kg/m³.
    pub density_min: f64,
    /// Largest density.
    pub density_max: f64,
    /// Whether every number is finite.
    pub finite: bool,
}

impl State {
    /// Of no particles.
    pub const EMPTY: State = State {
        speed: 0.0,
        acceleration: 0.0,
        density_min: f64::INFINITY,
        density_max: 0.0,
        finite: true,
    };

    /// Of two groups of particles.
    pub fn join(self, other: State) -> State {
        State {
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
            density_min: self.density_min.min(other.density_min),
            density_max: self.density_max.max(other.density_max),
            finite: self.finite && other.finite,
        }
    }
}

/// The columns of a fluid as tasks share them.
pub(super) struct Columns<R, const D: usize> {
    pub(super) position: [Shared<f64>; D],
    pub(super) velocity: [Shared<f64>; D],
    pub(super) density: Shared<f64>,
    pub(super) pair_velocity: [Shared<R>; D],
    pub(super) volume: Shared<R>,
    pub(super) pressure: Shared<R>,
    pub(super) condensation: Shared<R>,
}

/// Parts of them that belong to one task.
pub(super) struct Part<'a, R, const D: usize> {
    pub(super) position: [&'a mut [f64]; D],
    pub(super) velocity: [&'a mut [f64]; D],
    pub(super) density: &'a mut [f64],
    pub(super) pair_velocity: [&'a mut [R]; D],
    pub(super) volume: &'a mut [R],
    pub(super) pressure: &'a mut [R],
    pub(super) condensation: &'a mut [R],
}

impl<R: Real, const D: usize> Columns<R, D> {
    pub(super) fn new(fluid: &mut Fluid<R, D>) -> Self {
        Columns {
            position: std::array::from_fn(|a| Shared::new(&mut fluid.position[a])),
            velocity: std::array::from_fn(|a| Shared::new(&mut fluid.velocity[a])),
            density: Shared::new(&mut fluid.density),
            pair_velocity: std::array::from_fn(|a| Shared::new(&mut fluid.pair_velocity[a])),
            volume: Shared::new(&mut fluid.volume),
            pressure: Shared::new(&mut fluid.pressure),
            condensation: Shared::new(&mut fluid.condensation),
        }
    }

    /// # Safety
    /// Ranges held at the same time must be disjoint, and inside the columns, which must outlive the pass.
    pub(super) unsafe fn part<'a>(&self, range: &Range<usize>) -> Part<'a, R, D> {
        // SAFETY: promised by the caller.
        unsafe {
            Part {
                position: std::array::from_fn(|a| self.position[a].range(range)),
                velocity: std::array::from_fn(|a| self.velocity[a].range(range)),
                density: self.density.range(range),
                pair_velocity: std::array::from_fn(|a| self.pair_velocity[a].range(range)),
                volume: self.volume.range(range),
                pressure: self.pressure.range(range),
                condensation: self.condensation.range(range),
            }
        }
    }
}

impl<const D: usize> Motion<D> {
    /// Half a drift of position and density; leaves what the sweep of forces reads. Gives whether all of it is finite:
    /// asked before the sweep, which would spread what is not.
    pub fn first_half<R: Real>(&self, fluid: &mut Fluid<R, D>, dt: f64) -> bool {
        let n = fluid.len();
        let columns = Columns::new(fluid);
        let (acceleration, rate, mass) = (&fluid.acceleration, &fluid.density_rate, &fluid.mass);
        let half = 0.5 * dt;
        let damper = R::from_f64(self.bulk_viscosity);
        for_ranges(
            n,
            || true,
            |a, b| a && b,
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let part = unsafe { columns.part(&range) };
                let m = &mass[range.clone()];
                let rate = &rate[range.clone()];
                // A sum of all numbers times zero is zero, or not a number: one test for all of them.
                let mut zero = 0.0;
                for a in 0..D {
                    let acceleration = &acceleration[a][range.clone()];
                    for i in 0..m.len() {
                        let v = part.velocity[a][i];
                        part.position[a][i] += half * v;
                        let total = acceleration[i].to_f64() + self.gravity[a];
                        part.pair_velocity[a][i] = R::from_f64(v + half * total);
                        zero += 0.0 * (part.position[a][i] + v + total);
                    }
                }
                for i in 0..m.len() {
                    part.density[i] += half * rate[i].to_f64();
                    self.pair_state(
                        part.density[i],
                        m[i],
                        i,
                        &mut *part.condensation,
                        &mut *part.volume,
                    );
                    let pressure: R = self.eos.pressure(part.condensation[i]);
                    part.pressure[i] = pressure + damper * rate[i];
                    zero += 0.0 * (part.pressure[i].to_f64() + part.volume[i].to_f64());
                }
                zero == 0.0
            },
        )
    }

    /// Kick, and half a drift of position; leaves what the sweep of continuity reads. Gives the largest speed.
    pub fn second_half<R: Real>(&self, fluid: &mut Fluid<R, D>, dt: f64) -> f64 {
        let n = fluid.len();
        let columns = Columns::new(fluid);
        let (acceleration, rate, mass) = (&fluid.acceleration, &fluid.density_rate, &fluid.mass);
        let half = 0.5 * dt;
        let speed2 = for_ranges(
            n,
            || 0.0,
            f64::max,
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let part = unsafe { columns.part(&range) };
                let m = &mass[range.clone()];
                let rate = &rate[range.clone()];
                for a in 0..D {
                    let acceleration = &acceleration[a][range.clone()];
                    for i in 0..m.len() {
                        let v =
                            part.velocity[a][i] + dt * (acceleration[i].to_f64() + self.gravity[a]);
                        part.velocity[a][i] = v;
                        part.position[a][i] += half * v;
                        part.pair_velocity[a][i] = R::from_f64(v);
                    }
                }
                let mut speed2 = 0.0f64;
                for i in 0..m.len() {
                    let ahead = part.density[i] + half * rate[i].to_f64();
                    self.pair_state(ahead, m[i], i, &mut *part.condensation, &mut *part.volume);
                    let mut v2 = 0.0;
                    for a in 0..D {
                        v2 += part.velocity[a][i] * part.velocity[a][i];
                    }
                    speed2 = speed2.max(v2);
                }
                speed2
            },
        );
        speed2.sqrt()
    }

    /// The second half of the density's drift.
    pub fn finish<R: Real>(&self, fluid: &mut Fluid<R, D>, dt: f64) -> State {
        let n = fluid.len();
        let columns = Columns::new(fluid);
        let (acceleration, rate) = (&fluid.acceleration, &fluid.density_rate);
        let half = 0.5 * dt;
        let mut state = for_ranges(
            n,
            || State::EMPTY,
            State::join,
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let part = unsafe { columns.part(&range) };
                let rate = &rate[range.clone()];
                let acceleration: [&[R]; D] =
                    std::array::from_fn(|a| &acceleration[a][range.clone()]);
                let mut state = State::EMPTY;
                // A sum of all numbers times zero is zero, or not a number: one test for all of them.
                let mut zero = 0.0;
                for i in 0..rate.len() {
                    let density = part.density[i] + half * rate[i].to_f64();
                    part.density[i] = density;
                    let (mut v2, mut a2) = (0.0, 0.0);
                    for a in 0..D {
                        let v = part.velocity[a][i];
                        let acc = acceleration[a][i].to_f64() + self.gravity[a];
                        v2 += v * v;
                        a2 += acc * acc;
                        zero += 0.0 * part.position[a][i];
                    }
                    zero += 0.0 * (v2 + a2 + density);
                    state.speed = state.speed.max(v2);
                    state.acceleration = state.acceleration.max(a2);
                    state.density_min = state.density_min.min(density);
                    state.density_max = state.density_max.max(density);
                }
                state.finite = zero == 0.0;
                state
            },
        );
        state.speed = state.speed.sqrt();
        state.acceleration = state.acceleration.sqrt();
        state
    }

    /// Speed of sound at a density.
    pub fn sound_speed(&self, density: f64) -> f64 {
        self.eos.sound_speed(density)
    }

    /// Condensation and volume of particle `i` of a part.
    #[inline(always)]
    pub(super) fn pair_state<R: Real>(
        &self,
        density: f64,
        mass: R,
        i: usize,
        condensation: &mut [R],
        volume: &mut [R],
    ) {
        let reference = self.eos.reference_density();
        condensation[i] = R::from_f64((density - reference) / reference);
        volume[i] = R::from_f64(mass.to_f64() / density);
    }
}
