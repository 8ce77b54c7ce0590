//! Whole files: numbering, agreement with `tobj`, random changes, and the course's bunny-sized neighbours.

use super::super::testing::{Scratch, mutated, random};
use super::*;
use crate::mesh::MeshTri;
use gz_core::GzCoord;
use std::fmt::Write;

/// A file with polygons of many shapes over groups, materials and line ends, and the triangles that it must give.
struct Made {
    text: String,
    triangles: Vec<MeshTri>,
}

/// Faces of three to seven corners, convex, or concave in a way whose ears are known, with negative indices now and then.
fn made(seed: u64) -> Made {
    let mut state = seed;
    let mut made = Made { text: "mtllib m.mtl\n".to_owned(), triangles: Vec::new() };
    let (mut vertices, mut material) = (0u32, None);
    for _ in 0..60 {
        match random(&mut state) % 4 {
            0 => drop(writeln!(made.text, "g group{}", random(&mut state) % 3)),
            1 => drop(writeln!(made.text, "o object\ns 1\nl 1 2 3")),
            2 => {
                let number = random(&mut state) % 3;
                let _ = writeln!(made.text, "usemtl m{number}");
                material = Some(number as u16);
            }
            _ => {}
        }
        let corners = 3 + (random(&mut state) % 5) as u32;
        // On a parabola, so convex; an arrow is the exception whose second corner is pushed in.
        let arrow = corners == 4 && random(&mut state).is_multiple_of(2);
        for k in 0..corners {
            let (x, y) = match (arrow, k) {
                (true, 1) => (1.0, 7.0),
                (true, 3) => (1.0, 9.0),
                _ => (f64::from(k), f64::from(k * k)),
            };
            let _ = writeln!(made.text, "v {x} {y} {}\nvt {x} 0.5\nvn 0 0 1", f64::from(vertices) * 0.25);
        }
        made.text.push('f');
        for k in 0..corners {
            let index = match random(&mut state).is_multiple_of(2) {
                true => i64::from(k) - i64::from(corners),
                false => i64::from(vertices + k + 1),
            };
            let _ = write!(made.text, " {index}/{index}/{index}");
        }
        made.text.push('\n');
        let cut = match (arrow, corners) {
            (true, _) => vec![[1, 2, 3], [0, 1, 3]],
            _ => (1..corners - 1).map(|k| [0, k, k + 1]).collect(),
        };
        for tri in cut {
            let at = tri.map(|k| vertices + k);
            made.triangles.push(MeshTri { position: at, normal: Some(at), uv: Some(at), material });
        }
        vertices += corners;
    }
    made
}

const LIBRARY: &[u8] = b"newmtl m0\nKd 1 0 0\nnewmtl m1\nKd 0 1 0\nnewmtl m2\nKd 0 0 1\n";

#[test]
fn triangles_are_numbered_in_file_order_over_groups_and_materials() {
    let scratch = Scratch::new();
    scratch.write("m.mtl", LIBRARY);
    for seed in 0..20 {
        let made = made(seed);
        for end in ["\n", "\r", "\r\n"] {
            let mesh = load(&scratch.write("a.obj", made.text.replace('\n', end).as_bytes())).unwrap();
            assert_eq!(mesh.triangles, made.triangles, "seed {seed}");
            assert!(mesh.warnings.is_empty(), "seed {seed}: {:?}", mesh.warnings);
        }
    }
}

#[test]
fn materials_follow_the_order_of_their_first_definition() {
    let scratch = Scratch::new();
    scratch.write("m.mtl", b"newmtl zinc\nnewmtl ash\n");
    scratch.write("n.mtl", b"newmtl oak\nnewmtl zinc\nNs 5\n");
    let text = "mtllib m.mtl n.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl oak\nf 1 2 3\nusemtl zinc # best\nf 1 2 3\n";
    let mesh = load(&scratch.write("a.obj", text.as_bytes())).unwrap();
    let names: Vec<_> = mesh.materials.iter().map(|m| (m.name.as_str(), m.ns)).collect();
    assert_eq!(names, [("zinc", Some(5.0)), ("ash", None), ("oak", None)]);
    assert_eq!(mesh.triangles.iter().map(|tri| tri.material).collect::<Vec<_>>(), [None, Some(2), Some(0)]);
    assert_eq!(mesh.warnings.len(), 1, "{:?}", mesh.warnings);
}

/// Corner positions, texture coordinates and normals of every triangle, as bits.
type Soup = Vec<[[u32; 8]; 3]>;

fn soup(mesh: &Mesh) -> Soup {
    let corner = |tri: &MeshTri, k: usize| {
        let at = mesh.positions[tri.position[k] as usize];
        let uv = tri.uv.map_or([0.0; 2], |uv| mesh.uvs[uv[k] as usize].to_array());
        let normal = tri.normal.map_or(GzCoord::ZERO, |normal| mesh.normals[normal[k] as usize]);
        [at.x, at.y, at.z, uv[0], uv[1], normal.x, normal.y, normal.z].map(f32::to_bits)
    };
    mesh.triangles.iter().map(|tri| [0, 1, 2].map(|k| corner(tri, k))).collect()
}

fn soup_by_tobj(text: &str) -> Soup {
    let options = tobj::LoadOptions { triangulate: true, ignore_lines: true, ignore_points: true, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| tobj::load_mtl_buf(&mut &b""[..])).unwrap();
    let mut soup = Vec::new();
    for tobj::Mesh { positions, texcoords, normals, indices, texcoord_indices, normal_indices, .. } in
        models.into_iter().map(|model| model.mesh)
    {
        let corner = |k: usize| {
            let (p, t, n) = (indices[k] as usize, texcoord_indices[k] as usize, normal_indices[k] as usize);
            let (p, t, n) = (&positions[3 * p..], &texcoords[2 * t..], &normals[3 * n..]);
            [p[0], p[1], p[2], t[0], t[1], n[0], n[1], n[2]].map(f32::to_bits)
        };
        soup.extend((0..indices.len() / 3).map(|tri| [0, 1, 2].map(|k| corner(3 * tri + k))));
    }
    soup
}

#[test]
fn files_that_tobj_reads_well_give_the_same_triangles_to_the_bit() {
    let mut state = 4;
    for _ in 0..20 {
        let mut text = String::new();
        let mut number = || random(&mut state) as i64 as f64 / 2f64.powi(60);
        for _ in 0..40 {
            let _ = writeln!(text, "v {} {:.3} {:e}\nvt {} {}\nvn 0 -0.6 0.8", number(), number(), number(), number(), number());
        }
        for _ in 0..100 {
            let corner = |index: u64| format!("{0}/{0}/{0}", index % 40 + 1);
            let [a, b, c] = [0; 3].map(|_| corner(random(&mut state)));
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        let mesh = parse(Path::new("nowhere/t.obj"), text.as_bytes()).unwrap();
        assert_eq!(soup(&mesh), soup_by_tobj(&text));
    }
}

#[test]
fn random_changes_never_panic_and_leave_indices_in_range() {
    let seed = made(1).text;
    let mut state = 77;
    let mut read = 0;
    for _ in 0..3000 {
        let bytes = mutated(seed.as_bytes(), b"0123456789./-+ \t\r\nvtnfgo\\#,e", &mut state);
        let Ok(mesh) = parse(Path::new("nowhere/t.obj"), &bytes) else { continue };
        read += 1;
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
        for tri in &mesh.triangles {
            assert!(tri.position.iter().all(|&k| (k as usize) < mesh.positions.len()));
            assert!(tri.uv.iter().flatten().all(|&k| (k as usize) < mesh.uvs.len()));
            assert!(tri.normal.iter().flatten().all(|&k| (k as usize) < mesh.normals.len()));
        }
    }
    assert!((300..3000).contains(&read), "{read} of 3000 were still meshes");
}

#[test]
fn random_changes_of_a_library_never_panic() {
    let seed = b"# x\nnewmtl a b\nKa 1 1 1\nKd .5\nKs 0 0 1\nNs 10\nNi 1.5\n\
                 Tf 1 1 0\nillum 7\nmap_Kd -s 1 1 1 t.png\nnewmtl c\nd 0.5\nKe 1 1 1\n";
    let mut state = 99;
    let mut read = 0;
    for _ in 0..4000 {
        let bytes = mutated(seed, b"0123456789.-+ \t\r\nnewmtlKdNsiT/\\#,", &mut state);
        let mut materials = Materials::default();
        if mtl::read(Path::new("d/a.mtl"), Path::new("d"), &bytes, &mut materials, &mut Vec::new()).is_ok() {
            assert!(materials.list.iter().flat_map(|m| m.kd).flatten().all(f32::is_finite));
            assert_eq!(materials.list.len(), materials.numbers.len());
            read += 1;
        }
    }
    assert!((300..4000).contains(&read), "{read} of 4000 were still libraries");
}
