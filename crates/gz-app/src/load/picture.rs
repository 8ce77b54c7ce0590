//! Textures from picture files.

use crate::error::LoadError;
use gz_core::GzColor;
use gz_shade::{ImageTexture, TextureLookup};
use std::path::Path;

/// Reads a picture as a texture.
///
/// # Errors
///
/// If the file cannot be read as a picture.
pub fn texture(path: &Path, lookup: TextureLookup, srgb: bool, ppm_shift: bool) -> Result<ImageTexture, LoadError> {
    let picture = image::open(path).map_err(|error| LoadError::bad(path, None, error.to_string()))?.to_rgb8();
    let code = |byte: u8| f32::from(byte) / 255.0;
    let linear = |c: f32| if srgb { c * c } else { c };
    let mut texels: Vec<GzColor> = picture.pixels().map(|p| GzColor::from_array(p.0.map(|byte| linear(code(byte))))).collect();
    if ppm_shift {
        texels.rotate_right(1);
    }
    Ok(ImageTexture { width: picture.width(), height: picture.height(), texels, lookup })
}
