//! What follows from the rows, in words made from them.

use super::chart::escape;
use super::page::Filled;
use super::table::{Table, grouped, short};

/// A finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Its name in files.
    pub id: &'static str,
    /// The question that it answers.
    pub question: &'static str,
    /// The figure that says most, as HTML.
    pub big: String,
    /// The answer, as HTML.
    pub headline: String,
    /// What it rests on, as HTML.
    pub text: String,
    /// All numbers in it.
    pub numbers: Vec<Number>,
}

/// A number of a finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// What it is.
    pub name: String,
    /// The number.
    pub value: f64,
    /// The cells that it is made from.
    pub from: String,
}

/// Collects the numbers of a finding as they are said.
#[derive(Default)]
pub(super) struct Numbers(Vec<Number>);

impl Numbers {
    /// A number as it stands in the text, with `unit` behind it.
    pub(super) fn say(&mut self, name: &str, value: f64, from: &str, unit: &str) -> String {
        self.0.push(Number { name: name.to_owned(), value, from: from.to_owned() });
        format!("<data value=\"{value}\">{}{}</data>", short(value), escape(unit))
    }

    /// A whole number.
    pub(super) fn count(&mut self, name: &str, value: f64, from: &str) -> String {
        self.0.push(Number { name: name.to_owned(), value, from: from.to_owned() });
        format!("<data value=\"{value}\">{}</data>", grouped(value))
    }

    /// The numbers said.
    pub(super) fn taken(self) -> Vec<Number> {
        self.0
    }
}

/// The rows of a section.
pub(super) fn table_of<'f>(sections: &'f [Filled], id: &str) -> Option<&'f Table> {
    sections.iter().find(|it| it.section.id == id).map(|it| &it.table)
}

/// The findings that these sections lead to: as many of them as have their rows.
pub(super) fn all(sections: &[Filled]) -> Vec<Finding> {
    let accuracy = match (table_of(sections, "kernels"), table_of(sections, "leaving")) {
        (Some(kernels), Some(leaving)) => accuracy(kernels, leaving),
        _ => None,
    };
    let setting = table_of(sections, "tree").and_then(setting);
    let paper = match (table_of(sections, "kernels"), table_of(sections, "leaving"), table_of(sections, "tree")) {
        (Some(kernels), Some(leaving), Some(tree)) => paper(kernels, leaving, tree),
        _ => None,
    };
    [accuracy, setting, paper].into_iter().flatten().collect()
}

/// `ratio` times as long as `what`, or a share of its time.
fn times_as_long(numbers: &mut Numbers, name: &str, ratio: f64, from: &str, what: &str) -> String {
    if ratio >= 1.0 {
        format!("{} times as long as {what}", numbers.say(name, ratio, from, ""))
    } else {
        format!("{} of the time of {what}", numbers.say(name, 100.0 * ratio, from, " %"))
    }
}

/// What accuracy costs.
fn accuracy(table: &Table, leaving: &Table) -> Option<Finding> {
    let mut numbers = Numbers::default();
    let of = |row: usize, name: &str| table.number(row, name);
    let (plane, scalar) = (table.row("test", "plane")?, table.row("test", "ours, Portable")?);
    let best = table.row("test", "ours, by the tree")?.checked_sub(1)?;
    // The most accurate and the fastest of those that round.
    let rounding: Vec<usize> = (0..table.rows.len()).filter(|&row| !table.words(row, "test").starts_with("ours")).collect();
    let by = |name: &str| {
        rounding
            .iter()
            .copied()
            .filter(|&row| of(row, name).is_some())
            .min_by(|&a, &b| of(a, name).partial_cmp(&of(b, name)).unwrap_or(std::cmp::Ordering::Equal))
    };
    let (finest, fastest) = (by("wrong_per_1e9")?, by("ns_per_ray")?);
    let ours_wrong: f64 = (0..table.rows.len()).filter(|row| !rounding.contains(row)).filter_map(|row| of(row, "wrong")).sum();
    let n = table.rows[best].n as f64;
    let ratio = of(best, "ns_per_ray")? / of(fastest, "ns_per_ray")?;
    let portable = of(scalar, "ns_per_ray")? / of(plane, "ns_per_ray")?;
    let one_by_one = of(table.row("test", "ours, one at a time")?, "ns_per_ray")? / of(plane, "ns_per_ray")?;
    let big = match ratio >= 1.0 {
        true => format!("{} times as long", numbers.say("ours over fastest", ratio, "kernels: ns_per_ray", "")),
        false => format!("{} of the time", numbers.say("ours over fastest", 100.0 * ratio, "kernels: ns_per_ray", " %")),
    };
    let headline = match (ours_wrong == 0.0, ratio < 1.0) {
        (true, true) => "Being right every time need not cost time: behind a filter the exact test is the fastest here",
        (true, false) => "Being right every time has a price, and this is it",
        (false, _) => "The exact test was wrong somewhere: that is a bug",
    };
    let wrong_of = |row: usize| of(row, "wrong_per_1e9").unwrap_or(f64::NAN) / 1e9;
    let best_of_them = match finest == fastest {
        true => "which is the best of those that round".to_owned(),
        false => format!(
            "and the best of those that round ({}) still on {}",
            escape(table.words(finest, "test")),
            numbers.say("finest wrong", 100.0 * wrong_of(finest), "kernels: wrong_per_1e9", " %")
        ),
    };
    let start = |policy: &str| leaving.number(leaving.row("policy", policy)?, "ns_per_ray");
    let start_ratio = start("exact")? / start("bare")?;
    let start_costs = times_as_long(
        &mut numbers,
        "exact start over bare",
        start_ratio,
        "leaving: ns_per_ray",
        "one from the rounded hit point, start and trace",
    );
    let where_it_costs =
        if start_ratio > 1.1 { "What does cost is to leave a surface" } else { "Nor does it cost to leave a surface" };
    let text = format!(
        "Triangle by triangle the proof in f64 takes {}. Behind a filter in f32, which only has to reject and so may be coarse and eight lanes \
         wide, the proof sees the few triangles that are left: brute force then takes {}, and {} even without vector instructions of this \
         processor. In {} hard rays it was wrong {} times; that fastest plain test is wrong on {} of them, {best_of_them}. {where_it_costs}: a \
         shadow ray from a proved side takes {start_costs}.",
        times_as_long(&mut numbers, "one by one over plane", one_by_one, "kernels: ns_per_ray", "the paper's test in f32"),
        times_as_long(
            &mut numbers,
            "ours over fastest",
            ratio,
            "kernels: ns_per_ray",
            &format!("the fastest plain test that rounds ({})", escape(table.words(fastest, "test")))
        ),
        times_as_long(&mut numbers, "portable over plane", portable, "kernels: ns_per_ray", "the paper's"),
        numbers.count("hard rays", n, "kernels: n"),
        numbers.count("ours wrong", ours_wrong, "kernels: wrong"),
        numbers.say("fastest wrong", 100.0 * wrong_of(fastest), "kernels: wrong_per_1e9", " %"),
    );
    Some(Finding {
        id: "accuracy",
        question: "What does accuracy cost?",
        big,
        headline: headline.to_owned(),
        text,
        numbers: numbers.taken(),
    })
}

/// Which setting to choose.
fn setting(table: &Table) -> Option<Finding> {
    let mut numbers = Numbers::default();
    let of = |row: usize, name: &str| table.number(row, name);
    let (best, tuned) = (super::sections::fastest(table)?, table.row("tree", "self-tuned")?);
    let (paper, plain) = (table.row("tree", "(15, 5)")?, table.row("tree", "plain brute force")?);
    let ratio = of(best, "trace_ms")? / of(tuned, "trace_ms")?;
    let fewer = of(tuned, "tests_per_ray")? / of(best, "tests_per_ray")?;
    let memory = of(best, "kb")? / of(tuned, "kb")?;
    let plus = of(plain, "trace_ms")? / of(tuned, "trace_ms")?;
    let big = match ratio >= 1.0 {
        true => format!("{} times faster", numbers.say("tuned over best", ratio, "tree: trace_ms", "")),
        false => format!("{} the speed", numbers.say("tuned over best", 100.0 * ratio, "tree: trace_ms", " %")),
    };
    let headline = match ratio > 1.0 {
        true => "Choose no setting: the tree that tunes itself beats the whole grid",
        false => "Set MAX_DEPTH and MIN_SIZE by hand: the best of the grid beats the tree that tunes itself",
    };
    let walk = match (fewer > 1.0, ratio > 1.0) {
        (true, true) => format!(
            "It looks at {} times as many triangles a ray, so fewer tests do not explain that: its walk does, which takes 64 rays along and \
             filters eight triangles at a time.",
            numbers.say("triangles", fewer, "tree: tests_per_ray", "")
        ),
        (true, false) => {
            format!("It looks at {} times as many triangles a ray.", numbers.say("triangles", fewer, "tree: tests_per_ray", ""))
        }
        (false, _) => {
            format!(
                "It looks at {} of the triangles a ray.",
                numbers.say("triangles", 100.0 * fewer, "tree: tests_per_ray", " %")
            )
        }
    };
    let least = of(best, "trace_ms")?;
    let close: Vec<&str> = (0..table.rows.len())
        .filter(|&row| row != best && of(row, "max_depth").is_some() && of(row, "trace_ms").is_some_and(|ms| ms < 1.15 * least))
        .map(|row| table.words(row, "tree"))
        .collect();
    let by_hand = match close.is_empty() {
        true => format!("By hand, take {}: nothing else comes near it.", escape(table.words(best, "tree"))),
        false => {
            format!("By hand, take {}; {} come within a seventh of it.", escape(table.words(best, "tree")), close.join(", "))
        }
    };
    let same_best = if best == paper {
        ", the paper's own choice".to_owned()
    } else {
        format!("; the paper's (15, 5) takes {} ms", numbers.say("paper's", of(paper, "trace_ms")?, "tree: trace_ms", ""))
    };
    let text = format!(
        "The fastest of 36 settings on the paper's scene is {} with {} ms{same_best}. The tree that tunes itself takes {} ms with {} of its \
         memory, {} times as fast as the paper's brute force. {walk} {by_hand}",
        escape(table.words(best, "tree")),
        numbers.say("best", of(best, "trace_ms")?, "tree: trace_ms", ""),
        numbers.say("tuned", of(tuned, "trace_ms")?, "tree: trace_ms", ""),
        numbers.say("memory", 100.0 / memory, "tree: kb", " %"),
        numbers.say("over plain", plus, "tree: trace_ms", ""),
    );
    Some(Finding {
        id: "setting",
        question: "Which setting?",
        big,
        headline: headline.to_owned(),
        text,
        numbers: numbers.taken(),
    })
}

/// Where the paper's choices lie.
fn paper(kernels: &Table, leaving: &Table, tree: &Table) -> Option<Finding> {
    let mut numbers = Numbers::default();
    let rate = |name: &str| kernels.number(kernels.row("test", name)?, "wrong_per_1e9");
    let rounding: Vec<f64> =
        kernels.labels().iter().filter(|name| !name.starts_with("ours")).filter_map(|name| rate(name)).collect();
    let plane = rate("plane")?;
    let place = rounding.iter().filter(|rate| **rate < plane).count() + 1;
    let acne = |name: &str| leaving.number(leaving.row("policy", name)?, "wrong_per_1e6");
    let (identity, bare) = (acne("identity")?, acne("bare")?);
    let alike = super::sections::agreement(tree);
    let best = super::sections::fastest(tree)?;
    let (fifteen, time) = (tree.row("tree", "(15, 5)")?, |row: usize| tree.number(row, "trace_ms"));
    let behind = time(fifteen)? / time(best)?;
    let big = format!("{} of hard rays", numbers.say("plane wrong", plane / 1e7, "kernels: wrong_per_1e9", " %"));
    let verdict_tree = match (alike > 0.8, behind < 1.25) {
        (true, true) => "Its tree was well chosen",
        (true, false) => "Its tables were right about what matters",
        _ => "Its tree's tables do not carry over to this machine",
    };
    let fastest_text = match best == fifteen {
        true => "its fastest, (15, 5), is the fastest of the whole grid here".to_owned(),
        false => {
            let behind = numbers.say("behind", behind, "tree: trace_ms", "");
            format!("its fastest, (15, 5), takes {behind} times as long as the best of the grid")
        }
    };
    let verdict_rest = match (plane > 0.0, identity > 0.0) {
        (true, true) => "its test and its cure for stipple were not",
        (true, false) => "its test was not",
        (false, true) => "its cure for stipple was not",
        (false, false) => "its test and its cure held here as well",
    };
    let headline = format!("{verdict_tree}; {verdict_rest}");
    let text = format!(
        "The paper's test gives a wrong answer on so many hard rays, the {} of {} tests that round. Skipping the own triangle takes the wrong \
         shadow answers of the bare hit point from {} in a million hard cases down to {}, and not to none: neighbours in the same plane still \
         shadow each other. Its eleven settings rank here {} they did there (coefficient {}), and {fastest_text}.",
        nth(place),
        rounding.len(),
        numbers.count("bare", bare, "leaving: wrong_per_1e6"),
        numbers.count("identity", identity, "leaving: wrong_per_1e6"),
        if alike > 0.8 { "as" } else { "otherwise than" },
        numbers.say("rank", alike, "tree: paper_speedup, speedup", ""),
    );
    Some(Finding { id: "paper", question: "Where do the paper's choices lie?", big, headline, text, numbers: numbers.taken() })
}

/// `best`, `second best` and so on.
fn nth(place: usize) -> String {
    const WORDS: [&str; 7] = ["best", "second best", "third best", "fourth best", "fifth best", "sixth best", "seventh best"];
    WORDS.get(place.saturating_sub(1)).map_or_else(|| format!("number {place}"), |word| (*word).to_owned())
}
