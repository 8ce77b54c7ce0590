//! Whole pictures before the truth: every question that a frame asks.

use super::{Tally, everyone, truth_ray, truth_triangles};
use crate::bench::rays::Asked;
use crate::bench::recorder::Recorder;
use crate::scenes::color_bits;
use crate::truth::Truth;
use gz_core::{ClassMask, Hit, RayQuery, TileGrid, TriBuffer};
use gz_shade::{Frame, Scene, SceneNeeds, shade_frame};

/// Shades the whole picture of `scene` with everyone and returns the frame, the same of all. Every question that it asks is answered truly.
///
/// # Panics
///
/// If two frames differ in a colour's bits or a count, or an answer is not the true one.
pub fn shaded(name: &str, scene: &Scene, needs: SceneNeeds) -> Frame {
    let grid = TileGrid::whole(scene.camera.width(), scene.camera.height(), 16);
    let mut expected: Option<Frame> = None;
    everyone(&scene.tris, |who, query| {
        let recorder = Recorder::of(query);
        let frame = shade_frame(scene, needs, &recorder, &grid, &|_| ());
        match &expected {
            Some(expected) => {
                let same = expected.stats == frame.stats && color_bits(&expected.colors) == color_bits(&frame.colors);
                assert!(same, "{name}: {who} gives another picture");
            }
            None => {
                let tally = questions(&scene.tris, query, &recorder.taken());
                assert!(tally.is_clean() && tally.rays == frame.stats.rays() + frame.stats.tint_queries, "{name}: {tally:?}");
                expected = Some(frame);
            }
        }
    });
    expected.unwrap_or_else(|| unreachable!("there is always brute force"))
}

/// Asks `query` again what was asked, and judges the answers. For rays that ask whether anything is hit, hit or miss is all that counts.
pub fn questions(tris: &TriBuffer, query: &dyn RayQuery, asked: &[Asked]) -> Tally {
    let triangles = truth_triangles(tris);
    let mut truths: Vec<(ClassMask, Truth)> = Vec::new();
    let mut tally = Tally::default();
    for asked in asked {
        if !truths.iter().any(|(classes, _)| *classes == asked.classes) {
            let truth = Truth::of_some(&triangles, |tri| asked.classes.has(tris.class(tri)));
            truths.push((asked.classes, truth));
        }
        let truth = truths.iter().find(|(classes, _)| *classes == asked.classes).map(|(_, truth)| truth);
        let Some(truth) = truth else { continue };
        let batch = asked.batch();
        if asked.any {
            let mut found = vec![false; batch.len()];
            query.any_hits(&batch, asked.classes, &mut found);
            for (i, found) in found.into_iter().enumerate() {
                let blocked = truth.any(&truth_ray(&batch.ray(i)));
                tally.rays += 1;
                tally.hits += u64::from(blocked);
                tally.false_hits += u64::from(found && !blocked);
                tally.false_misses += u64::from(!found && blocked);
            }
        } else {
            let mut found = vec![Hit::MISS; batch.len()];
            query.closest_hits(&batch, asked.classes, &mut found);
            for (i, found) in found.iter().enumerate() {
                tally.add(found, truth.closest(&truth_ray(&batch.ray(i))));
            }
        }
    }
    tally
}
