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
        let finite = |x: f32| if x.is_finite() { f64::from(x) } else { 0.0 };
        let (u, v) = (finite(uv.x), finite(uv.y));
        match self {
            Self::Image(image) => image.color(u, v),
            Self::Procedural(formula) => formula.color(u, v),
        }
    }
}

impl ImageTexture {
    /// Bilinear between the four texels around (u, v), both finite.
    fn color(&self, u: f64, v: f64) -> GzColor {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        match self.lookup {
            TextureLookup::Repeat => {
                // A whole number of pictures is taken off first, so that huge coordinates keep their fraction's bits.
                let (x, y) = ((u - u.floor()) * width - 0.5, (1.0 - (v - v.floor())) * height - 0.5);
                self.bilinear(x, y, |k, size| k.rem_euclid(i64::from(size).max(1)))
            }
            TextureLookup::PaperEdge if !(0.0 < u && u < 1.0 && 0.0 < v && v < 1.0) => GzColor::ZERO,
            TextureLookup::Homework | TextureLookup::PaperEdge => {
                let (x, y) = (u.clamp(0.0, 1.0) * (width - 1.0), v.clamp(0.0, 1.0) * (height - 1.0));
                // The weight of a texel beyond the last one is 0; which texel that is does not matter.
                self.bilinear(x, y, |k, size| k.min(i64::from(size) - 1).max(0))
            }
        }
    }

    /// Between floor and ceil of texel coordinates (x, y); `wrap` brings a column or row into the picture.
    fn bilinear(&self, x: f64, y: f64, wrap: impl Fn(i64, u32) -> i64) -> GzColor {
        let (s, t) = ((x - x.floor()) as f32, (y - y.floor()) as f32);
        let texel = |dx: i64, dy: i64| {
            let (column, row) = (wrap(x.floor() as i64 + dx, self.width), wrap(y.floor() as i64 + dy, self.height));
            // Both are in the picture. A buffer that is too short, which loaders never make, is black where it ends.
            self.texels.get((row * i64::from(self.width) + column) as usize).copied().unwrap_or(GzColor::ZERO)
        };
        let mix = |a: GzColor, b: GzColor, t: f32| if t == 0.0 { a } else { a * (1.0 - t) + b * t };
        mix(mix(texel(0, 0), texel(1, 0), s), mix(texel(0, 1), texel(1, 1), s), t)
    }
}

impl Procedural {
    /// The formula's colour at (u, v), both finite.
    fn color(&self, u: f64, v: f64) -> GzColor {
        match *self {
            Self::Checker { across, down, colors } => {
                let square = (u * f64::from(across)).floor() + (v * f64::from(down)).floor();
                colors[usize::from(square.rem_euclid(2.0) == 1.0)]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const R: GzColor = GzColor::new(1.0, 0.0, 0.0);
    const G: GzColor = GzColor::new(0.0, 1.0, 0.0);
    const B: GzColor = GzColor::new(0.0, 0.0, 1.0);
    const W: GzColor = GzColor::new(1.0, 1.0, 1.0);

    /// Red and green above blue and white.
    fn two_by_two(lookup: TextureLookup) -> Texture {
        Texture::Image(ImageTexture { width: 2, height: 2, texels: vec![R, G, B, W], lookup })
    }

    fn at(texture: &Texture, u: f32, v: f32) -> GzColor {
        texture.color(GzTextureIndex::new(u, v))
    }

    #[test]
    fn homework_lookup_puts_the_first_row_at_v_0_and_clamps() {
        let texture = two_by_two(TextureLookup::Homework);
        assert_eq!((at(&texture, 0.0, 0.0), at(&texture, 1.0, 0.0)), (R, G));
        assert_eq!((at(&texture, 0.0, 1.0), at(&texture, 1.0, 1.0)), (B, W));
        assert_eq!((at(&texture, -3.0, 7.0), at(&texture, -0.0, -0.0)), (B, R));
        assert_eq!(at(&texture, 0.25, 0.0), R * 0.75 + G * 0.25);
    }

    #[test]
    fn repeat_lookup_has_texel_centres_and_v_0_at_the_bottom() {
        let texture = two_by_two(TextureLookup::Repeat);
        assert_eq!((at(&texture, 0.25, 0.75), at(&texture, 0.75, 0.75)), (R, G));
        assert_eq!((at(&texture, 0.25, 0.25), at(&texture, 0.75, 0.25)), (B, W));
        assert_eq!((at(&texture, 3.25, -1.25), at(&texture, -0.75, 0.75)), (R, R));
        // The seam mixes the first and the last column.
        assert_eq!((at(&texture, 0.0, 0.75), at(&texture, 1.0, 0.75)), ((R + G) * 0.5, (R + G) * 0.5));
    }

    #[test]
    fn paper_edge_is_black_on_and_beyond_the_border() {
        let texture = two_by_two(TextureLookup::PaperEdge);
        for (u, v) in [(0.0, 0.5), (1.0, 0.5), (0.5, 0.0), (0.5, 1.0), (-0.0, 0.5), (1e9, 0.5), (f32::NAN, 0.5)] {
            assert_eq!(at(&texture, u, v), GzColor::ZERO, "{u} {v}");
        }
        assert_eq!(at(&texture, 0.5, 0.5), (R + G + B + W) * 0.25);
    }

    #[test]
    fn i2_odd_coordinates_and_the_smallest_picture_give_finite_colours() {
        for lookup in [TextureLookup::Repeat, TextureLookup::Homework, TextureLookup::PaperEdge] {
            let single = Texture::Image(ImageTexture { width: 1, height: 1, texels: vec![G], lookup });
            let empty = Texture::Image(ImageTexture { width: 0, height: 0, texels: vec![], lookup });
            for x in [1.0, -0.0, 1e9, f32::NAN, f32::INFINITY, f32::MIN, f32::MAX, -1e-30] {
                assert!(at(&two_by_two(lookup), x, x).is_finite());
                assert_eq!(at(&empty, x, 0.5), GzColor::ZERO);
                let inside = 0.0 < x && x < 1.0;
                let expected = if lookup == TextureLookup::PaperEdge && !inside { GzColor::ZERO } else { G };
                assert_eq!(at(&single, x, 0.5), expected, "{lookup:?} {x}");
            }
        }
        assert_eq!(at(&two_by_two(TextureLookup::Homework), f32::NAN, f32::NAN), R);
    }

    #[test]
    fn checkers_alternate_and_go_on_below_zero() {
        let texture = Texture::Procedural(Procedural::Checker { across: 10.0, down: 2.0, colors: [R, B] });
        assert_eq!((at(&texture, 0.0, 0.0), at(&texture, 0.15, 0.0), at(&texture, 0.15, 0.6)), (R, B, R));
        assert_eq!((at(&texture, -0.05, 0.0), at(&texture, -0.15, 0.0)), (B, R));
        assert!(at(&texture, f32::MAX, f32::NAN).is_finite());
    }
}
