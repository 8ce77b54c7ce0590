//! A frame certified: every question that a render asks, judged as it is answered.

use crate::judge::{Tally, truth_ray, truth_triangle, truth_triangles};
use crate::truth::{ExactPoint, Line, Meeting, Steps, Triangle, Truth, plain};
use gz_core::kernel::hit_weights;
use gz_core::{ClassMask, GzRay, Hit, NO_TRI, RayBatch, RayQuery, TileGrid, TriBuffer, TriId};
use gz_shade::{FrameStats, MaterialKind, Scene, SceneNeeds, ShadeScratch, shade_tile};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From the camera.
    Primary,
    /// From a surface to a light.
    Shadow,
    /// Of a shadow ray, which glass is in its way.
    Tint,
    /// Reflected by a mirror.
    Mirror,
    /// Reflected or refracted by glass.
    Glass,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Primary, Self::Shadow, Self::Tint, Self::Mirror, Self::Glass];

    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Tint => "tint",
            Self::Mirror => "mirror",
            Self::Glass => "glass",
        }
    }
}

/// What was found of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Certificate {
    /// Answers judged, by [`Kind`] in the order of [`Kind::ALL`].
    pub kinds: [Tally; Kind::ALL.len()],
    /// Rays that leave a surface and whose exact hit point is known.
    pub leaving: u64,
    /// Rays that leave a surface from where none of the frame's hits leads: there must be none.
    pub astray: u64,
    /// Of the leaving ones, rays whose exact answer from the exact hit point differs from that from their own start.
    pub undecided: u64,
    /// Decided ones that hit something which truly is not in the way.
    pub acne: u64,
    /// Decided ones that miss what truly is in the way.
    pub leaks: u64,
    /// Rays that integers alone were asked about too.
    pub plain: u64,
    /// Of these, rays on which they differ from the truth by intervals: there must be none.
    pub plain_differing: u64,
    /// What the frame counted.
    pub stats: FrameStats,
}

impl Certificate {
    /// All answers together.
    pub fn all(&self) -> Tally {
        let mut sum = Tally::default();
        self.kinds.into_iter().for_each(|tally| sum += tally);
        sum
    }

    /// Whether nothing is wrong and nothing was left out.
    pub fn is_clean(&self) -> bool {
        self.all().is_clean() && self.astray + self.acne + self.leaks + self.plain_differing + self.stats.nan_pixels == 0
    }
}

/// Shades the whole picture of `scene` through `query` and judges every answer.
///
/// The frame runs on the calling thread, which is none of a pool's; the truth is asked on the threads of `pool`. `plain_tests` triangles, more or less, are tested with integers
/// alone besides.
pub fn certify(
    scene: &Scene,
    needs: SceneNeeds,
    query: &dyn RayQuery,
    pool: &rayon::ThreadPool,
    plain_tests: u64,
) -> Certificate {
    let pixels = u64::from(scene.camera.width()) * u64::from(scene.camera.height());
    let tests = 4 * pixels * scene.tris.len() as u64;
    let certifier = Certifier {
        scene,
        inner: query,
        pool,
        triangles: truth_triangles(&scene.tris),
        truths: Mutex::default(),
        plain_stride: tests.div_ceil(plain_tests.max(1)).max(1),
        notes: Mutex::default(),
    };
    let grid = TileGrid::whole(scene.camera.width(), scene.camera.height(), 64);
    // Tile by tile on this thread: one that waits for the pool must not begin another tile meanwhile.
    let (mut scratch, mut colors, mut stats) = (ShadeScratch::default(), Vec::new(), FrameStats::default());
    for tile in grid.tiles() {
        shade_tile(scene, needs, &certifier, &tile, &mut scratch, &mut colors, &mut stats);
    }
    let mut certificate = certifier.notes.into_inner().unwrap_or_else(PoisonError::into_inner).certificate;
    certificate.stats = stats;
    certificate
}

struct Certifier<'a> {
    scene: &'a Scene,
    inner: &'a dyn RayQuery,
    pool: &'a rayon::ThreadPool,
    triangles: Vec<Triangle>,
    /// The truth about the triangles of some classes, made when first asked for.
    truths: Mutex<Vec<(ClassMask, Truth)>>,
    plain_stride: u64,
    notes: Mutex<Notes>,
}

#[derive(Default)]
struct Notes {
    certificate: Certificate,
    /// Hits since the last camera rays: what rays can leave from, by triangle, and where each triangle's search went on last.
    hits: HashMap<TriId, (Vec<GzRay>, usize)>,
    asked: u64,
}

/// One ray to be judged.
struct Quest {
    ray: GzRay,
    /// Where it truly starts, if it leaves a surface.
    from: Option<ExactPoint>,
    plain: bool,
}

impl Certifier<'_> {
    fn judge(&self, rays: &RayBatch<'_>, classes: ClassMask, kind: Kind, found: &[Found]) {
        let quests = self.quests(rays, kind);
        let mut truths = self.truths.lock().unwrap_or_else(PoisonError::into_inner);
        if !truths.iter().any(|(known, _)| *known == classes) {
            let truth = Truth::of_some(&self.triangles, |tri| classes.has(self.scene.tris.class(tri)));
            truths.push((classes, truth));
        }
        let Some((_, truth)) = truths.iter().find(|(known, _)| *known == classes) else { return };
        let judged: Vec<Certificate> = self.pool.install(|| {
            quests
                .par_iter()
                .zip(found)
                .with_min_len(64)
                .map(|(quest, found)| self.one(quest, found, truth, classes, kind))
                .collect()
        });
        let mut notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        for one in judged {
            notes.certificate += one;
        }
    }

    /// The rays of a batch, with the exact points that they leave from.
    fn quests(&self, rays: &RayBatch<'_>, kind: Kind) -> Vec<Quest> {
        let mut notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        (0..rays.len())
            .map(|i| {
                let (ray, source) = (rays.ray(i), rays.left_by(i));
                notes.asked += 1;
                let plain = kind != Kind::Tint && notes.asked.is_multiple_of(self.plain_stride);
                let from = (source != NO_TRI).then(|| self.parent(&mut notes, &ray, source)).flatten();
                notes.certificate.astray += u64::from(source != NO_TRI && from.is_none());
                Quest { ray, from, plain }
            })
            .collect()
    }

    /// The exact point of the hit on `source` that `ray` leaves: the one from which leaving in its direction gives its very origin.
    fn parent(&self, notes: &mut Notes, ray: &GzRay, source: TriId) -> Option<ExactPoint> {
        let corners = self.scene.tris.position(source);
        let (hits, at) = notes.hits.get_mut(&source)?;
        let leaves = |parent: &GzRay| {
            let start = self.scene.rules.leave.leave(corners, hit_weights(parent, corners), ray.direction);
            start.is_some_and(|start| start.origin.to_array().map(f64::to_bits) == ray.origin.to_array().map(f64::to_bits))
        };
        // Rays come in the order of the hits they leave, so the next hit is nearly always the one.
        let n = hits.len();
        let k = (0..n).map(|step| (*at + step) % n).find(|&k| leaves(&hits[k]))?;
        *at = k;
        let line = truth_ray(&hits[k]).line()?;
        Meeting::of(&line, &truth_triangle(corners)).map(|meeting| meeting.point)
    }

    fn one(&self, quest: &Quest, found: &Found, truth: &Truth, classes: ClassMask, kind: Kind) -> Certificate {
        let mut one = Certificate::default();
        let tally = &mut one.kinds[kind as usize];
        let asked = truth_ray(&quest.ray);
        let (expected, is_right) = match found {
            Found::Hit(hit) => {
                let expected = truth.closest(&asked);
                tally.add(hit, expected);
                (expected.map(|found| found.tri), hit.is_hit().then_some(hit.tri) == expected.map(|found| found.tri))
            }
            Found::Blocked(blocked) => {
                let expected = truth.any(&asked);
                tally.rays = 1;
                tally.hits = u64::from(expected);
                tally.false_hits = u64::from(*blocked && !expected);
                tally.false_misses = u64::from(!*blocked && expected);
                (expected.then_some(NO_TRI), *blocked == expected)
            }
        };
        if quest.plain && classes == ClassMask::ALL {
            let plain = plain::closest(&asked, &self.triangles);
            one.plain = 1;
            one.plain_differing = u64::from(match found {
                Found::Hit(_) => plain != truth.closest(&asked),
                Found::Blocked(_) => plain.is_some() != expected.is_some(),
            });
        }
        // Behind glass that a shadow ray has passed it goes on from its start with another beginning: no question of leaving.
        if let Some(from) = quest.from.clone().filter(|_| quest.ray.tmin == 0.0)
            && let Some(line) = Line::from_point(from, asked.direction, asked.tmax)
        {
            one.leaving = 1;
            let exact = match found {
                Found::Hit(_) => truth.closest_of(&line, &mut Steps::default()).map(|found| found.tri),
                Found::Blocked(_) => truth.any_of(&line, &mut Steps::default()).then_some(NO_TRI),
            };
            let hits = match found {
                Found::Hit(hit) => hit.is_hit(),
                Found::Blocked(blocked) => *blocked,
            };
            if exact != expected {
                one.undecided = 1;
            } else if !is_right {
                (one.acne, one.leaks) = (u64::from(hits), u64::from(!hits));
            }
        }
        one
    }
}

/// An answer of the product.
enum Found {
    Hit(Hit),
    Blocked(bool),
}

impl RayQuery for Certifier<'_> {
    fn tris(&self) -> &TriBuffer {
        self.inner.tris()
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        self.inner.closest_hits(rays, classes, hits);
        let kind = match rays.leaves {
            _ if classes != ClassMask::ALL => Kind::Tint,
            None => Kind::Primary,
            // Mirror and glass rays come in batches of their own.
            Some(leaves) => match leaves.first().map(|&tri| self.scene.material(tri).kind) {
                Some(MaterialKind::Mirror { .. }) => Kind::Mirror,
                _ => Kind::Glass,
            },
        };
        let found: Vec<Found> = hits.iter().map(|&hit| Found::Hit(hit)).collect();
        self.judge(rays, classes, kind, &found);
        if kind == Kind::Tint {
            return;
        }
        let mut notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        if kind == Kind::Primary {
            notes.hits.clear();
        }
        for (i, hit) in hits.iter().enumerate().filter(|(_, hit)| hit.is_hit()) {
            notes.hits.entry(hit.tri).or_default().0.push(rays.ray(i));
        }
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        self.inner.any_hits(rays, classes, occluded);
        let found: Vec<Found> = occluded.iter().map(|&blocked| Found::Blocked(blocked)).collect();
        self.judge(rays, classes, Kind::Shadow, &found);
    }
}

impl std::ops::AddAssign for Certificate {
    fn add_assign(&mut self, other: Self) {
        for (sum, tally) in self.kinds.iter_mut().zip(other.kinds) {
            *sum += tally;
        }
        self.leaving += other.leaving;
        self.astray += other.astray;
        self.undecided += other.undecided;
        self.acne += other.acne;
        self.leaks += other.leaks;
        self.plain += other.plain;
        self.plain_differing += other.plain_differing;
        self.stats += other.stats;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::placed;
    use gz_app::load::Overrides;
    use gz_bsp::BspTree;
    use gz_core::{BruteForce, Kernel};

    const SMALL: Overrides = Overrides { size: Some((48, 36)), ..Overrides::NONE };

    fn pool() -> rayon::ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap()
    }

    #[test]
    fn frames_are_certified_ray_by_ray() {
        for (name, kinds) in [("shadows", &[0, 1][..]), ("reflection", &[0, 1, 3]), ("refraction", &[0, 1, 2, 4])] {
            let (scene, needs) = placed(name, &SMALL);
            let certificate = certify(&scene, needs, &BspTree::build(&scene.tris), &pool(), 100_000);
            assert!(certificate.is_clean(), "{name}: {certificate:?}");
            for kind in kinds {
                assert!(certificate.kinds[*kind].rays > 0, "{name}: no {} rays", Kind::ALL[*kind].name());
            }
            let stats = certificate.stats;
            assert_eq!(certificate.all().rays, stats.rays() + stats.tint_queries, "{name}: every question is judged");
            assert!(certificate.plain > 0 && certificate.leaving > 1000, "{name}: {certificate:?}");
        }
    }

    #[test]
    fn a_kernel_that_is_wrong_is_found_out() {
        let (scene, needs) = placed("shadows", &SMALL);
        let plane = BruteForce::with_kernel(&scene.tris, Kernel::Plane);
        let certificate = certify(&scene, needs, &plane, &pool(), 0);
        // Its T is rounded otherwise, and its shadow rays start in f32, half of them behind what they leave.
        assert!(!certificate.is_clean() && certificate.all().t > 100 && certificate.acne > 20, "{certificate:?}");
    }
}
