//! Bars across the page, of several parts each, as SVG.

use super::escape;
use super::labels::width_of;
use super::plot::Size;
use super::ticks::ticks;
use crate::report::section::Scale;
use crate::report::table::short;
use std::fmt::Write;

/// A bar: its name, the values of its parts, and what is shown when it is pointed at.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// What it is of.
    pub name: String,
    /// One value for each part, at least 0.
    pub values: Vec<f64>,
    /// What is shown when it is pointed at.
    pub hover: String,
}

/// Bars over one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// What stands at the axis.
    pub title: String,
    /// The bars.
    pub bars: Vec<Bar>,
    /// Colours of the parts.
    pub tones: Vec<&'static str>,
}

const ROW: f64 = 26.0;
const THICK: f64 = 16.0;

impl Bars {
    /// The bars as an SVG element of a class; nothing when there is none. The height follows from their number.
    pub fn svg(&self, class: &str, size: Size) -> String {
        let most = self.bars.iter().map(|bar| bar.values.iter().sum::<f64>()).fold(0.0, f64::max);
        if self.bars.is_empty() || !(most > 0.0 && most.is_finite()) {
            return String::new();
        }
        let left = self.bars.iter().map(|bar| width_of(&bar.name)).fold(0.0, f64::max).min(size.width * 0.45) + 12.0;
        let right = size.width - 56.0;
        let (top, bottom) = (8.0, 8.0 + ROW * self.bars.len() as f64);
        let height = bottom + 52.0;
        let at = |value: f64| left + value / most * (right - left);
        let mut svg = format!(
            "<svg class=\"{class}\" viewBox=\"0 0 {0} {height}\" width=\"{0}\" height=\"{height}\" role=\"img\" aria-label=\"{1}\">\n",
            size.width,
            escape(&self.title)
        );
        // Writing to a string cannot fail.
        for (value, text) in ticks(Scale::Linear, 0.0, most, if size.width < 500.0 { 2 } else { 5 }) {
            let x = at(value);
            let _ = writeln!(svg, "<line class=\"grid\" x1=\"{x:.1}\" y1=\"{top}\" x2=\"{x:.1}\" y2=\"{bottom}\"/>");
            let _ = writeln!(svg, "<text class=\"tick x\" x=\"{x:.1}\" y=\"{}\">{text}</text>", bottom + 18.0);
        }
        for (k, bar) in self.bars.iter().enumerate() {
            let middle = top + ROW * (k as f64 + 0.5);
            let _ = writeln!(
                svg,
                "<text class=\"tick y\" x=\"{}\" y=\"{:.1}\">{}</text>",
                left - 8.0,
                middle + 4.0,
                escape(&bar.name)
            );
            let _ = write!(svg, "<g class=\"mark\" tabindex=\"0\"><title>{}</title>", escape(&bar.hover));
            let (mut sum, y) = (0.0, middle - THICK / 2.0);
            let _ =
                write!(svg, "<rect class=\"reach\" x=\"{left}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{THICK}\"/>", right - left);
            for (&value, tone) in bar.values.iter().zip(&self.tones).filter(|(value, _)| **value > 0.0) {
                let (x0, x1) = (at(sum), at(sum + value));
                sum += value;
                let _ = write!(
                    svg,
                    "<rect x=\"{x0:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{THICK}\" fill=\"{tone}\"/>",
                    (x1 - x0).max(0.5)
                );
            }
            let _ = writeln!(
                svg,
                "<text class=\"sum\" x=\"{:.1}\" y=\"{:.1}\">{}</text></g>",
                at(sum) + 6.0,
                middle + 4.0,
                short(sum)
            );
        }
        let _ = writeln!(svg, "<path class=\"axis\" d=\"M{left} {top}V{bottom}\"/>");
        let _ = writeln!(
            svg,
            "<text class=\"title\" x=\"{right}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            bottom + 42.0,
            escape(&self.title)
        );
        svg + "</svg>\n"
    }
}
