//! The failures that the paper tells of, made again on purpose, beside their cures.

use crate::cells;
use crate::failures;
use crate::report::picture::Picture;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;

const COLUMNS: [Column; 3] = [
    Column::new("failure", "failure", "", Kind::Label),
    Column::new("differing", "pixels wrong", "", Kind::Count),
    Column::new("share", "pixels wrong", "%", Kind::Figure),
];

/// The section.
pub(in crate::report) const SECTION: Section = Section {
    id: "failures",
    chapter: Chapter::Pictures,
    title: "What went wrong on the way",
    how: "The failures of the paper's 2.4 and 3.3.2, made again on purpose, with the cure under the slider. Each mistake is in this repository \
          as code that only the report and its tests call.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| Ok(NAMES.map(str::to_owned).to_vec()),
    measure,
    says: |_: &Table| String::new(),
};

/// What [`failures::all`] makes.
const NAMES: [&str; 5] = ["stipple", "stipple-at-edges", "holes", "lights-in-world-space", "normals-in-world-space"];

fn measure(run: &Run) -> Result<Measured, AppError> {
    let width = run.size(32, 400, 480);
    let mut measured = Measured::default();
    for failure in failures::all(width)? {
        run.progress.say(&format!("  failures: {}", failure.name));
        let pixels = u64::from(failure.wrong.width * failure.wrong.height);
        let differing = failure.differing();
        let cells = cells![failure.name, differing, 100.0 * differing as f64 / pixels as f64];
        let settings = format!("{}; {}x{}", run.mode.name(), failure.wrong.width, failure.wrong.height);
        measured.rows.push(Row { cells, n: pixels, settings });
        let title = failure.name.replace('-', " ");
        let photo = |side: &str, caption: String, shot: &failures::Shot| {
            Picture::photo(&format!("{}.{side}", failure.name), &caption, shot.width, shot.height, &shot.rgb)
        };
        measured.pictures.extend([
            photo("before", format!("{title}. {}", failure.why), &failure.wrong)?,
            photo("after", format!("cured. Left: {}; right: {}.", failure.wrong.caption, failure.cure.caption), &failure.cure)?,
        ]);
    }
    Ok(measured)
}
