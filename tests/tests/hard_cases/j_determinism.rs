//! J: the same bits, whatever the machine does.

use gz_app::load::Overrides;
use gz_app::{hits_file, threads};
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, RayQuery, SimdLevel, TBuffer};
use gz_shade::Antialias;
use gz_tests::folder::Folder;
use gz_tests::judge::everyone;
use gz_tests::scenes::{color_bits, hit_bits, placed, shade};
use std::path::Path;

const SMALL: Overrides = Overrides { size: Some((40, 30)), aa: Some(Antialias::None), ..Overrides::NONE };

#[test]
fn j01_threads_tiles_and_trees() {
    for name in ["shadows", "refraction"] {
        let (scene, needs) = placed(name, &SMALL);
        let tree = BspTree::build(&scene.tris);
        let first = shade(&scene, needs, &tree, 16);
        let colors = color_bits(&first.colors);
        let check = |what: &str, query: &dyn RayQuery, tile: u32| {
            let frame = shade(&scene, needs, query, tile);
            assert!(color_bits(&frame.colors) == colors && frame.stats == first.stats, "{name}: {what}, tiles of {tile}");
        };
        for count in [1, 2, 3, 16] {
            for tile in [1, 7, 64, 256] {
                threads::with(count, || {
                    check(&format!("{count} threads"), &tree, tile);
                    Ok(())
                })
                .expect("there are threads");
            }
        }
        everyone(&scene.tris, |who, query| check(who, query, 16));
        for (max_depth, min_size) in [(2, 1), (10, 10), (15, 20)] {
            let setting = Midpoint { max_depth, min_size, ..Midpoint::default() };
            check("midpoint", &MidpointTree::build(&scene.tris, setting).expect("within budget"), 16);
        }
    }
}

/// The T-buffer of a golden reference: made once, by one build on one machine.
fn reference(name: &str) -> Vec<[u32; 4]> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("golden/{name}.hits"));
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    hit_bits(&hits_file::decode(&bytes).expect("a T-buffer"))
}

/// The same now, at its size of 128 pixels across.
fn golden_scene(name: &str) -> gz_shade::Scene {
    let full = placed(name, &Overrides::NONE).0.camera;
    let height = (128 * full.height()).div_ceil(full.width());
    placed(name, &Overrides { size: Some((128, height)), aa: Some(Antialias::None), ..Overrides::NONE }).0
}

#[test]
fn j02_instruction_sets() {
    // What this build and this machine can do must give the bits of the references, which another build on another machine wrote; the
    // builds for other targets are compared with each other by `cargo xtask verify builds`.
    for name in ["shadows", "reflection", "refraction", "teapot"] {
        let (scene, expected) = (golden_scene(name), reference(name));
        for &level in SimdLevel::available() {
            let tree = BspTree::build(&scene.tris).with_simd(level);
            assert!(hit_bits(&TBuffer::trace(&scene.camera, &tree).hits) == expected, "{name}, {level:?}");
        }
        println!("J2: {name}, {} pixels, {:?}: 0 differ", expected.len(), SimdLevel::available());
    }
}

#[test]
fn j03_debug_and_release() {
    // This test is run by both kinds of build, and either has to give the same references.
    let (scene, expected) = (golden_scene("plain"), reference("plain"));
    let kind = if cfg!(debug_assertions) { "debug" } else { "release" };
    let brute = BruteForce::new(&scene.tris);
    assert!(hit_bits(&TBuffer::trace(&scene.camera, &BspTree::build(&scene.tris)).hits) == expected, "tree, {kind}");
    assert!(hit_bits(&TBuffer::trace(&scene.camera, &brute).hits) == expected, "brute force, {kind}");
}

#[test]
fn j04_two_runs() {
    // Materials go through hash maps in tobj: their order here must be the file's, run after run.
    let folder = Folder::new("j04");
    let names: Vec<String> = (0..40).map(|k| format!("m{}", k * 37 % 40)).collect();
    folder.write("m.mtl", names.iter().map(|name| format!("newmtl {name}\nKd 0.{} 0.5 0.5\n", &name[1..])).collect::<String>());
    let faces: String = names.iter().rev().map(|name| format!("usemtl {name}\nf 1 2 3\n")).collect();
    let path = folder.write("t.obj", format!("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{faces}"));
    let load = || gz_app::load::obj::load(&path).expect("it can be used");
    let first = load();
    assert!(first.materials.len() >= 40);
    for _ in 0..5 {
        let again = load();
        assert_eq!((&again.materials, &again.triangles), (&first.materials, &first.triangles));
    }
    // And the same picture from two runs, loading included.
    let run = || {
        let (scene, needs) = placed("teapot", &SMALL);
        let frame = shade(&scene, needs, &BspTree::build(&scene.tris), 16);
        (color_bits(&frame.colors), frame.stats)
    };
    assert!(run() == run());
}
