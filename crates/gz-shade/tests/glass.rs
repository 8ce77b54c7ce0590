//! Glass: directions through slabs, nested media, energy.

mod common;

use common::*;
use gz_core::GzColor;
use gz_shade::*;

fn glass(ior: f32) -> Material {
    dark(MaterialKind::Glass { ior })
}

/// A white world with one material of glass.
fn white_world(ior: f32) -> Made {
    let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
    made.rules.depth = 12;
    made.material(glass(ior));
    made
}

#[test]
fn g7_rays_leave_a_slab_parallel_however_thin_it_is() {
    for thickness in [1.0, 1e-3, 1e-5] {
        let mut made = white_world(1.5);
        made.block([-4.0, -4.0, 0.0], [4.0, 4.0, thickness], false, 0);
        for (i, j) in [(8, 8), (0, 0), (15, 5), (2, 13)] {
            let nodes = made.explain(i, j);
            let out = heaviest_leaf(&nodes);
            assert!((out.ray.direction - nodes[0].ray.direction).length() < 1e-6, "{thickness}");
            assert_eq!((out.depth, out.hit.is_hit()), (2, false));
        }
        assert_eq!(made.shade().stats.unmatched_exits, 0);
    }
}

#[test]
fn g12_energy_is_kept_and_what_the_limits_cost_is_counted() {
    for depth in [1, 3, 12] {
        let mut made = white_world(1.5);
        made.camera = looking([2.0, 1.5, 4.0], [0.0; 3], 30.0);
        made.rules.depth = depth;
        made.block([-1.0; 3], [1.0; 3], false, 0);
        let frame = made.shade();
        // Glass neither makes nor takes light: what a pixel lacks of white is the weight of what was not followed.
        let lacking: f64 = frame.colors.iter().map(|color| 1.0 - f64::from(color.x)).sum();
        let stats = frame.stats;
        let counted = (stats.depth_cut_weight + stats.weak_weight) as f64 * FrameStats::WEIGHT_UNIT;
        assert!((lacking - counted).abs() < 1e-3, "depth {depth}: {lacking} {counted}");
        assert!(stats.depth_cuts > 0 && stats.absorbed == 0 && stats.nan_pixels == 0 && stats.unmatched_exits == 0);
    }
}

#[test]
fn g12_a_slab_before_a_mirror_needs_more_than_three_bounces() {
    let mut made = white_world(1.5);
    let mirror = made.material(dark(MaterialKind::Mirror { ior: None }));
    made.block([-4.0, -4.0, 0.0], [4.0, 4.0, 0.5], false, 0).wall(-1.0, 40.0, mirror);
    let at = |depth: u32| {
        let mut made = made.clone();
        made.rules.depth = depth;
        (made.middle().x, made.shade().stats.depth_cuts)
    };
    // In, out, mirror, in, out: five. With three only what the slab's two faces reflect at once comes back.
    assert!(at(3).0 < 0.09 && at(5).0 > 0.8 && at(16).0 > 0.99, "{:?} {:?} {:?}", at(3), at(5), at(16));
    assert!(at(3).1 > 0);
}

#[test]
fn g1_an_index_of_one_is_invisible() {
    let mut made = white_world(1.0);
    made.background = Background::Gradient { bottom: GzColor::ZERO, top: GzColor::new(0.3, 0.6, 0.9) };
    let without = made.shade().colors;
    made.block([-1.0; 3], [1.0; 3], false, 0);
    let frame = made.shade();
    assert_eq!(frame.colors, without);
    assert!(frame.stats.glass_rays > 0 && frame.stats.total_reflections == 0);
}

#[test]
fn g2_an_index_below_one_is_a_bubble_and_reflects_totally_from_outside() {
    let mut made = white_world(1.0 / 1.33);
    made.camera = looking([0.0, 1.0, 5.0], [0.0, 0.0, 0.0], 10.0);
    made.quad([[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [9.0, 0.0, 9.0], [-9.0, 0.0, 9.0]], [0.0, 1.0, 0.0], 0);
    // 79 degrees from the normal, beyond the critical 48.8.
    let frame = made.shade();
    assert_eq!(frame.stats.total_reflections, frame.stats.primary_hits);
    assert!(frame.stats.total_reflections > 0 && frame.colors.iter().all(|&color| color == GzColor::ONE));
}

#[test]
fn g9_water_in_glass_bends_as_glass_to_water_does() {
    let cavities = [
        0.75, // the glass reaches into the water
        0.8,  // their walls coincide, the water listed first
    ];
    for cavity in cavities {
        let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
        made.rules.depth = 8;
        let (water, bottle) = (made.material(glass(1.33)), made.material(glass(1.5)));
        made.block([-0.8; 3], [0.8; 3], false, water);
        made.block([-cavity; 3], [cavity; 3], true, bottle);
        made.block([-1.0; 3], [1.0; 3], false, bottle);
        for (i, j) in [(8, 8), (6, 7), (9, 6)] {
            let nodes = made.explain(i, j);
            let path: Vec<_> = nodes.iter().filter(|node| node.factor.x > 0.5).collect();
            // Sines from the z axis: the index times the sine stays what it was in air.
            let sine = |k: usize| path[k].ray.direction.truncate().length();
            assert!((1.5 * sine(1) - sine(0)).abs() < 1e-6, "in the wall");
            assert!((1.33 * sine(2) - sine(0)).abs() < 1e-6, "in the water, {cavity}");
            let out = heaviest_leaf(&nodes);
            assert!((out.ray.direction - nodes[0].ray.direction).length() < 1e-6, "{cavity}");
        }
        assert_eq!(made.shade().stats.unmatched_exits, 0, "{cavity}");
    }
}

#[test]
fn g10_a_camera_inside_glass_looks_out_of_it() {
    let mut made = white_world(1.5);
    made.camera = looking([0.1, 0.0, 0.2], [0.1, 0.0, -1.0], 100.0);
    made.block([-1.0; 3], [1.0; 3], false, 0);
    let nodes = made.explain(9, 9);
    let (inside, outside) = (nodes[0].ray.direction, heaviest_leaf(&nodes).ray.direction);
    let ratio = outside.truncate().length() / inside.truncate().length();
    assert!((ratio - 1.5).abs() < 1e-5, "{ratio}");
    let frame = made.shade();
    assert!(frame.stats.unmatched_exits > 100 && frame.stats.total_reflections > 0);
    // The corners of the picture look beyond the critical angle and see the walls only: nothing, after the depth limit.
    assert!(frame.colors[0].x < 1.0 && frame.stats.nan_pixels == 0);
}

#[test]
fn sides_come_from_the_triangle_not_from_the_shading_normal() {
    // A pane whose corner normals lean so far that interpolated normals face away from half of the rays.
    let mut made = white_world(1.5);
    made.materials[0].interpolate = Interpolate::Phong;
    made.block([-2.0, -2.0, 0.0], [2.0, 2.0, 0.5], false, 0);
    for tri in &mut made.tris {
        tri.normals = tri.normals.map(|n| (n + gz_core::GzCoord::new(3.0, 0.5, 0.0) * n.z.abs()).normalize());
    }
    let frame = made.shade();
    // Every ray that enters leaves again.
    assert_eq!(frame.stats.unmatched_exits, 0);
    assert!(frame.stats.below_surface > 0 && frame.stats.nan_pixels == 0);
    assert!(frame.colors.iter().all(|color| color.is_finite() && color.min_element() >= 0.0 && color.max_element() <= 1.0001));
}

#[test]
fn tint_counts_once_a_face() {
    let mut made = white_world(1.0);
    made.materials[0].tint = GzColor::new(0.5, 1.0, 0.0);
    made.block([-1.0; 3], [1.0; 3], false, 0);
    assert_eq!(made.middle(), GzColor::new(0.25, 1.0, 0.0));
}

#[test]
fn the_papers_glass_adds_what_it_shows_and_nothing_where_it_misses() {
    let mut made = Made { ambient: GzColor::ONE, background: Background::Plain(GzColor::ONE), ..Made::default() };
    made.rules = ShadeRules::PAPER;
    let pane = made.material(Material { ka: GzColor::splat(0.25), ..glass(1.5) });
    let seen = made.material(Material { ka: GzColor::splat(0.5), ..dark(MaterialKind::Phong) });
    made.wall(0.0, 1.0, pane);
    assert_eq!(made.middle(), GzColor::splat(0.25));
    made.wall(-1.0, 9.0, seen);
    assert_eq!(made.middle(), GzColor::splat(0.75));
}

#[test]
fn the_papers_glass_is_entered_along_its_normal() {
    let mut made = Made { rules: ShadeRules::PAPER, ..Made::default() };
    made.material(Material { interpolate: Interpolate::Phong, ..glass(1.5) });
    made.wall(0.0, 5.0, 0);
    let sines = |made: &Made| {
        let nodes = made.explain(3, 12);
        (nodes[1].ray.direction.truncate().length(), nodes[0].ray.direction.truncate().length())
    };
    let (refracted, incoming) = sines(&made);
    assert!((refracted - incoming * 1.5).abs() < 1e-6, "against the normal: out of the glass");
    made.tris.iter_mut().for_each(|tri| tri.normals = tri.normals.map(|n| -n));
    let (refracted, incoming) = sines(&made);
    assert!((refracted * 1.5 - incoming).abs() < 1e-6, "along it: into the glass");
}

#[test]
fn schlick_and_the_exact_equations_differ_a_little() {
    let mut made = white_world(1.5);
    made.background = Background::Gradient { bottom: GzColor::ZERO, top: GzColor::ONE };
    made.camera = looking([2.0, 1.5, 4.0], [0.0; 3], 30.0);
    made.block([-1.0; 3], [1.0; 3], false, 0);
    let exact = made.shade();
    made.rules.fresnel = Fresnel::Schlick;
    let schlick = made.shade();
    let differences = || exact.colors.iter().zip(&schlick.colors).map(|(a, b)| (*a - *b).abs().max_element());
    let worst = differences().fold(0.0, f32::max);
    assert!(worst > 1e-4 && worst < 0.1, "{worst}");
}
