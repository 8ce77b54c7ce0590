//! The primary rays of many pixels, eight at a time.

use crate::camera::GzCamera;
use crate::simd::{Doubles, EightDoubles, Lanes, Simd, Task, dispatch};
use crate::{CameraModel, GzCoord, PerRay, RayBatch, SimdLevel};
use glam::{DVec2, DVec3};

/// Room for the primary rays of a batch, kept between batches.
#[derive(Clone, Debug, Default)]
pub struct PrimaryRays {
    origins: Vec<DVec3>,
    directions: Vec<GzCoord>,
}

impl GzCamera {
    /// The primary rays of `pixels` at one `offset`, as a batch that knows what they share. Row `k` is for `pixels[k]`.
    pub fn rays<'a>(&self, pixels: &[(u32, u32)], offset: DVec2, store: &'a mut PrimaryRays) -> RayBatch<'a> {
        store.origins.clear();
        store.directions.clear();
        if self.spec.model == CameraModel::Screen {
            store.origins.extend(pixels.iter().map(|&(i, j)| self.ray(i, j, offset).origin));
            let tmin = self.ray(0, 0, offset).tmin;
            return RayBatch::new(
                pixels.len(),
                PerRay::Each(&store.origins),
                PerRay::One(GzCoord::Z),
                PerRay::One(tmin),
                PerRay::One(f32::INFINITY),
            );
        }
        dispatch(SimdLevel::best(), Directions { camera: self, pixels, offset, directions: &mut store.directions });
        RayBatch::unbounded(pixels.len(), PerRay::One(self.common_origin()), PerRay::Each(&store.directions))
    }

    /// The direction, at length 1, of the ray through the place (`x`, `y`) of the picture, in pixels, for models with a centre.
    #[inline(always)]
    pub(crate) fn direction<D: Doubles>(&self, x: D, y: D) -> [D; 3] {
        let (one, two) = (D::splat(1.0), D::splat(2.0));
        let (width, height) = (D::splat(f64::from(self.spec.width)), D::splat(f64::from(self.spec.height)));
        let v = if self.spec.model == CameraModel::Pinhole {
            let half = D::splat(0.5);
            let x = two.times(x.plus(half)).over(width).minus(one).times(D::splat(self.half_width));
            let y = one.minus(two.times(y.plus(half)).over(height));
            let mut v = [one; 3];
            for (axis, v) in v.iter_mut().enumerate() {
                let [right, up, forward] = &self.axes;
                let ahead = D::splat(forward[axis] * self.d);
                *v = D::splat(right[axis]).times(x).plus(D::splat(up[axis]).times(y)).plus(ahead);
            }
            v
        } else {
            let (x, y) = (two.times(x).over(width).minus(one), one.minus(two.times(y).over(height)));
            [x, y, D::splat(self.d)]
        };
        let length = v[0].times(v[0]).plus(v[1].times(v[1])).plus(v[2].times(v[2])).sqrt();
        [v[0].over(length), v[1].over(length), v[2].over(length)]
    }
}

/// Directions of primary rays, eight pixels at a time.
struct Directions<'a> {
    camera: &'a GzCamera,
    pixels: &'a [(u32, u32)],
    offset: DVec2,
    directions: &'a mut Vec<GzCoord>,
}

impl Task for Directions<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        for pixels in self.pixels.chunks(8) {
            let (mut x, mut y) = ([0.0; 8], [0.0; 8]);
            for (k, &(i, j)) in pixels.iter().enumerate() {
                (x[k], y[k]) = (f64::from(i), f64::from(j));
            }
            let x = <S::Doubles>::load(&x).plus(<S::Doubles>::splat(self.offset.x));
            let y = <S::Doubles>::load(&y).plus(<S::Doubles>::splat(self.offset.y));
            let d = self.camera.direction(x, y);
            let d = [S::narrow(d[0]).array(), S::narrow(d[1]).array(), S::narrow(d[2]).array()];
            let [x, y, z] = &d;
            let eight = x.iter().zip(y).zip(z).map(|((&x, &y), &z)| GzCoord::new(x, y, z));
            self.directions.extend(eight.take(pixels.len()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CameraSpec, View};

    #[test]
    fn many_rays_are_those_of_one_pixel_at_every_level() {
        let view = View { position: DVec3::new(4.2, 5.2, 9.5), look_at: DVec3::new(0.6, 0.4, -0.3), up: DVec3::Y, fov: 42.0 };
        let pixels: Vec<(u32, u32)> = (0..1003).map(|k| (k * 37 % 640, k * 91 % 480)).collect();
        for model in [CameraModel::Homework, CameraModel::Paper, CameraModel::Pinhole, CameraModel::Screen] {
            let camera = GzCamera::new(CameraSpec { model, view: Some(view), width: 640, height: 480 }).unwrap();
            for offset in [DVec2::ZERO, DVec2::new(-0.41, 0.27)] {
                let expected: Vec<_> = pixels.iter().map(|&(i, j)| camera.ray(i, j, offset)).collect();
                let mut store = PrimaryRays::default();
                let rays = camera.rays(&pixels, offset, &mut store);
                assert!(expected.iter().enumerate().all(|(k, ray)| rays.ray(k) == *ray), "{model:?}");
                for &level in SimdLevel::available() {
                    let mut directions = Vec::new();
                    dispatch(level, Directions { camera: &camera, pixels: &pixels, offset, directions: &mut directions });
                    let differ = |(direction, ray): (&GzCoord, &crate::GzRay)| *direction != ray.direction;
                    let differ = directions.iter().zip(&expected).filter(|&pair| differ(pair)).count();
                    assert!(model == CameraModel::Screen || differ == 0, "{differ} of {} at {level:?}, {model:?}", pixels.len());
                }
            }
        }
    }
}
