//! The kernel of a simulation: the default as a static type, the others by a branch per vector of pairs.
//!
//! Compiling every sweep for every kernel would multiply the hot code by five; a predictable branch per vector costs a
//! few per cent, and only those who leave the default pay it.

use super::{Kernel, KernelName};
use crate::simd::Lanes;
use crate::with_kernel;
use std::marker::PhantomData;

/// A kernel as a sweep sees it.
pub trait ChosenKernel: Copy + Send + Sync + 'static {
    /// Support radius in smoothing lengths.
    fn support(self) -> f64;
    /// `σ_D`.
    fn normalisation(self, dimension: usize) -> f64;
    /// `w(q)`.
    fn shape<L: Lanes>(self, q: L) -> L;
    /// `w'(q)/q`.
    fn slope_over_q<L: Lanes>(self, q: L) -> L;
}

/// A kernel known when the sweep is compiled.
#[derive(Clone, Copy, Debug)]
pub struct Fixed<K>(PhantomData<K>);

impl<K> Default for Fixed<K> {
    fn default() -> Self {
        Fixed(PhantomData)
    }
}

impl<K: Kernel> ChosenKernel for Fixed<K> {
    #[inline(always)]
    fn support(self) -> f64 {
        K::SUPPORT
    }
    #[inline(always)]
    fn normalisation(self, dimension: usize) -> f64 {
        K::normalisation(dimension)
    }
    #[inline(always)]
    fn shape<L: Lanes>(self, q: L) -> L {
        K::shape(q)
    }
    #[inline(always)]
    fn slope_over_q<L: Lanes>(self, q: L) -> L {
        K::slope_over_q(q)
    }
}

impl ChosenKernel for KernelName {
    fn support(self) -> f64 {
        with_kernel!(self, K => K::SUPPORT)
    }
    fn normalisation(self, dimension: usize) -> f64 {
        with_kernel!(self, K => K::normalisation(dimension))
    }
    #[inline(always)]
    fn shape<L: Lanes>(self, q: L) -> L {
        with_kernel!(self, K => K::shape(q))
    }
    #[inline(always)]
    fn slope_over_q<L: Lanes>(self, q: L) -> L {
        with_kernel!(self, K => K::slope_over_q(q))
    }
}
