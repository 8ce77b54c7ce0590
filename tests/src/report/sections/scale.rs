//! Time and memory of the tree that tunes itself against the number of triangles, and beside others where their results are there.

use crate::bench::scale::{SEGMENTS, Size, power_of};
use crate::cells;
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Column, Kind, Row, Table};

const COLUMNS: [Column; 8] = [
    Column::new("scene", "teapot", "", Kind::Label),
    Column::new("triangles", "triangles", "", Kind::Count),
    Column::new("ns_per_ray", "primary ray", "ns", Kind::Time),
    Column::new("build_one", "build, 1 thread", "s", Kind::Time),
    Column::new("build_all", "build, all threads", "s", Kind::Time),
    Column::new("bytes", "tree", "bytes/triangle", Kind::Figure),
    Column::new("checked", "checked by brute force", "rays", Kind::Count),
    Column::new("wrong", "wrong", "answers", Kind::Count),
];

const X: Axis = Axis { column: "triangles", title: "triangles →", scale: Scale::Log };

const CHARTS: [ChartSpec; 2] = [
    ChartSpec {
        title: "Time of a primary ray",
        caption: "Brute force would rise as steeply as the axis runs: a decade for a decade. What a ray passes on its way through a tree \
                  grows far slower; what rises here beyond that are triangles that no longer fit into the caches.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: X,
            y: Axis { column: "ns_per_ray", title: "↑ ns per primary ray", scale: Scale::Log },
            series: "",
            label: "",
            joined: true,
            zeros: "",
        },
    },
    ChartSpec {
        title: "Time to build",
        caption: "What sorts its triangles takes a little more than proportional time: a decade and a bit for a decade.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: X,
            y: Axis { column: "build_one", title: "↑ seconds to build, one thread", scale: Scale::Log },
            series: "",
            label: "",
            joined: true,
            zeros: "",
        },
    },
];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "scale",
    chapter: Chapter::Scale,
    title: "From a thousand triangles up",
    how: "Teapots of 64 segments² triangles; the primary rays of a picture of 256 by 256, one thread, the median of the rounds, and builds \
          on one thread and on all. As many rays as there is time for are compared with brute force.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |run| Ok(segments(run).iter().map(|n| format!("teapot:{n}")).collect()),
    measure: |run| {
        let settings = format!("{}; {} rounds, rays on 1 thread", run.mode.name(), rounds(run));
        let of_size = |segments: &u32| {
            run.progress.say(&format!("  scale: teapot:{segments}"));
            let it = gz_app::threads::with(1, || Size::measure(*segments, rounds(run), None, run.size(1e5, 1e8, 1e9)))?;
            let cells = cells![
                format!("teapot:{segments}"),
                it.triangles,
                it.per_ray * 1e9,
                it.build_one,
                it.build_all,
                it.bytes as f64 / it.triangles as f64,
                it.checked,
                it.differing,
            ];
            Ok(Row { cells, n: it.rays as u64, settings: settings.clone() })
        };
        let rows = segments(run).iter().map(of_size).collect::<Result<Vec<_>, gz_app::error::AppError>>()?;
        Ok(Measured { rows, pictures: Vec::new() })
    },
    says,
};

fn segments(run: &Run) -> &'static [u32] {
    &SEGMENTS[..run.size(2, 5, SEGMENTS.len())]
}

fn rounds(run: &Run) -> usize {
    run.size(1, 3, 5)
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let values = |name: &str| (0..table.rows.len()).filter_map(|row| table.number(row, name)).collect::<Vec<f64>>();
    let (sizes, rays, builds) = (values("triangles"), values("ns_per_ray"), values("build_one"));
    let (Some(ray), Some(build)) = (power_of(&sizes, &rays), power_of(&sizes, &builds)) else { return String::new() };
    let (Some(first), Some(last)) = (rays.first(), rays.last()) else { return String::new() };
    format!(
        "From {} to {} triangles a ray takes {} times as long: its time grows as n<sup>{}</sup>, the time to build as n<sup>{}</sup>.",
        numbers.count("least", sizes[0], "triangles"),
        numbers.count("most", sizes[sizes.len() - 1], "triangles"),
        numbers.say("ratio", last / first, "ns_per_ray", ""),
        numbers.say("ray exponent", ray, "ns_per_ray", ""),
        numbers.say("build exponent", build, "build_one", ""),
    )
}
