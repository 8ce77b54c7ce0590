//! Triangles as indices into vertices, as other programs want them.

use gz_core::GzCoord;
use std::collections::HashMap;

/// Vertices, and three numbers of them for each triangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Indexed {
    /// No two with the same bits.
    pub vertices: Vec<GzCoord>,
    /// In the order of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Indexed {
    /// The same triangles with corners of equal bits as one vertex, in the order in which they first occur.
    pub fn of<'a>(positions: impl IntoIterator<Item = &'a [GzCoord; 3]>) -> Self {
        let (mut this, mut numbers) = (Self::default(), HashMap::new());
        for corners in positions {
            let triangle = corners.map(|corner| {
                *numbers.entry(corner.to_array().map(f32::to_bits)).or_insert_with(|| {
                    this.vertices.push(corner);
                    this.vertices.len() as u32 - 1
                })
            });
            this.triangles.push(triangle);
        }
        this
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_corners_are_one_vertex() {
        let [a, b, c, d] = [GzCoord::ZERO, GzCoord::X, GzCoord::Y, GzCoord::Z];
        let indexed = Indexed::of(&[[a, b, c], [c, b, d]]);
        assert_eq!(indexed, Indexed { vertices: vec![a, b, c, d], triangles: vec![[0, 1, 2], [2, 1, 3]] });
        // -0 has other bits than 0.
        assert_eq!(Indexed::of(&[[a, -a, b]]).vertices.len(), 3);
    }
}
