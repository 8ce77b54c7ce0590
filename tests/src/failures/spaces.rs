//! Mixed spaces: triangles in image space, as the course's cameras have them, lit by something left in world space.

use super::{Failure, Shot, shadows, shot};
use gz_app::error::AppError;
use gz_app::load::Overrides;
use gz_bsp::BspTree;
use gz_core::{CameraModel, GzTri, TriBuffer};
use gz_shade::{Scene, SceneNeeds};

/// Lights whose directions were never taken to image space.
///
/// # Errors
///
/// If the scene cannot be loaded.
pub fn lights_in_world_space(width: u32) -> Result<Failure, AppError> {
    let ((world, _), (image, needs)) = both_spaces(width)?;
    let mut mixed = image.clone();
    mixed.lights = world.lights;
    Ok(Failure {
        name: "lights-in-world-space",
        why: "Triangles are in image space and the lights' directions were left in world space: light and shadows come from elsewhere, and \
              turn with the camera.",
        wrong: seen("triangles in image space, lights in world space", &mixed, needs),
        cure: seen("both in image space", &image, needs),
    })
}

/// Normals that were never taken to image space.
///
/// # Errors
///
/// If the scene cannot be loaded.
pub fn normals_in_world_space(width: u32) -> Result<Failure, AppError> {
    let ((world, _), (image, needs)) = both_spaces(width)?;
    let mut mixed = image.clone();
    mixed.tris = with_normals_of(&image.tris, &world.tris)?;
    Ok(Failure {
        name: "normals-in-world-space",
        why: "Positions were taken to image space and normals were not: each surface is shaded as if it faced another way, while shadows, \
              which know positions alone, stay where they are.",
        wrong: seen("positions in image space, normals in world space", &mixed, needs),
        cure: seen("both in image space", &image, needs),
    })
}

type Placed = (Scene, SceneNeeds);

/// The scene `shadows` traced in world space and in image space, the latter through the paper's camera.
fn both_spaces(width: u32) -> Result<(Placed, Placed), AppError> {
    // The paper's camera has one field of view for both axes: a square picture.
    let of = |camera| shadows(&Overrides { size: Some((width, width)), camera: Some(camera), ..Overrides::NONE });
    Ok((of(CameraModel::Pinhole)?, of(CameraModel::Paper)?))
}

/// The triangles of one buffer with the normals of the other, which has the same triangles in another space.
fn with_normals_of(tris: &TriBuffer, other: &TriBuffer) -> Result<TriBuffer, AppError> {
    let mut mixed = TriBuffer::with_attributes(tris.attributes(), tris.len());
    for id in 0..tris.len() as u32 {
        let normals = other.normals(id).copied().unwrap_or_default();
        let tri = GzTri {
            positions: *tris.position(id),
            normals,
            material: tris.material(id),
            class: tris.class(id),
            ..GzTri::default()
        };
        mixed.push(&tri).map_err(|error| AppError::Usage(format!("mixed spaces: {error}")))?;
    }
    Ok(mixed)
}

fn seen(caption: &str, scene: &Scene, needs: SceneNeeds) -> Shot {
    shot(caption, scene, needs, &BspTree::build(&scene.tris))
}
