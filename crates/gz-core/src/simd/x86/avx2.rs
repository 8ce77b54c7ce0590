//! Eight f32 in an AVX register.

use super::{Avx2, four, turned};
use crate::simd::lanes::Lanes;
use std::arch::x86_64::*;

/// Lane `i` is all ones where bit `i` of the eight is set.
#[inline(always)]
fn spread(bits: u32) -> __m256i {
    let each = call!(_mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128));
    let bits = call!(_mm256_set1_epi32(bits as i32));
    let bits = call!(_mm256_and_si256(bits, each));
    call!(_mm256_cmpeq_epi32(bits, each))
}

/// For each set of lanes their numbers, in the order in which pairs of them come to lie one after the other when halves of registers are
/// zipped.
static FRONT: [[u8; 8]; 256] = {
    let mut front = [[0; 8]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < 8 {
            if bits >> lane & 1 != 0 {
                front[bits][[0, 1, 4, 5, 2, 3, 6, 7][count]] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    front
};

impl Lanes<8> for Avx2 {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(call!(_mm256_set1_ps(x)))
    }
    #[inline(always)]
    fn load(x: &[f32; 8]) -> Self {
        // SAFETY: reads the 32 bytes of `x`, unaligned; features as above.
        Self(unsafe { _mm256_loadu_ps(x.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        // SAFETY: writes the 32 bytes of `to`, unaligned; features as above.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) };
    }
    #[inline(always)]
    fn select(self, bits: u32, other: Self) -> Self {
        let here = call!(_mm256_castsi256_ps(spread(bits)));
        Self(call!(_mm256_blendv_ps(other.0, self.0, here)))
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        let (one, two) = (call!(_mm256_castps_si256(self.0)), call!(_mm256_castps_si256(other.0)));
        let lanes = call!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(one, two)));
        call!(_mm256_movemask_ps(lanes)) as u32
    }
    #[inline(always)]
    fn least(self) -> f32 {
        let (low, high) = (call!(_mm256_castps256_ps128(self.0)), call!(_mm256_extractf128_ps::<1>(self.0)));
        let four = call!(_mm_min_ps(low, high));
        let two = call!(_mm_min_ps(four, _mm_movehl_ps(four, four)));
        let one = call!(_mm_min_ss(two, _mm_movehdup_ps(two)));
        call!(_mm_cvtss_f32(one))
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        let (low, high) = (call!(_mm256_castps256_ps128(self.0)), call!(_mm256_extractf128_ps::<1>(self.0)));
        let four = call!(_mm_max_ps(low, high));
        let two = call!(_mm_max_ps(four, _mm_movehl_ps(four, four)));
        let one = call!(_mm_max_ss(two, _mm_movehdup_ps(two)));
        call!(_mm_cvtss_f32(one))
    }
    #[inline(always)]
    fn least_of_each([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        let ab = call!(_mm256_min_ps(_mm256_unpacklo_ps(a.0, b.0), _mm256_unpackhi_ps(a.0, b.0)));
        let cd = call!(_mm256_min_ps(_mm256_unpacklo_ps(c.0, d.0), _mm256_unpackhi_ps(c.0, d.0)));
        let each = call!(_mm256_min_ps(_mm256_shuffle_ps::<0x44>(ab, cd), _mm256_shuffle_ps::<0xee>(ab, cd)));
        four(call!(_mm_min_ps(_mm256_castps256_ps128(each), _mm256_extractf128_ps::<1>(each))))
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(call!(_mm256_add_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(call!(_mm256_sub_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(call!(_mm256_mul_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(call!(_mm256_div_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(call!(_mm256_fmadd_ps(self.0, factor.0, term.0)))
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, term: Self) -> Self {
        Self(call!(_mm256_fmsub_ps(self.0, factor.0, term.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let sign = call!(_mm256_set1_ps(-0.0));
        Self(call!(_mm256_andnot_ps(sign, self.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(call!(_mm256_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(call!(_mm256_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        let lanes = call!(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0));
        call!(_mm256_movemask_ps(lanes)) as u32
    }
    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        let lanes = call!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0));
        call!(_mm256_movemask_ps(lanes)) as u32
    }
    #[inline(always)]
    fn unzip3(points: &[[f32; 3]; 8]) -> [Self; 3] {
        let start: *const f32 = points.as_ptr().cast();
        // SAFETY: the 24 numbers of `points` are read, four at a time; features as above.
        unsafe {
            // Numbers 4 k to 4 k + 3 beside those twelve further on.
            let a = _mm256_loadu2_m128(start.add(12), start);
            let b = _mm256_loadu2_m128(start.add(16), start.add(4));
            let c = _mm256_loadu2_m128(start.add(20), start.add(8));
            let x2y2x3y3 = _mm256_shuffle_ps::<0b10_01_11_10>(b, c);
            let y0z0y1z1 = _mm256_shuffle_ps::<0b01_00_10_01>(a, b);
            [
                Self(_mm256_shuffle_ps::<0b10_00_11_00>(a, x2y2x3y3)),
                Self(_mm256_shuffle_ps::<0b11_01_10_00>(y0z0y1z1, x2y2x3y3)),
                Self(_mm256_shuffle_ps::<0b11_00_11_01>(y0z0y1z1, c)),
            ]
        }
    }
    #[inline(always)]
    fn unzip8(rows: &[[f32; 8]; 8]) -> [Self; 8] {
        let start: *const f32 = rows.as_ptr().cast();
        let mut out = [Self(call!(_mm256_setzero_ps())); 8];
        for half in 0..2 {
            // SAFETY: of the 64 numbers of `rows` four at a time are read, a half of rows i and i + 4 each; features as above.
            let rows = unsafe {
                let start = start.add(4 * half);
                [
                    _mm256_loadu2_m128(start.add(32), start),
                    _mm256_loadu2_m128(start.add(40), start.add(8)),
                    _mm256_loadu2_m128(start.add(48), start.add(16)),
                    _mm256_loadu2_m128(start.add(56), start.add(24)),
                ]
            };
            let [a, b, c, d] = turned(rows);
            out[4 * half] = Self(a);
            out[4 * half + 1] = Self(b);
            out[4 * half + 2] = Self(c);
            out[4 * half + 3] = Self(d);
        }
        out
    }
    #[inline(always)]
    fn same(ids: &[u32; 8], id: u32) -> u32 {
        // SAFETY: reads the 32 bytes of `ids`, unaligned; features as above.
        let ids = unsafe { _mm256_loadu_si256(ids.as_ptr().cast()) };
        let id = call!(_mm256_set1_epi32(id as i32));
        let lanes = call!(_mm256_cmpeq_epi32(ids, id));
        let lanes = call!(_mm256_castsi256_ps(lanes));
        call!(_mm256_movemask_ps(lanes)) as u32
    }
    #[inline(always)]
    fn front(self, numbers: &[u32; 8], bits: u32, to: &mut [i64; 8]) {
        let lanes = u64::from_le_bytes(FRONT[bits as usize & 0xff]);
        let lanes = call!(_mm256_cvtepu8_epi32(_mm_cvtsi64_si128(lanes as i64)));
        // SAFETY: reads the 32 bytes of `numbers` and writes the 64 of `to`, unaligned; features as above.
        unsafe {
            let numbers = _mm256_permutevar8x32_epi32(_mm256_loadu_si256(numbers.as_ptr().cast()), lanes);
            let x = _mm256_castps_si256(_mm256_permutevar8x32_ps(self.0, lanes));
            let to = to.as_mut_ptr().cast::<__m256i>();
            _mm256_storeu_si256(to, _mm256_unpacklo_epi32(numbers, x));
            _mm256_storeu_si256(to.add(1), _mm256_unpackhi_epi32(numbers, x));
        }
    }
    #[inline(always)]
    fn set_some(id: u32, bits: u32, ids: &mut [u32; 8]) {
        // SAFETY: writes to the 32 bytes of `ids` at most; features as above.
        unsafe { _mm256_maskstore_epi32(ids.as_mut_ptr().cast(), spread(bits), _mm256_set1_epi32(id as i32)) };
    }
}
