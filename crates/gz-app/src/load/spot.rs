//! Where in a scene file something stands, and errors that say so.

use super::words::hint;
use crate::error::LoadError;
use std::ops::Range;
use std::path::Path;

/// The text of a scene file and its name.
#[derive(Clone, Copy, Debug)]
pub(super) struct SceneText<'a> {
    pub(super) path: &'a Path,
    pub(super) text: &'a str,
    /// Where its lines start, as [`line_starts`] gives it.
    pub(super) starts: &'a [usize],
}

/// The offset at which each line of `text` starts, in bytes. Made once: a scene asks for the lines of all its tables.
pub(super) fn line_starts(text: &str) -> Vec<usize> {
    let ends = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n').map(|(at, _)| at + 1);
    std::iter::once(0).chain(ends).collect()
}

impl SceneText<'_> {
    /// The line that the byte `offset` stands in, counting from 1.
    pub(super) fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset)
    }

    /// An error at what stands at `span`.
    pub(super) fn error(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::bad(self.path, self.line(span.start), message)
    }

    /// An error of the TOML reader in one line, in this program's words.
    pub(super) fn toml_error(&self, error: &toml::de::Error) -> LoadError {
        LoadError::bad(self.path, error.span().map(|span| self.line(span.start)), in_our_words(error.message()))
    }
}

/// Keys of the scene as a whole. In TOML they must come before any table, which is easily forgotten.
const TOP_KEYS: [&str; 2] = ["ambient", "background"];

/// A message of serde or the TOML reader as we put it. What is not recognised is passed on, in one line.
fn in_our_words(message: &str) -> String {
    let flat = message.split_whitespace().collect::<Vec<_>>().join(" ");
    if let Some(rest) = flat.strip_prefix("unknown field ")
        && let [wrong, known @ ..] = &quoted(rest)[..]
    {
        return if TOP_KEYS.contains(wrong) {
            format!("\"{wrong}\" belongs above the first [table]: here it is a key of that table")
        } else {
            format!("unknown key \"{wrong}\"{}", hint(wrong, known))
        };
    }
    if let Some(rest) = flat.strip_prefix("missing field ")
        && let [name, ..] = quoted(rest)[..]
    {
        return format!("key \"{name}\" is missing");
    }
    for prefix in ["invalid type: ", "invalid value: "] {
        if let Some((found, expected)) = flat.strip_prefix(prefix).and_then(|rest| rest.split_once(", expected ")) {
            return format!("expected {expected}, found {}", found.replace('`', ""));
        }
    }
    if let Some((found, expected)) = flat.strip_prefix("invalid length ").and_then(|rest| rest.split_once(", expected ")) {
        return format!("expected {expected}, found {found} elements");
    }
    flat
}

/// The names between backquotes.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_count_from_one_and_end_with_the_text() {
        let written = "a\nb\r\nc";
        let starts = line_starts(written);
        let text = SceneText { path: Path::new("s.toml"), text: written, starts: &starts };
        assert_eq!([0, 1, 2, 5, 6, 99].map(|offset| text.line(offset)), [1, 1, 2, 3, 3, 3]);
    }

    #[test]
    fn messages_of_serde_are_put_in_our_words() {
        let cases = [
            ("unknown field `colour`, expected one of `color`, `space`", "unknown key \"colour\" (did you mean \"color\"?)"),
            ("missing field `name`", "key \"name\" is missing"),
            ("invalid type: string \"x\", expected a number", "expected a number, found string \"x\""),
            ("invalid type: integer `3`, expected a string", "expected a string, found integer 3"),
            ("invalid length 2, expected an array of length 3", "expected an array of length 3, found 2 elements"),
            ("something\n new", "something new"),
        ];
        for (theirs, ours) in cases {
            assert_eq!(in_our_words(theirs), ours);
        }
    }
}
