//! The hits format: what each ray found, 16 bytes a ray, little-endian, no header.
//!
//! f32 T-value (infinity for a miss), u32 triangle (0xffffffff for a miss), f32 u, f32 v. A T-buffer is this format, one hit a
//! pixel, row-major, row 0 on top.

use gz_core::{Hit, NO_TRI};

/// Bytes of one hit.
pub const HIT_BYTES: usize = 16;

/// `hits` in the hits format.
pub fn encode(hits: &[Hit]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(hits.len() * HIT_BYTES);
    for hit in hits {
        bytes.extend(hit.t.to_le_bytes());
        bytes.extend(hit.tri.to_le_bytes());
        bytes.extend(hit.u.to_le_bytes());
        bytes.extend(hit.v.to_le_bytes());
    }
    bytes
}

/// The hits of a file in the hits format, bits kept.
///
/// # Errors
///
/// What is wrong, in a few words: a length that is not a whole number of hits, or a T-value of a hit that is NaN.
pub fn decode(bytes: &[u8]) -> Result<Vec<Hit>, String> {
    if !bytes.len().is_multiple_of(HIT_BYTES) {
        return Err(format!("{} bytes are not a whole number of hits of {HIT_BYTES} bytes", bytes.len()));
    }
    let hit = |(i, b): (usize, &[u8])| {
        let word = |k: usize| [b[k], b[k + 1], b[k + 2], b[k + 3]];
        let float = |k: usize| f32::from_le_bytes(word(k));
        let hit = Hit { t: float(0), tri: u32::from_le_bytes(word(4)), u: float(8), v: float(12) };
        if hit.tri != NO_TRI && hit.t.is_nan() { Err(format!("hit {i} has a T-value that is not a number")) } else { Ok(hit) }
    };
    bytes.chunks_exact(HIT_BYTES).enumerate().map(hit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_come_back_with_their_bits() {
        let hits = [Hit::MISS, Hit { t: -0.0, tri: 7, u: 0.25, v: f32::from_bits(1) }];
        let bytes = encode(&hits);
        assert_eq!(bytes.len(), 2 * HIT_BYTES);
        assert_eq!(bytes[..8], [0, 0, 0x80, 0x7f, 0xff, 0xff, 0xff, 0xff]);
        let back = decode(&bytes).unwrap();
        assert_eq!(back, hits);
        assert_eq!(back[1].t.to_bits(), (-0.0f32).to_bits());
    }

    #[test]
    fn a_cut_file_is_refused() {
        assert_eq!(decode(&[0; 17]).unwrap_err(), "17 bytes are not a whole number of hits of 16 bytes");
    }
}
