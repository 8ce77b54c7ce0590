//! Channels as they are written to a picture and read from one. All functions take one channel of a linear colour.

use std::sync::LazyLock;

/// The 12-bit intensity of a channel, as the course writes it: clamped to [0, 1], times 4095, cut.
///
/// Returns 0 to 4095; NaN gives 0.
pub fn course12_intensity(channel: f32) -> u16 {
    (channel.clamp(0.0, 1.0) * 4095.0) as u16 // a NaN casts to 0
}

/// The byte of a channel, as the course writes it: the upper 8 of the 12 bits of [`course12_intensity`].
pub fn course12_byte(channel: f32) -> u8 {
    (course12_intensity(channel) >> 4) as u8
}

/// The least channel whose 12-bit intensity is `intensity`; intensities above 4095 count as 4095.
///
/// `intensity / 4095` alone falls short: times 4095 it may round below the integer, and cutting would lose one step.
pub fn course12_channel(intensity: u16) -> f32 {
    let intensity = intensity.min(4095);
    let mut channel = f32::from(intensity) / 4095.0;
    while course12_intensity(channel) < intensity {
        channel = channel.next_up();
    }
    channel
}

/// The sRGB byte of a linear channel, rounded to nearest; clamped to [0, 1] first, NaN gives 0.
///
/// Source: IEC 61966-2-1, the piecewise curve.
pub fn srgb_byte(channel: f32) -> u8 {
    static STEPS: LazyLock<SrgbSteps> = LazyLock::new(SrgbSteps::new);
    STEPS.byte(channel)
}

/// Where the sRGB byte of a channel changes, found once from the curve itself, as a power for each channel of a picture takes long.
struct SrgbSteps {
    /// The least channel of each byte; beyond the last, infinity.
    least: [f32; 257],
    /// The byte of the least channel among those whose bits agree in all but the lower [`Self::LOWER`]. So few hold one step at most.
    bytes: Vec<u8>,
}

impl SrgbSteps {
    const LOWER: u32 = 16;

    fn new() -> Self {
        // The bits of numbers from 0 to 1 are in the order of the numbers.
        let one = 1.0f32.to_bits();
        let mut least = [0.0; 257];
        for byte in 1..=255 {
            let (mut below, mut reached) = (0, one);
            while reached - below > 1 {
                let middle = below + (reached - below) / 2;
                if Self::by_curve(f32::from_bits(middle)) < byte { below = middle } else { reached = middle }
            }
            least[usize::from(byte)] = f32::from_bits(reached);
        }
        least[256] = f32::INFINITY;
        let bytes = (0..=one >> Self::LOWER).map(|upper| Self::by_curve(f32::from_bits(upper << Self::LOWER))).collect();
        Self { least, bytes }
    }

    fn byte(&self, channel: f32) -> u8 {
        // No NaN, and no -0, is above 0.
        let channel = if channel > 0.0 { channel.min(1.0) } else { 0.0 };
        let byte = self.bytes[channel.to_bits() as usize >> Self::LOWER];
        byte + u8::from(channel >= self.least[usize::from(byte) + 1])
    }

    /// The byte of a channel from 0 to 1.
    fn by_curve(channel: f32) -> u8 {
        // Truncating x + 1/2 rounds to nearest as x is not negative.
        (srgb_from_linear(channel) * 255.0 + 0.5) as u8
    }
}

/// The linear channel, in [0, 1], of an sRGB byte.
pub fn linear_from_srgb_byte(byte: u8) -> f32 {
    linear_from_srgb(f64::from(byte) / 255.0) as f32
}

/// The sRGB curve: linear to encoded, [0, 1] to [0, 1]. Computed in f64 by `libm`, so that every machine gives the same bits.
pub fn srgb_from_linear(channel: f32) -> f32 {
    let c = f64::from(channel);
    (if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055 }) as f32
}

/// The sRGB curve backwards: encoded to linear, [0, 1] to [0, 1]. In f64, as samples of 16 bits are too fine to be rounded twice.
///
/// Source: IEC 61966-2-1: c / 12.92 up to 0.04045, then ((c + 0.055) / 1.055)^2.4.
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_12_bit_intensity_comes_back_from_its_channel() {
        for intensity in 0..=4095 {
            let channel = course12_channel(intensity);
            assert_eq!(course12_intensity(channel), intensity);
            assert!(intensity == 0 || course12_intensity(channel.next_down()) < intensity);
        }
        assert_eq!(course12_channel(u16::MAX), 1.0);
    }

    #[test]
    fn course_bytes_are_cut_not_rounded() {
        assert_eq!(course12_byte(1.0), 255);
        assert_eq!(course12_byte(16.0 / 4095.0), 1);
        assert_eq!(course12_byte((16.0f32 / 4095.0).next_down()), 0);
        assert_eq!((course12_byte(-1.0), course12_byte(7.0), course12_byte(f32::NAN)), (0, 255, 0));
    }

    #[test]
    fn every_srgb_byte_survives_the_round_trip() {
        for byte in 0..=255 {
            assert_eq!(srgb_byte(linear_from_srgb_byte(byte)), byte);
        }
        assert_eq!((srgb_byte(-1.0), srgb_byte(2.0), srgb_byte(f32::NAN)), (0, 255, 0));
    }

    #[test]
    fn srgb_bytes_are_those_of_the_curve() {
        let steps = SrgbSteps::new();
        // Beside every step, and at the ends of what one entry of the table stands for.
        let ends = (0..=1.0f32.to_bits() >> SrgbSteps::LOWER).map(|upper| f32::from_bits(upper << SrgbSteps::LOWER));
        for channel in steps.least[..256].iter().copied().chain(ends) {
            for channel in [channel.next_down(), channel, channel.next_up()].map(|c| c.clamp(0.0, 1.0)) {
                assert_eq!(srgb_byte(channel), SrgbSteps::by_curve(channel), "{channel}");
            }
        }
        assert_eq!(srgb_byte(-0.0), 0);
    }

    #[test]
    fn srgb_meets_known_points_of_the_curve() {
        assert_eq!(srgb_byte(0.5), 188);
        assert_eq!(srgb_byte(0.18), 118);
        assert!((linear_from_srgb_byte(128) - 0.215_860_5).abs() < 1e-7);
        assert_eq!((linear_from_srgb_byte(0), linear_from_srgb_byte(255)), (0.0, 1.0));
    }
}
