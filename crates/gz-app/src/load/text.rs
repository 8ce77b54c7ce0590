//! Text files as bytes: bounded reading, lines with their numbers, words and numbers with messages.
//!
//! Mesh files come from everywhere, so nothing here asks for UTF-8: lines are bytes, only names become text.

use crate::error::LoadError;
use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

/// All bytes of the file at `path`, a UTF-8 byte order mark removed.
///
/// # Errors
///
/// If it cannot be read, is a folder, is longer than `limit` bytes, or is UTF-16 text.
pub(crate) fn read_text(path: &Path, limit: u64) -> Result<Vec<u8>, LoadError> {
    let mut bytes = read_bytes(path, limit)?;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(LoadError::bad(path, 1, "UTF-16 text is not supported: save the file as UTF-8"));
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
    }
    Ok(bytes)
}

/// All bytes of the file at `path`.
///
/// # Errors
///
/// If it cannot be read, is a folder, or is longer than `limit` bytes; a regular file is refused before memory is taken for it.
pub(crate) fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, LoadError> {
    let io = |error| LoadError::io(path, &error);
    let too_long = || LoadError::bad(path, None, format!("longer than {limit} bytes, the most that is read"));
    let file = std::fs::File::open(path).map_err(io)?;
    let about = file.metadata().map_err(io)?;
    if about.is_dir() {
        return Err(LoadError { io: true, ..LoadError::bad(path, None, "is a folder, not a file") });
    }
    if about.len() > limit {
        return Err(too_long());
    }
    let mut bytes = Vec::new();
    let room = usize::try_from(about.len()).unwrap_or(usize::MAX);
    if bytes.try_reserve_exact(room).is_err() {
        return Err(LoadError::bad(path, None, format!("not enough memory for its {room} bytes")));
    }
    // A pipe or device has no length beforehand, so the limit holds while reading too.
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > limit { Err(too_long()) } else { Ok(bytes) }
}

/// A logical line.
pub(crate) struct Line<'a> {
    /// The number of its first physical line, counting from 1.
    pub(crate) number: usize,
    /// Its bytes without the line end, borrowed unless it was continued.
    pub(crate) text: Cow<'a, [u8]>,
}

/// Logical lines: ended by LF, CR or CRLF, and joined by a space where one ends in `\`. A comment line is never continued, for
/// Windows paths in comments end in `\` too.
pub(crate) struct Lines<'a> {
    rest: Option<&'a [u8]>,
    number: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `bytes`.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: Some(bytes), number: 0 }
    }

    fn physical(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        let end = line_end(rest);
        let line = &rest[..end];
        self.rest = match &rest[end..] {
            [] => None,
            [b'\r', b'\n', after @ ..] | [_, after @ ..] => Some(after),
        };
        self.number += 1;
        Some(line)
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let mut part = self.physical()?;
        let number = self.number;
        if part.last() != Some(&b'\\') || trim(part).first() == Some(&b'#') {
            return Some(Line { number, text: Cow::Borrowed(part) });
        }
        let mut joined = Vec::new();
        while let [before @ .., b'\\'] = part {
            joined.extend_from_slice(before);
            joined.push(b' ');
            part = self.physical().unwrap_or_default();
        }
        joined.extend_from_slice(part);
        Some(Line { number, text: Cow::Owned(joined) })
    }
}

/// Where the first line of `bytes` ends. Sixteen bytes are looked at together, which the compiler turns into one comparison.
fn line_end(bytes: &[u8]) -> usize {
    let ends = |b: u8| b == b'\n' || b == b'\r';
    let whole = bytes.chunks_exact(16).take_while(|chunk| !chunk.iter().fold(false, |any, &b| any | ends(b))).count() * 16;
    bytes[whole..].iter().position(|&b| ends(b)).map_or(bytes.len(), |at| whole + at)
}

/// Whether a byte separates words inside a line.
pub(crate) fn is_blank(byte: &u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c | b'\r' | b'\n')
}

/// `bytes` without blanks at either end.
pub(crate) fn trim(bytes: &[u8]) -> &[u8] {
    let start = bytes.iter().position(|b| !is_blank(b)).unwrap_or(bytes.len());
    let end = bytes.iter().rposition(|b| !is_blank(b)).map_or(start, |at| at + 1);
    &bytes[start..end]
}

/// The first word of a line and what follows it. Both are empty for a blank or comment line.
pub(crate) fn keyword(line: &[u8]) -> (&[u8], &[u8]) {
    let line = trim(line);
    if line.first() == Some(&b'#') {
        return (&[], &[]);
    }
    line.split_at(line.iter().position(is_blank).unwrap_or(line.len()))
}

/// The words of a line of numbers, up to a `#`.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let end = line.iter().position(|&b| b == b'#').unwrap_or(line.len());
    line[..end].split(is_blank).filter(|word| !word.is_empty())
}

/// A name that may hold blanks: all of `rest` up to a word that is only `#`, so that "Map #1" stays whole.
pub(crate) fn name(rest: &[u8]) -> String {
    let comment = (0..rest.len())
        .find(|&at| rest[at] == b'#' && (at == 0 || is_blank(&rest[at - 1])) && rest.get(at + 1).is_none_or(is_blank));
    decode(trim(&rest[..comment.unwrap_or(rest.len())]))
}

/// Bytes as text: UTF-8 where they are, else Latin-1, in which every byte is a character.
pub(crate) fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// A word in quotes for a message of one line: escaped, and cut after 40 characters.
pub(crate) fn quoted(word: &[u8]) -> String {
    let text = decode(&word[..word.len().min(161)]);
    match text.char_indices().nth(40) {
        Some((cut, _)) => format!("{:?}...", &text[..cut]),
        None => format!("{text:?}"),
    }
}

/// `word` as the nearest f32.
///
/// # Errors
///
/// The message when it is no number or not finite; `what` says what it would have been.
pub(crate) fn number(word: &[u8], what: &str) -> Result<f32, String> {
    let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse::<f32>().ok());
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(format!("{what} is not finite: {}", quoted(word))),
        None if word.contains(&b',') => Err(format!("{} is not a number: decimals need a point, not a comma", quoted(word))),
        None => Err(format!("{} is not a number", quoted(word))),
    }
}

/// One warning, as the command prints it.
pub(crate) fn warning(path: &Path, line: impl Into<Option<usize>>, message: impl Into<String>) -> String {
    LoadError::bad(path, line, message).to_string()
}

/// How often something odd was met, and where first.
#[derive(Clone, Copy, Default)]
pub(crate) struct Tally {
    count: usize,
    first: usize,
}

impl Tally {
    /// Counts one on `line`.
    pub(crate) fn add(&mut self, line: usize) {
        if self.count == 0 {
            self.first = line;
        }
        self.count += 1;
    }

    /// One warning for all, if there were any, at the first one's line: how many of `noun`, then `what`.
    pub(crate) fn report(self, path: &Path, noun: &str, what: &str, warnings: &mut Vec<String>) {
        if self.count > 0 {
            let plural = if self.count == 1 { "" } else { "s" };
            warnings.push(warning(path, self.first, format!("{} {noun}{plural} {what}", self.count)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<(usize, String)> {
        Lines::new(text.as_bytes()).map(|line| (line.number, decode(&line.text))).filter(|(_, text)| !text.is_empty()).collect()
    }

    #[test]
    fn all_line_ends_count_the_same() {
        let expected = vec![(1, "a".to_owned()), (3, "b".to_owned()), (4, "a line of more than sixteen bytes".to_owned())];
        for end in ["\n", "\r", "\r\n"] {
            let text = format!("a{end}{end}b{end}a line of more than sixteen bytes{end}");
            assert_eq!(lines(&text), expected, "{end:?}");
        }
    }

    #[test]
    fn a_backslash_joins_lines_but_not_after_a_comment() {
        assert_eq!(lines("f 1 2\\\n3 \\\r\n4\nx"), [(1, "f 1 2 3  4".to_owned()), (4, "x".to_owned())]);
        assert_eq!(lines("# C:\\dir\\\nv"), [(1, "# C:\\dir\\".to_owned()), (2, "v".to_owned())]);
        assert_eq!(lines("v \\"), [(1, "v  ".to_owned())]);
    }

    #[test]
    fn a_name_keeps_blanks_and_hashes_that_belong_to_it() {
        assert_eq!(name(b"  Map #1 (wood) "), "Map #1 (wood)");
        assert_eq!(name(b" red # the colour"), "red");
        assert_eq!(name(b" caf\xe9"), "caf\u{e9}");
        assert_eq!(name(" caf\u{e9}".as_bytes()), "caf\u{e9}");
    }

    #[test]
    fn a_quoted_word_stays_on_one_line_and_is_cut() {
        assert_eq!(quoted(b"a\nb"), r#""a\nb""#);
        assert_eq!(quoted(&[b'x'; 200]), format!("\"{}\"...", "x".repeat(40)));
    }

    #[test]
    fn numbers_are_rounded_correctly_and_refused_by_name() {
        assert_eq!(number(b"16777217", "x"), Ok(16777216.0));
        assert_eq!(number(b"+.5e1", "x"), Ok(5.0));
        assert_eq!(number(b"1e-60", "x"), Ok(0.0));
        assert_eq!(number(b"1e999", "coordinate"), Err(r#"coordinate is not finite: "1e999""#.to_owned()));
        assert_eq!(number(b"0,5", "x"), Err(r#""0,5" is not a number: decimals need a point, not a comma"#.to_owned()));
        assert_eq!(number(b"1.0f", "x"), Err(r#""1.0f" is not a number"#.to_owned()));
    }

    #[test]
    fn a_file_over_the_limit_and_a_folder_are_refused() {
        let scratch = super::super::testing::Scratch::new();
        let path = scratch.write("long.txt", b"12345");
        assert_eq!(read_bytes(&path, 5).unwrap(), b"12345");
        assert_eq!(read_bytes(&path, 4).unwrap_err().message, "longer than 4 bytes, the most that is read");
        let folder = read_bytes(scratch.path(), 4).unwrap_err();
        assert_eq!((folder.message.as_str(), folder.io), ("is a folder, not a file", true));
        let missing = read_bytes(&scratch.path().join("none"), 4).unwrap_err();
        assert_eq!((missing.message.as_str(), missing.io), ("no such file", true));
        let utf16 = scratch.write("utf16.txt", b"\xff\xfev\0");
        assert!(read_text(&utf16, 9).unwrap_err().message.starts_with("UTF-16"));
        assert_eq!(read_text(&scratch.write("bom.txt", b"\xef\xbb\xbfv"), 9).unwrap(), b"v");
    }
}
