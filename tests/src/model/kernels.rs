//! Errors of f32: the paper's test as it is printed, and the answers that are stored.

use super::pictures::{self, COLUMNS, placed, shot_by, sized};
use super::{Table, figure};
use gz_app::error::LoadError;
use gz_bsp::BspTree;
use gz_core::glam::{DVec2, DVec3};
use gz_core::{BruteForce, GzRay, Hit, Kernel, TBuffer, kernel};
use gz_shade::Scene;

/// A number of errors with their greatest and their sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// How many.
    pub n: u64,
    /// The greatest.
    pub max: f64,
    sum: f64,
}

impl Errors {
    pub(super) fn add(&mut self, error: f64) {
        self.n += 1;
        self.max = self.max.max(error);
        self.sum += error;
    }

    /// Their mean; 0 when there are none.
    pub fn mean(&self) -> f64 {
        self.sum / self.n.max(1) as f64
    }
}

/// What the paper's test answers to the primary rays of a picture, against the exact answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneErrors {
    /// Rays.
    pub rays: u64,
    /// Rays that hit, exactly.
    pub hits: u64,
    /// Rays that slip through: a hit that the test misses altogether.
    pub holes: u64,
    /// Rays that hit nothing but do by the test.
    pub phantoms: u64,
    /// Rays for which it names another triangle.
    pub others: u64,
    /// Rays whose exact answer is clear: its weights all exceed 1e-4 and it meets the plane at more than 1e-3 radians.
    pub clear: u64,
    /// Of those, answered wrongly.
    pub clear_wrong: u64,
    /// Relative error of T where the triangle is the same.
    pub t: Errors,
    /// Error of the weights u and v where the triangle is the same.
    pub weights: Errors,
}

/// Every primary ray of `scene`, with its exact hit.
pub(crate) fn primary(scene: &Scene) -> impl Iterator<Item = (GzRay, Hit)> + '_ {
    let hits = TBuffer::trace(&scene.camera, &BspTree::build(&scene.tris)).hits;
    let width = scene.camera.width();
    (0..).zip(hits).map(move |(k, hit)| (scene.camera.ray(k % width, k / width, DVec2::ZERO), hit))
}

/// Where a ray meets the triangle that it is known to hit, in f64.
pub(super) struct Meeting {
    pub(super) weights: [f64; 3],
    pub(super) point: DVec3,
    pub(super) t: f64,
}

impl Meeting {
    pub(super) fn of(scene: &Scene, ray: &GzRay, hit: &Hit) -> Self {
        let corners = scene.tris.position(hit.tri);
        let weights = kernel::hit_weights(ray, corners);
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let point = a * weights[0] + b * weights[1] + c * weights[2];
        let d = ray.direction.as_dvec3();
        Self { weights, point, t: (point - ray.origin).dot(d) / d.length_squared() }
    }
}

/// The paper's test on the primary rays of `scene`.
pub fn plane_errors(scene: &Scene) -> PlaneErrors {
    let plane = TBuffer::trace(&scene.camera, &BruteForce::with_kernel(&scene.tris, Kernel::Plane)).hits;
    let mut errors = PlaneErrors::default();
    for ((ray, exact), plane) in primary(scene).zip(plane) {
        errors.rays += 1;
        errors.hits += u64::from(exact.is_hit());
        match (exact.is_hit(), plane.is_hit()) {
            (false, true) => errors.phantoms += 1,
            (true, false) => errors.holes += 1,
            _ => errors.others += u64::from(exact.tri != plane.tri),
        }
        if !exact.is_hit() {
            continue;
        }
        let meeting = Meeting::of(scene, &ray, &exact);
        let slope = ray.direction.as_dvec3().normalize_or_zero().dot(scene.tris.face_normal(exact.tri)).abs();
        if meeting.weights.iter().all(|&w| w > 1e-4) && slope.asin() > 1e-3 {
            errors.clear += 1;
            errors.clear_wrong += u64::from(exact.tri != plane.tri);
        }
        if exact.tri == plane.tri {
            errors.t.add((f64::from(plane.t) / meeting.t - 1.0).abs());
            errors.weights.add((f64::from(plane.u) - meeting.weights[1]).abs());
            errors.weights.add((f64::from(plane.v) - meeting.weights[2]).abs());
        }
    }
    errors
}

/// What rounding the exact answer to f32 costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoundingErrors {
    /// Relative error of T.
    pub t: Errors,
    /// Error of the weights u and v.
    pub weights: Errors,
    /// Distance of origin + T direction from the point of the hit.
    pub point_by_t: Errors,
    /// Distance of the point that u and v give.
    pub point_by_weights: Errors,
}

/// The stored hits of the primary rays of `scene` against the same in f64.
pub fn rounding_errors(scene: &Scene) -> RoundingErrors {
    let mut errors = RoundingErrors::default();
    for (ray, hit) in primary(scene).filter(|(_, hit)| hit.is_hit()) {
        let meeting = Meeting::of(scene, &ray, &hit);
        errors.t.add((f64::from(hit.t) / meeting.t - 1.0).abs());
        errors.weights.add((f64::from(hit.u) - meeting.weights[1]).abs());
        errors.weights.add((f64::from(hit.v) - meeting.weights[2]).abs());
        errors.point_by_t.add(ray.at(hit.t).distance(meeting.point));
        errors.point_by_weights.add(scene.tris.hit_point(&hit).distance(meeting.point));
    }
    errors
}

pub(super) fn plane_table() -> Result<Table, LoadError> {
    let (scene, _) = placed("teapot", &sized(320, 240))?;
    let errors = plane_errors(&scene);
    let row = |what: &str, figure: String, n: u64| vec![what.to_owned(), figure, n.to_string()];
    let mut rows = vec![
        row("rays that slip through a surface", errors.holes.to_string(), errors.hits),
        row("rays that hit where nothing is", errors.phantoms.to_string(), errors.rays - errors.hits),
        row("rays that are given another triangle", errors.others.to_string(), errors.hits),
        row("wrong answers to clear rays", errors.clear_wrong.to_string(), errors.clear),
        row("relative error of T, max", figure(errors.t.max), errors.t.n),
        row("relative error of T, mean", figure(errors.t.mean()), errors.t.n),
        row("error of u and v, max", figure(errors.weights.max), errors.weights.n),
        row("error of u and v, mean", figure(errors.weights.mean()), errors.weights.n),
    ];
    // The whole picture by that test: its shadow, mirror and glass rays too.
    let (scene, needs) = placed("teapot", &sized(160, 120))?;
    let exact = shot_by(&scene, needs, &BspTree::build(&scene.tris));
    let plane = shot_by(&scene, needs, &BruteForce::with_kernel(&scene.tris, Kernel::Plane));
    let cells = plane.against(&exact);
    if let Some((pixels, figures)) = cells.split_last() {
        for (column, figure) in COLUMNS.iter().zip(figures) {
            rows.push(vec![format!("whole picture: {column}"), figure.clone(), pixels.clone()]);
        }
    }
    Ok(Table {
        title: "The paper's test in f32 against the exact answer".to_owned(),
        how: format!(
            "`--kernel plane` against the default kernel on the scene `teapot`, {} triangles. First the primary rays of a picture of \
             320 by 240; *clear* are those whose exact weights all exceed 1e-4 and that meet the plane at more than 1e-3 radians. \
             Then a whole picture of 160 by 120 with all its rays, whose origins the test rounds to f32: many start behind the surface \
             that they leave, as in the table before. {}",
            scene.tris.len(),
            pictures::MEANING
        ),
        columns: vec!["what", "figure", "n"],
        rows,
    })
}

pub(super) fn rounding_table() -> Result<Table, LoadError> {
    let (scene, _) = placed("teapot", &sized(320, 240))?;
    let errors = rounding_errors(&scene);
    let row = |what: &str, errors: Errors| vec![what.to_owned(), figure(errors.max), figure(errors.mean()), errors.n.to_string()];
    Ok(Table {
        title: "Stored f32 against f64".to_owned(),
        how: "T is the exact t rounded once, so its error is at most 2^-24, 5.96e-8, by construction. Measured on the primary hits of \
              `teapot` at 320 by 240, against the point that weights in f64 give. Distances are in units of the scene, in which \
              the teapot is about 6 wide and 13 away. Shading and secondary rays start from the weights in f64, not from these."
            .to_owned(),
        columns: vec!["what", "max", "mean", "n"],
        rows: vec![
            row("relative error of T", errors.t),
            row("error of u and v", errors.weights),
            row("distance of origin + T direction", errors.point_by_t),
            row("distance of the point by u and v", errors.point_by_weights),
        ],
    })
}
