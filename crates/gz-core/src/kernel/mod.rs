//! Ray against triangle: a conservative filter, a certified f64 test, and an exact stage behind both.

mod answer;
mod answers;
mod baldwin_weber;
mod bundle;
mod certify;
mod departure;
mod dyadic;
mod exact;
mod filter;
mod gather;
mod group;
mod height;
mod leaving;
mod moeller_trumbore;
mod nearest;
mod order;
mod packets;
mod passage;
mod plain;
mod plain_f32;
mod plane;
mod pluecker;
mod quotient;
mod rung;
mod solution;
mod space;
mod spans;
mod together;
mod woop;

pub(crate) use answer::point_at;
pub use answer::{answer_rung, hit_weights};
pub use bundle::RayBundle;
pub(crate) use departure::FindPoints;
pub(crate) use exact::side_sign;
pub use filter::FilterRay;
pub use group::{Candidates, TriGroup};
pub(crate) use height::Plane;
pub(crate) use leaving::{Leaving, without_tiny};
pub use nearest::{Asked, Nearest};
pub use order::{Closest, is_hit};
pub use packets::{BUNDLE, Each, LANES, PACKETS, Rays, Row, count, extremes, first, greatest, is_none, least, packets, span};
pub use passage::{GoingThrough, OnHit, Stopped};
pub use plain::plain;
pub use plain_f32::InPlainF32;
pub use rung::{Rung, rung};
pub use space::FilterSpace;
pub use spans::Spans;

/// Which ray-triangle test answers a query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// Exact: filter, certified f64 test, exact stage. The specification.
    #[default]
    Certified,
    /// The paper's, in f32: plane first, then inside test. For lessons and comparison, as all that follow.
    Plane,
    /// Möller and Trumbore's, in f32 and without a tolerance.
    MoellerTrumbore,
    /// The same in f64.
    MoellerTrumboreF64,
    /// Woop, Benthin and Wald's watertight one, in f32 with f64 where an edge function is 0.
    Woop,
    /// The same with fused multiply-adds, which cost it its property.
    WoopFused,
    /// By Plücker coordinates relative to the ray's origin, in f32.
    Pluecker,
    /// Baldwin and Weber's, one affine map a triangle, in f32.
    BaldwinWeber,
}

impl Kernel {
    /// All of them, the exact one first.
    pub const ALL: [Self; 8] = [
        Self::Certified,
        Self::Plane,
        Self::MoellerTrumbore,
        Self::MoellerTrumboreF64,
        Self::Woop,
        Self::WoopFused,
        Self::Pluecker,
        Self::BaldwinWeber,
    ];
}
