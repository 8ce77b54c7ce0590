//! What a running render says on standard error.

use gz_core::Tile;
use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// How progress is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProgressMode {
    /// A bar where standard error is a terminal, nothing elsewhere.
    #[default]
    Auto,
    /// A line for every tenth.
    Plain,
    /// Lines of JSON: `progress` for every hundredth, `warning`, and `done` at the end.
    Json,
    /// Nothing, not even the closing line. Warnings still come.
    None,
}

/// Progress of one render, counted in pixels. Tiles may report from any thread.
#[derive(Debug)]
pub struct Progress {
    mode: ProgressMode,
    started: Instant,
    total: u64,
    /// Pixels done. Locked while a line is written, so that lines never go backwards.
    done: Mutex<u64>,
    bar: Option<indicatif::ProgressBar>,
}

impl Progress {
    /// Nothing done yet; the pixels to come are not known before [`Self::begin`].
    pub fn new(mode: ProgressMode) -> Self {
        Self { mode, started: Instant::now(), total: 0, done: Mutex::new(0), bar: None }
    }

    /// From here on, `total` pixels are worked on.
    pub fn begin(&mut self, total: u64) {
        self.total = total;
        if self.mode == ProgressMode::Auto && std::io::stderr().is_terminal() {
            let bar = indicatif::ProgressBar::new(total);
            // The template is a constant; should it ever be wrong, the library's own look is good enough.
            if let Ok(style) = indicatif::ProgressStyle::with_template("{bar:40} {percent:>3}%  {elapsed} (still {eta})") {
                bar.set_style(style);
            }
            self.bar = Some(bar);
        }
    }

    /// The pixels of `tile` are done.
    pub fn advance(&self, tile: &Tile) {
        let pixels = tile.len() as u64;
        if let Some(bar) = &self.bar {
            bar.inc(pixels);
        }
        let parts = match self.mode {
            ProgressMode::Plain => 10,
            ProgressMode::Json => 100,
            ProgressMode::Auto | ProgressMode::None => return,
        };
        // A thread that panicked while it held the lock has left a count that is still good.
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        let before = *done;
        *done += pixels;
        if let Some(part) = step_reached(before, *done, self.total, parts) {
            let seconds = self.started.elapsed().as_secs_f64();
            say(&match self.mode {
                ProgressMode::Json => {
                    let line = serde_json::json!({ "event": "progress", "percent": part, "pixels": *done, "of": self.total, "seconds": seconds });
                    line.to_string()
                }
                _ => format!("{:>5}%  {seconds:.1} s", part * 10),
            });
        }
    }

    /// Something odd but usable, in one line.
    pub fn warn(&self, message: &str) {
        match self.mode {
            ProgressMode::Json => say(&serde_json::json!({ "event": "warning", "message": message }).to_string()),
            _ => say(&format!("gz: warning: {message}")),
        }
    }

    /// The end: `summary` is one line, `stats` the same for programs.
    pub fn finish(&self, summary: &str, stats: &serde_json::Value) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        match self.mode {
            ProgressMode::None => {}
            ProgressMode::Json => say(&serde_json::json!({ "event": "done", "stats": stats }).to_string()),
            ProgressMode::Auto | ProgressMode::Plain => say(summary),
        }
    }
}

/// The part (of `parts`) that is full after the step from `before` to `after` of `total`, when it was not before.
fn step_reached(before: u64, after: u64, total: u64, parts: u64) -> Option<u64> {
    let part = |done: u64| u128::from(done) * u128::from(parts) / u128::from(total.max(1));
    (part(after) > part(before)).then(|| part(after).min(u128::from(parts)) as u64)
}

/// One line on standard error. A closed standard error is no reason to stop a render.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_tenth_is_told_once() {
        let told: Vec<u64> = (0..100).filter_map(|k| step_reached(k * 7, k * 7 + 7, 700, 10)).collect();
        assert_eq!(told, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
    }

    #[test]
    fn one_big_tile_is_told_as_the_end() {
        assert_eq!(step_reached(0, 9, 9, 10), Some(10));
        assert_eq!(step_reached(0, 0, 0, 10), None);
    }
}
