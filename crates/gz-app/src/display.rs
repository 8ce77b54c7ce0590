//! HW1: the homework's frame buffer, pixels of 12-bit intensities, and its two flushes.

use std::io::{self, Write};

/// Greatest width and height, the course's `MAXXRES` and `MAXYRES`.
pub const MAX_RESOLUTION: u16 = 1024;

/// Greatest intensity: 12 bits.
pub const MAX_INTENSITY: i16 = 4095;

/// One pixel of a display, the homework's `GzPixel`. (The ray tracer's own pixel, with a T-value for z, is `gz_core::GzPixel`.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DisplayPixel {
    /// Red, 0 to 4095.
    pub red: i16,
    /// Green, 0 to 4095.
    pub green: i16,
    /// Blue, 0 to 4095.
    pub blue: i16,
    /// Opacity, 0 to 4095. Stored and clamped, never used.
    pub alpha: i16,
    /// Depth: smaller is nearer.
    pub z: i32,
}

impl DisplayPixel {
    /// A pixel of this colour, opaque and in front of everything.
    pub fn of(red: i16, green: i16, blue: i16) -> Self {
        Self { red, green, blue, alpha: MAX_INTENSITY, z: 0 }
    }

    fn clamped(self) -> Self {
        let clamp = |x: i16| x.clamp(0, MAX_INTENSITY);
        Self { red: clamp(self.red), green: clamp(self.green), blue: clamp(self.blue), alpha: clamp(self.alpha), z: self.z }
    }
}

/// The homework's `GzDisplay`: `width * height` pixels, row-major, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GzDisplay {
    width: u16,
    height: u16,
    pixels: Vec<DisplayPixel>,
}

/// A display with a side that is 0 or above [`MAX_RESOLUTION`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a display has 1 to 1024 pixels a side, not {width} x {height}")]
pub struct DisplayError {
    /// The width asked for.
    pub width: u16,
    /// The height asked for.
    pub height: u16,
}

impl GzDisplay {
    /// A display cleared to black at the greatest depth. The homework's `GzNewDisplay`.
    ///
    /// # Errors
    ///
    /// If a side is 0 or above [`MAX_RESOLUTION`].
    pub fn new(width: u16, height: u16) -> Result<Self, DisplayError> {
        if !(1..=MAX_RESOLUTION).contains(&width) || !(1..=MAX_RESOLUTION).contains(&height) {
            return Err(DisplayError { width, height });
        }
        let clear = DisplayPixel { red: 0, green: 0, blue: 0, alpha: MAX_INTENSITY, z: i32::MAX };
        Ok(Self { width, height, pixels: vec![clear; usize::from(width) * usize::from(height)] })
    }

    /// Width in pixels.
    pub fn width(&self) -> u16 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u16 {
        self.height
    }

    /// Clears every pixel to this colour at the greatest depth. The homework's `GzDefault`, whose colour is free.
    pub fn clear(&mut self, red: i16, green: i16, blue: i16) {
        self.pixels.fill(DisplayPixel { z: i32::MAX, ..DisplayPixel::of(red, green, blue) }.clamped());
    }

    /// Writes the pixel in column `i` and row `j`, its intensities clamped to 0..=4095. The homework's `GzPut`.
    ///
    /// Off the screen nothing happens: an application may draw past the edges. There is no depth test here; HW2's rasteriser did it
    /// before the call, and the ray tracer keeps the least T-value instead.
    pub fn put(&mut self, i: i32, j: i32, pixel: DisplayPixel) {
        if let Some(k) = self.index(i, j) {
            self.pixels[k] = pixel.clamped();
        }
    }

    /// The pixel in column `i` and row `j`; `None` off the screen. The homework's `GzGet`.
    pub fn get(&self, i: i32, j: i32) -> Option<DisplayPixel> {
        self.index(i, j).map(|k| self.pixels[k])
    }

    /// Writes a binary PPM, of each intensity the upper 8 of 12 bits. The homework's `GzFlushDisplay2File`, with its header.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn flush_to_file(&self, out: &mut impl Write) -> io::Result<()> {
        write!(out, "P6 {} {} 255\r", self.width, self.height)?;
        let bytes: Vec<u8> = self.pixels.iter().flat_map(|p| [p.red, p.green, p.blue].map(upper_bits)).collect();
        out.write_all(&bytes)
    }

    /// The picture for a window: three bytes a pixel in the order blue, green, red, rows from the top. The homework's
    /// `GzFlushDisplay2FrameBuffer`.
    pub fn flush_to_framebuffer(&self) -> Vec<u8> {
        self.pixels.iter().flat_map(|p| [p.blue, p.green, p.red].map(upper_bits)).collect()
    }

    fn index(&self, i: i32, j: i32) -> Option<usize> {
        let (i, j) = (u16::try_from(i).ok()?, u16::try_from(j).ok()?);
        (i < self.width && j < self.height).then(|| usize::from(j) * usize::from(self.width) + usize::from(i))
    }
}

/// The upper 8 of 12 bits.
fn upper_bits(intensity: i16) -> u8 {
    // Stored intensities are 0 to 4095.
    (intensity >> 4) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// HW1's application: a filled rectangle, both corners inclusive.
    fn rectangle(display: &mut GzDisplay, [ulx, uly, lrx, lry]: [i32; 4], pixel: DisplayPixel) {
        for j in uly..=lry {
            for i in ulx..=lrx {
                display.put(i, j, pixel);
            }
        }
    }

    fn count(display: &GzDisplay, pixel: DisplayPixel) -> usize {
        display.pixels.iter().filter(|&&p| p == pixel).count()
    }

    #[test]
    fn sizes_beyond_the_course_s_limit_are_refused() {
        for (width, height) in [(0, 5), (5, 0), (1025, 5), (5, 1025)] {
            assert_eq!(GzDisplay::new(width, height).unwrap_err(), DisplayError { width, height });
        }
        assert_eq!(GzDisplay::new(1024, 1).unwrap().width(), 1024);
    }

    #[test]
    fn puts_off_the_screen_are_ignored_and_intensities_clamped() {
        let mut display = GzDisplay::new(4, 3).unwrap();
        let before = display.clone();
        for (i, j) in [(-1, 0), (0, -1), (4, 0), (0, 3), (i32::MIN, i32::MAX), (65536, 0)] {
            display.put(i, j, DisplayPixel::of(1, 2, 3));
            assert_eq!(display.get(i, j), None);
        }
        assert_eq!(display, before);
        display.put(3, 2, DisplayPixel { alpha: 5000, ..DisplayPixel::of(-7, 4096, 2000) });
        let expected = DisplayPixel { red: 0, green: 4095, blue: 2000, alpha: 4095, z: 0 };
        assert_eq!(display.get(3, 2), Some(expected));
    }

    #[test]
    fn rectangles_include_both_corners_and_later_ones_cover_earlier() {
        let mut display = GzDisplay::new(16, 8).unwrap();
        let (red, blue) = (DisplayPixel::of(4095, 0, 0), DisplayPixel::of(0, 0, 5000));
        rectangle(&mut display, [2, 1, 5, 3], red);
        assert_eq!(count(&display, red), 12);
        rectangle(&mut display, [5, 3, 40, 90], blue);
        assert_eq!((count(&display, red), count(&display, blue.clamped())), (11, 11 * 5));
    }

    #[test]
    fn flushes_keep_the_upper_eight_bits_in_their_own_orders() {
        let mut display = GzDisplay::new(2, 1).unwrap();
        display.clear(16, 15, 4095);
        display.put(1, 0, DisplayPixel::of(0x123, 0xabc, 0x00f));
        let mut file = Vec::new();
        display.flush_to_file(&mut file).unwrap();
        assert_eq!(file, b"P6 2 1 255\r\x01\x00\xff\x12\xab\x00");
        assert_eq!(display.flush_to_framebuffer(), [255, 0, 1, 0, 0xab, 0x12]);
    }

    #[test]
    fn the_course_s_rectangles_show_where_no_later_one_covers_them() {
        let Some(folder) = std::env::var_os("GZ_HW_DATA") else {
            println!("skipped: GZ_HW_DATA is not set");
            return;
        };
        let text = std::fs::read_to_string(std::path::Path::new(&folder).join("rects.txt")).unwrap();
        let numbers: Vec<i32> = text.split_whitespace().map(|word| word.parse().unwrap()).collect();
        let rects: Vec<&[i32]> = numbers.chunks_exact(7).collect();
        let pixel = |r: &[i32]| DisplayPixel::of(r[4] as i16, r[5] as i16, r[6] as i16);
        let mut display = GzDisplay::new(512, 512).unwrap();
        for rect in &rects {
            rectangle(&mut display, [rect[0], rect[1], rect[2], rect[3]], pixel(rect));
        }
        assert!(
            rects.len() == 8
                && rects.iter().any(|r| r[0] < 0 || r[2] > 511)
                && rects.iter().any(|r| r[4..].iter().any(|&c| c > 4095))
        );
        // Asked from each pixel instead of drawn: the last rectangle that holds it.
        for (i, j) in (0..512).flat_map(|j| (0..512).map(move |i| (i, j))) {
            let last = rects.iter().rev().find(|r| (r[0]..=r[2]).contains(&i) && (r[1]..=r[3]).contains(&j));
            let got = display.get(i, j).unwrap();
            match last {
                Some(rect) => assert_eq!(got, pixel(rect).clamped(), "{i} {j}"),
                None => assert_eq!((got.red, got.green, got.blue, got.z), (0, 0, 0, i32::MAX), "{i} {j}"),
            }
        }
    }
}
