//! One picture against another, with a slider.

use super::srgb;
use crate::cells;
use crate::model::{Shot, shot};
use crate::report::picture::Picture;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_app::load::Overrides;
use gz_core::GzColor;
use gz_shade::{Antialias, Fresnel};

const COLUMNS: [Column; 5] = [
    Column::new("pair", "pair", "", Kind::Label),
    Column::new("rmse", "RMSE", "of 255", Kind::Figure),
    Column::new("worst", "worst channel", "of 255", Kind::Count),
    Column::new("differing", "pixels that differ", "%", Kind::Figure),
    Column::new("gain", "difference shown", "×", Kind::Figure),
];

/// The section.
pub(in crate::report) const SECTION: Section = Section {
    id: "differences",
    chapter: Chapter::Model,
    title: "Before and after",
    how: "Move the slider. Beside each pair stands how far its pictures are apart, made brighter by the factor in the table.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| Ok(pairs().iter().map(|pair| pair.name.to_owned()).collect()),
    measure,
    says: |_: &Table| String::new(),
};

/// Two ways to render a scene.
struct Pair {
    name: &'static str,
    scene: &'static str,
    /// What is changed, and what is said of it, its first sentence short.
    sides: [(Overrides, &'static str); 2],
    /// How much brighter the difference is shown.
    gain: f32,
}

fn pairs() -> [Pair; 3] {
    let one = Overrides { aa: Some(Antialias::None), ..Overrides::NONE };
    [
        Pair {
            name: "samples",
            scene: "teapot",
            sides: [
                (one, "1 sample. One ray a pixel leaves stairs and noise in the glass."),
                (Overrides { aa: Some(Antialias::Samples(8)), ..one }, "8 samples. Eight rays smooth both."),
            ],
            gain: 2.0,
        },
        Pair {
            name: "depth",
            scene: "teapot",
            sides: [
                (
                    Overrides { depth: Some(3), ..one },
                    "Depth 3. At the paper's depth rays end inside the glass and the pot goes dark.",
                ),
                (Overrides { depth: Some(16), ..one }, "Depth 16. Enough bounces let them out."),
            ],
            gain: 2.0,
        },
        Pair {
            name: "fresnel",
            scene: "teapot",
            sides: [
                (Overrides { fresnel: Some(Fresnel::Schlick), ..one }, "Schlick. The paper's equations 2 and 3."),
                (one, "Fresnel. The exact equations: hardly a change at index 1.5."),
            ],
            gain: 8.0,
        },
    ]
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let size = run.size((16, 12), (320, 240), (480, 360));
    let mut measured = Measured::default();
    for Pair { name, scene, sides, gain } in pairs() {
        run.progress.say(&format!("  differences: {name}"));
        let render = |(overrides, _): &(Overrides, &str)| -> Result<Shot, AppError> {
            Ok(shot(scene, &Overrides { size: Some(size), ..*overrides })?)
        };
        let [before, after] = [render(&sides[0])?, render(&sides[1])?];
        let (_, bytes) = before.differences(&after);
        let share = 100.0 * bytes.differing as f64 / bytes.pixels as f64;
        let cells = cells![name, bytes.rmse, bytes.max, share, f64::from(gain)];
        let settings = format!("{}; {scene}, {}x{}", run.mode.name(), size.0, size.1);
        measured.rows.push(Row { cells, n: bytes.pixels as u64, settings });
        let apart = |(a, b): (&GzColor, &GzColor)| {
            // Clamped as they are seen.
            let (a, b) = (a.clamp(GzColor::ZERO, GzColor::ONE), b.clamp(GzColor::ZERO, GzColor::ONE));
            ((a - b).abs() * gain).min(GzColor::ONE)
        };
        let difference: Vec<GzColor> = before.frame.colors.iter().zip(&after.frame.colors).map(apart).collect();
        measured.pictures.extend([
            Picture::of_frame(&format!("{name}.before"), sides[0].1, &before.frame, before.code)?,
            Picture::of_frame(&format!("{name}.after"), sides[1].1, &after.frame, after.code)?,
            Picture::photo(
                &format!("{name}.difference"),
                &format!("Beside it the difference, times {gain}."),
                size.0,
                size.1,
                &srgb(&difference),
            )?,
        ]);
    }
    Ok(measured)
}
