//! Smoothing kernels `W(r, h) = σ_D / h^D · w(q)` with `q = r / h`, one file each.
//!
//! A simulation runs one kernel as a static type ([`with_kernel!`] turns a name into it); the methods of
//! [`KernelName`] evaluate any kernel in one, two or three dimensions for users, plots and tests.

mod cubic;
mod name;
mod quintic;
mod scaled;
mod wendland_c2;
mod wendland_c4;
mod wendland_c6;

pub use cubic::Cubic;
pub use name::{KernelName, UnknownKernel};
pub use quintic::Quintic;
pub use scaled::Scaled;
pub use wendland_c2::WendlandC2;
pub use wendland_c4::WendlandC4;
pub use wendland_c6::WendlandC6;

use crate::simd::Lanes;

/// A smoothing kernel, written for lanes. Its gradient is used as `∇W = F r_ij` with
/// `F = σ_D / h^(D+2) · w'(q)/q`, which needs no division by the distance and is finite at zero.
pub trait Kernel: Copy + Send + Sync + 'static {
    /// Support radius in smoothing lengths.
    const SUPPORT: f64;
    /// Its name in scenes and in Python.
    const NAME: KernelName;
    /// `σ_D` in `dimension` 1, 2 or 3.
    fn normalisation(dimension: usize) -> f64;
    /// `w(q)` in two and three dimensions; meaningful for `0 <= q <= SUPPORT` only: the caller masks the rest.
    fn shape<L: Lanes>(q: L) -> L;
    /// `w'(q) / q` in two and three dimensions; the same range.
    fn slope_over_q<L: Lanes>(q: L) -> L;
    /// `w(q)` in one dimension, where Wendland's functions are other polynomials.
    #[inline(always)]
    fn shape_1d(q: f64) -> f64 {
        Self::shape(q)
    }
    /// `w'(q) / q` in one dimension.
    #[inline(always)]
    fn slope_over_q_1d(q: f64) -> f64 {
        Self::slope_over_q(q)
    }
}

/// Evaluates an expression with a kernel's static type, chosen by its name at run time.
///
/// ```
/// use kolk::kernel::{Kernel, KernelName};
/// let support = kolk::with_kernel!(KernelName::Quintic, K => K::SUPPORT);
/// assert_eq!(support, 3.0);
/// ```
#[macro_export]
macro_rules! with_kernel {
    ($name:expr, $kernel:ident => $body:expr) => {
        match $name {
            $crate::kernel::KernelName::Cubic => {
                type $kernel = $crate::kernel::Cubic;
                $body
            }
            $crate::kernel::KernelName::Quintic => {
                type $kernel = $crate::kernel::Quintic;
                $body
            }
            $crate::kernel::KernelName::WendlandC2 => {
                type $kernel = $crate::kernel::WendlandC2;
                $body
            }
            $crate::kernel::KernelName::WendlandC4 => {
                type $kernel = $crate::kernel::WendlandC4;
                $body
            }
            $crate::kernel::KernelName::WendlandC6 => {
                type $kernel = $crate::kernel::WendlandC6;
                $body
            }
        }
    };
}
