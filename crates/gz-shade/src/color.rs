//! Stand-in: how linear channels become bytes.

/// The course's byte of a linear channel.
pub fn course12_byte(channel: f32) -> u8 {
    ((channel.clamp(0.0, 1.0) * 4095.0) as u16 >> 4) as u8
}

/// The sRGB byte of a linear channel.
pub fn srgb_byte(channel: f32) -> u8 {
    let c = f64::from(channel.clamp(0.0, 1.0));
    ((if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055 }) * 255.0 + 0.5) as u8
}
