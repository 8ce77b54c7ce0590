//! `[[light]]`: lights in the space they are written in, taken to shading space.

use super::keys::LightKeys;
use super::part::unit;
use super::settings::Settings;
use super::spot::SceneText;
use super::values::Number;
use super::words::LightSpace;
use crate::error::LoadError;
use glam::DVec3;
use gz_core::{CameraModel, CameraSpec, GzCamera, GzMatrix};
use gz_shade::{Falloff, GzLight, LightKind};
use toml::Spanned;

/// Reads the lights of a scene.
pub(super) fn lights(text: SceneText<'_>, keys: &[Spanned<LightKeys>], set: &Settings) -> Result<Vec<GzLight>, LoadError> {
    keys.iter().map(|light| one(text, light, set)).collect()
}

fn one(text: SceneText<'_>, light: &Spanned<LightKeys>, set: &Settings) -> Result<GzLight, LoadError> {
    let keys = light.get_ref();
    let by_model = if set.written_model == CameraModel::Pinhole { LightSpace::World } else { LightSpace::Image };
    let space = keys.space.map_or(by_model, |word| word.0);
    let kind = match (&keys.direction, &keys.position) {
        (Some(_), Some(position)) => {
            return Err(text.error(position.span(), "a light has a direction or a position, not both"));
        }
        (None, None) => return Err(text.error(light.span(), "a light needs a direction or a position")),
        (Some(direction), None) => {
            if let Some(falloff) = &keys.falloff {
                return Err(text.error(falloff.span(), "falloff belongs to a light with a position"));
            }
            let toward = direction.get_ref().0;
            if toward == DVec3::ZERO {
                return Err(text.error(direction.span(), "a light's direction must not be zero"));
            }
            LightKind::Directional(direction_in_shading_space(&set.camera, toward, space))
        }
        (None, Some(position)) => {
            if set.camera.model() == CameraModel::Screen {
                let why = "a light with a position does not work under the screen camera: what it sees has no place in the world";
                return Err(text.error(position.span(), why));
            }
            let falloff = keys.falloff.as_ref().map_or(Ok(Falloff::NONE), |given| falloff(text, given))?;
            LightKind::Point { position: position_in_shading_space(&set.camera, position.get_ref().0, space), falloff }
        }
    };
    Ok(GzLight { kind, color: keys.color.0 })
}

/// World directions become unit vectors, image-space ones keep the length they are given with, as in the course.
pub(super) fn direction_in_shading_space(camera: &GzCamera, toward: DVec3, space: LightSpace) -> DVec3 {
    match space {
        LightSpace::World => camera.shading_from_world().vector(unit(toward).unwrap_or(toward)),
        LightSpace::Image if camera.model() == CameraModel::Pinhole => turned_back(&image_from_world(camera), toward),
        LightSpace::Image => toward,
    }
}

fn position_in_shading_space(camera: &GzCamera, at: DVec3, space: LightSpace) -> DVec3 {
    let pinhole = camera.model() == CameraModel::Pinhole;
    match space {
        LightSpace::World if pinhole => at,
        LightSpace::World => camera.image_from_world().point(at),
        LightSpace::Image if pinhole => {
            turned_back(&image_from_world(camera), at) + camera.spec().view.map_or(DVec3::ZERO, |view| view.position)
        }
        LightSpace::Image => at,
    }
}

/// The course's image space for the view of a pinhole camera, whose own right axis points the other way.
fn image_from_world(camera: &GzCamera) -> GzMatrix {
    let course = GzCamera::new(CameraSpec { model: CameraModel::Homework, ..*camera.spec() });
    course.as_ref().unwrap_or(camera).image_from_world()
}

/// `v` from image to world axes: the transpose of a rotation takes it back.
fn turned_back(image_from_world: &GzMatrix, v: DVec3) -> DVec3 {
    let [x, y, z, _] = image_from_world.0.map(|row| DVec3::new(row[0], row[1], row[2]));
    x * v.x + y * v.y + z * v.z
}

fn falloff(text: SceneText<'_>, given: &Spanned<[Number; 3]>) -> Result<Falloff, LoadError> {
    let [c0, c1, c2] = given.get_ref().map(Number::f32);
    if c0 < 0.0 || c1 < 0.0 || c2 < 0.0 {
        return Err(text.error(given.span(), "a falloff must not be negative"));
    }
    if c0 == 0.0 && c1 == 0.0 && c2 == 0.0 {
        return Err(text.error(given.span(), "a falloff must not be zero throughout"));
    }
    Ok(Falloff { c0, c1, c2 })
}
