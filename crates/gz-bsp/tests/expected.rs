//! What a line is expected to visit, where it can be worked out by hand, and what random lines visit.

mod common;

use common::{Lcg, buffer, soup};
use gz_bsp::{BspTree, CostStats, Expected, Midpoint, MidpointTree, TreeStats, VisitCount};
use gz_core::glam::DVec3;
use gz_core::{ClassMask, GzCoord, GzRay, TriBuffer};

/// Triangles whose box is the unit cube from `corner` on.
fn cube_filling(corner: GzCoord, n: usize) -> impl Iterator<Item = [GzCoord; 3]> {
    (0..n).map(move |_| [GzCoord::ZERO, GzCoord::new(1.0, 1.0, 0.0), GzCoord::new(0.0, 1.0, 1.0)].map(|p| corner + p))
}

/// Eight triangles at each end of a beam of 10 by 1 by 1, whose area is 42.
fn two_ends() -> TriBuffer {
    buffer(cube_filling(GzCoord::ZERO, 8).chain(cube_filling(GzCoord::X * 9.0, 8)))
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn two_far_clusters_are_two_leaves_of_their_own_areas() {
    let tris = two_ends();
    let tree = BspTree::build(&tris);
    let stats = CostStats::of(&tree);
    assert_eq!((stats.nodes, stats.cells, stats.leaves, stats.groups, stats.depth), (1, 2, 2, 2, 1));
    assert_eq!((stats.references, stats.smallest_leaf, stats.median_leaf, stats.largest_leaf), (16, 8, 8, 8));
    assert_eq!(stats.leaves_by_groups, [2, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!((stats.node_bytes, stats.bytes), (224, 224 + 2 * 320));
    // Each cube has area 6. A triangle has edges (1, 1, 0) and (0, 1, 1), whose cross product is sqrt 3 long.
    let expected = Expected::of(&tree).unwrap();
    assert!(close(expected.nodes, 1.0), "{expected:?}");
    assert!(close(expected.leaves, 12.0 / 42.0) && close(expected.groups, 12.0 / 42.0), "{expected:?}");
    assert!(close(expected.triangles, 8.0 * 12.0 / 42.0), "{expected:?}");
    assert!(close(expected.met, 16.0 * 3f64.sqrt() / 42.0), "{expected:?}");
}

#[test]
fn one_cut_of_the_papers_tree_is_worked_out_by_hand() {
    // The first cut is across z: cubes from z = 0 to 1 and 3 to 4, cut at 2. The box has area 18, either half of it 10.
    let tris = buffer(cube_filling(GzCoord::ZERO, 3).chain(cube_filling(GzCoord::Z * 3.0, 1)));
    let tree = MidpointTree::build(&tris, Midpoint { max_depth: 1, min_size: 1, ..Midpoint::default() }).unwrap();
    let stats = TreeStats::of(&tree);
    assert_eq!((stats.nodes, stats.leaves, stats.empty_leaves, stats.references), (3, 2, 0, 4));
    assert_eq!((stats.smallest_leaf, stats.median_leaf, stats.largest_leaf), (1, 1, 3));
    let expected = Expected::of_midpoint(&tree).unwrap();
    assert!(close(expected.nodes, 1.0) && close(expected.leaves, 20.0 / 18.0), "{expected:?}");
    assert!(close(expected.triangles, 4.0 * 10.0 / 18.0) && close(expected.groups, 0.0), "{expected:?}");
    assert!(close(expected.met, 4.0 * 3f64.sqrt() / 18.0), "{expected:?}");
}

#[test]
fn nothing_is_expected_where_there_is_no_area() {
    let point = buffer([[GzCoord::ONE; 3]]);
    let line = buffer([[GzCoord::ZERO, GzCoord::X, GzCoord::X * 2.0]]);
    for tris in [TriBuffer::new(), point, line] {
        assert_eq!(Expected::of(&BspTree::build(&tris)), None);
        assert_eq!(Expected::of_midpoint(&MidpointTree::build(&tris, Midpoint::default()).unwrap()), None);
    }
    let empty = CostStats::of(&BspTree::build(&TriBuffer::new()));
    assert_eq!((empty.nodes, empty.cells, empty.leaves, empty.smallest_leaf, empty.depth), (1, 0, 0, 0, 1));
}

#[test]
fn one_triangle_is_one_leaf_that_every_line_enters() {
    let tris = buffer(cube_filling(GzCoord::ZERO, 1));
    let expected = Expected::of(&BspTree::build(&tris)).unwrap();
    assert!(close(expected.nodes, 1.0) && close(expected.leaves, 1.0) && close(expected.groups, 1.0), "{expected:?}");
    assert!(close(expected.triangles, 1.0) && close(expected.met, 3f64.sqrt() / 6.0), "{expected:?}");
    // Flat across an axis: both sides of the box count, and every line that meets it meets half of it.
    let flat = buffer([[GzCoord::ZERO, GzCoord::X, GzCoord::Y]]);
    let expected = Expected::of(&BspTree::build(&flat)).unwrap();
    assert!(close(expected.leaves, 1.0) && close(expected.met, 0.5), "{expected:?}");
}

/// A line through a sphere around the unit cube, every one as likely as any other: directions uniform, and places on the disc across.
fn random_line(lcg: &mut Lcg) -> GzRay {
    let mut ball = || loop {
        let p = (lcg.point() * 2.0 - 1.0).as_dvec3();
        if (1e-4..1.0).contains(&p.length_squared()) {
            return p;
        }
    };
    let direction = ball().normalize();
    let place = loop {
        let p = ball();
        let across = p - direction * p.dot(direction);
        // The middle slice of the ball is equally thick everywhere but at its rim, so its shadow is a uniform disc.
        if p.dot(direction).abs() < 0.1 && across.length() < 0.99 {
            break across;
        }
    };
    let ray = GzRay::from_f64(DVec3::splat(0.5) + place * 0.9, direction.as_vec3());
    GzRay { tmin: f32::NEG_INFINITY, ..ray }
}

#[test]
fn random_lines_visit_what_is_expected() {
    let mut lcg = Lcg(11);
    let tris = buffer(soup(&mut lcg, 500, 0.1).positions().iter().map(|corners| corners.map(|p| p / 1.1)));
    let bounds = tris.bounds();
    assert!(bounds.min.min_element() >= 0.0 && bounds.max.max_element() <= 1.0);
    let cost = BspTree::build(&tris);
    let paper = MidpointTree::build(&tris, Midpoint { max_depth: 9, min_size: 4, ..Midpoint::default() }).unwrap();
    let (mut met, mut of_cost, mut of_paper) = (0u32, VisitCount::default(), VisitCount::default());
    while met < 20_000 {
        let ray = random_line(&mut lcg);
        let before = of_paper;
        // Of no class at all, so that nothing stops the line; its visits are counted all the same.
        paper.closest_hit_counted(&ray, ClassMask::NONE, &mut of_paper);
        // The paper's walk begins only if the line meets the scene's box.
        if of_paper != before {
            met += 1;
            cost.closest_hit_counted(&ray, ClassMask::NONE, &mut of_cost);
        }
    }
    let per_line = |n: u64| n as f64 / f64::from(met);
    let (cost, paper) = (Expected::of(&cost).unwrap(), Expected::of_midpoint(&paper).unwrap());
    for (what, expected, measured) in [
        ("nodes", cost.nodes, per_line(of_cost.nodes)),
        ("leaves", cost.leaves, per_line(of_cost.leaves)),
        ("groups", cost.groups, per_line(of_cost.groups)),
        ("the paper's nodes", paper.nodes, per_line(of_paper.nodes)),
        ("the paper's leaves", paper.leaves, per_line(of_paper.leaves)),
        ("the paper's tests", paper.triangles, per_line(of_paper.tests)),
    ] {
        println!("{what}: {expected:.4} expected, {measured:.4} measured, {met} lines");
        assert!((measured / expected - 1.0).abs() < 0.03, "{what}: {expected} expected, {measured} measured");
    }
    // The filter lets every triangle through that is met, once for each leaf that lists it, and few others.
    let tests = per_line(of_cost.tests);
    assert!(cost.met < tests * 1.03 && tests < 3.0 * cost.met, "{tests} tests, {} met", cost.met);
}
