//! A section of the report: what it measures, how its rows are drawn, and what is said of them.

use super::picture::Picture;
use super::run::Run;
use super::table::{Column, Row, Table};
use gz_app::error::AppError;

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By powers of ten.
    Log,
}

/// An axis of a chart: the column that it shows.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// The column's name.
    pub column: &'static str,
    /// What stands at the axis.
    pub title: &'static str,
    /// How it is divided.
    pub scale: Scale,
}

/// What a chart draws of each row.
#[derive(Clone, Copy, Debug)]
pub enum Drawn {
    /// A point; those of one series are joined by a line where `joined`.
    Points {
        /// Along the page.
        x: Axis,
        /// Up the page.
        y: Axis,
        /// The column of words that make a series, one colour each; empty for one colour a row's label.
        series: &'static str,
        /// The column of words that stand at a point; empty for none.
        label: &'static str,
        /// Whether points of a series are joined.
        joined: bool,
        /// What stands at the band for zeros of a logarithmic y axis; empty where there is no such band.
        zeros: &'static str,
    },
    /// A bar across the page, of these columns' numbers one behind the other.
    Bars {
        /// The columns.
        parts: &'static [&'static str],
        /// What stands at the axis.
        title: &'static str,
    },
}

/// A chart over the rows of a section.
#[derive(Clone, Copy, Debug)]
pub struct ChartSpec {
    /// What it shows, as a heading.
    pub title: &'static str,
    /// What to see in it.
    pub caption: &'static str,
    /// Only rows with this word (second) under this column (first); both empty for all.
    pub only: (&'static str, &'static str),
    /// What is drawn.
    pub drawn: Drawn,
}

/// Everything measured for a section.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// The rows.
    pub rows: Vec<Row>,
    /// Its pictures.
    pub pictures: Vec<Picture>,
}

/// A section.
#[derive(Clone, Copy)]
pub struct Section {
    /// Its name in files and links.
    pub id: &'static str,
    /// The number and name of the chapter that it belongs to.
    pub chapter: Chapter,
    /// Its heading.
    pub title: &'static str,
    /// What is measured, and how.
    pub how: &'static str,
    /// Its columns.
    pub columns: &'static [Column],
    /// Its charts.
    pub charts: &'static [ChartSpec],
    /// The labels of the rows that measuring would give.
    pub labels: fn(&Run) -> Result<Vec<String>, AppError>,
    /// Measures.
    pub measure: fn(&Run) -> Result<Measured, AppError>,
    /// What the rows say, in sentences made from them.
    pub says: fn(&Table) -> String,
}

/// The chapters of the page, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chapter {
    /// From Z to T: the pictures of the paper's steps.
    Pictures,
    /// Ray-triangle tests.
    Kernels,
    /// The error of T.
    Distance,
    /// Leaving a surface.
    Leaving,
    /// The tree.
    Tree,
    /// Size.
    Scale,
    /// Samples.
    Sampling,
    /// Approximations of the model.
    Model,
    /// What a scene needs.
    Needs,
}

impl Chapter {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Pictures,
        Self::Kernels,
        Self::Distance,
        Self::Leaving,
        Self::Tree,
        Self::Scale,
        Self::Sampling,
        Self::Model,
        Self::Needs,
    ];

    /// Its heading.
    pub fn title(self) -> &'static str {
        match self {
            Self::Pictures => "From a Z-buffer to a T-value buffer",
            Self::Kernels => "Which triangle does a ray hit?",
            Self::Distance => "How far away is the hit?",
            Self::Leaving => "Leaving a surface",
            Self::Tree => "The tree",
            Self::Scale => "More triangles",
            Self::Sampling => "More samples",
            Self::Model => "Approximations of light",
            Self::Needs => "Only what a scene needs",
        }
    }

    /// Its name in the list of contents.
    pub fn short(self) -> &'static str {
        match self {
            Self::Pictures => "Pictures",
            Self::Kernels => "Kernels",
            Self::Distance => "T error",
            Self::Leaving => "Leaving",
            Self::Tree => "Tree",
            Self::Scale => "Scale",
            Self::Sampling => "Samples",
            Self::Model => "Model",
            Self::Needs => "Needs",
        }
    }

    /// What it is about, in a sentence or two.
    pub fn about(self) -> &'static str {
        match self {
            Self::Pictures => {
                "The homework filled a buffer of depths by drawing triangles. Here a ray goes through each pixel instead, and what it \
                 keeps is T, the distance along it. Everything else follows from rays: shadows, mirrors, glass."
            }
            Self::Kernels => {
                "Random rays prove nothing: every test gets them right. These rays are aimed at edges and corners, graze planes, meet \
                 needles and copies, at scales from 1e-18 to 1e18, and the right answer is known from integers of any length."
            }
            Self::Distance => {
                "T orders everything that a ray meets. An ulp is one step of f32; the exact T rounded once is off by none."
            }
            Self::Leaving => {
                "A shadow ray starts on a surface, at a point that was rounded. If it starts on the wrong side the surface shadows \
                 itself (acne); if it is moved too far it slips past what stands close by (a leak)."
            }
            Self::Tree => {
                "The paper cuts boxes through their middle until MAX_DEPTH is passed or fewer than MIN_SIZE triangles are left. Its two \
                 tables again, over the whole grid that they are lines of, and beside them a tree that needs no settings."
            }
            Self::Scale => "The tree that tunes itself, on teapots of more and more triangles.",
            Self::Sampling => "What more rays through a pixel cost, and what they bring.",
            Self::Model => "Each approximation's error, and the time that it saves.",
            Self::Needs => "What a scene does not use is neither stored nor traced. This is what that saves, scene by scene.",
        }
    }
}
