//! The first pass over an OBJ file: vertices, library names, and how many triangles there will be.

use super::{MAX_LINE, MAX_NAMED};
use crate::error::LoadError;
use crate::load::text::{self, Lines, warning};
use gz_core::{GzCoord, GzTextureIndex};
use std::path::Path;

/// What the first pass finds.
#[derive(Default)]
pub(super) struct Vertices {
    /// `v`, finite.
    pub(super) positions: Vec<GzCoord>,
    /// `vt`, finite.
    pub(super) uvs: Vec<GzTextureIndex>,
    /// `vn`, unit length, or zero where the file has zero.
    pub(super) normals: Vec<GzCoord>,
    /// Triangles that the faces give: n - 2 for n corners.
    pub(super) triangles: usize,
    /// Lines with `mtllib` and what they name.
    pub(super) libraries: Vec<(usize, String)>,
}

/// Keywords of the format that mean nothing to a ray tracer. Lines and points are not counted, nor are groups.
const PASSED_OVER: &[&[u8]] = &[
    b"f",
    b"fo",
    b"g",
    b"o",
    b"s",
    b"l",
    b"p",
    b"usemtl",
    b"mg",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"call",
    b"csh",
];
/// Keywords of curves and surfaces, which would be geometry.
const FREE_FORM: &[&[u8]] = &[
    b"vp", b"cstype", b"deg", b"bmat", b"step", b"curv", b"curv2", b"surf", b"parm", b"trim", b"hole", b"scrv", b"sp", b"end",
    b"con", b"bzp", b"bsp", b"cdc", b"cdp", b"res",
];

/// Reads all vertex lines of `bytes`.
///
/// # Errors
///
/// At the first line with a number that is none or is not finite, or with too few or too many.
pub(super) fn read(path: &Path, bytes: &[u8], warnings: &mut Vec<String>) -> Result<Vertices, LoadError> {
    let mut found = Vertices::default();
    let mut unknown = Vec::new();
    let mut free_form = None;
    for line in Lines::new(bytes) {
        let bad = |message: String| LoadError::bad(path, line.number, message);
        if line.text.len() > MAX_LINE {
            return Err(bad(format!("a line of {} bytes: at most {MAX_LINE} are read", line.text.len())));
        }
        let (key, rest) = text::keyword(&line.text);
        match key {
            b"v" => found.positions.push(position(rest).map_err(bad)?),
            b"vt" => found.uvs.push(texture_index(rest).map_err(bad)?),
            b"vn" => found.normals.push(normal(rest).map_err(bad)?),
            b"f" | b"fo" => found.triangles = found.triangles.saturating_add(text::words(rest).count().saturating_sub(2)),
            b"mtllib" => match text::name(rest) {
                name if name.is_empty() => warnings.push(warning(path, line.number, "mtllib without a file name")),
                name => found.libraries.push((line.number, name)),
            },
            b"" => {}
            _ if PASSED_OVER.contains(&key) => {}
            _ if FREE_FORM.contains(&key) => free_form = free_form.or(Some(line.number)),
            _ if unknown.len() < MAX_NAMED && !unknown.iter().any(|known| known == key) => {
                warnings.push(warning(path, line.number, format!("unknown keyword {}, ignored", text::quoted(key))));
                unknown.push(key.to_owned());
            }
            _ => {}
        }
    }
    if let Some(line) = free_form {
        warnings.push(warning(path, line, "curves and free-form surfaces are not supported, ignored"));
    }
    Ok(found)
}

/// The numbers of a line, at most seven kept, and how many there are.
fn numbers(rest: &[u8], what: &str) -> Result<([f32; 7], usize), String> {
    let mut values = [0.0; 7];
    let mut count = 0;
    for word in text::words(rest) {
        let value = text::number(word, what)?;
        if let Some(slot) = values.get_mut(count) {
            *slot = value;
        }
        count += 1;
    }
    Ok((values, count))
}

/// `v x y z [w]` or `v x y z r g b [a]`.
fn position(rest: &[u8]) -> Result<GzCoord, String> {
    let ([x, y, z, w, ..], count) = numbers(rest, "coordinate")?;
    let at = GzCoord::new(x, y, z);
    match count {
        3 | 6 | 7 => Ok(at),
        4 if w == 0.0 => Err("a vertex with w = 0 is infinitely far away".to_owned()),
        4 if (at / w).is_finite() => Ok(at / w),
        4 => Err(format!("coordinate is not finite after division by w = {w}")),
        _ => Err(format!("v takes 3 numbers (4 with w, 6 or 7 with a colour), not {count}")),
    }
}

/// `vt u [v [w]]`.
fn texture_index(rest: &[u8]) -> Result<GzTextureIndex, String> {
    match numbers(rest, "texture coordinate")? {
        ([u, v, ..], 1..=3) => Ok(GzTextureIndex::new(u, v)),
        (_, count) => Err(format!("vt takes 1 to 3 numbers, not {count}")),
    }
}

/// `vn x y z`, made unit length. Bits are kept where the length is 1 already, to six decimals as files are written.
fn normal(rest: &[u8]) -> Result<GzCoord, String> {
    let ([x, y, z, ..], count) = numbers(rest, "normal")?;
    if count != 3 {
        return Err(format!("vn takes 3 numbers, not {count}"));
    }
    let given = GzCoord::new(x, y, z);
    let exact = given.as_dvec3();
    let unit = (exact.length_squared() - 1.0).abs() < 4e-6;
    Ok(if unit { given } else { exact.normalize_or_zero().as_vec3() })
}
