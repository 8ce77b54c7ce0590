//! Samples of a pixel: where they lie and how much each counts.

use crate::color::{course12_channel, course12_intensity};
use crate::{Antialias, ColorCode};
use glam::{DVec2, DVec3};
use gz_core::GzColor;

/// One sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Where it lies, in pixels from the pixel itself: x right, y down.
    pub offset: DVec2,
    /// How much it counts; the weights of a pixel's samples sum to 1.
    pub weight: f64,
}

/// HW6's table: dx, dy, weight. The course adds (dx, dy) to the vertices' screen coordinates, which looks at the pixel's
/// neighbourhood at (-dx, -dy).
const HW6: [(f64, f64, f64); 6] = [
    (-0.52, 0.38, 0.128),
    (0.41, 0.56, 0.119),
    (0.27, 0.08, 0.294),
    (-0.17, -0.29, 0.249),
    (0.58, -0.55, 0.104),
    (-0.31, -0.71, 0.106),
];

/// Steps of the R2 sequence: 1/g and 1/g^2 for the real root g of g^3 = g + 1. Any number of its first points is spread evenly
/// (M. Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
const R2: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);

/// The samples of every pixel under `rule`; at least one, the same for all pixels, the first of [`Antialias::Samples`] at offset 0.
///
/// The N-sample pattern is the first N points of the R2 sequence within half a pixel around the pixel, of equal weight. 0 samples
/// count as 1.
pub fn samples(rule: Antialias) -> Vec<Sample> {
    match rule {
        Antialias::None => vec![Sample { offset: DVec2::ZERO, weight: 1.0 }],
        Antialias::Hw6 => HW6.map(|(dx, dy, weight)| Sample { offset: -DVec2::new(dx, dy), weight }).to_vec(),
        Antialias::Samples(n) => {
            let n = n.max(1);
            let place = |k: u32| {
                let at = R2 * f64::from(k) + 0.5;
                at - at.floor() - 0.5
            };
            (0..n).map(|k| Sample { offset: place(k), weight: 1.0 / f64::from(n) }).collect()
        }
    }
}

/// What a sample adds to its pixel's sum, before its weight.
///
/// Under [`ColorCode::Course12`] that is its 12-bit intensity, since HW6 sums finished pictures; otherwise its colour.
pub(crate) fn sample_value(code: ColorCode, color: GzColor) -> DVec3 {
    match code {
        ColorCode::Srgb => color.as_dvec3(),
        ColorCode::Course12 => DVec3::from_array(color.to_array().map(|c| f64::from(course12_intensity(c)))),
    }
}

/// The colour of a pixel from the weighted sum of its samples' values.
pub(crate) fn pixel_color(code: ColorCode, sum: DVec3) -> GzColor {
    match code {
        ColorCode::Srgb => sum.as_vec3(),
        // Six equal intensities must not lose one to the rounding of the weights, hence the millionth.
        ColorCode::Course12 => GzColor::from_array(sum.to_array().map(|c| course12_channel((c + 1e-6) as u16))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one() {
        for rule in [Antialias::None, Antialias::Hw6, Antialias::Samples(0), Antialias::Samples(7), Antialias::Samples(256)] {
            let sum: f64 = samples(rule).iter().map(|sample| sample.weight).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{rule:?}: {sum}");
        }
    }

    #[test]
    fn hw6_looks_at_the_other_side_of_its_offsets() {
        assert_eq!(samples(Antialias::Hw6)[1], Sample { offset: DVec2::new(-0.41, -0.56), weight: 0.119 });
    }

    #[test]
    fn one_sample_is_the_pixel_itself() {
        assert_eq!(samples(Antialias::Samples(1)), samples(Antialias::None));
        assert_eq!(samples(Antialias::Samples(0)), samples(Antialias::None));
    }

    #[test]
    fn sixteen_samples_fill_every_quarter_of_the_pixel_alike() {
        let places = samples(Antialias::Samples(16));
        for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let inside = places.iter().filter(|s| s.offset.x * x >= 0.0 && s.offset.y * y >= 0.0).count();
            assert!((3..=6).contains(&inside), "{inside} of 16");
        }
        assert!(places.iter().all(|s| s.offset.abs().max_element() <= 0.5));
    }

    #[test]
    fn equal_intensities_stay_what_they_are() {
        for intensity in 0..=4095u16 {
            let color = GzColor::splat(course12_channel(intensity));
            let value = |sample: &Sample| sample_value(ColorCode::Course12, color) * sample.weight;
            let sum = samples(Antialias::Hw6).iter().map(value).sum();
            assert_eq!(pixel_color(ColorCode::Course12, sum), color);
        }
    }
}
