//! Normals for meshes without.

use crate::mesh::Mesh;
use gz_core::GzCoord;

impl Mesh {
    /// Gives triangles without normals normals that are shared by all such triangles at a vertex.
    pub fn compute_smooth_normals(&mut self) {
        let mut sums = vec![GzCoord::ZERO; self.positions.len()];
        let missing = || self.triangles.iter().filter(|tri| tri.normal.is_none());
        for tri in missing() {
            let [a, b, c] = tri.position.map(|k| self.positions[k as usize]);
            tri.position.iter().for_each(|&k| sums[k as usize] += (b - a).cross(c - a));
        }
        let first = self.normals.len() as u32;
        self.normals.extend(sums.iter().map(|n| n.normalize_or(GzCoord::Z)));
        for tri in self.triangles.iter_mut().filter(|tri| tri.normal.is_none()) {
            tri.normal = Some(tri.position.map(|k| k + first));
        }
    }
}
