//! Eight f32 side by side, and how a task gets the best form of them.

use super::SimdLevel;

/// Eight f32 numbers worked on together.
///
/// Implementations differ in speed and in whether [`Self::mul_add`] rounds once or twice; code over lanes may only take decisions that
/// are right for both. A NaN operand of `min` and `max` gives either operand.
pub trait Lanes: Copy {
    /// All lanes `x`.
    fn splat(x: f32) -> Self;
    /// Lane `i` is `x[i]`.
    fn load(x: &[f32; 8]) -> Self;
    /// The lanes as an array.
    fn store(self) -> [f32; 8];
    /// Lane by lane `self + other`.
    fn plus(self, other: Self) -> Self;
    /// Lane by lane `self - other`.
    fn minus(self, other: Self) -> Self;
    /// Lane by lane `self * other`.
    fn times(self, other: Self) -> Self;
    /// Lane by lane `self * factor + term`, with one or two roundings.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Lane by lane `self * factor - term`, with one or two roundings.
    fn mul_sub(self, factor: Self, term: Self) -> Self;
    /// Lane by lane without its sign.
    fn abs(self) -> Self;
    /// The lesser of each lane.
    fn min(self, other: Self) -> Self;
    /// The greater of each lane.
    fn max(self, other: Self) -> Self;
    /// Bit `i` is set where lane `i` of `self` is at most that of `other`; clear for NaN.
    fn at_most(self, other: Self) -> u32;
    /// Bit `i` is set where lane `i` of `self` is below that of `other`; clear for NaN.
    fn below(self, other: Self) -> u32;
}

/// Work written once over [`Lanes`]; its `run` and all below it must be `#[inline(always)]` to be compiled for each level.
pub trait Task {
    /// What the work gives.
    type Output;
    /// The work.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Runs `task` with the instructions of `level`, or of the best level where this machine lacks it.
pub fn dispatch<T: Task>(level: SimdLevel, task: T) -> T::Output {
    match level.or_best() {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `or_best` returns no level above `best`, and `available` lists these only where AVX2 and FMA were detected.
        SimdLevel::Avx2 | SimdLevel::Avx512 => unsafe { x86::run(task) },
        _ => task.run::<Portable>(),
    }
}

/// What every target has: eight numbers in an array.
#[derive(Clone, Copy)]
struct Portable([f32; 8]);

#[inline(always)]
fn each(a: Portable, b: Portable, f: impl Fn(f32, f32) -> f32) -> Portable {
    Portable(std::array::from_fn(|i| f(a.0[i], b.0[i])))
}

#[inline(always)]
fn bits(a: Portable, b: Portable, f: impl Fn(f32, f32) -> bool) -> u32 {
    let mut out = 0;
    for i in 0..8 {
        out |= u32::from(f(a.0[i], b.0[i])) << i;
    }
    out
}

impl Lanes for Portable {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn load(x: &[f32; 8]) -> Self {
        Self(*x)
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        self.0
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        each(self, other, |a, b| a + b)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        each(self, other, |a, b| a - b)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        each(self, other, |a, b| a * b)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self.times(factor).plus(term)
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, term: Self) -> Self {
        self.times(factor).minus(term)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        each(self, self, |a, _| a.abs())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        each(self, other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        each(self, other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        bits(self, other, |a, b| a <= b)
    }
    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        bits(self, other, |a, b| a < b)
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Lanes, Task};
    use std::arch::x86_64::*;

    /// One AVX register. Private, so that a value or a method of it is reached through [`run`] alone, where AVX2 and FMA exist.
    #[derive(Clone, Copy)]
    pub(super) struct Avx2(__m256);

    #[target_feature(enable = "avx2,fma")]
    pub(super) fn run<T: Task>(task: T) -> T::Output {
        task.run::<Avx2>()
    }

    /// Calls an intrinsic on registers.
    macro_rules! call {
        ($intrinsic:ident $(::<$n:ident>)? ($($arg:expr),*)) => {
            // SAFETY: `Avx2` is private to this module and named only in `run`, whose caller has detected AVX2 and FMA; these
            // intrinsics have no other precondition.
            unsafe { $intrinsic $(::<$n>)? ($($arg),*) }
        };
    }

    impl Lanes for Avx2 {
        #[inline(always)]
        fn splat(x: f32) -> Self {
            Self(call!(_mm256_set1_ps(x)))
        }
        #[inline(always)]
        fn load(x: &[f32; 8]) -> Self {
            // SAFETY: reads the 32 bytes of `x`, unaligned; AVX2 as above.
            Self(unsafe { _mm256_loadu_ps(x.as_ptr()) })
        }
        #[inline(always)]
        fn store(self) -> [f32; 8] {
            let mut out = [0.0; 8];
            // SAFETY: writes the 32 bytes of `out`, unaligned; AVX2 as above.
            unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
            out
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
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct All;

    impl Task for All {
        type Output = Vec<f32>;

        #[inline(always)]
        fn run<L: Lanes>(self) -> Vec<f32> {
            let a = L::load(&[1.0, -2.0, 3.5, 0.0, -0.5, 8.0, 1e30, 7.0]);
            let b = L::load(&[2.0, -2.0, 0.25, 4.0, 16.0, -1.0, 1.0, 7.5]);
            let c = L::splat(2.0);
            let mut out: Vec<f32> =
                [a.plus(b), a.minus(b), a.times(b), a.mul_add(b, c), a.mul_sub(b, c), a.min(b), a.max(b), a.abs()]
                    .into_iter()
                    .flat_map(L::store)
                    .collect();
            out.extend([a.at_most(b), a.below(b)].map(|bits| bits as f32));
            out
        }
    }

    #[test]
    fn every_level_gives_the_same_on_numbers_that_do_not_round() {
        let expected = dispatch(SimdLevel::Portable, All);
        assert_eq!(expected[..8], [3.0, -4.0, 3.75, 4.0, 15.5, 7.0, 1e30, 14.5]);
        assert_eq!(expected[64..], [f32::from(0b1001_1011u8), f32::from(0b1001_1001u8)]);
        for &level in SimdLevel::available() {
            assert_eq!(dispatch(level, All), expected, "{level:?}");
        }
    }
}
