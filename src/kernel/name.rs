//! The kernels by name, and any of them evaluated for single numbers.

use super::{Kernel, Scaled};
use crate::simd::Lanes;
use crate::with_kernel;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A smoothing kernel by name; written `wendland-c2` and so on in scenes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum KernelName {
    /// Cubic B-spline M4, support 2h.
    Cubic,
    /// Quintic B-spline M6, support 3h.
    Quintic,
    /// Wendland C2, support 2h.
    #[default]
    WendlandC2,
    /// Wendland C4, support 2h.
    WendlandC4,
    /// Wendland C6, support 2h.
    WendlandC6,
}

impl KernelName {
    /// All kernels.
    pub const ALL: [Self; 5] = [
        Self::Cubic,
        Self::Quintic,
        Self::WendlandC2,
        Self::WendlandC4,
        Self::WendlandC6,
    ];

    /// The name as it is written.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Cubic => "cubic",
            Self::Quintic => "quintic",
            Self::WendlandC2 => "wendland-c2",
            Self::WendlandC4 => "wendland-c4",
            Self::WendlandC6 => "wendland-c6",
        }
    }

    /// `w(q)` in two and three dimensions on lanes.
    #[inline(always)]
    pub(crate) fn shape<L: Lanes>(self, q: L) -> L {
        with_kernel!(self, K => K::shape(q))
    }

    /// `w'(q) / q` in two and three dimensions on lanes.
    #[inline(always)]
    pub(crate) fn slope_over_q<L: Lanes>(self, q: L) -> L {
        with_kernel!(self, K => K::slope_over_q(q))
    }

    /// `σ_D`.
    pub(crate) fn normalisation(self, dimension: usize) -> f64 {
        with_kernel!(self, K => K::normalisation(dimension))
    }

    /// Support radius in smoothing lengths.
    pub fn support(self) -> f64 {
        with_kernel!(self, K => K::SUPPORT)
    }

    /// `W(r, h)` [m^-D] in `dimension` 1, 2 or 3; zero beyond the support.
    ///
    /// # Panics
    /// In any other dimension: what users give is checked before (`kolk.kernel`), the engine has two and three.
    pub fn value(self, dimension: usize, r: f64, h: f64) -> f64 {
        match dimension {
            1 => Scaled::<1>::new(self, h).value(r),
            2 => Scaled::<2>::new(self, h).value(r),
            3 => Scaled::<3>::new(self, h).value(r),
            _ => panic!("a kernel has 1, 2 or 3 dimensions, not {dimension}"),
        }
    }

    /// `dW/dr (r, h)` [m^-(D+1)] in `dimension` 1, 2 or 3; zero beyond the support, negative inside.
    ///
    /// # Panics
    /// In any other dimension: what users give is checked before (`kolk.kernel`), the engine has two and three.
    pub fn gradient(self, dimension: usize, r: f64, h: f64) -> f64 {
        r * match dimension {
            1 => Scaled::<1>::new(self, h).slope_over_r(r),
            2 => Scaled::<2>::new(self, h).slope_over_r(r),
            3 => Scaled::<3>::new(self, h).slope_over_r(r),
            _ => panic!("a kernel has 1, 2 or 3 dimensions, not {dimension}"),
        }
    }
}

impl fmt::Display for KernelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// A name that no kernel has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no kernel is called {0:?}: choose one of cubic, quintic, wendland-c2, wendland-c4, wendland-c6"
)]
pub struct UnknownKernel(pub String);

impl FromStr for KernelName {
    type Err = UnknownKernel;

    fn from_str(name: &str) -> Result<Self, UnknownKernel> {
        let known = Self::ALL.into_iter().find(|kernel| kernel.as_str() == name);
        known.ok_or_else(|| UnknownKernel(name.to_owned()))
    }
}
