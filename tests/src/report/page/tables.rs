//! Tables of the page, and how to read them back.

use crate::report::chart::escape;
use crate::report::section::Section;
use crate::report::table::{Cell, Kind, Row, Table, grouped};
use std::fmt::Write;

/// The rows of a section. Each cell carries what its file has.
pub(super) fn table(section: &Section, table: &Table) -> String {
    let is_words = |kind: Kind| matches!(kind, Kind::Label | Kind::Note);
    let mut html = format!(
        "<details><summary>The same as a table, {} rows <a href=\"{id}.csv\">csv</a> <a href=\"{id}.json\">json</a></summary>\n<div \
         class=\"scroll\"><table data-file=\"{id}.csv\">\n<thead><tr>",
        table.rows.len(),
        id = section.id
    );
    for column in &table.columns {
        // Writing to a string cannot fail.
        let class = if is_words(column.kind) { " class=\"w\"" } else { "" };
        let unit = if column.unit.is_empty() { String::new() } else { format!("<small>{}</small>", escape(column.unit)) };
        let _ = write!(html, "<th{class}>{}{unit}</th>", escape(column.title));
    }
    html += "<th>n</th><th class=\"w\">settings</th></tr></thead>\n<tbody>\n";
    for row in &table.rows {
        html += "<tr>";
        for (column, cell) in table.columns.iter().zip(&row.cells) {
            let shown = escape(&cell.shown(column.kind));
            let _ = match cell {
                Cell::Text(_) => write!(html, "<td class=\"w\">{shown}</td>"),
                _ => write!(html, "<td data-v=\"{}\">{shown}</td>", cell.text()),
            };
        }
        let Row { n, settings, .. } = row;
        let _ = writeln!(html, "<td data-v=\"{n}\">{}</td><td class=\"w\">{}</td></tr>", grouped(*n as f64), escape(settings));
    }
    html + "</tbody></table></div></details>\n"
}

/// A table as it is found in a page: the file it names, and its cells, each with what stands there and what it carries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PageTable {
    /// The file of its figures.
    pub file: String,
    /// Shown text and carried value of each cell; the value of words is the words.
    pub rows: Vec<Vec<(String, String)>>,
}

/// All tables of a page.
pub fn tables_of(page: &str) -> Vec<PageTable> {
    let plain = |text: &str| text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&");
    let between = |text: &str, from: &str, to: &str| {
        let (_, rest) = text.split_once(from)?;
        rest.split_once(to).map(|(inside, _)| inside.to_owned())
    };
    let cell = |text: &str| {
        let (head, shown) = text.split_once('>')?;
        let shown = plain(shown.split("</td>").next()?);
        let value = between(head, "data-v=\"", "\"").unwrap_or_else(|| shown.clone());
        Some((shown, value))
    };
    let table = |text: &str| {
        let file = text.split('"').next()?.to_owned();
        let body = between(text, "<tbody>", "</tbody>")?;
        let rows = body.split("<tr>").skip(1).map(|row| row.split("<td").skip(1).filter_map(cell).collect()).collect();
        Some(PageTable { file, rows })
    };
    page.split("<table data-file=\"").skip(1).filter_map(table).collect()
}
