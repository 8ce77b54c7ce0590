//! The course's reference pictures and the paper's figures, where their files are at hand.

use gz_tests::homework;

#[test]
fn every_row_of_the_homework_table_holds() {
    let Some(data) = homework::data_folder() else {
        println!("skipped: set GZ_HW_DATA to the folder of course data");
        return;
    };
    let rows = homework::table(&data).unwrap_or_else(|error| panic!("{error}"));
    assert!(rows.len() >= 10, "{} rows", rows.len());
    let failed: Vec<String> = rows
        .iter()
        .inspect(|row| println!("{}: {}", row.name, row.measured))
        .filter(|row| !row.holds)
        .map(|row| format!("{}: {} (required: {})", row.name, row.measured, row.required))
        .collect();
    assert!(failed.is_empty(), "{} of {} rows fail\n{}", failed.len(), rows.len(), failed.join("\n"));
}
