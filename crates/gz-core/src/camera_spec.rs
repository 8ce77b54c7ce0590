//! What a camera is made from, and why one cannot be.

use glam::DVec3;

/// Which space is traced and where rays start. Decides trace space for triangles, lights and tree alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraModel {
    /// Image space of the course: x = y cross z, rays from the centre of projection (0, 0, -d) through integer pixels, the field of
    /// view on both axes. Reproduces HW3 to HW6 to the pixel. Triangles with a corner behind the view plane are dropped whole.
    Homework,
    /// The same space and directions with rays from (0, 0, 0), as the paper's program has it (its section 2.3.1).
    Paper,
    /// Screen space: parallel rays along +z through integer pixels, so that the T-value is the homework's z. HW2.
    Screen,
    /// World space, right-handed, y up, right = forward cross up; rays through pixel centres, the field of view vertical, square
    /// pixels.
    Pinhole,
}

/// Where a camera stands and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position in world space. For the course's models this is the middle of the *image plane*, not the centre of projection.
    pub position: DVec3,
    /// The point looked at, world space.
    pub look_at: DVec3,
    /// Up, world space; made perpendicular to the viewing direction.
    pub up: DVec3,
    /// Field of view in degrees, in (0, 180).
    pub fov: f64,
}

/// All that makes a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSpec {
    /// The model.
    pub model: CameraModel,
    /// The view. `None` only for [`CameraModel::Screen`], when triangles are given in screen space already.
    pub view: Option<View>,
    /// Picture width in pixels, 1 to 65535.
    pub width: u32,
    /// Picture height in pixels, 1 to 65535.
    pub height: u32,
}

/// Why a camera cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraError {
    /// Width or height is 0 or above 65535.
    Size,
    /// This model needs a view.
    NoView,
    /// A coordinate is not finite.
    NotFinite,
    /// Position and look-at are the same point, or too near or far to tell a direction.
    NoDirection,
    /// Up is zero or parallel to the viewing direction.
    UpIsParallel,
    /// The field of view is not in (0, 180) degrees.
    Fov,
}

impl std::fmt::Display for CameraError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Size => "picture width and height must be 1 to 65535",
            Self::NoView => "this camera model needs position, look_at and fov",
            Self::NotFinite => "camera position, look_at and up must be finite",
            Self::NoDirection => "camera position and look_at are the same point",
            Self::UpIsParallel => "camera up is zero or parallel to the viewing direction",
            Self::Fov => "camera fov must lie between 0 and 180 degrees",
        })
    }
}

impl std::error::Error for CameraError {}
