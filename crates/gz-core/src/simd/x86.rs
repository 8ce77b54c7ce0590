//! AVX2 and AVX-512.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::lanes::{Doubles, EightDoubles, Lanes, Pair, Simd, Task};
use super::view::rows_of;
use crate::Hit;
use std::arch::x86_64::*;

/// Calls an intrinsic on registers.
macro_rules! call {
    ($intrinsic:ident $(::<$n:tt>)? ($($arg:expr),*)) => {
        // SAFETY: the types of this file are named only in `run_avx2` and `run_avx512`, whose caller has detected the features; these
        // intrinsics have no other precondition.
        unsafe { $intrinsic $(::<$n>)? ($($arg),*) }
    };
}

#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) fn run_avx2<T: Task>(task: T) -> T::Output {
    task.run::<Avx2Simd>()
}

#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw")]
pub(super) fn run_avx512<T: Task>(task: T) -> T::Output {
    task.run::<Avx512Simd>()
}

struct Avx2Simd;
struct Avx512Simd;

impl Simd for Avx2Simd {
    type Doubles = Avx2Doubles;
    type Eight = Avx2;
    type Sixteen = Pair<Avx2>;

    #[inline(always)]
    fn join(low: Avx2, high: Avx2) -> Pair<Avx2> {
        Pair(low, high)
    }

    #[inline(always)]
    fn widen(x: Avx2) -> Avx2Doubles {
        let (low, high) = (call!(_mm256_castps256_ps128(x.0)), call!(_mm256_extractf128_ps::<1>(x.0)));
        Avx2Doubles(call!(_mm256_cvtps_pd(low)), call!(_mm256_cvtps_pd(high)))
    }

    #[inline(always)]
    fn narrow(x: Avx2Doubles) -> Avx2 {
        let (low, high) = (call!(_mm256_cvtpd_ps(x.0)), call!(_mm256_cvtpd_ps(x.1)));
        Avx2(call!(_mm256_set_m128(high, low)))
    }

    #[inline(always)]
    fn write_hits(rows: [Avx2; 4], hits: &mut [Hit; 8]) {
        write_rows(rows, rows_of(hits));
    }

    #[inline(always)]
    fn corners(corners: &[&[f32; 9]; 8]) -> [Avx2; 9] {
        transpose(corners)
    }

    #[inline(always)]
    fn prefetch<T>(what: &T) {
        prefetch(what);
    }
}

impl Simd for Avx512Simd {
    type Doubles = Avx512Doubles;
    type Eight = Avx2;
    type Sixteen = Avx512;

    #[inline(always)]
    fn join(low: Avx2, high: Avx2) -> Avx512 {
        Avx512(call!(_mm512_insertf32x8::<1>(_mm512_castps256_ps512(low.0), high.0)))
    }

    #[inline(always)]
    fn widen(x: Avx2) -> Avx512Doubles {
        Avx512Doubles(call!(_mm512_cvtps_pd(x.0)))
    }

    #[inline(always)]
    fn narrow(x: Avx512Doubles) -> Avx2 {
        Avx2(call!(_mm512_cvtpd_ps(x.0)))
    }

    #[inline(always)]
    fn write_hits(rows: [Avx2; 4], hits: &mut [Hit; 8]) {
        write_rows(rows, rows_of(hits));
    }

    #[inline(always)]
    fn corners(corners: &[&[f32; 9]; 8]) -> [Avx2; 9] {
        transpose(corners)
    }

    #[inline(always)]
    fn prefetch<T>(what: &T) {
        prefetch(what);
    }
}

#[inline(always)]
fn prefetch<T>(what: &T) {
    let start: *const i8 = std::ptr::from_ref(what).cast();
    for line in (0..size_of::<T>()).step_by(64) {
        // SAFETY: a prefetch reads nothing; the address is within `what`. SSE is part of x86-64.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(line)) };
    }
}

/// Four columns as rows of four.
#[inline(always)]
fn write_rows([a, b, c, d]: [Avx2; 4], to: &mut [[f32; 4]; 8]) {
    // SAFETY: each row of `to` is written once, 16 bytes, unaligned; the features are there where the caller was reached.
    unsafe {
        let (ab, ab_high) = (_mm256_unpacklo_ps(a.0, b.0), _mm256_unpackhi_ps(a.0, b.0));
        let (cd, cd_high) = (_mm256_unpacklo_ps(c.0, d.0), _mm256_unpackhi_ps(c.0, d.0));
        // Row k beside row k + 4.
        let rows = [
            _mm256_shuffle_ps::<0x44>(ab, cd),
            _mm256_shuffle_ps::<0xee>(ab, cd),
            _mm256_shuffle_ps::<0x44>(ab_high, cd_high),
            _mm256_shuffle_ps::<0xee>(ab_high, cd_high),
        ];
        for k in 0..4 {
            _mm_storeu_ps(to[k].as_mut_ptr(), _mm256_castps256_ps128(rows[k]));
            _mm_storeu_ps(to[k + 4].as_mut_ptr(), _mm256_extractf128_ps::<1>(rows[k]));
        }
    }
}

/// Rows of nine as nine columns.
#[inline(always)]
fn transpose(rows: &[&[f32; 9]; 8]) -> [Avx2; 9] {
    // SAFETY: reads the first eight of the nine numbers of each row; the features are there where the caller was reached.
    unsafe {
        let mut r = [_mm256_setzero_ps(); 8];
        for (r, row) in r.iter_mut().zip(rows) {
            *r = _mm256_loadu_ps(row.as_ptr());
        }
        // Pairs, fours, halves.
        let (a, b) = (_mm256_unpacklo_ps(r[0], r[1]), _mm256_unpackhi_ps(r[0], r[1]));
        let (c, d) = (_mm256_unpacklo_ps(r[2], r[3]), _mm256_unpackhi_ps(r[2], r[3]));
        let (e, f) = (_mm256_unpacklo_ps(r[4], r[5]), _mm256_unpackhi_ps(r[4], r[5]));
        let (g, h) = (_mm256_unpacklo_ps(r[6], r[7]), _mm256_unpackhi_ps(r[6], r[7]));
        let (s0, s1) = (_mm256_shuffle_ps::<0x44>(a, c), _mm256_shuffle_ps::<0xee>(a, c));
        let (s2, s3) = (_mm256_shuffle_ps::<0x44>(b, d), _mm256_shuffle_ps::<0xee>(b, d));
        let (s4, s5) = (_mm256_shuffle_ps::<0x44>(e, g), _mm256_shuffle_ps::<0xee>(e, g));
        let (s6, s7) = (_mm256_shuffle_ps::<0x44>(f, h), _mm256_shuffle_ps::<0xee>(f, h));
        [
            Avx2(_mm256_permute2f128_ps::<0x20>(s0, s4)),
            Avx2(_mm256_permute2f128_ps::<0x20>(s1, s5)),
            Avx2(_mm256_permute2f128_ps::<0x20>(s2, s6)),
            Avx2(_mm256_permute2f128_ps::<0x20>(s3, s7)),
            Avx2(_mm256_permute2f128_ps::<0x31>(s0, s4)),
            Avx2(_mm256_permute2f128_ps::<0x31>(s1, s5)),
            Avx2(_mm256_permute2f128_ps::<0x31>(s2, s6)),
            Avx2(_mm256_permute2f128_ps::<0x31>(s3, s7)),
            Avx2(_mm256_setr_ps(rows[0][8], rows[1][8], rows[2][8], rows[3][8], rows[4][8], rows[5][8], rows[6][8], rows[7][8])),
        ]
    }
}

/// One AVX register. Private, so that a value or a method of it is reached through the two functions above alone.
#[derive(Clone, Copy)]
struct Avx2(__m256);

/// One AVX-512 register; private as well.
#[derive(Clone, Copy)]
struct Avx512(__m512);

/// Lane `i` is all ones where bit `i` of the eight is set.
#[inline(always)]
fn spread(bits: u32) -> __m256i {
    let each = call!(_mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128));
    let bits = call!(_mm256_set1_epi32(bits as i32));
    let bits = call!(_mm256_and_si256(bits, each));
    call!(_mm256_cmpeq_epi32(bits, each))
}

/// The numbers of a register.
#[inline(always)]
fn four(x: __m128) -> [f32; 4] {
    let mut out = [0.0; 4];
    // SAFETY: writes the 16 bytes of `out`, unaligned. SSE is part of x86-64.
    unsafe { _mm_storeu_ps(out.as_mut_ptr(), x) };
    out
}

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
    fn same(ids: &[u32; 8], id: u32) -> u32 {
        // SAFETY: reads the 32 bytes of `ids`, unaligned; features as above.
        let ids = unsafe { _mm256_loadu_si256(ids.as_ptr().cast()) };
        let id = call!(_mm256_set1_epi32(id as i32));
        let lanes = call!(_mm256_cmpeq_epi32(ids, id));
        let lanes = call!(_mm256_castsi256_ps(lanes));
        call!(_mm256_movemask_ps(lanes)) as u32
    }
    #[inline(always)]
    fn set_some(id: u32, bits: u32, ids: &mut [u32; 8]) {
        // SAFETY: writes to the 32 bytes of `ids` at most; features as above.
        unsafe { _mm256_maskstore_epi32(ids.as_mut_ptr().cast(), spread(bits), _mm256_set1_epi32(id as i32)) };
    }
}

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

/// Eight f64 in two AVX registers; private as well.
#[derive(Clone, Copy)]
struct Avx2Doubles(__m256d, __m256d);

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

/// One AVX-512 register of f64; private as well.
#[derive(Clone, Copy)]
struct Avx512Doubles(__m512d);

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
