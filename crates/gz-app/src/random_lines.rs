//! Lines through a box, each as likely as any other.

use glam::{DVec2, DVec3};
use gz_core::{Bounds, GzRay};

/// An endless run of random lines through a box, the same for the same seed.
///
/// The lines that enter a convex body, none more likely than another, enter it evenly over its surface, and at each place in directions
/// that are as likely as the cosine of their angle with the normal. So a line is a place on the box and a place on a unit disc above
/// it. It is a ray without ends: t runs from minus to plus infinity.
#[derive(Clone, Debug)]
pub struct RandomLines {
    min: DVec3,
    size: DVec3,
    /// Area of the faces across x, and across x and y, as shares of all.
    shares: [f64; 2],
    state: u64,
}

/// Origins of smaller magnitude than this, other than 0, are no ray's.
const LEAST_ORIGIN: f64 = f64::from_bits((1023 - 150) << 52);

impl RandomLines {
    /// Lines through `bounds`; `None` when it has no area.
    pub fn through(bounds: &Bounds, seed: u64) -> Option<Self> {
        if bounds.is_empty() {
            return None;
        }
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let size = max - min;
        let areas = DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y);
        let whole = areas.element_sum();
        let shares = [areas.x / whole, (areas.x + areas.y) / whole];
        (whole > 0.0).then_some(Self { min, size, shares, state: seed })
    }

    /// Uniform in [0, 1), by the generator SplitMix64.
    fn unit(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A place on the unit disc.
    fn on_disc(&mut self) -> DVec2 {
        loop {
            let p = DVec2::new(self.unit(), self.unit()) * 2.0 - 1.0;
            if p.length_squared() < 1.0 {
                return p;
            }
        }
    }
}

impl Iterator for RandomLines {
    type Item = GzRay;

    fn next(&mut self) -> Option<GzRay> {
        let face = self.unit();
        let axis = self.shares.iter().filter(|share| face >= **share).count();
        let is_upper = self.unit() < 0.5;
        let mut place = DVec3::new(self.unit(), self.unit(), self.unit());
        place[axis] = f64::from(u8::from(is_upper));
        let across = self.on_disc();
        let mut direction = DVec3::ZERO;
        direction[(axis + 1) % 3] = across.x;
        direction[(axis + 2) % 3] = across.y;
        direction[axis] = (1.0 - across.length_squared()).sqrt() * if is_upper { -1.0 } else { 1.0 };
        let origin = self.min + place * self.size;
        let origin = origin.map(|x| if x.abs() < LEAST_ORIGIN { 0.0 } else { x });
        Some(GzRay { tmin: f32::NEG_INFINITY, ..GzRay::from_f64(origin, direction.as_vec3()) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::{BruteForce, GzCoord, RayQuery, TriBuffer};

    #[test]
    fn lines_are_valid_and_go_through_the_box() {
        let bounds = Bounds { min: GzCoord::new(-1.0, 0.0, 2.0), max: GzCoord::new(3.0, 1.0, 2.5) };
        for line in RandomLines::through(&bounds, 5).unwrap().take(1000) {
            assert!(line.is_valid(), "{line:?}");
            let inner = line.at(1e-3).as_vec3();
            assert!(bounds.min.cmple(inner + 1e-3).all() && bounds.max.cmpge(inner - 1e-3).all(), "{line:?}");
        }
        let one = |seed| RandomLines::through(&bounds, seed).unwrap().next().unwrap();
        assert!(one(5) == one(5) && one(5) != one(6));
    }

    #[test]
    fn a_rectangle_inside_is_met_by_its_share() {
        // A rectangle of 2 by 1 across x inside of a box of 4 by 2 by 1: twice its area is 4, the box's 28.
        let corners = [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 2.0, 1.0], [0.0, 0.0, 1.0]].map(GzCoord::from_array);
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let bounds = Bounds { min: GzCoord::new(-1.0, 0.0, 0.0), max: GzCoord::new(3.0, 2.0, 1.0) };
        let (brute, n) = (BruteForce::new(&tris), 50_000);
        let met = RandomLines::through(&bounds, 1).unwrap().take(n).filter(|line| brute.any_hit(line)).count();
        let share = met as f64 / n as f64;
        assert!((share - 4.0 / 28.0).abs() < 0.006, "{share} of {n} lines");
    }

    #[test]
    fn a_flat_box_has_two_faces_and_a_thinner_one_none() {
        let flat = Bounds { min: GzCoord::ZERO, max: GzCoord::new(1.0, 2.0, 0.0) };
        let z: Vec<f32> = RandomLines::through(&flat, 2).unwrap().take(100).map(|line| line.direction.z).collect();
        assert!(z.iter().any(|z| *z > 0.0) && z.iter().any(|z| *z < 0.0));
        assert!(RandomLines::through(&Bounds { max: GzCoord::X, ..flat }, 2).is_none());
        assert!(RandomLines::through(&Bounds::EMPTY, 2).is_none());
    }
}
