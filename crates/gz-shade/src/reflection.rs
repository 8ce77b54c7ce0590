//! Mirrors, the plain version: the paper's section 2.3.5.

use glam::DVec3;

/// The direction in which a ray along `d` leaves a mirror with the unit normal `n`: d - 2 (d.n) n.
///
/// Either sign of `n` gives the same answer; the length of `d` is kept. A ray in the mirror's plane goes on as it came.
///
/// Source: the paper, section 2.3.5 and its program, which turns the normal against the ray first and so computes the same.
pub fn reflect(d: DVec3, n: DVec3) -> DVec3 {
    d - n * (2.0 * d.dot(n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_bounces_at_the_angle_it_came() {
        assert_eq!(reflect(DVec3::new(3.0, -4.0, 0.0), DVec3::Y), DVec3::new(3.0, 4.0, 0.0));
        assert_eq!(reflect(DVec3::new(3.0, -4.0, 0.0), DVec3::NEG_Y), DVec3::new(3.0, 4.0, 0.0));
        assert_eq!(reflect(DVec3::X, DVec3::Y), DVec3::X);
    }
}
