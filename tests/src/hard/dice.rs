//! Random numbers that are the same everywhere, from a seed.

use gz_core::GzCoord;
use gz_core::glam::DVec3;

/// A generator with 64 bits of state; any seed is as good as another, and neighbouring seeds give unrelated numbers.
///
/// Source: G. Steele, D. Lea, C. Flood 2014, "Fast Splittable Pseudorandom Number Generators": SplitMix64.
#[derive(Clone, Debug)]
pub struct Dice(u64);

impl Dice {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1), a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [lo, hi], rounded to f32.
    pub fn between(&mut self, lo: f64, hi: f64) -> f32 {
        (lo + (hi - lo) * self.unit()) as f32
    }

    /// From 0 to n - 1; 0 for n = 0.
    pub fn below(&mut self, n: usize) -> usize {
        // The bias of the remainder is below 2^-32 for every n in use.
        (self.bits() % n.max(1) as u64) as usize
    }

    /// A whole number from -n to n.
    pub fn whole(&mut self, n: i32) -> i32 {
        self.below(2 * n as usize + 1) as i32 - n
    }

    /// One of `all`.
    ///
    /// # Panics
    ///
    /// If there is none.
    pub fn pick<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// 10^x with x even in [lo, hi].
    pub fn magnitude(&mut self, lo: f64, hi: f64) -> f64 {
        10f64.powf(lo + (hi - lo) * self.unit())
    }

    /// -1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// A point of the cube [-r, r]^3.
    pub fn point(&mut self, r: f64) -> DVec3 {
        DVec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5) * (2.0 * r)
    }

    /// The same with whole coordinates.
    pub fn whole_point(&mut self, r: i32) -> GzCoord {
        GzCoord::new(self.whole(r) as f32, self.whole(r) as f32, self.whole(r) as f32)
    }

    /// A direction of length 1, even over the sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.point(1.0);
            let square = p.length_squared();
            if square > 1e-4 && square <= 1.0 {
                return p / square.sqrt();
            }
        }
    }

    /// Two vectors of length 1 at right angles to each other, and the third that completes them.
    pub fn frame(&mut self) -> [DVec3; 3] {
        let x = self.direction();
        loop {
            if let Some(y) = x.cross(self.direction()).try_normalize() {
                return [x, y, x.cross(y)];
            }
        }
    }

    /// Three weights, each at least 0, that sum to 1, even over the triangle.
    pub fn weights(&mut self) -> [f64; 3] {
        let (mut u, mut v) = (self.unit(), self.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        [1.0 - u - v, u, v]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_seed_and_in_their_ranges() {
        // The first numbers of SplitMix64 from seed 0.
        let mut dice = Dice::new(0);
        assert_eq!([dice.bits(), dice.bits()], [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4]);
        let mut least = [0usize; 7];
        for _ in 0..7000 {
            least[(dice.whole(3) + 3) as usize] += 1;
            let (u, m) = (dice.unit(), dice.magnitude(-2.0, 3.0));
            assert!((0.0..1.0).contains(&u) && (0.0099..1000.1).contains(&m));
            let w = dice.weights();
            assert!(w.iter().all(|&w| w >= 0.0) && (w[0] + w[1] + w[2] - 1.0).abs() < 1e-15);
            assert!((dice.direction().length() - 1.0).abs() < 1e-15);
        }
        assert!(least.iter().all(|&n| n > 800), "{least:?}");
        let [x, y, z] = dice.frame();
        assert!(x.dot(y).abs() < 1e-15 && (x.cross(y) - z).length() < 1e-15);
    }
}
