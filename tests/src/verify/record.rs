//! What is counted over blocks of hard rays.

use crate::hard::classes::{Block, Class, TURNS};
use crate::hard::company::{Company, RUN};
use crate::judge::{Tally, buffer, truth_ray, truth_triangles};
use crate::truth::Truth;
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, ClassMask, GzRay, GzRay32, Hit, Kernel, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer};
use std::ops::Range;

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
    /// The tree is asked at every SIMD level; levels take turns in whether rays come as a batch or one by one, and in answering by brute
    /// force. Every seventh block asks the paper's tree too.
    pub fn of(class: Class, seed: u64, number: u64, stride: u64) -> Self {
        let block = class.block(seed, number);
        let tris = buffer(block.triangles.iter().copied());
        let mut record = Self { rays: block.rays.len() as u64, ..Self::default() };
        // Whatever the rays of a block have in common, it has every turn.
        let (levels, turn) = (SimdLevel::available(), (number / TURNS) as usize);
        let brute = BruteForce::new(&tris).with_simd(levels[turn % levels.len()]);
        let hits = together(&brute, &block);
        let mut differs = vec![false; block.rays.len()];
        let mut tree = BspTree::build(&tris);
        for (k, &level) in levels.iter().enumerate() {
            tree = tree.with_simd(level);
            let found = if (turn + k).is_multiple_of(2) { together(&tree, &block) } else { alone(&tree, &block) };
            compare(&tree, &block, &hits, &found, &mut differs);
        }
        record.differing = count(&differs);
        if number.is_multiple_of(7) {
            let setting = Midpoint { max_depth: 10, min_size: 3, node_budget: 1 << 14 };
            if let Ok(paper) = MidpointTree::build(&tris, setting) {
                differs.fill(false);
                compare(&paper, &block, &hits, &together(&paper, &block), &mut differs);
                (record.midpoint, record.midpoint_differing) = (record.rays, count(&differs));
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
    each_batch(block, |place, batch| query.closest_hits(batch, ClassMask::ALL, &mut hits[place]));
    hits
}

fn alone(query: &dyn RayQuery, block: &Block) -> Vec<Hit> {
    block.rays.iter().map(|ray| query.closest_hit(ray)).collect()
}

/// Marks the rays whose front-most hit or whose occlusion differs from `expected`.
fn compare(query: &dyn RayQuery, block: &Block, expected: &[Hit], found: &[Hit], differs: &mut [bool]) {
    let mut occluded = vec![false; block.rays.len()];
    each_batch(block, |place, batch| query.any_hits(batch, ClassMask::ALL, &mut occluded[place]));
    let bits = |hit: &Hit| [hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits()];
    for (k, differs) in differs.iter_mut().enumerate() {
        *differs |= bits(&expected[k]) != bits(&found[k]) || occluded[k] != expected[k].is_hit();
    }
}

fn count(marked: &[bool]) -> u64 {
    marked.iter().filter(|marked| **marked).count() as u64
}

/// The rays of a block as the batches that they are asked in, and the place of each: by halves, or run by run. Every other batch whose origins
/// are f32 is asked as it lies in memory; of the rest it is said once what their rays share.
fn each_batch(block: &Block, mut ask: impl FnMut(Range<usize>, &RayBatch<'_>)) {
    let at_a_time = if block.company == Company::None { block.rays.len().div_ceil(2).max(1) } else { RUN };
    for (number, rays) in block.rays.chunks(at_a_time).enumerate() {
        let from = number * at_a_time;
        if number % 2 == 1
            && let Some(rays) = in_f32(rays)
        {
            ask(from..from + rays.len(), &RayBatch::of_rays(&rays));
            continue;
        }
        let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
        let (tmin, tmax): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
        let batch = RayBatch::new(
            rays.len(),
            shared(&origins, |p| p.to_array().map(f64::to_bits)),
            shared(&directions, |d| d.to_array().map(f32::to_bits)),
            shared(&tmin, |t| t.to_bits()),
            shared(&tmax, |t| t.to_bits()),
        );
        ask(from..from + rays.len(), &batch);
    }
}

/// The rays with origins of f32, if they have such.
fn in_f32(rays: &[GzRay]) -> Option<Vec<GzRay32>> {
    let narrow = |&GzRay { origin, direction, tmin, tmax }: &GzRay| {
        let ray = GzRay32 { origin: origin.as_vec3(), tmin, direction, tmax };
        (GzRay::from(ray).origin.to_array().map(f64::to_bits) == origin.to_array().map(f64::to_bits)).then_some(ray)
    };
    rays.iter().map(narrow).collect()
}

/// One value where all are equal to the bit.
fn shared<T: Copy, B: PartialEq>(values: &[T], bits: impl Fn(&T) -> B) -> PerRay<'_, T> {
    match values.first() {
        Some(first) if values.iter().all(|value| bits(value) == bits(first)) => PerRay::One(*first),
        _ => PerRay::Each(values),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::Given;

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
        // A query that knows one triangle less: every number is another one.
        for number in 0..TURNS {
            let block = Class::Random.block(1, number);
            let (whole, part) = (buffer(block.triangles.iter().copied()), buffer(block.triangles[1..].iter().copied()));
            let (brute, poor) = (BruteForce::new(&whole), BruteForce::new(&part));
            let hits = together(&brute, &block);
            let differing = |query: &dyn RayQuery, found: &[Hit]| {
                let mut differs = vec![false; block.rays.len()];
                compare(query, &block, &hits, found, &mut differs);
                count(&differs)
            };
            assert_eq!(differing(&brute, &together(&brute, &block)), 0);
            let hit = hits.iter().filter(|hit| hit.is_hit()).count() as u64;
            assert!(hit > 100 && differing(&poor, &together(&poor, &block)) == hit);
            // And one that answers right but for whether anything is hit.
            let less = differing(&BruteForce::new(&buffer([])), &hits);
            assert_eq!(less, hit);
        }
    }

    #[test]
    fn batches_say_once_what_their_rays_share() {
        let mut common = [0; 4];
        for number in 0..8 {
            for class in [Class::Edges, Class::Needles] {
                let block = class.block(5, number);
                each_batch(&block, |place, batch| {
                    common[0] += 1;
                    match batch.given() {
                        Given::Properties { origin, direction, .. } => {
                            common[1] += usize::from(matches!(origin, PerRay::One(_)));
                            common[2] += usize::from(matches!(direction, PerRay::One(_)));
                        }
                        Given::Rays(_) => common[3] += 1,
                    }
                    for (k, ray) in place.zip(0..) {
                        assert_eq!(block.rays[k], batch.ray(ray));
                    }
                });
            }
        }
        // Two blocks of each class as they come, in halves; of the others 16 runs each, a third of them from one point, a third in one
        // direction. Of every other batch those from points of f32 are not told what they share.
        assert_eq!(common, [8 + 12 * 16, 40, 64, 24]);
    }
}
