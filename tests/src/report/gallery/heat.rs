//! Heat maps: the work that each pixel's primary ray is.

use super::srgb;
use crate::cells;
use crate::model::placed;
use crate::report::findings::Numbers;
use crate::report::picture::Picture;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::accel::Accel;
use gz_app::error::AppError;
use gz_app::heat::{Effort, HeatMap, HeatScale, Spread};
use gz_app::load::Overrides;
use gz_bsp::Midpoint;
use gz_core::{Kernel, TileGrid};
use gz_shade::Antialias;

const COLUMNS: [Column; 5] = [
    Column::new("tree", "answered by", "", Kind::Label),
    Column::new("effort", "counted", "", Kind::Label),
    Column::new("least", "least", "per pixel", Kind::Count),
    Column::new("mean", "mean", "per pixel", Kind::Figure),
    Column::new("most", "most", "per pixel", Kind::Count),
];

/// The section.
pub(in crate::report) const SECTION: Section = Section {
    id: "heat",
    chapter: Chapter::Tree,
    title: "Where the work is",
    how: "Every primary ray of the paper's scene, sent by itself, and what it takes: dark blue is none, light yellow the most of the two trees, \
          evenly in the logarithm between; brute force is off the scale. <code>gz render --view tests</code> and <code>--view visits</code> draw \
          the same for any scene. A node of the self-tuned tree has eight cells, and its groups count eight tests each.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| {
        Ok(EFFORTS.iter().flat_map(|(_, effort, _)| trees().map(move |(tree, ..)| format!("{tree}, {effort}"))).collect())
    },
    measure,
    says,
};

const EFFORTS: [(Effort, &str, &str); 2] =
    [(Effort::Tests, "triangles", "tests"), (Effort::Visits, "nodes and leaves", "visits")];

fn trees() -> impl Iterator<Item = (&'static str, Accel, &'static str)> {
    [
        ("brute force", Accel::Brute(Kernel::Certified), "brute"),
        ("midpoint (15, 5)", Accel::Midpoint(Midpoint::default()), "midpoint"),
        ("self-tuned", Accel::Bsp, "tuned"),
    ]
    .into_iter()
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let size = run.size(24, 320, 512);
    let (scene, _) =
        placed("paper-reflection", &Overrides { size: Some((size, size)), aa: Some(Antialias::None), ..Overrides::NONE })?;
    let grid = TileGrid::whole(size, size, 32);
    let mut measured = Measured::default();
    for (effort, counted, word) in EFFORTS {
        let maps = trees()
            .map(|(tree, accel, name)| Ok((tree, name, HeatMap::trace(&scene, &accel.build(&scene.tris)?, effort, &grid))))
            .collect::<Result<Vec<_>, AppError>>()?;
        // One scale for all, so that colours may be compared; brute force, the same everywhere, is off it.
        let full = maps[1..].iter().map(|(.., map)| map.most()).max().unwrap_or(1);
        for (tree, name, map) in &maps {
            let cells = cells![*tree, counted, map.least(), map.mean(), map.most()];
            measured.rows.push(Row { cells, n: u64::from(size * size), settings: format!("{}; {size}x{size}", run.mode.name()) });
            let caption = format!("{tree}. {counted} a pixel: {} to {}, {:.1} on average.", map.least(), map.most(), map.mean());
            // Brute force visits no node: a black picture shows nothing.
            if map.most() > 0 {
                let frame = map.frame(HeatScale { full, spread: Spread::Log });
                measured.pictures.push(Picture::drawing(&format!("{word}-{name}"), &caption, size, size, &srgb(&frame.colors))?);
            }
        }
    }
    Ok(measured)
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let find = |tree: &str| {
        (0..table.rows.len()).find(|&row| table.words(row, "tree") == tree && table.words(row, "effort") == "triangles")
    };
    let (Some(brute), Some(midpoint), Some(tuned)) = (find("brute force"), find("midpoint (15, 5)"), find("self-tuned")) else {
        return String::new();
    };
    let mean = |row: usize| table.number(row, "mean").unwrap_or(f64::NAN);
    format!(
        "Of {} triangles a primary ray looks at {} on average in the paper's tree and at {} in the self-tuned one, eight at a time. What is \
         bright are outlines: rays that pass close by.",
        numbers.count("brute", mean(brute), "mean"),
        numbers.say("midpoint", mean(midpoint), "mean", ""),
        numbers.say("tuned", mean(tuned), "mean", ""),
    )
}
