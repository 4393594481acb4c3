//! What a simulation is told, all numbers resolved.

use crate::effects::{HerschelBulkleyConfig, Transport, TurbulenceConfig};
use crate::error::{Error, Result};
use crate::kernel::KernelName;
use crate::prescribed::{MotionConfig, SignalConfig};
use crate::step::Integrator;
use crate::walls::{Slip, WallMethod};
use serde::{Deserialize, Serialize};
use std::num::NonZeroU32;

/// The resolved description of a simulation; the particles come beside it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// 2 or 3.
    pub dimension: usize,
    /// Initial particle spacing in m.
    pub spacing: f64,
    /// Smoothing length in m.
    pub smoothing_length: f64,
    /// Smoothing kernel.
    #[serde(default)]
    pub kernel: KernelName,
    /// Gravity in m/s²; absent: none.
    #[serde(default)]
    pub gravity: Option<Vec<f64>>,
    /// What gravity changes by in the course of time: each part a signal along a direction.
    #[serde(default)]
    pub gravity_over_time: Vec<GravityConfig>,
    /// Walls that move.
    #[serde(default)]
    pub motion: Vec<MotionConfig>,
    /// Per axis `[low, high]` in m where it is periodic.
    #[serde(default)]
    pub periodic: Vec<Option<[f64; 2]>>,
    /// Density at rest in kg/m³.
    pub reference_density: f64,
    /// Speed of sound at rest in m/s.
    pub sound_speed: f64,
    /// Equation of state.
    #[serde(default)]
    pub eos: EosName,
    /// Exponent of Tait's equation.
    #[serde(default = "seven")]
    pub gamma: f64,
    /// Pressure at rest in Pa.
    #[serde(default)]
    pub background_pressure: f64,
    /// Monaghan's artificial viscosity.
    #[serde(default)]
    pub artificial_viscosity: Option<ArtificialViscosityConfig>,
    /// Laminar viscosity.
    #[serde(default)]
    pub laminar_viscosity: Option<LaminarViscosityConfig>,
    /// Turbulence below the particle scale.
    #[serde(default)]
    pub turbulence: Option<TurbulenceConfig>,
    /// A liquid with yield stress.
    #[serde(default)]
    pub herschel_bulkley: Option<HerschelBulkleyConfig>,
    /// Surface tension in N/m.
    #[serde(default)]
    pub surface_tension: Option<f64>,
    /// Rate in 1/s at which drag slows the fluid.
    #[serde(default)]
    pub linear_drag: Option<f64>,
    /// Density diffusion.
    #[serde(default)]
    pub density_diffusion: Option<DensityDiffusionConfig>,
    /// Coefficient of the acoustic damper, in units of `h c0`: a bulk viscosity that takes up sound and leaves the
    /// flow of an incompressible fluid alone (Sun, Pilloton, Antuono & Colagrossi 2023).
    #[serde(default)]
    pub acoustic_damper: Option<f64>,
    /// Particle shifting.
    #[serde(default)]
    pub shifting: Option<ShiftingConfig>,
    /// What keeps fluid under tension from clumping.
    #[serde(default)]
    pub tensile_control: Option<TensileControlConfig>,
    /// Whether approaching particles meet as in a Riemann problem.
    #[serde(default)]
    pub riemann_viscosity: bool,
    /// Walls.
    #[serde(default)]
    pub wall: Option<WallConfig>,
    /// How the equations are integrated in time.
    #[serde(default)]
    pub integrator: Integrator,
    /// Courant number; absent: the integrator's own.
    #[serde(default)]
    pub courant: Option<f64>,
    /// Fixed time step in s.
    #[serde(default)]
    pub time_step: Option<f64>,
    /// Whether a state is kept in memory to go back to on trouble; without, trouble ends the run.
    #[serde(default = "yes")]
    pub guard: bool,
}

fn seven() -> f64 {
    7.0
}

/// A part of gravity that depends on time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GravityConfig {
    /// Where it acts.
    pub direction: Vec<f64>,
    /// Its strength in m/s² per length of the direction.
    pub signal: SignalConfig,
}

/// Equations of state by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EosName {
    /// Tait's.
    #[default]
    Tait,
    /// Linear.
    Linear,
}

/// Coefficients of the artificial viscosity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArtificialViscosityConfig {
    /// Linear coefficient.
    pub alpha: f64,
    /// Quadratic coefficient.
    #[serde(default)]
    pub beta: f64,
}

/// A Newtonian fluid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LaminarViscosityConfig {
    /// Kinematic viscosity in m²/s.
    pub kinematic: f64,
    /// Form of the pair sum.
    #[serde(default)]
    pub form: ViscosityForm,
}

/// Forms of laminar viscosity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ViscosityForm {
    /// Morris, Fox & Zhu 1997: for flow without a free surface.
    #[default]
    Morris,
    /// Monaghan & Gingold 1983: also under a free surface.
    MonaghanGingold,
}

/// Density diffusion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DensityDiffusionConfig {
    /// Its form.
    pub form: DiffusionForm,
    /// Its coefficient δ.
    pub delta: f64,
}

/// Forms of density diffusion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DiffusionForm {
    /// Molteni & Colagrossi 2009.
    Molteni,
    /// Antuono et al. 2010.
    Antuono,
    /// Fourtakas et al. 2019.
    Fourtakas,
    /// Zhang, Hu & Adams 2017.
    Riemann,
}

/// Particle shifting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShiftingConfig {
    /// Its form.
    pub form: ShiftingForm,
    /// Whether there is a free surface to keep.
    #[serde(default = "yes")]
    pub free_surface: bool,
    /// Steps from one shift to the next, which moves particles as far as all of them would have.
    #[serde(default = "one")]
    pub every: NonZeroU32,
}

fn yes() -> bool {
    true
}

fn one() -> NonZeroU32 {
    NonZeroU32::MIN
}

/// What keeps fluid under tension from clumping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TensileControlConfig {
    /// Its form.
    pub form: TensileForm,
    /// Whether there is a free surface, which is left to its tension.
    #[serde(default = "yes")]
    pub free_surface: bool,
}

/// Remedies against tensile instability.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TensileForm {
    /// Differences of pressure, Sun et al. 2018.
    Sun,
    /// Artificial stress, Monaghan 2000.
    Monaghan,
}

/// Forms of particle shifting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShiftingForm {
    /// Sun et al. 2017.
    Sun,
    /// As `Sun`, weaker and hardly through a surface: only with a free surface.
    Gentle,
    /// Lind et al. 2012.
    Lind,
    /// As `Sun`, and the particles take the fields along: Sun et al. 2019.
    Consistent,
    /// Transport velocity, Adami, Hu & Adams 2013: not with a free surface.
    TransportVelocity,
}

impl ShiftingForm {
    /// How the fields follow the shift, if they do.
    pub fn transport(self) -> Option<Transport> {
        match self {
            ShiftingForm::Sun | ShiftingForm::Gentle | ShiftingForm::Lind => None,
            ShiftingForm::Consistent => Some(Transport::Differences),
            ShiftingForm::TransportVelocity => Some(Transport::Stress),
        }
    }
}

/// Walls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallConfig {
    /// Boundary method.
    pub method: WallMethod,
    /// Slip or no slip.
    pub slip: Slip,
    /// Whether the wall may pull at the fluid; absent: only where some axis is periodic (no free surface).
    #[serde(default)]
    pub suction: Option<bool>,
}

impl Config {
    /// Checks all numbers; the message names the key, what was found and what is allowed.
    pub fn validate(&self) -> Result<()> {
        let positive = |key: &str, value: f64| {
            if value > 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(Error::Input(format!(
                    "{key}: found {value}, allowed is a finite number above 0"
                )))
            }
        };
        let not_negative = |key: &str, value: f64| {
            if value >= 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(Error::Input(format!(
                    "{key}: found {value}, allowed is a finite number of at least 0"
                )))
            }
        };
        if !matches!(self.dimension, 2 | 3) {
            return Err(Error::Input(format!(
                "dimension: found {}, allowed are 2 and 3",
                self.dimension
            )));
        }
        positive("spacing", self.spacing)?;
        positive("smoothing_length", self.smoothing_length)?;
        // Sums over the lattice within the support, made once, are that many terms to the power of the dimension.
        if self.smoothing_length > 100.0 * self.spacing {
            return Err(Error::Input(format!(
                "smoothing_length: found {:e}, allowed is at most 100 spacings of {:e}",
                self.smoothing_length, self.spacing
            )));
        }
        positive("reference_density", self.reference_density)?;
        positive("sound_speed", self.sound_speed)?;
        positive("gamma", self.gamma)?;
        not_negative("background_pressure", self.background_pressure)?;
        if let Some(v) = self.artificial_viscosity {
            not_negative("artificial_viscosity.alpha", v.alpha)?;
            not_negative("artificial_viscosity.beta", v.beta)?;
        }
        if let Some(v) = self.laminar_viscosity {
            not_negative("laminar_viscosity.kinematic", v.kinematic)?;
        }
        if let Some(t) = self.turbulence {
            not_negative("turbulence.smagorinsky", t.smagorinsky)?;
        }
        if let Some(v) = self.herschel_bulkley {
            not_negative("herschel_bulkley.yield_stress", v.yield_stress)?;
            not_negative("herschel_bulkley.consistency", v.consistency)?;
            positive("herschel_bulkley.index", v.index)?;
            if let Some(bound) = v.max_viscosity {
                positive("herschel_bulkley.max_viscosity", bound)?;
            }
        }
        if let Some(sigma) = self.surface_tension {
            positive("surface_tension", sigma)?;
        }
        if let Some(rate) = self.linear_drag {
            positive("linear_drag", rate)?;
        }
        if let Some(d) = self.density_diffusion {
            not_negative("density_diffusion.delta", d.delta)?;
        }
        if let Some(a) = self.acoustic_damper {
            not_negative("acoustic_damper", a)?;
        }
        if let Some(s) = self.shifting
            && s.form == ShiftingForm::TransportVelocity
            && s.free_surface
        {
            return Err(Error::Input(
                "shifting.form: found transport-velocity with a free surface, which its background pressure would drive \
                 apart; allowed there are sun, consistent and lind"
                    .to_owned(),
            ));
        }
        if let Some(s) = self.shifting
            && s.form == ShiftingForm::Gentle
            && !s.free_surface
        {
            return Err(Error::Input(
                "shifting.form: found gentle without a free surface, which it is for; allowed there are sun, consistent, \
                 lind and transport-velocity"
                    .to_owned(),
            ));
        }
        if let Some(wall) = self.wall.filter(|w| !w.method.uses_particles())
            && self.tensile_control.is_some()
        {
            return Err(Error::Input(format!(
                "tensile_control: found one beside the wall method {:?}, allowed are walls of particles: choose adami, \
                 dynamic or modified-dynamic walls, or leave it out",
                wall.method
            )));
        }
        if let Some(c) = self.courant {
            positive("courant", c)?;
        }
        if let Some(dt) = self.time_step {
            positive("time_step", dt)?;
        }
        if let Some(g) = &self.gravity
            && (g.len() != self.dimension || g.iter().any(|g| !g.is_finite()))
        {
            return Err(Error::Input(format!(
                "gravity: found {g:?}, allowed are {} finite numbers",
                self.dimension
            )));
        }
        for part in &self.gravity_over_time {
            if part.direction.len() != self.dimension
                || part.direction.iter().any(|g| !g.is_finite())
            {
                return Err(Error::Input(format!(
                    "gravity_over_time.direction: found {:?}, allowed are {} finite numbers",
                    part.direction, self.dimension
                )));
            }
            part.signal.build("gravity_over_time")?;
        }
        for motion in &self.motion {
            motion.build(self.dimension)?;
        }
        if !self.periodic.is_empty() && self.periodic.len() != self.dimension {
            return Err(Error::Input(format!(
                "periodic: found {} axes, allowed are {}",
                self.periodic.len(),
                self.dimension
            )));
        }
        let support = self.smoothing_length * self.kernel.support();
        for (axis, period) in self.periodic.iter().enumerate() {
            if let Some([low, high]) = period
                && !(low.is_finite() && high.is_finite() && high - low >= support)
            {
                return Err(Error::Input(format!(
                    "periodic[{axis}]: found [{low}, {high}], allowed is a length of at least the support radius \
                     {support}; choose a smaller spacing or a longer period"
                )));
            }
        }
        Ok(())
    }

    /// Gravity, zero where absent.
    pub fn gravity<const D: usize>(&self) -> [f64; D] {
        std::array::from_fn(|a| self.gravity.as_ref().map_or(0.0, |g| g[a]))
    }

    /// The period of each axis.
    pub fn period<const D: usize>(&self) -> [Option<[f64; 2]>; D] {
        std::array::from_fn(|a| self.periodic.get(a).copied().flatten())
    }
}
