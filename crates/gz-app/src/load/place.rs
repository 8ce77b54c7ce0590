//! Placing: every triangle from model to trace space, with the shading data that is needed and no more.

use super::draft::{Draft, MaterialNumbers};
use super::part::{Part, face_normal, unit};
use super::words::NormalsRule;
use crate::error::LoadError;
use glam::DVec3;
use gz_core::{Attributes, GzCamera, GzCoord, GzMatrix, GzTri, TriBuffer, TriError};
use gz_shade::{Material, Scene, SceneNeeds};

impl Draft {
    /// Places every triangle and gives the scene to render.
    ///
    /// Positions go through the placement and the camera in f64 and are rounded once to f32; an identity placement under the pinhole
    /// camera keeps every bit. Normals go by the inverse transpose to shading space and are brought to length 1. A placement that
    /// mirrors swaps the second and third corner, so that the winding stays counter-clockwise seen from outside. A triangle that
    /// the camera model drops keeps its number as three equal corners, which no ray hits. Meshes are let go of one by one.
    ///
    /// # Errors
    ///
    /// If a placed coordinate is beyond the range of f32.
    pub fn place(self, needs: SceneNeeds) -> Result<Scene, LoadError> {
        let keep = needs.attributes();
        let total = self.triangles();
        let Self { mut scene, parts, numbers, .. } = self;
        let mut placer = Placer {
            tris: TriBuffer::with_attributes(keep, total),
            keep,
            camera: &scene.camera,
            materials: &scene.materials,
            numbers,
            resting_place: None,
            waiting: 0,
        };
        for part in parts {
            placer.place(part)?;
        }
        scene.tris = placer.finish()?;
        Ok(scene)
    }
}

struct Placer<'a> {
    tris: TriBuffer,
    keep: Attributes,
    camera: &'a GzCamera,
    materials: &'a [Material],
    numbers: MaterialNumbers,
    /// Where dropped triangles lie: on a corner of the first kept one, so that they do not widen the scene's box.
    resting_place: Option<GzCoord>,
    /// Dropped triangles before the first kept one.
    waiting: usize,
}

impl Placer<'_> {
    fn place(&mut self, mut part: Part) -> Result<(), LoadError> {
        if self.keep.normals {
            compute_missing_normals(&mut part);
        }
        let normals = NormalPlacer::new(self.camera, &part.world_from_model);
        let mirrors = part.world_from_model.det3() < 0.0;
        for i in 0..part.mesh.triangles.len() {
            let Some(positions) = part.trace_corners(self.camera, i) else {
                self.push_dropped().map_err(|error| part.error(error.to_string()))?;
                continue;
            };
            // Changed vertices are given where they are to be, so no placement mirrors them.
            let change = part.changes.get(&i).copied().unwrap_or_default();
            let swap = mirrors && change.image_vertices.is_none();
            let corners = &part.mesh.triangles[i];
            let material = self.numbers.of(part.material(i), corners.uv.is_some());
            let mut tri = GzTri { positions, material, class: self.materials[usize::from(material)].class(), ..GzTri::default() };
            if self.keep.colors {
                tri.color = part.color(i);
            }
            if self.keep.normals {
                tri.normals = normals.of(&part, i, &positions, mirrors);
            }
            if let Some(uv) = corners.uv.filter(|_| self.keep.uvs) {
                tri.uvs = uv.map(|k| part.mesh.uvs[k as usize]);
            }
            if swap {
                swap_last(&mut tri);
            }
            self.push_kept(&tri).map_err(|error| match error {
                TriError::NotFinite(_) => part.error(format!("triangle {i} is placed beyond the range of f32")),
                _ => part.error(error.to_string()),
            })?;
        }
        Ok(())
    }

    fn push_kept(&mut self, tri: &GzTri) -> Result<(), TriError> {
        if self.resting_place.is_none() && tri.positions[0].is_finite() {
            self.resting_place = Some(tri.positions[0]);
            for _ in 0..std::mem::take(&mut self.waiting) {
                self.push_dropped()?;
            }
        }
        self.tris.push(tri).map(|_| ())
    }

    fn push_dropped(&mut self) -> Result<(), TriError> {
        match self.resting_place {
            Some(point) => self.tris.push(&GzTri { positions: [point; 3], ..GzTri::default() }).map(|_| ()),
            None => {
                self.waiting += 1;
                Ok(())
            }
        }
    }

    /// The buffer, with the triangles of a scene that was dropped whole at the origin.
    fn finish(mut self) -> Result<TriBuffer, LoadError> {
        self.resting_place.get_or_insert(GzCoord::ZERO);
        for _ in 0..std::mem::take(&mut self.waiting) {
            // An origin is finite and the number of triangles was checked when the draft was made.
            let pushed = self.push_dropped();
            debug_assert_eq!(pushed, Ok(()), "a point at the origin can be stored");
        }
        Ok(self.tris)
    }
}

fn swap_last(tri: &mut GzTri) {
    tri.positions.swap(1, 2);
    tri.normals.swap(1, 2);
    tri.uvs.swap(1, 2);
}

fn compute_missing_normals(part: &mut Part) {
    match part.normals {
        NormalsRule::Flat => {}
        NormalsRule::File if part.mesh.triangles.iter().all(|tri| tri.normal.is_some()) => {}
        NormalsRule::File => part.mesh.compute_smooth_normals(part.crease),
        NormalsRule::Smooth => {
            part.mesh.normals.clear();
            part.mesh.triangles.iter_mut().for_each(|tri| tri.normal = None);
            part.mesh.compute_smooth_normals(part.crease);
        }
    }
}

/// Takes the normals of one part to shading space.
struct NormalPlacer {
    shading_from_world: GzMatrix,
    shading_from_model: GzMatrix,
}

impl NormalPlacer {
    fn new(camera: &GzCamera, world_from_model: &GzMatrix) -> Self {
        let shading_from_world = camera.shading_from_world();
        Self { shading_from_world, shading_from_model: shading_from_world.times(&world_from_model.normal_matrix()) }
    }

    /// Unit normals at the corners of triangle `i`, in file order. `mirrors` says that the winding is turned by the placement.
    ///
    /// The file's or computed ones; the face normal for a flat part and where a corner's normal has no direction. The face normal
    /// is turned to the side that the file's normals point to, where there are any.
    fn of(&self, part: &Part, i: usize, positions: &[GzCoord; 3], mirrors: bool) -> [GzCoord; 3] {
        let change = part.changes.get(&i).copied().unwrap_or_default();
        if let Some(normal) = change.normal {
            return [normal.as_vec3(); 3];
        }
        if change.image_vertices.is_some() {
            return [or_z(face_normal(positions.map(|p| p.as_dvec3()))); 3];
        }
        let given = part.mesh.triangles[i]
            .normal
            .map(|normal| normal.map(|k| unit(self.shading_from_model.vector(part.mesh.normals[k as usize].as_dvec3()))));
        match given {
            Some([Some(a), Some(b), Some(c)]) if part.normals != NormalsRule::Flat => [a, b, c].map(|n| n.as_vec3()),
            _ => {
                let face = self.face(part, i, mirrors, given);
                given
                    .filter(|_| part.normals != NormalsRule::Flat)
                    .map_or([face; 3], |corners| corners.map(|normal| normal.map_or(face, |n| n.as_vec3())))
            }
        }
    }

    fn face(&self, part: &Part, i: usize, mirrors: bool, given: Option<[Option<DVec3>; 3]>) -> GzCoord {
        let winding = face_normal(part.world_corners(i)) * if mirrors { -1.0 } else { 1.0 };
        let face = self.shading_from_world.vector(winding);
        let side: DVec3 = given.into_iter().flatten().flatten().sum();
        or_z(if face.dot(side) < 0.0 { -face } else { face })
    }
}

/// The direction of `n` in f32; +z for the normal of a triangle without area, which is never seen.
fn or_z(n: DVec3) -> GzCoord {
    unit(n).map_or(GzCoord::Z, |n| n.as_vec3())
}

#[cfg(test)]
#[path = "place_tests.rs"]
mod tests;
