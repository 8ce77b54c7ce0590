//! One mesh of a scene with all that the scene says about it, before its triangles are placed.

use super::words::NormalsRule;
use crate::error::LoadError;
use crate::mesh::Mesh;
use glam::DVec3;
use gz_core::{CameraModel, GzCamera, GzColor, GzCoord, GzMatrix, MaterialId};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A mesh and what the scene says about it.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) mesh: Mesh,
    /// The file and line to name when something is wrong with this mesh in its scene.
    pub(super) path: PathBuf,
    pub(super) line: Option<usize>,
    /// What the mesh is called in warnings.
    pub(super) label: String,
    pub(super) world_from_model: GzMatrix,
    pub(super) normals: NormalsRule,
    /// Degrees, 0 to 180; `None` where the scene does not say.
    pub(super) crease: Option<f64>,
    pub(super) materials: PartMaterials,
    pub(super) app_color: Option<AppColor>,
    /// Triangles that the scene changes, by their number in this mesh.
    pub(super) changes: BTreeMap<usize, Change>,
}

/// Which materials the triangles of a part have.
#[derive(Clone, Debug)]
pub(super) enum PartMaterials {
    /// The one that the scene names.
    Given(MaterialId),
    /// Those of the mesh file, and for triangles without one the fallback.
    Own { by_mesh: Vec<Option<MaterialId>>, fallback: MaterialId },
}

/// How the application colours triangles in HW2 and HW3: by their first corner's normal as the file has it, in model space.
#[derive(Clone, Copy, Debug)]
pub(super) struct AppColor {
    pub(super) direction: DVec3,
    pub(super) color: GzColor,
}

/// What the scene changes about one triangle. Vertices and normal are in image space.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    pub(super) image_vertices: Option<[GzCoord; 3]>,
    pub(super) normal: Option<DVec3>,
    pub(super) material: Option<MaterialId>,
}

impl Part {
    /// An error about this mesh.
    pub(super) fn error(&self, message: impl Into<String>) -> LoadError {
        LoadError::bad(&self.path, self.line, message)
    }

    /// The material of a triangle, in the numbering of the scene's palette.
    pub(super) fn material(&self, tri: usize) -> MaterialId {
        if let Some(material) = self.changes.get(&tri).and_then(|change| change.material) {
            return material;
        }
        match &self.materials {
            PartMaterials::Given(id) => *id,
            PartMaterials::Own { by_mesh, fallback } => {
                let own = self.mesh.triangles[tri].material.and_then(|m| by_mesh.get(usize::from(m)).copied().flatten());
                own.unwrap_or(*fallback)
            }
        }
    }

    /// Corners in world space, f64, in file order.
    pub(super) fn world_corners(&self, tri: usize) -> [DVec3; 3] {
        let corners = self.mesh.triangles[tri].position.map(|k| self.mesh.positions[k as usize].as_dvec3());
        if self.world_from_model == GzMatrix::IDENTITY {
            // Not multiplied: 1 * x + 0 * y + 0 * z + 0 would lose the sign of a zero.
            return corners;
        }
        corners.map(|p| self.world_from_model.point(p))
    }

    /// Corners in trace space, rounded once to f32; `None` where the camera model drops the triangle.
    pub(super) fn trace_corners(&self, camera: &GzCamera, tri: usize) -> Option<[GzCoord; 3]> {
        if let Some(corners) = self.changes.get(&tri).and_then(|change| change.image_vertices) {
            return Some(corners);
        }
        let [a, b, c] = self.world_corners(tri).map(|p| camera.trace_from_world(p));
        Some([a?.as_vec3(), b?.as_vec3(), c?.as_vec3()])
    }

    /// Whether `camera` drops this triangle for a corner behind the view plane.
    pub(super) fn is_dropped(&self, camera: &GzCamera, tri: usize) -> bool {
        let drops = matches!(camera.model(), CameraModel::Homework | CameraModel::Screen);
        drops && self.trace_corners(camera, tri).is_none()
    }

    /// The application's colour of a triangle: min(1, |n . direction|) * color with n the first corner's normal as given in the
    /// file, or the face normal where the file has none (HW2 and HW3). Black for a mesh without `app_color`.
    pub(super) fn color(&self, tri: usize) -> GzColor {
        let Some(AppColor { direction, color }) = self.app_color else { return GzColor::ZERO };
        let corners = &self.mesh.triangles[tri];
        let normal = corners.normal.map_or_else(
            || face_normal(corners.position.map(|k| self.mesh.positions[k as usize].as_dvec3())),
            |[first, ..]| self.mesh.normals[first as usize].as_dvec3(),
        );
        color * (normal.dot(direction).abs().min(1.0) as f32)
    }
}

/// The unit vector (b - a) x (c - a); zero for a triangle without area.
pub(super) fn face_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    unit((b - a).cross(c - a)).unwrap_or(DVec3::ZERO)
}

/// `v` at length 1 up to rounding, however long or short it is; `None` when it is zero or not finite.
pub(super) fn unit(v: DVec3) -> Option<DVec3> {
    let greatest = v.abs().max_element();
    if !(greatest > 0.0 && v.is_finite()) {
        return None;
    }
    // Brought near 1 first, so that squares neither overflow nor vanish.
    let v = v / greatest;
    Some(v / (v.x * v.x + v.y * v.y + v.z * v.z).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_holds_for_tiny_and_huge_vectors() {
        for k in [1e-300, 1e-20, 1.0, 1e200] {
            assert_eq!(unit(DVec3::new(3.0, 0.0, -4.0) * k).map(|v| v.as_vec3()), Some(GzCoord::new(0.6, 0.0, -0.8)), "{k}");
        }
        assert_eq!((unit(DVec3::ZERO), unit(DVec3::splat(f64::NAN)), unit(DVec3::X * f64::INFINITY)), (None, None, None));
    }

    #[test]
    fn face_normal_follows_the_winding_and_is_zero_without_area() {
        assert_eq!(face_normal([DVec3::ZERO, DVec3::X, DVec3::Y]), DVec3::Z);
        assert_eq!(face_normal([DVec3::ZERO, DVec3::X, DVec3::X * 2.0]), DVec3::ZERO);
    }
}
