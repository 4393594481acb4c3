//! What the guard makes of trouble: how often it tries again, how long it stays careful, and what it lets pass.

/// Snapshots whose energies are remembered: what contact stores for some steps may come back.
pub(super) const MEMORY: usize = 4;
/// More than any energy or distance: in place of those before the first snapshots.
pub(super) const UNKNOWN: f64 = f64::MAX;
/// Attempts from one snapshot, each with half the step of the last.
const ATTEMPTS: u64 = 6;
/// Attempts against trouble that leaves the state sound; it is let pass after them.
const ATTEMPTS_IF_SOUND: u64 = 2;
/// The smallest share of the regular time step.
const SMALLEST: f64 = 1.0 / 4096.0;
/// Steps without trouble before the step grows again, after the first; each further trouble doubles them.
const PATIENCE: u64 = 64;
const LONGEST_PATIENCE: u64 = 1 << 16;
/// Steps during which a check is silent after what it found was let pass; each further time doubles them.
const SILENCE: u64 = 1024;
const LONGEST_SILENCE: u64 = 1 << 20;

/// What can be wrong with a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A number that is none.
    NotFinite,
    /// A density that no weakly compressible fluid has.
    Density,
    /// A step too long for the speeds or accelerations that it made.
    Overshoot,
    /// A step so short that the run would not end.
    TimeStep,
    /// Energy that came from nowhere.
    Energy,
    /// Particles that came much too close.
    Closeness,
}

impl Trouble {
    /// All of them.
    pub const ALL: [Trouble; 6] = [
        Trouble::NotFinite,
        Trouble::Density,
        Trouble::Overshoot,
        Trouble::TimeStep,
        Trouble::Energy,
        Trouble::Closeness,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Trouble::NotFinite => "not finite",
            Trouble::Density => "density",
            Trouble::Overshoot => "overshoot",
            Trouble::TimeStep => "time step",
            Trouble::Energy => "energy",
            Trouble::Closeness => "closeness",
        }
    }

    /// Whether the state can be used nevertheless, if a shorter step does not help.
    fn leaves_sound(self) -> bool {
        matches!(
            self,
            Trouble::Overshoot | Trouble::Energy | Trouble::Closeness
        )
    }
}

/// What the guard did so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Retries {
    /// How often each [`Trouble`] made it go back.
    pub retries: [u64; Trouble::ALL.len()],
    /// How often each was let pass because a shorter step did not help.
    pub passed: [u64; Trouble::ALL.len()],
    /// Steps taken back.
    pub undone: u64,
}

/// What decides, apart from the snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Memory {
    /// Share of the regular time step.
    pub(super) factor: f64,
    /// Energies at the last snapshots in J.
    pub(super) energies: [f64; MEMORY],
    /// Distance of the closest pair at the last snapshot, in spacings.
    pub(super) closest: f64,
    /// Time in s of the last trouble since the snapshot: no other is taken before it, or a shorter step would seem to
    /// help by covering less time.
    pub(super) passes: f64,
    /// Attempts from the present snapshot.
    pub(super) attempts: u64,
    /// Steps without trouble.
    pub(super) calm: u64,
    /// Steps without trouble until the step may grow.
    pub(super) patience: u64,
    /// Steps done at which a check speaks again.
    pub(super) silent_until: [u64; Trouble::ALL.len()],
    pub(super) record: Retries,
}

impl Default for Memory {
    fn default() -> Self {
        Memory {
            factor: 1.0,
            energies: [UNKNOWN; MEMORY],
            closest: UNKNOWN,
            passes: 0.0,
            attempts: 0,
            calm: 0,
            patience: PATIENCE,
            silent_until: [0; Trouble::ALL.len()],
            record: Retries::default(),
        }
    }
}

/// What is done about trouble.
pub(super) enum Verdict {
    Retry,
    LetPass,
    Stop,
}

impl Memory {
    /// Judges a trouble after `step` steps.
    pub(super) fn judge(&mut self, trouble: Trouble) -> Verdict {
        let sound = trouble.leaves_sound();
        if sound && self.attempts >= ATTEMPTS_IF_SOUND {
            return Verdict::LetPass;
        }
        if self.attempts >= ATTEMPTS || self.factor <= SMALLEST {
            return if sound {
                Verdict::LetPass
            } else {
                Verdict::Stop
            };
        }
        Verdict::Retry
    }

    /// Halves the step, and grows wary.
    pub(super) fn shorten(&mut self, trouble: Trouble, undone: u64) {
        self.attempts += 1;
        self.factor *= 0.5;
        self.calm = 0;
        self.patience = (2 * self.patience).min(LONGEST_PATIENCE);
        self.record.retries[trouble as usize] += 1;
        self.record.undone += undone;
    }

    /// A shorter step did not help: back to the step before the attempts, and silence.
    pub(super) fn let_pass(&mut self, trouble: Trouble, step: u64) {
        let times = &mut self.record.passed[trouble as usize];
        let silence = SILENCE << (*times).min(20);
        *times += 1;
        self.silent_until[trouble as usize] = step + silence.min(LONGEST_SILENCE);
        self.factor = (self.factor * 2f64.powi(self.attempts as i32)).min(1.0);
    }

    /// After a step without trouble.
    pub(super) fn recover(&mut self) {
        self.calm += 1;
        if self.factor < 1.0 && self.calm >= self.patience {
            self.factor = (2.0 * self.factor).min(1.0);
            self.calm = 0;
        }
    }
}
