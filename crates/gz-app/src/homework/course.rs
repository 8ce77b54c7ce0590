//! What the course's application sets: its lights and where it puts the teapot, in the four digits that it was given in.
#![allow(clippy::approx_constant, reason = "the course's directions have four digits")]

use super::GzAttribute;
use gz_core::{GzColor, GzMatrix};

/// The lights of HW4 to HW6: three directional ones, whose directions point to the light in image space, and the ambient one.
pub fn course_lights() -> [GzAttribute; 4] {
    let directional =
        |direction: [f64; 3], color: [f32; 3]| GzAttribute::DirectionalLight { direction: direction.into(), color: color.into() };
    [
        directional([-0.7071, 0.7071, 0.0], [0.5, 0.5, 0.9]),
        directional([0.0, -0.7071, -0.7071], [0.9, 0.2, 0.3]),
        directional([0.7071, 0.0, -0.7071], [0.2, 0.7, 0.3]),
        GzAttribute::AmbientLight(GzColor::splat(0.3)),
    ]
}

/// The model matrices of HW5's teapot in the order they are pushed: scale and translate, rotate about y by -30 degrees, about x
/// by -45. The last acts first.
pub fn course_placement() -> [GzMatrix; 3] {
    let s = 3.25;
    let (sin30, cos30, sin45) = (0.5, 0.866, 0.7071);
    [
        GzMatrix([[s, 0.0, 0.0, 0.0], [0.0, s, 0.0, -3.25], [0.0, 0.0, s, 3.5], [0.0, 0.0, 0.0, 1.0]]),
        GzMatrix([[cos30, 0.0, -sin30, 0.0], [0.0, 1.0, 0.0, 0.0], [sin30, 0.0, cos30, 0.0], [0.0, 0.0, 0.0, 1.0]]),
        GzMatrix([[1.0, 0.0, 0.0, 0.0], [0.0, sin45, sin45, 0.0], [0.0, -sin45, sin45, 0.0], [0.0, 0.0, 0.0, 1.0]]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::glam::DVec3;

    #[test]
    fn directions_are_unit_and_rotations_turn_to_four_digits() {
        for light in course_lights() {
            if let GzAttribute::DirectionalLight { direction, .. } = light {
                assert!((direction.length() - 1.0).abs() < 1e-4, "{direction}");
            }
        }
        let [place, about_y, about_x] = course_placement();
        assert_eq!(place.point(DVec3::ZERO), DVec3::new(0.0, -3.25, 3.5));
        let (x, y) = (about_y.vector(DVec3::X), about_x.vector(DVec3::Y));
        assert!((x.z.atan2(x.x).to_degrees() - 30.0).abs() < 1e-2);
        assert!((y.z.atan2(y.y).to_degrees() + 45.0).abs() < 1e-2);
    }
}
