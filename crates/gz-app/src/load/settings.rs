//! `[render]` and `[camera]`: rules, picture size and camera, and what the command line changes about them.

use super::keys::{CameraKeys, RenderKeys, SceneKeys};
use super::spot::SceneText;
use super::words::{Mode, Word};
use crate::error::LoadError;
use glam::DVec3;
use gz_core::{CameraError, CameraModel, CameraSpec, GzCamera, GzCoord, GzRay, LeavePolicy, View};
use gz_shade::{Antialias, Fresnel, ShadeRules};
use std::path::Path;
use toml::Spanned;

/// What the command line says instead of the scene. `None` leaves the scene's word.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Picture width and height in pixels, 1 to 65535 each.
    pub size: Option<(u32, u32)>,
    /// The camera model. The scene keeps the mode and the meaning of its lights; only where rays start and what space is traced
    /// changes.
    pub camera: Option<CameraModel>,
    /// Mirror and glass bounces, 0 to 32.
    pub depth: Option<u32>,
    /// Samples a pixel.
    pub aa: Option<Antialias>,
    /// The reflected share at a boundary.
    pub fresnel: Option<Fresnel>,
    /// Where shadow, mirror and glass rays start.
    pub leave: Option<LeavePolicy>,
}

/// More bounces than this are refused: light is gone long before.
const MAX_DEPTH: u32 = 32;

/// The field of view of a camera that does not say, in degrees: the course's default.
pub(super) const DEFAULT_FOV: f64 = 35.0;

/// `[render]` and `[camera]`, read.
#[derive(Debug)]
pub(super) struct Settings {
    /// The mode: decides defaults of other tables.
    pub(super) mode: Mode,
    /// The camera model of the scene file, which decides what its lights mean, whatever the command line says.
    pub(super) written_model: CameraModel,
    /// The rules of shading.
    pub(super) rules: ShadeRules,
    /// The camera.
    pub(super) camera: GzCamera,
}

impl Overrides {
    /// Nothing: the scene as it is.
    pub const NONE: Self = Self { size: None, camera: None, depth: None, aa: None, fresnel: None, leave: None };

    /// `rules` as the command line wants them.
    ///
    /// # Errors
    ///
    /// If the depth is above 32; the message names `path`.
    pub(super) fn applied_to(&self, mut rules: ShadeRules, path: &Path) -> Result<ShadeRules, LoadError> {
        rules.depth = self.depth.unwrap_or(rules.depth);
        rules.antialias = self.aa.unwrap_or(rules.antialias);
        rules.fresnel = self.fresnel.unwrap_or(rules.fresnel);
        rules.leave = self.leave.unwrap_or(rules.leave);
        if rules.depth > MAX_DEPTH {
            return Err(LoadError::bad(path, None, format!("depth must be 0 to {MAX_DEPTH}, not {}", rules.depth)));
        }
        Ok(rules)
    }
}

/// The picture size of a scene that does not say: the course's under its cameras.
pub(super) fn default_size(model: CameraModel) -> (u32, u32) {
    if model == CameraModel::Pinhole { (800, 600) } else { (256, 256) }
}

/// Reads `[render]` and `[camera]`.
pub(super) fn settings(text: SceneText<'_>, keys: &SceneKeys, overrides: &Overrides) -> Result<Settings, LoadError> {
    let Some(camera_keys) = &keys.camera else {
        return Err(LoadError::bad(text.path, None, "the scene has no [camera]"));
    };
    let written_model = camera_keys.get_ref().model.map_or(CameraModel::Pinhole, |word| word.0);
    let mode = keys.render.mode.map_or(Mode::of(written_model), |word| word.0);
    let rules = overrides.applied_to(rules(text, &keys.render, mode)?, text.path)?;

    let (width, height) = match (overrides.size, &keys.render.size) {
        (Some(size), _) => size,
        (None, Some(size)) => checked_size(text, size)?,
        (None, None) => default_size(written_model),
    };
    let model = overrides.camera.unwrap_or(written_model);
    let spec = CameraSpec { model, view: view(text, camera_keys, written_model)?, width, height };
    let camera = GzCamera::new(spec).map_err(|error| match (error, &camera_keys.get_ref().fov) {
        // The scene's own size was checked above with its line.
        (CameraError::Size, _) => LoadError::bad(text.path, None, error.to_string()),
        (CameraError::Fov, Some(fov)) => text.error(fov.span(), error.to_string()),
        _ => text.error(camera_keys.span(), error.to_string()),
    })?;
    Ok(Settings { mode, written_model, rules, camera })
}

fn checked_size(text: SceneText<'_>, size: &Spanned<[i64; 2]>) -> Result<(u32, u32), LoadError> {
    let [width, height] = *size.get_ref();
    let side = |pixels: i64| u16::try_from(pixels).ok().filter(|&n| n > 0).map(u32::from);
    match (side(width), side(height)) {
        (Some(w), Some(h)) => Ok((w, h)),
        _ => Err(text.error(size.span(), format!("size must be 1 to 65535 pixels each way, not {width} x {height}"))),
    }
}

/// The mode's rules with each key that is given put over them.
fn rules(text: SceneText<'_>, keys: &RenderKeys, mode: Mode) -> Result<ShadeRules, LoadError> {
    fn put<T: Copy>(rule: &mut T, key: Option<Word<T>>) {
        *rule = key.map_or(*rule, |word| word.0);
    }
    let mut rules = mode.rules();
    if let Some(depth) = &keys.depth {
        let given = *depth.get_ref();
        let checked = u32::try_from(given).ok().filter(|&depth| depth <= MAX_DEPTH);
        rules.depth = checked.ok_or_else(|| text.error(depth.span(), format!("depth must be 0 to {MAX_DEPTH}, not {given}")))?;
    }
    rules.antialias = keys.aa.map_or(rules.antialias, |aa| aa.0);
    put(&mut rules.fresnel, keys.fresnel);
    put(&mut rules.shadow, keys.shadow);
    put(&mut rules.eye, keys.eye);
    put(&mut rules.mirror_blend, keys.mirror_blend);
    put(&mut rules.glass_blend, keys.glass_blend);
    put(&mut rules.color_code, keys.color_code);
    rules.reflect_last_light = keys.reflect_last_light.unwrap_or(rules.reflect_last_light);
    rules.clamp_levels = keys.clamp_levels.unwrap_or(rules.clamp_levels);
    rules.geometric_sides = keys.geometric_sides.unwrap_or(rules.geometric_sides);
    rules.flat_textures = keys.flat_textures.unwrap_or(rules.flat_textures);
    rules.screen_interpolation = keys.screen_interpolation.unwrap_or(rules.screen_interpolation);
    Ok(rules)
}

/// Whether rays can start at `point`.
pub(super) fn holds(point: DVec3) -> bool {
    GzRay::from_f64(point, GzCoord::Z).is_valid()
}

fn view(text: SceneText<'_>, camera: &Spanned<CameraKeys>, model: CameraModel) -> Result<Option<View>, LoadError> {
    let keys = camera.get_ref();
    let says_nothing = keys.position.is_none() && keys.look_at.is_none() && keys.up.is_none() && keys.fov.is_none();
    if model == CameraModel::Screen && says_nothing {
        return Ok(None);
    }
    let missing = |name: &str| text.error(camera.span(), format!("the camera has no {name}"));
    let position = keys.position.ok_or_else(|| missing("position"))?.0;
    if !holds(position) {
        return Err(text.error(
            camera.span(),
            "the camera's position is where rays cannot start: its coordinates must be 0 or 2^-150 to 2^128",
        ));
    }
    let look_at = keys.look_at.ok_or_else(|| missing("look_at"))?.0;
    let up = keys.up.map_or(DVec3::Y, |up| up.0);
    let fov = keys.fov.as_ref().map_or(DEFAULT_FOV, |fov| fov.get_ref().0);
    Ok(Some(View { position, look_at, up, fov }))
}
