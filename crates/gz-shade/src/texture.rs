//! Textures as pixels, and their lookup.

use gz_core::{GzColor, GzTextureIndex};

/// A function from texture coordinates to a colour.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// A picture.
    Image(ImageTexture),
    /// A formula.
    Procedural(Procedural),
}

/// A picture as linear colours: `width * height` texels, row-major, the file's first row first. Never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageTexture {
    /// Texels a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// The texels.
    pub texels: Vec<GzColor>,
    /// How coordinates become texels.
    pub lookup: TextureLookup,
}

/// How texture coordinates become texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureLookup {
    /// Repeats; texels have their centres at (k + 1/2) / size; v = 0 is the bottom of the picture.
    #[default]
    Repeat,
    /// The course's: clamped to [0, 1], x = u (width - 1), v = 0 is the first row of the file.
    Homework,
    /// As [`Self::Homework`], but black where u or v is not strictly between 0 and 1: the paper's program fails there and leaves
    /// the colour unset.
    PaperEdge,
}

/// A formula for a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Procedural {
    /// Squares of two colours, `across` columns and `down` rows a unit of u and v.
    Checker {
        /// Squares along u.
        across: f32,
        /// Squares along v.
        down: f32,
        /// Colours, the first at u = v = 0.
        colors: [GzColor; 2],
    },
}

impl Texture {
    /// The colour at `uv`. Not finite coordinates count as 0.
    pub fn color(&self, uv: GzTextureIndex) -> GzColor {
        let _ = uv;
        GzColor::ONE
    }
}
