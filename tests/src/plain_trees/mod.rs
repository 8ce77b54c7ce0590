//! Trees that are there to be compared with: the paper's with the mistakes that are easily made in it, and one cut by the triangles' own
//! planes.
//!
//! Each answers [`RayQuery`], so that whatever traces rays or shades a picture can be given one.

mod midpoint;
mod polygon;
mod polygon_build;
mod shape;

pub use midpoint::{Ending, Insert, PlainMidpoint, PlainRules};
pub use polygon::PolygonBsp;
pub use polygon_build::PolygonRules;
pub use shape::Shape;

use gz_core::{GzRay, RayQuery};
use rayon::prelude::*;
use std::ops::AddAssign;

/// How often two ways to answer the same rays find another triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Disagreement {
    /// Rays asked about.
    pub rays: u64,
    /// Rays on which the truth is a hit and the other answer none.
    pub missed: u64,
    /// Rays on which the truth is a miss and the other answer a hit.
    pub invented: u64,
    /// Rays on which both are hits, of different triangles.
    pub other: u64,
}

impl Disagreement {
    /// All rays with another answer.
    pub fn wrong(&self) -> u64 {
        self.missed + self.invented + self.other
    }

    /// Asks both about `rays`, and counts where `query` does not name the triangle that `truth` does. T-values are not compared: tests
    /// that round have their own.
    pub fn count(query: &dyn RayQuery, truth: &dyn RayQuery, rays: &[GzRay]) -> Self {
        let of_part = |part: &[GzRay]| {
            let mut counts = Self { rays: part.len() as u64, ..Self::default() };
            for ray in part {
                let (found, right) = (query.closest_hit(ray), truth.closest_hit(ray));
                match (found.is_hit(), right.is_hit()) {
                    (false, true) => counts.missed += 1,
                    (true, false) => counts.invented += 1,
                    _ => counts.other += u64::from(found.tri != right.tri),
                }
            }
            counts
        };
        rays.par_chunks(256).map(of_part).reduce(Self::default, |mut all, part| {
            all += part;
            all
        })
    }
}

impl AddAssign for Disagreement {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.missed += other.missed;
        self.invented += other.invented;
        self.other += other.other;
    }
}
