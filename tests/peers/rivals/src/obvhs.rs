//! obvhs: a compressed tree of eight children (`cw`) or a binary one (`bvh2`), built as slowly and well as it can, or at medium speed.

use crate::{MISS, PeerHit, PeerRay, Rival};
use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris};
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use std::time::Duration;

enum Tree {
    Wide(CwBvh),
    Binary(Bvh2),
}

pub(crate) struct Obvhs {
    tree: Tree,
    /// In the order of the leaves, so that a leaf's triangles lie side by side.
    triangles: Vec<RtTriangle>,
    numbers: Vec<u32>,
}

impl Obvhs {
    /// `obvhs-cw-vslow`, `obvhs-cw-medium`, `obvhs-bvh2-vslow` or `obvhs-bvh2-medium`.
    pub(crate) fn new(variant: &str, vertices: &[[f32; 3]], indices: &[[u32; 3]]) -> Option<Self> {
        let (kind, speed) = variant.strip_prefix("obvhs-")?.split_once('-')?;
        let settings = match speed {
            "vslow" => BvhBuildParams::very_slow_build(),
            "medium" => BvhBuildParams::medium_build(),
            _ => return None,
        };
        let vertex = |k: u32| Vec3A::from(vertices[k as usize]);
        let triangles: Vec<Triangle> =
            indices.iter().map(|&[a, b, c]| Triangle { v0: vertex(a), v1: vertex(b), v2: vertex(c) }).collect();
        let mut time = Duration::default();
        let (tree, numbers) = match kind {
            "cw" => {
                let tree = build_cwbvh_from_tris(&triangles, settings, &mut time);
                let numbers = tree.primitive_indices.clone();
                (Tree::Wide(tree), numbers)
            }
            "bvh2" => {
                let tree = build_bvh2_from_tris(&triangles, settings, &mut time);
                let numbers = tree.primitive_indices.clone();
                (Tree::Binary(tree), numbers)
            }
            _ => return None,
        };
        let triangles = numbers.iter().map(|&k| RtTriangle::from(&triangles[k as usize])).collect();
        Some(Self { tree, triangles, numbers })
    }

    #[inline(always)]
    fn triangle(&self, k: usize) -> &RtTriangle {
        // SAFETY: there are as many triangles as numbers, and the tree asks for places in its own list of these. It is not to lose time to
        // a check that its users can do without.
        unsafe { self.triangles.get_unchecked(k) }
    }
}

#[inline(always)]
fn ray_of(ray: &PeerRay) -> Ray {
    Ray::new(Vec3A::from(ray.origin), Vec3A::from(ray.direction), ray.tmin, ray.tmax)
}

impl Rival for Obvhs {
    #[inline(always)]
    fn closest(&self, ray: &PeerRay) -> PeerHit {
        let (ray, mut hit) = (ray_of(ray), RayHit::none());
        let test = |ray: &Ray, k: usize| self.triangle(k).intersect(ray);
        match &self.tree {
            Tree::Wide(tree) => tree.ray_traverse(ray, &mut hit, test),
            Tree::Binary(tree) => tree.ray_traverse(ray, &mut hit, test),
        };
        let k = hit.primitive_id as usize;
        if hit.primitive_id == u32::MAX {
            return MISS;
        }
        let weights = self.triangle(k).compute_barycentric(&ray);
        PeerHit { t: hit.t, triangle: self.numbers[k], u: weights.x, v: weights.y }
    }

    #[inline(always)]
    fn any(&self, ray: &PeerRay) -> bool {
        let test = |ray: &Ray, k: usize| self.triangle(k).intersect(ray);
        !match &self.tree {
            Tree::Wide(tree) => tree.ray_traverse_miss(ray_of(ray), test),
            Tree::Binary(tree) => tree.ray_traverse_miss(ray_of(ray), test),
        }
    }

    fn bytes(&self) -> usize {
        let tree = match &self.tree {
            Tree::Wide(tree) => size_of_val(&tree.nodes[..]) + size_of_val(&tree.primitive_indices[..]),
            Tree::Binary(tree) => size_of_val(&tree.nodes[..]) + size_of_val(&tree.primitive_indices[..]),
        };
        tree + size_of_val(&self.triangles[..]) + size_of_val(&self.numbers[..])
    }
}
