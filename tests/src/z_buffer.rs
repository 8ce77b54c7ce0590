//! The homework's Z-buffer beside our T-value buffer, of the same triangles through the same camera.
//!
//! The left side is what this project replaced: triangles taken to screen space and scan-converted in f32, one screen z a pixel, the least
//! kept. The right side casts a ray through each pixel. Under the homework's camera both look through the same points, so that they differ
//! only by rounding: at edges, and where two depths are nearly equal.

use crate::bench::scenes::teapot;
use crate::failures::{Shot, turned_teapot_floor};
use glam::DVec3;
use gz_app::error::AppError;
use gz_app::output::rgb8;
use gz_bsp::BspTree;
use gz_core::{CameraModel, CameraSpec, GzCamera, GzColor, GzCoord, GzTri, Hit, NO_TRI, TBuffer, TriBuffer, TriId, View};
use gz_shade::ColorCode;

/// A pixel of the Z-buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ZPixel {
    /// Screen z, the homework's `GzDepth`: 0 on the view plane, 2147483647 at infinity and where nothing is.
    pub z: i32,
    /// The triangle whose z it is, [`NO_TRI`] for none.
    pub tri: TriId,
}

/// Both buffers of a view.
#[derive(Clone, Debug)]
pub struct SameView {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The Z-buffer, row-major, row 0 on top.
    pub z: Vec<ZPixel>,
    /// The T-value buffer.
    pub t: Vec<Hit>,
}

/// In how many pixels the two differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    /// Pixels that both cover.
    pub both: usize,
    /// Of these, pixels with another triangle.
    pub other: usize,
    /// Pixels that scan conversion alone covers.
    pub only_z: usize,
    /// Pixels that rays alone cover.
    pub only_t: usize,
    /// Different depths that the Z-buffer holds. f32 tells screen z apart in steps of 128 where most of a scene is.
    pub depths_z: usize,
    /// Different T-values.
    pub depths_t: usize,
}

/// A teapot on a floor, `size` pixels wide and high.
///
/// # Errors
///
/// If the camera is refused, which it is for a size of 0.
pub fn teapot_view(size: u32) -> Result<SameView, AppError> {
    let view = View { position: DVec3::new(1.2, 4.4, 11.2), look_at: DVec3::new(0.2, 1.35, 0.0), up: DVec3::Y, fov: 40.0 };
    same_view(&turned_teapot_floor(teapot(16)), view, size, size)
}

/// Both buffers of `triangles`, in world space, seen by the homework's camera. Triangles that reach behind the view plane are dropped from
/// both, as the course does.
///
/// # Errors
///
/// If the camera or a triangle is refused.
pub fn same_view(triangles: &[[GzCoord; 3]], view: View, width: u32, height: u32) -> Result<SameView, AppError> {
    let bad = |why: String| AppError::Usage(format!("the view: {why}"));
    let camera =
        |model| GzCamera::new(CameraSpec { model, view: Some(view), width, height }).map_err(|error| bad(error.to_string()));
    let (screen, image) = (camera(CameraModel::Screen)?, camera(CameraModel::Homework)?);
    let placed = |camera: &GzCamera, corners: &[GzCoord; 3]| -> Option<[GzCoord; 3]> {
        let [a, b, c] = corners.map(|p| camera.trace_from_world(p.as_dvec3()));
        Some([a?, b?, c?].map(|p| p.as_vec3()))
    };
    let mut z = vec![ZPixel { z: i32::MAX, tri: NO_TRI }; width as usize * height as usize];
    let mut tris = TriBuffer::new();
    for corners in triangles {
        let (Some(on_screen), Some(positions)) = (placed(&screen, corners), placed(&image, corners)) else { continue };
        let tri = tris.push(&GzTri { positions, ..GzTri::default() }).map_err(|error| bad(error.to_string()))?;
        put_triangle(&mut z, width, height, on_screen, tri);
    }
    let t = TBuffer::trace(&image, &BspTree::build(&tris)).hits;
    Ok(SameView { width, height, z, t })
}

/// Scan-converts a triangle in screen space: HW2's `GzPutTriangle`, row by row between a long edge and two short ones, all in f32.
fn put_triangle(buffer: &mut [ZPixel], width: u32, height: u32, mut corners: [GzCoord; 3], tri: TriId) {
    corners.sort_by(|a, b| a.y.total_cmp(&b.y));
    let [top, middle, bottom] = corners;
    // x and z of an edge in a row.
    let on = |from: GzCoord, to: GzCoord, y: f32| {
        let share = if to.y > from.y { (y - from.y) / (to.y - from.y) } else { 0.0 };
        (from.x + share * (to.x - from.x), from.z + share * (to.z - from.z))
    };
    for row in rows(top.y, bottom.y, height) {
        let y = row as f32;
        let long = on(top, bottom, y);
        let short = if y < middle.y { on(top, middle, y) } else { on(middle, bottom, y) };
        // A row through a horizontal edge has both its ends.
        let short = if y == middle.y { (middle.x, middle.z) } else { short };
        let ((x0, z0), (x1, z1)) = if long.0 <= short.0 { (long, short) } else { (short, long) };
        for column in rows(x0, x1, width) {
            let share = if x1 > x0 { (column as f32 - x0) / (x1 - x0) } else { 0.0 };
            let z = (z0 + share * (z1 - z0)) as i32;
            let pixel = &mut buffer[row as usize * width as usize + column as usize];
            if z < pixel.z {
                *pixel = ZPixel { z, tri };
            }
        }
    }
}

/// The whole numbers from `low` to `high` that are on the screen.
fn rows(low: f32, high: f32, size: u32) -> std::ops::Range<u32> {
    // Casts of what is below 0 or NaN give 0.
    let (first, last) = (low.ceil().max(0.0), high.floor().min(size as f32 - 1.0));
    if first <= last { first as u32..last as u32 + 1 } else { 0..0 }
}

impl SameView {
    /// Compares the two, pixel by pixel.
    pub fn difference(&self) -> Difference {
        let mut it = Difference::default();
        for (z, t) in self.z.iter().zip(&self.t) {
            match (z.tri != NO_TRI, t.is_hit()) {
                (true, true) => {
                    it.both += 1;
                    it.other += usize::from(z.tri != t.tri);
                }
                (true, false) => it.only_z += 1,
                (false, true) => it.only_t += 1,
                (false, false) => {}
            }
        }
        let distinct = |mut bits: Vec<u32>| {
            bits.sort_unstable();
            bits.dedup();
            bits.len()
        };
        it.depths_z = distinct(self.z.iter().filter(|z| z.tri != NO_TRI).map(|z| z.z as u32).collect());
        it.depths_t = distinct(self.t.iter().filter(|t| t.is_hit()).map(|t| t.t.to_bits()).collect());
        it
    }

    /// The Z-buffer as a picture: white where screen z is least, dark where it is greatest, black where nothing is.
    pub fn z_shot(&self) -> Shot {
        let depths = self.z.iter().map(|z| (z.tri != NO_TRI).then_some(f64::from(z.z)));
        self.shot("Z-buffer: screen z by scan conversion", depths.collect())
    }

    /// The T-value buffer as a picture, white where T is least.
    pub fn t_shot(&self) -> Shot {
        let depths = self.t.iter().map(|t| t.is_hit().then_some(f64::from(t.t)));
        self.shot("T-value buffer: distances by rays", depths.collect())
    }

    /// Where they differ: grey where both have the same triangle, yellow where another, red where scan conversion alone covers a pixel, blue
    /// where rays alone do.
    pub fn difference_shot(&self) -> Shot {
        let color = |(z, t): (&ZPixel, &Hit)| match (z.tri != NO_TRI, t.is_hit()) {
            (true, true) if z.tri == t.tri => [70, 70, 70],
            (true, true) => [255, 220, 60],
            (true, false) => [230, 50, 40],
            (false, true) => [70, 120, 255],
            (false, false) => [0, 0, 0],
        };
        let rgb = self.z.iter().zip(&self.t).flat_map(color).collect();
        let caption = "the two compared: grey same triangle, yellow another, red only Z, blue only T";
        Shot { caption: caption.to_owned(), width: self.width, height: self.height, rgb }
    }

    fn shot(&self, caption: &str, depths: Vec<Option<f64>>) -> Shot {
        let (near, far) = depths.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &d| (lo.min(d), hi.max(d)));
        let range = if far > near { far - near } else { 1.0 };
        // From 1 down to 0.1, as `--view t` has it.
        let color = |depth: Option<f64>| depth.map_or(GzColor::ZERO, |d| GzColor::splat(1.0 - 0.9 * ((d - near) / range) as f32));
        let colors: Vec<GzColor> = depths.into_iter().map(color).collect();
        Shot { caption: caption.to_owned(), width: self.width, height: self.height, rgb: rgb8(&colors, ColorCode::Srgb) }
    }
}
