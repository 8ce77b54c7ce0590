//! Rays in packets: sets of them, and numbers that they have.
// Packets and axes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use crate::simd::{Lanes, Simd};

/// Rays that one operation works on.
pub const LANES: usize = 16;
/// Packets of a bundle.
pub const PACKETS: usize = 4;
/// Rays of a bundle.
pub const BUNDLE: usize = LANES * PACKETS;

/// All rays of a packet.
const WHOLE: u32 = (1 << LANES) - 1;

/// One number for each ray of a packet.
pub type Row = [f32; LANES];
/// One number for each ray.
pub type Each = [Row; PACKETS];
/// A set of rays: a bit for each ray of each packet.
pub type Rays = [u32; PACKETS];

/// The rays in a set.
#[inline(always)]
pub fn count(rays: &Rays) -> u32 {
    rays.iter().map(|packet| packet.count_ones()).sum()
}

/// The packets in which a set has rays.
#[inline(always)]
pub fn packets(rays: &Rays) -> u32 {
    rays.iter().fold(0, |packets, &packet| packets + u32::from(packet != 0))
}

/// The first ray of a set.
#[inline(always)]
pub fn first(rays: &Rays) -> Option<(usize, usize)> {
    (0..PACKETS).find(|&p| rays[p] != 0).map(|p| (p, rays[p].trailing_zeros() as usize % LANES))
}

/// Whether there is no ray in a set.
// Not by comparing arrays, as that goes through memory.
#[inline(always)]
pub fn is_none(rays: &Rays) -> bool {
    rays.iter().fold(0, |any, packet| any | packet) == 0
}

/// `x` where the bit is set, `other` elsewhere; as most sets are whole, that is looked at first.
#[inline(always)]
fn some<L: Lanes<LANES>>(x: L, bits: u32, other: L) -> L {
    if bits == WHOLE { x } else { x.select(bits, other) }
}

/// The least number of the rays in a set; infinite when it is empty.
#[inline(always)]
pub fn least<S: Simd>(each: &Each, rays: &Rays) -> f32 {
    let mut least = <S::Sixteen>::splat(f32::INFINITY);
    for p in 0..PACKETS {
        least = some(<S::Sixteen>::load(&each[p]), rays[p], least).min(least);
    }
    least.least()
}

/// The greatest number of the rays in a set.
#[inline(always)]
pub fn greatest<S: Simd>(each: &Each, rays: &Rays) -> f32 {
    let mut greatest = <S::Sixteen>::splat(f32::NEG_INFINITY);
    for p in 0..PACKETS {
        greatest = some(<S::Sixteen>::load(&each[p]), rays[p], greatest).max(greatest);
    }
    greatest.greatest()
}

/// The least of three numbers, and the greatest of three, of the rays in a set, which is not empty.
#[inline(always)]
pub fn extremes<S: Simd>(low: &[Each; 3], high: &[Each; 3], rays: &Rays) -> [[f32; 3]; 2] {
    let zero = <S::Sixteen>::splat(0.0);
    // The greatest with other signs.
    let mut least = [<S::Sixteen>::splat(f32::INFINITY); 6];
    for p in 0..PACKETS {
        let (low, high) = (packet_of(low, p), packet_of(high, p));
        let all: [S::Sixteen; 6] = [low[0], low[1], low[2], zero.minus(high[0]), zero.minus(high[1]), zero.minus(high[2])];
        // As `some` has it, but looked at once for all six, which primary rays notice.
        if rays[p] == WHOLE {
            for k in 0..6 {
                least[k] = all[k].min(least[k]);
            }
        } else if rays[p] != 0 {
            for k in 0..6 {
                least[k] = all[k].select(rays[p], least[k]).min(least[k]);
            }
        }
    }
    let [x, y, z, a] = <S::Sixteen>::least_of_each([least[0], least[1], least[2], least[3]]);
    let [b, c, ..] = <S::Sixteen>::least_of_each([least[4], least[5], least[5], least[5]]);
    [[x, y, z], [-a, -b, -c]]
}

/// The same of three numbers, `common` to all rays of the bundle or not.
#[inline(always)]
pub fn span<S: Simd>(each: &[Each; 3], common: bool, rays: &Rays) -> [[f32; 3]; 2] {
    if common { [[each[0][0][0], each[1][0][0], each[2][0][0]]; 2] } else { extremes::<S>(each, each, rays) }
}

/// Three numbers of a packet's rays.
#[inline(always)]
pub(super) fn packet_of<L: Lanes<LANES>>(rows: &[Each; 3], p: usize) -> [L; 3] {
    [L::load(&rows[0][p]), L::load(&rows[1][p]), L::load(&rows[2][p])]
}

/// The lower or upper eight.
#[inline(always)]
pub(super) fn eight<T>(row: &[T; LANES], half: usize) -> &[T; 8] {
    let (eights, _) = row.as_chunks();
    &eights[half]
}

#[inline(always)]
pub(super) fn eight_mut<T>(row: &mut [T; LANES], half: usize) -> &mut [T; 8] {
    let (eights, _) = row.as_chunks_mut();
    &mut eights[half]
}
