//! A whole frame beside POV-Ray and Mitsuba: `cargo xtask bench frames`.
//!
//! The scene is `tests/peers/frames/teapots.toml`; each renderer has it in its own words, with the triangles as we have placed them.

mod contender;
mod gz;
mod mitsuba;
mod options;
mod pixels;
mod povray;
mod race;

use super::indexed::Indexed;
use super::memory;
use super::record::Record;
use super::timing::machine;
use contender::Contender;
use gz::Gz;
use gz_app::compare;
use gz_app::error::AppError;
use gz_app::load::{self, Overrides};
use gz_app::picture::Picture;
use gz_shade::SceneNeeds;
use mitsuba::Mitsuba;
use options::Options;
use povray::Povray;
use race::{Race, ray_table};
use std::path::Path;

/// Side of the picture that brute force renders too.
const CHECKED_SIDE: u32 = 96;

/// Does what `words` ask for, printing as it goes.
///
/// # Errors
///
/// Usage errors, a renderer that fails, and answers that differ from those of brute force.
pub fn run(words: &[String]) -> Result<(), AppError> {
    let options = Options::parse(words)?;
    let folder = options.dir.join("frames");
    std::fs::create_dir_all(&folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
    println!("{}", machine(options.threads[0]));
    let gz = Gz::new(&folder, options.depth)?;
    check(&gz, &folder, options.side)?;

    let teapots = teapots(gz.scene())?;
    let povray = Povray::new(&folder, options.depth, &teapots)?;
    if povray.is_none() {
        println!("POV-Ray: left out: there is no program povray (the Debian package of that name)");
    }
    let mitsuba = match Mitsuba::new(&options.dir, &folder, options.depth, &teapots) {
        Ok(mitsuba) => Some(mitsuba),
        Err(error) => {
            println!("Mitsuba: left out: {error}");
            None
        }
    };
    let contenders: Vec<&dyn Contender> = std::iter::once(&gz as &dyn Contender)
        .chain(povray.as_ref().map(|it| it as &dyn Contender))
        .chain(mitsuba.as_ref().map(|it| it as &dyn Contender))
        .collect();
    let race = Race::run(&contenders, &options)?;
    print!("{}", race.table(&options));
    let rays = gz.rays()?;
    if let Some(povray) = &povray {
        let theirs = povray.rays(options.side)?;
        print!("{}", ray_table(&rays, &theirs));
        print!("{}", race.verdict(&options, &rays, &theirs));
        println!("pictures: {}", apart(&gz.picture(), &povray.picture())?);
    }
    for contender in &contenders {
        println!("picture of {}: {}", contender.name(), contender.picture().display());
    }
    let growth = pixels::run(&gz, &options)?;
    if options.write {
        let settings = [format!("scene: tests/peers/frames/teapots.toml, depth {}", options.depth)];
        let record = Record::new("frames", options.rounds, &settings)?;
        record.write(HEAD, race.cells(options.side).chain(growth.iter().flat_map(pixels::Size::cells)))?;
    }
    Ok(())
}

/// Our own answers, before anything is timed.
fn check(gz: &Gz, folder: &Path, side: u32) -> Result<(), AppError> {
    let hits = folder.join("gz.hits");
    gz.with_hits(side, &hits)?;
    let overrides = Overrides { size: Some((side, side)), ..Overrides::default() };
    let (checked, differing, triangles) = memory::check(gz.scene(), &overrides, &hits)?;
    println!("{triangles} triangles; {checked} pixels' T-values checked by brute force, {differing} differ");
    if differing > 0 {
        return Err(AppError::Differs(format!("{differing} of {checked} T-values differ from those of brute force")));
    }
    gz.agrees_with_brute_force(CHECKED_SIDE)?;
    println!("the whole picture at {CHECKED_SIDE}x{CHECKED_SIDE} by brute force: 0 pixels differ");
    Ok(())
}

/// The teapots of the scene by material, as placed in world space.
fn teapots(scene: &Path) -> Result<Vec<(&'static str, Indexed)>, AppError> {
    let draft = load::scene(scene, &Overrides::default())?;
    let needs = SceneNeeds::of(&draft.scene);
    let scene = draft.place(needs)?;
    let of = |name: &str| {
        let is_of = |tri: &u32| scene.material(*tri).name == name;
        Indexed::of((0..scene.tris.len() as u32).filter(is_of).map(|tri| scene.tris.position(tri)))
    };
    Ok(["matte", "glass"].map(|name| (name, of(name))).to_vec())
}

/// Columns of the record.
const HEAD: &str = "renderer,threads,side,trace s median,trace s by round,process s by round";

/// How far apart two pictures are, in one line.
fn apart(one: &Path, other: &Path) -> Result<String, AppError> {
    let difference = compare::pictures(&Picture::read(one)?, &Picture::read(other)?, 8.0).map_err(AppError::Io)?;
    let share = 100.0 * difference.over as f64 / difference.pixels.max(1) as f64;
    Ok(format!("{share:.2}% of the pixels of gz and POV-Ray are more than 8 of 255 apart, RMSE {:.2}", difference.rmse))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scene_is_what_the_bench_says() {
        let teapots = teapots(&contender::source("teapots.toml")).unwrap();
        let count = |k: usize| teapots[k].1.triangles.len();
        assert_eq!((teapots[0].0, count(0), teapots[1].0, count(1)), ("matte", 16384, "glass", 16384));
    }

    #[test]
    fn the_other_scenes_have_the_same_numbers() {
        let read = |name: &str| std::fs::read_to_string(contender::source(name)).unwrap();
        let (toml, pov, py) = (read("teapots.toml"), read("teapots.pov"), read("teapots.py"));
        let is_place = |key: &str| ["position", "look_at", "direction"].contains(&key);
        let vectors: Vec<&str> =
            toml.lines().filter_map(|line| line.split_once(" = [")).filter(|(key, _)| is_place(key)).map(|(_, v)| v).collect();
        assert_eq!(vectors.len(), 5);
        for vector in vectors {
            let numbers = vector.trim_end_matches(']');
            assert!(pov.contains(&format!("<{numbers}>")) && py.contains(&format!("[{numbers}]")), "{numbers}");
        }
    }
}
