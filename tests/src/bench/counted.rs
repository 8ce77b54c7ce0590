//! What a walk visits, per ray.

use super::rays::{Answer, RaySet, room};
use gz_bsp::{BspTree, MidpointTree, VisitCount};
use gz_core::{ClassMask, GzRay, Hit};

/// A tree whose walk tells what it visits.
pub trait Counted {
    /// Finds the front-most hit and counts the walk.
    fn count_closest(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit;
    /// Finds whether anything is hit and counts the walk.
    fn count_any(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> bool;
}

impl Counted for MidpointTree<'_> {
    fn count_closest(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit {
        self.closest_hit_counted(ray, classes, visits)
    }

    fn count_any(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> bool {
        self.any_hit_counted(ray, classes, visits)
    }
}

impl Counted for BspTree<'_> {
    fn count_closest(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit {
        self.closest_hit_counted(ray, classes, visits)
    }

    fn count_any(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> bool {
        self.any_hit_counted(ray, classes, visits)
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
    visits_and_answers(tree, rays).0
}

/// The same with the answers: one walk for both.
pub fn visits_and_answers(tree: &impl Counted, rays: &RaySet) -> (PerRayVisits, Vec<Answer>) {
    let (mut all, mut answers) = (VisitCount::default(), room(rays));
    for (asked, answer) in rays.batches.iter().zip(&mut answers) {
        let batch = asked.batch();
        for i in 0..batch.len() {
            all.excluded = asked.leaves(i);
            match answer {
                Answer::Hits(hits) => hits[i] = tree.count_closest(&batch.ray(i), asked.classes, &mut all),
                Answer::Blocked(blocked) => blocked[i] = tree.count_any(&batch.ray(i), asked.classes, &mut all),
            }
        }
    }
    let share = |n: u64| n as f64 / rays.len().max(1) as f64;
    let visits =
        PerRayVisits { nodes: share(all.nodes), leaves: share(all.leaves), groups: share(all.groups), tests: share(all.tests) };
    (visits, answers)
}

/// Triangle tests of brute force for an average ray: every triangle but the one that the ray is known to leave.
pub fn brute_tests(triangles: usize, rays: &RaySet) -> f64 {
    let leaving = rays.rays().filter(|(_, leaves)| leaves.is_some()).count();
    triangles as f64 - leaving as f64 / rays.len().max(1) as f64
}
