//! Ray against triangle: a conservative filter, a certified f64 test, and an exact stage behind both.

mod certify;
mod dyadic;
mod exact;
mod filter;
mod group;
mod order;
mod plane;
mod quotient;

pub use certify::hit_weights;
pub(crate) use exact::side_sign;
pub use filter::FilterRay;
pub use group::TriGroup;
pub use order::{Closest, is_hit};
pub(crate) use plane::plane_then_inside;

/// Which ray-triangle test answers a query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// Exact: filter, certified f64 test, exact stage. The specification.
    #[default]
    Certified,
    /// The paper's, in f32: plane first, then inside test. For lessons and comparison.
    Plane,
}
