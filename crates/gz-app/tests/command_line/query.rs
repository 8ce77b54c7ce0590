//! `gz query` and `--rays-out`: rays in, hits out.

use crate::folder::Folder;
use gz_app::hits_file;
use gz_app::rays_file::RayFormat;
use gz_core::glam::DVec3;
use gz_core::{GzCoord, GzRay, Hit};

/// A wall at z = 2 and one at z = 3, the farther one first.
const WALLS: &str = "v -9 -9 2\nv 9 -9 2\nv 0 9 2\nv -9 -9 3\nv 9 -9 3\nv 0 9 3\nf 4 5 6\nf 1 2 3\n";

fn folder_with(name: &str, rays: &[GzRay]) -> Folder {
    let folder = Folder::new(name);
    folder.write("walls.obj", WALLS);
    for (file, format) in [("a.rays", RayFormat::F32), ("a.rays64", RayFormat::F64)] {
        let mut bytes = Vec::new();
        rays.iter().for_each(|ray| format.encode(ray, &mut bytes));
        std::fs::write(folder.path().join(file), bytes).expect("the folder is writable");
    }
    folder
}

fn hits(folder: &Folder, name: &str) -> Vec<Hit> {
    hits_file::decode(&folder.read(name)).expect("a file of hits")
}

#[test]
fn rays_are_answered_in_order_by_everything_alike() {
    let down = GzRay::new(GzCoord::ZERO, GzCoord::Z);
    let rays = [
        down,
        GzRay { tmin: 2.0, ..down },
        GzRay { tmax: 2.0, ..down },
        GzRay::new(GzCoord::new(0.0, -4.5, 0.0), GzCoord::Z * 0.5),
        GzRay { direction: GzCoord::NAN, ..down },
        GzRay { direction: GzCoord::ZERO, ..down },
    ];
    let folder = folder_with("query", &rays);
    let out = folder.done("query --mesh walls.obj --rays a.rays --hits a.hits").out;
    let found = hits(&folder, "a.hits");
    assert_eq!(found.iter().map(|hit| (hit.tri, hit.t)).collect::<Vec<_>>(), {
        let miss = (u32::MAX, f32::INFINITY);
        [(1, 2.0), (0, 3.0), miss, (1, 4.0), miss, miss]
    });
    assert_eq!((found[3].u, found[3].v, found[2]), (0.375, 0.25, Hit::MISS));
    for part in ["triangles  2\n", "rays       6, 3 hit\n", "build      ", "trace      ", " Mrays/s\n"] {
        assert!(out.contains(part), "{part} in {out}");
    }
    for how in ["--accel brute", "--split midpoint", "--max-depth 3 --min-size 1", "--threads 1"] {
        folder.done(&format!("query --mesh walls.obj --rays64 a.rays64 --hits b.hits {how}"));
        assert_eq!(folder.read("b.hits"), folder.read("a.hits"), "{how}");
    }
    folder.done("query --mesh walls.obj --rays a.rays --hits any.hits --any");
    let any = folder.read("any.hits");
    for (any, hit) in any.chunks_exact(16).zip(&found) {
        assert_eq!(any, if hit.is_hit() { vec![0; 16] } else { hits_file::encode(&[Hit::MISS]) });
    }
    folder.done("query --mesh walls.obj --rays a.rays --hits c.hits --kernel moeller-trumbore");
    assert_eq!(hits(&folder, "c.hits")[0].t, 2.0);
}

#[test]
fn f64_origins_are_kept() {
    // A hair on either side of the edge at y = -9, which f32 does not tell apart.
    let at = |y: f64| GzRay::from_f64(DVec3::new(0.0, y, 0.0), GzCoord::Z);
    let folder = folder_with("query64", &[at(-9.0 - 1e-12), at(-9.0 + 1e-12)]);
    folder.done("query --mesh walls.obj --rays64 a.rays64 --hits a.hits");
    assert_eq!(hits(&folder, "a.hits").iter().map(Hit::is_hit).collect::<Vec<_>>(), [false, true]);
    folder.done("query --mesh walls.obj --rays a.rays --hits a.hits");
    assert!(hits(&folder, "a.hits").iter().all(Hit::is_hit));
}

#[test]
fn the_rays_of_a_render_give_its_t_buffer() {
    let folder = Folder::with_scene("rays-out");
    folder.done("render scene.toml -o a.png --size 40x30 --tbuffer t.hits --rays-out a.rays64");
    assert_eq!(folder.read("a.rays64").len(), 40 * 30 * 64);
    let out = folder.done("query --mesh scene.toml --rays64 a.rays64 --hits q.hits").out;
    assert!(out.contains("rays       1200, ") && folder.read("q.hits") == folder.read("t.hits"));
    // The camera stands on f32 numbers, so that f32 rays do as well; a crop has its own pixels only.
    folder.done("render scene.toml -o a.png --size 40x30 --crop 3,4,20,9 --tbuffer t.hits --rays-out a.rays");
    assert_eq!(folder.read("a.rays").len(), 17 * 5 * 32);
    folder.done("query --mesh scene.toml --rays a.rays --hits q.hits --accel brute");
    assert_eq!(folder.read("q.hits"), folder.read("t.hits"));
    folder.fails(
        "render scene.toml -o out.png --rays-out a.rays --aa 4",
        2,
        "--rays-out: an antialiased pixel has no single ray, use --aa none",
    );
    folder.fails(
        "render scene.toml -o out.png --rays-out scene.toml",
        2,
        "scene.toml: --rays-out would overwrite the scene itself",
    );
}

#[test]
fn no_rays_give_no_hits() {
    let folder = folder_with("query-none", &[]);
    let out = folder.done("query --mesh walls.obj --rays a.rays --hits a.hits").out;
    assert!(
        folder.read("a.hits").is_empty() && out.contains("rays       0, 0 hit\n") && out.contains("speed      0.000 Mrays/s\n")
    );
}

#[test]
fn what_cannot_be_queried_is_told_in_one_line() {
    let folder = folder_with("query-bad", &[GzRay::new(GzCoord::ZERO, GzCoord::Z); 3]);
    let query = |rest: &str| format!("query --mesh walls.obj {rest}");
    folder.fails(&query("--rays none.rays --hits a.hits"), 1, "none.rays: no such file");
    folder.fails("query --mesh none.obj --rays a.rays --hits a.hits", 1, "none.obj: no such file");
    folder.fails("query --mesh a.rays --rays a.rays --hits a.hits", 3, "a.rays: a scene is a .toml, .obj or .asc file");
    folder.write("cut.rays", "no ray has ten bytes");
    folder.fails(&query("--rays cut.rays --hits a.hits"), 3, "cut.rays: 20 bytes are not a whole number of rays of 32 bytes");
    // Three rays of f32 are no whole number of f64 ones.
    folder.fails(&query("--rays64 a.rays --hits a.hits"), 3, "a.rays: 96 bytes are not a whole number of rays of 64 bytes");
    folder.fails(&query("--rays a.rays --hits a.rays"), 2, "a.rays: --hits would overwrite the rays");
    folder.fails(&query("--rays a.rays --hits ./walls.obj"), 2, "./walls.obj: --hits would overwrite the mesh");
    folder.fails(&query("--rays a.rays --hits no/a.hits"), 1, "no/a.hits: there is no folder no");
    folder.fails(&query("--rays . --hits a.hits"), 1, ".: is a folder, not a file");
    folder.write("flat.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
    let ended = folder.gz("query --mesh flat.obj --rays a.rays --hits a.hits");
    assert!(ended.code == 3 && ended.err.starts_with("gz: flat.obj:2: ") && ended.err.lines().count() == 1, "{}", ended.err);
    for line in [
        query("--hits a.hits"),
        query("--rays a.rays"),
        query("--rays a.rays --rays64 a.rays64 --hits a.hits"),
        "query".to_owned(),
    ] {
        let ended = folder.gz(&line);
        assert!(ended.code == 2 && ended.err.lines().count() == 1, "{line}: {}", ended.err);
    }
    assert!(!folder.names().iter().any(|name| name == "a.hits" || name.ends_with(".part")));
}
