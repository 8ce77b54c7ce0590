//! The report: its page holds the numbers of its files, follows from the seed, asks for nothing from elsewhere, and is not stale.

use gz_tests::folder::Folder;
use gz_tests::report::page::tables_of;
use gz_tests::report::run::{Mode, Run};
use gz_tests::report::section::Section;
use gz_tests::report::store::{COMMON, Store, csv_lines, repeatable};
use gz_tests::report::table::{Cell, Kind, grouped};
use gz_tests::report::{Options, all_sections, check, check_sections, committed, make, root};
use std::path::Path;

/// Makes a report of a few rays of everything.
fn tiny(folder: &Path, seed: u64, sections: &[Section]) -> Store {
    let store = Store { folder: folder.join("report"), pictures: folder.join("pictures") };
    let options = Options { mode: Mode::Tiny, ..Options::parse(&[]).expect("no words") };
    make(&store, &Run::new(Mode::Tiny, seed, false), &options, sections).expect("a tiny report");
    store
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn a_tiny_report_holds_its_numbers_repeats_them_and_grows_stale() {
    let folder = Folder::new("report");
    let sections = all_sections();
    let store = tiny(folder.path(), 1, &sections);
    let page = read(&store.folder.join("index.html"));

    // Every number in a table is that of its file, and what is shown is that number, rounded.
    let tables = tables_of(&page);
    assert_eq!(tables.len(), sections.len());
    let mut compared = 0;
    for (table, section) in tables.iter().zip(&sections) {
        assert_eq!(table.file, format!("{}.csv", section.id));
        let lines = csv_lines(&read(&store.csv(section.id)));
        assert_eq!(lines.len(), table.rows.len() + 1, "{}", table.file);
        assert_eq!(lines[0].len(), section.columns.len() + COMMON.len());
        for (line, row) in lines[1..].iter().zip(&table.rows) {
            assert_eq!(row.len(), section.columns.len() + 2);
            for (k, (shown, value)) in row.iter().enumerate() {
                let Some(column) = section.columns.get(k) else { break };
                assert_eq!(*value, line[k], "{}: {}", table.file, column.name);
                assert_eq!(Cell::parse(value, column.kind).expect("a cell").shown(column.kind), *shown, "{}", table.file);
                compared += 1;
            }
            let [n, settings] = [&row[section.columns.len()], &row[section.columns.len() + 1]];
            assert_eq!((&n.1, &settings.1), (&line[section.columns.len()], &line[section.columns.len() + 4]));
            assert_eq!(n.0, grouped(n.1.parse().expect("n")));
        }
    }
    assert!(compared > 1000, "{compared}");

    // The numbers of the findings stand in their file.
    let kept = csv_lines(&read(&store.folder.join("findings.csv")));
    let cards = page.split_once("<nav>").expect("a page").0;
    let values: Vec<&str> = cards.split("<data value=\"").skip(1).filter_map(|part| part.split('"').next()).collect();
    assert!(values.len() >= 9, "{values:?}");
    assert!(values.iter().all(|value| kept.iter().any(|line| line.get(2).is_some_and(|it| it == value))), "{values:?}");

    // Nothing is fetched from elsewhere.
    for word in ["src=\"http", "href=\"http", "src=\"//", "href=\"//", "@import", "url(", "<link"] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(page.matches("<img").count() >= 12 && page.matches("<svg").count() >= 20, "pictures and charts are there");

    // What is kept is not measured again, and the page made of it is the same.
    let again = tiny(folder.path(), 1, &sections);
    assert_eq!(read(&again.folder.join("index.html")), page);

    // Its form is checked.
    check_sections(&store, &sections).expect("a report just made is not stale");
    let csv = store.csv("kernels");
    let text = read(&csv);
    for (from, to) in [("pluecker", "pluck"), ("ns_per_ray", "ns"), ("quick;", "tiny;")] {
        if text.contains(from) {
            std::fs::write(&csv, text.replace(from, to)).expect("written");
            assert_eq!(check_sections(&store, &sections).expect_err(from).exit_code(), 4, "{from}");
        }
    }
    std::fs::write(&csv, &text).expect("written");
    std::fs::write(store.folder.join("index.html"), page.replace("Three findings", "Findings")).expect("written");
    assert!(check_sections(&store, &sections).is_err());
}

#[test]
fn error_figures_follow_from_the_seed_to_the_bit() {
    let folder = Folder::new("report-seed");
    let sections: Vec<Section> =
        all_sections().into_iter().filter(|it| ["kernels", "leaving", "t-aspect", "tree"].contains(&it.id)).collect();
    let rows = |name: &str, seed: u64| {
        let store = tiny(&folder.path().join(name), seed, &sections);
        let of = |section: &Section| repeatable(&store.table(section.id, section.columns).expect("a table").1);
        sections.iter().map(of).collect::<Vec<_>>()
    };
    let one = rows("one", 1);
    assert_eq!(one, rows("two", 1));
    assert_ne!(one, rows("three", 2));
    assert!(sections.iter().all(|it| it.columns.iter().any(|column| matches!(column.kind, Kind::Count | Kind::Figure))));
}

#[test]
fn the_report_that_is_committed_is_not_stale() {
    check(&committed(), &root()).expect("cargo xtask report makes it anew");
}

#[test]
fn nothing_of_it_comes_from_course_data() {
    let folder = committed().folder;
    for entry in std::fs::read_dir(&folder).expect("docs/report") {
        let path = entry.expect("a readable folder").path();
        let text = read(&path);
        assert!(!text.contains("hw:") && !text.contains("GZ_HW_DATA"), "{}", path.display());
        assert!(path.metadata().expect("a file").len() < 3_500_000, "{}", path.display());
    }
}
