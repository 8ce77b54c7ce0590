//! What a scene does not need costs nothing and changes nothing; nor do threads, tiles and crops.

mod common;

use common::*;
use gz_core::{GzColor, Tile, TileGrid};
use gz_shade::*;
use std::sync::atomic::Ordering;

const MIRROR: MaterialKind = MaterialKind::Mirror { ior: None };
const GLASS: MaterialKind = MaterialKind::Glass { ior: 1.5 };

/// A matt flat wall, unlit: needs nothing.
fn plain() -> Made {
    let mut made = Made { ambient: GzColor::ONE, background: Background::Plain(GzColor::splat(0.2)), ..Made::default() };
    made.material(matt());
    made.wall(0.0, 1.5, 0);
    made
}

fn checker() -> Texture {
    Texture::Procedural(Procedural::Checker { across: 7.0, down: 5.0, colors: [GzColor::X, GzColor::Y] })
}

fn picture() -> Texture {
    let texels = (0..12).map(|k| GzColor::splat(k as f32 / 12.0)).collect();
    Texture::Image(ImageTexture { width: 4, height: 3, texels, lookup: TextureLookup::Repeat })
}

/// Everything at once.
fn everything() -> Made {
    let mut made = plain();
    made.textures = vec![picture(), checker()];
    made.lights = vec![sun([0.3, 0.4, 1.0]), lamp([1.0, 2.0, 3.0])];
    made.rules.antialias = Antialias::Samples(3);
    made.rules.depth = 5;
    made.background = Background::Gradient { bottom: GzColor::splat(0.1), top: GzColor::new(0.3, 0.5, 0.9) };
    let smooth = Material { texture: Some(0), interpolate: Interpolate::Phong, ..Material::default() };
    let floor = made.material(Material { texture: Some(1), ..smooth.clone() });
    let mirror = made.material(Material { kind: MaterialKind::Mirror { ior: Some(2.0) }, ..smooth.clone() });
    let pane = made.material(Material { tint: GzColor::new(0.9, 0.5, 0.8), interpolate: Interpolate::Phong, ..dark(GLASS) });
    let gouraud = made.material(Material { interpolate: Interpolate::Gouraud, ..smooth });
    let app = made.material(Material { surface: Surface::AppColor, ..matt() });
    made.quad([[-5.0, -1.0, -5.0], [5.0, -1.0, -5.0], [5.0, -1.0, 5.0], [-5.0, -1.0, 5.0]], [0.1, 1.0, 0.0], floor);
    made.wall(-2.0, 3.0, mirror).block([-0.9, -0.5, 0.5], [0.3, 0.6, 1.2], false, pane);
    made.block([0.5, -0.9, 0.1], [1.2, 0.4, 0.9], false, gouraud).block([-1.4, 0.7, 0.0], [-1.0, 1.2, 0.4], false, app);
    made
}

/// One scene for each need; the name is that of its field.
fn one_each() -> Vec<(&'static str, Made)> {
    let with = |change: &dyn Fn(&mut Made)| {
        let mut made = plain();
        change(&mut made);
        made
    };
    vec![
        ("shadows", with(&|it| it.lights = vec![sun([0.0, 0.0, 1.0])])),
        ("mirrors", with(&|it| it.materials[0].kind = MIRROR)),
        ("glass", with(&|it| it.materials[0] = dark(GLASS))),
        ("image_textures", with(&|it| (it.textures, it.materials[0].texture) = (vec![picture()], Some(0)))),
        ("procedural_textures", with(&|it| (it.textures, it.materials[0].texture) = (vec![checker()], Some(0)))),
        ("smooth_normals", with(&|it| it.materials[0].interpolate = Interpolate::Phong)),
        ("gouraud", with(&|it| it.materials[0].interpolate = Interpolate::Gouraud)),
        ("app_colors", with(&|it| it.materials[0].surface = Surface::AppColor)),
        ("materials", with(&|it| it.materials.insert(0, dark(MIRROR)))),
        ("antialiasing", with(&|it| it.rules.antialias = Antialias::Hw6)),
    ]
}

fn needed(made: &Made) -> Vec<&'static str> {
    let reasons = SceneNeeds::reasons(&made.scene(None));
    reasons.iter().filter(|reason| reason.because.is_some()).map(|reason| reason.need).collect()
}

/// Materials move up by one where one was put before them.
fn used_materials(mut made: Made) -> Made {
    let last = (made.materials.len() - 1) as u16;
    if made.tris.iter().all(|tri| tri.material == 0) {
        made.tris.iter_mut().for_each(|tri| tri.material = last);
    }
    made
}

#[test]
fn the_plain_scene_casts_primary_rays_only_and_stores_positions_only() {
    let made = plain();
    assert!(needed(&made).is_empty());
    let scene = made.scene(None);
    assert_eq!(scene.tris.bytes(), 36 * scene.tris.len());
    let stats = made.shade().stats;
    assert_eq!((stats.rays(), stats.primary_rays), (256, 256));
}

#[test]
fn for_each_need_there_is_a_scene_in_which_only_that_counts() {
    for (need, made) in one_each() {
        let made = used_materials(made);
        let also = match need {
            "glass" | "gouraud" => Some("smooth_normals"), // sides of glass, and normals to shade corners with
            _ => None,
        };
        let asked = needed(&made);
        assert!(asked.contains(&need) && asked.iter().all(|&it| it == need || Some(it) == also), "{need}: {asked:?}");
        let stats = made.shade().stats;
        let counts = [("shadows", stats.shadow_rays), ("mirrors", stats.mirror_rays), ("glass", stats.glass_rays)];
        for (name, count) in counts {
            assert_eq!(count > 0, name == need, "{need}: {name} {count}");
        }
        assert_eq!(stats.primary_rays, if need == "antialiasing" { 6 * 256 } else { 256 });
    }
}

#[test]
fn computed_needs_give_the_same_bits_as_all_needs() {
    let mut scenes = one_each();
    scenes.push(("plain", plain()));
    scenes.push(("everything", everything()));
    for (rules_name, rules) in
        [("physical", ShadeRules::PHYSICAL), ("homework", ShadeRules::HOMEWORK), ("paper", ShadeRules::PAPER)]
    {
        for (name, made) in &scenes {
            let mut made = used_materials(made.clone());
            made.rules = ShadeRules { antialias: made.rules.antialias, depth: made.rules.depth, ..rules };
            let scene = made.scene(None);
            let of = shade_with(&scene, SceneNeeds::of(&scene), 8);
            assert_eq!(of, shade_with(&scene, SceneNeeds::ALL, 8), "{rules_name} {name}: same buffer");
            let full = made.scene(Some(SceneNeeds::ALL));
            assert_eq!(of, shade_with(&full, SceneNeeds::ALL, 8), "{rules_name} {name}: all attributes");
            assert_eq!(of.stats.nan_pixels, 0);
        }
    }
}

#[test]
fn counts_are_those_at_the_query() {
    for made in [everything(), plain()] {
        let scene = made.scene(None);
        let query = Counted::new(&scene.tris);
        let grid = TileGrid::whole(SIZE, SIZE, 8);
        let stats = shade_frame(&scene, SceneNeeds::of(&scene), &query, &grid, &|_| {}).stats;
        assert_eq!(query.any.load(Ordering::Relaxed), stats.shadow_rays);
        let closest = stats.primary_rays + stats.mirror_rays + stats.glass_rays + stats.tint_queries;
        assert_eq!(query.closest.load(Ordering::Relaxed), closest);
    }
}

#[test]
fn j1_threads_tiles_and_crops_cannot_be_seen() {
    let scene = everything().scene(None);
    let needs = SceneNeeds::of(&scene);
    let reference = shade_with(&scene, needs, 64);
    assert!(reference.stats.mirror_rays > 0 && reference.stats.glass_rays > 0 && reference.stats.tint_queries > 0);
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for size in [1, 5, 8, 16] {
            assert_eq!(pool.install(|| shade_with(&scene, needs, size)), reference, "{threads} threads, tiles of {size}");
        }
    }
    let crop = Tile { x0: 3, y0: 5, x1: 14, y1: 9 };
    let query = Counted::new(&scene.tris);
    let part = shade_frame(&scene, needs, &query, &TileGrid::of(crop, 4), &|_| {});
    assert_eq!(part.area, crop);
    for ((i, j), color) in crop.pixels().zip(&part.colors) {
        assert_eq!(*color, reference.colors[(j * SIZE + i) as usize]);
    }
}

#[test]
fn every_tile_is_reported_once() {
    let scene = plain().scene(None);
    let done = std::sync::Mutex::new(Vec::new());
    let grid = TileGrid::whole(SIZE, SIZE, 6);
    let query = Counted::new(&scene.tris);
    shade_frame(&scene, SceneNeeds::of(&scene), &query, &grid, &|tile| done.lock().unwrap().push((tile.y0, tile.x0)));
    let mut done = done.into_inner().unwrap();
    done.sort_unstable();
    assert_eq!(done, [0, 6, 12].map(|y| [0, 6, 12].map(|x| (y, x))).concat());
}

#[test]
fn the_explained_pixel_has_the_colour_of_the_picture() {
    let made = everything();
    let picture = made.shade();
    for (i, j) in [(0, 0), (5, 9), (8, 8), (11, 10), (15, 15)] {
        let nodes = made.explain(i, j);
        let roots = nodes.iter().filter(|node| node.parent.is_none());
        let sum: gz_core::glam::DVec3 = roots.map(|root| root.color.as_dvec3() * root.sample_weight).sum();
        assert_eq!(sum.as_vec3(), picture.colors[(j * SIZE + i) as usize], "{i} {j}");
        // Each node is its local colour and its children's shares.
        for (k, node) in nodes.iter().enumerate() {
            let children = nodes.iter().filter(|child| child.parent == Some(k));
            let expected = children.fold(node.local * node.keep, |sum, child| sum + child.factor * child.color);
            assert!((node.color - expected).abs().max_element() < 1e-5);
        }
    }
}

#[test]
fn the_screen_camera_has_no_secondary_rays() {
    let mut made = everything();
    made.camera.model = gz_core::CameraModel::Screen;
    let frame = made.shade();
    assert_eq!(frame.stats.rays(), frame.stats.primary_rays);
    let scene = made.scene(Some(SceneNeeds::ALL));
    assert_eq!(frame, shade_with(&scene, SceneNeeds::ALL, 8));
}
