//! What a walk visits, per ray.

use super::rays::RaySet;
use gz_bsp::{BspTree, MidpointTree, VisitCount};
use gz_core::{ClassMask, GzRay};

/// A tree whose walk tells what it visits.
pub trait Counted {
    /// Counts the walk of the front-most hit.
    fn count_closest(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount);
    /// Counts the walk of any hit.
    fn count_any(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount);
}

impl Counted for MidpointTree<'_> {
    fn count_closest(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) {
        self.closest_hit_counted(ray, classes, visits);
    }

    fn count_any(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) {
        self.any_hit_counted(ray, classes, visits);
    }
}

impl Counted for BspTree<'_> {
    fn count_closest(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) {
        self.closest_hit_counted(ray, classes, visits);
    }

    fn count_any(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) {
        self.any_hit_counted(ray, classes, visits);
    }
}

/// Visits of an average ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerRayVisits {
    /// Inner nodes.
    pub nodes: f64,
    /// Leaves.
    pub leaves: f64,
    /// Groups of eight triangles filtered.
    pub groups: f64,
    /// Triangles tested in f64, without those that a ray is known to leave.
    pub tests: f64,
}

/// The visits of `tree` over all of `rays`, each by itself.
pub fn visits(tree: &impl Counted, rays: &RaySet) -> PerRayVisits {
    let mut all = VisitCount::default();
    for asked in &rays.batches {
        let batch = asked.batch();
        for i in 0..batch.len() {
            all.excluded = asked.leaves(i);
            match asked.any {
                true => tree.count_any(&batch.ray(i), asked.classes, &mut all),
                false => tree.count_closest(&batch.ray(i), asked.classes, &mut all),
            }
        }
    }
    let share = |n: u64| n as f64 / rays.len().max(1) as f64;
    PerRayVisits { nodes: share(all.nodes), leaves: share(all.leaves), groups: share(all.groups), tests: share(all.tests) }
}

/// Triangle tests of brute force for an average ray: every triangle but the one that the ray is known to leave.
pub fn brute_tests(triangles: usize, rays: &RaySet) -> f64 {
    let leaving = rays.rays().filter(|(_, leaves)| leaves.is_some()).count();
    triangles as f64 - leaving as f64 / rays.len().max(1) as f64
}
