//! What answers rays: brute force or a tree, as the command line has it.

use crate::args;
use crate::cli::AccelArgs;
use crate::error::AppError;
use gz_bsp::{BspTree, CostStats, Midpoint, MidpointTree, TreeStats, VisitCount};
use gz_core::{BruteForce, ClassMask, GzRay, Kernel, RayQuery, TriBuffer};

/// How rays are answered. All answer alike, except the kernels that are there for comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accel {
    /// Every ray against every triangle.
    Brute(Kernel),
    /// The tree that tunes itself.
    Bsp,
    /// The paper's tree with its MAX_DEPTH and MIN_SIZE.
    Midpoint(Midpoint),
}

/// The rule by which a tree chooses its planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// Through the middle of each box, the paper's.
    Midpoint,
    /// By expected cost.
    Sah,
}

/// `brute` or `bsp`, as given by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccelKind {
    /// Every ray against every triangle.
    Brute,
    /// Through a tree.
    Bsp,
}

impl Accel {
    /// What these options ask for together: the tree that tunes itself, unless something else is said.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for options that contradict each other.
    pub fn of(asked: &AccelArgs) -> Result<Self, AppError> {
        let refuse = |what: &str| Err(AppError::Usage(what.to_owned()));
        let sizes = asked.max_depth.is_some() || asked.min_size.is_some();
        let kind = asked.accel.unwrap_or(match asked.kernel {
            Kernel::Certified => AccelKind::Bsp,
            _ => AccelKind::Brute,
        });
        match (kind, asked.split) {
            (AccelKind::Brute, _) if sizes || asked.split.is_some() => {
                refuse("--split, --max-depth and --min-size are of the tree: use --accel bsp with --kernel certified")
            }
            (AccelKind::Brute, _) => Ok(Self::Brute(asked.kernel)),
            (AccelKind::Bsp, _) if asked.kernel != Kernel::Certified => {
                let name = args::kernel_name(asked.kernel);
                refuse(&format!("--kernel {name} is for comparison by brute force: use --accel brute"))
            }
            (AccelKind::Bsp, Some(Split::Sah)) if sizes => {
                refuse("--max-depth and --min-size are of the paper's tree: use --split midpoint")
            }
            (AccelKind::Bsp, split) if sizes || split == Some(Split::Midpoint) => {
                let default = Midpoint::default();
                Ok(Self::Midpoint(Midpoint {
                    max_depth: asked.max_depth.unwrap_or(default.max_depth),
                    min_size: asked.min_size.unwrap_or(default.min_size),
                    ..default
                }))
            }
            (AccelKind::Bsp, _) => Ok(Self::Bsp),
        }
    }

    /// Builds what answers rays against `tris`.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] if the paper's tree would pass its node budget.
    pub fn build<'a>(&self, tris: &'a TriBuffer) -> Result<Built<'a>, AppError> {
        Ok(match *self {
            Self::Brute(kernel) => Built::Brute(BruteForce::with_kernel(tris, kernel)),
            Self::Bsp => Built::Bsp(BspTree::build(tris)),
            Self::Midpoint(params) => {
                Built::Midpoint(MidpointTree::build(tris, params).map_err(|error| AppError::Usage(error.to_string()))?)
            }
        })
    }

    /// `brute`, `bsp` or `midpoint`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Brute(_) => "brute",
            Self::Bsp => "bsp",
            Self::Midpoint(_) => "midpoint",
        }
    }

    /// The ray-triangle test behind it.
    pub fn kernel(&self) -> Kernel {
        match self {
            Self::Brute(kernel) => *kernel,
            Self::Bsp | Self::Midpoint(_) => Kernel::Certified,
        }
    }
}

/// What answers rays, built.
#[derive(Debug)]
pub enum Built<'a> {
    /// Every ray against every triangle.
    Brute(BruteForce<'a>),
    /// The tree that tunes itself.
    Bsp(BspTree<'a>),
    /// The paper's tree.
    Midpoint(MidpointTree<'a>),
}

impl Built<'_> {
    /// It as what may be asked.
    pub fn query(&self) -> &dyn RayQuery {
        match self {
            Self::Brute(brute) => brute,
            Self::Bsp(tree) => tree,
            Self::Midpoint(tree) => tree,
        }
    }

    /// What the walk of one ray to its front-most hit visits; `None` for brute force, which has no walk.
    pub fn visits(&self, ray: &GzRay) -> Option<VisitCount> {
        let mut visits = VisitCount::default();
        match self {
            Self::Brute(_) => return None,
            Self::Bsp(tree) => tree.closest_hit_counted(ray, ClassMask::ALL, &mut visits),
            Self::Midpoint(tree) => tree.closest_hit_counted(ray, ClassMask::ALL, &mut visits),
        };
        Some(visits)
    }

    /// Bytes beyond the triangle buffer.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Brute(brute) => brute.bytes(),
            Self::Bsp(tree) => tree.bytes(),
            Self::Midpoint(tree) => TreeStats::of(tree).bytes,
        }
    }

    /// Its sizes in one line.
    pub fn describe(&self) -> String {
        match self {
            Self::Brute(brute) => format!("brute force, {} bytes", brute.bytes()),
            Self::Bsp(tree) => {
                let CostStats { nodes, leaves, groups, references, largest_leaf, depth, bytes, .. } = CostStats::of(tree);
                format!(
                    "bsp by cost: {nodes} nodes of eight cells, {leaves} leaves, {groups} groups, {references} references, \
                     largest leaf {largest_leaf}, depth {depth}, {bytes} bytes"
                )
            }
            Self::Midpoint(tree) => {
                let TreeStats { nodes, leaves, empty_leaves, references, largest_leaf, depth, bytes, .. } = TreeStats::of(tree);
                let Midpoint { max_depth, min_size, .. } = tree.params();
                format!(
                    "bsp by midpoint ({max_depth}, {min_size}): {nodes} nodes, {leaves} leaves ({empty_leaves} empty), \
                     {references} references, largest leaf {largest_leaf}, depth {depth}, {bytes} bytes"
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: AccelArgs = AccelArgs { kernel: Kernel::Certified, accel: None, split: None, max_depth: None, min_size: None };

    #[test]
    fn the_tree_that_tunes_itself_is_the_default() {
        assert_eq!(Accel::of(&NOTHING).unwrap(), Accel::Bsp);
        for kernel in Kernel::ALL.into_iter().skip(1) {
            assert_eq!(Accel::of(&AccelArgs { kernel, ..NOTHING }).unwrap(), Accel::Brute(kernel));
        }
        let paper = AccelArgs { max_depth: Some(8), ..NOTHING };
        assert_eq!(Accel::of(&paper).unwrap(), Accel::Midpoint(Midpoint { max_depth: 8, ..Midpoint::default() }));
    }

    #[test]
    fn contradictions_are_usage_errors() {
        for bad in [
            AccelArgs { accel: Some(AccelKind::Brute), max_depth: Some(3), ..NOTHING },
            AccelArgs { accel: Some(AccelKind::Bsp), kernel: Kernel::Plane, ..NOTHING },
            AccelArgs { split: Some(Split::Sah), min_size: Some(3), ..NOTHING },
        ] {
            assert_eq!(Accel::of(&bad).unwrap_err().exit_code(), 2);
        }
    }

    #[test]
    fn a_tree_beyond_its_budget_is_a_usage_error() {
        let tris = TriBuffer::new();
        let error = Accel::Midpoint(Midpoint { max_depth: 40, min_size: 0, ..Midpoint::default() }).build(&tris).unwrap_err();
        assert_eq!(error.exit_code(), 2);
    }
}
