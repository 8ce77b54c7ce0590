//! What holds for every tessellation, and the course's own triangles.

use super::*;
use std::collections::HashMap;

fn bits(p: GzCoord) -> [u32; 3] {
    p.to_array().map(f32::to_bits)
}

fn corners(mesh: &Mesh, tri: &MeshTri) -> [DVec3; 3] {
    tri.position.map(|k| mesh.positions[k as usize].as_dvec3())
}

fn face(mesh: &Mesh, tri: &MeshTri) -> DVec3 {
    let [a, b, c] = corners(mesh, tri);
    (b - a).cross(c - a)
}

/// How often each directed edge occurs, triangles without area left out.
fn edges(mesh: &Mesh) -> HashMap<([u32; 3], [u32; 3]), u32> {
    let mut edges = HashMap::new();
    for tri in &mesh.triangles {
        let p = tri.position.map(|k| bits(mesh.positions[k as usize]));
        for (a, b) in [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])] {
            if p[0] != p[1] && p[1] != p[2] && p[2] != p[0] {
                *edges.entry((a, b)).or_insert(0) += 1;
            }
        }
    }
    edges
}

#[test]
fn counts_indices_and_box_are_as_promised() {
    for (segments, bottom, top) in [(1, true, 3.15), (4, false, 3.0), (9, true, 3.15), (16, false, 3.0), (33, true, 3.15)] {
        let mesh = tessellate(segments, bottom);
        assert_eq!(mesh.triangles.len(), triangle_count(segments, bottom));
        assert_eq!(mesh.triangles.len(), (if bottom { 64 } else { 56 }) * (segments * segments) as usize);
        for tri in &mesh.triangles {
            assert!(tri.position.iter().all(|&k| (k as usize) < mesh.positions.len()));
            assert!(tri.uv.unwrap().iter().all(|&k| (k as usize) < mesh.uvs.len()));
            assert_eq!(tri.normal, Some(tri.position));
        }
        let (low, high) = mesh.positions.iter().fold((GzCoord::MAX, GzCoord::MIN), |(l, h), &p| (l.min(p), h.max(p)));
        // The spout reaches 3.434 at most; a coarse grid steps over its tip. Everything else is reached at patch corners.
        assert_eq!((low, high.y, high.z), (GzCoord::new(-3.0, 0.0, -2.0), top, 2.0), "{segments}");
        assert!(high.x > if segments == 1 { 3.29 } else { 3.4 } && high.x < 3.4341, "{}", high.x);
    }
}

#[test]
fn segments_out_of_range_are_taken_as_the_nearest() {
    assert_eq!(tessellate(0, true).triangles.len(), 64);
    assert_eq!((triangle_count(MAX_SEGMENTS, true), triangle_count(u32::MAX, true)), (10_240_000, 10_240_000));
}

#[test]
fn no_seam_is_open_where_the_model_is_closed() {
    for segments in 1..=20 {
        for (bottom, rings) in [(true, 2), (false, 3)] {
            let edges = edges(&tessellate(segments, bottom));
            let mut open = 0;
            for (&(a, b), &count) in &edges {
                // One segment flattens the halves of handle and spout onto each other.
                assert!(count == 1 || segments == 1, "an edge is used twice in one direction at {segments} segments");
                open += count.saturating_sub(edges.get(&(b, a)).copied().unwrap_or(0));
            }
            // Rings around the axis have four patches, each of the four ends of handle and spout two. One segment flattens those
            // ends to a line there and back, two do so to the loops of the course's lid tip.
            let ends = if segments == 1 { 0 } else { 4 * 2 };
            let loops = if bottom || segments <= 2 { 0 } else { 4 };
            assert_eq!(open, segments * (4 * rings + ends + loops), "{segments} segments, bottom {bottom}");
        }
    }
}

#[test]
fn normals_are_unit_and_on_the_side_of_their_triangles() {
    for (segments, bottom, against) in [(4, false, 16), (8, true, 16), (16, true, 16), (31, true, 16)] {
        let mesh = tessellate(segments, bottom);
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
        let mut found = 0;
        for tri in &mesh.triangles {
            let face = face(&mesh, tri);
            if face.length() > 0.0 {
                let mean = tri.position.iter().map(|&k| mesh.normals[k as usize].as_dvec3()).sum::<DVec3>();
                found += usize::from(face.dot(mean) <= 0.0);
            }
        }
        assert!(found <= against, "{found} triangles wind against their normals at {segments} segments");
    }
}

#[test]
fn body_lid_and_bottom_look_away_from_the_inside() {
    let n = 12u32;
    let mesh = tessellate(n, true);
    let per_patch = ((n + 1) * (n + 1)) as usize;
    let patch = |k: usize| k * per_patch..(k + 1) * per_patch;
    for k in (4..12).flat_map(patch) {
        let (p, normal) = (mesh.positions[k], mesh.normals[k]);
        assert!(p.x * normal.x + p.z * normal.z > 0.0, "{p} {normal}");
    }
    for k in (28..32).flat_map(patch).filter(|&k| mesh.positions[k].y < 0.05) {
        assert!(mesh.normals[k].y < -0.5, "{}", mesh.normals[k]);
    }
    let tips: Vec<_> = (20..24).flat_map(patch).filter(|&k| mesh.positions[k] == GzCoord::new(0.0, 3.15, 0.0)).collect();
    assert_eq!(tips.len(), 4 * (n as usize + 1));
    assert!(tips.iter().all(|&k| (mesh.normals[k] - GzCoord::Y).length() < 1e-6));
    let middle: Vec<_> = (28..32).flat_map(patch).filter(|&k| mesh.positions[k] == GzCoord::ZERO).collect();
    assert_eq!(middle.len(), 4 * (n as usize + 1));
    assert!(middle.iter().all(|&k| (mesh.normals[k] + GzCoord::Y).length() < 1e-6));
}

#[test]
fn normals_beside_the_course_s_lid_tip_look_up_at_the_finest_grid() {
    let weights: Vec<Weights> = (0..=MAX_SEGMENTS).map(|k| Weights::at(k, MAX_SEGMENTS)).collect();
    for k in LID_TIP..LID_TIP + 4 {
        let patch = TeapotPatch::new(k, false);
        for across in &weights {
            let column = patch.column(across, &weights, FOOT);
            assert!(column[..20].iter().all(|(_, normal)| normal.y > 0.9), "patch {k}");
        }
    }
}

/// The course's teapot, if there: for each corner of each triangle x y z, normal, u v.
fn course_triangles() -> Option<Vec<[[f64; 8]; 3]>> {
    let Some(folder) = std::env::var_os("GZ_HW_DATA") else {
        println!("skipped: GZ_HW_DATA is not set");
        return None;
    };
    let text = std::fs::read_to_string(std::path::Path::new(&folder).join("pot4.asc")).expect("GZ_HW_DATA has pot4.asc");
    let words: Vec<&str> = text.split_whitespace().collect();
    let number = |word: &str| word.parse::<f64>().expect("a number");
    let corner = |words: &[&str]| std::array::from_fn(|k| number(words[k]));
    Some(words.chunks_exact(25).map(|tri| std::array::from_fn(|k| corner(&tri[1 + 8 * k..]))).collect())
}

#[test]
fn four_segments_without_bottom_are_the_course_s_own_triangles() {
    let Some(course) = course_triangles() else { return };
    let mesh = tessellate(4, false);
    assert_eq!(course.len(), mesh.triangles.len());
    let mut loops_turned = 0;
    for (k, (theirs, ours)) in course.iter().zip(&mesh.triangles).enumerate() {
        for (c, their) in theirs.iter().enumerate() {
            let [x, y, z, nx, ny, nz, u, v] = *their;
            let p = mesh.positions[ours.position[c] as usize].as_dvec3();
            // The files have six decimals.
            assert!((p - DVec3::new(x, y, z)).abs().max_element() < 1.1e-6, "triangle {k}: {p} {their:?}");
            let uv = mesh.uvs[ours.uv.unwrap()[c] as usize];
            assert_eq!((f64::from(uv.x), f64::from(uv.y)), (u, v), "triangle {k}");
            let normal = mesh.normals[ours.normal.unwrap()[c] as usize].as_dvec3();
            // In the middle of a loop at the lid's tip the course's normal looks down, into the pot.
            if p.y == 3.0 && ny == -1.0 {
                loops_turned += 1;
                assert_eq!(normal, DVec3::Y);
            } else {
                assert!((normal - DVec3::new(nx, ny, nz)).length() < 2e-5, "triangle {k}: {normal} {their:?}");
            }
        }
    }
    assert_eq!(loops_turned, 4 * 3);
    let distinct: std::collections::HashSet<_> = mesh.positions.iter().map(|&p| bits(p)).collect();
    assert_eq!(distinct.len(), 492);
}
