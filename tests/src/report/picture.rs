//! Pictures for the page.

use gz_app::error::AppError;
use gz_app::output::{png, rgb8};
use gz_shade::{ColorCode, Frame};
use image::ImageEncoder;
use std::path::Path;

/// How well photographs are kept; at 85 no block shows at this size.
const QUALITY: u8 = 85;

/// A picture, encoded, with what it shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its name in files.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The content of a PNG or JPEG file.
    pub bytes: Vec<u8>,
}

impl Picture {
    /// A rendered picture, as JPEG.
    ///
    /// # Errors
    ///
    /// If the encoder refuses.
    pub fn photo(name: &str, caption: &str, width: u32, height: u32, rgb: &[u8]) -> Result<Self, AppError> {
        let mut bytes = Vec::new();
        image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, QUALITY)
            .write_image(rgb, width, height, image::ExtendedColorType::Rgb8)
            .map_err(|error| AppError::Io(format!("the picture {name} cannot be encoded as jpeg: {error}")))?;
        Ok(Self { name: name.to_owned(), caption: caption.to_owned(), width, height, bytes })
    }

    /// A picture of flat colours or single pixels that count, as PNG.
    ///
    /// # Errors
    ///
    /// If the encoder refuses.
    pub fn drawing(name: &str, caption: &str, width: u32, height: u32, rgb: &[u8]) -> Result<Self, AppError> {
        let bytes = png(width, height, rgb)?;
        Ok(Self { name: name.to_owned(), caption: caption.to_owned(), width, height, bytes })
    }

    /// A whole frame, as JPEG.
    ///
    /// # Errors
    ///
    /// If the encoder refuses.
    pub fn of_frame(name: &str, caption: &str, frame: &Frame, code: ColorCode) -> Result<Self, AppError> {
        Self::photo(name, caption, frame.area.width(), frame.area.height(), &rgb8(&frame.colors, code))
    }

    /// `png` or `jpeg`.
    pub fn format(&self) -> &'static str {
        if self.bytes.starts_with(b"\x89PNG") { "png" } else { "jpeg" }
    }

    /// The file of this picture of a section.
    pub fn file(&self, section: &str) -> String {
        format!("{section}-{}.{}", self.name, self.format())
    }

    /// What the list of a section's pictures says of it.
    pub fn line(&self) -> String {
        format!("{}\t{}\t{}\t{}\t{}", self.name, self.format(), self.width, self.height, self.caption)
    }

    /// A picture of a section, from the line of its list.
    pub fn read(folder: &Path, section: &str, line: &str) -> Option<Self> {
        let mut words = line.splitn(5, '\t');
        let (name, format) = (words.next()?, words.next()?);
        let (width, height) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
        let caption = words.next()?.to_owned();
        let bytes = std::fs::read(folder.join(format!("{section}-{name}.{format}"))).ok()?;
        Some(Self { name: name.to_owned(), caption, width, height, bytes })
    }
}
