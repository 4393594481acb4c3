//! Lanes of 512 bits (AVX-512 F, VL, DQ).
//!
//! Division and square root of 16 floats take about 20 cycles each on these machines, the rest of a pair some 40;
//! an estimate refined by Newton steps to full precision takes 4, so that is what is used.

use super::Lanes;
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// Sixteen floats.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F32x16(__m512);

/// Eight doubles.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x8(__m512d);

// SAFETY of every block in this file: these types are only used under `dispatch`, which checks the features.
macro_rules! operators {
    ($t:ident, $add:ident, $sub:ident, $mul:ident, $zero:ident) => {
        impl Add for $t {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self {
                // SAFETY: see the head of this file.
                unsafe { $t($add(self.0, o.0)) }
            }
        }
        impl Sub for $t {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self {
                // SAFETY: see the head of this file.
                unsafe { $t($sub(self.0, o.0)) }
            }
        }
        impl Mul for $t {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: Self) -> Self {
                // SAFETY: see the head of this file.
                unsafe { $t($mul(self.0, o.0)) }
            }
        }
        impl Neg for $t {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: see the head of this file.
                unsafe { $t($sub($zero(), self.0)) }
            }
        }
        impl AddAssign for $t {
            #[inline(always)]
            fn add_assign(&mut self, o: Self) {
                *self = *self + o;
            }
        }
    };
}
operators!(
    F32x16,
    _mm512_add_ps,
    _mm512_sub_ps,
    _mm512_mul_ps,
    _mm512_setzero_ps
);
operators!(
    F64x8,
    _mm512_add_pd,
    _mm512_sub_pd,
    _mm512_mul_pd,
    _mm512_setzero_pd
);

impl Lanes for F32x16 {
    type Real = f32;
    type Mask = __mmask16;
    const N: usize = 16;
    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F32x16(_mm512_set1_ps(x)) }
    }
    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the caller promises 16 readable numbers.
        unsafe { F32x16(_mm512_loadu_ps(from)) }
    }
    #[inline(always)]
    unsafe fn load_relative(from: *const f64, origin: f64) -> Self {
        // SAFETY: the caller promises 16 readable doubles.
        unsafe {
            let o = _mm512_set1_pd(origin);
            let low = _mm512_cvtpd_ps(_mm512_sub_pd(_mm512_loadu_pd(from), o));
            let high = _mm512_cvtpd_ps(_mm512_sub_pd(_mm512_loadu_pd(from.add(8)), o));
            F32x16(_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1))
        }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the caller promises 16 writable numbers.
        unsafe { _mm512_storeu_ps(to, self.0) }
    }
    #[inline(always)]
    unsafe fn compress_store(self, bits: u32, to: *mut f32) {
        // Compressed in the register, then stored whole: the compressing store instruction is microcoded on some
        // machines. SAFETY: the caller promises 16 writable numbers.
        unsafe { _mm512_storeu_ps(to, _mm512_maskz_compress_ps(bits as __mmask16, self.0)) }
    }
    #[inline(always)]
    unsafe fn add_first(self, n: usize, to: *mut f32) {
        // SAFETY: the caller promises `n` writable numbers; masked lanes are not touched.
        unsafe {
            let mask = ((1u32 << n) - 1) as __mmask16;
            let sum = _mm512_add_ps(_mm512_maskz_loadu_ps(mask, to), self.0);
            _mm512_mask_storeu_ps(to, mask, sum);
        }
    }
    #[inline(always)]
    fn bits(mask: __mmask16) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    unsafe fn expand_load(bits: u32, from: *const f32) -> Self {
        // SAFETY: the caller promises N readable numbers.
        unsafe {
            F32x16(_mm512_maskz_expand_ps(
                bits as __mmask16,
                _mm512_loadu_ps(from),
            ))
        }
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F32x16(_mm512_fmadd_ps(self.0, a.0, b.0)) }
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F32x16(_mm512_min_ps(self.0, o.0)) }
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F32x16(_mm512_max_ps(self.0, o.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the head of this file.
        unsafe {
            // s = x y with y ~ 1/√x, then s + ½ y (x - s²); exact zero stays zero through the mask.
            let y = _mm512_maskz_rsqrt14_ps(
                _mm512_cmp_ps_mask(self.0, _mm512_setzero_ps(), _CMP_NEQ_OQ),
                self.0,
            );
            let s = _mm512_mul_ps(self.0, y);
            let half_y = _mm512_mul_ps(y, _mm512_set1_ps(0.5));
            F32x16(_mm512_fmadd_ps(_mm512_fnmadd_ps(s, s, self.0), half_y, s))
        }
    }
    #[inline(always)]
    fn recip(self) -> Self {
        // SAFETY: see the head of this file.
        unsafe {
            let y = _mm512_rcp14_ps(self.0);
            let e = _mm512_fnmadd_ps(self.0, y, _mm512_set1_ps(1.0));
            F32x16(_mm512_fmadd_ps(y, e, y))
        }
    }
    #[inline(always)]
    fn less(self, o: Self) -> __mmask16 {
        // SAFETY: see the head of this file.
        unsafe { _mm512_cmp_ps_mask(self.0, o.0, _CMP_LT_OQ) }
    }
    #[inline(always)]
    fn only(self, mask: __mmask16) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F32x16(_mm512_maskz_mov_ps(mask, self.0)) }
    }
    #[inline(always)]
    fn select(self, mask: __mmask16, o: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F32x16(_mm512_mask_mov_ps(o.0, mask, self.0)) }
    }
    #[inline(always)]
    fn sum(self) -> f32 {
        // SAFETY: see the head of this file.
        unsafe { _mm512_reduce_add_ps(self.0) }
    }
}

impl Lanes for F64x8 {
    type Real = f64;
    type Mask = __mmask8;
    const N: usize = 8;
    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F64x8(_mm512_set1_pd(x)) }
    }
    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        // SAFETY: the caller promises 8 readable numbers.
        unsafe { F64x8(_mm512_loadu_pd(from)) }
    }
    #[inline(always)]
    unsafe fn load_relative(from: *const f64, origin: f64) -> Self {
        // SAFETY: the caller promises 8 readable numbers.
        unsafe { F64x8(_mm512_sub_pd(_mm512_loadu_pd(from), _mm512_set1_pd(origin))) }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        // SAFETY: the caller promises 8 writable numbers.
        unsafe { _mm512_storeu_pd(to, self.0) }
    }
    #[inline(always)]
    unsafe fn compress_store(self, bits: u32, to: *mut f64) {
        // SAFETY: the caller promises 8 writable numbers.
        unsafe { _mm512_storeu_pd(to, _mm512_maskz_compress_pd(bits as __mmask8, self.0)) }
    }
    #[inline(always)]
    unsafe fn add_first(self, n: usize, to: *mut f64) {
        // SAFETY: the caller promises `n` writable numbers; masked lanes are not touched.
        unsafe {
            let mask = ((1u32 << n) - 1) as __mmask8;
            let sum = _mm512_add_pd(_mm512_maskz_loadu_pd(mask, to), self.0);
            _mm512_mask_storeu_pd(to, mask, sum);
        }
    }
    #[inline(always)]
    fn bits(mask: __mmask8) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    unsafe fn expand_load(bits: u32, from: *const f64) -> Self {
        // SAFETY: the caller promises N readable numbers.
        unsafe {
            F64x8(_mm512_maskz_expand_pd(
                bits as __mmask8,
                _mm512_loadu_pd(from),
            ))
        }
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F64x8(_mm512_fmadd_pd(self.0, a.0, b.0)) }
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F64x8(_mm512_min_pd(self.0, o.0)) }
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F64x8(_mm512_max_pd(self.0, o.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the head of this file.
        unsafe {
            let half = _mm512_set1_pd(0.5);
            let x = self.0;
            let y =
                _mm512_maskz_rsqrt14_pd(_mm512_cmp_pd_mask(x, _mm512_setzero_pd(), _CMP_NEQ_OQ), x);
            // Goldschmidt: s -> √x and d -> ½/√x together, 14 -> 28 -> 53 bits.
            let s = _mm512_mul_pd(x, y);
            let d = _mm512_mul_pd(y, half);
            let e = _mm512_fnmadd_pd(s, d, half);
            let s = _mm512_fmadd_pd(s, e, s);
            let d = _mm512_fmadd_pd(d, e, d);
            F64x8(_mm512_fmadd_pd(_mm512_fnmadd_pd(s, s, x), d, s))
        }
    }
    #[inline(always)]
    fn recip(self) -> Self {
        // SAFETY: see the head of this file.
        unsafe {
            let one = _mm512_set1_pd(1.0);
            let y = _mm512_rcp14_pd(self.0);
            let e = _mm512_fnmadd_pd(self.0, y, one);
            let y = _mm512_fmadd_pd(y, e, y);
            let e = _mm512_fnmadd_pd(self.0, y, one);
            F64x8(_mm512_fmadd_pd(y, e, y))
        }
    }
    #[inline(always)]
    fn less(self, o: Self) -> __mmask8 {
        // SAFETY: see the head of this file.
        unsafe { _mm512_cmp_pd_mask(self.0, o.0, _CMP_LT_OQ) }
    }
    #[inline(always)]
    fn only(self, mask: __mmask8) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F64x8(_mm512_maskz_mov_pd(mask, self.0)) }
    }
    #[inline(always)]
    fn select(self, mask: __mmask8, o: Self) -> Self {
        // SAFETY: see the head of this file.
        unsafe { F64x8(_mm512_mask_mov_pd(o.0, mask, self.0)) }
    }
    #[inline(always)]
    fn sum(self) -> f64 {
        // SAFETY: see the head of this file.
        unsafe { _mm512_reduce_add_pd(self.0) }
    }
}
