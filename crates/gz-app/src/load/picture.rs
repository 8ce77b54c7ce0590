//! Pictures into textures: PNG, JPEG and the PNM family (PPM, PGM, PBM, PAM) through the image crate, within limits.

use super::text;
use crate::error::LoadError;
use gz_core::GzColor;
use gz_shade::color::linear_from_srgb;
use gz_shade::{ImageTexture, TextureLookup};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::path::Path;

/// The longest picture file that is read, in bytes: 1 GiB.
pub const MAX_FILE: u64 = 1 << 30;
/// The most texels on a side.
pub const MAX_SIDE: u32 = 16384;
/// The most bytes that a decoded picture may take.
pub const MAX_DECODED: u64 = 256 << 20;

/// The texture in the picture at `path`.
///
/// Texels are linear. With `srgb` the file's samples are taken as sRGB and decoded by the exact curve, without it they are taken
/// as they are: 8 bits divided by 255 (the course), 16 bits by 65535. Grey becomes equal red, green and blue. Alpha is passed
/// over, colours are not multiplied by it. A palette becomes its colours; a CMYK JPEG becomes RGB without a colour profile, and
/// no other profile or gamma of a file is followed either. Samples of a PNM file whose maximum is not 255 or 65535 are scaled to
/// it and rounded.
///
/// `ppm_shift` reads a `P6` file as the course's loader does, which takes all behind the first digit of the maximum as pixels:
/// with `255` as the last word of the header every texel comes one place later in raster order, after one made of the bytes `55`
/// and line end, and the last is lost.
///
/// # Errors
///
/// A file that cannot be read, is no such picture, is cut short or damaged, has no pixels, or is beyond [`MAX_FILE`],
/// [`MAX_SIDE`] or [`MAX_DECODED`]; with `ppm_shift`, one that is not `P6`.
pub fn texture(path: &Path, lookup: TextureLookup, srgb: bool, ppm_shift: bool) -> Result<ImageTexture, LoadError> {
    let bytes = text::read_bytes(path, MAX_FILE)?;
    parse(&bytes, lookup, srgb, ppm_shift).map_err(|message| LoadError::bad(path, None, message))
}

/// As [`texture`], with the bytes of the file given; errors are messages.
fn parse(bytes: &[u8], lookup: TextureLookup, srgb: bool, ppm_shift: bool) -> Result<ImageTexture, String> {
    let (width, height, texels) = if ppm_shift {
        let (width, height, samples) = course_bytes(bytes)?;
        (width, height, colors(samples, 3, 255, srgb))
    } else {
        let picture = decode(bytes)?;
        (picture.width(), picture.height(), linear(&picture, srgb)?)
    };
    Ok(ImageTexture { width, height, texels, lookup })
}

/// Decodes a picture that is neither empty nor beyond the limits.
fn decode(bytes: &[u8]) -> Result<DynamicImage, String> {
    let format = image::guess_format(bytes).ok();
    let Some(format @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Pnm)) = format else {
        return Err("not a PNG, JPEG or PPM picture".to_owned());
    };
    let failed = |error: image::ImageError| {
        let cause = error.to_string().replace(['\n', '\r'], " ");
        format!("a damaged or unsupported {format:?} picture: {cause}")
    };
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_DECODED);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits.clone());
    let mut decoder = reader.into_decoder().map_err(failed)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    if decoder.total_bytes() > MAX_DECODED {
        return Err(format!("{width} x {height} pixels take {} bytes: at most {MAX_DECODED}", decoder.total_bytes()));
    }
    // Set only now, so that a size beyond them has a message that says the size.
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    decoder.set_limits(limits).map_err(failed)?;
    DynamicImage::from_decoder(decoder).map_err(failed)
}

fn check_size(width: u32, height: u32) -> Result<(), String> {
    match () {
        () if width == 0 || height == 0 => Err(format!("empty texture: {width} x {height} pixels")),
        () if width > MAX_SIDE || height > MAX_SIDE => Err(format!("{width} x {height} pixels: at most {MAX_SIDE} on a side")),
        () => Ok(()),
    }
}

/// The texels of a decoded picture.
fn linear(picture: &DynamicImage, srgb: bool) -> Result<Vec<GzColor>, String> {
    Ok(match picture {
        DynamicImage::ImageLuma8(p) => colors(p, 1, 255, srgb),
        DynamicImage::ImageLumaA8(p) => colors(p, 2, 255, srgb),
        DynamicImage::ImageRgb8(p) => colors(p, 3, 255, srgb),
        DynamicImage::ImageRgba8(p) => colors(p, 4, 255, srgb),
        DynamicImage::ImageLuma16(p) => colors(p, 1, 65535, srgb),
        DynamicImage::ImageLumaA16(p) => colors(p, 2, 65535, srgb),
        DynamicImage::ImageRgb16(p) => colors(p, 3, 65535, srgb),
        DynamicImage::ImageRgba16(p) => colors(p, 4, 65535, srgb),
        other => return Err(format!("{:?} samples are not supported", other.color())),
    })
}

/// Samples into colours, `channels` a texel: grey for one or two, red, green and blue for three or four; the second or fourth is
/// alpha. `most` is the sample that is 1.
fn colors<T: Copy + Into<usize>>(samples: &[T], channels: usize, most: u32, srgb: bool) -> Vec<GzColor> {
    // One entry a sample value: the curve is dear, and a picture has far more texels.
    let value = |sample| {
        let encoded = f64::from(sample) / f64::from(most);
        (if srgb { linear_from_srgb(encoded) } else { encoded }) as f32
    };
    let table: Vec<f32> = (0..=most).map(value).collect();
    let at = |sample: T| table[sample.into()];
    let color = |texel: &[T]| match *texel {
        [grey] | [grey, _] => GzColor::splat(at(grey)),
        [r, g, b, ..] => GzColor::new(at(r), at(g), at(b)),
        [] => GzColor::ZERO,
    };
    samples.chunks_exact(channels).map(color).collect()
}

/// Width, height and samples of a `P6` file as the course's loader finds them.
///
/// It reads a word, two whole numbers and **one character that is not blank**, and takes everything behind as pixels. Of a
/// maximum of `255` that is the `2`, so `55` and the line end are the first texel. The bytes over at the end of the file are
/// never read.
///
/// Source: the course's `tex_fun`, as HOMEWORK 5 and later copies have it.
fn course_bytes(bytes: &[u8]) -> Result<(u32, u32, &[u8]), String> {
    let mut at = 0;
    let mut word = || {
        let rest = &bytes[at..];
        let start = rest.iter().position(|b| !text::is_blank(b)).unwrap_or(rest.len());
        let end = rest[start..].iter().position(text::is_blank).map_or(rest.len(), |len| start + len);
        at += end;
        &rest[start..end]
    };
    if word() != b"P6" {
        return Err("the course's shift of a texture needs a P6 picture".to_owned());
    }
    let mut size = || {
        let word = word();
        let number = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
        number.ok_or_else(|| format!("a damaged P6 header: {} is not a size", text::quoted(word)))
    };
    let (width, height) = (size()?, size()?);
    check_size(width, height)?;
    let after = bytes[at..].iter().position(|b| !text::is_blank(b)).map_or(bytes.len(), |skip| at + skip + 1);
    let length = 3 * width as usize * height as usize;
    if length as u64 > MAX_DECODED {
        return Err(format!("{width} x {height} pixels take {length} bytes: at most {MAX_DECODED}"));
    }
    match bytes.get(after..after + length) {
        Some(samples) => Ok((width, height, samples)),
        None => Err(format!("cut short: {width} x {height} pixels need {length} bytes, {} are there", bytes.len() - after)),
    }
}

#[cfg(test)]
mod tests;
