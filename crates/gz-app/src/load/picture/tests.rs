//! Pictures made here, byte by byte or by the image crate's encoders, and read back.

use super::super::testing::{Scratch, course_data, mutated};
use super::*;
use image::{ImageBuffer, Luma, LumaA, Rgb, Rgba};

const RAW: fn(&[u8]) -> Result<ImageTexture, String> = |bytes| parse(bytes, TextureLookup::Homework, false, false);

fn ppm(header: &str, samples: &[u8]) -> Vec<u8> {
    [header.as_bytes(), samples].concat()
}

fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

#[test]
fn ppm_samples_are_divided_by_255() {
    let texture = RAW(&ppm("P6\n# made here\n2 1\r255\n", &[0, 51, 255, 1, 2, 3])).unwrap();
    assert_eq!((texture.width, texture.height, texture.lookup), (2, 1, TextureLookup::Homework));
    assert_eq!(texture.texels[0], GzColor::new(0.0, 0.2, 1.0));
    assert_eq!(texture.texels[1], GzColor::new(1.0 / 255.0, 2.0 / 255.0, 3.0 / 255.0));
}

#[test]
fn srgb_samples_are_decoded_by_the_exact_curve() {
    let texture = parse(&ppm("P6 2 1 255\n", &[0, 10, 11, 128, 188, 255]), TextureLookup::Repeat, true, false).unwrap();
    let [low, high] = [texture.texels[0], texture.texels[1]];
    assert_eq!((low.x, low.y, high.z), (0.0, (10.0f64 / 255.0 / 12.92) as f32, 1.0));
    // By hand: ((11 / 255 + 0.055) / 1.055)^2.4, and so on.
    for (value, expected) in [(low.z, 0.003_346_536), (high.x, 0.215_860_5), (high.y, 0.502_886_5)] {
        assert!((value - expected).abs() < 1e-7, "{value} for {expected}");
    }
}

#[test]
fn every_kind_of_sample_becomes_a_colour() {
    let png = |picture: DynamicImage| RAW(&encoded(picture, ImageFormat::Png)).unwrap().texels;
    let one = GzColor::new(1.0, 0.2, 0.0);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, Luma([51u8])).into()), [GzColor::splat(0.2)]);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, LumaA([51u8, 7])).into()), [GzColor::splat(0.2)]);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, Rgb([255u8, 51, 0])).into()), [one]);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, Rgba([255u8, 51, 0, 0])).into()), [one]);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, Luma([13107u16])).into()), [GzColor::splat(0.2)]);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, LumaA([13107u16, 9])).into()), [GzColor::splat(0.2)]);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, Rgb([65535u16, 13107, 0])).into()), [one]);
    assert_eq!(png(ImageBuffer::from_pixel(1, 1, Rgba([65535u16, 13107, 0, 1])).into()), [one]);
    let jpeg = RAW(&encoded(ImageBuffer::from_pixel(8, 8, Rgb([255u8, 51, 0])), ImageFormat::Jpeg)).unwrap();
    assert!(jpeg.texels.iter().all(|texel| texel.distance(one) < 0.03), "{}", jpeg.texels[0]);
    assert_eq!(RAW(b"P5 1 1 255\n\x33").unwrap().texels, [GzColor::splat(0.2)]);
    assert_eq!(RAW(b"P5 1 1 15\n\x03").unwrap().texels, [GzColor::splat(0.2)]);
    assert_eq!(RAW(b"P5 1 1 65535\n\x33\x33").unwrap().texels, [GzColor::splat(0.2)]);
    assert_eq!(RAW(b"P1 2 1 1 0").unwrap().texels, [GzColor::ZERO, GzColor::ONE]);
}

#[test]
fn a_palette_becomes_its_colours() {
    // One row of two pixels, one bit each: the second colour, then the first. Check sums are those of the format.
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        png.extend((data.len() as u32).to_be_bytes());
        let body = [kind, data].concat();
        let crc = body.iter().fold(!0u32, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 })
        });
        png.extend(body);
        png.extend((!crc).to_be_bytes());
    };
    chunk(b"IHDR", &[0, 0, 0, 2, 0, 0, 0, 1, 1, 3, 0, 0, 0]);
    chunk(b"PLTE", &[255, 0, 0, 0, 51, 255]);
    // A stored zlib block of the filter byte and the pixels, then its Adler-32.
    chunk(b"IDAT", &[0x78, 0x01, 1, 2, 0, 0xfd, 0xff, 0, 0b1000_0000, 0, 0x82, 0, 0x81]);
    chunk(b"IEND", &[]);
    assert_eq!(RAW(&png).unwrap().texels, [GzColor::new(0.0, 0.2, 1.0), GzColor::new(1.0, 0.0, 0.0)]);
}

#[test]
fn the_course_shift_moves_every_texel_one_place() {
    let samples: Vec<u8> = (0..12).map(|k| k * 20).collect();
    let file = ppm("P6\n2 2\n255\n", &samples);
    let plain = RAW(&file).unwrap();
    let shifted = parse(&file, TextureLookup::Homework, false, true).unwrap();
    assert_eq!(shifted.texels[0], GzColor::new(53.0, 53.0, 10.0) / 255.0);
    assert_eq!(shifted.texels[1..], plain.texels[..3]);
}

#[test]
fn the_course_shift_follows_the_bytes_of_any_header() {
    // One digit leaves only the line end over, so that even the channels move.
    let shifted = parse(&ppm("P6 1 1 9\r", &[1, 2, 3]), TextureLookup::Homework, false, true).unwrap();
    assert_eq!(shifted.texels, [GzColor::new(13.0, 1.0, 2.0) / 255.0]);
}

#[test]
fn the_course_shift_refuses_what_the_loader_cannot_read() {
    let error = |bytes: &[u8]| parse(bytes, TextureLookup::Homework, false, true).unwrap_err();
    assert_eq!(error(b"P5 1 1 255\n0"), "the course's shift of a texture needs a P6 picture");
    assert_eq!(error(b"P6 # note\n1 1 255\n000"), r##"a damaged P6 header: "#" is not a size"##);
    assert_eq!(error(b"P6 2 2 255\n0000"), "cut short: 2 x 2 pixels need 12 bytes, 7 are there");
}

#[test]
fn pictures_without_pixels_are_refused() {
    for (size, expected) in [("0 0", "0 x 0"), ("1 0", "1 x 0"), ("0 1", "0 x 1")] {
        for shift in [false, true] {
            let message = parse(&ppm(&format!("P6 {size} 255\n"), b"      "), TextureLookup::Repeat, false, shift).unwrap_err();
            assert_eq!(message, format!("empty texture: {expected} pixels"));
        }
    }
}

#[test]
fn huge_headers_are_refused_before_memory_is_taken() {
    for shift in [false, true] {
        let error = |header: &[u8]| parse(header, TextureLookup::Repeat, false, shift).unwrap_err();
        assert_eq!(error(b"P6 60000 60000 255\n"), "60000 x 60000 pixels: at most 16384 on a side");
        assert_eq!(error(b"P6 16384 16384 255\n"), "16384 x 16384 pixels take 805306368 bytes: at most 268435456");
    }
}

#[test]
fn damaged_pictures_are_errors_of_one_line_that_name_the_file() {
    let scratch = Scratch::new();
    let read = |name: &str, bytes: &[u8]| {
        let path = scratch.write(name, bytes);
        texture(&path, TextureLookup::Repeat, true, false).unwrap_err()
    };
    let whole = encoded(ImageBuffer::from_fn(20, 20, |x, y| Rgb([x as u8 * 9, y as u8 * 7, 3])), ImageFormat::Png);
    for (name, bytes) in [
        ("cut.ppm", &b"P6 2 2 255\n00000"[..]),
        ("zero.ppm", b"P6 1 1 0\n000"),
        ("big.ppm", b"P6 1 1 65536\n000000"),
        ("sample.ppm", b"P3 1 1 255\n1 2 999"),
        ("cut.png", &whole[..whole.len() / 2]),
    ] {
        let error = read(name, bytes);
        assert!(!error.io && error.message.starts_with("a damaged or unsupported P"), "{name}: {error}");
        assert!(error.to_string().contains(name) && !error.to_string().contains('\n'), "{name}: {error}");
    }
    assert_eq!(read("words.png", b"hello").message, "not a PNG, JPEG or PPM picture");
    assert_eq!(read("empty.png", b"").message, "not a PNG, JPEG or PPM picture");
    let missing = texture(&scratch.path().join("none.png"), TextureLookup::Repeat, true, false).unwrap_err();
    assert_eq!((missing.io, missing.message.as_str()), (true, "no such file"));
}

#[test]
fn random_changes_never_panic() {
    let picture = || ImageBuffer::from_fn(6, 5, |x, y| Rgb([x as u8 * 40, y as u8 * 50, 128u8]));
    let seeds = [
        ppm("P6\n6 5\n255\n", &picture()),
        b"P3 2 1 255 1 2 3 4 5 6".to_vec(),
        encoded(picture(), ImageFormat::Png),
        encoded(picture(), ImageFormat::Jpeg),
    ];
    let mut state = 6;
    let mut read = 0;
    for round in 0..4000 {
        let bytes = mutated(&seeds[round % seeds.len()], b"0123456789 \n#P\x00\xff", &mut state);
        for shift in [false, true] {
            if let Ok(texture) = parse(&bytes, TextureLookup::Repeat, true, shift) {
                assert_eq!(texture.texels.len(), texture.width as usize * texture.height as usize);
                read += 1;
            }
        }
    }
    assert!((1..8000).contains(&read), "{read} of 8000 were still pictures");
}

#[test]
fn the_course_texture_is_read_plain_and_shifted() {
    let Some(data) = course_data() else { return };
    let file = data.join("texture.ppm");
    let plain = texture(&file, TextureLookup::Homework, false, false).unwrap();
    let shifted = texture(&file, TextureLookup::Homework, false, true).unwrap();
    assert_eq!([plain.width, plain.height, shifted.width, shifted.height], [98, 109, 98, 109]);
    assert_eq!(shifted.texels[0], GzColor::new(53.0, 53.0, 10.0) / 255.0);
    assert_eq!(shifted.texels[1..], plain.texels[..98 * 109 - 1]);
    for reference in ["ref/hw6.ppot.texture.aa.ppm", "ref/hw5.ppot.texture.perspective.ppm", "paper/reflection.ppm"] {
        let picture = texture(&data.join(reference), TextureLookup::Homework, false, false).unwrap();
        assert_eq!((picture.width, picture.texels.len()), (256, 65536), "{reference}");
    }
}
