//! Bytes read as numbers; behind their end there are zeros.

use gz_core::GzCoord;
use gz_core::glam::DVec3;

pub(super) struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    pub(super) fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut taken = [0; N];
        let n = N.min(self.0.len());
        let (now, rest) = self.0.split_at(n);
        taken[..n].copy_from_slice(now);
        self.0 = rest;
        taken
    }

    pub(super) fn byte(&mut self) -> u8 {
        self.take::<1>()[0]
    }

    /// A number below `n`, which is at least 1.
    pub(super) fn below(&mut self, n: usize) -> usize {
        if n <= 256 { usize::from(self.byte()) % n } else { usize::from(u16::from_le_bytes(self.take())) % n }
    }

    /// Any f32.
    pub(super) fn float(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }

    /// Three of them.
    pub(super) fn point(&mut self) -> GzCoord {
        GzCoord::new(self.float(), self.float(), self.float())
    }

    /// Three of any f64.
    pub(super) fn point_f64(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| f64::from_le_bytes(self.take())))
    }

    /// A multiple of 1/256 from -128 to 128.
    pub(super) fn short(&mut self) -> f32 {
        f32::from(i16::from_le_bytes(self.take())) / 256.0
    }

    /// 2^k for k from -`n` to `n`.
    pub(super) fn power(&mut self, n: i32) -> f32 {
        2f32.powi(i32::from(self.byte()) % (2 * n + 1) - n)
    }
}
