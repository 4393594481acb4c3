//! Lanes of real numbers: the arithmetic of an effect is written once, for a [`Lanes`] type, and runs on
//! whatever vector unit the machine has. [`dispatch`] is the one place that chooses it, at run time.

mod array;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod dispatch;
mod peak;

pub use dispatch::{Level, Task, available_levels, dispatch, force_level, level};
pub use peak::peak_flops;

use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A real number type in which pairs are computed: `f64`, or `f32` in mixed precision.
pub trait Real:
    Copy
    + Default
    + Debug
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + Sum
    + Lanes<Real = Self>
{
    /// Lanes that every machine has.
    type Baseline: Lanes<Real = Self>;
    /// Lanes of 256 bits with fused multiply-add.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Lanes<Real = Self>;
    /// Lanes of 512 bits.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Lanes<Real = Self>;

    /// Rounds to this type.
    fn from_f64(x: f64) -> Self;
    /// Widens to double precision.
    fn to_f64(self) -> f64;
}

/// A vector of [`Real`]s with the operations that the pair sweep needs.
///
/// `f32` and `f64` are themselves lanes of length one, so that the same formula serves single numbers.
pub trait Lanes:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// The type of one lane.
    type Real: Real;
    /// One truth value per lane.
    type Mask: Copy;
    /// Number of lanes.
    const N: usize;

    /// All lanes `x`.
    fn splat(x: Self::Real) -> Self;
    /// Reads `N` numbers.
    ///
    /// # Safety
    /// `from` must be readable for `N` numbers.
    unsafe fn load(from: *const Self::Real) -> Self;
    /// Reads `N` doubles, subtracts `origin` in double precision, and rounds: how a position becomes relative to
    /// a cell without losing digits far from the coordinate origin.
    ///
    /// # Safety
    /// `from` must be readable for `N` doubles.
    unsafe fn load_relative(from: *const f64, origin: f64) -> Self;
    /// Writes `N` numbers.
    ///
    /// # Safety
    /// `to` must be writable for `N` numbers.
    unsafe fn store(self, to: *mut Self::Real);
    /// Writes the lanes chosen by `bits` to consecutive places and leaves the rest, up to `N`, unspecified.
    ///
    /// # Safety
    /// `to` must be writable for `N` numbers.
    unsafe fn compress_store(self, bits: u32, to: *mut Self::Real);
    /// Adds the first `n` lanes to the `n` numbers at `to`, and touches no others.
    ///
    /// # Safety
    /// `n` must be below `N`, and `to` writable for `n` numbers.
    unsafe fn add_first(self, n: usize, to: *mut Self::Real);
    /// The mask as bits, that of the first lane lowest.
    fn bits(mask: Self::Mask) -> u32;
    /// The inverse of [`Lanes::compress_store`]: consecutive numbers in the lanes chosen by `bits`, zero elsewhere.
    ///
    /// # Safety
    /// `from` must be readable for `N` numbers.
    unsafe fn expand_load(bits: u32, from: *const Self::Real) -> Self;
    /// `self * a + b`, fused where the machine can.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// The smaller of each lane.
    fn min(self, other: Self) -> Self;
    /// The larger of each lane; `other` where `self` is not a number.
    fn max(self, other: Self) -> Self;
    /// Square root, to rounding.
    fn sqrt(self) -> Self;
    /// `1 / self`, to rounding.
    fn recip(self) -> Self;
    /// `self < other`; false where either is not a number.
    fn less(self, other: Self) -> Self::Mask;
    /// `self` where `mask`, zero elsewhere (whatever `self` is there).
    fn only(self, mask: Self::Mask) -> Self;
    /// `self` where `mask`, `other` elsewhere.
    fn select(self, mask: Self::Mask, other: Self) -> Self;
    /// Sum of all lanes, always in the same order.
    fn sum(self) -> Self::Real;

    /// All lanes zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(Self::Real::default())
    }
    /// All lanes the constant `x`.
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::splat(Self::Real::from_f64(x))
    }
    /// `self * self`.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
    /// `self³`.
    #[inline(always)]
    fn cubed(self) -> Self {
        self * self * self
    }
}

/// Scalar product of two vectors of lanes.
#[inline(always)]
pub fn dot<L: Lanes, const D: usize>(a: &[L; D], b: &[L; D]) -> L {
    let mut s = a[0] * b[0];
    for k in 1..D {
        s = a[k].mul_add(b[k], s);
    }
    s
}

#[cfg(test)]
mod tests;
