//! Points of surfaces, eight side by side.

use crate::kernel::FindPoints;
use crate::simd::{EightDoubles, dispatch};
use crate::{GzCoord, GzRay, SimdLevel, SurfacePoint};
use glam::DVec3;

/// The points where eight rays have hit triangles: the numbers of eight [`SurfacePoint`], lane `i` of each row for ray `i`.
#[derive(Clone, Debug)]
pub struct EightPoints {
    /// Weights of the corners.
    pub weights: [[f64; 8]; 3],
    /// The points, trace space.
    pub point: [[f64; 8]; 3],
    /// The sides of the triangles' planes that the rays go to.
    pub to_side: [i8; 8],
    /// Unit normals of the triangles.
    pub normal: [[f64; 8]; 3],
    pub(crate) lean: [f64; 8],
    pub(crate) starts: [[[f64; 8]; 3]; 2],
    /// The lanes whose rays have places to leave from.
    pub(crate) leaving: u32,
}

impl EightPoints {
    /// Of rays that hit nothing.
    pub const NOWHERE: Self = Self {
        weights: [[0.0; 8]; 3],
        point: [[0.0; 8]; 3],
        to_side: [0; 8],
        normal: [[0.0; 8]; 3],
        lean: [f64::INFINITY; 8],
        starts: [[[0.0; 8]; 3]; 2],
        leaving: 0,
    };

    /// Finds where each ray, by its origin and direction, meets the triangle with its corners, which it is known to hit; with places to leave
    /// from if `leaving`. With the instructions of `level`; the numbers are those of [`SurfacePoint::of`].
    pub fn find(
        &mut self,
        origins: &[[f64; 3]; 8],
        directions: &[[f32; 3]; 8],
        corners: &[&[GzCoord; 3]; 8],
        leaving: bool,
        level: SimdLevel,
    ) {
        let settled = dispatch(level, FindPoints { origins, directions, corners, leaving, points: self });
        for k in (0..8).filter(|k| settled >> k & 1 == 0) {
            let ray = GzRay::from_f64(origins[k].into(), directions[k].into());
            self.set(k, &SurfacePoint::of(&ray, corners[k], leaving));
        }
    }

    fn set(&mut self, k: usize, of: &SurfacePoint) {
        let starts = of.starts.unwrap_or_default();
        for axis in 0..3 {
            self.weights[axis][k] = of.weights[axis];
            self.point[axis][k] = of.point[axis];
            self.normal[axis][k] = of.normal[axis];
            for (rows, start) in self.starts.iter_mut().zip(starts) {
                rows[axis][k] = start[axis];
            }
        }
        (self.to_side[k], self.lean[k]) = (of.to_side, of.lean);
        self.leaving = self.leaving & !(1 << k) | u32::from(of.starts.is_some()) << k;
    }

    /// Point number `k`.
    pub fn lane(&self, k: usize) -> SurfacePoint {
        SurfacePoint {
            weights: self.weights.map(|row| row[k]),
            point: self.point.map(|row| row[k]).into(),
            to_side: self.to_side[k],
            normal: self.normal.map(|row| row[k]).into(),
            lean: self.lean[k],
            starts: (self.leaving >> k & 1 != 0).then(|| self.starts.map(|rows| rows.map(|row| row[k]).into())),
        }
    }

    /// Which `directions` point to side 1 of their triangles and which to side -1, bit `i` for lane `i`: those that the normals tell, as
    /// most do. About others [`crate::side_of`] knows.
    #[inline(always)]
    pub fn sides<D: EightDoubles>(&self, directions: &[D; 3]) -> (u32, u32) {
        let [x, y, z] = *directions;
        let normal = [D::load(&self.normal[0]), D::load(&self.normal[1]), D::load(&self.normal[2])];
        let slope = normal[0].times(x).plus(normal[1].times(y)).plus(normal[2].times(z));
        let error = D::load(&self.lean).times(x.abs().plus(y.abs()).plus(z.abs()));
        let minus = D::splat(0.0).minus(slope);
        // Both ways, as NaN tells nothing.
        (error.at_most(slope) & !slope.at_most(error), error.at_most(minus) & !minus.at_most(error))
    }

    /// Where a ray starts that leaves point `k` to `side`: see [`SurfacePoint::start`].
    #[inline]
    pub fn start(&self, k: usize, side: i8) -> Option<DVec3> {
        let rows = match side {
            1 => &self.starts[0],
            -1 => &self.starts[1],
            _ => return None,
        };
        (self.leaving >> k & 1 != 0).then(|| DVec3::new(rows[0][k], rows[1][k], rows[2][k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Simd, Task};
    use crate::surface::tests::asked;
    use crate::{BruteForce, RayQuery, side_of};

    /// The sides that f32 directions lead to.
    struct Sides<'p>(&'p EightPoints, [[f32; 3]; 8]);

    impl Task for Sides<'_> {
        type Output = (u32, u32);

        #[inline(always)]
        fn run<S: Simd>(self) -> Self::Output {
            let mut directions = [[0.0; 3]; 8];
            for (to, from) in directions.iter_mut().zip(self.1) {
                *to = from.map(f64::from);
            }
            self.0.sides(&<S::Doubles>::unzip3(&directions))
        }
    }

    #[test]
    fn eight_points_are_those_of_one_at_every_level() {
        let (tris, asked) = asked();
        let brute = BruteForce::new(&tris);
        let hits: Vec<_> = asked
            .into_iter()
            .filter(|&(ray, tri)| brute.closest_hit(&ray).is_hit() && crate::kernel::is_hit(&ray, tris.position(tri)))
            .collect();
        assert!(hits.len() > 1500, "{}", hits.len());
        let (mut told, mut open) = (0, 0);
        for eight in hits.chunks_exact(8) {
            let rays = std::array::from_fn(|k| eight[k].0);
            let (origins, ways) = (rays.map(|ray: GzRay| ray.origin.to_array()), rays.map(|ray| ray.direction.to_array()));
            let corners = std::array::from_fn(|k| tris.position(eight[k].1));
            let directions = [GzCoord::new(0.1, -0.8, 0.3), GzCoord::Z, corners[0][1] - corners[0][0]];
            for &level in SimdLevel::available() {
                for leaving in [true, false] {
                    let mut points = EightPoints::NOWHERE;
                    points.find(&origins, &ways, &corners, leaving, level);
                    for k in 0..8 {
                        let expected = SurfacePoint::of(&rays[k], corners[k], leaving);
                        assert_eq!(points.lane(k), expected, "at {level:?}");
                        for side in [-1, 0, 1] {
                            assert_eq!(points.start(k, side), expected.start(side));
                        }
                    }
                    for direction in directions {
                        let (up, down) = dispatch(level, Sides(&points, [direction.to_array(); 8]));
                        for (k, corners) in corners.iter().enumerate() {
                            let side = (up >> k & 1) as i8 - (down >> k & 1) as i8;
                            assert!(side == 0 || side == side_of(corners, direction), "{corners:?} {direction} at {level:?}");
                            if side == 0 { open += 1 } else { told += 1 }
                        }
                    }
                }
            }
        }
        assert!(told > 2 * open && open > 0, "{told} told, {open} open");
    }
}
