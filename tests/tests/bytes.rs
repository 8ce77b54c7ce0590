//! Bytes of a placed scene, counted by the allocator: what is not needed is not stored.
//!
//! One test in a program of its own, so that nothing else allocates while it counts.

use cap::Cap;
use gz_app::info::texture_bytes;
use gz_app::load::{self, Draft, Overrides};
use gz_core::Attributes;
use gz_shade::{Scene, SceneNeeds};
use gz_tests::{needs_scenes, scenes};
use std::alloc::System;
use std::path::Path;

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Live bytes now.
fn live() -> usize {
    ALLOCATOR.allocated()
}

/// Bytes that dropping `it` gives back.
fn held<T>(it: T) -> usize {
    let before = live();
    drop(it);
    before - live()
}

/// Room for names, material and light lists, and whatever the standard library keeps from the first call on.
const SMALL_CHANGE: usize = 64 << 10;

/// Checks a scene placed with some needs: its buffer holds the bytes that it tells, not one more, and they are those of `keep`.
fn check(name: &str, load: &dyn Fn() -> Draft, needs: SceneNeeds, keep: Attributes) -> usize {
    let before = live();
    let mut scene: Scene = load().place(needs).unwrap_or_else(|error| panic!("{name}: {error}"));
    let whole = live() - before;
    let (told, textures, triangles) = (scene.tris.bytes(), texture_bytes(&scene), scene.tris.len());
    assert_eq!(scene.tris.attributes(), keep, "{name}");
    assert_eq!(told, triangles * keep.bytes_per_triangle(), "{name}");
    assert!(
        whole >= told + textures && whole <= told + textures + SMALL_CHANGE,
        "{name}: {whole} bytes live, {told} of triangles, {textures} of textures"
    );
    // The arrays are made at their final size, so there is no spare capacity to allow for.
    assert_eq!(held(std::mem::take(&mut scene.tris)), told, "{name}");
    told / triangles
}

/// Each array of a triangle buffer: a need that brings it, what it is, and its bytes a triangle.
const ARRAYS: [(&str, Attributes, usize); 5] = {
    let none = Attributes { normals: false, uvs: false, colors: false, materials: false, classes: false };
    [
        ("smooth_normals", Attributes { normals: true, ..none }, 36),
        ("image_textures", Attributes { uvs: true, ..none }, 24),
        ("app_colors", Attributes { colors: true, ..none }, 12),
        ("materials", Attributes { materials: true, ..none }, 2),
        ("glass", Attributes { classes: true, ..none }, 1),
    ]
};

/// No need at all, or one of those that bring an array.
fn only(need: &str) -> SceneNeeds {
    SceneNeeds {
        shadows: false,
        mirrors: false,
        glass: need == "glass",
        image_textures: need == "image_textures",
        procedural_textures: false,
        smooth_normals: need == "smooth_normals",
        gouraud: false,
        app_colors: need == "app_colors",
        materials: need == "materials",
        antialiasing: false,
    }
}

#[test]
fn a_placed_scene_holds_the_bytes_of_its_needs_and_no_more() {
    // The arrays one by one, over positions.
    let load_plain = || scenes::draft("plain", &Overrides::default());
    let positions = check("plain, nothing", &load_plain, only("nothing"), Attributes::default());
    assert_eq!(positions, 36);
    for (need, keep, bytes) in ARRAYS {
        let per_triangle = check(&format!("plain, {need}"), &load_plain, only(need), keep);
        assert_eq!(per_triangle, positions + bytes, "{need}");
        println!("{need}: {bytes} bytes a triangle");
    }

    // Every scene, with its needs and with all.
    for name in scenes::usable() {
        let load = || scenes::draft(&name, &Overrides::default());
        let needs = SceneNeeds::of(&load().scene);
        let computed = check(&name, &load, needs, needs.attributes());
        let all = check(&name, &load, SceneNeeds::ALL, Attributes::ALL);
        assert!(computed <= all && all == 111, "{name}: {computed} of {all}");
        println!("{name}: {computed} bytes a triangle, {all} with all needs");
    }

    // The scenes of one need each.
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bytes");
    for scene in needs_scenes::all() {
        let path = needs_scenes::write(&folder, scene.need, &scene.toml).unwrap();
        let load = || load::scene(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        check(scene.need, &load, SceneNeeds::of(&load().scene), scene.attributes);
    }
}
