//! The shading equation of the homework: ambient, diffuse and specular light.
//!
//! C = Ka la + sum over lights of le (Kd (N.L) + Ks (R.E)^s) with R = 2 (N.L) N - L.

use glam::DVec3;
use gz_core::GzColor;

/// What the equation needs of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Ambient coefficient.
    pub ka: GzColor,
    /// Diffuse coefficient.
    pub kd: GzColor,
    /// Specular coefficient.
    pub ks: GzColor,
    /// Specular power, at least 0.
    pub power: f32,
}

/// One light's share of the equation for light of colour 1: Kd (N.L) + Ks (R.E)^s.
///
/// `n` is the unit normal, `l` points to the light, `e` to the viewer. Surfaces have two sides: where N.L and N.E are both at most 0
/// the normal is turned; where they have opposite signs the light is behind the surface and gives nothing. R.E is clamped to [0, 1].
/// A NaN in a vector gives nothing.
pub fn light_share(k: &Coefficients, n: DVec3, l: DVec3, e: DVec3) -> GzColor {
    let (nl, ne) = (n.dot(l), n.dot(e));
    let (n, nl) = if nl >= 0.0 && ne >= 0.0 {
        (n, nl)
    } else if nl <= 0.0 && ne <= 0.0 {
        (-n, -nl)
    } else {
        return GzColor::ZERO;
    };
    let diffuse = k.kd * nl as f32;
    if k.ks == GzColor::ZERO {
        return diffuse;
    }
    let r = n * (2.0 * nl) - l;
    diffuse + k.ks * power(r.dot(e).clamp(0.0, 1.0), k.power) as f32
}

/// `base` in [0, 1] to the power `exponent`, at least 0; 0 to the power 0 is 1.
///
/// An integer exponent is repeated squaring, others go through `libm`: the same bits on every machine.
pub fn power(base: f64, exponent: f32) -> f64 {
    /// Beyond this a highlight is smaller than any pixel; `libm` may do it.
    const GREATEST_INTEGER: f32 = 65536.0;
    if !(0.0..=GREATEST_INTEGER).contains(&exponent) || exponent.fract() != 0.0 {
        return libm::pow(base, f64::from(exponent));
    }
    let (mut result, mut square, mut bits) = (1.0, base, exponent as u32);
    while bits != 0 {
        if bits & 1 == 1 {
            result *= square;
        }
        square *= square;
        bits >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    const K: Coefficients =
        Coefficients { ka: GzColor::splat(0.1), kd: GzColor::splat(0.7), ks: GzColor::splat(0.3), power: 32.0 };

    #[test]
    fn head_on_light_gives_both_coefficients_whole() {
        assert_eq!(light_share(&K, DVec3::Z, DVec3::Z, DVec3::Z), GzColor::splat(1.0));
    }

    #[test]
    fn both_sides_shade_alike_and_opposite_sides_not_at_all() {
        let (l, e) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 0.6, 0.8));
        let front = light_share(&K, DVec3::Z, l, e);
        assert_eq!(front, light_share(&K, DVec3::NEG_Z, l, e));
        assert!(front.x > 0.7 * 0.8 - 1e-6);
        assert_eq!(light_share(&K, DVec3::Z, -l, e), GzColor::ZERO);
        assert_eq!(light_share(&K, DVec3::Z, l, -e), GzColor::ZERO);
    }

    #[test]
    fn a_light_in_the_plane_gives_no_diffuse_light() {
        let matt = Coefficients { ks: GzColor::ZERO, ..K };
        assert_eq!(light_share(&matt, DVec3::Z, DVec3::X, DVec3::Z), GzColor::ZERO);
        assert_eq!(light_share(&matt, DVec3::NEG_Z, DVec3::X, DVec3::Z), GzColor::ZERO);
    }

    #[test]
    fn the_highlight_is_where_the_mirror_direction_meets_the_eye() {
        let shiny = Coefficients { kd: GzColor::ZERO, ..K };
        let (l, mirrored) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.6, 0.0, 0.8));
        assert!((light_share(&shiny, DVec3::Z, l, mirrored).x - 0.3).abs() < 1e-6);
        let off = light_share(&shiny, DVec3::Z, l, DVec3::Z).x;
        assert!((f64::from(off) - 0.3 * libm::pow(0.8, 32.0)).abs() < 1e-7);
    }

    #[test]
    fn the_clamp_keeps_a_long_light_vector_from_exceeding_the_coefficient() {
        let shiny = Coefficients { kd: GzColor::ZERO, ..K };
        assert_eq!(light_share(&shiny, DVec3::Z, DVec3::Z * 1.1, DVec3::Z), GzColor::splat(0.3));
        assert_eq!(light_share(&shiny, DVec3::Z, DVec3::splat(f64::NAN), DVec3::Z), GzColor::ZERO);
    }

    #[test]
    fn powers_by_squaring_and_by_libm_agree() {
        for exponent in [0.0, 1.0, 2.0, 7.0, 32.0, 100.0, 1000.0] {
            for base in [0.0, 0.1, 0.5, 0.97, 1.0] {
                let expected = libm::pow(base, f64::from(exponent));
                assert!((power(base, exponent) - expected).abs() <= 1e-13 * expected, "{base}^{exponent}");
            }
        }
        assert_eq!((power(0.0, 0.0), power(0.25, 0.5), power(0.5, 1e9)), (1.0, 0.5, 0.0));
    }
}
