//! A limit to the branches of one pixel, so that memory is bounded whatever the scene.

use crate::bounce::Branch;
use crate::tree::{Node, RayKind};
use crate::{FrameStats, MirrorBlend};

/// The most branches of one depth that descend from one camera ray.
///
/// Twenty panes of glass one behind the other have some thousands of paths at depth 32 that weigh more than 2^-16; scenes of solid
/// glass stay far below a hundred. With 1024 a pixel has at most 32 * 1024 + 1 nodes at the greatest depth of a scene file.
const MOST: usize = 1024;

/// Finds the branches that are too many, and the room that finding them takes.
#[derive(Debug, Default)]
pub(crate) struct Crowd {
    /// Branches of each root.
    counts: Vec<u32>,
    /// Branches of roots that have too many.
    crowd: Vec<Member>,
    ends: Vec<bool>,
}

/// A branch among too many.
#[derive(Clone, Copy, Debug)]
struct Member {
    root: u32,
    weight: f32,
    branch: u32,
}

impl Crowd {
    /// Leaves the [`MOST`] heaviest `branches` of each root, of equal ones the first, and counts the others.
    ///
    /// A root's branches come in the same order whatever other roots there are, so the choice is the same in every tile.
    pub(crate) fn thin(&mut self, branches: &mut Vec<Branch>, nodes: &mut [Node], blend: MirrorBlend, stats: &mut FrameStats) {
        if branches.len() <= MOST {
            return;
        }
        // 1. Which roots have too many?
        let root = |branch: &Branch| nodes[branch.parent as usize].root;
        self.counts.clear();
        for branch in branches.iter() {
            let root = root(branch) as usize;
            if root >= self.counts.len() {
                self.counts.resize(root + 1, 0);
            }
            self.counts[root] += 1;
        }
        self.crowd.clear();
        for (k, branch) in branches.iter().enumerate() {
            let root = root(branch);
            if self.counts[root as usize] as usize > MOST {
                let weight = (nodes[branch.parent as usize].weight * branch.factor).max_element();
                self.crowd.push(Member { root, weight, branch: k as u32 });
            }
        }
        if self.crowd.is_empty() {
            return;
        }
        // 2. Of those, the lighter ones end.
        self.crowd.sort_unstable_by(|a, b| a.root.cmp(&b.root).then(b.weight.total_cmp(&a.weight)).then(a.branch.cmp(&b.branch)));
        self.ends.clear();
        self.ends.resize(branches.len(), false);
        for one in self.crowd.chunk_by(|a, b| a.root == b.root) {
            for member in &one[MOST..] {
                let branch = &branches[member.branch as usize];
                self.ends[member.branch as usize] = true;
                stats.crowded_branches += 1;
                stats.crowded_weight = stats.crowded_weight.saturating_add(FrameStats::units(member.weight));
                if branch.kind == RayKind::Mirror && blend == MirrorBlend::Replace {
                    // Nothing replaces the mirror's own colour.
                    nodes[branch.parent as usize].keep = 1.0;
                }
            }
        }
        let mut ends = self.ends.iter();
        branches.retain(|_| ends.next() != Some(&true));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::Media;
    use glam::DVec3;
    use gz_core::{GzColor, GzCoord, Hit};

    /// `counts[r]` branches of root `r`, root by root in turn; branch `k` of a root weighs (1 + k % 7) / 8.
    fn some(counts: &[usize]) -> (Vec<Node>, Vec<Branch>) {
        let nodes = (0..counts.len()).map(|r| Node { keep: 0.0, ..Node::root(r as u32, Hit::MISS) }).collect();
        let mut branches = Vec::new();
        for k in 0..counts.iter().copied().max().unwrap_or(0) {
            for r in (0..counts.len()).filter(|&r| k < counts[r]) {
                let (origin, direction) = (DVec3::splat(k as f64), GzCoord::Z);
                let factor = GzColor::splat((1 + k % 7) as f32 / 8.0);
                branches.push(Branch {
                    parent: r as u32,
                    kind: RayKind::Mirror,
                    refracted: false,
                    origin,
                    direction,
                    factor,
                    media: Media::AIR,
                });
            }
        }
        (nodes, branches)
    }

    /// What is left of the branches of root `r`: which they are.
    fn left(branches: &[Branch], r: u32) -> Vec<f64> {
        branches.iter().filter(|branch| branch.parent == r).map(|branch| branch.origin.x).collect()
    }

    #[test]
    fn the_heaviest_stay_whatever_other_roots_there_are() {
        let (mut nodes, mut branches) = some(&[3, 2 * MOST, MOST]);
        let mut stats = FrameStats::default();
        Crowd::default().thin(&mut branches, &mut nodes, MirrorBlend::Replace, &mut stats);
        assert_eq!([0, 1, 2].map(|r| left(&branches, r).len()), [3, MOST, MOST]);
        assert_eq!(stats.crowded_branches, MOST as u64);
        assert_eq!([0, 1, 2].map(|r| nodes[r].keep), [0.0, 1.0, 0.0]);
        // Of 7 weights, equally frequent, the upper half stays.
        let least = branches.iter().filter(|branch| branch.parent == 1).map(|branch| branch.factor.x).fold(1.0, f32::min);
        assert_eq!(least, 4.0 / 8.0);

        let (mut nodes, mut alone) = some(&[2 * MOST]);
        Crowd::default().thin(&mut alone, &mut nodes, MirrorBlend::Replace, &mut FrameStats::default());
        assert_eq!(left(&alone, 0), left(&branches, 1));
    }
}
