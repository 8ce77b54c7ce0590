//! Heat maps: how much work each pixel's primary ray is.

use crate::accel::Built;
use crate::color_scale::scale_color;
use gz_bsp::VisitCount;
use gz_core::glam::DVec2;
use gz_core::{GzColor, GzRay, Tile, TileGrid, with_default_float_control};
use gz_shade::{Frame, FrameStats, Scene};
use rayon::prelude::*;

/// What is counted of the walk of a primary ray, sent by itself. (In a render neighbouring rays walk together and share the work.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Nodes and leaves entered. A node of the tree that tunes itself has eight cells, one of the paper's tree two halves. Brute force
    /// has none.
    Visits,
    /// Triangles looked at, each time counted. The tree that tunes itself looks at eight at a time, and a group counts eight even where
    /// some of its places are empty, as it takes the same time; the paper's tree looks at one at a time, brute force at all that there
    /// are.
    Tests,
}

impl Effort {
    /// `nodes and leaves entered` or `triangles looked at`.
    pub fn what(self) -> &'static str {
        match self {
            Self::Visits => "nodes and leaves entered",
            Self::Tests => "triangles looked at",
        }
    }

    /// The number for a walk that visited this.
    pub fn of(self, visits: &VisitCount) -> u64 {
        match self {
            Self::Visits => visits.nodes + visits.leaves,
            // A walk goes through groups or tests triangle by triangle. Behind groups, the tests in f64 are of triangles looked at already.
            Self::Tests if visits.groups > 0 => 8 * visits.groups,
            Self::Tests => visits.tests,
        }
    }
}

/// How counts become colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spread {
    /// Evenly: twice the count, twice as far up the scale.
    #[default]
    Even,
    /// By the logarithm of 1 + the count, for pictures of trees that are far apart on one scale.
    Log,
}

/// Which counts have which colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeatScale {
    /// The count that has the lightest colour; greater ones have it too. 0 has the darkest.
    pub full: u64,
    /// What is between.
    pub spread: Spread,
}

impl HeatScale {
    /// How far up the scale a count is; 1 and more for [`Self::full`] and above.
    pub fn share(&self, count: u64) -> f64 {
        let full = self.full.max(1);
        match self.spread {
            Spread::Even => count as f64 / full as f64,
            Spread::Log => libm::log1p(count as f64) / libm::log1p(full as f64),
        }
    }
}

/// Work by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// What is counted.
    pub effort: Effort,
    /// Which pixels these are.
    pub area: Tile,
    /// `area.len()` counts, row by row.
    pub counts: Vec<u64>,
}

impl HeatMap {
    /// Sends the primary ray of each pixel of `grid`'s area, without antialiasing, and counts. Tiles and threads do not show.
    pub fn trace(scene: &Scene, built: &Built<'_>, effort: Effort, grid: &TileGrid) -> Self {
        let area = grid.area();
        let tiles: Vec<Vec<u64>> = (0..grid.len())
            .into_par_iter()
            .map(|k| {
                let count = |(i, j)| effort.of(&visits(built, &scene.camera.ray(i, j, DVec2::ZERO)));
                with_default_float_control(|| grid.tile(k).pixels().map(count).collect())
            })
            .collect();
        let mut counts = vec![0; area.len()];
        for (tile, of_tile) in grid.tiles().zip(&tiles) {
            for ((i, j), &count) in tile.pixels().zip(of_tile) {
                counts[(j - area.y0) as usize * area.width() as usize + (i - area.x0) as usize] = count;
            }
        }
        Self { effort, area, counts }
    }

    /// The least count.
    pub fn least(&self) -> u64 {
        self.counts.iter().copied().min().unwrap_or(0)
    }

    /// The greatest count.
    pub fn most(&self) -> u64 {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// The mean count; 0 of no pixel.
    pub fn mean(&self) -> f64 {
        // Whole numbers far below 2^53 are summed, so that no order shows.
        self.counts.iter().sum::<u64>() as f64 / self.counts.len().max(1) as f64
    }

    /// The counts in colours of [`scale_color`], linear.
    pub fn frame(&self, scale: HeatScale) -> Frame {
        let colors: Vec<GzColor> = self.counts.iter().map(|&count| scale_color(scale.share(count))).collect();
        let stats = FrameStats { primary_rays: self.counts.len() as u64, ..FrameStats::default() };
        Frame { area: self.area, colors, stats }
    }

    /// What the colours mean, in a line: `nodes and leaves entered: 3 to 71, mean 20.4; colours from 0, dark blue, to 71, light yellow`.
    pub fn legend(&self, scale: HeatScale) -> String {
        let HeatScale { full, spread } = scale;
        let above = self.counts.iter().filter(|&&count| count > full).count();
        let beyond = if above > 0 { format!("; {above} pixels are above that") } else { String::new() };
        let steps = if spread == Spread::Log { " by the logarithm" } else { "" };
        format!(
            "{}: {} to {}, mean {:.2}; colours{steps} from 0, dark blue, to {full}, light yellow{beyond}",
            self.effort.what(),
            self.least(),
            self.most(),
            self.mean()
        )
    }
}

/// What the walk of one ray visits; brute force visits nothing and looks at everything.
fn visits(built: &Built<'_>, ray: &GzRay) -> VisitCount {
    let everything = || VisitCount { tests: built.query().tris().len() as u64, ..VisitCount::default() };
    built.visits(ray).unwrap_or_else(everything)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_count_eight_triangles_and_single_tests_one() {
        let walked = VisitCount { nodes: 3, leaves: 2, groups: 4, tests: 5, excluded: None };
        assert_eq!((Effort::Visits.of(&walked), Effort::Tests.of(&walked)), (5, 32));
        assert_eq!(Effort::Tests.of(&VisitCount { groups: 0, ..walked }), 5);
    }

    #[test]
    fn the_legend_tells_the_range_and_what_is_above() {
        let area = Tile { x0: 0, y0: 0, x1: 2, y1: 2 };
        let map = HeatMap { effort: Effort::Tests, area, counts: vec![8, 0, 24, 16] };
        let scale = |full| HeatScale { full, spread: Spread::Even };
        assert_eq!(
            map.legend(scale(24)),
            "triangles looked at: 0 to 24, mean 12.00; colours from 0, dark blue, to 24, light yellow"
        );
        assert!(map.legend(scale(10)).ends_with("to 10, light yellow; 2 pixels are above that"));
        let colors = map.frame(scale(16)).colors;
        assert_eq!((colors[1], colors[2], colors[3]), (scale_color(0.0), scale_color(1.0), scale_color(1.0)));
        let log = HeatScale { full: 24, spread: Spread::Log };
        assert!(map.legend(log).contains("; colours by the logarithm from 0"));
        assert_eq!([log.share(0), log.share(24)], [0.0, 1.0]);
        assert!((log.share(4) - 0.5).abs() < 1e-12, "1 + 4 is the root of 1 + 24");
    }
}
