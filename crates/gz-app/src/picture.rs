//! Pictures read back, to be compared.

use crate::error::LoadError;
use crate::pfm;
use std::path::Path;

/// What the channels of a [`Picture`] count in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Encoded values from 0 to 255; files with 16 bits a channel have fractions.
    Byte,
    /// Linear values, 1 for full intensity.
    Linear,
}

/// A picture of either kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What channels count in.
    pub unit: Unit,
    /// Red, green, blue of `width * height` pixels, row-major, row 0 on top. Transparency is not looked at.
    pub rgb: Vec<[f32; 3]>,
}

impl Picture {
    /// A picture of bytes: red, green, blue of each pixel.
    pub fn of_bytes(width: u32, height: u32, rgb: &[u8]) -> Self {
        let rgb = rgb.chunks_exact(3).map(|p| [p[0], p[1], p[2]].map(f32::from)).collect();
        Self { width, height, unit: Unit::Byte, rgb }
    }

    /// Whether a file of this name is read as a picture.
    pub fn is_named(path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        ["png", "ppm", "pfm", "jpg", "jpeg"].contains(&extension.as_str())
    }

    /// Reads a picture file: png, ppm, jpeg or pfm.
    ///
    /// # Errors
    ///
    /// If it cannot be read or is damaged.
    pub fn read(path: &Path) -> Result<Self, LoadError> {
        let bytes = std::fs::read(path).map_err(|error| LoadError::io(path, &error))?;
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("pfm")) {
            let (width, height, colors) = pfm::decode(&bytes).map_err(|message| LoadError::bad(path, None, message))?;
            let rgb = colors.iter().map(|c| c.to_array()).collect();
            return Ok(Self { width, height, unit: Unit::Linear, rgb });
        }
        let image = image::load_from_memory(&bytes).map_err(|error| {
            let reason = error.to_string();
            LoadError::bad(path, None, format!("not a picture that can be read: {}", reason.lines().next().unwrap_or_default()))
        })?;
        let (width, height) = (image.width(), image.height());
        // 257 takes 16 bits to 8 exactly: 65535 / 257 = 255.
        let rgb = match image.color().bytes_per_pixel() / image.color().channel_count() {
            1 => image.to_rgb8().pixels().map(|p| p.0.map(f32::from)).collect(),
            _ => image.to_rgb16().pixels().map(|p| p.0.map(|c| f32::from(c) / 257.0)).collect(),
        };
        Ok(Self { width, height, unit: Unit::Byte, rgb })
    }

    /// The channel value of full intensity.
    pub fn peak(&self) -> f32 {
        match self.unit {
            Unit::Byte => 255.0,
            Unit::Linear => 1.0,
        }
    }
}
