//! Seeds of the fuzz targets: hard cases as bytes, and random ones.

use crate::hard::{Dice, meshes};
use gz_core::GzCoord;
use std::io;
use std::path::{Path, PathBuf};

/// What a target starts from.
#[derive(Clone, Debug)]
pub struct Seed {
    /// The target.
    pub target: &'static str,
    /// The name of its file.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

/// Where the seeds of a target are.
pub fn folder(target: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(target)
}

/// Writes all seeds and returns how many there are. What once crashed a target lies beside them and stays.
///
/// # Errors
///
/// Those of the file system.
pub fn write() -> io::Result<usize> {
    let seeds = all();
    for Seed { target, name, bytes } in &seeds {
        std::fs::create_dir_all(folder(target))?;
        std::fs::write(folder(target).join(name), bytes)?;
    }
    Ok(seeds.len())
}

/// All seeds, the same at each call.
pub fn all() -> Vec<Seed> {
    let mut dice = Dice::new(2);
    let mut seeds = Vec::new();
    let mut add = |target, name: &str, bytes: &[u8]| seeds.push(Seed { target, name: name.to_owned(), bytes: bytes.to_vec() });
    let v = GzCoord::new;
    let mut scenes: Vec<(&str, Vec<[GzCoord; 3]>)> = vec![
        ("zero_area", vec![[v(1.0, 1.0, 1.0); 3], [v(0.0, 0.0, 0.0), v(1.0, 1.0, 1.0), v(2.0, 2.0, 2.0)]]),
        ("subnormal", vec![[v(1e-44, 0.0, 0.0), v(0.0, 1e-44, 0.0), v(0.0, 0.0, 1e-44)]; 3]),
        ("huge", vec![[v(3e38, 3e38, 1.0), v(-3e38, 3e38, 1.0), v(0.0, -3e38, 1.0)]; 2]),
        (
            "not_finite",
            vec![
                [v(f32::NAN, 0.0, 0.0), v(f32::INFINITY, 0.0, 0.0), v(0.0, 1.0, 0.0)],
                [v(0.0, 0.0, 1.0), v(1.0, 0.0, 1.0), v(0.0, 1.0, 1.0)],
            ],
        ),
        ("fan", meshes::spindle(8).triangles()),
        ("field", meshes::integer_field(&mut dice, 4).into_iter().take(60).collect()),
        ("box", meshes::block(v(-1.0, -1.0, -1.0), v(1.0, 1.0, 1.0)).triangles()),
    ];
    scenes.push(("copies", vec![scenes[6].1[0]; 40]));
    scenes.push(("soup", meshes::soup(&mut dice, 40, 0.5)));
    scenes.push(("needles", meshes::needles(&mut dice, 1e6, gz_core::glam::DVec3::ONE).to_vec()));
    for (name, triangles) in &scenes {
        let rays: Vec<u8> = (0..400).map(|_| dice.bits() as u8).collect();
        add("trace", name, &traced(triangles, &rays));
        let mut built = vec![if *name == "copies" { 39 } else { 0 }, 1];
        built.extend(raw(triangles));
        add("build_tree", name, &built);
    }
    let quad = [[-1, -1, 4], [1, -1, 4], [1, 1, 4], [-1, 1, 4]];
    let pyramid = [[-3, -3, 5], [3, -3, 5], [3, 3, 5], [-3, 3, 5], [0, 0, 9]];
    let halves = [[0, 1, 2], [0, 2, 3]];
    let sides = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 1, 2], [0, 2, 3]];
    for (name, scale, offset) in [("unit", 0, 0), ("tiny", -39, 0), ("huge", 39, 0), ("offset", 0, 12), ("far", 0, 20)] {
        let rays: Vec<u8> = (0..400).map(|_| dice.bits() as u8).collect();
        add("filter_soundness", &format!("quad_{name}"), &shared(scale, offset, &quad, &halves, &rays));
        add("filter_soundness", &format!("pyramid_{name}"), &shared(scale, offset, &pyramid, &sides, &rays));
        // Copies, both ways round, and triangles without area.
        let copies = [[0, 1, 2], [2, 1, 0], [0, 1, 2], [0, 0, 1], [0, 1, 3]];
        add("filter_soundness", &format!("copies_{name}"), &shared(scale, offset, &quad, &copies, &rays));
    }
    for k in 0..16 {
        let bytes: Vec<u8> = (0..60 + 20 * k).map(|_| dice.bits() as u8).collect();
        add("filter_soundness", &format!("random_{k:02}"), &bytes);
        if k < 4 {
            add("trace", &format!("random_{k:02}"), &bytes);
            add("build_tree", &format!("random_{k:02}"), &bytes);
        }
    }
    seeds
}

fn raw(corners: &[[GzCoord; 3]]) -> Vec<u8> {
    corners.iter().flatten().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes).collect()
}

/// Whole points and triangles over them as the target `filter_soundness` reads them, at 2^`scale` of their size and `offset` away, then what
/// is left for rays.
fn shared(scale: i8, offset: u8, points: &[[i16; 3]], faces: &[[u8; 3]], rays: &[u8]) -> Vec<u8> {
    // 2^k is written as k + 40 and k + 20, the number of points as what it is beyond 3, that of triangles beyond 1.
    let mut bytes = vec![(scale + 40) as u8, 20 + offset, u8::from(offset > 0), points.len() as u8 - 3];
    bytes.extend(points.iter().flatten().flat_map(|x| (x * 256).to_le_bytes()));
    bytes.push(faces.len() as u8 - 1);
    // A 1 behind each triangle: no needle.
    bytes.extend(faces.iter().flat_map(|[a, b, c]| [*a, *b, *c, 1]));
    bytes.extend(rays);
    bytes
}

/// Triangles as the target `trace` reads them: their number, then corners that are not taken from before, then rays.
fn traced(corners: &[[GzCoord; 3]], rays: &[u8]) -> Vec<u8> {
    let mut bytes = vec![corners.len() as u8];
    for corner in corners.iter().flatten() {
        bytes.push(1);
        bytes.extend(corner.to_array().into_iter().flat_map(f32::to_le_bytes));
    }
    bytes.extend(rays);
    bytes
}
