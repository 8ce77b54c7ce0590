//! The sheet: expected, difference and actual side by side.

use crate::output;
use crate::picture::{Picture, Unit};
use crate::view::id_color;
use gz_core::{GzColor, Hit};
use gz_shade::ColorCode;

/// White columns between the three parts.
const GAP: u32 = 4;

/// A picture of three parts: expected | difference | actual.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Pixels a row: three pictures and two gaps.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, row-major, row 0 on top.
    pub rgb: Vec<u8>,
}

/// The sheet of two pictures of one size. The difference is scaled so that its greatest channel is white; black is equal.
pub fn of_pictures(expected: &Picture, actual: &Picture) -> Sheet {
    let difference = |a: &[f32; 3], b: &[f32; 3]| -> [f32; 3] { std::array::from_fn(|k| (a[k] - b[k]).abs()) };
    let differences: Vec<[f32; 3]> = expected.rgb.iter().zip(&actual.rgb).map(|(a, b)| difference(a, b)).collect();
    let most = differences.iter().flatten().copied().filter(|d| d.is_finite()).fold(0.0, f32::max).max(f32::MIN_POSITIVE);
    // A difference that is not a number is the worst there can be: white.
    let byte = |d: f32| if d.is_finite() { (d / most * 255.0).round() as u8 } else { 255 };
    let middle = differences.iter().map(|d| d.map(byte)).collect();
    join(expected.width, &[bytes(expected), middle, bytes(actual)])
}

/// The sheet of two T-buffers of `width` pixels a row: triangles in colours, and white where any bit differs.
pub fn of_hits(width: u32, expected: &[Hit], actual: &[Hit]) -> Sheet {
    let bits = |hit: &Hit| (hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits());
    let triangle = |hit: &Hit| {
        let color = if hit.is_hit() { id_color(hit.tri) } else { GzColor::ZERO };
        color.to_array().map(|c| (c * 255.0).round() as u8)
    };
    let middle = expected.iter().zip(actual).map(|(a, b)| if bits(a) == bits(b) { [0; 3] } else { [255; 3] }).collect();
    join(width, &[expected.iter().map(triangle).collect(), middle, actual.iter().map(triangle).collect()])
}

fn bytes(picture: &Picture) -> Vec<[u8; 3]> {
    let byte = |c: f32| match picture.unit {
        Unit::Byte => c.round() as u8,
        Unit::Linear => output::byte(c, ColorCode::Srgb),
    };
    picture.rgb.iter().map(|pixel| pixel.map(byte)).collect()
}

/// Three parts of `width` pixels a row, white between them.
fn join(width: u32, parts: &[Vec<[u8; 3]>; 3]) -> Sheet {
    let height = parts[0].len() as u32 / width.max(1);
    let mut rgb = Vec::with_capacity(3 * (3 * width + 2 * GAP) as usize * height as usize);
    for row in 0..height as usize {
        for (k, part) in parts.iter().enumerate() {
            if k > 0 {
                rgb.extend([255u8; 3 * GAP as usize]);
            }
            rgb.extend(part[row * width as usize..][..width as usize].iter().flatten());
        }
    }
    Sheet { width: 3 * width + 2 * GAP, height, rgb }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_parts_stand_side_by_side() {
        let (a, b) = (Picture::of_bytes(1, 2, &[10, 20, 30, 0, 0, 0]), Picture::of_bytes(1, 2, &[12, 20, 30, 0, 0, 1]));
        let sheet = of_pictures(&a, &b);
        assert_eq!((sheet.width, sheet.height, sheet.rgb.len()), (11, 2, 66));
        assert_eq!(sheet.rgb[0..3], [10, 20, 30]);
        assert_eq!(sheet.rgb[15..18], [255, 0, 0]);
        assert_eq!(sheet.rgb[30..33], [12, 20, 30]);
        assert_eq!(sheet.rgb[33 + 15..33 + 18], [0, 0, 128]);
    }

    #[test]
    fn equal_pictures_leave_the_middle_black() {
        let a = Picture::of_bytes(2, 1, &[200; 6]);
        assert_eq!(of_pictures(&a, &a).rgb[18..24], [0; 6]);
    }

    #[test]
    fn differing_hits_are_white() {
        let hit = Hit { t: 1.0, tri: 0, u: 0.0, v: 0.0 };
        let sheet = of_hits(2, &[hit, hit], &[hit, Hit { v: 0.5, ..hit }]);
        assert_eq!(sheet.rgb[18..24], [0, 0, 0, 255, 255, 255]);
    }
}
