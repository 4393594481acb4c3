//! Portable lanes: single numbers, and short arrays that the compiler turns into the vectors every machine of the
//! architecture has (SSE2, NEON).

use super::{Lanes, Real};
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

macro_rules! scalar {
    ($t:ty, $n:literal, $avx2:ident, $avx512:ident) => {
        impl Real for $t {
            type Baseline = Array<$t, $n>;
            #[cfg(target_arch = "x86_64")]
            type Avx2 = super::avx2::$avx2;
            #[cfg(target_arch = "x86_64")]
            type Avx512 = super::avx512::$avx512;
            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
        }

        impl Lanes for $t {
            type Real = $t;
            type Mask = bool;
            const N: usize = 1;
            #[inline(always)]
            fn splat(x: $t) -> Self {
                x
            }
            #[inline(always)]
            unsafe fn load(from: *const $t) -> Self {
                // SAFETY: the caller promises one readable number.
                unsafe { *from }
            }
            #[inline(always)]
            unsafe fn load_relative(from: *const f64, origin: f64) -> Self {
                // SAFETY: the caller promises one readable number.
                unsafe { (*from - origin) as $t }
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut $t) {
                // SAFETY: the caller promises one writable number.
                unsafe { *to = self }
            }
            #[inline(always)]
            unsafe fn compress_store(self, _bits: u32, to: *mut $t) {
                // SAFETY: the caller promises one writable number.
                unsafe { *to = self }
            }
            #[inline(always)]
            unsafe fn add_first(self, _n: usize, _to: *mut $t) {}
            #[inline(always)]
            fn bits(mask: bool) -> u32 {
                u32::from(mask)
            }
            #[inline(always)]
            unsafe fn expand_load(bits: u32, from: *const $t) -> Self {
                // SAFETY: the caller promises one readable number.
                unsafe { (*from).only(bits & 1 == 1) }
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                self * a + b
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$t>::sqrt(self)
            }
            #[inline(always)]
            fn recip(self) -> Self {
                1.0 / self
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn only(self, mask: bool) -> Self {
                if mask { self } else { 0.0 }
            }
            #[inline(always)]
            fn select(self, mask: bool, other: Self) -> Self {
                if mask { self } else { other }
            }
            #[inline(always)]
            fn sum(self) -> $t {
                self
            }
        }
    };
}
scalar!(f32, 4, F32x8, F32x16);
scalar!(f64, 2, F64x4, F64x8);

/// `N` numbers side by side.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Array<T, const N: usize>([T; N]);

impl<T: Real, const N: usize> Array<T, N> {
    #[inline(always)]
    fn each(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        Array(std::array::from_fn(|k| f(self.0[k], other.0[k])))
    }
}

impl<T: Real, const N: usize> Add for Array<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.each(other, |a, b| a + b)
    }
}
impl<T: Real, const N: usize> Sub for Array<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.each(other, |a, b| a - b)
    }
}
impl<T: Real, const N: usize> Mul for Array<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.each(other, |a, b| a * b)
    }
}
impl<T: Real, const N: usize> Neg for Array<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Array(self.0.map(|a| -a))
    }
}
impl<T: Real, const N: usize> AddAssign for Array<T, N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real, const N: usize> Lanes for Array<T, N> {
    type Real = T;
    type Mask = [bool; N];
    const N: usize = N;
    #[inline(always)]
    fn splat(x: T) -> Self {
        Array([x; N])
    }
    #[inline(always)]
    unsafe fn load(from: *const T) -> Self {
        // SAFETY: the caller promises N readable numbers.
        Array(unsafe { from.cast::<[T; N]>().read_unaligned() })
    }
    #[inline(always)]
    unsafe fn load_relative(from: *const f64, origin: f64) -> Self {
        // SAFETY: the caller promises N readable doubles.
        let x = unsafe { from.cast::<[f64; N]>().read_unaligned() };
        Array(x.map(|x| T::from_f64(x - origin)))
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut T) {
        // SAFETY: the caller promises N writable numbers.
        unsafe { to.cast::<[T; N]>().write_unaligned(self.0) }
    }
    #[inline(always)]
    unsafe fn compress_store(self, bits: u32, to: *mut T) {
        let mut n = 0;
        for k in 0..N {
            // SAFETY: n <= k < N, and the caller promises N writable numbers.
            unsafe { *to.add(n) = self.0[k] };
            n += (bits >> k & 1) as usize;
        }
    }
    #[inline(always)]
    unsafe fn add_first(self, n: usize, to: *mut T) {
        for k in 0..n {
            // SAFETY: the caller promises `n` writable numbers.
            unsafe { *to.add(k) += self.0[k] };
        }
    }
    #[inline(always)]
    fn bits(mask: [bool; N]) -> u32 {
        (0..N).fold(0, |bits, k| bits | u32::from(mask[k]) << k)
    }
    #[inline(always)]
    unsafe fn expand_load(bits: u32, from: *const T) -> Self {
        let mut out = [T::default(); N];
        let mut n = 0;
        for (k, lane) in out.iter_mut().enumerate() {
            if bits >> k & 1 == 1 {
                // SAFETY: n <= k < N, and the caller promises N readable numbers.
                *lane = unsafe { *from.add(n) };
                n += 1;
            }
        }
        Array(out)
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.each(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.each(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Array(self.0.map(<T as Lanes>::sqrt))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        Array(self.0.map(<T as Lanes>::recip))
    }
    #[inline(always)]
    fn less(self, other: Self) -> [bool; N] {
        std::array::from_fn(|k| self.0[k] < other.0[k])
    }
    #[inline(always)]
    fn only(self, mask: [bool; N]) -> Self {
        self.select(mask, Self::zero())
    }
    #[inline(always)]
    fn select(self, mask: [bool; N], other: Self) -> Self {
        Array(std::array::from_fn(|k| {
            if mask[k] { self.0[k] } else { other.0[k] }
        }))
    }
    #[inline(always)]
    fn sum(self) -> T {
        let mut s = self.0[0];
        for k in 1..N {
            s += self.0[k];
        }
        s
    }
}
