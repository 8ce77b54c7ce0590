//! Eight f64 in two AVX registers or one AVX-512 register.
// Axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use crate::simd::doubles::{Doubles, EightDoubles};
use std::arch::x86_64::*;

/// Eight f64 in two AVX registers.
#[derive(Clone, Copy)]
pub(super) struct Avx2Doubles(pub(super) __m256d, pub(super) __m256d);

impl Doubles for Avx2Doubles {
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(call!(_mm256_add_pd(self.0, other.0)), call!(_mm256_add_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(call!(_mm256_sub_pd(self.0, other.0)), call!(_mm256_sub_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(call!(_mm256_mul_pd(self.0, other.0)), call!(_mm256_mul_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(call!(_mm256_div_pd(self.0, other.0)), call!(_mm256_div_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let sign = call!(_mm256_set1_pd(-0.0));
        Self(call!(_mm256_andnot_pd(sign, self.0)), call!(_mm256_andnot_pd(sign, self.1)))
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        let x = call!(_mm256_set1_pd(x));
        Self(x, x)
    }
    #[inline(always)]
    fn or_more(self, other: Self) -> Self {
        Self(call!(_mm256_max_pd(self.0, other.0)), call!(_mm256_max_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn or_less(self, other: Self) -> Self {
        Self(call!(_mm256_min_pd(self.0, other.0)), call!(_mm256_min_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(call!(_mm256_sqrt_pd(self.0)), call!(_mm256_sqrt_pd(self.1)))
    }
    #[inline(always)]
    fn product_error(self, other: Self, product: Self) -> Self {
        Self(call!(_mm256_fmsub_pd(self.0, other.0, product.0)), call!(_mm256_fmsub_pd(self.1, other.1, product.1)))
    }
}

impl EightDoubles for Avx2Doubles {
    #[inline(always)]
    fn load(x: &[f64; 8]) -> Self {
        // SAFETY: reads the 64 bytes of `x`, unaligned; features as above.
        unsafe { Self(_mm256_loadu_pd(x.as_ptr()), _mm256_loadu_pd(x.as_ptr().add(4))) }
    }
    #[inline(always)]
    fn widen(x: &[f32; 8]) -> Self {
        // SAFETY: reads the 32 bytes of `x`, unaligned; features as above.
        let (low, high) = unsafe { (_mm_loadu_ps(x.as_ptr()), _mm_loadu_ps(x.as_ptr().add(4))) };
        Self(call!(_mm256_cvtps_pd(low)), call!(_mm256_cvtps_pd(high)))
    }
    #[inline(always)]
    fn pick(x: &[f64; 8], places: &[u32; 8]) -> Self {
        let [a, b, c, d, e, f, g, h] = places.map(|place| x[place as usize % 8]);
        Self(call!(_mm256_setr_pd(a, b, c, d)), call!(_mm256_setr_pd(e, f, g, h)))
    }
    #[inline(always)]
    fn array(self) -> [f64; 8] {
        let mut out = [0.0; 8];
        // SAFETY: writes the 64 bytes of `out`, unaligned; features as above.
        unsafe {
            _mm256_storeu_pd(out.as_mut_ptr(), self.0);
            _mm256_storeu_pd(out.as_mut_ptr().add(4), self.1);
        }
        out
    }
    #[inline(always)]
    fn unzip3(points: &[[f64; 3]; 8]) -> [Self; 3] {
        let start: *const f64 = points.as_ptr().cast();
        // SAFETY: the 24 numbers of `points` are read, twelve by each call; features as above.
        let ([x, y, z], [x4, y4, z4]) = unsafe { (unzip_four(start), unzip_four(start.add(12))) };
        [Self(x, x4), Self(y, y4), Self(z, z4)]
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        let low = call!(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0));
        let high = call!(_mm256_cmp_pd::<_CMP_LE_OQ>(self.1, other.1));
        (call!(_mm256_movemask_pd(low)) | call!(_mm256_movemask_pd(high)) << 4) as u32
    }
    #[inline(always)]
    fn select(self, bits: u32, other: Self) -> Self {
        let (low, high) = (spread(bits), spread(bits >> 4));
        Self(call!(_mm256_blendv_pd(other.0, self.0, low)), call!(_mm256_blendv_pd(other.1, self.1, high)))
    }
}

/// Lane `i` is all ones where bit `i` of the lower four is set.
#[inline(always)]
fn spread(bits: u32) -> __m256d {
    let each = call!(_mm256_setr_epi64x(1, 2, 4, 8));
    let bits = call!(_mm256_set1_epi64x(i64::from(bits)));
    let bits = call!(_mm256_and_si256(bits, each));
    let all_ones = call!(_mm256_cmpeq_epi64(bits, each));
    call!(_mm256_castsi256_pd(all_ones))
}

/// The coordinates of four points.
///
/// # Safety
///
/// `start` points to twelve numbers.
#[inline(always)]
unsafe fn unzip_four(start: *const f64) -> [__m256d; 3] {
    // SAFETY: reads the twelve numbers; features as above.
    unsafe {
        let [a, b, c] = [_mm256_loadu_pd(start), _mm256_loadu_pd(start.add(4)), _mm256_loadu_pd(start.add(8))];
        let x0y0x2y2 = _mm256_permute2f128_pd::<0x30>(a, b);
        let z0x1z2x3 = _mm256_permute2f128_pd::<0x21>(a, c);
        let y1z1y3z3 = _mm256_permute2f128_pd::<0x30>(b, c);
        [
            _mm256_shuffle_pd::<0b1010>(x0y0x2y2, z0x1z2x3),
            _mm256_shuffle_pd::<0b0101>(x0y0x2y2, y1z1y3z3),
            _mm256_shuffle_pd::<0b1010>(z0x1z2x3, y1z1y3z3),
        ]
    }
}

/// One AVX-512 register of f64.
#[derive(Clone, Copy)]
pub(super) struct Avx512Doubles(pub(super) __m512d);

impl Doubles for Avx512Doubles {
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(call!(_mm512_add_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(call!(_mm512_sub_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(call!(_mm512_mul_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(call!(_mm512_div_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(call!(_mm512_abs_pd(self.0)))
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(call!(_mm512_set1_pd(x)))
    }
    #[inline(always)]
    fn or_more(self, other: Self) -> Self {
        Self(call!(_mm512_max_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn or_less(self, other: Self) -> Self {
        Self(call!(_mm512_min_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(call!(_mm512_sqrt_pd(self.0)))
    }
    #[inline(always)]
    fn product_error(self, other: Self, product: Self) -> Self {
        Self(call!(_mm512_fmsub_pd(self.0, other.0, product.0)))
    }
}

impl EightDoubles for Avx512Doubles {
    #[inline(always)]
    fn load(x: &[f64; 8]) -> Self {
        // SAFETY: reads the 64 bytes of `x`, unaligned; features as above.
        Self(unsafe { _mm512_loadu_pd(x.as_ptr()) })
    }
    #[inline(always)]
    fn widen(x: &[f32; 8]) -> Self {
        // SAFETY: reads the 32 bytes of `x`, unaligned; features as above.
        Self(unsafe { _mm512_cvtps_pd(_mm256_loadu_ps(x.as_ptr())) })
    }
    #[inline(always)]
    fn pick(x: &[f64; 8], places: &[u32; 8]) -> Self {
        // SAFETY: reads the 64 bytes of `x` and the 32 of `places`, unaligned; features as above. Only the lowest three bits of a place count.
        unsafe {
            let places = _mm512_cvtepu32_epi64(_mm256_loadu_si256(places.as_ptr().cast()));
            Self(_mm512_permutexvar_pd(places, _mm512_loadu_pd(x.as_ptr())))
        }
    }
    #[inline(always)]
    fn array(self) -> [f64; 8] {
        let mut out = [0.0; 8];
        // SAFETY: writes the 64 bytes of `out`, unaligned; features as above.
        unsafe { _mm512_storeu_pd(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        u32::from(call!(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn select(self, bits: u32, other: Self) -> Self {
        Self(call!(_mm512_mask_blend_pd(bits as u8, other.0, self.0)))
    }
    #[inline(always)]
    fn unzip3(points: &[[f64; 3]; 8]) -> [Self; 3] {
        // As for f32, eight at a time.
        const FIRST: [[i64; 8]; 3] = [[0, 3, 6, 9, 12, 15, 0, 0], [1, 4, 7, 10, 13, 0, 0, 0], [2, 5, 8, 11, 14, 0, 0, 0]];
        const THEN: [[i64; 8]; 3] = [[0, 1, 2, 3, 4, 5, 10, 13], [0, 1, 2, 3, 4, 8, 11, 14], [0, 1, 2, 3, 4, 9, 12, 15]];
        let start: *const f64 = points.as_ptr().cast();
        // SAFETY: the 24 numbers of `points` are read, and rows of 8 numbers of the tables; features as above.
        unsafe {
            let [a, b, c] = [_mm512_loadu_pd(start), _mm512_loadu_pd(start.add(8)), _mm512_loadu_pd(start.add(16))];
            let mut out = [Self(a); 3];
            for k in 0..3 {
                let first = _mm512_loadu_si512(FIRST[k].as_ptr().cast());
                let then = _mm512_loadu_si512(THEN[k].as_ptr().cast());
                out[k] = Self(_mm512_permutex2var_pd(_mm512_permutex2var_pd(a, first, b), then, c));
            }
            out
        }
    }
}
