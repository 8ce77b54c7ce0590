//! AVX2 and AVX-512.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::lanes::{Simd, Task};
use super::portable::Pair;
use super::view::rows_of;
use crate::Hit;
use std::arch::x86_64::*;

/// Calls an intrinsic on registers.
macro_rules! call {
    ($intrinsic:ident $(::<$n:tt>)? ($($arg:expr),*)) => {
        // SAFETY: the types of this folder are named only in `run_avx2` and `run_avx512`, whose caller has detected the features; these
        // intrinsics have no other precondition.
        unsafe { $intrinsic $(::<$n>)? ($($arg),*) }
    };
}

mod avx2;
mod avx512;
mod doubles;

use doubles::{Avx2Doubles, Avx512Doubles};

#[inline(never)]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) fn run_avx2<T: Task>(task: T) -> T::Output {
    task.run::<Avx2Simd>()
}

#[inline(never)]
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
    fn apart<T: Task>(task: T) -> T::Output {
        call!(run_avx2(task))
    }

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
    fn apart<T: Task>(task: T) -> T::Output {
        call!(run_avx512(task))
    }

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

/// Four rows of four as four columns, in each half: number k of half h of result i is number i of half h of row k.
#[inline(always)]
fn turned([a, b, c, d]: [__m256; 4]) -> [__m256; 4] {
    let (ab, ab_high) = (call!(_mm256_unpacklo_ps(a, b)), call!(_mm256_unpackhi_ps(a, b)));
    let (cd, cd_high) = (call!(_mm256_unpacklo_ps(c, d)), call!(_mm256_unpackhi_ps(c, d)));
    [
        call!(_mm256_shuffle_ps::<0x44>(ab, cd)),
        call!(_mm256_shuffle_ps::<0xee>(ab, cd)),
        call!(_mm256_shuffle_ps::<0x44>(ab_high, cd_high)),
        call!(_mm256_shuffle_ps::<0xee>(ab_high, cd_high)),
    ]
}

/// Four columns as rows of four.
#[inline(always)]
fn write_rows([a, b, c, d]: [Avx2; 4], to: &mut [[f32; 4]; 8]) {
    // SAFETY: each row of `to` is written once, 16 bytes, unaligned; the features are there where the caller was reached.
    unsafe {
        // Row k beside row k + 4.
        let rows = turned([a.0, b.0, c.0, d.0]);
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
        let ([s0, s1, s2, s3], [s4, s5, s6, s7]) = (turned([r[0], r[1], r[2], r[3]]), turned([r[4], r[5], r[6], r[7]]));
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

/// The numbers of a register.
#[inline(always)]
fn four(x: __m128) -> [f32; 4] {
    let mut out = [0.0; 4];
    // SAFETY: writes the 16 bytes of `out`, unaligned. SSE is part of x86-64.
    unsafe { _mm_storeu_ps(out.as_mut_ptr(), x) };
    out
}
