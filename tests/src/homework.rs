//! Our pictures against the course's reference pictures and the paper's two figures.

use crate::rendered::{Rendered, render};
use gz_app::error::LoadError;
use gz_core::GzRay;
use gz_core::{BruteForce, RayQuery};
use std::path::{Path, PathBuf};

/// One line of the table.
#[derive(Debug)]
pub struct Row {
    /// What is compared.
    pub name: String,
    /// What was measured, in words.
    pub measured: String,
    /// What it must be, in words; empty for a figure that is only printed.
    pub required: String,
    /// Whether it is.
    pub holds: bool,
}

/// A reference picture: 256 by 256, three bytes a pixel.
struct Reference {
    rgb: Vec<u8>,
}

const SIZE: usize = 256;

impl Reference {
    /// Reads a P6 file of this size, whatever white space its header has and whatever follows its pixels.
    fn read(path: &Path) -> Result<Self, LoadError> {
        let bytes = std::fs::read(path).map_err(|error| LoadError::io(path, &error))?;
        let mut rest = &bytes[..];
        let mut words = Vec::new();
        while words.len() < 4 {
            let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
            let end = rest[start..].iter().position(u8::is_ascii_whitespace).map_or(rest.len(), |n| start + n);
            if start == end {
                return Err(LoadError::bad(path, None, "the header ends early"));
            }
            words.push(String::from_utf8_lossy(&rest[start..end]).into_owned());
            rest = &rest[end..];
        }
        let pixels = rest.get(1..=SIZE * SIZE * 3);
        if words != ["P6", "256", "256", "255"] {
            return Err(LoadError::bad(path, None, format!("a 256 by 256 P6 picture is expected, not {}", words.join(" "))));
        }
        pixels.map(|rgb| Self { rgb: rgb.to_vec() }).ok_or_else(|| LoadError::bad(path, None, "the pixels end early"))
    }

    fn pixel(&self, k: usize) -> [u8; 3] {
        [self.rgb[3 * k], self.rgb[3 * k + 1], self.rgb[3 * k + 2]]
    }

    /// Whether pixel `k` shows something else than the background, which is in the upper left corner.
    fn is_covered(&self, k: usize) -> bool {
        self.pixel(k) != self.pixel(0)
    }
}

/// Differences of the three channels of pixel `k`, 0 to 255.
fn differences(ours: &Rendered, reference: &Reference, k: usize) -> [f64; 3] {
    std::array::from_fn(|c| f64::from(ours.rgb[3 * k + c].abs_diff(reference.rgb[3 * k + c])))
}

fn largest(d: [f64; 3]) -> f64 {
    d[0].max(d[1]).max(d[2])
}

/// The mean of `of` over the pixels that `counts`, and how many they are.
fn mean(counts: impl Fn(usize) -> bool, of: impl Fn(usize) -> f64) -> (f64, usize) {
    let pixels: Vec<usize> = (0..SIZE * SIZE).filter(|&k| counts(k)).collect();
    (pixels.iter().map(|&k| of(k)).sum::<f64>() / pixels.len().max(1) as f64, pixels.len())
}

fn channel_mean(d: [f64; 3]) -> f64 {
    (d[0] + d[1] + d[2]) / 3.0
}

/// Scene, reference, and the greatest mean error per covered channel; `None` is printed only.
const COVERED: [(&str, &str, Option<f64>); 6] = [
    ("hw2", "ref/hw2.pot4.screen.flat.ppm", None),
    ("hw3", "ref/hw3.pot4.defaultcam.flat.ppm", Some(0.05)),
    ("hw3-tri", "ref/hw3.tri.defaultcam.flat.ppm", Some(0.5)),
    ("hw4-gouraud", "ref/hw4.pot4.defaultcam.gouraud.ppm", Some(0.05)),
    ("hw4", "ref/hw4.pot4.defaultcam.phong.ppm", Some(0.25)),
    ("hw5", "ref/hw5.ppot.texture.perspective.ppm", Some(0.75)),
];

fn covered_row(data: &Path, (name, file, limit): (&str, &str, Option<f64>)) -> Result<Row, LoadError> {
    let (ours, reference) = (render(name, |_| {})?, Reference::read(&data.join(file))?);
    let (is_ours, is_theirs) = (|k: usize| ours.hits.hits[k].is_hit(), |k: usize| reference.is_covered(k));
    let missing = (0..SIZE * SIZE).filter(|&k| is_theirs(k) && !is_ours(k)).count();
    let extra = (0..SIZE * SIZE).filter(|&k| is_ours(k) && !is_theirs(k)).count();
    let (error, n) = mean(|k| is_ours(k) && is_theirs(k), |k| channel_mean(differences(&ours, &reference, k)));
    Ok(Row {
        name: name.to_owned(),
        measured: format!("{missing} missing, {extra} extra, mean error {error:.4} over {n} covered pixels"),
        required: limit.map_or_else(String::new, |limit| format!("0, 0, at most {limit}")),
        holds: limit.is_none_or(|limit| missing == 0 && extra == 0 && n > 0 && error <= limit),
    })
}

fn whole_row(data: &Path, name: &str, file: &str, limit: f64) -> Result<Row, LoadError> {
    let (ours, reference) = (render(name, |_| {})?, Reference::read(&data.join(file))?);
    let (error, _) = mean(|_| true, |k| channel_mean(differences(&ours, &reference, k)));
    Ok(Row {
        name: name.to_owned(),
        measured: format!("mean error {error:.4} over the whole picture"),
        required: format!("at most {limit}"),
        holds: error <= limit,
    })
}

/// The paper's figure 1: pixels whose first hit is a teapot triangle and whose reference is not black.
fn reflection_row(data: &Path) -> Result<Row, LoadError> {
    let ours = render("paper-reflection", |_| {})?;
    let reference = Reference::read(&data.join("paper/reflection.ppm"))?;
    let counts = |k: usize| {
        let hit = &ours.hits.hits[k];
        hit.is_hit() && hit.tri > 0 && reference.pixel(k) != [0; 3]
    };
    let (error, n) = mean(counts, |k| largest(differences(&ours, &reference, k)));
    Ok(Row {
        name: "paper-reflection".to_owned(),
        measured: format!("mean of the largest channel error {error:.4} over {n} teapot pixels"),
        required: "at most 0.01".to_owned(),
        holds: n > 5000 && error <= 0.01,
    })
}

/// The paper's figure 2, with the mistake that it was made with and without it.
fn refraction_rows(data: &Path) -> Result<[Row; 2], LoadError> {
    let reference = Reference::read(&data.join("paper/refraction.ppm"))?;
    let row = |reflect_last_light: bool| {
        let ours = render("paper-refraction", |scene| scene.rules.reflect_last_light = reflect_last_light)?;
        let (error, _) = mean(|_| true, |k| channel_mean(differences(&ours, &reference, k)));
        let (worst, _) = mean(|_| true, |k| largest(differences(&ours, &reference, k)));
        Ok::<Row, LoadError>(Row {
            name: format!("paper-refraction, reflect_last_light = {reflect_last_light}"),
            measured: format!("mean error {error:.4} over the whole picture (largest channel {worst:.4})"),
            required: if reflect_last_light { "at most 1".to_owned() } else { String::new() },
            holds: !reflect_last_light || error <= 1.0,
        })
    };
    Ok([row(true)?, row(false)?])
}

/// Column, row, triangles (either), T from (0,0,-d), T from (0,0,0); the T-values that are known for the course's scene.
const KNOWN_T: [(u32, u32, [u32; 2], f64, f64); 5] = [
    (60, 100, [0, 0], 43.12139, 40.26366),
    (100, 120, [1, 1], 29.80176, 27.82675),
    (130, 60, [345, 345], 21.02199, 19.37872),
    (160, 80, [346, 347], 21.09210, 19.42022),
    (180, 60, [210, 221], 25.31280, 22.29042),
];

fn t_value_row() -> Result<Row, LoadError> {
    let ours = render("hw5", |_| {})?;
    let brute = BruteForce::new(&ours.scene.tris);
    let (mut worst, mut wrong) = (0f64, 0);
    for (i, j, [homework_tri, paper_tri], homework_t, paper_t) in KNOWN_T {
        let ray = ours.scene.camera.ray(i, j, glam::DVec2::ZERO);
        let from_origin = GzRay { origin: glam::DVec3::ZERO, ..ray };
        for (ray, tri, t) in [(ray, homework_tri, homework_t), (from_origin, paper_tri, paper_t)] {
            let hit = brute.closest_hit(&ray);
            // Two triangles of the list meet at an edge near the pixel, and which is hit depends on the origin.
            wrong += usize::from(![tri, homework_tri, paper_tri].contains(&hit.tri));
            worst = worst.max((f64::from(hit.t) / t - 1.0).abs());
        }
    }
    let miss = brute.closest_hit(&ours.scene.camera.ray(240, 240, glam::DVec2::ZERO));
    wrong += usize::from(miss.is_hit());
    Ok(Row {
        name: "T-values of hw5, both origins".to_owned(),
        measured: format!("largest relative error {worst:.1e} in 10 values, {wrong} wrong triangles in 11"),
        required: "at most 1e-5, 0".to_owned(),
        holds: worst <= 1e-5 && wrong == 0,
    })
}

/// The whole table, from the course data in the folder `data`.
///
/// # Errors
///
/// If a scene or a reference cannot be read.
pub fn table(data: &Path) -> Result<Vec<Row>, LoadError> {
    let mut rows = COVERED.into_iter().map(|row| covered_row(data, row)).collect::<Result<Vec<_>, _>>()?;
    rows.push(whole_row(data, "hw6", "ref/hw6.ppot.texture.aa.ppm", 0.12)?);
    rows.push(reflection_row(data)?);
    rows.extend(refraction_rows(data)?);
    rows.push(t_value_row()?);
    Ok(rows)
}

/// The folder of course data that the environment names, if it does.
pub fn data_folder() -> Option<PathBuf> {
    std::env::var_os("GZ_HW_DATA").map(PathBuf::from).filter(|folder| folder.is_dir())
}
