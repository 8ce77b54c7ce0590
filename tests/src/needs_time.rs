//! What computed needs save over all needs, on this machine.

use crate::scenes;
use gz_app::error::LoadError;
use gz_app::load::{self, Overrides};
use gz_bsp::BspTree;
use gz_shade::SceneNeeds;
use std::path::Path;
use std::time::Instant;

/// A scene with computed needs and with all.
#[derive(Clone, Debug)]
pub struct Saving {
    /// The scene.
    pub name: String,
    /// Needs it has, of ten.
    pub needs: usize,
    /// Bytes a triangle, computed and all.
    pub bytes: [usize; 2],
    /// Rays cast, computed and all.
    pub rays: [u64; 2],
    /// Seconds to place, computed over all: the median of the runs' ratios.
    pub place: f64,
    /// The same for building the tree and shading.
    pub shade: f64,
    /// The least and the greatest ratio of the whole among the runs.
    pub spread: [f64; 2],
    /// Runs.
    pub runs: usize,
}

/// Seconds to place and to shade, bytes a triangle, rays.
struct Run {
    place: f64,
    shade: f64,
    bytes: usize,
    rays: u64,
}

fn run(path: &Path, overrides: &Overrides, needs: Option<SceneNeeds>) -> Result<Run, LoadError> {
    let draft = load::scene(path, overrides)?;
    let needs = needs.unwrap_or_else(|| SceneNeeds::of(&draft.scene));
    let start = Instant::now();
    let scene = draft.place(needs)?;
    let placed = Instant::now();
    let frame = scenes::shade(&scene, needs, &BspTree::build(&scene.tris), 32);
    let (place, shade) = (placed - start, placed.elapsed());
    let bytes = scene.tris.attributes().bytes_per_triangle();
    Ok(Run { place: place.as_secs_f64(), shade: shade.as_secs_f64(), bytes, rays: frame.stats.rays() })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Measures one scene file, both ways in turn, `runs` times after one that does not count.
///
/// # Errors
///
/// If the scene cannot be loaded.
pub fn saving(path: &Path, runs: usize) -> Result<Saving, LoadError> {
    let overrides = Overrides { size: Some((320, 240)), ..Overrides::default() };
    let needs = SceneNeeds::reasons(&load::scene(path, &overrides)?.scene);
    let (mut place, mut shade, mut whole, mut last) = (Vec::new(), Vec::new(), Vec::new(), ([0; 2], [0; 2]));
    for k in 0..=runs {
        let all = || run(path, &overrides, Some(SceneNeeds::ALL));
        let computed = || run(path, &overrides, None);
        // Now one, now the other is first.
        let (computed, all) = if k % 2 == 0 {
            let first = computed()?;
            (first, all()?)
        } else {
            let first = all()?;
            (computed()?, first)
        };
        last = ([computed.bytes, all.bytes], [computed.rays, all.rays]);
        if k > 0 {
            place.push(computed.place / all.place);
            shade.push(computed.shade / all.shade);
            whole.push((computed.place + computed.shade) / (all.place + all.shade));
        }
    }
    let spread = [whole.iter().copied().fold(f64::INFINITY, f64::min), whole.iter().copied().fold(0.0, f64::max)];
    Ok(Saving {
        name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        needs: needs.iter().filter(|need| need.because.is_some()).count(),
        bytes: last.0,
        rays: last.1,
        place: median(place),
        shade: median(shade),
        spread,
        runs,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_value() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert!(median(Vec::new()).is_nan());
    }
}
