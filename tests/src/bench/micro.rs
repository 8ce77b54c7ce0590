//! Single kernels and steps of the walk, in nanoseconds: `cargo xtask bench micro`.
//!
//! Of the kernels only what gz-core offers to a tree is used, and of the tree only its question; so the figures outlive what is inside.
//! What stands beside is the test of Möller and Trumbore as anybody writes it, in f32 for one ray and one triangle.

use super::options::Options;
use super::rays::{RaySet, answers, differing, room, trace};
use super::record::Record;
use super::scenes::{BenchScene, bench_scene};
use super::table::lines;
use super::timing::{Ratio, median, take_turns};
use crate::row;
use gz_app::error::AppError;
use gz_bsp::{BspTree, VisitCount};
use gz_core::glam::DVec3;
use gz_core::kernel::{BUNDLE, Closest, FilterRay, FilterSpace, RayBundle, TriGroup, hit_weights, is_hit, plain};
use gz_core::simd::{Simd, Task, dispatch};
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, Hit, Kernel, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer, TriId};
use std::hint::black_box;

/// The scene, unless the options name another: 16 thousand triangles.
const SCENE: &str = "teapot:16";
/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 15;
/// Groups of eight triangles that the kernels are given, evenly spaced over the scene.
const GROUPS: usize = 128;
/// Pairs of a ray and a triangle that it hits.
const PAIRS: usize = 4096;
/// Rays of the walk, evenly spaced over the picture.
const RAYS: usize = 1 << 16;
/// Brute force checks so many of them.
const CHECKED: usize = 4096;
/// The eye, in sizes of a group.
const AWAY: f32 = 3.0;

/// `cargo xtask bench micro`: on one scene or those named.
///
/// # Errors
///
/// If a scene cannot be loaded or an answer is wrong.
pub fn run(options: &Options) -> Result<(), AppError> {
    let scenes = if options.scenes.is_empty() { vec![SCENE.to_owned()] } else { options.scenes.clone() };
    let rounds = options.rounds.unwrap_or(ROUNDS);
    let mut cells = Vec::new();
    for name in &scenes {
        let scene = bench_scene(name)?;
        println!("\n{}: {} triangles; medians of {rounds} rounds in turns", scene.name, scene.tris.len());
        let kernels = Kernels::of(&scene.tris);
        kernels.check()?;
        let walk = Walk::of(&scene, options.rays.unwrap_or(RAYS));
        walk.check()?;
        let mut rows = kernels.time(rounds);
        rows.extend(walk.time(rounds));
        print!("{}", table(&rows));
        cells.extend(rows.iter().map(|row| row.cells(name)));
    }
    if options.write {
        let levels = format!("SIMD level: {:?}", SimdLevel::best());
        Record::new("micro", rounds, &[levels])?.write(HEAD, cells)?;
    }
    Ok(())
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    what: String,
    /// What is counted.
    unit: &'static str,
    /// How many of them a round has.
    count: f64,
    /// Seconds of each round.
    times: Vec<f64>,
    /// Seconds of the plain test for as many pairs, where that is the same work.
    plain: Vec<f64>,
}

/// Columns of the record.
const HEAD: &str = "scene,what,unit,count,ns median,ns by round,plain f32 ns by round";

impl Row {
    fn each(&self, times: &[f64]) -> f64 {
        median(times) * 1e9 / self.count
    }

    fn cells(&self, scene: &str) -> Vec<String> {
        let all =
            |times: &[f64]| times.iter().map(|time| format!("{:.3}", time * 1e9 / self.count)).collect::<Vec<_>>().join(" ");
        let each = format!("{:.3}", self.each(&self.times));
        row![scene, self.what, self.unit, self.count, each, all(&self.times), all(&self.plain)]
    }
}

fn table(rows: &[Row]) -> String {
    let mut lined = vec![row!["what", "ns", "a", "plain f32 takes [95% interval]"]];
    lined.extend(rows.iter().map(|row| {
        let ratio = match row.plain.is_empty() {
            true => "-".to_owned(),
            false => Ratio::of(&row.plain, &row.times).to_string(),
        };
        row![row.what, format!("{:.2}", row.each(&row.times)), row.unit, ratio]
    }));
    lines(&lined)
}

/// Groups of triangles with a bundle of rays towards each, and pairs that meet.
struct Kernels<'t> {
    tris: &'t TriBuffer,
    space: FilterSpace,
    groups: Vec<TriGroup>,
    /// Where the rays of each group start.
    eyes: Vec<DVec3>,
    /// 64 directions for each group.
    directions: Vec<Vec<GzCoord>>,
    /// The same rays for the kernel of one ray and eight triangles.
    filters: Vec<Vec<FilterRay>>,
    pairs: Vec<(GzRay, TriId)>,
}

impl<'t> Kernels<'t> {
    fn of(tris: &'t TriBuffer) -> Self {
        let space = FilterSpace::new(tris.bounds().reaches());
        let mut this = Self {
            tris,
            space,
            groups: Vec::new(),
            eyes: Vec::new(),
            directions: Vec::new(),
            filters: Vec::new(),
            pairs: Vec::new(),
        };
        let ids: Vec<TriId> = (0..tris.len() as TriId).collect();
        let eights = ids.len().div_ceil(8);
        for eight in ids.chunks(8).step_by(eights.div_ceil(GROUPS).max(1)) {
            this.add(eight);
        }
        this
    }

    /// A group with 64 rays from in front of it to points of its triangles, and beside them.
    fn add(&mut self, ids: &[TriId]) {
        let corners: Vec<GzCoord> = ids.iter().flat_map(|&tri| *self.tris.position(tri)).collect();
        let low = corners.iter().copied().fold(GzCoord::INFINITY, GzCoord::min);
        let high = corners.iter().copied().fold(GzCoord::NEG_INFINITY, GzCoord::max);
        let size = (high - low).length();
        let eye = (low + high) * 0.5 + GzCoord::new(0.4, 0.7, 0.6) * (AWAY * size);
        let towards = |k: usize| {
            let [a, b, c] = *self.tris.position(ids[k % ids.len()]);
            // Weights from the bits of k: seven rays in eight inside of the triangle, the others a little beside it.
            let (u, v) = ((k * 37 % 64) as f32 / 64.0, (k * 23 % 64) as f32 / 64.0);
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let beside = if k % 8 == 7 { 1.5 } else { 1.0 };
            a + (b - a) * (u * beside) + (c - a) * (v * beside)
        };
        let directions: Vec<GzCoord> = (0..BUNDLE).map(|k| (towards(k) - eye).normalize_or_zero()).collect();
        let rays = directions.iter().map(|&direction| GzRay::new(eye, direction));
        let filters: Option<Vec<FilterRay>> = rays.map(|ray| FilterRay::new(&ray, &self.space)).collect();
        // A group beyond the range of f32, or without extent, is no work for these kernels.
        let Some(filters) = filters.filter(|_| size > 0.0) else { return };
        let met = directions.iter().map(|&direction| GzRay::new(eye, direction));
        let met =
            met.flat_map(|ray| ids.iter().map(move |&tri| (ray, tri))).filter(|(ray, tri)| is_hit(ray, self.tris.position(*tri)));
        self.pairs.extend(met.take(PAIRS / GROUPS));
        self.groups.push(TriGroup::new(ids, self.tris.positions(), &self.space));
        self.eyes.push(eye.as_dvec3());
        self.directions.push(directions);
        self.filters.push(filters);
    }

    fn batch(&self, k: usize) -> RayBatch<'_> {
        RayBatch::unbounded(BUNDLE, PerRay::One(self.eyes[k]), PerRay::Each(&self.directions[k]))
    }

    /// The triangles of one group, as a mesh of their own.
    fn alone(&self, k: usize) -> Vec<TriId> {
        self.groups[k].ids().collect()
    }

    /// No kernel loses a hit, and none gives another answer than the exact one.
    fn check(&self) -> Result<(), AppError> {
        let (mut pairs, mut lost, mut other) = (0u64, 0u64, 0u64);
        for (k, group) in self.groups.iter().enumerate() {
            let survivors = self.survivors(k);
            for (i, bits) in survivors.iter().enumerate() {
                let ray = self.batch(k).ray(i);
                for (lane, tri) in group.ids().enumerate() {
                    pairs += 1;
                    let corners = self.tris.position(tri);
                    let hit = is_hit(&ray, corners);
                    lost += u64::from(hit && bits >> lane & 1 == 0);
                    // Well inside or outside there is nothing to round.
                    let weights = if hit { hit_weights(&ray, corners) } else { [0.0; 3] };
                    let well_inside = weights.iter().all(|&w| w > 1e-3);
                    other += u64::from(well_inside && plain(Kernel::MoellerTrumbore, &ray, corners).is_none());
                }
            }
        }
        println!(
            "{} groups, {pairs} pairs of ray and triangle: {lost} hits lost by the f32 kernel, {other} by plain f32 well inside",
            self.groups.len()
        );
        if lost + other > 0 || self.pairs.is_empty() {
            return Err(AppError::Differs(format!("{lost} hits are lost by the f32 kernel, {other} by the plain test")));
        }
        Ok(())
    }

    fn survivors(&self, k: usize) -> Vec<u32> {
        let mut found = Vec::new();
        dispatch(SimdLevel::best(), Survivors { group: &self.groups[k], rays: &self.filters[k], found: &mut found });
        found
    }

    fn time(&self, rounds: usize) -> Vec<Row> {
        let level = SimdLevel::best();
        let rays = (self.groups.len() * BUNDLE) as f64;
        let trees: Vec<TriBuffer> = (0..self.groups.len()).filter_map(|k| self.mesh(&self.alone(k))).collect();
        let trees: Vec<BspTree<'_>> = trees.iter().map(BspTree::build).collect();
        let (mut hits, mut found) = (vec![Hit::MISS; BUNDLE], Vec::with_capacity(BUNDLE));
        let mut bundle = RayBundle::empty();
        let positions = self.tris.positions();
        let mut contenders: Vec<Box<dyn FnMut() + '_>> = vec![
            Box::new(|| {
                for (k, group) in self.groups.iter().enumerate() {
                    for i in 0..BUNDLE {
                        let ray = self.batch(k).ray(i);
                        for tri in group.ids() {
                            black_box(plain(Kernel::MoellerTrumbore, &ray, &positions[tri as usize]));
                        }
                    }
                }
            }),
            Box::new(|| {
                for (group, rays) in self.groups.iter().zip(&self.filters) {
                    found.clear();
                    dispatch(level, Survivors { group, rays, found: &mut found });
                    black_box(&found);
                }
            }),
            Box::new(|| {
                for k in 0..self.groups.len() {
                    dispatch(level, Gather { bundle: &mut bundle, rays: &self.batch(k), space: &self.space });
                }
                black_box(&bundle);
            }),
            Box::new(|| {
                for (k, tree) in trees.iter().enumerate() {
                    tree.closest_hits(&self.batch(k), ClassMask::ALL, &mut hits);
                }
                black_box(&hits);
            }),
            Box::new(|| {
                for (ray, tri) in &self.pairs {
                    black_box(plain(Kernel::MoellerTrumbore, ray, &positions[*tri as usize]));
                }
            }),
            Box::new(|| {
                for (ray, tri) in &self.pairs {
                    black_box(is_hit(ray, &positions[*tri as usize]));
                }
            }),
            Box::new(|| {
                for (ray, tri) in &self.pairs {
                    let mut closest = Closest::default();
                    closest.consider(ray, *tri, positions);
                    black_box(closest.hit(ray, positions));
                }
            }),
        ];
        let times = take_turns(rounds, &mut contenders);
        drop(contenders);
        let row = |what: &str, unit, count: f64, k: usize, plain: Option<usize>| Row {
            what: what.to_owned(),
            unit,
            count,
            times: times[k].clone(),
            plain: plain.map_or_else(Vec::new, |plain| times[plain].clone()),
        };
        let (pairs, met) = (8.0 * rays, self.pairs.len() as f64);
        vec![
            row("plain f32, one ray and one triangle", "pair", pairs, 0, None),
            row("f32 filter, one ray against 8 triangles", "pair", pairs, 1, Some(0)),
            row("64 rays made into a bundle", "ray", rays, 2, None),
            row("64 rays against 8 triangles: bundle, filter, answers", "pair", pairs, 3, Some(0)),
            row("plain f32, a pair that meets", "pair", met, 4, None),
            row("certified in f64, a pair that meets", "pair", met, 5, Some(4)),
            row("certified in f64, and T, u and v", "pair", met, 6, Some(4)),
        ]
    }

    fn mesh(&self, ids: &[TriId]) -> Option<TriBuffer> {
        let corners: Vec<GzCoord> = ids.iter().flat_map(|&tri| *self.tris.position(tri)).collect();
        let triples: Vec<[u32; 3]> = (0..ids.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        TriBuffer::from_indexed(&corners, &triples).ok()
    }
}

/// One group against rays, one after the other.
struct Survivors<'k> {
    group: &'k TriGroup,
    rays: &'k [FilterRay],
    found: &'k mut Vec<u32>,
}

impl Task for Survivors<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        for ray in self.rays {
            self.found.push(self.group.survivors::<S>(ray));
        }
    }
}

/// Sixty-four rays made into a bundle.
struct Gather<'k> {
    bundle: &'k mut RayBundle,
    rays: &'k RayBatch<'k>,
    space: &'k FilterSpace,
}

impl Task for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        black_box(self.bundle.gather::<S>(self.rays, 0, BUNDLE, self.space));
    }
}

/// The walk through the tree of a scene.
struct Walk<'s> {
    tris: &'s TriBuffer,
    tree: BspTree<'s>,
    rays: RaySet,
}

impl<'s> Walk<'s> {
    fn of(scene: &'s BenchScene, most: usize) -> Self {
        Self { tris: &scene.tris, tree: BspTree::build(&scene.tris), rays: scene.rays.primary().as_closest().sample(most) }
    }

    fn check(&self) -> Result<(), AppError> {
        let few = self.rays.sample(CHECKED);
        let wrong = differing(&answers(&BruteForce::new(self.tris), &few), &answers(&self.tree, &few));
        println!("walk: {} rays checked by brute force, {wrong} differ", few.len());
        if wrong > 0 { Err(AppError::Differs(format!("{wrong} answers differ from those of brute force"))) } else { Ok(()) }
    }

    fn time(&self, rounds: usize) -> Vec<Row> {
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

    #[test]
    fn kernels_are_checked_before_they_are_timed() {
        let scene = bench_scene("teapot:2").unwrap();
        let kernels = Kernels::of(&scene.tris);
        kernels.check().unwrap();
        assert!(kernels.groups.len() > 10 && kernels.pairs.len() > 100);
        // Every pair meets, and most rays that should.
        assert!(kernels.pairs.iter().all(|(ray, tri)| is_hit(ray, scene.tris.position(*tri))));
        let rows = kernels.time(2);
        assert_eq!(rows.len(), 7);
        assert!(rows.iter().all(|row| row.times.len() == 2 && row.count > 0.0));
        let walk = Walk::of(&scene, 500);
        walk.check().unwrap();
        assert_eq!(walk.time(2).len(), 3);
    }

    #[test]
    fn the_ratio_stands_beside_what_does_the_same_work() {
        let row = |what: &str, times: [f64; 2], plain: &[f64]| Row {
            what: what.to_owned(),
            unit: "pair",
            count: 1000.0,
            times: times.to_vec(),
            plain: plain.to_vec(),
        };
        let rows = [row("plain", [4e-6, 4e-6], &[]), row("ours", [1e-6, 1e-6], &[4e-6, 4e-6])];
        let text = table(&rows);
        assert!(text.contains("4.00x [4.00, 4.00]") && text.contains("1.00  pair"), "{text}");
        assert_eq!(rows[1].cells("s"), row!["s", "ours", "pair", 1000, "1.000", "1.000 1.000", "4.000 4.000"]);
    }
}
