//! Triangles and the growable buffer that holds them.

use crate::simd::advise_large;
use crate::{Bounds, GzColor, GzCoord, GzTextureIndex, Hit, TriId};

/// The number of a material in its scene, counting from 0.
pub type MaterialId = u16;

/// What a triangle is to a ray that only asks whether something is in the way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum TriClass {
    /// Stops light.
    #[default]
    Opaque = 0,
    /// Lets light through, tinted.
    Glass = 1,
}

/// One triangle with all that can be said of it, as the homework's `GzPutTriangle` receives it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GzTri {
    /// Corners in trace space.
    pub positions: [GzCoord; 3],
    /// Unit normals at the corners, in trace space.
    pub normals: [GzCoord; 3],
    /// Texture coordinates at the corners.
    pub uvs: [GzTextureIndex; 3],
    /// The colour that the application gave the whole triangle (`GZ_RGB_COLOR`).
    pub color: GzColor,
    /// The material of the triangle.
    pub material: MaterialId,
    /// How the triangle meets shadow rays.
    pub class: TriClass,
}

/// Which shading data a buffer keeps beside positions. What is not kept is not stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Normals at the corners, 36 bytes a triangle.
    pub normals: bool,
    /// Texture coordinates at the corners, 24 bytes a triangle.
    pub uvs: bool,
    /// One colour, 12 bytes a triangle.
    pub colors: bool,
    /// A material number other than 0, 2 bytes a triangle.
    pub materials: bool,
    /// A class other than opaque, 1 byte a triangle.
    pub classes: bool,
}

impl Attributes {
    /// Everything is kept.
    pub const ALL: Self = Self { normals: true, uvs: true, colors: true, materials: true, classes: true };

    /// Bytes that one triangle takes, positions (36) included.
    pub fn bytes_per_triangle(&self) -> usize {
        36 + 36 * usize::from(self.normals)
            + 24 * usize::from(self.uvs)
            + 12 * usize::from(self.colors)
            + 2 * usize::from(self.materials)
            + usize::from(self.classes)
    }
}

/// Why a triangle was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriError {
    /// A corner of this triangle has a NaN or infinite coordinate.
    NotFinite(usize),
    /// This triangle names a vertex that does not exist.
    NoSuchVertex(usize),
    /// More than 2^32 - 2 triangles.
    TooMany,
}

impl std::fmt::Display for TriError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite(tri) => write!(f, "triangle {tri} has a coordinate that is not finite"),
            Self::NoSuchVertex(tri) => write!(f, "triangle {tri} names a vertex that does not exist"),
            Self::TooMany => write!(f, "more than 4294967294 triangles"),
        }
    }
}

impl std::error::Error for TriError {}

/// The triangle buffer: positions for the ray query, and apart from them the shading data that is asked once per hit.
///
/// Every stored position is finite, so a query never meets a NaN. Triangles are numbered in the order of [`Self::push`].
#[derive(Clone, Debug, Default)]
pub struct TriBuffer {
    keep: Attributes,
    positions: Vec<[GzCoord; 3]>,
    normals: Vec<[GzCoord; 3]>,
    uvs: Vec<[GzTextureIndex; 3]>,
    colors: Vec<GzColor>,
    materials: Vec<MaterialId>,
    classes: Vec<TriClass>,
}

impl TriBuffer {
    /// An empty buffer that keeps positions only.
    pub fn new() -> Self {
        Self::default()
    }

    /// An empty buffer that keeps `keep` and has room for `capacity` triangles.
    pub fn with_attributes(keep: Attributes, capacity: usize) -> Self {
        fn room<T>(kept: bool, capacity: usize) -> Vec<T> {
            Vec::with_capacity(if kept { capacity } else { 0 })
        }
        let mut positions = room(true, capacity);
        // Answers are formed from them, here and there.
        advise_large(&mut positions);
        Self {
            keep,
            positions,
            normals: room(keep.normals, capacity),
            uvs: room(keep.uvs, capacity),
            colors: room(keep.colors, capacity),
            materials: room(keep.materials, capacity),
            classes: room(keep.classes, capacity),
        }
    }

    /// A buffer of positions only: triangle `i` has the vertices `indices[i]`.
    ///
    /// # Errors
    ///
    /// If a vertex used is not finite or does not exist.
    pub fn from_indexed(vertices: &[GzCoord], indices: &[[u32; 3]]) -> Result<Self, TriError> {
        let mut tris = Self::with_attributes(Attributes::default(), indices.len());
        for (i, corners) in indices.iter().enumerate() {
            let vertex = |k: u32| vertices.get(k as usize).copied().ok_or(TriError::NoSuchVertex(i));
            let positions = [vertex(corners[0])?, vertex(corners[1])?, vertex(corners[2])?];
            tris.push(&GzTri { positions, ..GzTri::default() })?;
        }
        Ok(tris)
    }

    /// Appends a triangle and returns its number. Of its shading data only what this buffer keeps is stored.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite; the buffer is then unchanged.
    pub fn push(&mut self, tri: &GzTri) -> Result<TriId, TriError> {
        let id = self.positions.len();
        if !tri.positions.iter().all(|p| p.is_finite()) {
            return Err(TriError::NotFinite(id));
        }
        let id = u32::try_from(id).ok().filter(|&id| id != crate::NO_TRI).ok_or(TriError::TooMany)?;
        self.positions.push(tri.positions);
        if self.keep.normals {
            self.normals.push(tri.normals);
        }
        if self.keep.uvs {
            self.uvs.push(tri.uvs);
        }
        if self.keep.colors {
            self.colors.push(tri.color);
        }
        if self.keep.materials {
            self.materials.push(tri.material);
        }
        if self.keep.classes {
            self.classes.push(tri.class);
        }
        Ok(id)
    }

    /// The number of triangles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is no triangle.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// What is kept beside positions.
    pub fn attributes(&self) -> Attributes {
        self.keep
    }

    /// Corners of all triangles.
    pub fn positions(&self) -> &[[GzCoord; 3]] {
        &self.positions
    }

    /// Corners of one triangle.
    pub fn position(&self, tri: TriId) -> &[GzCoord; 3] {
        &self.positions[tri as usize]
    }

    /// Corner normals of one triangle; `None` when the buffer keeps none.
    pub fn normals(&self, tri: TriId) -> Option<&[GzCoord; 3]> {
        self.normals.get(tri as usize)
    }

    /// Corner texture coordinates of one triangle; `None` when the buffer keeps none.
    pub fn uvs(&self, tri: TriId) -> Option<&[GzTextureIndex; 3]> {
        self.uvs.get(tri as usize)
    }

    /// The application's colour of one triangle; `None` when the buffer keeps none.
    pub fn color(&self, tri: TriId) -> Option<GzColor> {
        self.colors.get(tri as usize).copied()
    }

    /// The material of one triangle; 0 when the buffer keeps none.
    pub fn material(&self, tri: TriId) -> MaterialId {
        self.materials.get(tri as usize).copied().unwrap_or(0)
    }

    /// The class of one triangle; opaque when the buffer keeps none.
    pub fn class(&self, tri: TriId) -> TriClass {
        self.classes.get(tri as usize).copied().unwrap_or_default()
    }

    /// The unit vector (b - a) x (c - a), in f64. Zero for a triangle without area.
    ///
    /// Its side follows the winding, which course data does not keep consistently: use it up to sign.
    pub fn face_normal(&self, tri: TriId) -> glam::DVec3 {
        let [a, b, c] = self.position(tri).map(|p| p.as_dvec3());
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The point (1 - u - v) a + u b + v c of a hit, in f64. The ray's origin-independent form: it stays in the triangle.
    pub fn hit_point(&self, hit: &Hit) -> glam::DVec3 {
        let [a, b, c] = self.position(hit.tri).map(|p| p.as_dvec3());
        let [wa, wb, wc] = hit.weights();
        a * wa + b * wb + c * wc
    }

    /// The least box around all triangles.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.positions.iter().flatten().copied())
    }

    /// Bytes of all stored arrays, spare capacity not counted.
    pub fn bytes(&self) -> usize {
        self.len() * self.keep.bytes_per_triangle()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_kept_is_stored() {
        let tri = GzTri { normals: [GzCoord::Z; 3], uvs: [GzTextureIndex::ONE; 3], material: 3, ..GzTri::default() };
        let mut bare = TriBuffer::new();
        let mut full = TriBuffer::with_attributes(Attributes::ALL, 1);
        assert_eq!((bare.push(&tri), full.push(&tri)), (Ok(0), Ok(0)));
        assert_eq!((bare.normals(0), bare.uvs(0), bare.material(0), bare.bytes()), (None, None, 0, 36));
        assert_eq!((full.normals(0), full.material(0), full.bytes()), (Some(&[GzCoord::Z; 3]), 3, 111));
    }

    #[test]
    fn a_coordinate_that_is_not_finite_is_refused_and_leaves_no_trace() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut tris = TriBuffer::with_attributes(Attributes::ALL, 0);
            tris.push(&GzTri::default()).unwrap();
            let tri = GzTri { positions: [GzCoord::ZERO, GzCoord::new(0.0, bad, 0.0), GzCoord::X], ..GzTri::default() };
            assert_eq!(tris.push(&tri), Err(TriError::NotFinite(1)));
            assert_eq!((tris.len(), tris.normals.len(), tris.classes.len()), (1, 1, 1));
        }
    }

    #[test]
    fn an_index_out_of_range_is_refused() {
        let vertices = [GzCoord::ZERO, GzCoord::X, GzCoord::Y];
        assert_eq!(TriBuffer::from_indexed(&vertices, &[[0, 1, 2], [0, 1, 3]]).unwrap_err(), TriError::NoSuchVertex(1));
    }
}
