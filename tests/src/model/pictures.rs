//! Errors of approximations on pictures.

use super::{Table, figure};
use crate::rendered::scene_path;
use crate::scenes;
use gz_app::compare::{Difference, pictures};
use gz_app::error::LoadError;
use gz_app::load::{self, Overrides};
use gz_app::output::rgb8;
use gz_app::picture::{Picture, Unit};
use gz_bsp::BspTree;
use gz_core::{CameraModel, RayQuery};
use gz_shade::{Antialias, ColorCode, Eye, Frame, FrameStats, Fresnel, Scene, SceneNeeds, ShadeRules, ShadowRule};

/// A picture as it is computed and as it is written.
pub(crate) struct Shot {
    pub(crate) frame: Frame,
    pub(crate) code: ColorCode,
}

/// Renders a scene of `assets/scenes` through the tree.
pub(crate) fn shot(name: &str, overrides: &Overrides) -> Result<Shot, LoadError> {
    shot_by_rules(name, overrides, |_| {})
}

/// The same under rules that `change` has changed.
fn shot_by_rules(name: &str, overrides: &Overrides, change: impl FnOnce(&mut ShadeRules)) -> Result<Shot, LoadError> {
    let mut draft = load::scene(&scene_path(name), overrides)?;
    change(&mut draft.scene.rules);
    let needs = SceneNeeds::of(&draft.scene);
    let scene = draft.place(needs)?;
    Ok(shot_by(&scene, needs, &BspTree::build(&scene.tris)))
}

/// A scene of `assets/scenes`, placed.
pub(crate) fn placed(name: &str, overrides: &Overrides) -> Result<(Scene, SceneNeeds), LoadError> {
    let draft = load::scene(&scene_path(name), overrides)?;
    let needs = SceneNeeds::of(&draft.scene);
    Ok((draft.place(needs)?, needs))
}

/// Renders `scene` by any query.
pub(crate) fn shot_by(scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery) -> Shot {
    Shot { frame: scenes::shade(scene, needs, query, 32), code: scene.rules.color_code }
}

/// Overrides with one sample a pixel.
pub(crate) const fn sized(width: u32, height: u32) -> Overrides {
    Overrides { size: Some((width, height)), aa: Some(Antialias::None), ..Overrides::NONE }
}

impl Shot {
    fn stats(&self) -> &FrameStats {
        &self.frame.stats
    }

    fn linear(&self) -> Picture {
        let (width, height) = (self.frame.area.width(), self.frame.area.height());
        Picture { width, height, unit: Unit::Linear, rgb: self.frame.colors.iter().map(|c| c.to_array()).collect() }
    }

    fn bytes(&self) -> Picture {
        let (width, height) = (self.frame.area.width(), self.frame.area.height());
        Picture::of_bytes(width, height, &rgb8(&self.frame.colors, self.code))
    }

    /// How far this picture is from `reference`, before encoding and as written.
    pub(crate) fn differences(&self, reference: &Self) -> (Difference, Difference) {
        let found = |a: &Picture, b: &Picture| -> Difference {
            pictures(a, b, 0.0).unwrap_or_else(|reason| unreachable!("two renders of one scene: {reason}"))
        };
        (found(&reference.linear(), &self.linear()), found(&reference.bytes(), &self.bytes()))
    }

    /// The cells of [`COLUMNS`]: how far this picture is from `reference`.
    pub(super) fn against(&self, reference: &Self) -> Vec<String> {
        let (linear, bytes) = self.differences(reference);
        let share = 100.0 * bytes.differing as f64 / bytes.pixels as f64;
        let cells = [figure(linear.rmse), figure(bytes.rmse), format!("{}", bytes.max), format!("{share:.1} %")];
        cells.into_iter().chain([bytes.pixels.to_string()]).collect()
    }
}

/// How pictures are compared.
pub(super) const COLUMNS: [&str; 5] = ["RMSE, linear", "RMSE, bytes", "max, bytes", "pixels differing", "n pixels"];

/// What the columns mean.
pub(super) const MEANING: &str = "Linear values are those before encoding, 1 for full intensity; bytes are those of the written \
                                  picture, 0 to 255. RMSE is over all pixels and channels, *max* the most different channel.";

fn columns(first: &[&'static str]) -> Vec<&'static str> {
    first.iter().copied().chain(COLUMNS).collect()
}

pub(super) fn fresnel_table() -> Result<Table, LoadError> {
    let mut rows = Vec::new();
    for name in ["refraction", "teapot"] {
        let by = |fresnel| shot(name, &Overrides { fresnel: Some(fresnel), ..sized(320, 240) });
        let (exact, schlick) = (by(Fresnel::Exact)?, by(Fresnel::Schlick)?);
        rows.push([vec![name.to_owned()], schlick.against(&exact)].concat());
    }
    Ok(Table {
        title: "Schlick against Fresnel, on pictures".to_owned(),
        how: format!("The scene with `--fresnel schlick` against `--fresnel exact`, one sample a pixel. {MEANING}"),
        columns: columns(&["scene"]),
        rows,
    })
}

pub(super) fn depth_table() -> Result<Table, LoadError> {
    const DEEP: u32 = 16;
    let mut rows = Vec::new();
    for name in ["refraction", "teapot"] {
        let at = |depth| shot(name, &Overrides { depth: Some(depth), ..sized(320, 240) });
        let deep = at(DEEP)?;
        for depth in [1, 2, 3, 4, 6, 8, DEEP] {
            let shot = at(depth)?;
            let stats = shot.stats();
            let lost = |units: u64| figure(units as f64 * FrameStats::WEIGHT_UNIT / stats.primary_rays as f64);
            let cells = vec![name.to_owned(), depth.to_string(), lost(stats.depth_cut_weight), lost(stats.weak_weight)];
            rows.push([cells, shot.against(&deep)].concat());
        }
    }
    Ok(Table {
        title: format!("Depth limit against depth {DEEP}"),
        how: format!(
            "`--depth N` against `--depth {DEEP}`, one sample a pixel. *Cut* is the weight of the branches that the limit cut off, as \
             a mean share of a pixel; *weak* the same for branches that end because they weigh less than 2^-16. Columns as above."
        ),
        columns: columns(&["scene", "depth", "cut", "weak"]),
        rows,
    })
}

pub(super) fn samples_table() -> Result<Table, LoadError> {
    const MANY: u32 = 256;
    let mut rows = Vec::new();
    for name in ["plain", "refraction", "teapot"] {
        let by = |aa| shot(name, &Overrides { aa: Some(aa), ..sized(160, 120) });
        let many = by(Antialias::Samples(MANY))?;
        let ways = [
            ("1", Antialias::None),
            ("hw6", Antialias::Hw6),
            ("4", Antialias::Samples(4)),
            ("16", Antialias::Samples(16)),
            ("64", Antialias::Samples(64)),
        ];
        for (way, aa) in ways {
            rows.push([vec![name.to_owned(), way.to_owned()], by(aa)?.against(&many)].concat());
        }
    }
    Ok(Table {
        title: format!("Samples a pixel against {MANY}"),
        how: format!(
            "`--aa` against `--aa {MANY}`. The six samples of HW6 weigh differently and reach 0.80 pixels far, a softer filter than \
             the square of one pixel that the others average, so they come near it without tending to it. Columns as above."
        ),
        columns: columns(&["scene", "samples"]),
        rows,
    })
}

pub(super) fn rules_table() -> Result<Table, LoadError> {
    let mut rows = Vec::new();
    let size = sized(320, 240);
    for name in ["refraction", "teapot"] {
        let by = |shadow| shot_by_rules(name, &size, |rules| rules.shadow = shadow);
        let tinted = by(ShadowRule::Tinted)?;
        for (word, shadow) in [("no shadows", ShadowRule::Off), ("glass casts whole shadows", ShadowRule::Opaque)] {
            rows.push([vec![name.to_owned(), format!("{word}, for tinted ones")], by(shadow)?.against(&tinted)].concat());
        }
    }
    // The homework's viewer looks along z of image space, so its camera it must be.
    let image = Overrides { camera: Some(CameraModel::Homework), ..size };
    let by = |eye| shot_by_rules("plain", &image, |rules| rules.eye = eye);
    let cells = by(Eye::Fixed)?.against(&by(Eye::Ray)?);
    rows.push([vec!["plain".to_owned(), "highlights seen along z, for along the ray".to_owned()], cells].concat());
    Ok(Table {
        title: "Other rules".to_owned(),
        how: "One rule against the default, one sample a pixel. In truth glass gathers and spreads light, a caustic, which straight \
              tinted shadow rays do not show: the other two rules tell how much light is at stake, not how far off it is. The last \
              row is under `--camera homework`, whose fixed viewer belongs to image space. Columns as above."
            .to_owned(),
        columns: columns(&["scene", "rule"]),
        rows,
    })
}
