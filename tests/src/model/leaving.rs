//! Where a shadow ray starts, and what comes of it.

use super::Table;
use super::kernels::{Meeting, primary};
use super::pictures::{placed, sized};
use gz_app::error::LoadError;
use gz_bsp::BspTree;
use gz_core::{GzRay, RayQuery, TriId, leave_surface, side_of};
use gz_shade::Scene;

/// Wrong answers to the shadow rays of a picture's primary hits, by the way in which the rays leave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeavingErrors {
    /// Shadow rays: one a hit and light that is on the viewer's side of the triangle.
    pub rays: u64,
    /// Wrong when the ray starts at the hit point in f32.
    pub bare: u64,
    /// Wrong when it does so and its own triangle is skipped: the paper's way.
    pub skipping: u64,
}

/// Shadow rays asked exactly, from starting points of three kinds; those of [`leave_surface`] are right.
pub fn leaving_errors(scene: &Scene) -> LeavingErrors {
    let tree = BspTree::build(&scene.tris);
    let mut errors = LeavingErrors::default();
    for (ray, hit) in primary(scene).filter(|(_, hit)| hit.is_hit()) {
        let (at, corners) = (Meeting::of(scene, &ray, &hit), scene.tris.position(hit.tri));
        for light in &scene.lights {
            let arrival = light.arrive(at.point);
            let is_lit = side_of(corners, arrival.direction) == -side_of(corners, ray.direction);
            let Some(origin) = leave_surface(corners, at.weights, arrival.direction).filter(|_| is_lit) else { continue };
            let exact = GzRay { tmax: arrival.tmax, ..GzRay::from_f64(origin, arrival.direction) };
            let rounded = GzRay { origin: ray.at(hit.t).as_vec3().as_dvec3(), ..exact };
            let truth = tree.any_hit(&exact);
            errors.rays += 1;
            errors.bare += u64::from(tree.any_hit(&rounded) != truth);
            errors.skipping += u64::from(is_blocked_by_another(&tree, rounded, hit.tri) != truth);
        }
    }
    errors
}

/// Whether a ray hits a triangle other than `own`.
fn is_blocked_by_another(query: &dyn RayQuery, mut ray: GzRay, own: TriId) -> bool {
    loop {
        let hit = query.closest_hit(&ray);
        if hit.tri != own {
            return hit.is_hit();
        }
        ray.tmin = hit.t.next_up();
    }
}

pub(super) fn table() -> Result<Table, LoadError> {
    let mut rows = Vec::new();
    for name in ["shadows", "teapot"] {
        let errors = leaving_errors(&placed(name, &sized(320, 240))?.0);
        for (way, wrong) in
            [("the hit point in f32", errors.bare), ("the same, own triangle skipped (the paper)", errors.skipping)]
        {
            let share = 100.0 * wrong as f64 / errors.rays.max(1) as f64;
            rows.push(vec![name.to_owned(), way.to_owned(), wrong.to_string(), format!("{share:.3} %"), errors.rays.to_string()]);
        }
    }
    Ok(Table {
        title: "Leaving a surface".to_owned(),
        how: "Shadow rays from the primary hits of a picture of 320 by 240, each asked exactly from three starting points. Right is the \
              one in use, which is proved to lie on the side that the ray goes to; counted are the answers from the others that differ \
              from its own. Glass counts as opaque."
            .to_owned(),
        columns: vec!["scene", "the ray starts at", "wrong answers", "share", "n rays"],
        rows,
    })
}
