//! Ours beside other ray tracers, where `cargo xtask bench peers --write` has left its results.

use crate::bench::record::committed;
use crate::cells;
use crate::report::findings::Numbers;
use crate::report::section::{Chapter, ChartSpec, Drawn, Measured, Section};
use crate::report::store::csv_lines;
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use std::path::{Path, PathBuf};

const COLUMNS: [Column; 5] = [
    Column::new("set", "mesh, rays", "", Kind::Label),
    Column::new("who", "who", "", Kind::Label),
    Column::new("mrays", "speed", "Mrays/s", Kind::Time),
    Column::new("of_ours", "of ours", "×", Kind::Time),
    Column::new("file", "file", "", Kind::Note),
];

const CHARTS: [ChartSpec; 1] = [ChartSpec {
    title: "Rays a second beside others",
    caption: "Longer is better. The same rays on the same machine in turns; Embree in its fastest settings.",
    only: ("", ""),
    drawn: Drawn::Bars { parts: &["mrays"], title: "millions of rays a second →" },
}];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "peers",
    chapter: Chapter::Scale,
    title: "Beside other ray tracers",
    how: "What <code>cargo xtask bench peers --write</code> has measured, from the newest file of <code>docs/bench</code>; docs/BENCH.md says \
          how, and what is fair about it.",
    columns: &COLUMNS,
    charts: &CHARTS,
    // Results of another program: whatever rows there are.
    labels: |_| Ok(rows()?.iter().map(label).collect()),
    measure: |_| Ok(Measured { rows: rows()?, pictures: Vec::new() }),
    says,
};

/// Whether there is anything to show.
pub(in crate::report) fn has_results() -> bool {
    !races().is_empty()
}

fn label(row: &Row) -> String {
    format!("{}, {}", row.cells[0].text(), row.cells[1].text())
}

/// The name and text of the newest record of tracing: that of the last revision.
fn newest() -> Result<Option<(String, String)>, AppError> {
    let mut newest = None;
    for path in races() {
        let text = std::fs::read_to_string(&path).map_err(|error| AppError::Io(format!("{}: {error}", path.display())))?;
        let record = (name_of(&path), text);
        if newest.as_ref().is_none_or(|newest| age_of(newest) < age_of(&record)) {
            newest = Some(record);
        }
    }
    Ok(newest)
}

/// The files of tracing results.
fn races() -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(crate::report::root().join("docs/bench")) else { return Vec::new() };
    let is_race = |path: &PathBuf| {
        let name = name_of(path);
        name.starts_with("peers-") && !name.starts_with("peers-build-") && name.ends_with(".csv")
    };
    entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_race).collect()
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What records are ordered by, the newest last; the name decides between records of one revision.
fn age_of((name, text): &(String, String)) -> (Option<u64>, &str) {
    (committed(text), name)
}

/// A row for each line of the newest record.
fn rows() -> Result<Vec<Row>, AppError> {
    Ok(newest()?.map(|(file, text)| rows_of(&text, &file)).unwrap_or_default())
}

/// The rows of a file's text; lines that lack a column are left out.
fn rows_of(text: &str, file: &str) -> Vec<Row> {
    let plain: String = text.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n")).collect();
    let lines = csv_lines(&plain);
    let Some((head, lines)) = lines.split_first() else { return Vec::new() };
    let lap = |line: &Vec<String>| {
        let word = |name: &str| head.iter().position(|known| known == name).and_then(|k| line.get(k).cloned());
        let threads = word("threads").filter(|threads| threads != "1").map_or_else(String::new, |n| format!(", {n} threads"));
        let set = format!("{}, {}{threads}", word("mesh")?, word("set")?);
        let (rays, mrays) = (word("rays")?.parse::<u64>().ok()?, word("Mrays/s median")?.parse::<f64>().ok()?);
        let rounds = word("seconds by round")?.split(' ').count();
        Some((set, word("competitor")?, rays, mrays, rounds))
    };
    let laps: Vec<_> = lines.iter().filter_map(lap).collect();
    let ours = |set: &str| laps.iter().find(|(known, who, ..)| known == set && who.starts_with("gz")).map(|lap| lap.3);
    laps.iter()
        .map(|(set, who, rays, mrays, rounds)| {
            let cells = cells![set.as_str(), who.as_str(), *mrays, ours(set).map(|ours| mrays / ours), file];
            Row { cells, n: *rays, settings: format!("quick; {rounds} rounds, of {file}") }
        })
        .collect()
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let rows = 0..table.rows.len();
    let best = rows.filter(|&row| table.words(row, "who").starts_with("embree")).filter_map(|row| table.number(row, "of_ours"));
    let best = best.fold(0.0, f64::max);
    if best == 0.0 {
        return String::new();
    }
    format!("Where Embree is strongest beside ours it reaches {} times our speed.", numbers.say("embree", best, "of_ours", ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_record_is_of_the_last_commit_whatever_the_files_say() {
        let record = |name: &str, text: &str| (name.to_owned(), text.to_owned());
        let old = record("peers-b.csv", "# revision: b\n# committed: 99, 1970-01-01\nmesh\n");
        let new = record("peers-a.csv", "# revision: a\n# committed: 100, 1970-01-01\nmesh\n");
        let without = record("peers-c.csv", "# revision: c\nmesh\n");
        assert!(age_of(&old) < age_of(&new) && age_of(&without) < age_of(&old));
        assert!(age_of(&record("peers-a-dirty.csv", &new.1)) < age_of(&new));
    }

    #[test]
    fn lines_of_a_race_become_rows_beside_ours() {
        let text = "# machine: some\nmesh,set,threads,competitor,rays,Mrays/s median,seconds by round\n\
                    pot,prim,1,gz:default,100,4.0,1 2 3\npot,prim,1,embree4:1,100,3.0,1 2 3\nbroken\n";
        let table = Table { columns: COLUMNS.to_vec(), rows: rows_of(text, "f.csv") };
        assert_eq!(table.labels(), ["pot, prim, gz:default", "pot, prim, embree4:1"]);
        assert_eq!((table.number(1, "of_ours"), table.rows[1].n), (Some(0.75), 100));
    }
}
