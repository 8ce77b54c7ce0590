//! Counts as text. Every zero carries its n.

use super::options::RayOptions;
use super::record::{KERNELS, Record};
use crate::hard::leaving::{Label, Outcome};
use crate::judge::Tally;
use gz_app::args::{kernel_name, leave_name};
use gz_core::LeavePolicy;
use std::fmt::Write;

/// `count` of `n`: a zero with the rate that it excludes with 95% confidence, 3/n, anything else with its rate.
pub fn bounded(count: u64, n: u64) -> String {
    match (count, n) {
        (0, 0) => "0 of 0".to_owned(),
        (0, _) => format!("0 (< {:.1e})", 3.0 / n as f64),
        _ => format!("{count} ({:.1e})", count as f64 / n as f64),
    }
}

/// The classes, a line each.
pub(super) fn classes(options: &RayOptions, records: &[Record]) -> String {
    let mut text = String::new();
    let mut line = |cells: [String; 8]| {
        let [name, rays, differing, midpoint, judged, wrong_hits, triangles, rest] = cells;
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{name:<11} {rays:>12} {differing:>18} {midpoint:>18} {judged:>10} {wrong_hits:>18} {triangles:>18} {rest:>18}"
        );
    };
    line(
        [
            "class",
            "rays",
            "tree != brute",
            "midpoint != brute",
            "judged",
            "wrong hit or miss",
            "wrong triangle",
            "wrong T, u or v",
        ]
        .map(str::to_owned),
    );
    let mut sum = Record::default();
    let mut row = |name: &str, record: &Record| {
        let Tally { rays, false_hits, false_misses, triangles, t, weights, .. } = record.product;
        line([
            name.to_owned(),
            record.rays.to_string(),
            bounded(record.differing, record.rays),
            bounded(record.midpoint_differing, record.midpoint),
            rays.to_string(),
            bounded(false_hits + false_misses, rays),
            bounded(triangles, rays),
            bounded(t + weights, rays),
        ]);
    };
    for (class, record) in options.classes.iter().zip(records) {
        row(class.name(), record);
        sum += *record;
    }
    row("all", &sum);
    text
}

/// What each comparison kernel gets wrong, a line a class.
pub(super) fn kernels(options: &RayOptions, records: &[Record]) -> String {
    let mut text = "wrong answers of the comparison kernels per million of the judged rays: hit or miss / triangle / greatest error of T in steps of f32\n".to_owned();
    let mut line = |name: &str, cells: [String; KERNELS.len()]| {
        let _ = write!(text, "{name:<11}");
        for cell in cells {
            let _ = write!(text, " {cell:>31}");
        }
        text.push('\n');
    };
    line("class", KERNELS.map(|kernel| kernel_name(kernel).to_owned()));
    let mut sum = Record::default();
    let cells = |record: &Record| {
        record.kernels.map(|Tally { rays, false_hits, false_misses, triangles, worst_t, .. }| {
            let share = |n: u64| format!("{:.0}", n as f64 * 1e6 / rays.max(1) as f64);
            format!("{} / {} / {worst_t}", share(false_hits + false_misses), share(triangles))
        })
    };
    for (class, record) in options.classes.iter().zip(records) {
        line(class.name(), cells(record));
        sum += *record;
    }
    line("all", cells(&sum));
    text
}

/// Leaving a surface, a line a label.
pub(super) fn leaving(outcomes: &[(Label, Outcome)]) -> String {
    let mut text = format!(
        "{:<5} {:<36} {:>9} {:>9} {:>9} {:>18} {:>18} {:>18} {:>18}",
        "leave", "", "cases", "blocked", "undecided", "acne", "light leaks", "tree != brute", "no start, or met"
    );
    for policy in &LeavePolicy::ALL[1..] {
        let _ = write!(text, " {:>19}", leave_name(*policy));
    }
    text.push('\n');
    for (label, outcome) in outcomes {
        let Outcome { cases, blocked, undecided, .. } = *outcome;
        let exact = outcome.exact();
        let _ = write!(
            text,
            "{:<5} {:<36} {cases:>9} {blocked:>9} {undecided:>9} {:>18} {:>18} {:>18} {:>18}",
            format!("{label:?}"),
            label.what(),
            bounded(exact.acne, cases),
            bounded(exact.leaks, cases),
            bounded(outcome.differing, cases),
            bounded(outcome.lost + outcome.source_met, cases)
        );
        for wrong in &outcome.wrong[1..] {
            let _ = write!(text, " {:>19}", format!("{} / {}", wrong.acne, wrong.leaks));
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_zero_carries_its_n() {
        assert_eq!(
            (bounded(0, 1000), bounded(2, 1000), bounded(0, 0)),
            ("0 (< 3.0e-3)".to_owned(), "2 (2.0e-3)".to_owned(), "0 of 0".to_owned())
        );
    }
}
