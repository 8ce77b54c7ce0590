//! Pictures of the report, with what can be counted in them.

mod buffers;
mod cells;
mod differences;
mod failures;
mod heat;
mod steps;

pub(super) use buffers::SECTION as BUFFERS;
pub(super) use cells::SECTION as CELLS;
pub(super) use differences::SECTION as DIFFERENCES;
pub(super) use failures::SECTION as FAILURES;
pub(super) use heat::SECTION as HEAT;
pub(super) use steps::SECTION as STEPS;

use gz_core::GzColor;
use gz_shade::ColorCode;

/// Colours as the bytes of a picture that is shown as it is, whatever the scene's own rule.
fn srgb(colors: &[GzColor]) -> Vec<u8> {
    gz_app::output::rgb8(colors, ColorCode::Srgb)
}
