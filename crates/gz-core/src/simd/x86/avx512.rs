//! Sixteen f32 in an AVX-512 register.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::{Avx512, four};
use crate::simd::lanes::Lanes;
use std::arch::x86_64::*;

impl Lanes<16> for Avx512 {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(call!(_mm512_set1_ps(x)))
    }
    #[inline(always)]
    fn load(x: &[f32; 16]) -> Self {
        // SAFETY: reads the 64 bytes of `x`, unaligned; features as above.
        Self(unsafe { _mm512_loadu_ps(x.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 16]) {
        // SAFETY: writes the 64 bytes of `to`, unaligned; features as above.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) };
    }
    #[inline(always)]
    fn select(self, bits: u32, other: Self) -> Self {
        Self(call!(_mm512_mask_blend_ps(bits as u16, other.0, self.0)))
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        let (one, two) = (call!(_mm512_castps_si512(self.0)), call!(_mm512_castps_si512(other.0)));
        u32::from(call!(_mm512_cmpeq_epi32_mask(one, two)))
    }
    #[inline(always)]
    fn least(self) -> f32 {
        call!(_mm512_reduce_min_ps(self.0))
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        call!(_mm512_reduce_max_ps(self.0))
    }
    #[inline(always)]
    fn least_of_each([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        let ab = call!(_mm512_min_ps(_mm512_unpacklo_ps(a.0, b.0), _mm512_unpackhi_ps(a.0, b.0)));
        let cd = call!(_mm512_min_ps(_mm512_unpacklo_ps(c.0, d.0), _mm512_unpackhi_ps(c.0, d.0)));
        let each = call!(_mm512_min_ps(_mm512_shuffle_ps::<0x44>(ab, cd), _mm512_shuffle_ps::<0xee>(ab, cd)));
        let half = call!(_mm256_min_ps(_mm512_castps512_ps256(each), _mm512_extractf32x8_ps::<1>(each)));
        four(call!(_mm_min_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps::<1>(half))))
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(call!(_mm512_add_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(call!(_mm512_sub_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(call!(_mm512_mul_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(call!(_mm512_div_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(call!(_mm512_fmadd_ps(self.0, factor.0, term.0)))
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, term: Self) -> Self {
        Self(call!(_mm512_fmsub_ps(self.0, factor.0, term.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(call!(_mm512_abs_ps(self.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(call!(_mm512_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(call!(_mm512_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        u32::from(call!(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        u32::from(call!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn unzip3(points: &[[f32; 3]; 16]) -> [Self; 3] {
        // For each coordinate: where its numbers are in the first two registers (the second counts from 16), then which of these to keep
        // and which to take from the third.
        const FIRST: [[i32; 16]; 3] = [
            [0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 0, 0, 0, 0, 0],
            [1, 4, 7, 10, 13, 16, 19, 22, 25, 28, 31, 0, 0, 0, 0, 0],
            [2, 5, 8, 11, 14, 17, 20, 23, 26, 29, 0, 0, 0, 0, 0, 0],
        ];
        const THEN: [[i32; 16]; 3] = [
            [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 17, 20, 23, 26, 29],
            [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 18, 21, 24, 27, 30],
            [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 19, 22, 25, 28, 31],
        ];
        let start: *const f32 = points.as_ptr().cast();
        // SAFETY: the 48 numbers of `points` are read, and rows of 16 numbers of the tables; features as above.
        unsafe {
            let [a, b, c] = [_mm512_loadu_ps(start), _mm512_loadu_ps(start.add(16)), _mm512_loadu_ps(start.add(32))];
            let mut out = [Self(a); 3];
            for k in 0..3 {
                let first = _mm512_loadu_si512(FIRST[k].as_ptr().cast());
                let then = _mm512_loadu_si512(THEN[k].as_ptr().cast());
                out[k] = Self(_mm512_permutex2var_ps(_mm512_permutex2var_ps(a, first, b), then, c));
            }
            out
        }
    }
    #[inline(always)]
    fn unzip8(rows: &[[f32; 8]; 16]) -> [Self; 8] {
        let start: *const f32 = rows.as_ptr().cast();
        let mut out = [Self(call!(_mm512_setzero_ps())); 8];
        for half in 0..2 {
            let mut fours = [out[0].0; 4];
            for i in 0..4 {
                // SAFETY: of the 128 numbers of `rows` four at a time are read, a half of rows i, i + 4, i + 8 and i + 12; features as above.
                fours[i] = unsafe {
                    let start = start.add(8 * i + 4 * half);
                    let one = _mm512_castps128_ps512(_mm_loadu_ps(start));
                    let two = _mm512_insertf32x4::<1>(one, _mm_loadu_ps(start.add(32)));
                    let three = _mm512_insertf32x4::<2>(two, _mm_loadu_ps(start.add(64)));
                    _mm512_insertf32x4::<3>(three, _mm_loadu_ps(start.add(96)))
                };
            }
            let [a, b, c, d] = fours;
            let (ab, cd) = (call!(_mm512_unpacklo_ps(a, b)), call!(_mm512_unpacklo_ps(c, d)));
            out[4 * half] = Self(call!(_mm512_shuffle_ps::<0x44>(ab, cd)));
            out[4 * half + 1] = Self(call!(_mm512_shuffle_ps::<0xee>(ab, cd)));
            let (ab, cd) = (call!(_mm512_unpackhi_ps(a, b)), call!(_mm512_unpackhi_ps(c, d)));
            out[4 * half + 2] = Self(call!(_mm512_shuffle_ps::<0x44>(ab, cd)));
            out[4 * half + 3] = Self(call!(_mm512_shuffle_ps::<0xee>(ab, cd)));
        }
        out
    }
    #[inline(always)]
    fn same(ids: &[u32; 16], id: u32) -> u32 {
        // SAFETY: reads the 64 bytes of `ids`, unaligned; features as above.
        let ids = unsafe { _mm512_loadu_si512(ids.as_ptr().cast()) };
        let id = call!(_mm512_set1_epi32(id as i32));
        u32::from(call!(_mm512_cmpeq_epi32_mask(ids, id)))
    }
    #[inline(always)]
    fn set_some(id: u32, bits: u32, ids: &mut [u32; 16]) {
        // SAFETY: writes to the 64 bytes of `ids` at most; features as above.
        unsafe { _mm512_mask_storeu_epi32(ids.as_mut_ptr().cast(), bits as u16, _mm512_set1_epi32(id as i32)) };
    }
}
