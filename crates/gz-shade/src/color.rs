//! Stand-in: how linear channels become bytes.

use crate::ColorCode;

/// The byte of a linear channel.
pub fn encode(code: ColorCode, channel: f32) -> u8 {
    let c = channel.clamp(0.0, 1.0);
    match code {
        ColorCode::Course12 => ((c * 4095.0) as u16 >> 4) as u8,
        ColorCode::Srgb if c <= 0.003_130_8 => (c * 12.92 * 255.0).round() as u8,
        ColorCode::Srgb => ((1.055 * libm::powf(c, 1.0 / 2.4) - 0.055) * 255.0).round() as u8,
    }
}
