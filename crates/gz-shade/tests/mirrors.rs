//! Mirrors: directions, energy, the depth limit, and what missed rays show.

mod common;

use common::*;
use gz_core::GzColor;
use gz_shade::*;

const IDEAL: MaterialKind = MaterialKind::Mirror { ior: None };

/// Up to three walls at right angles, seen into their corner.
fn corner(walls: usize) -> Made {
    let mut made =
        Made { background: Background::Plain(GzColor::ONE), camera: looking([3.0, 2.5, 2.0], [0.3; 3], 20.0), ..Made::default() };
    made.rules.depth = 16;
    let mirror = made.material(dark(IDEAL));
    let w = 50.0;
    made.quad([[0.0, 0.0, -w], [w, 0.0, -w], [w, 0.0, w], [0.0, 0.0, w]], [0.0, 1.0, 0.0], mirror);
    made.quad([[0.0, 0.0, -w], [0.0, w, -w], [0.0, w, w], [0.0, 0.0, w]], [1.0, 0.0, 0.0], mirror);
    if walls == 3 {
        made.quad([[-w, -w, 0.0], [w, -w, 0.0], [w, w, 0.0], [-w, w, 0.0]], [0.0, 0.0, 1.0], mirror);
    }
    made
}

#[test]
fn f11_a_corner_of_three_mirrors_sends_rays_back_parallel() {
    let made = corner(3);
    let mut came_back = 0;
    for (i, j) in [(8, 8), (0, 0), (15, 3), (4, 12), (10, 1)] {
        let nodes = made.explain(i, j);
        let (first, last) = (nodes[0].ray.direction, nodes[nodes.len() - 1].ray.direction);
        assert!(!nodes[nodes.len() - 1].hit.is_hit());
        if nodes.len() == 4 {
            assert!((first + last).length() < 1e-6, "{first} {last}");
            came_back += 1;
        }
    }
    assert!(came_back >= 3, "{came_back}");
}

#[test]
fn f11_ideal_mirrors_keep_all_energy() {
    for walls in [2, 3] {
        let frame = corner(walls).shade();
        assert!(frame.colors.iter().all(|&color| color == GzColor::ONE));
        assert!(frame.stats.mirror_rays > 256 && frame.stats.depth_cuts == 0 && frame.stats.shadow_rays == 0);
    }
}

#[test]
fn two_facing_mirrors_end_at_the_depth_limit_with_their_local_colour() {
    let mut made = Made { ambient: GzColor::ONE, ..Made::default() };
    let mirror = made.material(Material { ka: GzColor::splat(0.25), kd: GzColor::ZERO, ..dark(IDEAL) });
    made.wall(0.0, 500.0, mirror).wall(10.0, 500.0, mirror);
    for depth in [1, 3, 32] {
        made.rules.depth = depth;
        let frame = made.shade();
        assert_eq!(frame.stats.mirror_rays, 256 * u64::from(depth));
        assert_eq!((frame.stats.depth_cuts, frame.stats.depth_cut_weight), (256, 256 << 32));
        assert!(frame.colors.iter().all(|&color| color == GzColor::splat(0.25)));
    }
    made.rules.depth = 0;
    let frame = made.shade();
    assert_eq!((frame.stats.mirror_rays, frame.stats.depth_cuts, frame.colors[0]), (0, 0, GzColor::splat(0.25)));
}

#[test]
fn a_missed_mirror_ray_shows_what_its_blend_says() {
    let mut made = Made { ambient: GzColor::ONE, background: Background::Plain(GzColor::splat(0.5)), ..Made::default() };
    let mirror = made.material(Material { ka: GzColor::splat(0.125), ..dark(IDEAL) });
    made.wall(0.0, 5.0, mirror);
    for (blend, expected) in [(MirrorBlend::Physical, 0.5), (MirrorBlend::Replace, 0.125), (MirrorBlend::Add, 0.125)] {
        made.rules.mirror_blend = blend;
        assert_eq!(made.middle(), GzColor::splat(expected), "{blend:?}");
    }
}

#[test]
fn what_a_mirror_sees_joins_its_colour_as_its_blend_says() {
    let mut made = Made { ambient: GzColor::ONE, ..Made::default() };
    let mirror = made.material(Material { ka: GzColor::splat(0.125), tint: GzColor::new(1.0, 0.5, 0.0), ..dark(IDEAL) });
    let seen = made.material(Material { ka: GzColor::splat(0.5), ..dark(MaterialKind::Phong) });
    made.wall(0.0, 5.0, mirror).wall(9.0, 50.0, seen);
    let tinted = GzColor::new(0.5, 0.25, 0.0);
    for (blend, expected) in
        [(MirrorBlend::Physical, tinted), (MirrorBlend::Replace, tinted), (MirrorBlend::Add, tinted + GzColor::splat(0.125))]
    {
        made.rules.mirror_blend = blend;
        assert_eq!(made.middle(), expected, "{blend:?}");
    }
}

#[test]
fn a_mirror_with_an_index_reflects_its_fresnel_share() {
    let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
    let mirror = made.material(dark(MaterialKind::Mirror { ior: Some(1.5) }));
    made.wall(0.0, 5.0, mirror);
    let head_on = made.middle().x;
    assert!((head_on - 0.04).abs() < 1e-4, "{head_on}");
}

#[test]
fn weak_branches_end_and_their_weight_is_counted() {
    let mut made = Made::default();
    made.rules.depth = 32;
    let mirror = made.material(Material { tint: GzColor::splat(1.0 / 256.0), ..dark(IDEAL) });
    made.wall(0.0, 500.0, mirror).wall(10.0, 500.0, mirror);
    let stats = made.shade().stats;
    // Weight 2^-16 still goes on, the third bounce at 2^-24 does not.
    assert_eq!((stats.mirror_rays, stats.weak_branches, stats.weak_weight), (512, 256, 256 << 8));
}

#[test]
fn f10_a_shading_normal_never_sends_a_ray_through_the_mirror() {
    let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
    let mirror = made.material(Material { interpolate: Interpolate::Phong, ..dark(IDEAL) });
    // Normals that lean 75 degrees to the side: most reflections would go below, and some normals face away from the viewer.
    made.wall(0.0, 1.5, mirror);
    for tri in &mut made.tris {
        tri.normals = [[0.966, 0.0, 0.259]; 3].map(Into::into);
    }
    let unlit = made.material(dark(MaterialKind::Phong));
    made.wall(-1.0, 50.0, unlit);
    let frame = made.shade();
    assert!(frame.stats.mirror_rays > 50 && frame.stats.below_surface > 0 && frame.stats.nan_pixels == 0);
    // None reaches the black wall behind the mirror: where the mirror is seen, so is the background.
    assert_eq!(frame.stats.secondary_hits, 0);
    // Without geometric sides, as in the paper's program, they do.
    made.rules.geometric_sides = false;
    let stats = made.shade().stats;
    assert!(stats.secondary_hits > 0 && stats.below_surface == 0);
}

#[test]
fn the_papers_mistake_reflects_the_last_light_about_a_normal_not_turned() {
    let mut made = Made { lights: vec![sun([0.0, 1.0, 0.0]), sun([0.8, 0.0, 0.6])], ..Made::default() };
    made.rules = ShadeRules { mirror_blend: MirrorBlend::Add, reflect_last_light: true, ..ShadeRules::PAPER };
    let mirror = made.material(dark(MaterialKind::Mirror { ior: Some(1.5) }));
    made.wall(0.0, 5.0, mirror);
    let child = |made: &Made, i| made.explain(i, 8).swap_remove(1);
    // Along the stored normal the light's direction is reflected rightly: away behind the wall, with the share of air to glass.
    let along = child(&made, 3);
    assert!((along.ray.direction - gz_core::GzCoord::new(0.8, 0.0, -0.6)).length() < 1e-6);
    assert!(along.factor.x < 0.1);
    assert_eq!(along.ray.direction, child(&made, 12).ray.direction, "the same for every pixel");
    // Against it the normal should be turned and is not; from the dense side at 53 degrees the share is total.
    made.tris.iter_mut().for_each(|tri| tri.normals = [gz_core::GzCoord::NEG_Z; 3]);
    made.materials[0].interpolate = Interpolate::Phong;
    let against = child(&made, 3);
    let expected = gz_core::GzCoord::new(0.8, 0.0, 0.6 + 1.2).normalize();
    assert!((against.ray.direction - expected).length() < 1e-6, "{}", against.ray.direction);
    assert_eq!(against.factor, GzColor::ONE);
}
