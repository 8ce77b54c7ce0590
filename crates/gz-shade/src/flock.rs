//! Branches in an order in which neighbours go the same way, so that they are asked together.

use crate::bounce::Branch;
use crate::tree::RayKind;
use gz_core::GzCoord;

/// Reflected or refracted, and the signs of a direction.
const WAYS: usize = 16;

/// Room for orders of branches, kept from batch to batch.
#[derive(Debug, Default)]
pub(crate) struct Flock {
    order: Vec<u32>,
}

impl Flock {
    /// The numbers of the `branches` of one kind: reflected rays before refracted ones, each by the signs of their directions, of equal ones
    /// the first before the next. A hit's branches stay in the order in which they were made.
    pub(crate) fn order(&mut self, branches: &[Branch], kind: RayKind) -> &[u32] {
        let of_kind = || (0..).zip(branches).filter(|(_, branch)| branch.kind == kind);
        // Where the branches of each way begin, and with each that is placed where the next goes.
        let mut next = [0; WAYS + 1];
        of_kind().for_each(|(_, branch)| next[way(branch) + 1] += 1);
        for way in 0..WAYS {
            next[way + 1] += next[way];
        }
        self.order.clear();
        self.order.resize(next[WAYS], 0);
        for (number, branch) in of_kind() {
            let place = &mut next[way(branch)];
            self.order[*place] = number;
            *place += 1;
        }
        &self.order
    }
}

fn way(branch: &Branch) -> usize {
    let GzCoord { x, y, z } = branch.direction;
    [branch.refracted, x < 0.0, y < 0.0, z < 0.0].into_iter().fold(0, |bits, bit| 2 * bits + usize::from(bit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::Media;
    use glam::DVec3;
    use gz_core::GzColor;

    #[test]
    fn neighbours_go_the_same_way_and_keep_their_order() {
        let mut branches = Vec::new();
        for k in 0..600u32 {
            let sign = |bit: u32| if k >> bit & 1 != 0 { -1.0 } else { 0.0 };
            branches.push(Branch {
                parent: k / 2,
                kind: if k % 5 == 0 { RayKind::Mirror } else { RayKind::Glass },
                refracted: k % 3 == 0,
                origin: DVec3::ZERO,
                direction: GzCoord::new(sign(0), sign(1), sign(4)),
                factor: GzColor::ONE,
                media: Media::AIR,
            });
        }
        let mut flock = Flock::default();
        for kind in [RayKind::Mirror, RayKind::Glass, RayKind::Primary] {
            let order = flock.order(&branches, kind).to_vec();
            let mut expected: Vec<u32> = (0..600).filter(|&k| branches[k as usize].kind == kind).collect();
            expected.sort_by_key(|&k| way(&branches[k as usize])); // stable
            assert_eq!(order, expected);
            assert!(order.iter().map(|&k| branches[k as usize].refracted).is_sorted());
        }
    }
}
