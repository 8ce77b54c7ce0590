//! `gz info --tree`: the tree that a render would use, and what rays visit in it beside what its builder expects.

use crate::accel::Built;
use crate::random_lines::RandomLines;
use gz_bsp::{BspTree, CostStats, Expected, MidpointTree, TreeStats, VisitCount};
use gz_core::{ClassMask, GzRay, Hit, TriBuffer, with_default_float_control};
use std::fmt::Write;

/// Lines that are sent through the tree.
const LINES: usize = 10_000;
/// Of their generator.
const SEED: u64 = 1;

/// What there is to say of `built`, as lines of text; `None` for brute force, which is no tree.
pub fn report(built: &Built<'_>) -> Option<String> {
    match built {
        Built::Brute(_) => None,
        Built::Bsp(tree) => Some(structure_by_cost(tree) + &visits(tree)),
        Built::Midpoint(tree) => Some(structure_by_midpoint(tree) + &visits(tree)),
    }
}

fn structure_by_cost(tree: &BspTree<'_>) -> String {
    let tris = gz_core::RayQuery::tris(tree);
    let stats = CostStats::of(tree);
    let CostStats { nodes, cells, leaves, leaves_by_groups, groups, references, depth, bytes, node_bytes, .. } = stats;
    let by_groups: Vec<String> = leaves_by_groups.iter().map(usize::to_string).collect();
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "  depth      {depth}");
    let _ = writeln!(text, "  nodes      {nodes} of eight cells, {:.2} of them in use", ratio(cells, nodes));
    let _ = writeln!(text, "  leaves     {leaves}, 0 empty (what holds nothing is no cell)");
    text += &leaf_sizes(stats.smallest_leaf, stats.median_leaf, stats.largest_leaf);
    let _ = writeln!(text, "  groups     {groups} of eight, {:.2} triangles in each", ratio(references, groups));
    let _ = writeln!(text, "             leaves of 1 to 8 groups: {}", by_groups.join(", "));
    text += &duplication(references, tris);
    let parts = [("nodes", node_bytes), ("groups", bytes - node_bytes)];
    text + &bytes_by_part(&parts, tris)
}

fn structure_by_midpoint(tree: &MidpointTree<'_>) -> String {
    let tris = gz_core::RayQuery::tris(tree);
    let stats = TreeStats::of(tree);
    let TreeStats { nodes, leaves, empty_leaves, references, depth, .. } = stats;
    let mut text = String::new();
    let _ = writeln!(text, "  depth      {depth}");
    let _ = writeln!(text, "  nodes      {nodes}, leaves included");
    let _ = writeln!(text, "  leaves     {leaves}, {empty_leaves} empty");
    text += &leaf_sizes(stats.smallest_leaf, stats.median_leaf, stats.largest_leaf);
    text += &duplication(references, tris);
    let parts = [("nodes", size_of_val(tree.nodes())), ("lists", size_of_val(tree.references()))];
    text + &bytes_by_part(&parts, tris)
}

fn leaf_sizes(least: usize, median: usize, most: usize) -> String {
    format!("             {least} to {most} triangles in one that is not empty, median {median}\n")
}

fn duplication(references: usize, tris: &TriBuffer) -> String {
    format!("  listed     {references} references, {:.3} a triangle\n", ratio(references, tris.len()))
}

fn bytes_by_part(parts: &[(&str, usize)], tris: &TriBuffer) -> String {
    let each = |bytes: usize| ratio(bytes, tris.len());
    let all: usize = parts.iter().map(|(_, bytes)| bytes).sum();
    let listed: Vec<String> = parts.iter().map(|(name, bytes)| format!("{name} {:.1}", each(*bytes))).collect();
    format!(
        "  bytes      {:.1} a triangle: {}; beside them the triangle buffer, {:.1}\n",
        each(all),
        listed.join(", "),
        each(tris.bytes())
    )
}

/// `a / b`, 0 of nothing.
fn ratio(a: usize, b: usize) -> f64 {
    a as f64 / b.max(1) as f64
}

/// A tree whose walk can be watched.
trait Watched {
    fn tris(&self) -> &TriBuffer;
    fn expected(&self) -> Option<Expected>;
    fn walk(&self, line: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit;
    /// The rows of the table: what is counted, what the areas say of it, and its count.
    fn rows(&self, expected: &Expected) -> Vec<Row>;
}

/// Something that is counted: its name, its expected number on a whole line, and how a count of visits has it, if it does.
type Row = (&'static str, String, Option<fn(&VisitCount) -> u64>);

impl Watched for BspTree<'_> {
    fn tris(&self) -> &TriBuffer {
        gz_core::RayQuery::tris(self)
    }

    fn expected(&self) -> Option<Expected> {
        Expected::of(self)
    }

    fn walk(&self, line: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit {
        self.closest_hit_counted(line, classes, visits)
    }

    fn rows(&self, expected: &Expected) -> Vec<Row> {
        vec![
            ("nodes of eight cells", number(expected.nodes), Some(|v| v.nodes)),
            ("leaves", number(expected.leaves), Some(|v| v.leaves)),
            ("groups of triangles", number(expected.groups), Some(|v| v.groups)),
            ("triangles in them", number(expected.triangles), None),
            ("triangles tested in f64", format!("{} met", number(expected.met)), Some(|v| v.tests)),
        ]
    }
}

impl Watched for MidpointTree<'_> {
    fn tris(&self) -> &TriBuffer {
        gz_core::RayQuery::tris(self)
    }

    fn expected(&self) -> Option<Expected> {
        Expected::of_midpoint(self)
    }

    fn walk(&self, line: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit {
        self.closest_hit_counted(line, classes, visits)
    }

    fn rows(&self, expected: &Expected) -> Vec<Row> {
        vec![
            ("inner nodes", number(expected.nodes), Some(|v| v.nodes)),
            ("leaves", number(expected.leaves), Some(|v| v.leaves)),
            ("triangles tested", number(expected.triangles), Some(|v| v.tests)),
            ("triangles met", number(expected.met), None),
        ]
    }
}

/// Visits of random lines as a table: expected, counted on whole lines, counted up to the first hit.
fn visits(tree: &impl Watched) -> String {
    let (Some(expected), Some(lines)) = (tree.expected(), RandomLines::through(&tree.tris().bounds(), SEED)) else {
        return "  no line can be sent through the scene's box at random: it has no area\n".to_owned();
    };
    let (mut whole, mut to_hit, mut hits) = (Vec::with_capacity(LINES), Vec::with_capacity(LINES), 0);
    with_default_float_control(|| {
        for line in lines.take(LINES) {
            let mut visits = VisitCount::default();
            // Triangles of no class do not end the walk: the line goes through everything on its way.
            tree.walk(&line, ClassMask::NONE, &mut visits);
            whole.push(visits);
            let mut visits = VisitCount::default();
            hits += usize::from(tree.walk(&line, ClassMask::ALL, &mut visits).is_hit());
            to_hit.push(visits);
        }
    });
    let mut text =
        format!("  visits     of {LINES} random lines through the scene's box (seed {SEED}), {hits} of which hit something\n");
    let _ = writeln!(text, "             {:<24}{:>14}{:>22}{:>18}", "", "expected", "counted", "to the first hit");
    for (name, expected, count) in tree.rows(&expected) {
        let (all, first) = match count {
            Some(count) => {
                let (mean, error) = mean(&whole, count);
                (format!("{} +- {}", number(mean), number(error)), number(self::mean(&to_hit, count).0))
            }
            None => ("-".to_owned(), "-".to_owned()),
        };
        let _ = writeln!(text, "             {name:<24}{expected:>14}{all:>22}{first:>18}");
    }
    text + "             expected by the areas of boxes, as the builder prices, with nothing in a line's way; counted with its standard error\n"
}

/// The mean of a count over all lines, and its standard error.
fn mean(visits: &[VisitCount], count: fn(&VisitCount) -> u64) -> (f64, f64) {
    let n = visits.len() as f64;
    let mean = visits.iter().map(|v| count(v) as f64).sum::<f64>() / n;
    let squares = visits.iter().map(|v| (count(v) as f64 - mean).powi(2)).sum::<f64>();
    (mean, (squares / (n - 1.0) / n).sqrt())
}

/// With as many decimals as make three or four digits.
fn number(x: f64) -> String {
    match x {
        0.0..10.0 => format!("{x:.3}"),
        10.0..100.0 => format!("{x:.2}"),
        _ => format!("{x:.1}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Accel;
    use gz_bsp::Midpoint;
    use gz_core::{GzCoord, GzTri};

    /// `n` triangles whose box is the unit cube, at each of `corners`.
    fn cubes(corners: &[GzCoord], n: usize) -> TriBuffer {
        let mut tris = TriBuffer::new();
        for corner in corners.iter().flat_map(|corner| std::iter::repeat_n(corner, n)) {
            let positions = [GzCoord::ZERO, GzCoord::new(1.0, 1.0, 0.0), GzCoord::new(0.0, 1.0, 1.0)].map(|p| *corner + p);
            tris.push(&GzTri { positions, ..GzTri::default() }).unwrap();
        }
        tris
    }

    fn report_of(tris: &TriBuffer, accel: Accel) -> String {
        report(&accel.build(tris).unwrap()).unwrap()
    }

    /// The numbers of the table's row `name`: expected, counted, its error, to the first hit.
    fn row(text: &str, name: &str) -> Vec<f64> {
        let line =
            text.lines().rfind(|line| line.trim_start().starts_with(name)).unwrap_or_else(|| panic!("no {name} in {text}"));
        line.trim_start()[name.len()..].split_whitespace().filter_map(|word| word.parse().ok()).collect()
    }

    #[test]
    fn a_tree_that_can_be_drawn_by_hand_is_reported() {
        // Two cubes of area 6 with eight triangles each, at the ends of a beam of area 42.
        let tris = cubes(&[GzCoord::ZERO, GzCoord::X * 9.0], 8);
        let text = report_of(&tris, Accel::Bsp);
        for line in [
            "  depth      1\n",
            "  nodes      1 of eight cells, 2.00 of them in use\n",
            "  leaves     2, 0 empty",
            "             8 to 8 triangles in one that is not empty, median 8\n",
            "  groups     2 of eight, 8.00 triangles in each\n",
            "leaves of 1 to 8 groups: 2, 0, 0, 0, 0, 0, 0, 0\n",
            "  listed     16 references, 1.000 a triangle\n",
            "  bytes      58.0 a triangle: nodes 14.0, groups 44.0; beside them the triangle buffer, 36.0\n",
            "  visits     of 10000 random lines through the scene's box (seed 1), ",
        ] {
            assert!(text.contains(line), "{line:?} is not in\n{text}");
        }
        assert_eq!(row(&text, "nodes of eight cells"), [1.0, 1.0, 0.0, 1.0]);
        assert_eq!(row(&text, "triangles in them"), [2.286]);
        for name in ["leaves", "groups of triangles"] {
            let [expected, counted, error, to_hit] = row(&text, name)[..] else { panic!("{text}") };
            assert!(
                expected == 0.286 && error < 0.006 && (counted - expected).abs() < 4.0 * error && to_hit <= counted,
                "{text}"
            );
        }
    }

    #[test]
    fn the_papers_tree_is_reported() {
        // Cubes at z = 0 and 3, cut at 2: the box has area 18, its halves 10.
        let tris = cubes(&[GzCoord::ZERO, GzCoord::Z * 3.0], 2);
        let text = report_of(&tris, Accel::Midpoint(Midpoint { max_depth: 1, min_size: 1, ..Midpoint::default() }));
        for line in
            ["  nodes      3, leaves included\n", "  leaves     2, 0 empty\n", "  listed     4 references, 1.000 a triangle\n"]
        {
            assert!(text.contains(line), "{line:?} is not in\n{text}");
        }
        assert_eq!(row(&text, "inner nodes"), [1.0, 1.0, 0.0, 1.0]);
        for (name, by_hand) in [("leaves", 1.111), ("triangles tested", 2.222)] {
            let [expected, counted, error, to_hit] = row(&text, name)[..] else { panic!("{text}") };
            assert!(expected == by_hand && (counted - expected).abs() < 4.0 * error && to_hit < counted, "{text}");
        }
    }

    #[test]
    fn scenes_without_area_and_of_one_triangle_are_reported() {
        let nothing = report_of(&TriBuffer::new(), Accel::Bsp);
        assert!(nothing.contains("leaves     0,") && nothing.contains("0 to 0 triangles") && nothing.contains("it has no area"));
        assert!(report_of(&TriBuffer::new(), Accel::Midpoint(Midpoint::default())).contains("leaves     1, 1 empty"));
        let one = report_of(&cubes(&[GzCoord::ONE], 1), Accel::Bsp);
        assert_eq!(row(&one, "leaves"), [1.0, 1.0, 0.0, 1.0], "{one}");
        assert_eq!(row(&one, "triangles in them"), [1.0]);
    }

    #[test]
    fn brute_force_is_no_tree() {
        let tris = TriBuffer::new();
        assert_eq!(report(&Accel::Brute(gz_core::Kernel::Certified).build(&tris).unwrap()), None);
    }
}
