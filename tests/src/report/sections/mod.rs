//! What the report measures.

mod balance;
mod kernels;
mod leaving;
mod model;
mod needs;
mod peers;
mod precision;
mod sampling;
mod scale;
mod t_error;
mod tree;
mod walks;

use super::gallery;
use super::section::Section;

/// All sections in the order of the page; that on other ray tracers only where there are results of them, or where `peers` says so.
pub(super) fn all(peers: bool) -> Vec<Section> {
    let mut all = vec![
        gallery::STEPS,
        gallery::BUFFERS,
        gallery::FAILURES,
        kernels::SECTION,
        t_error::DISTANCE,
        t_error::ASPECT,
        leaving::SECTION,
        tree::SECTION,
        walks::SECTION,
        balance::SECTION,
        gallery::CELLS,
        gallery::HEAT,
        scale::SECTION,
    ];
    all.extend(peers.then_some(peers::SECTION));
    all.extend([sampling::SECTION, model::SECTION, precision::SECTION, gallery::DIFFERENCES, needs::SECTION]);
    all
}

pub(super) use peers::has_results as has_peers;
pub(super) use tree::{agreement, fastest};
