//! Triangles in nested boxes, so that most need not be looked at.
//!
//! A box is left out only when the line surely misses it, or surely enters it beyond the best hit. Boxes are the exact bounds of f32
//! corners. The distance (p - o) / d of a plane passes two roundings, so it is off by at most 2.01 u of itself; it is widened by 9 u and
//! by the least normal number, which covers the widening's own roundings.

use super::quick::{LANES, Pack};
use super::{Line, Steps, Triangle};

#[derive(Clone, Debug)]
struct Node {
    lo: [f64; 3],
    hi: [f64; 3],
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// The first child follows this node, this is the other one.
    Pair(u32),
    /// The number of a pack.
    Leaf(u32),
}

/// Triangles with their numbers, in nested boxes.
#[derive(Clone, Debug)]
pub(super) struct Boxes {
    nodes: Vec<Node>,
    packs: Vec<Pack>,
    /// Those of each pack.
    triangles: Vec<Vec<(u32, Triangle)>>,
}

impl Boxes {
    /// # Panics
    ///
    /// If a corner is not finite.
    pub(super) fn new(mut triangles: Vec<(u32, Triangle)>) -> Self {
        assert!(triangles.iter().all(|(_, t)| t.iter().flatten().all(|x| x.is_finite())), "corners are finite");
        let mut boxes = Self { nodes: Vec::new(), packs: Vec::new(), triangles: Vec::new() };
        if !triangles.is_empty() {
            boxes.add(&mut triangles);
        }
        boxes
    }

    fn add(&mut self, triangles: &mut [(u32, Triangle)]) {
        let [mut lo, mut hi] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for corner in triangles.iter().flat_map(|(_, corners)| corners) {
            for k in 0..3 {
                lo[k] = lo[k].min(f64::from(corner[k]));
                hi[k] = hi[k].max(f64::from(corner[k]));
            }
        }
        let at = self.nodes.len();
        self.nodes.push(Node { lo, hi, kind: Kind::Leaf(self.packs.len() as u32) });
        if triangles.len() <= LANES {
            let corners: Vec<Triangle> = triangles.iter().map(|(_, corners)| *corners).collect();
            self.packs.push(Pack::new(&corners));
            self.triangles.push(triangles.to_vec());
            return;
        }
        // Half of them to either side, by the sum of corners along the longest axis.
        let size = [0, 1, 2].map(|k| hi[k] - lo[k]);
        let axis = if size[0] >= size[1] && size[0] >= size[2] { 0 } else { 1 + usize::from(size[2] > size[1]) };
        let place = |(_, corners): &(u32, Triangle)| corners.iter().map(|corner| f64::from(corner[axis])).sum::<f64>();
        let middle = triangles.len() / 2;
        triangles.select_nth_unstable_by(middle, |one, other| place(one).total_cmp(&place(other)).then(one.0.cmp(&other.0)));
        let (left, right) = triangles.split_at_mut(middle);
        self.add(left);
        self.nodes[at].kind = Kind::Pair(self.nodes.len() as u32);
        self.add(right);
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, tri: u32) -> Option<Triangle> {
        self.triangles.iter().flatten().find(|(id, _)| *id == tri).map(|(_, corners)| *corners)
    }

    /// Calls `found` for every triangle that `line` does not surely miss and that may lie within the distance that `found` returned last.
    pub(super) fn each_near(&self, line: &Line, steps: &mut Steps, found: &mut impl FnMut(u32, &Triangle, &mut Steps) -> f64) {
        let mut most = line.tmax;
        let mut open = Vec::with_capacity(64);
        let visit = |at: usize, open: &mut Vec<(usize, f64)>, most: f64| {
            if let Some(node) = self.nodes.get(at)
                && let Some(entry) = entry(node, line, most)
            {
                open.push((at, entry));
            }
        };
        visit(0, &mut open, most);
        while let Some((at, entry)) = open.pop() {
            if entry > most {
                continue;
            }
            match self.nodes[at].kind {
                Kind::Pair(other) => {
                    let before = open.len();
                    visit(other as usize, &mut open, most);
                    visit(at + 1, &mut open, most);
                    // The nearer one is taken first.
                    if let [one, other] = &mut open[before..]
                        && one.1 < other.1
                    {
                        std::mem::swap(one, other);
                    }
                }
                Kind::Leaf(pack) => {
                    let (pack, triangles) = (&self.packs[pack as usize], &self.triangles[pack as usize]);
                    steps.quick += triangles.len() as u64;
                    let misses = line.number().map_or([false; LANES], |origin| pack.misses(origin, line));
                    for ((tri, corners), _) in triangles.iter().zip(misses).filter(|(_, misses)| !misses) {
                        most = most.min(found(*tri, corners, steps));
                    }
                }
            }
        }
    }
}

/// At most the t at which `line` enters a box; `None` when it surely misses the box or enters it beyond `most`.
fn entry(node: &Node, line: &Line, most: f64) -> Option<f64> {
    let (mut enter, mut leave) = (line.tmin, most);
    for k in 0..3 {
        let (o, d) = (line.start[k], line.direction[k]);
        if d == 0.0 {
            if node.lo[k] > o.hi || node.hi[k] < o.lo {
                return None;
            }
            continue;
        }
        let (near, far) = if d > 0.0 { (node.lo[k] - o.hi, node.hi[k] - o.lo) } else { (node.hi[k] - o.lo, node.lo[k] - o.hi) };
        let (near, far) = (near / d, far / d);
        enter = enter.max(near - widening(near));
        leave = leave.min(far + widening(far));
    }
    (enter <= leave).then_some(enter)
}

fn widening(t: f64) -> f64 {
    t.abs() * (4.5 * f64::EPSILON) + f64::MIN_POSITIVE
}
