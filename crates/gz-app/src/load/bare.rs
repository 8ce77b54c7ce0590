//! A mesh without a scene: framed, lit, ready to look at.

use super::draft::{Draft, Surroundings, assemble};
use super::entries::load_mesh;
use super::lights::direction_in_shading_space;
use super::own_material::own_materials;
use super::part::{Part, PartMaterials, unit};
use super::settings::{DEFAULT_FOV, Overrides, default_size, holds};
use super::surfaces::Palette;
use super::words::{LightSpace, Mode, NormalsRule};
use crate::error::LoadError;
use crate::mesh::Mesh;
use glam::DVec3;
use gz_core::{Bounds, CameraModel, CameraSpec, GzCamera, GzColor, GzMatrix, View};
use gz_shade::{Background, GzLight, LightKind, Surface};
use std::collections::BTreeMap;
use std::path::Path;

/// From the mesh towards the eye: a little from above, a little from the right.
const TOWARDS_EYE: DVec3 = DVec3::new(1.0, 0.6, 1.4);

/// How much of the picture's shorter side the mesh's bounding sphere fills.
const FILL: f64 = 0.9;

/// The light that models the mesh: warm, from above the eye's left.
const KEY_LIGHT: (DVec3, GzColor) = (DVec3::new(-0.4, 1.0, 1.2), GzColor::new(0.95, 0.92, 0.86));

/// Softens the shadows of the key light: cool and weak, from the eye's right.
const FILL_LIGHT: (DVec3, GzColor) = (DVec3::new(1.6, 0.3, 0.4), GzColor::new(0.24, 0.27, 0.33));

/// Parts the mesh from the background: from behind and above.
const RIM_LIGHT: (DVec3, GzColor) = (DVec3::new(-0.6, 0.9, -1.3), GzColor::new(0.36, 0.38, 0.42));

/// A neutral backdrop, darker below.
const BACKDROP: Background = Background::Gradient { bottom: GzColor::new(0.10, 0.11, 0.13), top: GzColor::new(0.62, 0.68, 0.76) };

/// Reads a bare mesh as a scene of its own, in model space, which is world space here.
///
/// The camera looks at the middle of the mesh's box from normalise(1, 0.6, 1.4) with a field of view of 35 degrees, so far away
/// that the bounding sphere around that middle fills 90% of the picture's shorter side. Under the screen camera the coordinates are
/// taken as pixels, as the course's HW2 data are.
pub(super) fn scene(path: &Path, overrides: &Overrides) -> Result<Draft, LoadError> {
    let mut mesh = load_mesh(path, || LoadError::bad(path, None, "not a mesh: .obj and .asc can be read"))?;
    let mut warnings = std::mem::take(&mut mesh.warnings);
    let bad = |why: String| LoadError::bad(path, None, why);

    let model = overrides.camera.unwrap_or(CameraModel::Pinhole);
    let (width, height) = overrides.size.unwrap_or(default_size(model));
    let view = if model == CameraModel::Screen { None } else { Some(frame(&mesh, model, width, height)) };
    // Without pixels there is no view to judge; the camera refuses that below.
    if width > 0 && height > 0 && view.is_some_and(|view| !holds(view.position) || !holds(view.look_at)) {
        return Err(bad(
            "the mesh is too large or too small to be framed: rays start at coordinates of 0 or 2^-150 to 2^128, the camera would not".to_owned()
        ));
    }
    let camera = GzCamera::new(CameraSpec { model, view, width, height }).map_err(|error| bad(error.to_string()))?;
    let mode = Mode::of(model);
    let rules = overrides.applied_to(mode.rules(), path)?;

    let lights = [KEY_LIGHT, FILL_LIGHT, RIM_LIGHT].map(|(toward, color)| GzLight {
        kind: LightKind::Directional(direction_in_shading_space(&camera, toward, LightSpace::World)),
        color,
    });
    let mut palette = Palette::new(mode);
    let by_mesh = own_materials(&mut palette, &mesh, path, &mut warnings)?;
    let fallback = palette.fallback(Surface::Shaded).map_err(bad)?;
    let part = Part {
        mesh,
        path: path.to_owned(),
        line: None,
        label: path.display().to_string(),
        world_from_model: GzMatrix::IDENTITY,
        normals: NormalsRule::File,
        crease: None,
        materials: PartMaterials::Own { by_mesh, fallback },
        app_color: None,
        changes: BTreeMap::new(),
    };
    let lights = lights.to_vec();
    let around = Surroundings { camera, lights, ambient: GzColor::ONE, background: BACKDROP, rules };
    assemble(path, around, vec![part], palette, warnings)
}

/// The view that shows the whole mesh.
fn frame(mesh: &Mesh, model: CameraModel, width: u32, height: u32) -> View {
    let used = || mesh.triangles.iter().flat_map(|tri| tri.position).map(|k| mesh.positions[k as usize]);
    let bounds = Bounds::of(used());
    // A mesh without triangles is refused later, with its own message.
    let look_at = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre().as_dvec3() };
    let squared = used().map(|p| (p.as_dvec3() - look_at).length_squared()).fold(0.0, f64::max);
    // A mesh that is one point has no size; any distance shows it.
    let radius = if squared > 0.0 { squared.sqrt() } else { 1.0 };

    let towards_eye = unit(TOWARDS_EYE).unwrap_or(DVec3::Z);
    let view = |distance: f64| View { position: look_at + towards_eye * distance, look_at, up: DVec3::Y, fov: DEFAULT_FOV };
    // The sphere's outline is a cone with sine radius / distance. Its tangent is FILL times that of half the shorter side.
    let focal = GzCamera::new(CameraSpec { model, view: Some(view(radius)), width, height })
        .map_or(1.0, |camera| camera.focal_distance());
    let square = model != CameraModel::Pinhole;
    let shorter = if square { 1.0 } else { (f64::from(width) / f64::from(height.max(1))).min(1.0) };
    let tangent = FILL * shorter / focal;
    view(radius * (1.0 + tangent * tangent).sqrt() / tangent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MeshTri;
    use glam::DVec2;
    use gz_core::GzCoord;

    /// An octahedron: its corners lie on the bounding sphere.
    fn octahedron(centre: GzCoord, radius: f32) -> Mesh {
        let axes = [GzCoord::X, GzCoord::Y, GzCoord::Z];
        let positions = axes.iter().flat_map(|&a| [centre + a * radius, centre - a * radius]).collect();
        let tri = |position| MeshTri { position, normal: None, uv: None, material: None };
        Mesh { positions, triangles: vec![tri([0, 2, 4]), tri([1, 3, 5])], ..Mesh::default() }
    }

    #[test]
    fn bounding_sphere_fills_ninety_percent_of_the_shorter_side() {
        let centre = GzCoord::new(10.0, -3.0, 7.0);
        for (width, height) in [(800, 600), (300, 900), (64, 64)] {
            let view = frame(&octahedron(centre, 2.0), CameraModel::Pinhole, width, height);
            assert_eq!(view.look_at, centre.as_dvec3());
            let spec = CameraSpec { model: CameraModel::Pinhole, view: Some(view), width, height };
            let camera = GzCamera::new(spec).unwrap();
            // A ray 45% of the shorter side from the middle grazes the sphere.
            let (w, h) = (f64::from(width), f64::from(height));
            let reach = 0.45 * w.min(h);
            for edge in [DVec2::new(reach, 0.0), DVec2::new(0.0, -reach)] {
                let ray = camera.ray(0, 0, DVec2::new(w, h) / 2.0 - DVec2::splat(0.5) + edge);
                let to_centre = centre.as_dvec3() - ray.origin;
                let along = ray.direction.as_dvec3().normalize();
                let passes = (to_centre - along * to_centre.dot(along)).length();
                assert!((passes - 2.0).abs() < 1e-4, "{width} x {height}: {passes}");
            }
        }
    }

    #[test]
    fn a_single_point_is_framed_without_dividing_by_zero() {
        let view = frame(&octahedron(GzCoord::ONE, 0.0), CameraModel::Pinhole, 10, 10);
        assert!(view.position.is_finite() && view.position != view.look_at);
    }
}
