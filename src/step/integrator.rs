//! The integrators by name, and what those of several stages ask of what they integrate.

use serde::{Deserialize, Serialize};

/// Integrators by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// Position Verlet with staggered density: [`super::Motion`].
    #[default]
    #[serde(rename = "symplectic")]
    Symplectic,
    /// [`super::predictor_corrector`].
    #[serde(rename = "predictor-corrector")]
    PredictorCorrector,
    /// [`super::runge_kutta_2`].
    #[serde(rename = "rk2")]
    RungeKutta2,
    /// [`super::runge_kutta_4`].
    #[serde(rename = "rk4")]
    RungeKutta4,
}

impl Integrator {
    /// All of them.
    pub const ALL: [Integrator; 4] = [
        Integrator::Symplectic,
        Integrator::PredictorCorrector,
        Integrator::RungeKutta2,
        Integrator::RungeKutta4,
    ];

    /// Its name in scenes and reports.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::Symplectic => "symplectic",
            Integrator::PredictorCorrector => "predictor-corrector",
            Integrator::RungeKutta2 => "rk2",
            Integrator::RungeKutta4 => "rk4",
        }
    }

    /// Largest stable Courant number: noise on a lattice decays below it, and grows above it, with the default density
    /// diffusion, and with the acoustic damper too (`tests/integrators.rs`).
    pub fn stability_limit(self) -> f64 {
        match self {
            Integrator::Symplectic => 1.25,
            Integrator::PredictorCorrector => 1.05,
            Integrator::RungeKutta2 => 0.53,
            Integrator::RungeKutta4 => 1.85,
        }
    }

    /// The Courant number that is used where a scene names none: about 0.4 of the largest stable one, a margin for
    /// disorder, walls and impacts.
    pub fn courant(self) -> f64 {
        match self {
            Integrator::Symplectic => 0.5,
            Integrator::PredictorCorrector => 0.4,
            Integrator::RungeKutta2 => 0.2,
            Integrator::RungeKutta4 => 0.7,
        }
    }

    /// Sets of columns that it keeps beside the state: the start of the step, and a sum over stages.
    pub fn columns(self) -> usize {
        match self {
            Integrator::Symplectic => 0,
            Integrator::PredictorCorrector | Integrator::RungeKutta2 => 1,
            Integrator::RungeKutta4 => 2,
        }
    }
}

/// A system `dy/dt = f(y, t)` in the hands of an integrator of several stages.
///
/// It holds its state `y`, the state `y0` at the start of the step, the rates found last, and their weighted sum over the
/// stages so far.
pub trait System {
    /// Why a stage cannot be.
    type Trouble;

    /// Makes the present state `y0`.
    ///
    /// # Errors
    /// A state that is not finite.
    fn begin(&mut self) -> Result<(), Self::Trouble>;

    /// Goes to `y0 + ahead · f` with the rates found last, and adds `weight · f` to the sum; both in s.
    ///
    /// # Errors
    /// A state that is not finite: no rates may be asked of it.
    fn stage(&mut self, ahead: f64, weight: f64) -> Result<(), Self::Trouble>;

    /// Finds the rates of the present state, of the time `since` (s) after the start of the step of `dt` (s).
    fn rates(&mut self, since: f64, dt: f64);

    /// Finds the rates of the present state, which is that of the middle of the step of `dt` (s) as well as it is known,
    /// and looks at them.
    fn middle(&mut self, dt: f64);

    /// Goes to the outcome: `y0`, the sum, and `weight · f` with the rates found last, `dt` (s) after the start.
    fn arrive(&mut self, weight: f64, dt: f64);
}
