//! MTL material libraries: checked here line by line, read by `tobj`.
//!
//! `tobj` 4.0.5 panics on `Kd 1`, takes NaN for a colour, and forgets all materials for one line that it does not like. So each
//! line is checked first, with its number at hand, and only records of known form reach it: three numbers a colour, one number
//! a value, a file name without options.

use super::obj::Materials;
use super::surfaces::IORS;
use super::text::{self, Lines, Tally, name, quoted, warning, words};
use super::values::MAX_COLOR;
use crate::error::LoadError;
use crate::mesh::{MeshMaterial, MeshTexture};
use std::fmt::Write;
use std::path::{Component, Path, PathBuf};

/// The longest MTL file that is read, in bytes: 64 MiB.
pub(super) const MAX_FILE: u64 = 64 << 20;

/// Keys of the format, and of its common extension for physically based materials, that this renderer has no use for.
const PASSED_OVER: &[&str] = &[
    "Km",
    "sharpness",
    "map_Ka",
    "map_Ks",
    "map_Ke",
    "map_Ns",
    "map_Ni",
    "map_Tr",
    "map_opacity",
    "map_bump",
    "map_Bump",
    "bump",
    "Bump",
    "map_aat",
    "disp",
    "map_disp",
    "decal",
    "refl",
    "map_refl",
    "norm",
    "map_Kn",
    "Pr",
    "Pm",
    "Ps",
    "Pc",
    "Pcr",
    "aniso",
    "anisor",
    "map_Pr",
    "map_Pm",
    "map_Ps",
];

/// Keys that change the picture elsewhere and not here, with what they would do and the value at which they do nothing.
const MISSED: [(&str, &str, Option<f32>); 4] =
    [("d", "opacity", Some(1.0)), ("Tr", "transparency", Some(0.0)), ("Ke", "emission", Some(0.0)), ("map_d", "opacity", None)];

/// One material before `tobj` has read it.
struct Record {
    line: usize,
    name: String,
    /// Its lines in known form.
    text: String,
    map_kd: Option<MeshTexture>,
}

/// Adds the materials of the library at `path`, whose text is `bytes`. `root` is the folder of the OBJ file, which textures must
/// not leave.
///
/// A material defined again replaces the earlier one, with a warning. Colours are one number (grey) or three; `illum` other than
/// 0 to 10, `spectral` and `xyz` colours, options of `map_Kd` and unknown keys give warnings and are ignored.
///
/// # Errors
///
/// With file and line: a value of a key in use that is missing, no number, not finite, negative, or for `Ni` 0; a texture
/// outside of `root`; more than 65536 materials.
pub(super) fn read(
    path: &Path,
    root: &Path,
    bytes: &[u8],
    materials: &mut Materials,
    warnings: &mut Vec<String>,
) -> Result<(), LoadError> {
    let mut records: Vec<Record> = Vec::new();
    let mut unknown: Vec<String> = Vec::new();
    let mut missed = [Tally::default(); MISSED.len()];
    for line in Lines::new(bytes) {
        let bad = |message: String| LoadError::bad(path, line.number, message);
        let (key, rest) = text::keyword(&line.text);
        let key = text::decode(key);
        let mut warn = |message: String| warnings.push(warning(path, line.number, message));
        if key.is_empty() {
            continue;
        }
        if key == "newmtl" {
            match name(rest) {
                name if name.is_empty() => return Err(bad("newmtl without a name".to_owned())),
                name => records.push(Record { line: line.number, name, text: String::new(), map_kd: None }),
            }
            continue;
        }
        if let Some(at) = MISSED.iter().position(|(missed, ..)| *missed == key) {
            let neutral = |word: &[u8]| text::number(word, "").ok() == MISSED[at].2 && MISSED[at].2.is_some();
            if !words(rest).all(neutral) {
                missed[at].add(line.number);
            }
            continue;
        }
        if PASSED_OVER.contains(&key.as_str()) {
            continue;
        }
        let known = matches!(key.as_str(), "Ka" | "Kd" | "Ks" | "Tf" | "Ns" | "Ni" | "illum" | "map_Kd");
        if !known {
            if unknown.len() < 20 && !unknown.contains(&key) {
                warn(format!("unknown key {}, ignored", quoted(key.as_bytes())));
                unknown.push(key);
            }
            continue;
        }
        let Some(record) = records.last_mut() else {
            warn(format!("{key} before the first newmtl, ignored"));
            continue;
        };
        let checked = match key.as_str() {
            "Ns" | "Ni" => Ok(Some(value(&key, rest).map_err(bad)?)),
            "illum" => illum(rest),
            "map_Kd" => {
                record.map_kd = Some(map_kd(rest, path, line.number, root, &mut warn).map_err(bad)?);
                Ok(None)
            }
            _ => color(&key, rest).map_err(bad)?,
        };
        match checked {
            Ok(Some(text)) => drop(writeln!(record.text, "{key} {text}")),
            Ok(None) => {}
            Err(ignored) => warn(ignored),
        }
    }
    for ((key, meaning, _), tally) in MISSED.into_iter().zip(missed) {
        tally.report(path, &format!("{key} line"), &format!("ignored: {meaning} is not supported"), warnings);
    }
    take(path, records, materials, warnings)
}

/// Has `tobj` read the records and puts them under their own names.
fn take(path: &Path, records: Vec<Record>, materials: &mut Materials, warnings: &mut Vec<String>) -> Result<(), LoadError> {
    let mut clean = String::new();
    for (number, record) in records.iter().enumerate() {
        // Names may hold anything, and twice; to tobj they are numbers.
        let _ = write!(clean, "newmtl {number}\n{}", record.text);
    }
    let refused = |what: String| LoadError::bad(path, None, what);
    let (read, _) = tobj::load_mtl_buf(&mut clean.as_bytes()).map_err(|error| refused(error.to_string()))?;
    if read.len() != records.len() {
        return Err(refused(format!("{} materials where {} are defined", read.len(), records.len())));
    }
    for (record, read) in records.into_iter().zip(read) {
        let Record { line, name, map_kd, .. } = record;
        // tobj leaves the transmission filter as text.
        let tf =
            read.unknown_param.get("Tf").map(|text| text.split(' ').filter_map(|word| word.parse().ok()).collect::<Vec<f32>>());
        let material = MeshMaterial {
            ka: read.ambient,
            kd: read.diffuse,
            ks: read.specular,
            ns: read.shininess,
            ni: read.optical_density,
            tf: tf.and_then(|tf| tf.try_into().ok()),
            illum: read.illumination_model.map(u32::from),
            map_kd,
            name: name.clone(),
        };
        if material.illum == Some(3) && material.ks.is_some_and(|ks| ks.iter().any(|&channel| channel > 1.0)) {
            return Err(LoadError::bad(path, line, "Ks of a mirror (illum 3) is its tint and must be at most 1"));
        }
        match materials.put(material) {
            None => return Err(LoadError::bad(path, line, "more than 65536 materials")),
            Some(true) => warnings.push(warning(path, line, format!("material {name:?} is defined again, the last one is used"))),
            Some(false) => {}
        }
    }
    Ok(())
}

/// A number of a key, in range; the text that it was.
fn in_range<'a>(key: &str, word: &'a [u8]) -> Result<&'a str, String> {
    let value = text::number(word, key)?;
    let word = std::str::from_utf8(word).unwrap_or_default();
    match key {
        "Ni" if !IORS.contains(&f64::from(value)) => Err(format!("Ni must be {} to {}, not {word}", IORS.start(), IORS.end())),
        _ if value < 0.0 => Err(format!("{key} must not be negative: {word}")),
        "Tf" if value > 1.0 => Err(format!("Tf must be at most 1, not {word}")),
        "Ka" | "Kd" | "Ks" if value > MAX_COLOR => Err(format!("{key} must be at most {MAX_COLOR}, not {word}")),
        _ => Ok(word),
    }
}

/// The one number of `Ns` or `Ni`.
fn value(key: &str, rest: &[u8]) -> Result<String, String> {
    let words: Vec<_> = words(rest).collect();
    match words[..] {
        [word] => in_range(key, word).map(str::to_owned),
        _ => Err(format!("{key} takes 1 number, not {}", words.len())),
    }
}

/// The three numbers of a colour, from one or three; the inner error is a warning.
fn color(key: &str, rest: &[u8]) -> Result<Result<Option<String>, String>, String> {
    let words: Vec<_> = words(rest).collect();
    if let Some(form) = words.first().filter(|word| [b"spectral".as_slice(), b"xyz"].contains(word)) {
        return Ok(Err(format!("{key} {} colours are not supported, ignored", text::decode(form))));
    }
    let numbers = words.iter().map(|word| in_range(key, word)).collect::<Result<Vec<_>, _>>()?;
    match numbers[..] {
        [grey] => Ok(Ok(Some([grey; 3].join(" ")))),
        [_, _, _] => Ok(Ok(Some(numbers.join(" ")))),
        _ => Err(format!("{key} takes 1 or 3 numbers, not {}", numbers.len())),
    }
}

/// `illum`; the error is a warning.
fn illum(rest: &[u8]) -> Result<Option<String>, String> {
    let words: Vec<_> = words(rest).map(text::decode).collect();
    match words.first().and_then(|word| word.parse().ok()) {
        Some(model @ 0..=10u8) if words.len() == 1 => Ok(Some(model.to_string())),
        _ => Err(format!("illum takes a number from 0 to 10, not {}, ignored", quoted(words.join(" ").as_bytes()))),
    }
}

/// The texture that `map_Kd` names, beside the library. Options are named in a warning and passed over.
fn map_kd(rest: &[u8], path: &Path, line: usize, root: &Path, warn: &mut impl FnMut(String)) -> Result<MeshTexture, String> {
    let mut dropped = Vec::new();
    let full = name(rest);
    let mut file = full.as_str();
    while let Some(option) = file.split_whitespace().next().filter(|word| word.len() > 1 && word.starts_with('-')) {
        // How many arguments an option has, by the format: "-o u [v [w]]" may have one to three, which are numbers.
        let (least, most) = match option {
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-texres" | "-bm" | "-boost" | "-type" => (1, 1),
            "-mm" => (2, 2),
            "-o" | "-s" | "-t" => (1, 3),
            // Not an option after all: a file of that name, or a mistake that shows when the texture is opened.
            _ => break,
        };
        let mut after = file[option.len()..].trim_start();
        for k in 0..most {
            let word = after.split_whitespace().next().unwrap_or_default();
            // The last word is the file, even if it looks like a number.
            if word.len() == after.len() || (k >= least && word.parse::<f32>().is_err()) {
                break;
            }
            after = after[word.len()..].trim_start();
        }
        warn(format!("map_Kd option {option} is not supported, ignored"));
        dropped.push(option.to_owned());
        file = after;
    }
    if file.is_empty() {
        return Err("map_Kd without a file name".to_owned());
    }
    let outside = || format!("texture {file:?} is outside the folder of the mesh");
    let beside = path.parent().unwrap_or(Path::new("")).join(inside(file).ok_or_else(outside)?);
    if !beside.starts_with(root) {
        return Err(outside());
    }
    Ok(MeshTexture { file: beside, library: path.to_owned(), line, dropped })
}

/// A file name as a relative path that stays in its folder, with `\` for `/` too; `None` if it is absolute, has a drive letter,
/// climbs by `..`, or is empty. Links are followed: whoever makes one decides.
pub(super) fn inside(name: &str) -> Option<PathBuf> {
    let name = name.replace('\\', "/");
    let drive = name.as_bytes().get(1) == Some(&b':');
    let path = PathBuf::from(name);
    let stays = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    (stays && !drive && path.file_name().is_some()).then_some(path)
}

#[cfg(test)]
mod tests;
