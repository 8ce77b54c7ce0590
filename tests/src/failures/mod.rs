//! The failures that the paper tells of (its sections 2.4 and 3.3.2), made again on purpose as small pictures, each beside its cure.
//!
//! All are of our own scenes, `shadows` and what is made of it, so that none shows course data.

mod ground;
mod spaces;

pub use ground::turned_teapot_floor;
pub use spaces::{lights_in_world_space, normals_in_world_space};

use crate::plain_trees::{Insert, PlainMidpoint, PlainRules};
use crate::rendered::scene_path;
use gz_app::error::AppError;
use gz_app::load::{self, Overrides};
use gz_app::output::{png, rgb8};
use gz_bsp::BspTree;
use gz_core::{LeavePolicy, RayQuery, TileGrid};
use gz_shade::{Scene, SceneNeeds, shade_frame};

/// A picture with what is to be said of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// What was done, in a few words.
    pub caption: String,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, row-major, row 0 on top.
    pub rgb: Vec<u8>,
}

impl Shot {
    /// As a file.
    ///
    /// # Errors
    ///
    /// If the encoder refuses.
    pub fn png(&self) -> Result<Vec<u8>, AppError> {
        png(self.width, self.height, &self.rgb)
    }
}

/// A failure beside its cure.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Its name, as a file may have it.
    pub name: &'static str,
    /// What goes wrong and why, in a sentence or two.
    pub why: &'static str,
    /// The picture with the mistake.
    pub wrong: Shot,
    /// The picture without.
    pub cure: Shot,
}

impl Failure {
    /// Pixels that differ between the two pictures.
    pub fn differing(&self) -> usize {
        self.wrong.rgb.chunks_exact(3).zip(self.cure.rgb.chunks_exact(3)).filter(|(a, b)| a != b).count()
    }
}

/// All of them, `width` pixels wide.
///
/// # Errors
///
/// If a scene cannot be loaded.
pub fn all(width: u32) -> Result<Vec<Failure>, AppError> {
    let made = [shadow_stipple, stipple_at_edges, holes, lights_in_world_space, normals_in_world_space];
    made.into_iter().map(|make| make(width)).collect()
}

/// Shadow rays that start at the rounded hit point: about half of them meet the very surface that they leave.
///
/// # Errors
///
/// If the scene cannot be loaded.
pub fn shadow_stipple(width: u32) -> Result<Failure, AppError> {
    Ok(Failure {
        name: "stipple",
        why: "The rounded hit point lies on either side of its triangle, so that about half of the shadow rays that start there are blocked \
              by the surface itself.",
        wrong: left_by("shadow rays from the rounded hit point", LeavePolicy::Bare, width)?,
        cure: left_by("from a point proved to be on the light's side", LeavePolicy::Exact, width)?,
    })
}

/// The paper's own cure for stipple, which leaves out the triangle that a ray starts from, and not its neighbours.
///
/// # Errors
///
/// If the scene cannot be loaded.
pub fn stipple_at_edges(width: u32) -> Result<Failure, AppError> {
    Ok(Failure {
        name: "stipple-at-edges",
        why: "Leaving out the triangle that a shadow ray starts from, by its number, is no cure near an edge: from a point that rounding has \
              put under the surface the ray comes out through the neighbour. Here a flat ground of 80 000 small triangles, a thousand units \
              from the origin, under a light three degrees above it.",
        wrong: fine_ground("the triangle left is skipped by its number", LeavePolicy::Identity, width)?,
        cure: fine_ground("from a point proved to be on the light's side", LeavePolicy::Exact, width)?,
    })
}

/// A tree that lists a triangle only where a corner of it lies: whatever is larger than a voxel is missing from those in its middle.
///
/// # Errors
///
/// If the scene cannot be loaded.
pub fn holes(width: u32) -> Result<Failure, AppError> {
    let (fine, _) = shadows(&Overrides { size: Some(size(width)), ..Overrides::NONE })?;
    let scene = ground::coarse(fine)?;
    let needs = SceneNeeds::of(&scene);
    let shot = |caption: &str, insert| {
        let tree = PlainMidpoint::build(&scene.tris, PlainRules { insert, ..PlainRules::default() });
        shot(caption, &scene, needs, &tree)
    };
    Ok(Failure {
        name: "holes",
        why: "The paper's first tree listed a triangle in a voxel when one of its corners lay there. A triangle larger than the voxel has \
              none in it: its middle is missing, and its shadow too.",
        wrong: shot("listed where a corner lies in the voxel", Insert::CornerInside),
        cure: shot("listed where the triangle's box touches the voxel", Insert::BoxTouches),
    })
}

/// The scene `shadows` with this way of leaving a surface.
fn left_by(caption: &str, leave: LeavePolicy, width: u32) -> Result<Shot, AppError> {
    let (scene, needs) = shadows(&Overrides { size: Some(size(width)), leave: Some(leave), ..Overrides::NONE })?;
    Ok(shot(caption, &scene, needs, &BspTree::build(&scene.tris)))
}

/// The fine ground with this way of leaving a surface.
fn fine_ground(caption: &str, leave: LeavePolicy, width: u32) -> Result<Shot, AppError> {
    let (width, height) = size(width);
    let scene = ground::ground(width, height, leave)?;
    Ok(shot(caption, &scene, SceneNeeds::of(&scene), &BspTree::build(&scene.tris)))
}

/// The scene `shadows`, placed.
fn shadows(overrides: &Overrides) -> Result<(Scene, SceneNeeds), AppError> {
    let draft = load::scene(&scene_path("shadows"), overrides)?;
    let needs = SceneNeeds::of(&draft.scene);
    Ok((draft.place(needs)?, needs))
}

/// A picture of `width` in the scene's own proportion.
fn size(width: u32) -> (u32, u32) {
    (width, (width * 3).div_ceil(4))
}

/// The picture that `query` makes of `scene`.
fn shot(caption: &str, scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery) -> Shot {
    let (width, height) = (scene.camera.width(), scene.camera.height());
    let frame = shade_frame(scene, needs, query, &TileGrid::whole(width, height, 32), &|_| {});
    Shot { caption: caption.to_owned(), width, height, rgb: rgb8(&frame.colors, scene.rules.color_code) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::BruteForce;

    #[test]
    fn holes_are_cured_to_the_picture_of_brute_force() {
        let (fine, _) = shadows(&Overrides { size: Some(size(64)), ..Overrides::NONE }).unwrap();
        let scene = ground::coarse(fine).unwrap();
        let right = shot("", &scene, SceneNeeds::of(&scene), &BruteForce::new(&scene.tris));
        assert!(holes(64).unwrap().cure.rgb == right.rgb);
    }
}
