//! What can go wrong, each said once and completely.

use thiserror::Error;

/// Every failure of the engine.
#[derive(Debug, Error)]
pub enum Error {
    /// The configuration or the particles handed in cannot be computed.
    #[error("{0}")]
    Input(String),
    /// The run cannot go on.
    #[error("{0}")]
    Instability(Box<Instability>),
}

/// Why a run stopped: when, which particle, where, which quantity, the probable cause and what to change.
#[derive(Debug, Clone, PartialEq)]
pub struct Instability {
    /// Simulated time in s.
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// The particle's id, in the order in which the fluid's particles were given.
    pub particle: u32,
    /// Where it is, in m.
    pub position: Vec<f64>,
    /// What is wrong with it.
    pub quantity: &'static str,
    /// The value found.
    pub value: f64,
    /// The probable cause.
    pub cause: String,
    /// What to change.
    pub remedy: String,
}

impl std::fmt::Display for Instability {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "unstable at t = {:.6e} s (step {}): {} of particle {} at {:?} is {:.6e}. Probable cause: {}. What to do: {}.",
            self.time,
            self.step,
            self.quantity,
            self.particle,
            self.position,
            self.value,
            self.cause,
            self.remedy
        )
    }
}

/// The result of everything that can fail.
pub type Result<T> = std::result::Result<T, Error>;
