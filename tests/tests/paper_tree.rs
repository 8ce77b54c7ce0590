//! The paper's tree (its sections 3 and 4): the known sizes and counts of its own scene, its rule counted by another implementation,
//! and its failures, which must show when they are put back.

#[path = "paper_tree/naive.rs"]
mod naive;
#[path = "paper_tree/twins.rs"]
mod twins;

use gz_bsp::{Midpoint, TreeStats};
use gz_core::{Bounds, GzTri, TriBuffer};
use gz_tests::bench::counted::brute_tests;
use gz_tests::bench::paper::structure;
use gz_tests::bench::rays::RaySet;
use gz_tests::bench::scenes::{PAPER, bench_scene, has_course_data, teapot, uneven};

/// MAX_DEPTH, MIN_SIZE; nodes, leaves, empty leaves, references, largest leaf; triangle tests per ray. Measured by an independent
/// program on the paper's scene.
type Known = ((u32, usize), [usize; 5], f64);
const KNOWN: [Known; 11] = [
    ((5, 10), [53, 27, 11, 1207, 340], 151.55),
    ((8, 10), [135, 68, 33, 1545, 222], 72.24),
    ((10, 10), [251, 126, 53, 2078, 159], 43.13),
    ((12, 10), [531, 266, 93, 2783, 123], 20.90),
    ((15, 10), [1473, 737, 170, 5513, 75], 16.13),
    ((20, 10), [4693, 2347, 234, 16910, 32], 15.82),
    ((15, 3), [2597, 1299, 463, 6245, 75], 10.08),
    ((15, 5), [2269, 1135, 347, 6151, 75], 11.19),
    ((15, 15), [953, 477, 97, 4599, 75], 21.30),
    ((15, 20), [723, 362, 74, 4092, 75], 29.53),
    ((15, 30), [391, 196, 43, 3038, 75], 41.04),
];

fn buffer(triangles: impl IntoIterator<Item = [gz_core::GzCoord; 3]>) -> TriBuffer {
    let mut tris = TriBuffer::new();
    for positions in triangles {
        tris.push(&GzTri { positions, ..GzTri::default() }).expect("finite corners");
    }
    tris
}

/// The paper's scene, or what stands in for it without the course's data: our own teapot is the course's to the digits of its files.
fn paper_scene() -> (TriBuffer, RaySet) {
    let scene = bench_scene(PAPER).expect("the scene is there");
    (scene.tris, scene.rays)
}

#[test]
fn the_papers_scene_has_the_known_box_and_rays() {
    let (tris, rays) = paper_scene();
    assert_eq!(tris.len(), 897);
    let Bounds { min, max } = tris.bounds();
    let known = [[-20.2534, -24.1736, 17.9977], [20.3259, 32.3515, 40.0]];
    let off = |found: gz_core::GzCoord, known: [f32; 3]| (found - gz_core::GzCoord::from_array(known)).abs().max_element();
    assert!(off(min, known[0]) < 1e-4 && off(max, known[1]) < 1e-4, "{min} {max}");
    // 65536 primary, 3 x 35620 shadow, 23647 mirror rays.
    let leaving = rays.rays().filter(|(_, leaves)| leaves.is_some()).count();
    assert_eq!((rays.len(), leaving), (196_043, 196_043 - 65_536));
    assert!((brute_tests(tris.len(), &rays) - 896.33).abs() < 0.01);
}

#[test]
fn the_tree_of_the_papers_scene_has_the_known_sizes_and_tests_per_ray() {
    if !has_course_data() {
        println!("GZ_HW_DATA names no course data: checked on the stand-in, our own teapot, instead of the paper's scene");
    }
    let (tris, rays) = paper_scene();
    for ((max_depth, min_size), sizes, tests) in KNOWN {
        let (stats, found) =
            structure(&tris, &rays, Midpoint { max_depth, min_size, ..Midpoint::default() }).expect("within budget");
        let TreeStats { nodes, leaves, empty_leaves, references, largest_leaf, .. } = stats;
        println!("({max_depth}, {min_size}): {found:.2} tests a ray, {tests} known");
        assert_eq!([nodes, leaves, empty_leaves, references, largest_leaf], sizes, "({max_depth}, {min_size})");
        assert!((found / tests - 1.0).abs() < 0.01, "({max_depth}, {min_size}): {found} tests a ray, {tests} known");
    }
}

#[test]
fn another_implementation_of_the_rule_counts_the_same() {
    let scenes = [("teapot", buffer(teapot(8))), ("uneven", buffer(uneven())), ("the paper's", paper_scene().0)];
    for (name, tris) in &scenes {
        for (max_depth, min_size) in [(1, 0), (3, 0), (5, 10), (8, 3), (10, 1), (12, 30), (15, 5), (17, 100)] {
            let counts = naive::count(tris.positions(), max_depth, min_size);
            let tree = gz_bsp::MidpointTree::build(tris, Midpoint { max_depth, min_size, ..Midpoint::default() });
            let TreeStats { nodes, leaves, empty_leaves, references, largest_leaf, .. } =
                TreeStats::of(&tree.expect("within budget"));
            let found = naive::Counts { nodes, leaves, empty_leaves, references, largest_leaf };
            assert_eq!(found, counts, "{name} ({max_depth}, {min_size})");
        }
    }
}
