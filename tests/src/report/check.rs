//! Whether the report that is committed has the form that it would have if it were made now.

use super::page::{Content, Filled, page, without_pictures};
use super::picture::Picture;
use super::run::{Mode, Run};
use super::section::Section;
use super::store::{Origin, Store, csv_lines};
use super::{findings, markers, sections};
use gz_app::error::AppError;
use std::path::Path;

/// The pictures of a page, a line each: section, name, format, width, height, caption.
pub(super) fn picture_list(content: &Content) -> String {
    let line = |filled: &Filled, it: &Picture| {
        let caption = it.caption.replace('"', "\"\"");
        format!("{},{},{},{},{},\"{caption}\"\n", filled.section.id, it.name, it.format(), it.width, it.height)
    };
    let lines = content.sections.iter().flat_map(|filled| filled.pictures.iter().map(move |it| line(filled, it)));
    std::iter::once("section,name,format,width,height,caption\n".to_owned()).chain(lines).collect()
}

/// Compares the committed report with what would be made: columns and labels of every file, the text of the page, and the tables that
/// stand in other documents. Numbers are compared with the committed files, never measured.
///
/// # Errors
///
/// [`AppError::Differs`] for the first thing that is stale.
pub fn check(store: &Store, root: &Path) -> Result<(), AppError> {
    check_sections(store, &sections::all(store.csv("peers").is_file()))?;
    markers::check(store, root)
}

/// The same for some sections and the page alone.
///
/// # Errors
///
/// [`AppError::Differs`] for the first thing that is stale.
pub fn check_sections(store: &Store, sections: &[Section]) -> Result<(), AppError> {
    let stale = |what: String| AppError::Differs(format!("{what}: the report is stale, run cargo xtask report"));
    let list_path = store.folder.join("pictures.csv");
    let list = read(&list_path)?;
    let mut filled = Vec::new();
    let mut origins = Vec::new();
    let mut mode = None;
    for section in sections {
        let (origin, table) = store.table(section.id, section.columns)?;
        let name = table.rows.first().and_then(|row| row.settings.split(';').next()).unwrap_or_default().to_owned();
        let of_rows = [Mode::Tiny, Mode::Quick, Mode::Full].into_iter().find(|mode| mode.name() == name);
        let of_rows =
            of_rows.ok_or_else(|| stale(format!("{}: settings without a known mode", store.csv(section.id).display())))?;
        let wanted = (section.labels)(&Run::new(of_rows, 1, false))?;
        // What a machine can do, such as its SIMD levels, is no matter of age.
        let same_kind = |label: &String| !label.contains("Avx");
        let (found, wanted): (Vec<_>, Vec<_>) = (
            table.labels().into_iter().filter(same_kind).collect::<Vec<_>>(),
            wanted.into_iter().filter(same_kind).collect::<Vec<_>>(),
        );
        if found != wanted {
            return Err(stale(format!("{}: other rows", store.csv(section.id).display())));
        }
        mode.get_or_insert(of_rows);
        origins.push(origin);
        filled.push(Filled { section: *section, table, pictures: pictures(&list, section.id) });
    }
    let (Some(origin), Some(mode)) = (Origin::of_all(&origins), mode) else { return Ok(()) };
    let findings = findings::all(&filled);
    let content = Content { origin, mode: mode.name().to_owned(), sections: filled, findings };
    if picture_list(&content) != list {
        return Err(stale(format!("{}: other pictures", list_path.display())));
    }
    let path = store.folder.join("index.html");
    if without_pictures(&read(&path)?) != without_pictures(&page(&content)) {
        return Err(stale(format!("{}: other text than its files lead to", path.display())));
    }
    Ok(())
}

/// The pictures of a section as the list has them, without content.
fn pictures(list: &str, id: &str) -> Vec<Picture> {
    let of_line = |line: &Vec<String>| {
        let [section, name, format, width, height, caption] = line.as_slice() else { return None };
        let bytes = if format == "png" { b"\x89PNG".to_vec() } else { b"\xff".to_vec() };
        let (width, height) = (width.parse().ok()?, height.parse().ok()?);
        (section == id).then(|| Picture { name: name.clone(), caption: caption.clone(), width, height, bytes })
    };
    csv_lines(list).iter().filter_map(of_line).collect()
}

fn read(path: &Path) -> Result<String, AppError> {
    std::fs::read_to_string(path).map_err(|error| AppError::Io(format!("{}: {error}", path.display())))
}
