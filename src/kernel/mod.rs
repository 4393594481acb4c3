//! Smoothing kernels `W(r, h) = σ_D / h^D · w(q)` with `q = r / h`, one file each.

mod wendland_c2;

pub use wendland_c2::WendlandC2;

use crate::simd::Lanes;

/// A smoothing kernel, written for lanes. Its gradient is used as `∇W = F r_ij` with
/// `F = σ_D / h^(D+2) · w'(q)/q`, which needs no division by the distance and is finite at zero.
pub trait Kernel: Copy + Send + Sync + 'static {
    /// Support radius in smoothing lengths.
    const SUPPORT: f64;
    /// `σ_D` in `dimension` 1, 2 or 3.
    fn normalisation(dimension: usize) -> f64;
    /// `w(q)`; meaningful for `0 <= q <= SUPPORT` only: the caller masks the rest.
    fn shape<L: Lanes>(q: L) -> L;
    /// `w'(q) / q`; the same range.
    fn slope_over_q<L: Lanes>(q: L) -> L;
}
