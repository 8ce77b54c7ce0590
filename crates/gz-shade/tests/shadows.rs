//! Lights and shadows.

mod common;

use common::*;
use gz_core::{GzColor, GzCoord};
use gz_shade::*;

/// A matt wall at z = 0 under a sun straight before it.
fn lit_wall() -> Made {
    let mut made = Made { lights: vec![sun([0.0, 0.0, 1.0])], ..Made::default() };
    let wall = made.material(matt());
    made.wall(0.0, 9.0, wall);
    made
}

/// The same, with a small pane of `material` at height 9, behind the camera.
fn with_pane(material: Material) -> Made {
    let mut made = lit_wall();
    let pane = made.material(material);
    made.wall(9.0, 1.0, pane);
    made
}

fn red_glass() -> Material {
    Material { tint: GzColor::new(1.0, 0.5, 0.0), ..dark(MaterialKind::Glass { ior: 1.5 }) }
}

#[test]
fn what_is_in_the_way_drops_the_light_and_leaves_ambient() {
    let mut made = with_pane(matt());
    made.ambient = GzColor::splat(0.5);
    let frame = made.shade();
    assert_eq!(frame.colors[(SIZE * SIZE / 2 + SIZE / 2) as usize], GzColor::splat(0.05));
    assert_eq!(frame.colors[0], GzColor::splat(0.05 + 0.7));
    assert_eq!(frame.stats.shadow_rays, 256);
    made.rules.shadow = ShadowRule::Off;
    assert_eq!((made.middle(), made.shade().stats.shadow_rays), (GzColor::splat(0.05 + 0.7), 0));
}

#[test]
fn glass_tints_or_blocks_by_rule() {
    let mut made = with_pane(red_glass());
    assert_eq!(made.middle(), GzColor::splat(0.7) * GzColor::new(1.0, 0.5, 0.0));
    made.rules.shadow = ShadowRule::Opaque;
    assert_eq!(made.middle(), GzColor::ZERO);
}

#[test]
fn tints_of_several_panes_multiply_and_something_opaque_ends_it() {
    let mut made = with_pane(red_glass());
    made.wall(10.0, 1.0, 1).wall(10.5, 1.0, 1);
    assert_eq!(made.middle(), GzColor::splat(0.7) * GzColor::new(1.0, 0.125, 0.0));
    made.wall(11.0, 1.0, 0);
    assert_eq!(made.middle(), GzColor::ZERO);
}

#[test]
fn only_rays_that_something_is_in_the_way_of_are_asked_about_glass() {
    // The pane's shadow has `touched` pixels; behind it each ray asks once for what is opaque, then for glass until it meets no more.
    let blocked = with_pane(matt()).shade();
    let touched = blocked.colors.iter().filter(|&&color| color == GzColor::ZERO).count() as u64;
    assert!(touched > 0 && touched < 200, "{touched}");
    let tinted = with_pane(red_glass()).shade();
    assert_eq!((blocked.stats.tint_queries, tinted.stats.tint_queries), (0, touched * 3));
    assert_eq!(tinted.stats.shadow_rays, blocked.stats.shadow_rays);
}

#[test]
fn no_shadow_ray_goes_to_a_light_that_adds_nothing() {
    let mut made = lit_wall();
    made.lights = vec![sun([0.0, 0.3, -1.0])];
    assert_eq!((made.middle(), made.shade().stats.shadow_rays), (GzColor::ZERO, 0));
    made.lights = vec![GzLight { color: GzColor::ZERO, ..sun([0.0, 0.0, 1.0]) }];
    assert_eq!(made.shade().stats.shadow_rays, 0);
    made.lights = vec![sun([0.0, 0.0, 1.0])];
    made.materials[0].kd = GzColor::ZERO;
    assert_eq!(made.shade().stats.shadow_rays, 0);
}

#[test]
fn an_ideal_mirror_is_not_shaded_by_itself() {
    let mut made = lit_wall();
    made.materials[0].kind = MaterialKind::Mirror { ior: None };
    let stats = made.shade().stats;
    assert_eq!((stats.mirror_rays, stats.shadow_rays), (256, 0));
}

#[test]
fn a_lamp_is_not_shadowed_by_what_lies_beyond_it() {
    let mut made = with_pane(matt());
    made.lights = vec![lamp([0.0, 0.0, 8.0])];
    assert!(made.middle().x > 0.69);
    made.lights = vec![lamp([0.0, 0.0, 10.0])];
    assert_eq!(made.middle(), GzColor::ZERO);
}

#[test]
fn f13_a_lamp_on_a_triangle_shines() {
    let mut made = with_pane(matt());
    for z in [9.0, 9.0 - 1e-7] {
        made.lights = vec![lamp([0.25, 0.125, z])];
        let frame = made.shade();
        assert!(frame.colors.iter().all(|color| color.x > 0.5), "{z}");
    }
}

#[test]
fn f8_a_grazing_light_leaves_no_stipple_on_a_flat_floor() {
    let mut made = lit_wall();
    for slope in [1e-2, 1e-4, 1e-6] {
        made.lights = vec![sun([1.0, 0.37, slope])];
        let frame = made.shade();
        assert!(frame.stats.shadow_rays == 256 && frame.colors.iter().all(|&color| color == frame.colors[0]));
        assert!(frame.colors[0].x > 0.0);
    }
}

#[test]
fn a_light_behind_the_triangle_gives_nothing_though_corner_normals_see_it() {
    let mut made = lit_wall();
    made.rules.shadow = ShadowRule::Off;
    made.materials[0].interpolate = Interpolate::Phong;
    for tri in &mut made.tris {
        tri.normals = [GzCoord::new(0.8, 0.0, 0.6); 3];
    }
    made.lights = vec![sun([1.0, 0.0, -0.2])];
    assert_eq!(made.middle(), GzColor::ZERO);
    // The course lets normals decide alone.
    made.rules.geometric_sides = false;
    assert!(made.middle().x > 0.4);
}

#[test]
fn f9_a_light_in_the_plane_is_behind() {
    let mut made = lit_wall();
    made.materials[0].ks = GzColor::ONE; // a highlight needs no diffuse light
    made.materials[0].power = 0.0;
    made.lights = vec![sun([1.0, 0.0, 0.0])];
    let frame = made.shade();
    assert!(frame.colors.iter().all(|&color| color == GzColor::ZERO) && frame.stats.shadow_rays == 0);
    // Where normals decide alone it has nowhere to leave the surface: counted, and black.
    made.rules.geometric_sides = false;
    let frame = made.shade();
    assert_eq!((frame.stats.absorbed, frame.colors[0]), (256, GzColor::ZERO));
}

#[test]
fn corner_shading_equals_hit_shading_where_normals_are_equal() {
    let mut made = Made { lights: vec![sun([0.3, 0.2, 1.0])], ambient: GzColor::splat(0.3), ..Made::default() };
    made.rules.eye = Eye::Fixed;
    let wall = made.material(Material { interpolate: Interpolate::Phong, ..Material::default() });
    made.wall(0.0, 9.0, wall);
    let phong = made.shade().colors;
    made.materials[0].interpolate = Interpolate::Gouraud;
    for (a, b) in phong.iter().zip(made.shade().colors) {
        assert!((*a - b).abs().max_element() < 1e-6);
    }
}

#[test]
fn textures_colour_each_interpolation_by_its_own_rule() {
    let (red, blue) = (GzColor::X, GzColor::Z);
    let checker = |colors| Texture::Procedural(Procedural::Checker { across: 1.0, down: 1.0, colors });
    let mut made = lit_wall();
    made.textures = vec![checker([red, blue])];
    made.materials[0].texture = Some(0);
    made.materials[0].ks = GzColor::splat(0.25);
    made.materials[0].power = 0.0;
    let mut at = |interpolate, rules: ShadeRules| {
        made.materials[0].interpolate = interpolate;
        made.rules = ShadeRules { eye: Eye::Ray, geometric_sides: true, shadow: ShadowRule::Off, ..rules };
        made.middle()
    };
    // Kd = texture, Ks stays.
    assert_eq!(at(Interpolate::Phong, ShadeRules::PHYSICAL), red + GzColor::splat(0.25));
    assert_eq!(at(Interpolate::Flat, ShadeRules::PHYSICAL), red + GzColor::splat(0.25));
    // All coefficients 1 at the corners, 1 + 1, then times the texture.
    assert_eq!(at(Interpolate::Gouraud, ShadeRules::PHYSICAL), red * 2.0);
    // The course clamps, and its flat mode knows no texture.
    assert_eq!(at(Interpolate::Gouraud, ShadeRules::HOMEWORK), red);
    assert_eq!(at(Interpolate::Flat, ShadeRules::HOMEWORK), GzColor::splat(0.7 + 0.25));
}
