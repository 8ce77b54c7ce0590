//! Ray against triangle: a conservative filter, a certified f64 test, and an exact stage behind both.

mod answer;
mod bundle;
mod certify;
mod dyadic;
mod exact;
mod filter;
mod group;
mod nearest;
mod order;
mod plane;
mod quotient;
mod solution;
mod space;
mod together;

pub use answer::hit_weights;
pub use bundle::{BUNDLE, Each, LANES, PACKETS, RayBundle, Rays, Row, count, greatest, least};
pub(crate) use exact::side_sign;
pub use filter::FilterRay;
pub use group::{Candidates, TriGroup};
pub use nearest::Nearest;
pub use order::{Closest, is_hit};
pub(crate) use plane::plane_then_inside;
pub use space::FilterSpace;

/// Which ray-triangle test answers a query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// Exact: filter, certified f64 test, exact stage. The specification.
    #[default]
    Certified,
    /// The paper's, in f32: plane first, then inside test. For lessons and comparison.
    Plane,
}
