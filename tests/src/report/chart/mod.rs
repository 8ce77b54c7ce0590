//! Charts over the rows of a section, as SVG inside the page: wide, and narrow for phones.

mod bars;
mod labels;
mod plot;
pub mod ticks;
mod tone;

pub use bars::{Bar, Bars};
pub use plot::{Mark, Plot, Side, Size};
pub use tone::tone;

use super::section::{ChartSpec, Drawn};
use super::table::{Cell, Kind, Table};

const WIDE: Size = Size { width: 860.0, height: 460.0 };
const NARROW: Size = Size { width: 350.0, height: 400.0 };

/// A chart as HTML: the drawing in both sizes with its legend; nothing when no row has what it shows.
pub fn chart(spec: &ChartSpec, table: &Table) -> String {
    let (drawings, legend) = match spec.drawn {
        Drawn::Points { .. } => points(spec, table),
        Drawn::Bars { parts, title } => bars(spec, table, parts, title),
    };
    if drawings.is_empty() {
        return String::new();
    }
    let entries: String =
        legend.iter().map(|(name, tone)| format!("<li><span style=\"background:{tone}\"></span>{}</li>", escape(name))).collect();
    let legend = if legend.len() > 1 { format!("<ul class=\"legend\">{entries}</ul>\n") } else { String::new() };
    format!("{legend}{drawings}")
}

type Legend = Vec<(String, &'static str)>;

/// The rows that a chart shows.
fn rows<'t>(spec: &'t ChartSpec, table: &'t Table) -> impl Iterator<Item = usize> + 't {
    let (column, word) = spec.only;
    (0..table.rows.len()).filter(move |&row| column.is_empty() || table.words(row, column) == word)
}

fn points(spec: &ChartSpec, table: &Table) -> (String, Legend) {
    let Drawn::Points { x, y, series, label, joined, zeros } = spec.drawn else { return Default::default() };
    let mut names: Vec<String> = Vec::new();
    let mut marks = Vec::new();
    for row in rows(spec, table) {
        let (Some(px), Some(py)) = (table.number(row, x.column), table.number(row, y.column)) else { continue };
        // Without series and labels there is one thing alone to be seen, and it is ours.
        let name = match (series, label) {
            ("", "") => "ours".to_owned(),
            ("", _) => table.label(row),
            _ => word(table, row, series),
        };
        let number = names.iter().position(|known| *known == name).unwrap_or_else(|| {
            names.push(name.clone());
            names.len() - 1
        });
        let label = if label.is_empty() { String::new() } else { word(table, row, label) };
        marks.push(Mark { x: px, y: py, series: number, label, hover: hover(table, row) });
    }
    let tones: Vec<&'static str> = names.iter().enumerate().map(|(k, name)| tone(name, k)).collect();
    let side = |axis: super::section::Axis| Side { title: axis.title.to_owned(), scale: axis.scale };
    let plot = Plot { x: side(x), y: side(y), marks, tones: tones.clone(), joined, zeros: zeros.to_owned() };
    let legend = if series.is_empty() { Vec::new() } else { names.into_iter().zip(tones).collect() };
    (plot.svg("wide", WIDE) + &plot.svg("narrow", NARROW), legend)
}

fn bars(spec: &ChartSpec, table: &Table, parts: &[&str], title: &str) -> (String, Legend) {
    let known: Vec<(&str, String)> =
        parts.iter().filter_map(|part| table.column(part).map(|k| (*part, table.columns[k].title.to_owned()))).collect();
    let bars = rows(spec, table).map(|row| Bar {
        name: table.label(row),
        values: known.iter().map(|(part, _)| table.number(row, part).unwrap_or(0.0)).collect(),
        hover: hover(table, row),
    });
    let tones: Vec<&'static str> = known.iter().enumerate().map(|(k, (_, name))| tone(name, k)).collect();
    let bars = Bars { title: title.to_owned(), bars: bars.collect(), tones: tones.clone() };
    (bars.svg("wide", WIDE) + &bars.svg("narrow", NARROW), known.into_iter().map(|(_, name)| name).zip(tones).collect())
}

/// The words of a cell; a number as it is shown.
fn word(table: &Table, row: usize, name: &str) -> String {
    let cell = table.column(name).map(|k| table.rows[row].cells[k].shown(table.columns[k].kind));
    cell.unwrap_or_default()
}

/// All of a row, a line a cell.
pub fn hover(table: &Table, row: usize) -> String {
    let cells = table.columns.iter().zip(&table.rows[row].cells).filter(|(_, cell)| **cell != Cell::Missing);
    let lines = cells.map(|(column, cell)| match column.kind {
        Kind::Label => cell.shown(column.kind),
        _ => format!("{}: {}", column.head(), cell.shown(column.kind)),
    });
    let n = format!("n: {}", super::table::grouped(table.rows[row].n as f64));
    lines.chain([n]).collect::<Vec<_>>().join("\n")
}

/// Text as it stands in HTML and SVG.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
