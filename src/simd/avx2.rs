//! Lanes of 256 bits (AVX2 and FMA).

use super::Lanes;
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// Eight floats.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F32x8(__m256);

/// Four doubles.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x4(__m256d);

/// For each mask of eight bits, the order that brings the chosen lanes to the front.
static COMPRESS: [[u32; 8]; 256] = {
    let mut table = [[0u32; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut n, mut k) = (0, 0);
        while k < 8 {
            if mask >> k & 1 == 1 {
                table[mask][n] = k as u32;
                n += 1;
            }
            k += 1;
        }
        mask += 1;
    }
    table
};

/// The same for four doubles, each moved as two words.
static COMPRESS_DOUBLE: [[u32; 8]; 16] = {
    // Where no lane is chosen, the first: any number, but a number.
    let mut table = [[0, 1, 0, 1, 0, 1, 0, 1]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut n, mut k) = (0, 0);
        while k < 4 {
            if mask >> k & 1 == 1 {
                table[mask][2 * n] = 2 * k as u32;
                table[mask][2 * n + 1] = 2 * k as u32 + 1;
                n += 1;
            }
            k += 1;
        }
        mask += 1;
    }
    table
};

/// For each mask of eight bits, which of the consecutive numbers belongs into each lane; an index of no lane where none
/// does.
static EXPAND: [[u32; 8]; 256] = {
    let mut table = [[NOWHERE; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut n, mut k) = (0, 0);
        while k < 8 {
            if mask >> k & 1 == 1 {
                table[mask][k] = n;
                n += 1;
            }
            k += 1;
        }
        mask += 1;
    }
    table
};

/// The same for four doubles, each moved as two words.
static EXPAND_DOUBLE: [[u32; 8]; 16] = {
    let mut table = [[NOWHERE; 8]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut n, mut k) = (0, 0);
        while k < 4 {
            if mask >> k & 1 == 1 {
                table[mask][2 * k] = 2 * n;
                table[mask][2 * k + 1] = 2 * n + 1;
                n += 1;
            }
            k += 1;
        }
        mask += 1;
    }
    table
};

/// Marks a lane that gets zero: its sign bit is set.
const NOWHERE: u32 = 1 << 31;

// SAFETY of every block in this file: these types are only used under `dispatch`, which checks the features.
macro_rules! lanes {
    ($t:ident, $real:ty, $mask:ty, $n:literal,
     $add:ident, $sub:ident, $mul:ident, $div:ident, $fma:ident, $min:ident, $max:ident, $sqrt:ident,
     $zero:ident, $set1:ident, $loadu:ident, $storeu:ident, $cmp:ident, $and:ident, $blendv:ident, $movemask:ident) => {
        impl Add for $t {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($add(self.0, o.0)) }
            }
        }
        impl Sub for $t {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($sub(self.0, o.0)) }
            }
        }
        impl Mul for $t {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: Self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($mul(self.0, o.0)) }
            }
        }
        impl Neg for $t {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($sub($zero(), self.0)) }
            }
        }
        impl AddAssign for $t {
            #[inline(always)]
            fn add_assign(&mut self, o: Self) {
                *self = *self + o;
            }
        }

        impl Lanes for $t {
            type Real = $real;
            type Mask = $mask;
            const N: usize = $n;
            #[inline(always)]
            fn splat(x: $real) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($set1(x)) }
            }
            #[inline(always)]
            unsafe fn load(from: *const $real) -> Self {
                // SAFETY: the caller promises N readable numbers.
                unsafe { $t($loadu(from)) }
            }
            #[inline(always)]
            unsafe fn load_relative(from: *const f64, origin: f64) -> Self {
                // SAFETY: the caller promises N readable doubles.
                unsafe { Self::relative(from, origin) }
            }
            #[inline(always)]
            unsafe fn store(self, to: *mut $real) {
                // SAFETY: the caller promises N writable numbers.
                unsafe { $storeu(to, self.0) }
            }
            #[inline(always)]
            unsafe fn compress_store(self, bits: u32, to: *mut $real) {
                // SAFETY: the caller promises N writable numbers.
                unsafe { $storeu(to, self.compress(bits)) }
            }
            #[inline(always)]
            unsafe fn add_first(self, n: usize, to: *mut $real) {
                // SAFETY: the caller promises `n` writable numbers; masked lanes are not touched.
                unsafe { self.add_to_first(n, to) }
            }
            #[inline(always)]
            fn bits(mask: $mask) -> u32 {
                // SAFETY: see the head of the macro.
                unsafe { $movemask(mask) as u32 }
            }
            #[inline(always)]
            unsafe fn expand_load(bits: u32, from: *const $real) -> Self {
                // SAFETY: the caller promises N readable numbers.
                unsafe { Self::expand(bits, $loadu(from)) }
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($fma(self.0, a.0, b.0)) }
            }
            #[inline(always)]
            fn min(self, o: Self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($min(self.0, o.0)) }
            }
            #[inline(always)]
            fn max(self, o: Self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($max(self.0, o.0)) }
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($sqrt(self.0)) }
            }
            #[inline(always)]
            fn recip(self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($div($set1(1.0), self.0)) }
            }
            #[inline(always)]
            fn less(self, o: Self) -> $mask {
                // SAFETY: see the head of the macro.
                unsafe { $cmp(self.0, o.0, _CMP_LT_OQ) }
            }
            #[inline(always)]
            fn only(self, mask: $mask) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($and(mask, self.0)) }
            }
            #[inline(always)]
            fn select(self, mask: $mask, o: Self) -> Self {
                // SAFETY: see the head of the macro.
                unsafe { $t($blendv(o.0, self.0, mask)) }
            }
            #[inline(always)]
            fn sum(self) -> $real {
                // SAFETY: see the head of the macro.
                unsafe { self.total() }
            }
        }
    };
}

lanes!(
    F32x8,
    f32,
    __m256,
    8,
    _mm256_add_ps,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_div_ps,
    _mm256_fmadd_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    _mm256_sqrt_ps,
    _mm256_setzero_ps,
    _mm256_set1_ps,
    _mm256_loadu_ps,
    _mm256_storeu_ps,
    _mm256_cmp_ps,
    _mm256_and_ps,
    _mm256_blendv_ps,
    _mm256_movemask_ps
);
lanes!(
    F64x4,
    f64,
    __m256d,
    4,
    _mm256_add_pd,
    _mm256_sub_pd,
    _mm256_mul_pd,
    _mm256_div_pd,
    _mm256_fmadd_pd,
    _mm256_min_pd,
    _mm256_max_pd,
    _mm256_sqrt_pd,
    _mm256_setzero_pd,
    _mm256_set1_pd,
    _mm256_loadu_pd,
    _mm256_storeu_pd,
    _mm256_cmp_pd,
    _mm256_and_pd,
    _mm256_blendv_pd,
    _mm256_movemask_pd
);

impl F32x8 {
    #[inline(always)]
    unsafe fn relative(from: *const f64, origin: f64) -> Self {
        // SAFETY: the caller promises 8 readable doubles.
        unsafe {
            let o = _mm256_set1_pd(origin);
            let low = _mm256_cvtpd_ps(_mm256_sub_pd(_mm256_loadu_pd(from), o));
            let high = _mm256_cvtpd_ps(_mm256_sub_pd(_mm256_loadu_pd(from.add(4)), o));
            F32x8(_mm256_set_m128(high, low))
        }
    }
    #[inline(always)]
    unsafe fn compress(self, bits: u32) -> __m256 {
        // SAFETY: `bits` has 8 bits and the table 256 rows.
        unsafe {
            let row = COMPRESS.as_ptr().add(bits as usize);
            _mm256_permutevar8x32_ps(self.0, _mm256_loadu_si256(row.cast()))
        }
    }
    #[inline(always)]
    unsafe fn add_to_first(self, n: usize, to: *mut f32) {
        // SAFETY: the caller promises `n` writable numbers; masked lanes are not touched.
        unsafe {
            let lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            let mask = _mm256_cmpgt_epi32(_mm256_set1_epi32(n as i32), lane);
            _mm256_maskstore_ps(
                to,
                mask,
                _mm256_add_ps(_mm256_maskload_ps(to, mask), self.0),
            );
        }
    }
    #[inline(always)]
    unsafe fn expand(bits: u32, from: __m256) -> Self {
        // SAFETY: `bits` has 8 bits and the table 256 rows.
        unsafe {
            let row = _mm256_loadu_si256(EXPAND.as_ptr().add(bits as usize).cast());
            let nowhere = _mm256_castsi256_ps(_mm256_srai_epi32(row, 31));
            F32x8(_mm256_andnot_ps(
                nowhere,
                _mm256_permutevar8x32_ps(from, row),
            ))
        }
    }
    #[inline(always)]
    unsafe fn total(self) -> f32 {
        // SAFETY: see the head of the macro.
        unsafe {
            let s = _mm_add_ps(
                _mm256_castps256_ps128(self.0),
                _mm256_extractf128_ps(self.0, 1),
            );
            let s = _mm_add_ps(s, _mm_movehl_ps(s, s));
            _mm_cvtss_f32(_mm_add_ss(s, _mm_shuffle_ps(s, s, 1)))
        }
    }
}

impl F64x4 {
    #[inline(always)]
    unsafe fn relative(from: *const f64, origin: f64) -> Self {
        // SAFETY: the caller promises 4 readable doubles.
        unsafe { F64x4(_mm256_sub_pd(_mm256_loadu_pd(from), _mm256_set1_pd(origin))) }
    }
    #[inline(always)]
    unsafe fn compress(self, bits: u32) -> __m256d {
        // SAFETY: `bits` has 4 bits and the table 16 rows.
        unsafe {
            let row = COMPRESS_DOUBLE.as_ptr().add(bits as usize);
            let words = _mm256_permutevar8x32_epi32(
                _mm256_castpd_si256(self.0),
                _mm256_loadu_si256(row.cast()),
            );
            _mm256_castsi256_pd(words)
        }
    }
    #[inline(always)]
    unsafe fn add_to_first(self, n: usize, to: *mut f64) {
        // SAFETY: the caller promises `n` writable numbers; masked lanes are not touched.
        unsafe {
            let lane = _mm256_setr_epi64x(0, 1, 2, 3);
            let mask = _mm256_cmpgt_epi64(_mm256_set1_epi64x(n as i64), lane);
            _mm256_maskstore_pd(
                to,
                mask,
                _mm256_add_pd(_mm256_maskload_pd(to, mask), self.0),
            );
        }
    }
    #[inline(always)]
    unsafe fn expand(bits: u32, from: __m256d) -> Self {
        // SAFETY: `bits` has 4 bits and the table 16 rows.
        unsafe {
            let row = _mm256_loadu_si256(EXPAND_DOUBLE.as_ptr().add(bits as usize).cast());
            let words = _mm256_permutevar8x32_epi32(_mm256_castpd_si256(from), row);
            let nowhere = _mm256_srai_epi32(row, 31);
            F64x4(_mm256_castsi256_pd(_mm256_andnot_si256(nowhere, words)))
        }
    }
    #[inline(always)]
    unsafe fn total(self) -> f64 {
        // SAFETY: see the head of the macro.
        unsafe {
            let s = _mm_add_pd(
                _mm256_castpd256_pd128(self.0),
                _mm256_extractf128_pd(self.0, 1),
            );
            _mm_cvtsd_f64(_mm_add_sd(s, _mm_unpackhi_pd(s, s)))
        }
    }
}
