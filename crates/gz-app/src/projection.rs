//! From points to pixels: what `GzCamera::ray` does, backwards.

use gz_core::glam::{DVec2, DVec3};
use gz_core::{CameraModel, GzCamera, GzMatrix};

/// A camera as it places points of trace space on the picture.
#[derive(Clone, Debug)]
pub struct Projection {
    model: CameraModel,
    eye_from_trace: GzMatrix,
    /// Pixels for a tangent of 1, along x and down along y.
    scale: DVec2,
    /// The pixel that is looked at.
    middle: DVec2,
}

/// A part of a straight line as the picture has it: at both ends the pixel, and the point relative to the eye (x right, y up, z forward).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Column and row, fractions of a pixel included; a whole number is where `GzCamera::ray` sends its ray through without an offset.
    pub pixels: [DVec2; 2],
    points: [DVec3; 2],
    parallel: bool,
}

impl Projection {
    /// Of `camera`.
    pub fn of(camera: &GzCamera) -> Self {
        let (model, d) = (camera.model(), camera.focal_distance());
        let size = DVec2::new(f64::from(camera.width()), f64::from(camera.height()));
        let half = size / 2.0;
        let (eye_from_trace, scale, middle) = match model {
            CameraModel::Screen => (GzMatrix::IDENTITY, DVec2::ONE, DVec2::ZERO),
            CameraModel::Paper => (GzMatrix::IDENTITY, half * d, half),
            // The centre of projection lies d behind the image plane.
            CameraModel::Homework => {
                let mut back = GzMatrix::IDENTITY;
                back.0[2][3] = d;
                (back, half * d, half)
            }
            // Pixels are square, and rays go through their centres.
            CameraModel::Pinhole => (camera.image_from_world(), DVec2::splat(half.y * d), half - 0.5),
        };
        Self { model, eye_from_trace, scale, middle }
    }

    /// The pixel of a point and the T-value of a primary ray there; `None` for what lies behind the eye.
    pub fn pixel(&self, point: DVec3) -> Option<(DVec2, f64)> {
        let seen = self.eye_from_trace.point(point);
        if self.model == CameraModel::Screen {
            return Some((DVec2::new(seen.x, seen.y), seen.z));
        }
        (seen.z > 0.0).then(|| (self.place(seen), seen.length()))
    }

    /// The line from `a` to `b`, cut off where it goes behind the eye and beyond `margin` pixels outside of the picture of this size; `None`
    /// when nothing is left.
    pub fn segment(&self, a: DVec3, b: DVec3, size: DVec2, margin: f64) -> Option<Segment> {
        let mut points = [a, b].map(|p| self.eye_from_trace.point(p));
        let parallel = self.model == CameraModel::Screen;
        if !parallel {
            let near = 1e-6 * points[0].length().max(points[1].length());
            let [z0, z1] = points.map(|p| p.z);
            if z0.max(z1) <= near {
                return None;
            }
            let cut = points[0] + (points[1] - points[0]) * ((near - z0) / (z1 - z0));
            for (point, z) in points.iter_mut().zip([z0, z1]) {
                if z < near {
                    *point = cut;
                }
            }
        }
        let whole = Segment { pixels: points.map(|p| self.place(p)), points, parallel };
        let (from, to) = within(whole.pixels, DVec2::splat(-margin), size + margin)?;
        Some(Segment { pixels: [whole.at(from).0, whole.at(to).0], points: [whole.point(from), whole.point(to)], parallel })
    }

    fn place(&self, seen: DVec3) -> DVec2 {
        match self.model {
            CameraModel::Screen => DVec2::new(seen.x, seen.y),
            _ => self.middle + self.scale * DVec2::new(seen.x, -seen.y) / seen.z,
        }
    }
}

impl Segment {
    /// The pixel at share `s` of the way on the picture, and the T-value of the primary ray through it at the line.
    pub fn at(&self, s: f64) -> (DVec2, f64) {
        let point = self.point(s);
        let t = if self.parallel { point.z } else { point.length() };
        (self.pixels[0] + (self.pixels[1] - self.pixels[0]) * s, t)
    }

    /// 1 / z is linear on the picture, so the share of the way in space is the share weighted by it.
    fn point(&self, s: f64) -> DVec3 {
        let [p, q] = self.points;
        let share = match self.parallel {
            true => s,
            false => s * p.z / ((1.0 - s) * q.z + s * p.z),
        };
        p + (q - p) * share
    }
}

/// The shares between which a line lies in a rectangle. Source: Y.-D. Liang, B. Barsky 1984, "A New Concept and Method for Line Clipping".
fn within([p, q]: [DVec2; 2], low: DVec2, high: DVec2) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let (start, along) = (p[axis], q[axis] - p[axis]);
        if along == 0.0 {
            if !(low[axis] <= start && start <= high[axis]) {
                return None;
            }
            continue;
        }
        let (a, b) = ((low[axis] - start) / along, (high[axis] - start) / along);
        (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
    }
    (from <= to).then_some((from, to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::{CameraSpec, View};

    fn camera(model: CameraModel) -> GzCamera {
        let view = View { position: DVec3::new(3.0, 2.0, 9.0), look_at: DVec3::new(0.5, 1.0, 0.0), up: DVec3::Y, fov: 40.0 };
        GzCamera::new(CameraSpec { model, view: Some(view), width: 160, height: 100 }).unwrap()
    }

    const MODELS: [CameraModel; 4] = [CameraModel::Pinhole, CameraModel::Homework, CameraModel::Paper, CameraModel::Screen];

    #[test]
    fn a_point_on_a_pixels_ray_is_in_that_pixel_at_its_t() {
        for model in MODELS {
            let camera = camera(model);
            let projection = Projection::of(&camera);
            for (i, j, t) in [(0, 0, 3.0), (159, 99, 7.5), (80, 50, 1.0), (13, 77, 20.0)] {
                let (pixel, found) = projection.pixel(camera.ray(i, j, DVec2::ZERO).at(t)).unwrap();
                assert!((pixel - DVec2::new(f64::from(i), f64::from(j))).length() < 1e-4, "{model:?} {i} {j}: {pixel}");
                assert!((found - f64::from(t)).abs() < 1e-5, "{model:?} {i} {j}: {found}");
            }
        }
        let behind = camera(CameraModel::Pinhole).ray(5, 5, DVec2::ZERO).at(-1.0);
        assert_eq!(Projection::of(&camera(CameraModel::Pinhole)).pixel(behind), None);
    }

    #[test]
    fn a_line_has_the_t_of_the_rays_that_meet_it() {
        for model in MODELS {
            let camera = camera(model);
            let projection = Projection::of(&camera);
            let (a, b) = (camera.ray(10, 20, DVec2::ZERO).at(4.0), camera.ray(150, 90, DVec2::ZERO).at(30.0));
            let line = projection.segment(a, b, DVec2::new(160.0, 100.0), 1.0).unwrap();
            for k in 0..=10 {
                // The point of the line in space whose picture is at the share.
                let (pixel, t) = line.at(f64::from(k) / 10.0);
                let ray = camera.ray(0, 0, pixel);
                let point = ray.at(t as f32);
                let along = (b - a).normalize();
                let off = (point - a) - along * (point - a).dot(along);
                assert!(off.length() < 1e-4 * t.max(1.0), "{model:?} {k}: {off}");
            }
        }
    }

    #[test]
    fn lines_are_cut_off_at_the_eye_and_at_the_picture() {
        let camera = camera(CameraModel::Pinhole);
        let (projection, size) = (Projection::of(&camera), DVec2::new(160.0, 100.0));
        let (ahead, behind) = (camera.ray(80, 50, DVec2::ZERO).at(5.0), camera.ray(20, 20, DVec2::ZERO).at(-5.0));
        let line = projection.segment(ahead, behind, size, 2.0).unwrap();
        for pixel in line.pixels {
            assert!(pixel.cmpge(DVec2::splat(-2.001)).all() && pixel.cmple(size + 2.001).all(), "{pixel}");
        }
        assert_eq!(projection.segment(behind, behind, size, 2.0), None);
        let (left, more) = (camera.ray(0, 0, DVec2::new(-50.0, 5.0)).at(5.0), camera.ray(0, 0, DVec2::new(-40.0, 50.0)).at(5.0));
        assert_eq!(projection.segment(left, more, size, 2.0), None);
    }
}
