//! Time by phase.

use std::time::{Duration, Instant};

/// The phases of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Phase {
    /// Sorting into cells.
    Sort,
    /// Wall values.
    Walls,
    /// The sweep of forces.
    Forces,
    /// Effects that few scenes call for.
    Stages,
    /// The sweep of continuity.
    Continuity,
    /// Whole-array stages.
    Integrate,
    /// Particle shifting.
    Shift,
    /// Checks.
    Guard,
    /// The powers of the effects, once in some steps.
    Budget,
}

/// Names of the phases, in their order.
pub const PHASES: [&str; 9] = [
    "sort",
    "walls",
    "forces",
    "stages",
    "continuity",
    "integrate",
    "shift",
    "guard",
    "budget",
];

/// Seconds and calls per phase.
#[derive(Clone, Debug)]
pub struct Timers {
    spent: [(Duration, u64); PHASES.len()],
    since: Instant,
}

impl Default for Timers {
    fn default() -> Self {
        Timers {
            spent: Default::default(),
            since: Instant::now(),
        }
    }
}

impl Timers {
    /// Starts the clock.
    pub fn start(&mut self) {
        self.since = Instant::now();
    }

    /// Books the time since the last booking.
    pub fn book(&mut self, phase: Phase) {
        let now = Instant::now();
        let (spent, calls) = &mut self.spent[phase as usize];
        *spent += now - self.since;
        *calls += 1;
        self.since = now;
    }

    /// Name, seconds and calls of each phase that ran.
    pub fn report(&self) -> impl Iterator<Item = (&'static str, f64, u64)> {
        PHASES
            .iter()
            .zip(&self.spent)
            .filter(|(_, s)| s.1 > 0)
            .map(|(n, s)| (*n, s.0.as_secs_f64(), s.1))
    }
}
