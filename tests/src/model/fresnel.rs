//! Schlick's approximation against the Fresnel equations, over all angles.

use super::{Table, figure};
use gz_shade::optics::{fresnel, schlick};

/// How far an approximation of the reflected share is off, over angles of incidence spread evenly from 0 to 90 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleError {
    /// The greatest error.
    pub max: f64,
    /// Where it is, in degrees from the normal.
    pub at: f64,
    /// The mean of the errors' magnitudes.
    pub mean: f64,
    /// Angles.
    pub n: u32,
}

/// Angles compared: the middles of as many equal parts of 0 to 90 degrees.
const ANGLES: u32 = 9000;

/// The error of `approximation(cos_i)` of the reflected share at a boundary with `eta` = n1 / n2.
pub fn angle_error(eta: f64, approximation: impl Fn(f64) -> f64) -> AngleError {
    let mut error = AngleError { max: 0.0, at: 0.0, mean: 0.0, n: ANGLES };
    for k in 0..ANGLES {
        let degrees = (f64::from(k) + 0.5) * 90.0 / f64::from(ANGLES);
        let cos = degrees.to_radians().cos();
        let off = (approximation(cos) - fresnel(cos, eta)).abs();
        error.mean += off / f64::from(ANGLES);
        if off > error.max {
            (error.max, error.at) = (off, degrees);
        }
    }
    error
}

pub(super) fn table() -> Table {
    let mut rows = Vec::new();
    for n in [1.5, 1.1] {
        let cases = [
            ("air", angle_error(1.0 / n, |cos| schlick(cos, 1.0 / n))),
            ("glass", angle_error(n, |cos| schlick(cos, n))),
            // From the air side the formula takes the cosine of the incoming ray, whatever the side.
            ("glass, by the incoming angle", angle_error(n, |cos| schlick(cos, 1.0 / n))),
        ];
        for (side, AngleError { max, at, mean, n: angles }) in cases {
            rows.push(vec![n.to_string(), side.to_owned(), figure(max), format!("{at:.1}"), figure(mean), angles.to_string()]);
        }
    }
    Table {
        title: "Schlick against Fresnel, by angle".to_owned(),
        how:
            "The reflected share is a number from 0 to 1; its error is taken at n angles of incidence spread evenly from 0 to 90 \
              degrees. *By the incoming angle* is the paper's formula used from the dense side as it stands, which this renderer \
              does not do: it takes the cosine behind the boundary there, and 1 under total reflection."
                .to_owned(),
        columns: vec!["index", "coming from", "max error", "at degrees", "mean error", "n"],
        rows,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schlick_is_near_fresnel_with_the_angle_behind_the_boundary_and_far_off_without() {
        // The lower the index, the later and steeper the rise towards grazing angles, and the worse the fifth power fits it.
        for (n, most) in [(1.5, 0.036), (1.1, 0.211)] {
            let air = angle_error(1.0 / n, |cos| schlick(cos, 1.0 / n));
            let glass = angle_error(n, |cos| schlick(cos, n));
            assert!(air.max < most && glass.max < most, "{n}: {air:?} {glass:?}");
            assert!(air.mean < air.max && air.mean > 0.0 && glass.mean > 0.0);
            assert!(angle_error(n, |cos| schlick(cos, 1.0 / n)).max > 0.8);
        }
        assert_eq!(angle_error(1.0 / 1.5, |cos| fresnel(cos, 1.0 / 1.5)).max, 0.0);
    }
}
