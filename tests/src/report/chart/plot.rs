//! Points and lines between two axes, as SVG.

use super::escape;
use super::labels::{Rect, place, width_of};
use super::ticks::{ends, ticks};
use crate::report::section::Scale;
use std::fmt::Write;

/// A point of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Along the page.
    pub x: f64,
    /// Up the page.
    pub y: f64,
    /// The number of its series.
    pub series: usize,
    /// What stands beside it.
    pub label: String,
    /// What is shown when it is pointed at.
    pub hover: String,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// What stands at it.
    pub title: String,
    /// How it is divided.
    pub scale: Scale,
}

/// A plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Along the page.
    pub x: Side,
    /// Up the page.
    pub y: Side,
    /// The points.
    pub marks: Vec<Mark>,
    /// Colours of the series.
    pub tones: Vec<&'static str>,
    /// Whether the points of a series are joined.
    pub joined: bool,
    /// What stands at the band for zeros; empty for no band.
    pub zeros: String,
}

/// How large it is drawn, in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

const LEFT: f64 = 62.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 52.0;
/// Height of the band for zeros.
const BAND: f64 = 40.0;

/// From values to pixels.
struct Map {
    scale: Scale,
    ends: (f64, f64),
    pixels: (f64, f64),
}

impl Map {
    fn at(&self, value: f64) -> f64 {
        let place = |x: f64| if self.scale == Scale::Log { x.ln() } else { x };
        let (lo, hi) = (place(self.ends.0), place(self.ends.1));
        self.pixels.0 + (place(value) - lo) / (hi - lo) * (self.pixels.1 - self.pixels.0)
    }
}

impl Plot {
    /// The plot as an SVG element of a class; nothing when there is no point that can be shown.
    pub fn svg(&self, class: &str, size: Size) -> String {
        let has_zeros = !self.zeros.is_empty();
        let is_zero = |mark: &Mark| has_zeros && mark.y == 0.0;
        let Some(x_ends) = ends(self.x.scale, self.marks.iter().map(|mark| mark.x)) else { return String::new() };
        let above = self.marks.iter().filter(|mark| !is_zero(mark)).map(|mark| mark.y);
        let y_ends = ends(self.y.scale, above).unwrap_or((1.0, 10.0));
        let (right, bottom) = (size.width - RIGHT, size.height - BOTTOM);
        let floor = if has_zeros { bottom - BAND } else { bottom };
        let x = Map { scale: self.x.scale, ends: x_ends, pixels: (LEFT, right) };
        let y = Map { scale: self.y.scale, ends: y_ends, pixels: (floor, TOP) };

        let mut svg = format!(
            "<svg class=\"{class}\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" aria-label=\"{2}\">\n",
            size.width,
            size.height,
            escape(&format!("{} against {}", self.y.title, self.x.title))
        );
        // Writing to a string cannot fail.
        let narrow = size.width < 500.0;
        self.draw_axes(&mut svg, &x, &y, if narrow { 4 } else { 8 });
        if has_zeros {
            let _ =
                writeln!(svg, "<rect class=\"band\" x=\"{LEFT}\" y=\"{floor}\" width=\"{}\" height=\"{BAND}\"/>", right - LEFT);
            let _ = writeln!(svg, "<text class=\"band\" x=\"{}\" y=\"{}\">0</text>", LEFT - 8.0, floor + BAND / 2.0 + 4.0);
            let _ =
                writeln!(svg, "<text class=\"hint\" x=\"{}\" y=\"{}\">{}</text>", right - 4.0, bottom - 4.0, escape(&self.zeros));
        }
        let places: Vec<(f64, f64)> = self
            .marks
            .iter()
            .map(|mark| (x.at(mark.x), if is_zero(mark) { floor + BAND / 2.0 - 4.0 } else { y.at(mark.y) }))
            .collect();
        if self.joined {
            self.draw_lines(&mut svg, &places);
        }
        for (mark, (px, py)) in self.marks.iter().zip(&places) {
            if px.is_finite() && py.is_finite() {
                let _ = writeln!(
                    svg,
                    "<g class=\"mark\" tabindex=\"0\"><title>{}</title><circle class=\"reach\" cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"12\"/><circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"{}\" fill=\"{}\"/></g>",
                    escape(&mark.hover),
                    if self.joined { 3.5 } else { 5.5 },
                    self.tones[mark.series]
                );
            }
        }
        let words: Vec<(f64, f64, &str)> =
            self.marks.iter().zip(&places).map(|(mark, &(px, py))| (px, py, mark.label.as_str())).collect();
        let area = Rect { x0: LEFT + 2.0, y0: TOP - 8.0, x1: right, y1: bottom - 1.0 };
        for ((mark, rect), &(px, _)) in self.marks.iter().zip(place(&words, &area)).zip(&places) {
            let Some(rect) = rect else { continue };
            let (at, anchor) = if rect.x0 > px {
                (rect.x0, "start")
            } else if rect.x1 < px {
                (rect.x1, "end")
            } else {
                ((rect.x0 + rect.x1) / 2.0, "middle")
            };
            let _ = writeln!(
                svg,
                "<text class=\"label\" x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"{}\">{}</text>",
                rect.y1 - 3.0,
                self.tones[mark.series],
                escape(&mark.label)
            );
        }
        svg + "</svg>\n"
    }

    fn draw_axes(&self, svg: &mut String, x: &Map, y: &Map, most: usize) {
        let ((left, right), (floor, top)) = (x.pixels, y.pixels);
        let bottom = if self.zeros.is_empty() { floor } else { floor + BAND };
        let mut last = f64::NEG_INFINITY;
        for (value, text) in ticks(x.scale, x.ends.0, x.ends.1, most) {
            let at = x.at(value);
            let class = if text.is_empty() { "fine" } else { "grid" };
            let _ = writeln!(svg, "<line class=\"{class}\" x1=\"{at:.1}\" y1=\"{top}\" x2=\"{at:.1}\" y2=\"{bottom}\"/>");
            // Words that would run into each other are left out.
            let half = width_of(&text) / 2.0;
            if !text.is_empty() && at - half > last + 4.0 && at + half < right + 14.0 {
                let _ = writeln!(svg, "<text class=\"tick x\" x=\"{at:.1}\" y=\"{}\">{text}</text>", bottom + 18.0);
                last = at + half;
            }
        }
        for (value, text) in ticks(y.scale, y.ends.0, y.ends.1, 6) {
            let at = y.at(value);
            let class = if text.is_empty() { "fine" } else { "grid" };
            let _ = writeln!(svg, "<line class=\"{class}\" x1=\"{left}\" y1=\"{at:.1}\" x2=\"{right}\" y2=\"{at:.1}\"/>");
            if !text.is_empty() {
                let _ = writeln!(svg, "<text class=\"tick y\" x=\"{}\" y=\"{:.1}\">{text}</text>", left - 8.0, at + 4.0);
            }
        }
        let _ = writeln!(svg, "<path class=\"axis\" d=\"M{left} {top}V{bottom}H{right}\"/>");
        let _ = writeln!(svg, "<text class=\"title\" x=\"4\" y=\"16\">{}</text>", escape(&self.y.title));
        let _ = writeln!(
            svg,
            "<text class=\"title\" x=\"{right}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            bottom + 42.0,
            escape(&self.x.title)
        );
    }

    fn draw_lines(&self, svg: &mut String, places: &[(f64, f64)]) {
        for (series, tone) in self.tones.iter().enumerate() {
            let own =
                self.marks.iter().zip(places).filter(|(mark, (x, y))| mark.series == series && x.is_finite() && y.is_finite());
            let path: Vec<String> = own.map(|(_, (x, y))| format!("{x:.1} {y:.1}")).collect();
            if path.len() > 1 {
                let _ = writeln!(svg, "<path class=\"line\" stroke=\"{tone}\" d=\"M{}\"/>", path.join("L"));
            }
        }
    }
}
