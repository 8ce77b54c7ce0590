//! The course's triangle files (`.asc`): a word, then three corners of `x y z nx ny nz u v`, over and over.

use super::text::{self, Tally, is_blank, quoted, warning};
use crate::error::LoadError;
use crate::mesh::{Mesh, MeshTri};
use gz_core::{GzCoord, GzTextureIndex};
use std::path::Path;

/// The longest `.asc` file that is read, in bytes: 2 GiB, which is at least ten million triangles.
pub const MAX_FILE: u64 = 2 << 30;
/// Numbers a triangle.
const NUMBERS: usize = 24;

/// The mesh in the course file at `path`.
///
/// Any word begins a triangle; words are told apart from numbers by blanks of any kind, line ends included, as in the course's
/// reader. Old Mac line ends (CR) are what the course's files have. Corners are kept one by one, none shared.
///
/// Normals are kept **as given, not made unit length**: HW2's colours come from the short ones of `pot4.screen.asc`. A triangle
/// with a normal of length 0 counts as without normals, with a warning.
///
/// # Errors
///
/// With line and triangle number (from 0): something that is no number, or not finite; a number where a word should begin the
/// triangle; the end of the file inside a triangle. Without a line: a file that cannot be read, is beyond [`MAX_FILE`], or has no
/// triangles.
pub fn load(path: &Path) -> Result<Mesh, LoadError> {
    parse(path, &text::read_text(path, MAX_FILE)?)
}

/// As [`load`], with the bytes of the file given.
fn parse(path: &Path, bytes: &[u8]) -> Result<Mesh, LoadError> {
    let mut mesh = Mesh::default();
    let mut odd_words = Vec::new();
    let mut zero_normals = Tally::default();
    let mut words = Words { rest: bytes, line: 1 };
    while let Some((line, word)) = words.next() {
        let triangle = mesh.triangles.len();
        if text::number(word, "").is_ok() {
            let message = format!("triangle {triangle} begins with the number {} instead of a word", quoted(word));
            return Err(LoadError::bad(path, line, message));
        }
        if !word.starts_with(b"triangle") {
            odd_words.push((line, word));
        }
        let mut numbers = [0.0f32; NUMBERS];
        for (k, slot) in numbers.iter_mut().enumerate() {
            let bad = |line, message| LoadError::bad(path, line, format!("triangle {triangle}: {message}"));
            let (at, word) =
                words.next().ok_or_else(|| bad(words.line, format!("the file ends after {k} of {NUMBERS} numbers")))?;
            let what = ["coordinate", "normal", "texture coordinate"][[0, 0, 0, 1, 1, 1, 2, 2][k % 8]];
            *slot = text::number(word, what).map_err(|why| bad(at, format!("number {} of {NUMBERS}: {why}", k + 1)))?;
        }
        let first = mesh.positions.len() as u32;
        for corner in numbers.chunks_exact(8) {
            mesh.positions.push(GzCoord::from_slice(&corner[..3]));
            mesh.normals.push(GzCoord::from_slice(&corner[3..6]));
            mesh.uvs.push(GzTextureIndex::from_slice(&corner[6..]));
        }
        let corners = [first, first + 1, first + 2];
        let has_normals = mesh.normals[first as usize..].iter().all(|&normal| normal != GzCoord::ZERO);
        if !has_normals {
            zero_normals.add(line);
        }
        mesh.triangles.push(MeshTri {
            position: corners,
            normal: has_normals.then_some(corners),
            uv: Some(corners),
            material: None,
        });
    }
    if mesh.triangles.is_empty() {
        return Err(LoadError::bad(path, None, "no triangles"));
    }
    if let [(line, word), more @ ..] = &odd_words[..] {
        let others = if more.is_empty() { String::new() } else { format!(" ({} more like it)", more.len()) };
        let message = format!("a triangle begins with {} instead of \"triangle\"{others}", quoted(word));
        mesh.warnings.push(warning(path, *line, message));
    }
    zero_normals.report(path, "triangle", "with a normal of length 0, left without", &mut mesh.warnings);
    Ok(mesh)
}

/// Words with their line numbers; a line ends in LF, CR or CRLF.
struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Iterator for Words<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.rest.iter().position(|b| !is_blank(b)).unwrap_or(self.rest.len());
        let (blanks, rest) = self.rest.split_at(start);
        self.line +=
            blanks.iter().enumerate().filter(|&(k, &b)| b == b'\r' || (b == b'\n' && (k == 0 || blanks[k - 1] != b'\r'))).count();
        let end = rest.iter().position(is_blank).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        (!word.is_empty()).then_some((self.line, word))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Scratch, course_data, mutated};
    use super::*;

    const TWO: &str = "triangle\n0 0 0 0 0 1 0 0\n1 0 0 0 0 2 1 0\n0 1 0 0 0 1 0 1\n\
                       triangle2\n0 0 5\t0 0 1 0 0\n1 0 5 0 0 1 1 0\n0 1 5 0 0 1 0 1\n";

    fn read(text: &str) -> Result<Mesh, String> {
        parse(Path::new("t.asc"), text.as_bytes()).map_err(|error| error.to_string())
    }

    fn error(text: &str) -> String {
        read(text).unwrap_err()
    }

    #[test]
    fn corners_normals_and_texture_coordinates_are_kept_as_given() {
        let mesh = read(TWO).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.positions.len(), mesh.warnings.len()), (2, 6, 0));
        assert_eq!(mesh.triangles[1].position, [3, 4, 5]);
        assert_eq!((mesh.positions[4], mesh.normals[1]), (GzCoord::new(1.0, 0.0, 5.0), GzCoord::new(0.0, 0.0, 2.0)));
        assert_eq!(mesh.uvs[2], GzTextureIndex::new(0.0, 1.0));
    }

    #[test]
    fn errors_name_the_right_line_whatever_ends_the_lines() {
        for end in ["\n", "\r", "\r\n"] {
            let text = TWO.replace("1 0 5", "1 x 5").replace('\n', end);
            assert_eq!(error(&text), r#"t.asc:7: triangle 1: number 10 of 24: "x" is not a number"#, "{end:?}");
        }
    }

    #[test]
    fn too_few_and_too_many_numbers_are_told() {
        let seven = r#"t.asc:5: triangle 0: number 24 of 24: "triangle2" is not a number"#;
        assert_eq!(error(&TWO.replacen("0 0 2 1 0", "0 0 2 1", 1)), seven);
        let nine = r#"t.asc:4: triangle 1 begins with the number "1" instead of a word"#;
        assert_eq!(error(&TWO.replacen("0 0 2 1 0", "0 0 2 1 0 9", 1)), nine);
        assert_eq!(
            error(&TWO.replacen("triangle", "", 1)),
            r#"t.asc:2: triangle 0 begins with the number "0" instead of a word"#
        );
    }

    #[test]
    fn the_end_inside_a_triangle_and_trailing_words_are_told() {
        assert_eq!(error("triangle 1 2 3\n4"), "t.asc:2: triangle 0: the file ends after 4 of 24 numbers");
        assert_eq!(error(&format!("{TWO}end")), "t.asc:9: triangle 2: the file ends after 0 of 24 numbers");
        assert_eq!(error(" \r\n"), "t.asc: no triangles");
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        let nan = r#"t.asc:3: triangle 0: number 13 of 24: normal is not finite: "nan""#;
        assert_eq!(error(&TWO.replace("0 0 2", "0 nan 2")), nan);
        let huge = r#"t.asc:6: triangle 1: number 3 of 24: coordinate is not finite: "1e999""#;
        assert_eq!(error(&TWO.replacen("0 0 5", "0 0 1e999", 1)), huge);
    }

    #[test]
    fn a_normal_of_length_zero_and_an_odd_word_warn() {
        let mesh = read(&TWO.replace("0 0 2", "0 0 0").replace("triangle2", "facet")).unwrap();
        assert_eq!((mesh.triangles[0].normal, mesh.triangles[1].normal), (None, Some([3, 4, 5])));
        let expected = [
            r#"t.asc:5: a triangle begins with "facet" instead of "triangle""#,
            "t.asc:1: 1 triangle with a normal of length 0, left without",
        ];
        assert_eq!(mesh.warnings, expected);
    }

    #[test]
    fn random_changes_never_panic() {
        let mut state = 580;
        let mut read = 0;
        for _ in 0..4000 {
            let bytes = mutated(TWO.as_bytes(), b"0123456789.e-+ \t\r\nnaif\\#,x", &mut state);
            if let Ok(mesh) = parse(Path::new("t.asc"), &bytes) {
                assert!(mesh.positions.iter().chain(&mesh.normals).all(|p| p.is_finite()));
                read += 1;
            }
        }
        assert!((1..4000).contains(&read), "{read} of 4000 were still meshes");
    }

    #[test]
    fn a_missing_file_is_told() {
        let path = Scratch::new().path().join("none.asc");
        assert_eq!(load(&path).unwrap_err(), LoadError::io(&path, &std::io::ErrorKind::NotFound.into()));
    }

    #[test]
    fn the_course_files_have_their_triangles_and_ranges() {
        let Some(data) = course_data() else { return };
        for (file, triangles, least, most, uv) in [
            ("ppot.asc", 898, [-3.0, 0.0, -2.0], [20.0, 3.0, 20.0], [0.0, 1.0]),
            ("pot4.asc", 896, [-3.0, 0.0, -2.0], [3.428125, 3.0, 2.0], [0.0, 1.0]),
            ("tri.asc", 1, [-1.2915, -0.323828, 0.5495], [2.4, 2.25, 2.541834], [0.0, 0.25]),
        ] {
            let mesh = load(&data.join(file)).unwrap();
            assert_eq!((mesh.triangles.len(), &mesh.warnings[..]), (triangles, &[] as &[String]), "{file}");
            let low = mesh.positions.iter().fold(GzCoord::INFINITY, |m, p| m.min(*p));
            let high = mesh.positions.iter().fold(GzCoord::NEG_INFINITY, |m, p| m.max(*p));
            assert_eq!((low.to_array(), high.to_array()), (least, most), "{file}");
            let coordinates = || mesh.uvs.iter().flat_map(|uv| uv.to_array());
            assert_eq!([coordinates().fold(9.0, f32::min), coordinates().fold(-9.0, f32::max)], uv, "{file}");
        }
        let screen = load(&data.join("pot4.screen.asc")).unwrap();
        assert_eq!((screen.triangles.len(), screen.uvs.iter().all(|uv| *uv == GzTextureIndex::ZERO)), (896, true));
        let shortest = screen.normals.iter().map(|n| n.length()).fold(9.0, f32::min);
        assert!((0.35..0.37).contains(&shortest), "normals are kept as given, the shortest {shortest} long");
        for (file, triangles) in [("paper/reflection.asc", 897), ("paper/refraction.asc", 898)] {
            assert_eq!(load(&data.join(file)).unwrap().triangles.len(), triangles, "{file}");
        }
    }
}
