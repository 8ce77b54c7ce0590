//! The error of T against the distance from the origin of space, and against how thin triangles are.

use crate::cells;
use crate::hard::Dice;
use crate::hard::meshes::Corners;
use crate::judge::{steps, truth_ray, truth_triangle};
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Column, Kind, Row, Table};
use crate::truth::Truth;
use gz_app::args::kernel_name;
use gz_app::error::AppError;
use gz_core::glam::DVec3;
use gz_core::kernel::plain;
use gz_core::{GzRay, Kernel};
use rayon::prelude::*;

const fn columns(x: Column) -> [Column; 8] {
    [
        Column::new("test", "test", "", Kind::Label),
        x,
        Column::new("p50", "T error, median", "ulp", Kind::Count),
        Column::new("p99", "T error, 99 of 100", "ulp", Kind::Count),
        Column::new("worst", "T error, worst", "ulp", Kind::Count),
        Column::new("missed", "hits missed", "%", Kind::Figure),
        Column::new("judged", "T compared", "hits", Kind::Count),
        Column::new("place", "place", "", Kind::Label),
    ]
}

const AT_DISTANCE: [Column; 8] = columns(Column::new("distance", "from the origin", "units", Kind::Figure));
const AT_ASPECT: [Column; 8] = columns(Column::new("aspect", "length by thickness", "", Kind::Figure));

const fn chart(title: &'static str, caption: &'static str, x: Axis) -> [ChartSpec; 1] {
    let y = Axis { column: "p99", title: "↑ error of T that 99 of 100 stay below, ulp", scale: Scale::Log };
    [ChartSpec {
        title,
        caption,
        only: ("", ""),
        drawn: Drawn::Points { x, y, series: "test", label: "", joined: true, zeros: "the exact T, rounded once" },
    }]
}

const DISTANCE_CHART: [ChartSpec; 1] = chart(
    "T against the distance from the origin",
    "The same triangles, moved away from the origin of space with the ray. Tests that subtract the ray's origin first hold; those that \
     work with the coordinates as they are lose a digit with each power of ten.",
    Axis { column: "distance", title: "distance of the scene from the origin →", scale: Scale::Log },
);

const ASPECT_CHART: [ChartSpec; 1] = chart(
    "T against how thin a triangle is",
    "Triangles ten long and ever thinner, hit inside. A rounded normal of a needle points anywhere, and T with it. Woop's T is a mean of \
     the corners and cannot leave the triangle.",
    Axis { column: "aspect", title: "length by thickness →", scale: Scale::Log },
);

const HOW: &str = "A triangle and a ray aimed inside it from about ten units away, for every test alone; the exact T rounded once to f32 is \
                   the truth. Hits that a test misses have no T and are counted beside.";

/// The section on distance.
pub(super) const DISTANCE: Section = Section {
    id: "t-distance",
    chapter: Chapter::Distance,
    title: "Far from the origin",
    how: HOW,
    columns: &AT_DISTANCE,
    charts: &DISTANCE_CHART,
    labels: |_| Ok(labels(&DISTANCES)),
    measure: |run| measure(run, &DISTANCES, |dice, distance| (soup(dice), dice.direction() * distance)),
    says,
};

/// The section on thin triangles.
pub(super) const ASPECT: Section = Section {
    id: "t-aspect",
    chapter: Chapter::Distance,
    title: "Thin triangles",
    how: HOW,
    columns: &AT_ASPECT,
    charts: &ASPECT_CHART,
    labels: |_| Ok(labels(&ASPECTS)),
    measure: |run| measure(run, &ASPECTS, |dice, aspect| (needle(dice, aspect), dice.point(1.0))),
    says,
};

const DISTANCES: [f64; 7] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6];
const ASPECTS: [f64; 8] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7];

/// Those that round, then the exact one.
fn kernels() -> impl Iterator<Item = Kernel> {
    crate::verify::KERNELS.into_iter().chain([Kernel::Certified])
}

fn name(kernel: Kernel) -> &'static str {
    if kernel == Kernel::Certified { "ours" } else { kernel_name(kernel) }
}

fn labels(places: &[f64]) -> Vec<String> {
    kernels().flat_map(|kernel| places.iter().map(move |place| format!("{}, {place:e}", name(kernel)))).collect()
}

/// Corners of an ordinary triangle, about 2 large.
fn soup(dice: &mut Dice) -> [DVec3; 3] {
    loop {
        let corners = [dice.point(1.5), dice.point(1.5), dice.point(1.5)];
        if (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() > 0.5 {
            return corners;
        }
    }
}

/// Corners of a triangle ten long.
fn needle(dice: &mut Dice, aspect: f64) -> [DVec3; 3] {
    let [along, across, _] = dice.frame();
    let at = dice.unit();
    [along * -5.0, along * 5.0, along * (10.0 * at - 5.0) + across * (10.0 / aspect)]
}

/// What became of one ray: the error of T by kernel, `None` for a miss; nothing at all where the truth is a miss.
fn judged(dice: &mut Dice, corners: [DVec3; 3], offset: DVec3) -> Option<Vec<Option<u32>>> {
    let corners: Corners = corners.map(|p| (p + offset).as_vec3());
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    // Inside, away from the edges.
    let [u, v, w] = dice.weights().map(|w| 0.05 + 0.85 * w);
    let target = a * u + b * v + c * w;
    let normal = (b - a).cross(c - a).try_normalize()?;
    let mut from = dice.direction();
    if from.dot(normal).abs() < 0.2 {
        from = (from + normal * 0.5).normalize();
    }
    let origin = (target + from * (5.0 + 10.0 * dice.unit())).as_vec3().as_dvec3();
    let ray = GzRay::from_f64(origin, (target - origin).normalize().as_vec3());
    let truth = Truth::new(&[truth_triangle(&corners)]).closest(&truth_ray(&ray))?;
    Some(kernels().map(|kernel| plain(kernel, &ray, &corners).map(|(t, ..)| steps(t, truth.t))).collect())
}

fn measure(run: &Run, places: &[f64], make: fn(&mut Dice, f64) -> ([DVec3; 3], DVec3)) -> Result<Measured, AppError> {
    let count = run.size(64, 8000, 200_000);
    let at_place = |(k, place): (usize, &f64)| {
        let mut dice = Dice::new(run.seed.wrapping_mul(0x9e37_79b9).wrapping_add(k as u64));
        let mut found = Vec::new();
        let mut tried = 0;
        while found.len() < count && tried < 50 * count {
            tried += 1;
            let (corners, offset) = make(&mut dice, *place);
            found.extend(judged(&mut dice, corners, offset));
        }
        found
    };
    let found: Vec<Vec<Vec<Option<u32>>>> = places.par_iter().enumerate().map(at_place).collect();
    let settings = format!("{}; {count} rays at each place", run.mode.name());
    let mut rows = Vec::new();
    for (k, kernel) in kernels().enumerate() {
        for (place, found) in places.iter().zip(&found) {
            let mut errors: Vec<u32> = found.iter().filter_map(|of_ray| of_ray[k]).collect();
            errors.sort_unstable();
            let at = |share: f64| {
                let last = errors.len().checked_sub(1)?;
                Some(errors[((share * errors.len() as f64).ceil() as usize).saturating_sub(1).min(last)])
            };
            let missed = 100.0 * (found.len() - errors.len()) as f64 / found.len().max(1) as f64;
            let cells = cells![name(kernel), *place, at(0.5), at(0.99), at(1.0), missed, errors.len(), format!("{place:e}")];
            rows.push(Row { cells, n: found.len() as u64, settings: settings.clone() });
        }
    }
    Ok(Measured { rows, pictures: Vec::new() })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let rows_of = |test: &'static str| (0..table.rows.len()).filter(move |&row| table.words(row, "test") == test);
    let Some(last) = rows_of("plane").next_back() else { return String::new() };
    let p99 = |row: usize| table.number(row, "p99").unwrap_or(f64::NAN);
    let place = table.words(last, "place");
    let at_end = |test: &'static str| rows_of(test).next_back().map_or(f64::NAN, p99);
    let ours: f64 = rows_of("ours").filter_map(|row| table.number(row, "worst")).fold(0.0, f64::max);
    let exact = if ours == 0.0 {
        "Ours is the rounded exact T in every case, which is 0 ulp by construction and by this count.".to_owned()
    } else {
        format!("Ours is off by up to {} ulp: that is a bug.", numbers.say("ours", ours, "worst", ""))
    };
    let missed = table.number(last, "missed").unwrap_or(f64::NAN);
    let found = if missed > 1.0 {
        format!(", of the hits that it finds at all: it misses {}", numbers.say("missed", missed, "missed", " %"))
    } else {
        String::new()
    };
    format!(
        "At {place} the paper's T is off by {} ulp or more for one hit in a hundred{found}. Möller and Trumbore's is off by {}, Woop's by {}. \
         {exact}",
        numbers.count("plane", at_end("plane"), "p99"),
        numbers.count("mt", at_end("moeller-trumbore"), "p99"),
        numbers.count("woop", at_end("woop"), "p99"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::run::Mode;

    #[test]
    fn errors_repeat_and_ours_is_always_zero() {
        let run = Run::new(Mode::Tiny, 3, false);
        let rows = || (ASPECT.measure)(&run).unwrap().rows;
        let (one, two) = (rows(), rows());
        assert_eq!(one, two);
        let table = Table { columns: AT_ASPECT.to_vec(), rows: one };
        assert_eq!(table.labels(), (ASPECT.labels)(&run).unwrap());
        for row in 0..table.rows.len() {
            if table.words(row, "test") == "ours" {
                assert_eq!((table.number(row, "worst"), table.number(row, "missed")), (Some(0.0), Some(0.0)));
            }
        }
    }
}
