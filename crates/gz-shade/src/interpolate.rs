//! What varies over a triangle, at the point of a hit: normals, colours, texture coordinates.

use crate::{Interpolate, SceneNeeds};
use glam::DVec3;
use gz_core::{GzColor, GzCoord, GzTextureIndex, SurfacePoint, TriBuffer, TriId};

/// Corner normals are unit vectors of f32: what cancels to below 1e-6 of their length, squared here, is rounding, without a direction.
pub(crate) const LEAST_SQUARE: f64 = 1e-12;

/// The side of a triangle that is outside: 1 where the normal of the winding points, -1 on the other.
///
/// Outside is where the corner normals point, or the winding where there are none: course data does not wind consistently. `at` is a point
/// of the triangle, here and below.
pub(crate) fn outside(tris: &TriBuffer, needs: SceneNeeds, tri: TriId, at: &SurfacePoint) -> i8 {
    let Some(normals) = corner_normals(tris, needs, tri) else { return 1 };
    match at.side_of(tris.position(tri), normals[0] + normals[1] + normals[2]) {
        0 => 1,
        side => side,
    }
}

/// The unit face normal on the outer side.
fn flat_normal(tris: &TriBuffer, needs: SceneNeeds, tri: TriId, at: &SurfacePoint) -> DVec3 {
    at.normal * f64::from(outside(tris, needs, tri, at))
}

/// The unit normal at a point of a triangle, as `interpolate` makes it. Flat: the face normal on the outer side. Otherwise the sum of
/// corner normals by `weights`; where that vanishes (opposite corner normals, or none at all) the face normal again.
pub(crate) fn normal(
    tris: &TriBuffer,
    needs: SceneNeeds,
    tri: TriId,
    at: &SurfacePoint,
    interpolate: Interpolate,
    weights: [f64; 3],
) -> DVec3 {
    match (interpolate, corner_normals(tris, needs, tri)) {
        (Interpolate::Gouraud | Interpolate::Phong, Some(normals)) => {
            let [a, b, c] = normals.map(|n| n.as_dvec3());
            let sum = a * weights[0] + b * weights[1] + c * weights[2];
            if sum.length_squared() > LEAST_SQUARE { sum.normalize() } else { flat_normal(tris, needs, tri, at) }
        }
        _ => flat_normal(tris, needs, tri, at),
    }
}

/// Unit normals at the corners, for colours shaded there; the face normal where a corner has none.
pub(crate) fn normals_at_corners(tris: &TriBuffer, needs: SceneNeeds, tri: TriId, at: &SurfacePoint) -> [DVec3; 3] {
    let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    corners.map(|weights| normal(tris, needs, tri, at, Interpolate::Phong, weights))
}

/// Corner colours at a point.
pub(crate) fn color(corners: [GzColor; 3], weights: [f64; 3]) -> GzColor {
    let [a, b, c] = corners.map(|color| color.as_dvec3());
    (a * weights[0] + b * weights[1] + c * weights[2]).as_vec3()
}

/// Texture coordinates at a point: linear on the triangle, which is what perspective correction restores in screen space. (0, 0)
/// where a buffer keeps none.
pub(crate) fn uv(tris: &TriBuffer, tri: TriId, weights: [f64; 3]) -> GzTextureIndex {
    let Some(uvs) = tris.uvs(tri) else { return GzTextureIndex::ZERO };
    let [a, b, c] = uvs.map(|uv| uv.as_dvec2());
    (a * weights[0] + b * weights[1] + c * weights[2]).as_vec2()
}

/// Normals that the scene needs and the buffer keeps.
pub(crate) fn corner_normals(tris: &TriBuffer, needs: SceneNeeds, tri: TriId) -> Option<&[GzCoord; 3]> {
    tris.normals(tri).filter(|_| needs.smooth_normals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::{Attributes, GzRay, GzTri};

    const CORNERS: [GzCoord; 3] = [GzCoord::ZERO, GzCoord::X, GzCoord::Y]; // winds around +z

    fn buffer(normals: [GzCoord; 3]) -> TriBuffer {
        let mut tris = TriBuffer::with_attributes(Attributes::ALL, 1);
        let uvs = [[0.1, 0.7], [1.0, 0.3], [0.25, 1e-9]].map(GzTextureIndex::from_array);
        tris.push(&GzTri { positions: CORNERS, normals, uvs, ..GzTri::default() }).unwrap();
        tris
    }

    /// A point of the triangle.
    fn at() -> SurfacePoint {
        SurfacePoint::of(&GzRay::new(GzCoord::new(0.25, 0.5, -3.0), GzCoord::Z), &CORNERS, false)
    }

    #[test]
    fn i1_a_corner_has_its_own_texture_coordinate_to_the_bit() {
        let tris = buffer([GzCoord::Z; 3]);
        for k in 0..3 {
            let mut weights = [0.0; 3];
            weights[k] = 1.0;
            assert_eq!(uv(&tris, 0, weights), tris.uvs(0).unwrap()[k]);
        }
        assert_eq!(uv(&TriBuffer::from_indexed(&CORNERS, &[[0, 1, 2]]).unwrap(), 0, [1.0, 0.0, 0.0]), GzTextureIndex::ZERO);
    }

    #[test]
    fn flat_is_the_face_normal_on_the_side_of_the_corner_normals() {
        let leaning = GzCoord::new(0.6, 0.0, -0.8);
        let tris = buffer([leaning; 3]);
        assert_eq!(normal(&tris, SceneNeeds::ALL, 0, &at(), Interpolate::Flat, [1.0, 0.0, 0.0]), DVec3::NEG_Z);
        assert_eq!(outside(&tris, SceneNeeds::ALL, 0, &at()), -1);
        // Without corner normals the winding decides.
        let bare = TriBuffer::from_indexed(&CORNERS, &[[0, 1, 2]]).unwrap();
        assert_eq!(normal(&bare, SceneNeeds::ALL, 0, &at(), Interpolate::Phong, [1.0, 0.0, 0.0]), DVec3::Z);
    }

    #[test]
    fn phong_normals_are_the_weighted_sum_at_length_one() {
        let tris = buffer([GzCoord::X, GzCoord::Y, GzCoord::Z]);
        let n = normal(&tris, SceneNeeds::ALL, 0, &at(), Interpolate::Phong, [0.5, 0.5, 0.0]);
        assert!((n - DVec3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0)).length() < 1e-15);
        assert_eq!(normals_at_corners(&tris, SceneNeeds::ALL, 0, &at()), [DVec3::X, DVec3::Y, DVec3::Z]);
    }

    #[test]
    fn i4_opposite_normals_fall_back_to_the_face() {
        let tris = buffer([GzCoord::X, GzCoord::NEG_X, GzCoord::Z]);
        assert_eq!(normal(&tris, SceneNeeds::ALL, 0, &at(), Interpolate::Phong, [0.5, 0.5, 0.0]), DVec3::Z);
        let none = buffer([GzCoord::ZERO; 3]);
        assert_eq!(normals_at_corners(&none, SceneNeeds::ALL, 0, &at()), [DVec3::Z; 3]);
    }
}
