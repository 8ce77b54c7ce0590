//! Colours out: which picture format a name asks for, and the bytes of the file.

use crate::error::AppError;
use crate::pfm;
use gz_core::GzColor;
use gz_shade::{ColorCode, Frame};
use image::ImageEncoder;
use std::path::Path;

/// A picture format, told by the file's extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// 8 bits a channel, compressed without loss.
    Png,
    /// 8 bits a channel, the course's format P6.
    Ppm,
    /// Linear f32 a channel, neither clamped nor encoded: see [`crate::pfm`].
    Pfm,
}

impl ImageFormat {
    /// The format of a file of this name.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] if the extension is none that we write.
    pub fn of(path: &Path) -> Result<Self, AppError> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "png" => Ok(Self::Png),
            "ppm" => Ok(Self::Ppm),
            "pfm" => Ok(Self::Pfm),
            "" => Err(AppError::Usage(format!("{}: a picture needs an extension: png, ppm or pfm", path.display()))),
            other => Err(AppError::Usage(format!("{}: cannot write .{other} pictures: use png, ppm or pfm", path.display()))),
        }
    }
}

/// A frame as the content of a picture file. `code` is how 8-bit formats encode colours; PFM stays linear.
///
/// # Errors
///
/// [`AppError::Io`] if the encoder refuses.
pub fn picture(frame: &Frame, format: ImageFormat, code: ColorCode) -> Result<Vec<u8>, AppError> {
    let (width, height) = (frame.area.width(), frame.area.height());
    match format {
        ImageFormat::Png => png(width, height, &rgb8(&frame.colors, code)),
        ImageFormat::Ppm => Ok(ppm(width, height, &rgb8(&frame.colors, code))),
        ImageFormat::Pfm => Ok(pfm::encode(width, &frame.colors)),
    }
}

/// Colours as bytes: red, green, blue of each.
pub fn rgb8(colors: &[GzColor], code: ColorCode) -> Vec<u8> {
    colors.iter().flat_map(|c| c.to_array()).map(|channel| byte(channel, code)).collect()
}

/// The byte of one channel of a linear colour. Below 0 and NaN give 0, above 1 gives 255.
pub fn byte(channel: f32, code: ColorCode) -> u8 {
    match code {
        ColorCode::Srgb => gz_shade::color::srgb_byte(channel),
        ColorCode::Course12 => gz_shade::color::course12_byte(channel),
    }
}

/// An 8-bit RGB picture as a PNG file.
///
/// # Errors
///
/// [`AppError::Io`] if the encoder refuses.
pub fn png(width: u32, height: u32, rgb: &[u8]) -> Result<Vec<u8>, AppError> {
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    encoder
        .write_image(rgb, width, height, image::ExtendedColorType::Rgb8)
        .map_err(|error| AppError::Io(format!("the picture cannot be encoded as png: {error}")))?;
    Ok(bytes)
}

/// An 8-bit RGB picture as a PPM file (P6, maximum 255).
pub fn ppm(width: u32, height: u32, rgb: &[u8]) -> Vec<u8> {
    let mut bytes = format!("P6\n{width} {height}\n255\n").into_bytes();
    bytes.extend_from_slice(rgb);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_decides_in_any_case() {
        for (name, format) in [("a.png", ImageFormat::Png), ("a.PPM", ImageFormat::Ppm), ("x/a.b.pfm", ImageFormat::Pfm)] {
            assert_eq!(ImageFormat::of(Path::new(name)).unwrap(), format);
        }
    }

    #[test]
    fn other_extensions_are_refused_by_name() {
        let message = |name: &str| ImageFormat::of(Path::new(name)).unwrap_err();
        assert_eq!(message("a.gif").to_string(), "a.gif: cannot write .gif pictures: use png, ppm or pfm");
        assert_eq!(message("a").to_string(), "a: a picture needs an extension: png, ppm or pfm");
        assert_eq!(message("a").exit_code(), 2);
    }

    #[test]
    fn course_colours_are_cut_and_srgb_is_rounded() {
        let colors = [GzColor::new(0.0, 0.5, 1.0), GzColor::new(-1.0, 2.0, f32::NAN)];
        assert_eq!(rgb8(&colors, ColorCode::Course12), [0, 127, 255, 0, 255, 0]);
        assert_eq!(rgb8(&colors[..1], ColorCode::Srgb), [0, 188, 255]);
    }

    #[test]
    fn png_and_ppm_hold_the_same_pixels() {
        let rgb: Vec<u8> = (0..2 * 3 * 3).collect();
        let decoded = image::load_from_memory(&png(2, 3, &rgb).unwrap()).unwrap().to_rgb8();
        assert_eq!((decoded.dimensions(), decoded.as_raw()), ((2, 3), &rgb));
        assert_eq!(image::load_from_memory(&ppm(2, 3, &rgb)).unwrap().to_rgb8().as_raw(), &rgb);
    }
}
