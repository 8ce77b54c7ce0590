//! The float picture format PFM: linear colours, three f32 a pixel.
//!
//! A text header `PF`, width and height, and a scale whose sign tells the byte order (negative: little-endian), then the rows from
//! the *bottom* of the picture upwards. We write little-endian with scale -1; both byte orders are read, the scale's size is not
//! applied. Colours are neither clamped nor encoded, so values above 1 are kept.

use gz_core::GzColor;

/// `colors` (`width` a row, row 0 on top) as a PFM file.
pub fn encode(width: u32, colors: &[GzColor]) -> Vec<u8> {
    let height = if width == 0 { 0 } else { colors.len() / width as usize };
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    bytes.reserve(colors.len() * 12);
    for row in colors.chunks_exact(width.max(1) as usize).rev() {
        bytes.extend(row.iter().flat_map(|c| c.to_array()).flat_map(f32::to_le_bytes));
    }
    bytes
}

/// Width, height and colours (row 0 on top) of a PFM file.
///
/// # Errors
///
/// What is wrong with the file, in a few words.
pub fn decode(bytes: &[u8]) -> Result<(u32, u32, Vec<GzColor>), String> {
    let mut rest = bytes;
    if word(&mut rest) != Some("PF") {
        return Err("not a colour PFM file: it does not begin with PF".to_owned());
    }
    let size = |text: Option<&str>| text.and_then(|t| t.parse::<u32>().ok()).filter(|&n| n > 0);
    let (Some(width), Some(height)) = (size(word(&mut rest)), size(word(&mut rest))) else {
        return Err("PFM width or height is not a whole number above 0".to_owned());
    };
    let Some(scale) = word(&mut rest).and_then(|t| t.parse::<f32>().ok()).filter(|s| *s != 0.0) else {
        return Err("PFM scale is not a number other than 0".to_owned());
    };
    let wanted = (u64::from(width) * u64::from(height)).checked_mul(12);
    if wanted != u64::try_from(rest.len()).ok() {
        return Err(format!("PFM holds {} bytes of pixels, {width}x{height} needs another number", rest.len()));
    }
    let number = |b: &[u8]| {
        let b = [b[0], b[1], b[2], b[3]];
        if scale < 0.0 { f32::from_le_bytes(b) } else { f32::from_be_bytes(b) }
    };
    let row_bytes = width as usize * 12;
    let pixels = rest.chunks_exact(row_bytes).rev().flat_map(|row| row.chunks_exact(12));
    let colors = pixels.map(|p| GzColor::new(number(&p[0..4]), number(&p[4..8]), number(&p[8..12]))).collect();
    Ok((width, height, colors))
}

/// The next word of the header and the one white space behind it, taken off `rest`.
fn word<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    let end = rest.iter().position(u8::is_ascii_whitespace)?;
    let (word, behind) = (&rest[..end], &rest[end + 1..]);
    *rest = behind;
    std::str::from_utf8(word).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_comes_back_and_the_bottom_row_is_first_in_the_file() {
        let colors: Vec<GzColor> = (0..6).map(|i| GzColor::new(i as f32, -0.0, f32::MAX)).collect();
        let bytes = encode(2, &colors);
        assert!(bytes.starts_with(b"PF\n2 3\n-1.0\n"));
        assert_eq!(bytes[12..16], 4.0f32.to_le_bytes());
        assert_eq!(decode(&bytes), Ok((2, 3, colors)));
    }

    #[test]
    fn big_endian_is_read() {
        let mut bytes = b"PF\n1 1\n1.0\n".to_vec();
        bytes.extend([0.25f32, 0.5, 0.75].iter().flat_map(|c| c.to_be_bytes()));
        assert_eq!(decode(&bytes), Ok((1, 1, vec![GzColor::new(0.25, 0.5, 0.75)])));
    }

    #[test]
    fn a_damaged_file_is_refused() {
        let good = encode(2, &[GzColor::ONE; 4]);
        assert!(decode(&good[..good.len() - 1]).is_err());
        for bad in [
            &b""[..],
            b"P6\n1 1\n255\nabc",
            b"PF\n0 1\n-1\n",
            b"PF\n1 x\n-1\n",
            b"PF\n1 1\n0\n",
            b"PF\n4294967295 4294967295\n-1\n",
        ] {
            assert!(decode(bad).is_err(), "{bad:?}");
        }
    }
}
