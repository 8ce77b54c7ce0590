//! Draws the textures in assets/textures: `cargo run --release -p gz-app --example make_textures [FOLDER]`.
//!
//! Both are made of distances to simple shapes and of value noise, with + - * / and square root alone, so every machine writes the
//! same pixels. They repeat in both directions.

use glam::{Vec2, Vec3};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{Rgb, RgbImage};

fn main() {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "assets/textures".to_owned());
    for (name, size, color) in
        [("porcelain.png", 512, porcelain as fn(Vec2) -> Vec3), ("stone.png", 384, stone as fn(Vec2) -> Vec3)]
    {
        let path = std::path::Path::new(&folder).join(name);
        match save(&draw(size, color), &path) {
            Ok(()) => println!("{}", path.display()),
            Err(error) => {
                eprintln!("{}: {error}", path.display());
                std::process::exit(1);
            }
        }
    }
}

/// Writes a PNG as small as the encoder can.
fn save(picture: &RgbImage, path: &std::path::Path) -> image::ImageResult<()> {
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    picture.write_with_encoder(PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive))
}

/// A picture of `color` over the unit square, sixteen samples a pixel, colours as sRGB values in 0 to 1.
fn draw(size: u32, color: fn(Vec2) -> Vec3) -> RgbImage {
    RgbImage::from_fn(size, size, |i, j| {
        let mut sum = Vec3::ZERO;
        for k in 0..16u32 {
            let offset = Vec2::new((k % 4) as f32 + 0.5, (k / 4) as f32 + 0.5) / 4.0;
            sum += color((Vec2::new(i as f32, j as f32) + offset) / size as f32);
        }
        // Steps of two keep the file small and cannot be seen.
        Rgb((sum / 16.0).to_array().map(|c| ((c.clamp(0.0, 1.0) * 127.0 + 0.5) as u8) * 2))
    })
}

/// Glazed white with cobalt ornament: two medallions across, bands above and below, a thread of gold where patches meet.
fn porcelain(at: Vec2) -> Vec3 {
    let glaze = Vec3::new(0.965, 0.957, 0.925);
    let wash = Vec3::new(0.60, 0.71, 0.87);
    let cobalt = Vec3::new(0.06, 0.15, 0.46);
    let gold = Vec3::new(0.78, 0.58, 0.24);

    // One half of the square, mirrored about its middle: x to the side, y up and down, both 0 in the medallion's middle. A patch of
    // the teapot's body is nearly twice as wide as it is high; two halves side by side keep circles round there.
    let p = Vec2::new((((at.x * 2.0).fract() - 0.5) * 0.92).abs(), (at.y - 0.5).abs());
    let ink = medallion(p).over(spray(p)).over(band(at.x, p.y));

    // The brush held more or less paint.
    let paint = 0.80 + 0.20 * noise(at, 7) + 0.12 * (noise(at, 31) - 0.5);
    let mut color = glaze + (wash - glaze) * (ink.wash * (0.55 + 0.45 * noise(at + 0.37, 9)));
    color += (cobalt - color) * (ink.line * paint).min(1.0);
    color + (gold - color) * line((p.y - 0.492).abs(), 0.008)
}

/// How much of each paint lies at a place, 0 to 1: the thin wash and the strong line.
#[derive(Clone, Copy, Default)]
struct Ink {
    wash: f32,
    line: f32,
}

impl Ink {
    /// A filled shape with an outline, from its signed distance (negative inside).
    fn shape(distance: f32, width: f32) -> Self {
        Self { wash: f32::from(distance < 0.0), line: line(distance.abs(), width) }
    }

    fn over(self, below: Self) -> Self {
        Self { wash: self.wash.max(below.wash), line: self.line.max(below.line) }
    }
}

/// 1 within `width` of a line's middle, 0 beyond, with an edge as soft as the glaze makes it.
fn line(distance: f32, width: f32) -> f32 {
    1.0 - smooth(((distance - 0.6 * width) / (0.6 * width)).clamp(0.0, 1.0))
}

fn smooth(x: f32) -> f32 {
    x * x * (3.0 - 2.0 * x)
}

/// Turned by the angle of this cosine and sine.
fn turned(p: Vec2, cos: f32, sin: f32) -> Vec2 {
    Vec2::new(p.x * cos + p.y * sin, p.y * cos - p.x * sin)
}

/// Signed distance to a petal: the part common to two circles, from `root` to `tip` along x, at its widest `width` across.
fn petal(p: Vec2, root: f32, tip: f32, width: f32) -> f32 {
    let (half, middle) = ((tip - root) / 2.0, (tip + root) / 2.0);
    // The circles through both ends that bulge by half the width.
    let bulge = width / 2.0;
    let radius = (half * half + bulge * bulge) / (2.0 * bulge);
    let q = Vec2::new(p.x - middle, p.y.abs() + radius - bulge);
    q.length() - radius
}

const COS_22: f32 = 0.923_879_5;
const SIN_22: f32 = 0.382_683_4;
const COS_45: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// The middle: a rosette of two rings of eight petals within two circles and a ring of beads.
fn medallion(p: Vec2) -> Ink {
    let r = p.length();
    if r > 0.35 {
        return Ink::default();
    }
    // Fold the plane into one eighth, then into half of that: a petal lies along x, another along its border.
    let p = if p.y > p.x { Vec2::new(p.y, p.x) } else { p };
    let inner = Ink::shape(petal(p, 0.03, 0.17, 0.058), 0.0042)
        .over(Ink::shape(petal(turned(p, COS_45, COS_45), 0.03, 0.17, 0.058), 0.0042));
    let between = turned(p, COS_22, SIN_22);
    let outer = Ink::shape(petal(between, 0.085, 0.235, 0.066), 0.0042);
    let vein = line(between.y.abs(), 0.002) * f32::from((0.12..0.20).contains(&between.x));
    let heart = Ink { wash: 0.0, line: line(r, 0.026).max(line((r - 0.036).abs(), 0.003)) };
    // Thirty-two beads: fold twice more.
    let folded = turned(Vec2::new(between.x, between.y.abs()), 0.980_785_3, 0.195_090_3);
    let bead = line((Vec2::new(folded.x - 0.284, folded.y.abs()) - Vec2::new(0.0, 0.0277)).length(), 0.0105);
    let circles = line((r - 0.262).abs(), 0.0035).max(line((r - 0.306).abs(), 0.0035)).max(line((r - 0.330).abs(), 0.0105));
    let flower = Ink { line: inner.line.max(outer.line).max(vein), wash: inner.wash.max(outer.wash) };
    Ink { wash: flower.wash, line: flower.line.max(heart.line).max(bead).max(circles) }
}

/// Between medallions: a stem with leaves, and a bud to each side.
fn spray(p: Vec2) -> Ink {
    if p.length() < 0.345 || p.y > 0.40 {
        return Ink::default();
    }
    // From the border of the half tile, where its mirror image joins it.
    let q = Vec2::new(0.46 - p.x, p.y);
    let stem = line(q.x, 0.004) * f32::from(q.y < 0.31);
    let bud = Ink::shape(petal(Vec2::new(q.y, q.x), 0.27, 0.385, 0.062), 0.004);
    let bloom = Ink::shape(petal(turned(Vec2::new(q.y - 0.265, q.x), 0.80, 0.60), 0.0, 0.105, 0.036), 0.0038);
    let small = Ink::shape(petal(turned(Vec2::new(q.y - 0.265, q.x), 0.28, 0.96), 0.0, 0.075, 0.030), 0.0034);
    let leaf = Ink::shape(petal(turned(Vec2::new(q.y - 0.03, q.x), 0.86, 0.51), 0.0, 0.14, 0.040), 0.0036);
    let rise = Ink::shape(petal(turned(Vec2::new(q.y - 0.14, q.x), 0.80, 0.60), 0.0, 0.12, 0.036), 0.0036);
    let knot = Ink { wash: 0.0, line: line(q.length(), 0.020) };
    bud.over(bloom).over(small).over(leaf).over(rise).over(knot).over(Ink { wash: 0.0, line: stem })
}

/// The bands at both ends: lines, and scallops with a dot in each, sixteen a square.
fn band(x: f32, y: f32) -> Ink {
    if y < 0.40 {
        return Ink::default();
    }
    let cell = ((x * 16.0).fract() - 0.5) / 16.0 * 1.84;
    let scallop = Vec2::new(cell, y - 0.462).length();
    let arch = Ink::shape(scallop - 0.048, 0.0045);
    let arch = if y < 0.462 { arch } else { Ink::default() };
    let dot = line((Vec2::new(cell, y - 0.446)).length(), 0.0135);
    let lines = line((y - 0.464).abs(), 0.0045).max(line((y - 0.4785).abs(), 0.0075));
    Ink { wash: arch.wash, line: arch.line.max(dot).max(lines) }
}

/// Four slabs of stone, two light and two dark, with veins and joints.
fn stone(at: Vec2) -> Vec3 {
    let slab = (at * 2.0).floor();
    let dark = (slab.x + slab.y) as i32 % 2 == 1;
    let within = (at * 2.0).fract();
    // The grain of the dark slabs runs across that of the light ones.
    let block = if dark { Vec2::new(at.y, at.x) } else { at };
    let warp = Vec2::new(cloud(block + 0.13), cloud(block + 0.71)) - 0.5;
    let clouds = cloud(block + warp * 0.12) - 0.5;
    let vein = vein(block + warp * 0.30, 5, 9.0) + 0.6 * vein(block + warp * 0.42 + 0.29, 8, 12.0);
    let color = if dark {
        Vec3::new(0.20, 0.255, 0.30) + Vec3::new(0.20, 0.21, 0.21) * clouds + Vec3::new(0.34, 0.33, 0.30) * vein
    } else {
        Vec3::new(0.87, 0.845, 0.79) + Vec3::new(0.16, 0.17, 0.19) * clouds - Vec3::new(0.26, 0.25, 0.22) * vein
    };
    let edge = (0.5 - (within - 0.5).abs()).min_element();
    let joint = smooth((edge / 0.008).clamp(0.0, 1.0));
    Vec3::new(0.36, 0.34, 0.31) + (color - Vec3::new(0.36, 0.34, 0.31)) * joint
}

/// Soft patches of several sizes, 0 to 1.
fn cloud(at: Vec2) -> f32 {
    0.46 * noise(at, 4) + 0.27 * noise(at, 9) + 0.16 * noise(at, 19) + 0.11 * noise(at, 41)
}

/// Thin curves that swell, thin out and end: 0 to 1.
fn vein(at: Vec2, cells: i32, sharpness: f32) -> f32 {
    let curve = 1.0 - ((noise(at, cells) - 0.5).abs() * sharpness).min(1.0);
    let strength = smooth(((noise(at + 0.53, cells + 2) - 0.35) * 2.2).clamp(0.0, 1.0));
    curve * curve * curve * strength
}

/// Value noise that repeats with the unit square: `cells` random values a side, joined smoothly. In 0 to 1.
fn noise(at: Vec2, cells: i32) -> f32 {
    let p = at * cells as f32;
    let (low, part) = (p.floor(), p - p.floor());
    let value = |dx: i32, dy: i32| {
        random((low.x as i32 + dx).rem_euclid(cells) as u32, (low.y as i32 + dy).rem_euclid(cells) as u32, cells as u32)
    };
    let (x, y) = (smooth(part.x), smooth(part.y));
    let (top, bottom) = (value(0, 0) * (1.0 - x) + value(1, 0) * x, value(0, 1) * (1.0 - x) + value(1, 1) * x);
    top * (1.0 - y) + bottom * y
}

/// A number in 0 to 1 that looks unrelated for every `x`, `y` and `series`.
fn random(x: u32, y: u32, series: u32) -> f32 {
    let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ series.wrapping_mul(0xc2b2_ae3d);
    for _ in 0..3 {
        h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    }
    (h >> 8) as f32 / 16_777_216.0
}
