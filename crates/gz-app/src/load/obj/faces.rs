//! The second pass over an OBJ file: faces into triangles, in file order.

use super::vertices::Vertices;
use super::{MAX_NAMED, Materials};
use crate::error::LoadError;
use crate::load::polygon::{MAX_CONCAVE, Triangulator};
use crate::load::text::{self, Lines, Tally, warning};
use crate::mesh::{FLAT, MeshTri, UNGROUPED};
use gz_core::GzCoord;
use std::path::Path;

/// A face's corner: array positions counting from 0, `None` where the file gives none.
#[derive(Clone, Copy)]
struct Corner {
    position: u32,
    uv: Option<u32>,
    normal: Option<u32>,
}

/// How many there are of each kind: in the file, and before the line that is read.
#[derive(Clone, Copy, Default)]
struct Counts {
    positions: usize,
    uvs: usize,
    normals: usize,
}

/// What was odd.
#[derive(Default)]
struct Oddities {
    small: Tally,
    some_uvs: Tally,
    some_normals: Tally,
    zero_normals: Tally,
    no_area: Tally,
    no_group: Tally,
}

/// All triangles of `bytes`, whose vertices are `vertices`, and their smoothing groups, empty where the file has none.
///
/// # Errors
///
/// At the first line with a corner that is none, an index of 0 or out of range, or a polygon that cannot be cut.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    vertices: &Vertices,
    materials: &Materials,
    warnings: &mut Vec<String>,
) -> Result<(Vec<MeshTri>, Vec<u32>), LoadError> {
    let mut triangles = Vec::new();
    let mut smoothing = Vec::new();
    let mut group = UNGROUPED;
    if triangles.try_reserve_exact(vertices.triangles).is_err() {
        return Err(LoadError::bad(path, None, format!("not enough memory for {} triangles", vertices.triangles)));
    }
    let all = Counts { positions: vertices.positions.len(), uvs: vertices.uvs.len(), normals: vertices.normals.len() };
    let mut before = Counts::default();
    let mut material = None;
    let mut unknown: Vec<String> = Vec::new();
    let mut odd = Oddities::default();
    let mut face = Face::default();
    for line in Lines::new(bytes) {
        let bad = |message: String| LoadError::bad(path, line.number, message);
        let (key, rest) = text::keyword(&line.text);
        match key {
            b"v" => before.positions += 1,
            b"vt" => before.uvs += 1,
            b"vn" => before.normals += 1,
            b"f" | b"fo" => {
                let before_face = triangles.len();
                face.corners.clear();
                for word in text::words(rest) {
                    face.corners.push(corner(word, all, before).map_err(bad)?);
                }
                face.cut(vertices, material, line.number, &mut odd, &mut triangles).map_err(bad)?;
                // Files without groups, which are most, take no memory for them.
                if group != UNGROUPED || !smoothing.is_empty() {
                    smoothing.resize(before_face, UNGROUPED);
                    smoothing.resize(triangles.len(), group);
                }
            }
            b"s" => match smoothing_group(rest) {
                Some(given) => group = given,
                None => odd.no_group.add(line.number),
            },
            b"usemtl" => {
                let name = text::name(rest);
                material = materials.numbers.get(&name).copied();
                if material.is_none() && unknown.len() < MAX_NAMED && !unknown.contains(&name) {
                    let message = format!("material {name:?} is not defined, the default is used");
                    warnings.push(warning(path, line.number, message));
                    unknown.push(name);
                }
            }
            _ => {}
        }
    }
    odd.small.report(path, "face", "of fewer than three corners, ignored", warnings);
    odd.some_uvs.report(path, "triangle", "with texture coordinates at some corners only, left without", warnings);
    odd.some_normals.report(path, "triangle", "with normals at some corners only, left without", warnings);
    odd.zero_normals.report(path, "triangle", "with a normal of length 0, left without", warnings);
    odd.no_area.report(path, "triangle", "without area, numbered but never hit", warnings);
    odd.no_group.report(path, "smoothing group", "neither off nor a number, ignored", warnings);
    Ok((triangles, smoothing))
}

/// Room for one face after another.
#[derive(Default)]
struct Face {
    corners: Vec<Corner>,
    positions: Vec<GzCoord>,
    cutter: Triangulator,
}

impl Face {
    /// Appends the triangles of the face.
    fn cut(
        &mut self,
        vertices: &Vertices,
        material: Option<u16>,
        line: usize,
        odd: &mut Oddities,
        triangles: &mut Vec<MeshTri>,
    ) -> Result<(), String> {
        let at = |corner: &Corner| vertices.positions[corner.position as usize];
        let mut push = |corners: [Corner; 3]| {
            triangles.push(triangle(corners, vertices, material, line, odd));
        };
        match self.corners[..] {
            [] | [_] | [_, _] => odd.small.add(line),
            [a, b, c] => push([a, b, c]),
            _ => {
                self.positions.clear();
                self.positions.extend(self.corners.iter().map(at));
                let Some(cut) = self.cutter.cut(&self.positions) else {
                    let count = self.corners.len();
                    return Err(format!("a polygon of {count} corners that is not convex: at most {MAX_CONCAVE} are cut"));
                };
                cut.iter().for_each(|tri| push(tri.map(|k| self.corners[k as usize])));
            }
        }
        Ok(())
    }
}

fn triangle(corners: [Corner; 3], vertices: &Vertices, material: Option<u16>, line: usize, odd: &mut Oddities) -> MeshTri {
    let shared = |field: fn(&Corner) -> Option<u32>, some: &mut Tally| {
        let given = [field(&corners[0]), field(&corners[1]), field(&corners[2])];
        match given {
            [Some(a), Some(b), Some(c)] => Some([a, b, c]),
            [None, None, None] => None,
            _ => {
                some.add(line);
                None
            }
        }
    };
    let uv = shared(|corner| corner.uv, &mut odd.some_uvs);
    let mut normal = shared(|corner| corner.normal, &mut odd.some_normals);
    if normal.is_some_and(|given| given.iter().any(|&k| vertices.normals[k as usize] == GzCoord::ZERO)) {
        odd.zero_normals.add(line);
        normal = None;
    }
    let position = corners.map(|corner| corner.position);
    let [a, b, c] = position.map(|k| vertices.positions[k as usize].as_dvec3());
    if (b - a).cross(c - a) == glam::DVec3::ZERO {
        odd.no_area.add(line);
    }
    MeshTri { position, normal, uv, material }
}

/// `v`, `v/vt`, `v//vn` or `v/vt/vn`; a slash with nothing behind it is passed over.
fn corner(word: &[u8], all: Counts, before: Counts) -> Result<Corner, String> {
    let no_corner = || format!("{} is not a face corner", text::quoted(word));
    let mut fields = word.split(|&b| b == b'/');
    let mut field = || fields.next().filter(|field| !field.is_empty());
    let (position, uv, normal) = (field().ok_or_else(no_corner)?, field(), field());
    if fields.next().is_some() {
        return Err(no_corner());
    }
    let find = |field: &[u8], what, all, before| match integer(field) {
        Some(index) => resolve(index, field, what, all, before),
        None => Err(no_corner()),
    };
    Ok(Corner {
        position: find(position, "position", all.positions, before.positions)?,
        uv: uv.map(|field| find(field, "texture", all.uvs, before.uvs)).transpose()?,
        normal: normal.map(|field| find(field, "normal", all.normals, before.normals)).transpose()?,
    })
}

/// `s off`, or `s` and the number of a group, 0 being off.
fn smoothing_group(rest: &[u8]) -> Option<u32> {
    let mut words = text::words(rest);
    match (words.next(), words.next()) {
        (Some(b"off"), None) => Some(FLAT),
        (Some(word), None) => std::str::from_utf8(word).ok()?.parse().ok().filter(|&group| group != UNGROUPED),
        _ => None,
    }
}

/// An array position from an index, written as `word`: 1 is the first of the whole file, -1 the last one before this line.
fn resolve(index: i64, word: &[u8], what: &str, all: usize, before: usize) -> Result<u32, String> {
    let (defined, from_zero) = if index < 0 { (before, before as i64 + index) } else { (all, index - 1) };
    match u32::try_from(from_zero) {
        Ok(k) if (k as usize) < defined => Ok(k),
        _ if index == 0 => Err(format!("{what} index 0: indices count from 1")),
        // The word and not the number, which long words exceed.
        _ => Err(format!("{what} index {} but only {defined} defined", text::quoted(word).replace('"', ""))),
    }
}

/// A whole number with optional sign; beyond 18 digits it stands for any index that is out of range.
fn integer(field: &[u8]) -> Option<i64> {
    let (negative, digits) = match field {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let size = digits.iter().fold(0i64, |n, b| n.saturating_mul(10).saturating_add(i64::from(b - b'0')));
    Some(if negative { -size } else { size })
}
