//! docs/MODEL.md holds what is measured. The tables that take minutes are compared by `cargo xtask measure model --check`.

use gz_tests::model;

fn page() -> String {
    let path = model::page_path();
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn the_page_holds_the_tables_that_take_no_rendering() {
    let page = page();
    for table in model::quick_tables() {
        assert!(table.rows.iter().all(|row| row.len() == table.columns.len()), "{}", table.title);
        assert!(page.contains(&table.markdown()), "{} is stale: cargo xtask measure model --write", table.title);
    }
}

#[test]
fn every_table_of_the_page_has_its_heading_once() {
    let page = page();
    let titles = ["on pictures", "Depth limit", "Samples a pixel", "Other rules", "Leaving", "The paper's test", "Stored f32"];
    for title in titles {
        let found = page.lines().filter(|line| line.starts_with("### ") && line.contains(title)).count();
        assert_eq!(found, 1, "{title}: cargo xtask measure model --write");
    }
}
