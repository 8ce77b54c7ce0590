//! Glass, the plain version: Snell's law with total internal reflection, the paper's section 2.3.6.

use glam::DVec3;

/// The cosine behind the boundary, from the one before it; `None` under total internal reflection.
///
/// `cos_i`, the cosine between the normal and the incoming ray, is clamped to [0, 1]: a rounded dot product may exceed 1. `eta` is
/// n1 / n2, the index on the incoming side over the other, above 0. At the critical angle exactly the answer is 0. A NaN gives
/// `None`.
///
/// Source: the paper, section 2.3.6: sin^2 t = (n1/n2)^2 sin^2 i = (n1/n2)^2 (1 - cos^2 i).
pub fn cos_transmitted(cos_i: f64, eta: f64) -> Option<f64> {
    let cos_i = cos_i.clamp(0.0, 1.0);
    // (1 - c)(1 + c) instead of 1 - c^2: no cancellation near c = 1.
    let k = 1.0 - eta * eta * ((1.0 - cos_i) * (1.0 + cos_i));
    (k >= 0.0).then(|| k.sqrt()) // k < 0 and NaN never reach the root
}

/// The direction in which a ray along the unit vector `d` goes on behind a boundary; `None` under total internal reflection.
///
/// `n` is the unit normal on the side the ray comes from (d.n <= 0), `eta` = n1 / n2 as in [`cos_transmitted`]. The answer has
/// length 1. At `eta == 1` it is `d`, bit for bit.
///
/// Source: Snell's law in vector form, t = eta d + (eta cos i - cos t) n.
pub fn refract(d: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    if eta == 1.0 {
        return Some(d);
    }
    let cos_i = (-d.dot(n)).clamp(0.0, 1.0);
    let cos_t = cos_transmitted(cos_i, eta)?;
    Some((d * eta + n * (eta * cos_i - cos_t)).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit ray that comes down on the xz plane at `theta` from the normal.
    fn coming_down(theta: f64) -> DVec3 {
        DVec3::new(libm::sin(theta), -libm::cos(theta), 0.0)
    }

    #[test]
    fn g1_equal_indices_change_nothing() {
        for theta in [0.0, 0.3, 1.0, 1.57] {
            assert_eq!(refract(coming_down(theta), DVec3::Y, 1.0), Some(coming_down(theta)));
        }
    }

    #[test]
    fn snells_law_holds_both_ways() {
        for eta in [1.0 / 1.5, 1.5, 1.0 / 1.33, 0.66, 2.4] {
            for theta in [0.0, 0.1, 0.3, 0.4] {
                let out = refract(coming_down(theta), DVec3::Y, eta).unwrap();
                assert!((out.x - eta * libm::sin(theta)).abs() < 1e-15, "sin t = eta sin i");
                assert!((out.length() - 1.0).abs() < 1e-15 && out.y < 0.0 && out.z == 0.0);
                // G2: the way back is the same physics with the sides swapped.
                let back = refract(-out, DVec3::NEG_Y, 1.0 / eta).unwrap();
                assert!((back + coming_down(theta)).length() < 1e-14);
            }
        }
    }

    #[test]
    fn g4_a_cosine_above_one_is_clamped() {
        assert_eq!(cos_transmitted(1.0 + 4e-7, 1.5), Some(1.0));
        assert_eq!(cos_transmitted(-1e-9, 1.0 / 1.5), cos_transmitted(0.0, 1.0 / 1.5));
        let long = DVec3::new(0.0, -1.0 - 4e-7, 0.0);
        assert_eq!(refract(long, DVec3::Y, 1.5), Some(DVec3::NEG_Y));
    }

    #[test]
    fn g5_the_critical_angle_splits_to_1e_7() {
        let critical = libm::asin(1.0 / 1.5);
        assert!(refract(coming_down(critical - 1e-7), DVec3::Y, 1.5).is_some());
        assert_eq!(refract(coming_down(critical + 1e-7), DVec3::Y, 1.5), None);
        // With eta^2 (1 - cos^2) = 1 exactly, the ray goes on along the surface.
        assert_eq!(cos_transmitted(0.0, 1.0), Some(0.0));
    }

    #[test]
    fn g6_total_reflection_and_nan_are_none_never_a_zero_direction() {
        assert_eq!(refract(coming_down(1.2), DVec3::Y, 1.5), None);
        assert_eq!(cos_transmitted(f64::NAN, 1.5), None);
        assert_eq!(cos_transmitted(0.5, f64::NAN), None);
    }
}
