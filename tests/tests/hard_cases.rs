//! The hard cases, one test each, named by their labels: A shared edges and corners, B ill-shaped triangles, C rays near a plane, E the
//! range of numbers, F leaving a surface, G glass, H cameras, I what varies over a triangle, J determinism. D, trees, is in `d_cases.rs`.
//!
//! Wherever a case is a question about rays, brute force and the tree that tunes itself at every SIMD level, and the paper's tree at three
//! settings, are asked one by one and in a batch, and each answer is compared with the independent truth (`gz_tests::judge::settled`).
//! What the other ray-triangle tests get wrong is asserted beside it: known, wrong, and the reason why they are for comparison only.

#[path = "hard_cases/a_edges.rs"]
mod a_edges;
#[path = "hard_cases/b_shapes.rs"]
mod b_shapes;
#[path = "hard_cases/c_planes.rs"]
mod c_planes;
#[path = "hard_cases/e_range.rs"]
mod e_range;
#[path = "hard_cases/f_leaving.rs"]
mod f_leaving;
#[path = "hard_cases/g_glass.rs"]
mod g_glass;
#[path = "hard_cases/h_cameras.rs"]
mod h_cameras;
#[path = "hard_cases/i_weights.rs"]
mod i_weights;
#[path = "hard_cases/j_determinism.rs"]
mod j_determinism;
/// Scenes made by hand, as the tests of gz-shade make them.
#[path = "../../crates/gz-shade/tests/common/mod.rs"]
mod made;

use gz_core::kernel::plain;
use gz_core::{GzCoord, GzRay, Kernel, TriId};
use gz_shade::{Frame, SceneNeeds};
use made::Made;

fn v(x: f32, y: f32, z: f32) -> GzCoord {
    GzCoord::new(x, y, z)
}

/// The picture of `made`, the same from everyone and by true answers only.
fn shaded(name: &str, made: &Made) -> Frame {
    let scene = made.scene(None);
    gz_tests::judge::shaded(name, &scene, SceneNeeds::of(&scene))
}

/// The triangle that a rounded test finds first, by its own T and then by number.
fn by_plain(kernel: Kernel, triangles: &[[GzCoord; 3]], ray: &GzRay) -> Option<TriId> {
    let mut best: Option<(f32, TriId)> = None;
    for (tri, corners) in (0..).zip(triangles) {
        if let Some((t, ..)) = plain(kernel, ray, corners)
            && best.is_none_or(|(least, _)| t < least)
        {
            best = Some((t, tri));
        }
    }
    best.map(|(_, tri)| tri)
}

/// Of `rays`, how many a rounded test lets through all of `triangles`.
fn leaks(kernel: Kernel, triangles: &[[GzCoord; 3]], rays: &[GzRay]) -> usize {
    rays.iter().filter(|ray| by_plain(kernel, triangles, ray).is_none()).count()
}
