//! The words that scene keys take, and hints for words and keys that are nearly right.

use gz_core::CameraModel;
use gz_shade::{ColorCode, Eye, Fresnel, GlassBlend, Interpolate, MirrorBlend, ShadeRules, ShadowRule, Surface, TextureLookup};
use serde::{Deserialize, Deserializer, de};

/// A value that a scene file names by a word.
pub(super) trait Words: Copy + 'static {
    /// Every word with its meaning.
    const WORDS: &'static [(&'static str, Self)];
}

/// A word of a scene file, already turned into its meaning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<T>(pub(super) T);

impl<'de, T: Words> Deserialize<'de> for Word<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let word = String::deserialize(deserializer)?;
        let meaning = T::WORDS.iter().find(|(name, _)| *name == word);
        meaning.map(|&(_, meaning)| Self(meaning)).ok_or_else(|| {
            let known: Vec<&str> = T::WORDS.iter().map(|&(name, _)| name).collect();
            de::Error::custom(format!("\"{word}\" is not known here{}", hint(&word, &known)))
        })
    }
}

/// Which preset of [`ShadeRules`] a scene starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    Physical,
    Homework,
    Paper,
}

impl Mode {
    /// What a scene that does not say gets from its camera.
    pub(super) fn of(model: CameraModel) -> Self {
        match model {
            CameraModel::Pinhole => Self::Physical,
            CameraModel::Homework | CameraModel::Screen => Self::Homework,
            CameraModel::Paper => Self::Paper,
        }
    }

    /// The rules before keys change them.
    pub(super) fn rules(self) -> ShadeRules {
        match self {
            Self::Physical => ShadeRules::PHYSICAL,
            Self::Homework => ShadeRules::HOMEWORK,
            Self::Paper => ShadeRules::PAPER,
        }
    }
}

/// Which space a light is given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightSpace {
    World,
    Image,
}

/// What a `[[material]]` is, before its index of refraction is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Phong,
    Mirror,
    Glass,
}

/// Where a mesh's normals come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NormalsRule {
    /// From the file; computed smooth where it has none.
    File,
    /// Computed smooth, the file's ignored.
    Smooth,
    /// The face normal at all three corners.
    Flat,
}

impl Words for Mode {
    const WORDS: &'static [(&'static str, Self)] =
        &[("physical", Self::Physical), ("homework", Self::Homework), ("paper", Self::Paper)];
}

impl Words for CameraModel {
    const WORDS: &'static [(&'static str, Self)] =
        &[("pinhole", Self::Pinhole), ("homework", Self::Homework), ("paper", Self::Paper), ("screen", Self::Screen)];
}

impl Words for LightSpace {
    const WORDS: &'static [(&'static str, Self)] = &[("world", Self::World), ("image", Self::Image)];
}

impl Words for Fresnel {
    const WORDS: &'static [(&'static str, Self)] = &[("exact", Self::Exact), ("schlick", Self::Schlick)];
}

impl Words for ShadowRule {
    const WORDS: &'static [(&'static str, Self)] = &[("tinted", Self::Tinted), ("opaque", Self::Opaque), ("off", Self::Off)];
}

impl Words for Eye {
    const WORDS: &'static [(&'static str, Self)] = &[("ray", Self::Ray), ("fixed", Self::Fixed)];
}

impl Words for MirrorBlend {
    const WORDS: &'static [(&'static str, Self)] =
        &[("physical", Self::Physical), ("replace", Self::Replace), ("add", Self::Add)];
}

impl Words for GlassBlend {
    const WORDS: &'static [(&'static str, Self)] = &[("physical", Self::Physical), ("add", Self::Add)];
}

impl Words for ColorCode {
    const WORDS: &'static [(&'static str, Self)] = &[("srgb", Self::Srgb), ("course12", Self::Course12)];
}

impl Words for TextureLookup {
    const WORDS: &'static [(&'static str, Self)] =
        &[("repeat", Self::Repeat), ("homework", Self::Homework), ("paper_edge", Self::PaperEdge)];
}

impl Words for Kind {
    const WORDS: &'static [(&'static str, Self)] = &[("phong", Self::Phong), ("mirror", Self::Mirror), ("glass", Self::Glass)];
}

impl Words for Interpolate {
    const WORDS: &'static [(&'static str, Self)] = &[("flat", Self::Flat), ("gouraud", Self::Gouraud), ("phong", Self::Phong)];
}

impl Words for Surface {
    const WORDS: &'static [(&'static str, Self)] = &[("shaded", Self::Shaded), ("app_color", Self::AppColor)];
}

impl Words for NormalsRule {
    const WORDS: &'static [(&'static str, Self)] = &[("file", Self::File), ("smooth", Self::Smooth), ("flat", Self::Flat)];
}

/// What to say after a wrong name: the nearest known one, or all of them when none is near.
pub(super) fn hint(wrong: &str, known: &[&str]) -> String {
    let near = known.iter().map(|name| (distance(wrong, name), *name)).min();
    match near {
        None => String::new(),
        // A third of the letters wrong is still a slip of the hand; more is another word.
        Some((d, name)) if d <= wrong.chars().count().max(3) / 3 => format!(" (did you mean \"{name}\"?)"),
        Some(_) => format!(" (known: {})", known.join(", ")),
    }
}

/// Letters to insert, delete, replace or swap with their neighbour to get from `a` to `b` (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    // d[i][j] is the distance of the first i letters of a from the first j of b.
    let mut d = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            d[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = d[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
                let swapped = if swapped { d[i - 2][j - 2] + 1 } else { replaced };
                replaced.min(swapped).min(d[i - 1][j] + 1).min(d[i][j - 1] + 1)
            };
        }
    }
    d[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_counts_single_letter_changes() {
        for (a, b, d) in [
            ("", "", 0),
            ("fov", "fov", 0),
            ("colour", "color", 1),
            ("kitten", "sitting", 3),
            ("", "abc", 3),
            ("depht", "depth", 1),
        ] {
            assert_eq!((distance(a, b), distance(b, a)), (d, d), "{a} {b}");
        }
    }

    #[test]
    fn hint_names_the_nearest_word_or_all() {
        assert_eq!(hint("colour", &["color", "cold"]), " (did you mean \"color\"?)");
        assert_eq!(hint("size", &["fov", "up"]), " (known: fov, up)");
        assert_eq!(hint("size", &[]), "");
    }
}
