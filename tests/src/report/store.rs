//! Sections as files: rows as CSV and JSON, pictures beside them.

use super::picture::Picture;
use super::run::Run;
use super::section::{Measured, Section};
use super::table::{Cell, Column, Row, Table};
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// Columns that every row has beside its section's own.
pub const COMMON: [&str; 5] = ["n", "seed", "revision", "cpu", "settings"];

/// Where a report is kept.
#[derive(Clone, Debug)]
pub struct Store {
    /// The page and the figures.
    pub folder: PathBuf,
    /// Pictures by themselves, to be put into the page.
    pub pictures: PathBuf,
}

/// What a file says that its rows were measured with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The seed.
    pub seed: String,
    /// The revision of the sources.
    pub revision: String,
    /// The processor.
    pub cpu: String,
}

impl Origin {
    /// That of a run.
    pub fn of(run: &Run) -> Self {
        Self { seed: run.seed.to_string(), revision: run.revision.clone(), cpu: run.cpu.clone() }
    }

    /// All that several files say, each thing once: a run that was stopped and taken up again may have more than one revision.
    pub fn of_all(origins: &[Self]) -> Option<Self> {
        let each = |part: fn(&Self) -> &str| {
            let mut said: Vec<&str> = Vec::new();
            for origin in origins {
                if !said.contains(&part(origin)) {
                    said.push(part(origin));
                }
            }
            said.join(" and ")
        };
        (!origins.is_empty()).then(|| Self {
            seed: each(|it| &it.seed),
            revision: each(|it| &it.revision),
            cpu: each(|it| &it.cpu),
        })
    }
}

impl Store {
    /// The file of a section's figures.
    pub fn csv(&self, id: &str) -> PathBuf {
        self.folder.join(format!("{id}.csv"))
    }

    /// Writes what was measured.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn keep(&self, section: &Section, run: &Run, measured: &Measured) -> Result<(), AppError> {
        for folder in [&self.folder, &self.pictures] {
            std::fs::create_dir_all(folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
        }
        for picture in &measured.pictures {
            NewFile::at(&self.pictures.join(picture.file(section.id)))?.write(&picture.bytes)?;
        }
        let names: Vec<String> = measured.pictures.iter().map(|picture| picture.line()).collect();
        write(&self.pictures.join(format!("{}.list", section.id)), &names.join("\n"))?;
        let table = Table { columns: section.columns.to_vec(), rows: measured.rows.clone() };
        let origin = Origin::of(run);
        // The figures come last: a section counts as measured once they are there.
        write(&self.folder.join(format!("{}.json", section.id)), &json_of(section, &origin, &table))?;
        write(&self.csv(section.id), &csv_of(&origin, &table))
    }

    /// What was measured before: rows with the same seed, revision, processor and settings, and all of its pictures. `None` if anything is
    /// not there or not the same.
    pub fn kept(&self, section: &Section, run: &Run) -> Option<Measured> {
        let (origin, table) = self.table(section.id, section.columns).ok()?;
        let settings = |row: &Row| row.settings.split(';').next() == Some(run.mode.name());
        let wanted = (section.labels)(run).ok()?;
        if origin != Origin::of(run) || !table.rows.iter().all(settings) || table.labels() != wanted {
            return None;
        }
        Some(Measured { rows: table.rows, pictures: self.pictures_of(section.id)? })
    }

    /// The pictures of a section; `None` if one is missing.
    pub fn pictures_of(&self, id: &str) -> Option<Vec<Picture>> {
        let list = std::fs::read_to_string(self.pictures.join(format!("{id}.list"))).ok()?;
        list.lines().map(|line| Picture::read(&self.pictures, id, line)).collect()
    }

    /// The rows of a file of these columns, and where they come from.
    ///
    /// # Errors
    ///
    /// If the file is not there, or has other columns, or cells that are none.
    pub fn table(&self, id: &str, columns: &[Column]) -> Result<(Origin, Table), AppError> {
        let path = self.csv(id);
        let text = std::fs::read_to_string(&path).map_err(|error| AppError::Io(format!("{}: {error}", path.display())))?;
        parse_csv(&text, columns).map_err(|why| AppError::Differs(format!("{}: {why}", path.display())))
    }
}

fn write(path: &Path, text: &str) -> Result<(), AppError> {
    NewFile::at(path)?.write(text.as_bytes())
}

fn csv_of(origin: &Origin, table: &Table) -> String {
    let line = |cells: Vec<String>| cells.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",") + "\n";
    let head = table.columns.iter().map(|column| column.name.to_owned()).chain(COMMON.map(str::to_owned));
    let mut text = line(head.collect());
    for row in &table.rows {
        let own = row.cells.iter().map(Cell::text);
        let Origin { seed, revision, cpu } = origin.clone();
        text += &line(own.chain([row.n.to_string(), seed, revision, cpu, row.settings.clone()]).collect());
    }
    text
}

fn json_of(section: &Section, origin: &Origin, table: &Table) -> String {
    let of_row = |row: &Row| {
        let value = |cell: &Cell| match cell {
            Cell::Text(text) => json!(text),
            Cell::Number(number) => json!(number),
            Cell::Missing => Value::Null,
        };
        let mut object: Map<String, Value> =
            table.columns.iter().zip(&row.cells).map(|(column, cell)| (column.name.to_owned(), value(cell))).collect();
        object.insert("n".to_owned(), json!(row.n));
        object.insert("settings".to_owned(), json!(row.settings));
        Value::Object(object)
    };
    let columns = table.columns.iter().map(|column| json!({ "name": column.name, "title": column.title, "unit": column.unit }));
    let value = json!({
        "section": section.id,
        "title": section.title,
        "how": section.how,
        "seed": origin.seed,
        "revision": origin.revision,
        "cpu": origin.cpu,
        "columns": columns.collect::<Vec<_>>(),
        "rows": table.rows.iter().map(of_row).collect::<Vec<_>>(),
    });
    format!("{value:#}\n")
}

fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

/// The cells of CSV text, line by line.
pub fn csv_lines(text: &str) -> Vec<Vec<String>> {
    let (mut lines, mut line, mut cell, mut inside) = (Vec::new(), Vec::new(), String::new(), false);
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        match c {
            '"' if inside && characters.peek() == Some(&'"') => {
                cell.push('"');
                characters.next();
            }
            '"' => inside = !inside,
            ',' if !inside => line.push(std::mem::take(&mut cell)),
            '\n' if !inside => {
                line.push(std::mem::take(&mut cell));
                lines.push(std::mem::take(&mut line));
            }
            '\r' if !inside => {}
            c => cell.push(c),
        }
    }
    lines
}

fn parse_csv(text: &str, columns: &[Column]) -> Result<(Origin, Table), String> {
    let lines = csv_lines(text);
    let (head, lines) = lines.split_first().ok_or("the file is empty")?;
    let expected: Vec<&str> = columns.iter().map(|column| column.name).chain(COMMON).collect();
    if *head != expected {
        return Err(format!("the columns are {}, not {}", head.join(", "), expected.join(", ")));
    }
    let mut origin: Option<Origin> = None;
    let mut rows = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let bad = |what: &str| format!("line {}: {what}", number + 2);
        if line.len() != expected.len() {
            return Err(bad("wrong number of cells"));
        }
        let (own, common) = line.split_at(columns.len());
        let cell = |(text, column): (&String, &Column)| {
            Cell::parse(text, column.kind).ok_or_else(|| bad(&format!("{text} is no number")))
        };
        let cells = own.iter().zip(columns).map(cell).collect::<Result<Vec<_>, _>>()?;
        let n = common[0].parse().map_err(|_| bad("n is no number"))?;
        let here = Origin { seed: common[1].clone(), revision: common[2].clone(), cpu: common[3].clone() };
        if origin.get_or_insert_with(|| here.clone()) != &here {
            return Err(bad("another seed, revision or processor than the lines before"));
        }
        rows.push(Row { cells, n, settings: common[4].clone() });
    }
    let origin = origin.ok_or("there is no row")?;
    Ok((origin, Table { columns: columns.to_vec(), rows }))
}

/// The cells of a table that a run with the same seed gives again to the bit.
pub fn repeatable(table: &Table) -> Vec<Vec<String>> {
    let kept = |row: &Row| {
        let cells = table.columns.iter().zip(&row.cells).filter(|(column, _)| column.kind.is_repeatable());
        cells.map(|(_, cell)| cell.text()).chain([row.n.to_string()]).collect()
    };
    table.rows.iter().map(kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table::Kind;

    const COLUMNS: [Column; 3] = [
        Column::new("what", "What", "", Kind::Label),
        Column::new("n_wrong", "wrong", "", Kind::Count),
        Column::new("ns", "time", "ns", Kind::Time),
    ];

    #[test]
    fn a_file_gives_back_what_was_written() {
        let row = |what: &str, wrong: Cell, ns: f64| Row {
            cells: vec![what.into(), wrong, ns.into()],
            n: 7,
            settings: "quick; \"a\", b".to_owned(),
        };
        let rows = vec![row("a, \"b\"\nc", Cell::Missing, 0.1 + 0.2), row("d", 3u64.into(), f64::MIN_POSITIVE)];
        let table = Table { columns: COLUMNS.to_vec(), rows };
        let origin = Origin { seed: "1".to_owned(), revision: "abc".to_owned(), cpu: "some, cpu".to_owned() };
        let text = csv_of(&origin, &table);
        assert_eq!(parse_csv(&text, &COLUMNS).unwrap(), (origin, table));
        assert!(parse_csv(&text, &COLUMNS[..2]).unwrap_err().contains("columns"));
        assert!(parse_csv("", &COLUMNS).is_err());
    }
}
