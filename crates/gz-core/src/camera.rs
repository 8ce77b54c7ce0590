//! The camera models and the homework's camera matrices.

use crate::camera_spec::{CameraError, CameraModel, CameraSpec};
use crate::{GzCoord, GzMatrix, GzRay};
use glam::{DVec2, DVec3};

/// A camera ready to make primary rays. The homework's `GzCamera`.
#[derive(Clone, Debug)]
pub struct GzCamera {
    pub(crate) spec: CameraSpec,
    /// Camera axes in world space: right, up, forward.
    pub(crate) axes: [DVec3; 3],
    /// 1 / tan(fov / 2): distance of the centre of projection from the view plane of half-height 1.
    pub(crate) d: f64,
    /// Half the extent of the view plane along x, for half-height 1.
    pub(crate) half_width: f64,
}

impl GzCamera {
    /// Makes a camera.
    ///
    /// # Errors
    ///
    /// If the description does not define one: see [`CameraError`].
    pub fn new(spec: CameraSpec) -> Result<Self, CameraError> {
        if !(1..=65535).contains(&spec.width) || !(1..=65535).contains(&spec.height) {
            return Err(CameraError::Size);
        }
        let Some(view) = spec.view else {
            if spec.model != CameraModel::Screen {
                return Err(CameraError::NoView);
            }
            return Ok(Self { spec, axes: [DVec3::X, DVec3::Y, DVec3::Z], d: 1.0, half_width: 1.0 });
        };
        if !(view.position.is_finite() && view.look_at.is_finite() && view.up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if !(view.fov > 0.0 && view.fov < 180.0) {
            return Err(CameraError::Fov);
        }
        let forward = unit(view.look_at - view.position).ok_or(CameraError::NoDirection)?;
        let up = unit(view.up).ok_or(CameraError::UpIsParallel)?;
        let up = up - forward * dot(up, forward);
        // What is left of a parallel up is rounding error; 1e-12 is far above it and far below any up that was meant.
        if dot(up, up) < 1e-24 {
            return Err(CameraError::UpIsParallel);
        }
        let up = unit(up).ok_or(CameraError::UpIsParallel)?;
        let right = match spec.model {
            CameraModel::Pinhole => forward.cross(up),
            _ => up.cross(forward),
        };
        let half_width = match spec.model {
            CameraModel::Pinhole => f64::from(spec.width) / f64::from(spec.height),
            _ => 1.0,
        };
        let d = 1.0 / libm::tan(view.fov.to_radians() / 2.0);
        Ok(Self { spec, axes: [right, up, forward], d, half_width })
    }

    /// The description this camera was made from.
    pub fn spec(&self) -> &CameraSpec {
        &self.spec
    }

    /// The camera model.
    pub fn model(&self) -> CameraModel {
        self.spec.model
    }

    /// Picture width in pixels.
    pub fn width(&self) -> u32 {
        self.spec.width
    }

    /// Picture height in pixels.
    pub fn height(&self) -> u32 {
        self.spec.height
    }

    /// Distance d of the centre of projection behind the view plane, in units in which the plane is 2 high.
    pub fn focal_distance(&self) -> f64 {
        self.d
    }

    /// World to image: camera axes, origin at the camera's position. The homework's Xiw; identity without a view.
    pub fn image_from_world(&self) -> GzMatrix {
        let Some(view) = self.spec.view else { return GzMatrix::IDENTITY };
        let row = |axis: DVec3| [axis.x, axis.y, axis.z, -dot(axis, view.position)];
        let [x, y, z] = self.axes;
        GzMatrix([row(x), row(y), row(z), [0.0, 0.0, 0.0, 1.0]])
    }

    /// Image to perspective: w becomes z/d + 1, so that the view plane z = 0 keeps its x and y. The homework's Xpi.
    pub fn perspective_from_image(&self) -> GzMatrix {
        let k = 1.0 / self.d;
        GzMatrix([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, k, 0.0], [0.0, 0.0, k, 1.0]])
    }

    /// Perspective to screen: pixels, row 0 on top, z from 0 on the view plane to 2147483647 at infinity. The homework's Xsp.
    pub fn screen_from_perspective(&self) -> GzMatrix {
        let (w, h) = (f64::from(self.spec.width) / 2.0, f64::from(self.spec.height) / 2.0);
        GzMatrix([[w, 0.0, 0.0, w], [0.0, -h, 0.0, h], [0.0, 0.0, f64::from(i32::MAX), 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// A world-space point in trace space, or `None` where this model drops the triangle it belongs to (a corner behind the view
    /// plane, z < 0, under homework and screen).
    pub fn trace_from_world(&self, p: DVec3) -> Option<DVec3> {
        match self.spec.model {
            CameraModel::Pinhole => Some(p),
            CameraModel::Paper => Some(self.image_from_world().point(p)),
            CameraModel::Homework => Some(self.image_from_world().point(p)).filter(|p| p.z >= 0.0),
            CameraModel::Screen if self.spec.view.is_none() => Some(p),
            CameraModel::Screen => {
                let image = self.image_from_world().point(p);
                let [x, y, z, w] = self.screen_from_perspective().times(&self.perspective_from_image()).homogeneous(image);
                (image.z >= 0.0).then(|| DVec3::new(x / w, y / w, z / w))
            }
        }
    }

    /// Takes world-space directions (normals, lights) to the space that shading happens in: image space under the course's models,
    /// world space under pinhole.
    pub fn shading_from_world(&self) -> GzMatrix {
        match self.spec.model {
            CameraModel::Pinhole => GzMatrix::IDENTITY,
            _ => {
                let row = |axis: DVec3| [axis.x, axis.y, axis.z, 0.0];
                let [x, y, z] = self.axes;
                GzMatrix([row(x), row(y), row(z), [0.0, 0.0, 0.0, 1.0]])
            }
        }
    }

    /// The ray through pixel (`i`, `j`), column and row from the top left, moved by `offset` pixels (x right, y down).
    ///
    /// Under pinhole an offset of 0 is the pixel's centre; under the course's models it is the integer screen point.
    pub fn ray(&self, i: u32, j: u32, offset: DVec2) -> GzRay {
        let (x, y) = (f64::from(i) + offset.x, f64::from(j) + offset.y);
        if self.spec.model == CameraModel::Screen {
            // The least tmin below 0: z = 0 is on the view plane and still visible.
            let tmin = -f32::from_bits(1);
            return GzRay { tmin, ..GzRay::from_f64(DVec3::new(x, y, 0.0), GzCoord::Z) };
        }
        GzRay::from_f64(self.common_origin(), GzCoord::from_array(self.direction(x, y).map(|x| x as f32)))
    }

    /// Weights of a triangle's corners that are linear in screen space, from the weights at the hit of a primary ray.
    ///
    /// The homework interpolates colours and normals so. Under homework a corner's weight is multiplied by its w = z/d + 1 and the
    /// sum brought back to 1; the other models return `weights` (screen space is linear already, the paper interpolates at the hit).
    pub fn screen_weights(&self, corners: &[GzCoord; 3], weights: [f64; 3]) -> [f64; 3] {
        if self.spec.model != CameraModel::Homework {
            return weights;
        }
        let scaled: [f64; 3] = std::array::from_fn(|k| weights[k] * (f64::from(corners[k].z) / self.d + 1.0));
        let sum = scaled[0] + scaled[1] + scaled[2];
        scaled.map(|w| w / sum)
    }

    /// Where all primary rays start, for the models that have such a point.
    pub(crate) fn common_origin(&self) -> DVec3 {
        match self.spec.model {
            CameraModel::Homework => DVec3::new(0.0, 0.0, -self.d),
            CameraModel::Pinhole => self.spec.view.map_or(DVec3::ZERO, |view| view.position),
            CameraModel::Paper | CameraModel::Screen => DVec3::ZERO,
        }
    }
}

fn dot(a: DVec3, b: DVec3) -> f64 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// `v` at length 1 up to rounding; `None` when its length is 0 or not finite.
fn unit(v: DVec3) -> Option<DVec3> {
    let length = dot(v, v).sqrt();
    (length > 0.0 && length.is_finite()).then(|| v / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View;

    fn application5(model: CameraModel) -> GzCamera {
        let view = View {
            position: DVec3::new(-3.0, -25.0, -4.0),
            look_at: DVec3::new(7.8, 0.7, 6.5),
            up: DVec3::new(-0.2, 1.0, 0.0),
            fov: 63.7,
        };
        GzCamera::new(CameraSpec { model, view: Some(view), width: 256, height: 256 }).unwrap()
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-6 * b.abs().max(1.0)
    }

    #[test]
    fn application5_has_the_known_axes_and_focal_distance() {
        let camera = application5(CameraModel::Homework);
        assert!(near(camera.focal_distance(), 1.609_696_6), "{}", camera.focal_distance());
        let expected = [
            [0.546798, 0.109360, -0.830092, 1.054019],
            [-0.754698, 0.493686, -0.432094, 8.349676],
            [0.362551, 0.862737, 0.352480, 24.065992],
        ];
        for (row, expected) in camera.image_from_world().0.iter().zip(expected) {
            assert!(row.iter().zip(expected).all(|(&a, b)| near(a, b)), "{row:?} {expected:?}");
        }
    }

    #[test]
    fn a_point_goes_through_image_space_to_its_known_screen_place() {
        // The first teapot vertex of the course data after its placement.
        let image = DVec3::new(3.75547, 3.81249, 28.54613);
        let camera = application5(CameraModel::Homework);
        let [x, y, z, w] = camera.screen_from_perspective().times(&camera.perspective_from_image()).homogeneous(image);
        assert!((x / w - 153.6594).abs() < 1e-3 && (y / w - 101.9510).abs() < 1e-3, "{} {}", x / w, y / w);
        assert!((z / w - 2_032_852_512.0).abs() < 500.0, "{}", z / w);
    }

    #[test]
    fn homework_ray_of_a_pixel_runs_through_that_screen_point() {
        let camera = application5(CameraModel::Homework);
        let ray = camera.ray(60, 100, DVec2::ZERO);
        let [x, y, _, w] = camera.screen_from_perspective().times(&camera.perspective_from_image()).homogeneous(ray.at(40.0));
        assert!(near(x / w, 60.0) && near(y / w, 100.0), "{} {}", x / w, y / w);
        assert_eq!(application5(CameraModel::Paper).ray(60, 100, DVec2::ZERO).direction, ray.direction);
    }

    #[test]
    fn pinhole_is_right_handed_with_square_pixels() {
        let view = View { position: DVec3::Z * 5.0, look_at: DVec3::ZERO, up: DVec3::Y, fov: 90.0 };
        let camera =
            GzCamera::new(CameraSpec { model: CameraModel::Pinhole, view: Some(view), width: 200, height: 100 }).unwrap();
        let corner = camera.ray(199, 0, DVec2::new(0.5, -0.5)).direction;
        let expected = DVec3::new(2.0, 1.0, -1.0).normalize().as_vec3();
        assert!((corner - expected).abs().max_element() < 1e-6, "{corner}");
        assert_eq!(camera.trace_from_world(DVec3::ONE), Some(DVec3::ONE));
    }

    #[test]
    fn impossible_cameras_are_refused_with_their_reason() {
        let good = *application5(CameraModel::Homework).spec();
        let view = good.view.unwrap();
        let with = |view: View| GzCamera::new(CameraSpec { view: Some(view), ..good }).unwrap_err();
        assert_eq!(with(View { look_at: view.position, ..view }), CameraError::NoDirection);
        assert_eq!(with(View { up: (view.look_at - view.position) * -3.0, ..view }), CameraError::UpIsParallel);
        assert_eq!(with(View { up: DVec3::ZERO, ..view }), CameraError::UpIsParallel);
        for fov in [0.0, 180.0, -1.0, f64::NAN] {
            assert_eq!(with(View { fov, ..view }), CameraError::Fov);
        }
        assert_eq!(with(View { position: DVec3::splat(f64::NAN), ..view }), CameraError::NotFinite);
        assert_eq!(GzCamera::new(CameraSpec { width: 0, ..good }).unwrap_err(), CameraError::Size);
        assert_eq!(GzCamera::new(CameraSpec { view: None, ..good }).unwrap_err(), CameraError::NoView);
    }

    #[test]
    fn corners_behind_the_view_plane_drop_their_triangle_only_where_the_course_does() {
        let behind = DVec3::new(-3.0, -25.0, -4.0) - DVec3::new(10.8, 25.7, 10.5);
        assert_eq!(application5(CameraModel::Homework).trace_from_world(behind), None);
        assert_eq!(application5(CameraModel::Screen).trace_from_world(behind), None);
        assert!(application5(CameraModel::Paper).trace_from_world(behind).is_some());
    }

    #[test]
    fn screen_weights_undo_the_perspective() {
        let camera = application5(CameraModel::Homework);
        let corners = [[-3.0, -2.0, 5.0], [4.0, -1.0, 40.0], [0.0, 5.0, 15.0]].map(GzCoord::from_array);
        let weights = [0.2, 0.5, 0.3];
        let screen = camera.screen_weights(&corners, weights);
        // The screen point of the weighted corners is the screen-weighted sum of the corners' screen points.
        let project = |p: DVec3| {
            let [x, y, _, w] = camera.perspective_from_image().homogeneous(p);
            DVec2::new(x / w, y / w)
        };
        let at = |k: usize| corners[k].as_dvec3();
        let direct = project(at(0) * weights[0] + at(1) * weights[1] + at(2) * weights[2]);
        let summed = project(at(0)) * screen[0] + project(at(1)) * screen[1] + project(at(2)) * screen[2];
        assert!((direct - summed).length() < 1e-12, "{direct} {summed}");
    }
}
