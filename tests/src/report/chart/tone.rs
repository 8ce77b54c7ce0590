//! Colours of series: the same name has the same colour in every chart.

/// Ours.
const OURS: &str = "#0b7a75";
/// The paper's.
const PAPER: &str = "#d1495b";
/// Everybody else, in turn; dark enough on white, and told apart also without red and green.
const OTHERS: [&str; 12] = [
    "#30638e", "#b8860b", "#6a4c93", "#5f6b7a", "#c06014", "#2f7d32", "#9c4f8f", "#1f8fb3", "#7a5c3e", "#14213d", "#8aa336",
    "#e08e79",
];

/// The colour of the series `name`, the `k`-th of its chart.
pub fn tone(name: &str, k: usize) -> &'static str {
    let begins = |words: &[&str]| words.iter().any(|word| name.starts_with(word));
    if begins(&["ours", "self-tuned", "certified", "exact"]) {
        OURS
    } else if ["plane", "identity"].contains(&name) || begins(&["paper", "midpoint"]) {
        PAPER
    } else {
        OTHERS[fixed(name).unwrap_or(k) % OTHERS.len()]
    }
}

/// Names that appear in several charts.
fn fixed(name: &str) -> Option<usize> {
    const NAMES: [&str; 9] = [
        "moeller-trumbore",
        "baldwin-weber",
        "pluecker",
        "woop",
        "woop-fused",
        "moeller-trumbore-f64",
        "bare",
        "epsilon",
        "waechter-binder",
    ];
    NAMES.iter().position(|known| *known == name)
}
