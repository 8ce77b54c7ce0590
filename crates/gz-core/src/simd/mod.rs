//! What the processor and its memory offer, found at run time. The only unsafe code of the project.
#![allow(unsafe_code)]

mod control;
mod doubles;
mod lanes;
mod pages;
mod portable;
mod view;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use control::with_default_float_control;
pub use doubles::{Doubles, EightDoubles};
pub use lanes::{Lanes, Simd, Task, arrays3, dispatch, load3, splat3};
pub use pages::{Pages, advise_large};
use std::sync::OnceLock;
pub use view::{coordinates, coordinates_f64, nine, numbers_of, numbers_of_rays};

/// A set of vector instructions that kernels are compiled for. Answers do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SimdLevel {
    /// What the build target guarantees.
    Portable,
    /// AVX2 with fused multiply-add and the bit operations of its time: eight f32 at a time.
    Avx2,
    /// AVX-512 F, VL, DQ and BW: sixteen f32 at a time.
    Avx512,
}

impl SimdLevel {
    /// The best level of this machine.
    pub fn best() -> Self {
        static BEST: OnceLock<SimdLevel> = OnceLock::new();
        *BEST.get_or_init(|| Self::available().last().copied().unwrap_or(Self::Portable))
    }

    /// All levels that this machine can run, the least first.
    pub fn available() -> &'static [Self] {
        #[cfg(target_arch = "x86_64")]
        {
            let bits = is_x86_feature_detected!("bmi1")
                && is_x86_feature_detected!("bmi2")
                && is_x86_feature_detected!("lzcnt")
                && is_x86_feature_detected!("popcnt");
            let avx2 = bits && is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
            let avx512 = avx2
                && is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw");
            if avx512 {
                return &[Self::Portable, Self::Avx2, Self::Avx512];
            }
            if avx2 {
                return &[Self::Portable, Self::Avx2];
            }
        }
        &[Self::Portable]
    }

    /// This level, or the best available one where this machine lacks it.
    #[must_use]
    pub fn or_best(self) -> Self {
        self.min(Self::best())
    }
}
