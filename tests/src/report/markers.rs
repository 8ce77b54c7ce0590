//! Tables of the report in other documents, between two marks.

use super::sections;
use super::store::Store;
use super::table::{Kind, Table};
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use std::path::Path;

/// A table in a document: the file, the section, and the columns that it shows.
struct Place {
    file: &'static str,
    section: &'static str,
    columns: &'static [&'static str],
}

/// Where tables stand.
const PLACES: [Place; 5] = [
    Place { file: "README.md", section: "kernels", columns: &["test", "ns_per_ray", "wrong_per_1e9"] },
    Place { file: "docs/REPORT.md", section: "walks", columns: &["walk", "setting", "ns_per_ray", "wrong_per_1e9"] },
    Place {
        file: "docs/REPORT.md",
        section: "balance",
        columns: &["tree", "balance", "empty", "copies", "tests_per_ray", "ns_per_ray"],
    },
    Place { file: "docs/REPORT.md", section: "model", columns: &["scene", "approximation", "rmse", "saved"] },
    Place { file: "docs/REPORT.md", section: "leaving", columns: &["policy", "ns_per_ray", "wrong_per_1e6", "acne", "leaks"] },
];

/// `table` as Markdown, these columns of it.
fn markdown(table: &Table, columns: &[&str]) -> String {
    let numbers: Vec<usize> = columns.iter().filter_map(|name| table.column(name)).collect();
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = line(numbers.iter().map(|&k| table.columns[k].head()).chain(["n".to_owned()]).collect());
    let rule = |k: &usize| if matches!(table.columns[*k].kind, Kind::Label | Kind::Note) { "---" } else { "---:" };
    text += &format!("|{}|\n", numbers.iter().map(rule).chain(["---:"]).collect::<Vec<_>>().join("|"));
    for row in &table.rows {
        let cells = numbers.iter().map(|&k| row.cells[k].shown(table.columns[k].kind));
        text += &line(cells.chain([super::table::grouped(row.n as f64)]).collect());
    }
    text
}

fn marks(section: &str) -> (String, String) {
    (format!("<!-- report:{section} -->\n"), format!("<!-- /report:{section} -->"))
}

/// `page` with `text` between the marks of `section`.
///
/// # Errors
///
/// If a mark is missing.
pub fn with_table(page: &str, section: &str, text: &str) -> Result<String, String> {
    let (begin, end) = marks(section);
    let missing = || format!("the page must hold the lines {} and {end}", begin.trim_end());
    let (before, rest) = page.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    Ok(format!("{before}{begin}\n{text}\n{end}{after}"))
}

/// A document with all tables that belong into it.
fn filled(store: &Store, file: &str, mut page: String) -> Result<String, AppError> {
    for place in PLACES.iter().filter(|place| place.file == file) {
        let section = sections::all(true).into_iter().find(|section| section.id == place.section);
        let section = section.ok_or_else(|| AppError::Usage(format!("there is no section {}", place.section)))?;
        let (_, table) = store.table(section.id, section.columns)?;
        let text = markdown(&table, place.columns);
        page = with_table(&page, place.section, &text).map_err(|why| AppError::Differs(format!("{file}: {why}")))?;
    }
    Ok(page)
}

fn documents() -> Vec<&'static str> {
    let mut files: Vec<&'static str> = PLACES.iter().map(|place| place.file).collect();
    files.dedup();
    files
}

fn read(path: &Path) -> Result<String, AppError> {
    std::fs::read_to_string(path).map_err(|error| AppError::Io(format!("{}: {error}", path.display())))
}

/// Puts the tables of the report into the documents.
///
/// # Errors
///
/// If a document lacks its marks or cannot be written.
pub fn write(store: &Store, root: &Path) -> Result<(), AppError> {
    for file in documents() {
        let path = root.join(file);
        let old = read(&path)?;
        let new = filled(store, file, old.clone())?;
        if new != old {
            NewFile::at(&path)?.write(new.as_bytes())?;
        }
    }
    Ok(())
}

/// Compares the tables in the documents with those of the report's files.
///
/// # Errors
///
/// [`AppError::Differs`] for the first document that is stale.
pub fn check(store: &Store, root: &Path) -> Result<(), AppError> {
    for file in documents() {
        let old = read(&root.join(file))?;
        if filled(store, file, old.clone())? != old {
            return Err(AppError::Differs(format!("{file}: its tables are stale, run cargo xtask report")));
        }
    }
    Ok(())
}
