//! The colours that stand for numbers: dark blue for little, through red to light yellow for much.
//!
//! Lightness grows evenly from 0.12 to 0.96 in Oklab, a space in which equal steps look equally large, so that twice as much looks twice as
//! light also to who does not see colours, and in print. The hue turns by half a circle on the way, which tells more steps apart.

use gz_core::GzColor;

/// The colour of `share`, linear: 0 and less is the darkest, 1 and more the lightest. NaN gives the darkest.
pub fn scale_color(share: f64) -> GzColor {
    // A NaN is neither above 0 nor below 1.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    let lightness = 0.12 + 0.84 * share;
    // As much colour as a screen can show all the way, with room to spare.
    let chroma = 0.065 + 0.40 * share - 0.36 * share * share;
    let hue = (285.0 + 180.0 * share).to_radians();
    linear_from_oklab(lightness, chroma * libm::cos(hue), chroma * libm::sin(hue))
}

/// Source: B. Ottosson 2020, "A perceptual color space for image processing", from Oklab to linear sRGB.
fn linear_from_oklab(lightness: f64, a: f64, b: f64) -> GzColor {
    let cube = |x: f64| x * x * x;
    let l = cube(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m = cube(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s = cube(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    let red = 4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s;
    let green = -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s;
    let blue = -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s;
    GzColor::new(red as f32, green as f32, blue as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_can_be_shown_and_is_lighter_than_the_one_before() {
        let luminance = |c: GzColor| c.dot(GzColor::new(0.2126, 0.7152, 0.0722));
        let mut before = -1.0;
        for k in 0..=1000 {
            let color = scale_color(f64::from(k) / 1000.0);
            assert!(color.min_element() >= 0.0 && color.max_element() <= 1.0, "{k}: {color}");
            assert!(luminance(color) > before, "{k}: {color}");
            before = luminance(color);
        }
    }

    #[test]
    fn white_and_black_of_oklab_are_white_and_black() {
        assert!((linear_from_oklab(1.0, 0.0, 0.0) - GzColor::ONE).abs().max_element() < 1e-6);
        assert_eq!(linear_from_oklab(0.0, 0.0, 0.0), GzColor::ZERO);
    }

    #[test]
    fn numbers_off_the_scale_have_the_colour_of_its_end() {
        let ends = [scale_color(0.0), scale_color(1.0)];
        assert_eq!([-3.0, f64::NAN, f64::NEG_INFINITY].map(scale_color), [ends[0]; 3]);
        assert_eq!([1.5, f64::INFINITY].map(scale_color), [ends[1]; 2]);
    }
}
