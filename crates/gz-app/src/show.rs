//! What a render shows in place of colours.

use crate::accel::Built;
use crate::cells::{cells, draw};
use crate::heat::{Effort, HeatMap, HeatScale, Spread};
use crate::view::View;
use gz_core::{Hit, TileGrid};
use gz_shade::{ColorCode, Frame, Scene};

/// What `--view` asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// What primary rays hit.
    Hits(View),
    /// How much work they are. `full`: the count that has the lightest colour, the greatest of the picture if it is not said.
    Heat {
        /// What is counted.
        effort: Effort,
        /// The end of the scale.
        full: Option<u64>,
        /// What is between its ends.
        spread: Spread,
    },
    /// The cells of the tree over the picture: its leaves, or its cells of a level.
    Cells {
        /// The level; see [`crate::cells::Cell::level`].
        level: Option<usize>,
    },
}

/// A picture to be written.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Its colours, linear, and what it took.
    pub frame: Frame,
    /// How files of 8 bits encode them.
    pub code: ColorCode,
    /// What the colours mean, as lines of text; nothing where that is plain.
    pub legend: String,
}

impl Show {
    /// Whether it is made from what primary rays hit.
    pub fn takes_hits(self) -> bool {
        !matches!(self, Self::Heat { .. })
    }

    /// The picture of `grid`'s area. `hits`: what the area's primary rays hit, where [`Self::takes_hits`]; `colors` renders the area.
    pub fn picture(
        self,
        scene: &Scene,
        built: &Built<'_>,
        grid: &TileGrid,
        hits: &[Hit],
        colors: impl FnOnce() -> Frame,
    ) -> Shown {
        let code = scene.rules.color_code;
        match self {
            Self::Hits(view) => Shown { frame: view.frame(scene, hits, grid), code, legend: String::new() },
            Self::Cells { level } => {
                let (cells, mut frame) = (cells(built, level), colors());
                draw(scene, &cells, &mut frame, hits);
                let what =
                    level.map_or_else(|| "leaves".to_owned(), |level| format!("cells of level {level} and leaves above it"));
                Shown { frame, code, legend: format!("{} {what} drawn\n", cells.len()) }
            }
            Self::Heat { effort, full, spread } => {
                let map = HeatMap::trace(scene, built, effort, grid);
                let scale = HeatScale { full: full.unwrap_or(map.most()), spread };
                // The scale is even in what a screen shows, whatever the scene's own rule for pictures is.
                Shown { frame: map.frame(scale), code: ColorCode::Srgb, legend: map.legend(scale) + "\n" }
            }
        }
    }
}
