//! The trees that are there to be compared with: right where they claim to be, wrong where they are made to be.

use gz_bsp::{Midpoint, MidpointTree, TreeStats, VisitCount};
use gz_core::{BruteForce, ClassMask, GzRay, GzTri, Kernel, RayQuery, TriBuffer};
use gz_tests::bench::rays::RaySet;
use gz_tests::bench::scenes::{PAPER, bench_scene, teapot};
use gz_tests::hard::classes::Class;
use gz_tests::hard::dice::Dice;
use gz_tests::hard::meshes::{integer_field, soup};
use gz_tests::plain_trees::{Disagreement, Ending, Insert, PlainMidpoint, PlainRules, PolygonBsp, PolygonRules};

fn buffer(triangles: impl IntoIterator<Item = [gz_core::GzCoord; 3]>) -> TriBuffer {
    let mut tris = TriBuffer::new();
    for positions in triangles {
        tris.push(&GzTri { positions, ..GzTri::default() }).expect("finite corners");
    }
    tris
}

/// Triangles, and rays of all kinds at them.
fn scenes() -> Vec<(&'static str, TriBuffer, Vec<GzRay>)> {
    let random = |tris: &TriBuffer| RaySet::random(&tris.bounds(), 1000).rays().map(|(ray, _)| ray).collect::<Vec<_>>();
    let paper = bench_scene(PAPER).expect("the scene is there");
    let of_paper = paper.rays.sample(2000).rays().map(|(ray, _)| ray).collect();
    let mut scenes = vec![("the paper's", paper.tris, of_paper)];
    let mut dice = Dice::new(5);
    let made = [("teapot", teapot(4)), ("soup", soup(&mut dice, 500, 0.4)), ("integer field", integer_field(&mut dice, 12))];
    for (name, triangles) in made {
        let tris = buffer(triangles);
        let mut rays = random(&tris);
        rays.extend(along_the_axes(&tris));
        scenes.push((name, tris, rays));
    }
    scenes
}

/// Rays along each axis, both ways, from corner to corner: in planes that trees cut by.
fn along_the_axes(tris: &TriBuffer) -> Vec<GzRay> {
    let mut rays = Vec::new();
    for corners in tris.positions().iter().step_by(tris.len().div_ceil(200)) {
        for axis in 0..3 {
            let mut direction = gz_core::GzCoord::ZERO;
            direction[axis] = if corners[1][axis] > corners[0][axis] { 1.0 } else { -1.0 };
            let origin = (corners[0] + corners[1]) * 0.5 - direction * 100.0;
            rays.push(GzRay::new(origin, direction));
        }
    }
    rays
}

#[test]
fn a_tree_of_polygon_planes_answers_as_brute_force_to_the_bit() {
    for (name, tris, rays) in scenes() {
        let brute = BruteForce::new(&tris);
        for (max_depth, min_size, tried) in [(30, 5, 8), (12, 1, 1), (400, 1, 3), (0, 1, 1)] {
            let tree = PolygonBsp::build(&tris, PolygonRules { max_depth, min_size, tried, ..PolygonRules::default() });
            for ray in &rays {
                assert_eq!(tree.closest_hit(ray), brute.closest_hit(ray), "{name} ({max_depth}, {min_size}, {tried}): {ray:?}");
            }
        }
    }
}

#[test]
fn hard_rays_do_not_fool_the_tree_of_polygon_planes() {
    let mut hits = 0;
    for class in Class::ALL {
        for number in 0..3 {
            let block = class.block(11, number);
            let tris = buffer(block.triangles.iter().copied());
            let (brute, tree) = (BruteForce::new(&tris), PolygonBsp::build(&tris, PolygonRules::default()));
            for ray in block.rays.iter().take(400) {
                let right = brute.closest_hit(ray);
                assert_eq!(tree.closest_hit(ray), right, "{} {number}: {ray:?}", class.name());
                hits += u32::from(right.is_hit());
            }
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn polygon_planes_keep_every_triangle_that_can_be_hit() {
    let tris = buffer(teapot(4));
    // Some of the teapot's have no area: patches that end in a point.
    let has_area =
        |[a, b, c]: &&[gz_core::GzCoord; 3]| (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3()).length() > 0.0;
    let can_be_hit = tris.positions().iter().filter(has_area).count();
    assert!(can_be_hit < tris.len());
    let shape = PolygonBsp::build(&tris, PolygonRules::default()).shape();
    assert!(shape.stats.references >= can_be_hit && shape.stats.depth <= 31, "{shape:?}");
    assert!(shape.balance > 0.0 && shape.balance <= 0.5 && shape.mean_level >= shape.even_level() - 1e-9, "{shape:?}");
    let whole = PolygonBsp::build(&tris, PolygonRules { max_depth: 0, ..PolygonRules::default() }).shape();
    assert_eq!((whole.stats.nodes, whole.stats.references, whole.stats.depth), (1, can_be_hit, 1));
}

#[test]
fn the_plain_tree_is_the_papers_tree() {
    for (name, tris, rays) in scenes() {
        let brute = BruteForce::new(&tris);
        for (max_depth, min_size) in [(15, 5), (8, 10), (17, 1)] {
            let plain = PlainMidpoint::build(&tris, PlainRules { max_depth, min_size, ..PlainRules::default() });
            let tree =
                MidpointTree::build(&tris, Midpoint { max_depth, min_size, ..Midpoint::default() }).expect("within budget");
            let sizes = TreeStats::of(&tree);
            assert_eq!(TreeStats { bytes: sizes.bytes, ..plain.shape().stats }, sizes, "{name} ({max_depth}, {min_size})");
            let (mut ours, mut theirs) = (VisitCount::default(), VisitCount::default());
            for ray in &rays {
                let hit = plain.closest_hit_counted(ray, ClassMask::ALL, &mut ours);
                assert_eq!(hit, brute.closest_hit(ray), "{name} ({max_depth}, {min_size}): {ray:?}");
                tree.closest_hit_counted(ray, ClassMask::ALL, &mut theirs);
            }
            // It goes into nodes that begin beyond the hit and looks at no list there; all else is the same walk.
            assert!(
                ours.nodes >= theirs.nodes && ours.tests.abs_diff(theirs.tests) <= theirs.tests / 1000,
                "{ours:?} {theirs:?}"
            );
        }
    }
}

#[test]
fn each_way_to_end_a_walk_too_early_goes_wrong_and_padding_does_not() {
    // Ties, edges, and rays in the planes that the tree cuts by.
    let blocks: Vec<_> =
        [Class::Edges, Class::Axis, Class::InPlane, Class::Grids].iter().flat_map(|c| (0..2).map(|k| c.block(11, k))).collect();
    let blocks: Vec<(TriBuffer, Vec<GzRay>)> = blocks.into_iter().map(|block| (buffer(block.triangles), block.rays)).collect();
    let wrong = |kernel, insert, ending| {
        let mut all = Disagreement::default();
        for (tris, rays) in &blocks {
            let tree = PlainMidpoint::build(tris, PlainRules { insert, ending, kernel, ..PlainRules::default() });
            all += Disagreement::count(&tree, &BruteForce::with_kernel(tris, kernel), rays);
        }
        println!("{kernel:?} {insert:?} {ending:?}: {all:?}");
        assert_eq!(all.rays, 8 * 1024);
        all.wrong()
    };
    for kernel in [Kernel::Certified, Kernel::Plane, Kernel::MoellerTrumbore, Kernel::Woop] {
        for ending in [Ending::FirstInLeaf, Ending::BeforeExit, Ending::PointInVoxel] {
            assert!(wrong(kernel, Insert::BoxTouches, ending) > 0, "{kernel:?} {ending:?}");
        }
    }
    assert_eq!(wrong(Kernel::Certified, Insert::BoxTouches, Ending::Padded), 0);
    assert!(wrong(Kernel::Certified, Insert::CornerInside, Ending::Padded) > 0);
}
