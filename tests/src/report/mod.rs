//! The report behind `cargo xtask report`: speed against error, in one page.
//!
//! A section is measured into rows ([`section`]); rows and pictures are kept as files ([`store`]); the page is made from those files and
//! from nothing else ([`page`]), so that no number in it can differ from them. What was measured with the same sources and settings is not
//! measured again.

mod base64;
pub mod chart;
mod check;
pub mod findings;
mod gallery;
pub mod markers;
mod options;
pub mod page;
pub mod picture;
pub mod progress;
pub mod run;
pub mod section;
mod sections;
pub mod store;
pub mod table;

pub use check::{check, check_sections};
pub use options::Options;

use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use page::{Content, Filled};
use run::{Mode, Run};
use section::Section;
use std::path::{Path, PathBuf};
use store::{Origin, Store};

/// Does what `words` ask for.
///
/// # Errors
///
/// Usage errors, scenes that cannot be loaded, files that cannot be written, and a check that fails.
pub fn run(words: &[String]) -> Result<(), AppError> {
    let options = Options::parse(words)?;
    if std::env::var_os("GZ_HW_DATA").is_some() && !options.course && !options.check {
        return Err(AppError::Usage(
            "GZ_HW_DATA is set: ask with --course for a report on the course's data, which is not to be published, or unset it"
                .to_owned(),
        ));
    }
    let store = store_of(&options);
    if options.check {
        check(&store, &root())?;
        println!("{}: up to date in form", store.folder.display());
        return Ok(());
    }
    let run = Run::new(options.mode, options.seed, options.course);
    let page = make(&store, &run, &options, &sections::all(sections::has_peers()))?;
    // Only the report that is committed has its tables elsewhere too.
    if options.folder.is_none() && !options.course {
        markers::write(&store, &root())?;
    }
    println!("{}", page.display());
    Ok(())
}

/// All sections, without that on other ray tracers.
pub fn all_sections() -> Vec<Section> {
    sections::all(false)
}

/// The folder of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Where the report that is committed lies.
pub fn committed() -> Store {
    Store { folder: root().join("docs/report"), pictures: root().join("target/report") }
}

fn store_of(options: &Options) -> Store {
    match (&options.folder, options.course) {
        (Some(folder), _) => Store { folder: folder.clone(), pictures: folder.join("pictures") },
        (None, true) => Store { folder: root().join("out/report"), pictures: root().join("out/report/pictures") },
        (None, false) => committed(),
    }
}

/// Measures what is not measured yet, and makes the page; returns where it is.
///
/// # Errors
///
/// If a section cannot be measured or a file cannot be written.
pub fn make(store: &Store, run: &Run, options: &Options, sections: &[Section]) -> Result<PathBuf, AppError> {
    run.progress.say(&format!("{} report, seed {}, revision {}; {}", run.mode.name(), run.seed, run.revision, run.cpu));
    for section in sections {
        let asked = options.only.is_empty() || options.only.iter().any(|id| id == section.id);
        if !asked || (!options.fresh && store.kept(section, run).is_some()) {
            run.progress.say(&format!("{}: kept", section.id));
            continue;
        }
        run.progress.say(&format!("{}: {}", section.id, section.title));
        let measured = (section.measure)(run)?;
        store.keep(section, run, &measured)?;
    }
    let content = content(store, sections, run.mode)?;
    keep_lists(store, &content)?;
    let path = store.folder.join("index.html");
    let page = page::page(&content);
    NewFile::at(&path)?.write(page.as_bytes())?;
    run.progress.say(&format!("{}: {} kB", path.display(), page.len() / 1000));
    Ok(path)
}

/// What the page is made from, read from its files.
fn content(store: &Store, sections: &[Section], mode: Mode) -> Result<Content, AppError> {
    let mut filled = Vec::new();
    let mut origins = Vec::new();
    for section in sections {
        let (of, table) = store.table(section.id, section.columns)?;
        let pictures = store.pictures_of(section.id).ok_or_else(|| {
            AppError::Io(format!("pictures of {} are missing: measure it again with --fresh --only {0}", section.id))
        })?;
        origins.push(of);
        filled.push(Filled { section: *section, table, pictures });
    }
    let origin = Origin::of_all(&origins).ok_or_else(|| AppError::Usage("a report of no section".to_owned()))?;
    let findings = findings::all(&filled);
    Ok(Content { origin, mode: mode.name().to_owned(), sections: filled, findings })
}

/// Keeps what the page says beside the sections' rows: the numbers of the findings, and the list of pictures.
fn keep_lists(store: &Store, content: &Content) -> Result<(), AppError> {
    let numbers = content.findings.iter().flat_map(|it| it.numbers.iter().map(move |number| (it.id, number)));
    let lines = numbers.map(|(id, it)| format!("{id},\"{}\",{},\"{}\"\n", it.name, it.value, it.from));
    let text: String = std::iter::once("finding,name,value,from\n".to_owned()).chain(lines).collect();
    NewFile::at(&store.folder.join("findings.csv"))?.write(text.as_bytes())?;
    NewFile::at(&store.folder.join("pictures.csv"))?.write(check::picture_list(content).as_bytes())
}
