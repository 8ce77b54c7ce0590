//! Normals for meshes whose files have none.

use crate::mesh::{Mesh, MeshTri};
use glam::DVec3;
use gz_core::GzCoord;

/// A sum of unit face normals weighted by angles below this has no direction: only rounding is left of faces that cancel.
const NO_DIRECTION: f64 = 1e-12;

impl Mesh {
    /// Gives every triangle without normals smooth ones; triangles that have normals keep them.
    ///
    /// At each place, which may be several vertices of equal coordinates, the unit normals of the faces there are summed,
    /// weighted by their angle at that corner, so that how a polygon was cut does not matter. Only triangles without normals are
    /// summed, in their order and in f64, with the side that their winding gives. Triangles without area add nothing. Where
    /// nothing or no direction is left, the corner gets its face normal; a triangle without area then gets (0, 0, 1).
    ///
    /// Source: G. Thürmer and C. A. Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets".
    pub fn compute_smooth_normals(&mut self) {
        if self.triangles.iter().all(|tri| tri.normal.is_some()) {
            return;
        }
        let place = places(&self.positions);
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for tri in self.triangles.iter().filter(|tri| tri.normal.is_none()) {
            let corners = corners(&self.positions, tri);
            let Some(face) = face_normal(corners) else { continue };
            for k in 0..3 {
                let (along, back) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
                let angle = libm::atan2(along.cross(back).length(), along.dot(back));
                sums[place[tri.position[k] as usize] as usize] += face * angle;
            }
        }
        // The number of each place's normal, once it has one.
        let mut numbers: Vec<Option<u32>> = vec![None; self.positions.len()];
        for tri in self.triangles.iter_mut().filter(|tri| tri.normal.is_none()) {
            let face = face_normal(corners(&self.positions, tri)).unwrap_or(DVec3::Z);
            tri.normal = Some(tri.position.map(|vertex| {
                let at = place[vertex as usize] as usize;
                if sums[at].length() <= NO_DIRECTION {
                    return append(&mut self.normals, face);
                }
                *numbers[at].get_or_insert_with(|| append(&mut self.normals, sums[at].normalize()))
            }));
        }
    }

    /// Gives every triangle its face normal, (b - a) x (c - a) made unit length, at all corners, in place of what it had; (0, 0,
    /// 1) where it has no area.
    pub fn compute_flat_normals(&mut self) {
        self.clear_normals();
        self.normals.reserve_exact(self.triangles.len());
        for tri in &mut self.triangles {
            let face = face_normal(corners(&self.positions, tri)).unwrap_or(DVec3::Z);
            tri.normal = Some([append(&mut self.normals, face); 3]);
        }
    }

    /// Forgets all normals, so that [`Self::compute_smooth_normals`] makes them anew.
    pub fn clear_normals(&mut self) {
        self.normals = Vec::new();
        self.triangles.iter_mut().for_each(|tri| tri.normal = None);
    }
}

fn append(normals: &mut Vec<GzCoord>, normal: DVec3) -> u32 {
    normals.push(normal.as_vec3());
    normals.len() as u32 - 1
}

fn corners(positions: &[GzCoord], tri: &MeshTri) -> [DVec3; 3] {
    tri.position.map(|k| positions[k as usize].as_dvec3())
}

/// The unit face normal; `None` without area.
fn face_normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    (b - a).cross(c - a).try_normalize()
}

/// For each vertex the first vertex of equal coordinates, 0 and -0 being equal.
fn places(positions: &[GzCoord]) -> Vec<u32> {
    // Adding 0 turns -0 into 0.
    let key = |k: u32| (positions[k as usize] + GzCoord::ZERO).to_array().map(f32::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by_key(|&k| (key(k), k));
    let mut first = vec![0; positions.len()];
    for equal in order.chunk_by(|&a, &b| key(a) == key(b)) {
        equal.iter().for_each(|&k| first[k as usize] = equal[0]);
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Mesh {
        let tri = |&position: &[u32; 3]| MeshTri { position, normal: None, uv: None, material: None };
        Mesh {
            positions: positions.iter().map(|&p| p.into()).collect(),
            triangles: triangles.iter().map(tri).collect(),
            ..Mesh::default()
        }
    }

    fn normal(mesh: &Mesh, tri: usize, corner: usize) -> GzCoord {
        mesh.normals[mesh.triangles[tri].normal.unwrap()[corner] as usize]
    }

    /// A cube of side 2 around the origin, each square cut along one diagonal or the other by `cut`.
    fn cube(cut: u32) -> Mesh {
        let corners: Vec<[f32; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|bit| bit as f32 * 2.0 - 1.0)).collect();
        let squares = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let mut triangles = Vec::new();
        for (number, [a, b, c, d]) in squares.into_iter().enumerate() {
            match cut >> number & 1 {
                0 => triangles.extend([[a, b, c], [a, c, d]]),
                _ => triangles.extend([[a, b, d], [b, c, d]]),
            }
        }
        mesh(&corners, &triangles)
    }

    #[test]
    fn a_cube_has_its_diagonals_however_its_squares_are_cut() {
        for cut in 0..64 {
            let mut mesh = cube(cut);
            mesh.compute_smooth_normals();
            assert_eq!(mesh.normals.len(), 8);
            for (number, tri) in mesh.triangles.iter().enumerate() {
                for corner in 0..3 {
                    let outward = mesh.positions[tri.position[corner] as usize].normalize();
                    assert!(normal(&mesh, number, corner).distance(outward) < 1e-6, "cut {cut}, triangle {number}");
                }
            }
        }
    }

    #[test]
    fn vertices_of_equal_coordinates_share_a_normal_and_zero_has_no_sign() {
        let roof = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, -1.0], [-0.0, 0.0, 0.0], [0.0, 1.0, -0.0], [1.0, 0.0, -1.0]];
        let mut mesh = mesh(&roof, &[[0, 1, 2], [3, 5, 4]]);
        mesh.compute_smooth_normals();
        assert_eq!(mesh.triangles[0].normal.unwrap()[..2], [0, 1]);
        assert_eq!(mesh.triangles[1].normal.unwrap()[0], 0);
        assert!(normal(&mesh, 1, 0).distance(GzCoord::Z) < 1e-6);
    }

    #[test]
    fn given_normals_are_kept_and_do_not_count() {
        let mut mesh = mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &[[0, 1, 2], [0, 2, 3]]);
        mesh.normals = vec![GzCoord::Y];
        mesh.triangles[0].normal = Some([0; 3]);
        mesh.compute_smooth_normals();
        assert_eq!((normal(&mesh, 0, 0), normal(&mesh, 1, 0), mesh.normals.len()), (GzCoord::Y, GzCoord::X, 4));
    }

    #[test]
    fn faces_that_cancel_get_face_normals_and_points_get_z() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [7.0; 3]];
        let mut mesh = mesh(&positions, &[[0, 1, 2], [0, 2, 1], [3, 3, 3]]);
        mesh.compute_smooth_normals();
        assert_eq!([0, 1, 2].map(|tri| normal(&mesh, tri, 1)), [-GzCoord::Y, GzCoord::Y, GzCoord::Z]);
    }

    #[test]
    fn a_sliver_of_no_area_takes_the_normals_of_its_neighbours() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.0, 0.0]];
        let mut mesh = mesh(&positions, &[[0, 1, 3], [0, 1, 2]]);
        mesh.compute_smooth_normals();
        assert_eq!([0, 1].map(|corner| normal(&mesh, 0, corner)), [-GzCoord::Y; 2]);
        assert_eq!(normal(&mesh, 0, 2), GzCoord::Z);
    }

    #[test]
    fn flat_normals_replace_what_was_there() {
        let mut mesh = cube(0);
        mesh.compute_smooth_normals();
        mesh.compute_flat_normals();
        assert_eq!((mesh.normals.len(), normal(&mesh, 0, 0), normal(&mesh, 11, 2)), (12, -GzCoord::X, GzCoord::Z));
    }

    #[test]
    fn huge_and_tiny_meshes_have_normals() {
        for scale in [1e-38, 1e38] {
            let mut mesh = mesh(&[[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]], &[[0, 1, 2]]);
            mesh.compute_smooth_normals();
            assert_eq!(normal(&mesh, 0, 2), GzCoord::Z, "{scale}");
        }
    }
}
