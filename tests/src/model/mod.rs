//! What the model leaves out, in numbers: the measurements behind the tables of docs/MODEL.md.
//!
//! No figure is a time, and every picture is the same on every machine, so the page can be checked against a new run.

mod fresnel;
mod kernels;
mod leaving;
mod pictures;
mod quick;

use gz_app::error::LoadError;
use std::fmt::Write;
use std::path::{Path, PathBuf};

pub use fresnel::{AngleError, angle_error};
pub(crate) use kernels::primary as primary_hits;
pub use kernels::{Errors, PlaneErrors, RoundingErrors, plane_errors, rounding_errors};
pub use leaving::{LeavingErrors, leaving_errors};
pub(crate) use pictures::{Shot, placed, shot, shot_by, sized};
pub use quick::{patch_errors, write_error};

/// A table of the page.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it is about.
    pub title: String,
    /// How it is measured, one paragraph.
    pub how: String,
    /// Names of the columns.
    pub columns: Vec<&'static str>,
    /// Rows of as many cells.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The table as Markdown, under a heading of the third level.
    pub fn markdown(&self) -> String {
        let mut text = format!("### {}\n\n{}\n\n", self.title, self.how);
        let line = |text: &mut String, cells: &[String]| {
            let _ = writeln!(text, "| {} |", cells.join(" | ")); // writing to a string cannot fail
        };
        line(&mut text, &self.columns.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
        let _ = writeln!(text, "|{}", "---|".repeat(self.columns.len()));
        self.rows.iter().for_each(|row| line(&mut text, row));
        text
    }
}

/// The tables that take no rendering: a test compares them with the page.
pub fn quick_tables() -> Vec<Table> {
    vec![fresnel::table(), quick::patches_table(), quick::codes_table()]
}

/// All tables, in the order of the page: [`quick_tables`] first. Takes a few minutes in a release build.
///
/// # Errors
///
/// If a scene of `assets/scenes` cannot be loaded.
pub fn tables() -> Result<Vec<Table>, LoadError> {
    let mut tables = quick_tables();
    tables.extend([
        pictures::fresnel_table()?,
        pictures::depth_table()?,
        pictures::samples_table()?,
        pictures::rules_table()?,
        leaving::table()?,
        kernels::plane_table()?,
        kernels::rounding_table()?,
    ]);
    Ok(tables)
}

/// The page that holds the tables.
pub fn page_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/MODEL.md")
}

const BEGIN: &str = "<!-- figures:model -->\n";
const END: &str = "<!-- /figures:model -->";

/// `page` with `tables` between its two marks.
///
/// # Errors
///
/// If a mark is missing.
pub fn with_tables(page: &str, tables: &[Table]) -> Result<String, String> {
    let missing = || format!("the page must hold the lines {} and {END}", BEGIN.trim_end());
    let (before, rest) = page.split_once(BEGIN).ok_or_else(missing)?;
    let (_, after) = rest.split_once(END).ok_or_else(missing)?;
    let text: Vec<String> = tables.iter().map(Table::markdown).collect();
    Ok(format!("{before}{BEGIN}\n{}\n{END}{after}", text.join("\n")))
}

/// A figure with three digits, small ones with an exponent.
pub(crate) fn figure(x: f64) -> String {
    if x == 0.0 {
        "0".to_owned()
    } else if x.abs() < 1e-3 {
        format!("{x:.2e}")
    } else if x.abs() < 1.0 {
        format!("{x:.4}")
    } else {
        format!("{x:.2}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let rows = vec![vec!["1".to_owned(), "2".to_owned()]];
        Table { title: "T".to_owned(), how: "So.".to_owned(), columns: vec!["a", "b"], rows }
    }

    #[test]
    fn tables_go_between_the_marks_and_leave_the_rest() {
        let page = format!("before\n{BEGIN}old\n{END}\nafter\n");
        let new = with_tables(&page, &[table()]).unwrap();
        assert_eq!(new, format!("before\n{BEGIN}\n### T\n\nSo.\n\n| a | b |\n|---|---|\n| 1 | 2 |\n\n{END}\nafter\n"));
        assert_eq!(with_tables(&new, &[table()]).unwrap(), new);
        assert!(with_tables("no marks", &[]).is_err());
    }

    #[test]
    fn figures_are_short() {
        assert_eq!([0.0, 1.234e-5, 0.03567, 12.345].map(figure), ["0", "1.23e-5", "0.0357", "12.35"]);
    }
}
