//! Normals for meshes whose files have none.

use crate::mesh::{FLAT, Mesh, MeshTri, UNGROUPED};
use glam::DVec3;
use gz_core::GzCoord;

/// A sum of unit face normals weighted by angles below this has no direction: only rounding is left of faces that cancel.
const NO_DIRECTION: f64 = 1e-12;

/// The crease angle where the scene gives none, in degrees: a cube and a prism of up to eight sides keep their edges, rounder
/// things are smoothed.
const DEFAULT_CREASE: f64 = 45.0;

/// Slack of the cosine of a crease angle, so that rounding does not part faces that lie in one plane.
const SLACK: f64 = 1e-9;

/// Faces on one edge of which each is compared with the next so many. More than two is no surface; this keeps the time linear.
const MOST_ON_AN_EDGE: usize = 8;

impl Mesh {
    /// Gives every triangle without normals smooth ones up to a crease; triangles that have normals keep them.
    ///
    /// Two faces meet smoothly at an edge (vertices of equal coordinates count as one) when the angle between their normals is
    /// at most `crease`, in degrees from 0 to 180, and their smoothing group is the same and not [`FLAT`]. With `None` it is
    /// 45 for faces in no group, while faces of one group meet smoothly at any angle. The corners of a place
    /// that are joined over such edges share one normal: the sum of their unit face normals, weighted by their angle at that
    /// corner, so that how a polygon was cut does not matter. Only triangles without normals are joined and summed, in their
    /// order and in f64, with the side that their winding gives. Triangles without area join nothing and get (0, 0, 1); where no
    /// direction is left the corner gets its face normal.
    ///
    /// The time is that of sorting the triangles.
    ///
    /// Source: G. Thürmer and C. A. Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets".
    pub fn compute_smooth_normals(&mut self, crease: Option<f64>) {
        if self.triangles.iter().all(|tri| tri.normal.is_some()) {
            return;
        }
        let faces: Vec<Option<DVec3>> = self
            .triangles
            .iter()
            .map(|tri| tri.normal.is_none().then(|| face_normal(corners(&self.positions, tri))).flatten())
            .collect();
        let mut joined = self.joined_corners(&faces, crease);
        let clusters = numbered(&mut joined);
        let mut sums = vec![DVec3::ZERO; clusters];
        for (t, (tri, face)) in self.triangles.iter().zip(&faces).enumerate() {
            let Some(face) = face else { continue };
            let corners = corners(&self.positions, tri);
            for k in 0..3 {
                let (along, back) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
                let angle = libm::atan2(along.cross(back).length(), along.dot(back));
                sums[joined[3 * t + k] as usize] += *face * angle;
            }
        }
        // The number of each cluster's normal, once it has one.
        let mut numbers: Vec<Option<u32>> = vec![None; clusters];
        for (t, (tri, face)) in self.triangles.iter_mut().zip(&faces).enumerate().filter(|(_, (tri, _))| tri.normal.is_none()) {
            let face = face.unwrap_or(DVec3::Z);
            tri.normal = Some([0, 1, 2].map(|k| {
                let at = joined[3 * t + k] as usize;
                if sums[at].length() <= NO_DIRECTION {
                    return append(&mut self.normals, face);
                }
                *numbers[at].get_or_insert_with(|| append(&mut self.normals, sums[at].normalize()))
            }));
        }
    }

    /// For each corner (triangle times three plus its place in it) a corner not after it that it is joined with, or itself.
    fn joined_corners(&self, faces: &[Option<DVec3>], crease: Option<f64>) -> Vec<u32> {
        let place = places(&self.positions);
        let at = |corner: u32| place[self.triangles[corner as usize / 3].position[corner as usize % 3] as usize];
        let next = |corner: u32| if corner % 3 == 2 { corner - 2 } else { corner + 1 };
        // An edge is named by the corner that it starts at, and sought at the lower of its two places.
        let ends = |edge: u32| (at(edge).min(at(next(edge))), at(edge).max(at(next(edge))));
        let edges = || (0..3 * faces.len() as u32).filter(|&edge| faces[edge as usize / 3].is_some());
        let mut end_of = vec![0_u32; self.positions.len() + 1];
        edges().for_each(|edge| end_of[ends(edge).0 as usize + 1] += 1);
        (1..end_of.len()).for_each(|k| end_of[k] += end_of[k - 1]);
        let mut sorted = vec![0_u32; end_of[end_of.len() - 1] as usize];
        for edge in edges() {
            let slot = &mut end_of[ends(edge).0 as usize];
            sorted[*slot as usize] = edge;
            *slot += 1;
        }
        let mut parent: Vec<u32> = (0..3 * faces.len() as u32).collect();
        let mut start = 0;
        for end in end_of {
            let here = &mut sorted[start..(end as usize).max(start)];
            start += here.len();
            here.sort_unstable_by_key(|&edge| (ends(edge).1, edge));
            for same in here.chunk_by(|&a, &b| ends(a).1 == ends(b).1) {
                for (k, &a) in same.iter().enumerate() {
                    for &b in same[k + 1..].iter().take(MOST_ON_AN_EDGE) {
                        if a / 3 != b / 3 && self.is_smooth(a as usize / 3, b as usize / 3, faces, crease) {
                            let (b_first, b_second) = if at(a) == at(b) { (b, next(b)) } else { (next(b), b) };
                            join(&mut parent, a, b_first);
                            join(&mut parent, next(a), b_second);
                        }
                    }
                }
            }
        }
        parent
    }

    /// Whether two faces that share an edge meet smoothly there.
    fn is_smooth(&self, a: usize, b: usize, faces: &[Option<DVec3>], crease: Option<f64>) -> bool {
        let group = |tri: usize| self.smoothing.get(tri).copied().unwrap_or(UNGROUPED);
        if group(a) != group(b) || group(a) == FLAT {
            return false;
        }
        let degrees = crease.unwrap_or(if group(a) == UNGROUPED { DEFAULT_CREASE } else { 180.0 });
        let (Some(a), Some(b)) = (faces[a], faces[b]) else { return false };
        a.dot(b) >= libm::cos(degrees.to_radians()) - SLACK
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

/// The first corner that `corner` is joined with. The way there is halved for the next one who asks.
fn root(parent: &mut [u32], mut corner: u32) -> u32 {
    while parent[corner as usize] != corner {
        let above = parent[parent[corner as usize] as usize];
        parent[corner as usize] = above;
        corner = above;
    }
    corner
}

fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// Turns corners joined with others into numbers of clusters, counted in the order of their first corners. Returns how many.
fn numbered(parent: &mut [u32]) -> usize {
    let mut clusters = 0;
    // A corner's parent is not after it, so it has its number already.
    for corner in 0..parent.len() {
        let above = parent[corner] as usize;
        parent[corner] = if above == corner { clusters } else { parent[above] };
        clusters += u32::from(above == corner);
    }
    clusters as usize
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
            mesh.compute_smooth_normals(Some(90.0));
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
        mesh.compute_smooth_normals(Some(180.0));
        assert_eq!(mesh.triangles[0].normal.unwrap()[..2], [0, 1]);
        assert_eq!(mesh.triangles[1].normal.unwrap()[0], 0);
        assert!(normal(&mesh, 1, 0).distance(GzCoord::Z) < 1e-6);
    }

    #[test]
    fn given_normals_are_kept_and_do_not_count() {
        let mut mesh = mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &[[0, 1, 2], [0, 2, 3]]);
        mesh.normals = vec![GzCoord::Y];
        mesh.triangles[0].normal = Some([0; 3]);
        mesh.compute_smooth_normals(None);
        assert_eq!((normal(&mesh, 0, 0), normal(&mesh, 1, 0), mesh.normals.len()), (GzCoord::Y, GzCoord::X, 4));
    }

    #[test]
    fn faces_that_cancel_get_face_normals_and_points_get_z() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [7.0; 3]];
        let mut mesh = mesh(&positions, &[[0, 1, 2], [0, 2, 1], [3, 3, 3]]);
        mesh.compute_smooth_normals(None);
        assert_eq!([0, 1, 2].map(|tri| normal(&mesh, tri, 1)), [-GzCoord::Y, GzCoord::Y, GzCoord::Z]);
    }

    #[test]
    fn a_cube_keeps_its_edges_unless_a_group_or_the_crease_says_otherwise() {
        let squares = |crease, smoothing: &[u32]| {
            let mut mesh = cube(5);
            mesh.smoothing = smoothing.to_vec();
            mesh.compute_smooth_normals(crease);
            let flat = (0..12).filter(|&t| (0..3).all(|k| normal(&mesh, t, k).abs().max_element() == 1.0)).count();
            (flat, mesh.normals.len())
        };
        assert_eq!(squares(None, &[]), (12, 24));
        assert_eq!(squares(Some(89.9), &[]), (12, 24));
        assert_eq!(squares(Some(90.0), &[]), (0, 8));
        assert_eq!(squares(None, &[1; 12]), (0, 8));
        assert_eq!(squares(Some(45.0), &[1; 12]), (12, 24));
        assert_eq!(squares(None, &[UNGROUPED; 12]), (12, 24));
        // Flat: no corner is joined, not even in the plane of a square.
        assert_eq!(squares(Some(180.0), &[FLAT; 12]), (12, 36));
        // The squares at -x and +x in a group of their own keep their normals, those between them are smooth around x.
        let mut groups = [2; 12];
        groups[..4].fill(1);
        assert_eq!(squares(None, &groups), (4, 16));
    }

    #[test]
    fn a_fan_of_many_faces_is_joined_all_around() {
        let count = 100_000_u32;
        let angle = |k: u32| f64::from(k) * std::f64::consts::TAU / f64::from(count);
        let rim = (0..count).map(|k| [libm::cos(angle(k)) as f32, libm::sin(angle(k)) as f32, 0.0]);
        let positions: Vec<[f32; 3]> = [[0.0, 0.0, 1.0]].into_iter().chain(rim).collect();
        let triangles: Vec<[u32; 3]> = (0..count).map(|k| [0, 1 + k, 1 + (k + 1) % count]).collect();
        let mut mesh = mesh(&positions, &triangles);
        mesh.compute_smooth_normals(None);
        assert_eq!(mesh.normals.len(), positions.len());
        assert!(normal(&mesh, 7, 0).distance(GzCoord::Z) < 1e-5);
    }

    #[test]
    fn a_triangle_of_no_area_joins_nothing() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.0, 0.0]];
        let mut mesh = mesh(&positions, &[[0, 1, 3], [0, 1, 2]]);
        mesh.compute_smooth_normals(None);
        assert_eq!([normal(&mesh, 0, 0), normal(&mesh, 1, 0)], [GzCoord::Z, -GzCoord::Y]);
    }

    #[test]
    fn flat_normals_replace_what_was_there() {
        let mut mesh = cube(0);
        mesh.compute_smooth_normals(None);
        mesh.compute_flat_normals();
        assert_eq!((mesh.normals.len(), normal(&mesh, 0, 0), normal(&mesh, 11, 2)), (12, -GzCoord::X, GzCoord::Z));
    }

    #[test]
    fn huge_and_tiny_meshes_have_normals() {
        for scale in [1e-38, 1e38] {
            let mut mesh = mesh(&[[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]], &[[0, 1, 2]]);
            mesh.compute_smooth_normals(None);
            assert_eq!(normal(&mesh, 0, 2), GzCoord::Z, "{scale}");
        }
    }
}
