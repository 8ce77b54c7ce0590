//! A walk told step by step is the walk that is counted.

mod common;

use common::*;
use gz_bsp::{BspTree, Midpoint, MidpointTree, Step, VisitCount};
use gz_core::{BruteForce, ClassMask, GzRay, RayQuery, TriBuffer};

fn leaves(steps: &[Step]) -> usize {
    steps.iter().filter(|step| step.triangles.is_some()).count()
}

/// Each step lies on the ray.
fn assert_on_the_way(steps: &[Step], ray: &GzRay) {
    for step in steps {
        assert!(step.enter <= step.leave, "{step:?} of {ray:?}");
        if step.enter > f64::from(ray.tmin) {
            let at = ray.origin + ray.direction.as_dvec3() * step.enter;
            let (lo, hi) = (step.bounds.min.as_dvec3(), step.bounds.max.as_dvec3());
            let off = (lo - at).max(at - hi).max_element();
            assert!(off < 1e-5 * (1.0 + at.abs().max_element()), "{step:?} is entered {off} beside its box");
        }
    }
}

fn scenes() -> [(&'static str, TriBuffer); 3] {
    let mut lcg = Lcg(7);
    [("soup", soup(&mut lcg, 600, 0.1)), ("grid", grid(&mut lcg, 12)), ("slivers", slivers(&mut lcg, 200))]
}

#[test]
fn the_papers_walk_is_told_as_it_is_counted() {
    for (name, tris) in scenes() {
        let tree = MidpointTree::build(&tris, Midpoint::default()).unwrap();
        for ray in rays(&mut Lcg(8), &tris, 300) {
            let (hit, steps) = tree.steps(&ray, ClassMask::ALL);
            let mut visits = VisitCount::default();
            assert_eq!(hit, tree.closest_hit_counted(&ray, ClassMask::ALL, &mut visits), "{name}: {ray:?}");
            let tests: usize = steps.iter().filter_map(|step| step.triangles.as_ref()).map(Vec::len).sum();
            let told = (steps.len() - leaves(&steps), leaves(&steps), tests);
            assert_eq!(told, (visits.nodes as usize, visits.leaves as usize, visits.tests as usize), "{name}: {ray:?}");
            assert_on_the_way(&steps, &ray);
            // Voxels do not overlap, so that none is entered beyond the hit.
            assert!(steps.iter().all(|step| step.enter <= f64::from(hit.t.next_up())), "{name}: {ray:?}");
        }
    }
}

#[test]
fn the_default_trees_walk_is_told_but_for_cells_that_the_ray_just_misses() {
    for (name, tris) in scenes() {
        let (tree, brute) = (BspTree::build(&tris), BruteForce::new(&tris));
        let (mut told, mut counted) = (0, 0);
        for ray in rays(&mut Lcg(8), &tris, 300) {
            let (hit, steps) = tree.steps(&ray, ClassMask::ALL);
            assert_eq!(hit, brute.closest_hit(&ray), "{name}: {ray:?}");
            let mut visits = VisitCount::default();
            tree.closest_hit_counted(&ray, ClassMask::ALL, &mut visits);
            told += steps.len() as u64;
            counted += visits.nodes + visits.leaves;
            assert_on_the_way(&steps, &ray);
            // What is hit stands in a list that was looked at. Cells may overlap: one beyond the hit may be entered before that list, not after.
            let found = steps.iter().position(|step| step.triangles.as_ref().is_some_and(|list| list.contains(&hit.tri)));
            assert_eq!(found.is_some(), hit.is_hit(), "{name}: {ray:?}");
            let after = found.map_or(&[][..], |found| &steps[found + 1..]);
            assert!(after.iter().all(|step| step.enter <= f64::from(hit.t.next_up())), "{name}: {ray:?}");
        }
        assert!(told.abs_diff(counted) <= counted / 20, "{name}: {told} told, {counted} counted");
    }
}

#[test]
fn triangles_of_other_classes_end_no_walk() {
    let tris = soup(&mut Lcg(7), 100, 0.3);
    let tree = BspTree::build(&tris);
    for ray in rays(&mut Lcg(9), &tris, 60) {
        let (hit, through) = tree.steps(&ray, ClassMask::NONE);
        assert!(!hit.is_hit() && through.len() >= tree.steps(&ray, ClassMask::ALL).1.len());
    }
    let nowhere = GzRay::new(gz_core::GzCoord::ZERO, gz_core::GzCoord::ZERO);
    assert!(tree.steps(&nowhere, ClassMask::ALL).1.is_empty());
}
