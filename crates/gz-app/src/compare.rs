//! `gz compare`: how far two pictures or two T-buffers are apart.

use crate::cli::CompareArgs;
use crate::error::{AppError, LoadError};
use crate::new_file::NewFile;
use crate::output::{self, ImageFormat};
use crate::picture::Picture;
use crate::{hits_file, sheet};
use gz_core::Hit;
use std::path::Path;

/// How far apart two pictures or T-buffers are, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels that differ at all; of T-buffers, in any bit.
    pub differing: usize,
    /// Pixels that differ by more than the tolerance.
    pub over: usize,
    /// The greatest difference of a pixel: see [`pictures`] and [`hits`]. Infinite where numbers cannot tell it.
    pub max: f64,
    /// Root of the mean square: over all channels of pictures, over all pixels of T-buffers.
    pub rmse: f64,
    /// The pixel that differs most, row-major, the first of several; `None` when none differs.
    pub worst: Option<usize>,
}

impl Difference {
    /// From the differences of pixels: the greatest, the sum of squares, and whether it differs at all.
    fn of(pixels: impl Iterator<Item = (f64, f64, bool)>, channels: usize, tolerance: f64) -> Self {
        let mut total = Self { pixels: 0, differing: 0, over: 0, max: 0.0, rmse: 0.0, worst: None };
        let mut squares = 0.0;
        for (i, (difference, square, differs)) in pixels.enumerate() {
            total.pixels += 1;
            squares += square;
            total.differing += usize::from(differs);
            // With no tolerance at all, the bits decide: -0 is not 0.
            total.over += usize::from(difference > tolerance || (tolerance == 0.0 && differs));
            if differs && (total.worst.is_none() || difference > total.max) {
                (total.worst, total.max) = (Some(i), difference);
            }
        }
        total.rmse = (squares / (total.pixels * channels).max(1) as f64).sqrt();
        total
    }

    /// Peak signal-to-noise ratio in decibels; infinite for equal pictures.
    pub fn psnr(&self, peak: f32) -> f64 {
        20.0 * (f64::from(peak) / self.rmse).log10()
    }
}

/// How far apart two numbers are: 0 for equal ones, two NaNs among them; infinite when only one is NaN or infinite.
fn apart(a: f32, b: f32) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let difference = (f64::from(a) - f64::from(b)).abs();
    if difference.is_nan() { f64::INFINITY } else { difference }
}

/// Compares two pictures. A pixel's difference is that of its most different channel.
///
/// # Errors
///
/// If they have different sizes, or one is linear and the other encoded.
pub fn pictures(expected: &Picture, actual: &Picture, tolerance: f64) -> Result<Difference, String> {
    if (expected.width, expected.height) != (actual.width, actual.height) {
        let (a, b) = (expected, actual);
        return Err(format!("sizes differ: {}x{} and {}x{}", a.width, a.height, b.width, b.height));
    }
    if expected.unit != actual.unit {
        return Err("one picture is linear (pfm), the other encoded: render both in one format".to_owned());
    }
    let pixels = expected.rgb.iter().zip(&actual.rgb).map(|(a, b)| {
        let channels: [f64; 3] = std::array::from_fn(|k| apart(a[k], b[k]));
        let most = channels.into_iter().fold(0.0, f64::max);
        (most, channels.iter().map(|d| d * d).sum(), most > 0.0)
    });
    Ok(Difference::of(pixels, 3, tolerance))
}

/// Compares two T-buffers.
///
/// A pixel's difference is infinite when the triangles differ, else the greatest of: T-values relative to the expected one, u, and v.
///
/// # Errors
///
/// If they have different lengths.
pub fn hits(expected: &[Hit], actual: &[Hit], tolerance: f64) -> Result<Difference, String> {
    if expected.len() != actual.len() {
        return Err(format!("lengths differ: {} and {} hits", expected.len(), actual.len()));
    }
    let bits = |hit: &Hit| (hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits());
    let pixels = expected.iter().zip(actual).map(|(a, b)| {
        let relative = |d: f64| if d == 0.0 { 0.0 } else { d / f64::from(a.t.abs()) };
        let most = match a.tri == b.tri {
            true => relative(apart(a.t, b.t)).max(apart(a.u, b.u)).max(apart(a.v, b.v)),
            false => f64::INFINITY,
        };
        (most, most * most, bits(a) != bits(b))
    });
    Ok(Difference::of(pixels, 1, tolerance))
}

/// What `gz compare` found.
#[derive(Debug)]
pub struct Comparison {
    /// The figures, as lines of text.
    pub report: String,
    /// An error when the two differ by more than the tolerance.
    pub verdict: Result<(), AppError>,
}

/// Does what `gz compare` is asked for, the sheet included.
///
/// # Errors
///
/// If a file cannot be read or written, or the two are not of one kind. A difference is no error here: see [`Comparison::verdict`].
pub fn compare(args: &CompareArgs) -> Result<Comparison, AppError> {
    let sheet = args.sheet.as_deref().map(|path| sheet_file(path, args)).transpose()?;
    match (Picture::is_named(&args.expected), Picture::is_named(&args.actual)) {
        (true, true) => {
            let (expected, actual) = (Picture::read(&args.expected)?, Picture::read(&args.actual)?);
            let found = pictures(&expected, &actual, args.tolerance);
            if let (Some((file, format)), Ok(_)) = (&sheet, &found) {
                write_sheet(file, *format, &sheet::of_pictures(&expected, &actual))?;
            }
            Ok(judge(args, found, expected.width, |found, i| picture_lines(found, i, &expected, &actual)))
        }
        (false, false) => {
            let read = |path: &Path| -> Result<Vec<Hit>, AppError> {
                let bytes = std::fs::read(path).map_err(|error| LoadError::io(path, &error))?;
                Ok(hits_file::decode(&bytes).map_err(|message| LoadError::bad(path, None, message))?)
            };
            let (expected, actual) = (read(&args.expected)?, read(&args.actual)?);
            if let Some((width, height)) = args.size
                && u64::from(width) * u64::from(height) != expected.len() as u64
            {
                return Err(AppError::Usage(format!("--size {width}x{height} does not fit {} hits", expected.len())));
            }
            let found = hits(&expected, &actual, args.tolerance);
            let width = args.size.map_or(expected.len() as u32, |size| size.0);
            if let (Some((file, format)), Ok(_)) = (&sheet, &found) {
                if args.size.is_none() {
                    return Err(AppError::Usage("--sheet of T-buffers needs their --size".to_owned()));
                }
                write_sheet(file, *format, &sheet::of_hits(width, &expected, &actual))?;
            }
            Ok(judge(args, found, width, |_, i| hit_lines(i, &expected, &actual)))
        }
        _ => Err(AppError::Usage(format!(
            "{} and {}: a picture (png, ppm, pfm) cannot be compared with a T-buffer",
            args.expected.display(),
            args.actual.display()
        ))),
    }
}

/// The figures as text, and whether they are within the tolerance.
fn judge(
    args: &CompareArgs,
    found: Result<Difference, String>,
    width: u32,
    more: impl Fn(&Difference, Option<usize>) -> String,
) -> Comparison {
    let names = format!("{} and {}", args.expected.display(), args.actual.display());
    let found = match found {
        Ok(found) => found,
        Err(reason) => {
            return Comparison { report: String::new(), verdict: Err(AppError::Differs(format!("{names}: {reason}"))) };
        }
    };
    let share = 100.0 * found.differing as f64 / found.pixels.max(1) as f64;
    let place = |i: usize| format!("({}, {})", i as u64 % u64::from(width.max(1)), i as u64 / u64::from(width.max(1)));
    let worst = found.worst.map_or("none".to_owned(), place);
    let report = format!(
        "pixels            {}\ndiffering         {} ({share:.4} %)\nover tolerance    {} (tolerance {})\nmax               {}\n\
         rmse              {}\n{}worst pixel       {worst}\n",
        found.pixels,
        found.differing,
        found.over,
        args.tolerance,
        found.max,
        found.rmse,
        more(&found, found.worst),
    );
    let verdict = match found.over {
        0 => Ok(()),
        over => Err(AppError::Differs(format!(
            "{names} differ in {over} of {} pixels by more than {}, most at {worst} by {}",
            found.pixels, args.tolerance, found.max
        ))),
    };
    Comparison { report, verdict }
}

fn picture_lines(found: &Difference, worst: Option<usize>, expected: &Picture, actual: &Picture) -> String {
    let psnr = format!("psnr              {:.2} dB\n", found.psnr(expected.peak()));
    match worst {
        Some(i) => format!("{psnr}expected there    {:?}\nactual there      {:?}\n", expected.rgb[i], actual.rgb[i]),
        None => psnr,
    }
}

fn hit_lines(worst: Option<usize>, expected: &[Hit], actual: &[Hit]) -> String {
    let others = expected.iter().zip(actual).filter(|(a, b)| a.tri != b.tri).count();
    let others = format!("other triangles   {others}\n");
    match worst {
        Some(i) => format!("{others}expected there    {:?}\nactual there      {:?}\n", expected[i], actual[i]),
        None => others,
    }
}

fn sheet_file(path: &Path, args: &CompareArgs) -> Result<(NewFile, ImageFormat), AppError> {
    let format = ImageFormat::of(path)?;
    if format == ImageFormat::Pfm {
        return Err(AppError::Usage(format!("{}: a sheet is written as png or ppm", path.display())));
    }
    let file = NewFile::at(path)?;
    if file.is(&args.expected) || file.is(&args.actual) {
        return Err(AppError::Usage(format!("{}: would overwrite a picture that is compared", path.display())));
    }
    Ok((file, format))
}

fn write_sheet(file: &NewFile, format: ImageFormat, sheet: &sheet::Sheet) -> Result<(), AppError> {
    file.write(&match format {
        ImageFormat::Ppm => output::ppm(sheet.width, sheet.height, &sheet.rgb),
        _ => output::png(sheet.width, sheet.height, &sheet.rgb)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Unit;

    fn grey(values: &[u8]) -> Picture {
        let rgb: Vec<u8> = values.iter().flat_map(|&v| [v; 3]).collect();
        Picture::of_bytes(values.len() as u32, 1, &rgb)
    }

    #[test]
    fn equal_pictures_have_no_worst_pixel() {
        let found = pictures(&grey(&[1, 2, 3]), &grey(&[1, 2, 3]), 0.0).unwrap();
        assert_eq!((found.differing, found.over, found.max, found.worst), (0, 0, 0.0, None));
        assert_eq!(found.psnr(255.0), f64::INFINITY);
    }

    #[test]
    fn the_figures_of_a_small_difference_are_right() {
        let found = pictures(&grey(&[10, 20, 30, 40]), &grey(&[10, 22, 30, 39]), 1.0).unwrap();
        assert_eq!((found.pixels, found.differing, found.over, found.max, found.worst), (4, 2, 1, 2.0, Some(1)));
        assert_eq!(found.rmse, (5.0f64 / 4.0).sqrt());
    }

    #[test]
    fn one_nan_is_worse_than_any_number() {
        let linear = |v: f32| Picture { unit: Unit::Linear, rgb: vec![[v; 3]], ..grey(&[0]) };
        assert_eq!(pictures(&linear(0.5), &linear(f32::NAN), 1e9).unwrap().over, 1);
        assert_eq!(pictures(&linear(f32::NAN), &linear(f32::NAN), 0.0).unwrap().differing, 0);
        assert!(pictures(&linear(0.0), &grey(&[0]), 0.0).is_err());
    }

    #[test]
    fn sizes_must_agree() {
        assert_eq!(pictures(&grey(&[1, 2]), &grey(&[1]), 0.0).unwrap_err(), "sizes differ: 2x1 and 1x1");
        assert_eq!(hits(&[Hit::MISS], &[], 0.0).unwrap_err(), "lengths differ: 1 and 0 hits");
    }

    #[test]
    fn another_triangle_is_over_any_tolerance_and_a_sign_bit_over_none() {
        let hit = Hit { t: 2.0, tri: 3, u: 0.0, v: 0.5 };
        assert_eq!(hits(&[hit], &[Hit { tri: 4, ..hit }], 1e9).unwrap().over, 1);
        let signed = [Hit { u: -0.0, ..hit }];
        assert_eq!(hits(&[hit], &signed, 0.0).unwrap().over, 1);
        assert_eq!(hits(&[hit], &signed, 1e-9).unwrap().over, 0);
        let later = Hit { t: 2.5, ..hit };
        assert_eq!(hits(&[hit, Hit::MISS], &[later, Hit::MISS], 0.3).unwrap().max, 0.25);
    }
}
