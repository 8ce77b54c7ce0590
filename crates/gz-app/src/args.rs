//! The values of command-line options, from text.

use crate::accel::{AccelKind, Split};
use crate::heat::{Effort, Spread};
use crate::progress::ProgressMode;
use crate::show::Show;
use crate::view::View;
use gz_core::{CameraModel, Kernel, LeavePolicy, Tile};
use gz_shade::{Antialias, Fresnel};

const ACCELS: [(&str, AccelKind); 2] = [("brute", AccelKind::Brute), ("bsp", AccelKind::Bsp)];
const SPLITS: [(&str, Split); 2] = [("midpoint", Split::Midpoint), ("sah", Split::Sah)];
const CAMERAS: [(&str, CameraModel); 4] = [
    ("homework", CameraModel::Homework),
    ("paper", CameraModel::Paper),
    ("screen", CameraModel::Screen),
    ("pinhole", CameraModel::Pinhole),
];
const FRESNELS: [(&str, Fresnel); 2] = [("exact", Fresnel::Exact), ("schlick", Fresnel::Schlick)];
const KERNELS: [(&str, Kernel); 8] = [
    ("certified", Kernel::Certified),
    ("plane", Kernel::Plane),
    ("moeller-trumbore", Kernel::MoellerTrumbore),
    ("moeller-trumbore-f64", Kernel::MoellerTrumboreF64),
    ("woop", Kernel::Woop),
    ("woop-fused", Kernel::WoopFused),
    ("pluecker", Kernel::Pluecker),
    ("baldwin-weber", Kernel::BaldwinWeber),
];
const LEAVES: [(&str, LeavePolicy); 6] = [
    ("exact", LeavePolicy::Exact),
    ("bare", LeavePolicy::Bare),
    ("identity", LeavePolicy::Identity),
    ("epsilon", LeavePolicy::USUAL_EPSILON),
    ("waechter-binder", LeavePolicy::WaechterBinder),
    ("error-bound", LeavePolicy::ErrorBound),
];
const VIEWS: [(&str, Show); 6] = [
    ("t", Show::Hits(View::T)),
    ("id", Show::Hits(View::Id)),
    ("normal", Show::Hits(View::Normal)),
    ("visits", Show::Heat { effort: Effort::Visits, full: None, spread: Spread::Even }),
    ("tests", Show::Heat { effort: Effort::Tests, full: None, spread: Spread::Even }),
    ("cells", Show::Cells { level: None }),
];
const SPREADS: [(&str, Spread); 2] = [("even", Spread::Even), ("log", Spread::Log)];
const PROGRESS: [(&str, ProgressMode); 4] =
    [("auto", ProgressMode::Auto), ("plain", ProgressMode::Plain), ("json", ProgressMode::Json), ("none", ProgressMode::None)];

/// The value called `text`; the error lists the names.
fn named<T: Copy>(text: &str, known: &[(&str, T)]) -> Result<T, String> {
    let names = || known.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    known.iter().find(|(name, _)| *name == text).map(|(_, value)| *value).ok_or_else(|| format!("it is one of {}", names()))
}

/// The name under which `value` stands in `known`.
fn name_of<T: PartialEq>(value: T, known: &[(&'static str, T)]) -> &'static str {
    known.iter().find(|(_, known)| *known == value).map_or("", |(name, _)| name)
}

/// `brute` or `bsp`.
pub(crate) fn accel(text: &str) -> Result<AccelKind, String> {
    named(text, &ACCELS)
}

/// `midpoint` or `sah`.
pub(crate) fn split(text: &str) -> Result<Split, String> {
    named(text, &SPLITS)
}

/// A camera model by name.
pub(crate) fn camera(text: &str) -> Result<CameraModel, String> {
    named(text, &CAMERAS)
}

/// The name of a camera model.
pub fn camera_name(model: CameraModel) -> &'static str {
    name_of(model, &CAMERAS)
}

/// `exact` or `schlick`.
pub(crate) fn fresnel(text: &str) -> Result<Fresnel, String> {
    named(text, &FRESNELS)
}

/// The name of a Fresnel rule.
pub fn fresnel_name(fresnel: Fresnel) -> &'static str {
    name_of(fresnel, &FRESNELS)
}

/// A ray-triangle test by name.
pub(crate) fn kernel(text: &str) -> Result<Kernel, String> {
    named(text, &KERNELS)
}

/// The name of a kernel.
pub fn kernel_name(kernel: Kernel) -> &'static str {
    name_of(kernel, &KERNELS)
}

/// A way to leave a surface by name, or `epsilon=T` with T at least 0.
pub(crate) fn leave(text: &str) -> Result<LeavePolicy, String> {
    match text.strip_prefix("epsilon=") {
        Some(number) => match number.parse::<f32>() {
            Ok(t) if t >= 0.0 && t.is_finite() => Ok(LeavePolicy::Epsilon(t)),
            _ => Err("epsilon=T takes a number from 0 up".to_owned()),
        },
        None => named(text, &LEAVES),
    }
}

/// The option text of a way to leave a surface.
pub fn leave_name(policy: LeavePolicy) -> String {
    match policy {
        LeavePolicy::Epsilon(t) if policy != LeavePolicy::USUAL_EPSILON => format!("epsilon={t}"),
        _ => name_of(policy, &LEAVES).to_owned(),
    }
}

/// What to show in place of colours.
pub(crate) fn view(text: &str) -> Result<Show, String> {
    named(text, &VIEWS)
}

/// `even` or `log`.
pub(crate) fn spread(text: &str) -> Result<Spread, String> {
    named(text, &SPREADS)
}

/// `auto`, `plain`, `json` or `none`.
pub(crate) fn progress(text: &str) -> Result<ProgressMode, String> {
    named(text, &PROGRESS)
}

/// `640x480`: width and height from 1 to 65535.
pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    let (width, height) = text.split_once('x').ok_or("it is written as 640x480")?;
    let number = |text: &str| text.parse::<u32>().ok().filter(|n| (1..=65535).contains(n));
    match (number(width), number(height)) {
        (Some(width), Some(height)) => Ok((width, height)),
        _ => Err("width and height must be whole numbers from 1 to 65535".to_owned()),
    }
}

/// `x0,y0,x1,y1`, half-open and not empty.
pub(crate) fn crop(text: &str) -> Result<Tile, String> {
    let numbers: Vec<u32> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
    match (text.split(',').count(), numbers.as_slice()) {
        (4, &[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Tile { x0, y0, x1, y1 }),
        (4, [_, _, _, _]) => Err("there is no pixel in it: x0 < x1 and y0 < y1 are needed".to_owned()),
        _ => Err("it is written as x0,y0,x1,y1 in pixels, x1 and y1 not included".to_owned()),
    }
}

/// `none`, `hw6`, or a number of samples from 1 to 4096.
pub(crate) fn antialias(text: &str) -> Result<Antialias, String> {
    match (text, text.parse::<u32>()) {
        ("none", _) => Ok(Antialias::None),
        ("hw6", _) => Ok(Antialias::Hw6),
        (_, Ok(n)) if (1..=4096).contains(&n) => Ok(Antialias::Samples(n)),
        _ => Err("it is none, hw6 or a number of samples from 1 to 4096".to_owned()),
    }
}

/// The option text of an antialiasing rule.
pub fn antialias_name(rule: Antialias) -> String {
    match rule {
        Antialias::None => "none".to_owned(),
        Antialias::Hw6 => "hw6".to_owned(),
        Antialias::Samples(n) => n.to_string(),
    }
}

/// A number that is at least 0.
pub(crate) fn tolerance(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|t| *t >= 0.0).ok_or_else(|| "it is a number from 0 up".to_owned())
}

/// The option parser's message, which spans lines and ends in a summary of the usage, as one line that begins with the cause.
pub(crate) fn one_line(message: &str) -> String {
    let cause = message.split("\n\nUsage:").next().unwrap_or_default().trim_start_matches("error: ");
    let cause = cause.split("\n\nFor more information").next().unwrap_or_default();
    let mut line = String::new();
    for part in cause.lines().map(str::trim).filter(|part| !part.is_empty()) {
        match line.as_str() {
            "" => {}
            so_far if so_far.ends_with(':') => line.push(' '),
            _ => line.push_str("; "),
        }
        line.push_str(part);
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_whole_and_in_range() {
        assert_eq!(size("640x480"), Ok((640, 480)));
        assert_eq!(size("65535x1"), Ok((65535, 1)));
        for bad in ["0x10", "10x0", "65536x1", "-1x1", "1.5x2", "x", "axb"] {
            assert_eq!(size(bad), Err("width and height must be whole numbers from 1 to 65535".to_owned()), "{bad}");
        }
        assert_eq!(size("640"), Err("it is written as 640x480".to_owned()));
    }

    #[test]
    fn crops_hold_a_pixel() {
        assert_eq!(crop("0,1,2,3"), Ok(Tile { x0: 0, y0: 1, x1: 2, y1: 3 }));
        assert!(crop("2,0,2,5").unwrap_err().starts_with("there is no pixel in it"));
        for bad in ["", "1,2,3", "1,2,3,4,5", "1,2,3,x", "a,2,3,4", "1,2,,4"] {
            assert!(crop(bad).unwrap_err().starts_with("it is written as"), "{bad}");
        }
    }

    #[test]
    fn names_go_both_ways() {
        for (name, model) in CAMERAS {
            assert_eq!((camera(name), camera_name(model)), (Ok(model), name));
        }
        for kernel in Kernel::ALL {
            assert_eq!(super::kernel(kernel_name(kernel)), Ok(kernel));
        }
        assert_eq!(camera("orthographic"), Err("it is one of homework, paper, screen, pinhole".to_owned()));
        assert_eq!((antialias("hw6"), antialias("16")), (Ok(Antialias::Hw6), Ok(Antialias::Samples(16))));
        assert!(antialias("0").is_err() && antialias("lots").is_err());
        assert!(tolerance("-1").is_err() && tolerance("NaN").is_err() && tolerance("0.5") == Ok(0.5));
    }

    #[test]
    fn ways_to_leave_are_names_and_one_takes_a_number() {
        for (name, policy) in LEAVES {
            assert_eq!((leave(name), leave_name(policy)), (Ok(policy), name.to_owned()));
        }
        assert_eq!(leave("epsilon=0.25"), Ok(LeavePolicy::Epsilon(0.25)));
        assert_eq!(leave_name(LeavePolicy::Epsilon(0.25)), "epsilon=0.25");
        assert_eq!(leave("epsilon=-1"), Err("epsilon=T takes a number from 0 up".to_owned()));
        assert!(
            leave("epsilon=NaN").is_err() && leave("epsilon=").is_err() && leave("pbrt").unwrap_err().contains("error-bound")
        );
    }

    #[test]
    fn a_message_becomes_one_line() {
        let message =
            "error: the following required arguments were not provided:\n  <SCENE>\n\nUsage: gz render <SCENE>\n\nFor more";
        assert_eq!(one_line(message), "the following required arguments were not provided: <SCENE>");
        let message = "error: unexpected argument '--sise' found\n\n  tip: a similar argument exists: '--size'\n\nUsage: gz";
        assert_eq!(one_line(message), "unexpected argument '--sise' found; tip: a similar argument exists: '--size'");
    }
}
