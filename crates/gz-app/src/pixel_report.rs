//! `gz pixel`: one pixel explained.

mod facts;
mod json;
mod text;
mod walk;

use crate::accel::Accel;
use crate::cli::{AccelArgs, PixelArgs};
use crate::error::AppError;
use crate::progress::say;
use crate::{job, load, threads};
use facts::Facts;
use gz_core::Kernel;
use gz_shade::SceneNeeds;

/// What `gz pixel` found.
#[derive(Debug)]
pub struct Explained {
    /// The pixel, as lines of text, or as JSON where that was asked for.
    pub report: String,
    /// An error when `--compare` found another answer.
    pub verdict: Result<(), AppError>,
}

/// Does what `gz pixel` is asked for.
///
/// # Errors
///
/// If the scene cannot be used or has no such pixel. A difference under `--compare` is no error here: see [`Explained::verdict`].
pub fn explain(args: &PixelArgs) -> Result<Explained, AppError> {
    let accel = Accel::of(&args.scene.accel)?;
    let other = args.compare.map(|kind| Accel::of(&AccelArgs { accel: Some(kind), ..NO_CHOICE })).transpose()?;
    threads::with(args.scene.threads, || {
        let draft = load::scene(&args.scene.scene, &job::overrides(&args.scene))?;
        draft.warnings.iter().for_each(|warning| say(&format!("gz: warning: {warning}")));
        let (width, height) = (draft.scene.camera.width(), draft.scene.camera.height());
        if args.x >= width || args.y >= height {
            return Err(AppError::Usage(format!("pixel {} {} is outside of the picture of {width}x{height}", args.x, args.y)));
        }
        let needs = SceneNeeds::of(&draft.scene);
        let scene = draft.place(needs)?;
        let mut facts = Facts::of(&scene, needs, &accel.build(&scene.tris)?, args.x, args.y);
        if let Some(other) = other {
            facts.compared = Some((other.name(), other.build(&scene.tris)?.query().closest_hit(&facts.ray)));
        }
        let report = if args.json { format!("{:#}\n", facts.json()) } else { facts.text() };
        Ok(Explained { report, verdict: verdict(&facts) })
    })
}

/// The options of nobody who has not said anything.
const NO_CHOICE: AccelArgs = AccelArgs { kernel: Kernel::Certified, accel: None, split: None, max_depth: None, min_size: None };

/// Whether what was compared answers alike.
fn verdict(facts: &Facts<'_>) -> Result<(), AppError> {
    match facts.compared {
        Some((_, expected)) if !facts.agrees() => {
            let (one, other) = (facts.hit_line(&expected), facts.hit_line(&facts.hit));
            Err(AppError::Differs(format!("the one hits {one}, the other {other}")))
        }
        _ => Ok(()),
    }
}
