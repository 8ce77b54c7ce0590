//! parry3d's triangle mesh.

use crate::{MISS, PeerHit, PeerRay, Rival};
use parry3d::math::Vector;
use parry3d::query::Ray;
use parry3d::shape::{CompositeShapeRef, TriMesh};

pub(crate) struct Parry(TriMesh);

impl Parry {
    pub(crate) fn new(vertices: &[[f32; 3]], indices: &[[u32; 3]]) -> Option<Self> {
        TriMesh::new(vertices.iter().map(|&[x, y, z]| Vector::new(x, y, z)).collect(), indices.to_vec()).ok().map(Self)
    }

    #[inline(always)]
    fn cast(&self, ray: &PeerRay) -> Option<(u32, f32)> {
        let vector = |[x, y, z]: [f32; 3]| Vector::new(x, y, z);
        let line = Ray::new(vector(ray.origin), vector(ray.direction));
        CompositeShapeRef(&self.0).cast_local_ray(&line, ray.tmax.min(f32::MAX), true)
    }
}

impl Rival for Parry {
    #[inline(always)]
    fn closest(&self, ray: &PeerRay) -> PeerHit {
        self.cast(ray).map_or(MISS, |(triangle, t)| PeerHit { t, triangle, u: 0.0, v: 0.0 })
    }

    #[inline(always)]
    fn any(&self, ray: &PeerRay) -> bool {
        self.cast(ray).is_some()
    }

    /// It does not say.
    fn bytes(&self) -> usize {
        0
    }
}
