//! The walk: what a ray costs, and a step of it.

use super::Row;
use crate::bench::rays::{RaySet, answers, differing, room, trace};
use crate::bench::scenes::BenchScene;
use crate::bench::timing::take_turns;
use gz_app::error::AppError;
use gz_bsp::{BspTree, VisitCount};
use gz_core::{BruteForce, ClassMask, GzRay, RayQuery, TriBuffer};
use std::hint::black_box;

/// Brute force checks so many of them.
const CHECKED: usize = 4096;

/// The walk through the tree of a scene.
pub(super) struct Walk<'s> {
    tris: &'s TriBuffer,
    tree: BspTree<'s>,
    rays: RaySet,
}

impl<'s> Walk<'s> {
    pub(super) fn of(scene: &'s BenchScene, most: usize) -> Self {
        Self { tris: &scene.tris, tree: BspTree::build(&scene.tris), rays: scene.rays.primary().as_closest().sample(most) }
    }

    pub(super) fn check(&self) -> Result<(), AppError> {
        let few = self.rays.sample(CHECKED);
        let wrong = differing(&answers(&BruteForce::new(self.tris), &few), &answers(&self.tree, &few));
        println!("walk: {} rays checked by brute force, {wrong} differ", few.len());
        if wrong > 0 { Err(AppError::Differs(format!("{wrong} answers differ from those of brute force"))) } else { Ok(()) }
    }

    pub(super) fn time(&self, rounds: usize) -> Vec<Row> {
        let rays: Vec<GzRay> = self.rays.rays().map(|(ray, _)| ray).collect();
        let mut visits = VisitCount::default();
        for ray in &rays {
            black_box(self.tree.closest_hit_counted(ray, ClassMask::ALL, &mut visits));
        }
        let mut found = room(&self.rays);
        let mut contenders: Vec<Box<dyn FnMut() + '_>> = vec![
            Box::new(|| {
                for ray in &rays {
                    black_box(self.tree.closest_hit(ray));
                }
            }),
            Box::new(|| trace(&self.tree, &self.rays, &mut found)),
        ];
        let times = take_turns(rounds, &mut contenders);
        drop(contenders);
        let count = rays.len() as f64;
        let row =
            |what: String, unit, count: f64, k: usize| Row { what, unit, count, times: times[k].clone(), plain: Vec::new() };
        let per_ray = |n: u64| n as f64 / count.max(1.0);
        let seen = format!("{:.1} nodes and {:.2} groups of 8", per_ray(visits.nodes), per_ray(visits.groups));
        let steps = (visits.nodes + visits.groups) as f64;
        vec![
            row(format!("walk, primary rays one at a time: {seen}"), "ray", count, 0),
            row("the same by node or group visited".to_owned(), "step", steps, 0),
            row("walk, primary rays in batches".to_owned(), "ray", count, 1),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::scenes::bench_scene;

    #[test]
    fn the_walk_is_checked_before_it_is_timed() {
        let scene = bench_scene("teapot:2").unwrap();
        let walk = Walk::of(&scene, 500);
        walk.check().unwrap();
        let rows = walk.time(2);
        assert!(rows.iter().all(|row| row.times.len() == 2));
        // More steps than rays, in the same time.
        assert!(rows[1].count > rows[0].count && rows[1].times == rows[0].times);
    }
}
