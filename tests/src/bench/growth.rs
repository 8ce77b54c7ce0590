//! How something grows: the exponent of a power law, and how well it fits.

/// A power of n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    /// The power.
    pub exponent: f64,
    /// Root mean square of what the logarithms are off by: nearly a relative error.
    pub residual: f64,
}

impl Power {
    /// The least-squares line of log y = e log x + c; `None` for fewer than two sizes.
    pub fn fit(x: &[f64], y: &[f64]) -> Option<Self> {
        let n = x.len() as f64;
        let mean = |values: &[f64]| values.iter().map(|v| v.ln()).sum::<f64>() / n;
        let (mx, my) = (mean(x), mean(y));
        let off = || x.iter().zip(y).map(|(x, y)| (x.ln() - mx, y.ln() - my));
        let (over, under) = off().fold((0.0, 0.0), |(over, under), (dx, dy)| (over + dx * dy, under + dx * dx));
        let exponent = over / under;
        let residual = (off().map(|(dx, dy)| (dy - exponent * dx).powi(2)).sum::<f64>() / n).sqrt();
        (x.len() >= 2 && under > 0.0).then_some(Self { exponent, residual })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_of_a_power_is_found() {
        let x = [1e3, 1e4, 1e6];
        let exact = Power::fit(&x, &x.map(|x: f64| 3.0 * x.powf(1.1))).unwrap();
        assert!((exact.exponent - 1.1).abs() < 1e-9 && exact.residual < 1e-9, "{exact:?}");
        assert_eq!(Power::fit(&x[..1], &x[..1]), None);
    }

    #[test]
    fn the_residual_is_what_a_power_leaves() {
        // 1, 2, 1 at equal steps: the line is level, and off by -1/3, 2/3 and -1/3 of ln 2.
        let fit = Power::fit(&[1.0, 10.0, 100.0], &[1.0, 2.0, 1.0]).unwrap();
        assert!(fit.exponent.abs() < 1e-12 && (fit.residual - 2f64.ln() * 2f64.sqrt() / 3.0).abs() < 1e-12, "{fit:?}");
    }
}
