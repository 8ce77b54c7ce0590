//! Powers of eight numbers at a time, with the bits of [`power`].
// Lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use crate::eight::lanes;
use crate::phong::power;
use gz_core::simd::EightDoubles;

/// Eight powers of highlights.
#[derive(Debug, Default)]
pub(crate) struct Powers {
    exact: [f32; 8],
    /// The same where they are whole and have at most 16 bits.
    whole: [u16; 8],
    /// The lanes where they are not.
    others: u32,
}

impl Powers {
    pub(crate) fn set(&mut self, k: usize, power: f32) {
        self.exact[k] = power;
        self.whole[k] = power as u16;
        self.others |= u32::from(f32::from(self.whole[k]) != power) << k;
    }

    /// `base`, in [0, 1], to these powers, as [`power`] has it, in `wanted` lanes.
    #[inline(always)]
    pub(crate) fn of<D: EightDoubles>(&self, base: D, wanted: u32) -> D {
        if wanted & self.others != 0 {
            return D::load(&self.each(base.array(), wanted));
        }
        // By repeated squaring, all lanes in step.
        let (mut result, mut square, mut bits) = (D::splat(1.0), base, self.whole);
        loop {
            let (mut odd, mut rest) = (0, 0);
            for k in 0..8 {
                odd |= u32::from(bits[k] & 1) << k;
                bits[k] >>= 1;
                rest |= bits[k];
            }
            result = result.times(square).select(odd, result);
            if rest == 0 {
                return result;
            }
            square = square.times(square);
        }
    }

    /// The same, lane by lane.
    #[inline(never)]
    fn each(&self, mut base: [f64; 8], wanted: u32) -> [f64; 8] {
        for k in lanes(wanted) {
            base[k] = power(base[k], self.exact[k]);
        }
        base
    }
}
