//! What is counted over blocks of hard rays.

use crate::hard::classes::{Block, Class};
use crate::judge::{Tally, buffer, truth_ray, truth_triangles};
use crate::truth::Truth;
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, ClassMask, Hit, Kernel, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer};

/// The tests that are there for comparison.
pub const KERNELS: [Kernel; 7] = [
    Kernel::Plane,
    Kernel::MoellerTrumbore,
    Kernel::BaldwinWeber,
    Kernel::Pluecker,
    Kernel::Woop,
    Kernel::WoopFused,
    Kernel::MoellerTrumboreF64,
];

/// Counts over the rays of a class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Record {
    /// Rays asked of brute force and of the tree.
    pub rays: u64,
    /// Of these, rays whose answers differ in a bit, or in whether anything is hit.
    pub differing: u64,
    /// Rays asked of the paper's tree too.
    pub midpoint: u64,
    /// Of these, rays whose answers differ.
    pub midpoint_differing: u64,
    /// Brute force judged by the truth.
    pub product: Tally,
    /// The comparison kernels, in the order of [`KERNELS`], judged by the truth.
    pub kernels: [Tally; KERNELS.len()],
}

impl std::ops::AddAssign for Record {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.differing += other.differing;
        self.midpoint += other.midpoint;
        self.midpoint_differing += other.midpoint_differing;
        self.product += other.product;
        for (sum, other) in self.kernels.iter_mut().zip(other.kernels) {
            *sum += other;
        }
    }
}

impl Record {
    /// Whether everything is as it should be.
    pub fn is_clean(&self) -> bool {
        self.differing == 0 && self.midpoint_differing == 0 && self.product.is_clean()
    }

    /// Block `number` of a class; every `stride`-th ray is judged by the truth.
    ///
    /// Blocks take turns in SIMD level and in whether rays come as a batch or one by one; every eighth asks the paper's tree too.
    pub fn of(class: Class, seed: u64, number: u64, stride: u64) -> Self {
        let block = class.block(seed, number);
        let tris = buffer(block.triangles.iter().copied());
        let mut record = Self { rays: block.rays.len() as u64, ..Self::default() };
        let brute = BruteForce::new(&tris);
        let hits = together(&brute, &block);
        let levels = SimdLevel::available();
        let tree = BspTree::build(&tris).with_simd(levels[number as usize % levels.len()]);
        let alone = |query: &dyn RayQuery| block.rays.iter().map(|ray| query.closest_hit(ray)).collect::<Vec<_>>();
        let found = if number.is_multiple_of(2) { together(&tree, &block) } else { alone(&tree) };
        record.differing = differing(&tree, &block, &hits, &found);
        if number.is_multiple_of(8) {
            let setting = Midpoint { max_depth: 10, min_size: 3, node_budget: 1 << 14 };
            if let Ok(paper) = MidpointTree::build(&tris, setting) {
                record.midpoint = record.rays;
                record.midpoint_differing = differing(&paper, &block, &hits, &together(&paper, &block));
            }
        }
        record.judge(&block, &tris, &hits, number, stride);
        record
    }

    fn judge(&mut self, block: &Block, tris: &TriBuffer, hits: &[Hit], number: u64, stride: u64) {
        // Numbers of rays over all blocks, so that every place in a block has its turn.
        let first = (number * block.rays.len() as u64).next_multiple_of(stride) - number * block.rays.len() as u64;
        let judged = || (first as usize..block.rays.len()).step_by(stride as usize);
        if judged().next().is_none() {
            return;
        }
        let truth = Truth::new(&truth_triangles(tris));
        let plain = KERNELS.map(|kernel| BruteForce::with_kernel(tris, kernel));
        for i in judged() {
            let ray = &block.rays[i];
            let expected = truth.closest(&truth_ray(ray));
            self.product.add(&hits[i], expected);
            for (tally, plain) in self.kernels.iter_mut().zip(&plain) {
                tally.add(&plain.closest_hit(ray), expected);
            }
        }
    }
}

fn together(query: &dyn RayQuery, block: &Block) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; block.rays.len()];
    with_batch(block, |batch| query.closest_hits(batch, ClassMask::ALL, &mut hits));
    hits
}

/// Rays whose front-most hit or whose occlusion differs from `expected`.
fn differing(query: &dyn RayQuery, block: &Block, expected: &[Hit], found: &[Hit]) -> u64 {
    let mut occluded = vec![false; block.rays.len()];
    with_batch(block, |batch| query.any_hits(batch, ClassMask::ALL, &mut occluded));
    let bits = |hit: &Hit| [hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits()];
    let differs = |((a, b), any): &((&Hit, &Hit), &bool)| bits(a) != bits(b) || **any != a.is_hit();
    expected.iter().zip(found).zip(&occluded).filter(differs).count() as u64
}

fn with_batch(block: &Block, ask: impl FnOnce(&RayBatch<'_>)) {
    let (origins, directions): (Vec<_>, Vec<_>) = block.rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
    let (tmin, tmax): (Vec<_>, Vec<_>) = block.rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
    let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
    ask(&RayBatch::new(block.rays.len(), origin, direction, PerRay::Each(&tmin), PerRay::Each(&tmax)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ray_is_compared_and_every_strideth_judged() {
        let mut all = Record::default();
        for number in 0..4 {
            all += Record::of(Class::Edges, 3, number, 100);
        }
        assert_eq!((all.rays, all.product.rays, all.midpoint), (4096, 41, 1024));
        assert!(all.is_clean() && all.kernels.iter().all(|tally| tally.rays == 41), "{all:?}");
        assert!(!all.kernels[0].is_clean(), "the plane test is not right at 41 edges");
    }

    #[test]
    fn what_differs_is_counted() {
        // A query that knows one triangle less.
        let block = Class::Random.block(1, 1);
        let (whole, part) = (buffer(block.triangles.iter().copied()), buffer(block.triangles[1..].iter().copied()));
        let (brute, poor) = (BruteForce::new(&whole), BruteForce::new(&part));
        let hits = together(&brute, &block);
        assert_eq!(differing(&brute, &block, &hits, &together(&brute, &block)), 0);
        // Every number is another one.
        let hit = hits.iter().filter(|hit| hit.is_hit()).count() as u64;
        assert!(hit > 100 && differing(&poor, &block, &hits, &together(&poor, &block)) == hit);
    }
}
