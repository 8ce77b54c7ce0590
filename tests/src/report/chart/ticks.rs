//! Where an axis has its ticks, and what stands at them.

use crate::report::section::Scale;
use crate::report::table::grouped;

/// A tick: where, and its text; an empty text for a small one.
pub type Tick = (f64, String);

/// The ends of an axis over `values`, with some air; `None` when there is nothing to show.
pub fn ends(scale: Scale, values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let shown = values.filter(|&x| x.is_finite() && (scale == Scale::Linear || x > 0.0));
    let (lo, hi) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
    if lo > hi {
        return None;
    }
    Some(match scale {
        Scale::Log => {
            let air = ((hi / lo).powf(0.06)).max(1.3);
            (lo / air, hi * air)
        }
        Scale::Linear => {
            let air = if hi > lo { 0.05 * (hi - lo) } else { 0.5 * hi.abs().max(1.0) };
            // What starts near 0 starts at 0.
            (if lo >= 0.0 && lo < 0.35 * hi { 0.0 } else { lo - air }, hi + air)
        }
    })
}

/// The ticks between `lo` and `hi`, about `most` of them with a text.
pub fn ticks(scale: Scale, lo: f64, hi: f64, most: usize) -> Vec<Tick> {
    match scale {
        Scale::Linear => linear(lo, hi, most),
        Scale::Log => logarithmic(lo, hi, most),
    }
}

fn linear(lo: f64, hi: f64, most: usize) -> Vec<Tick> {
    let rough = (hi - lo) / most.max(1) as f64;
    if !(rough.is_finite() && rough > 0.0) {
        return Vec::new();
    }
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|k| k * power).find(|&step| step >= rough * 0.999).unwrap_or(10.0 * power);
    let first = (lo / step).ceil() as i64;
    (first..).map(|k| k as f64 * step).take_while(|&x| x <= hi).map(|x| (x, plain(x, step))).collect()
}

/// A number of an even axis, with as many decimals as its step has.
fn plain(x: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).max(0.0) as usize;
    if decimals == 0 { grouped(x) } else { format!("{x:.decimals$}") }
}

fn logarithmic(lo: f64, hi: f64, most: usize) -> Vec<Tick> {
    if !(lo > 0.0 && hi > lo && hi.is_finite()) {
        return Vec::new();
    }
    let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
    let inside = |x: f64| x >= lo && x <= hi;
    let decades = (first..=last).filter(|&k| inside(10f64.powi(k))).count();
    // Fewer than two whole powers: 2 and 5 between them as well; still fewer: evenly.
    let named: &[u32] = if decades >= 3 { &[1] } else { &[1, 2, 5] };
    let mut ticks = Vec::new();
    let every = (decades.div_ceil(most.max(1)) as i32).max(1);
    for k in first..=last {
        for m in 1..10u32 {
            let x = f64::from(m) * 10f64.powi(k);
            if inside(x) {
                let has_text = named.contains(&m) && (m > 1 || k.rem_euclid(every) == 0);
                // Between the ticks of several powers no small ones are left out.
                if has_text || every == 1 || m == 1 {
                    ticks.push((x, if has_text { power(m, k) } else { String::new() }));
                }
            }
        }
    }
    if ticks.iter().filter(|(_, text)| !text.is_empty()).count() < 2 { linear(lo, hi, most) } else { ticks }
}

/// `m` times the `k`-th power of ten: as a number where that is short.
fn power(m: u32, k: i32) -> String {
    match k {
        0..=4 => grouped(f64::from(m) * 10f64.powi(k)),
        -3..=-1 => format!("{:.*}", (-k) as usize, f64::from(m) * 10f64.powi(k)),
        _ if m == 1 => format!("10{}", raised(k)),
        _ => format!("{m}·10{}", raised(k)),
    }
}

/// An exponent in raised digits.
pub fn raised(k: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or('⁻', |d| digits[d as usize]);
    k.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(scale: Scale, lo: f64, hi: f64, most: usize) -> Vec<String> {
        ticks(scale, lo, hi, most).into_iter().map(|(_, text)| text).filter(|text| !text.is_empty()).collect()
    }

    #[test]
    fn even_axes_step_by_one_two_or_five() {
        assert_eq!(named(Scale::Linear, 0.0, 20.5, 5), ["0", "5", "10", "15", "20"]);
        assert_eq!(named(Scale::Linear, 0.13, 0.42, 4), ["0.2", "0.3", "0.4"]);
        assert_eq!(named(Scale::Linear, 0.0, 54_321.0, 3), ["0", "20\u{202f}000", "40\u{202f}000"]);
        assert_eq!(named(Scale::Linear, 1.0, 1.0, 3), [""; 0]);
    }

    #[test]
    fn logarithmic_axes_name_powers_and_mark_what_is_between() {
        assert_eq!(named(Scale::Log, 0.5, 2e6, 8), ["1", "10", "100", "1000", "10\u{202f}000", "10⁵", "10⁶"]);
        assert_eq!(named(Scale::Log, 1.5, 60.0, 8), ["2", "5", "10", "20", "50"]);
        assert_eq!(named(Scale::Log, 1e-12, 1e12, 5).len(), 5);
        assert!(named(Scale::Log, 1.1, 1.4, 4).len() >= 3);
        let all = ticks(Scale::Log, 1.0, 1e4, 8);
        assert_eq!(all.iter().filter(|(_, text)| text.is_empty()).count(), 4 * 8);
        assert!(all.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!(raised(-12), "⁻¹²");
    }

    #[test]
    fn ends_leave_air_and_start_at_zero_where_that_is_near() {
        assert_eq!(ends(Scale::Linear, [2.0, 20.0].into_iter()).map(|(lo, _)| lo), Some(0.0));
        let (lo, hi) = ends(Scale::Log, [1.0, 0.0, 100.0].into_iter()).unwrap();
        assert!(lo < 1.0 && lo > 0.5 && hi > 100.0 && hi < 200.0);
        assert_eq!(ends(Scale::Log, [0.0, -1.0].into_iter()), None);
    }
}
