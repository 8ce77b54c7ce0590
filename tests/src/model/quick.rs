//! Errors that take no rendering: triangles for patches, bytes for colours.

use super::kernels::Errors;
use super::{Table, figure};
use gz_app::teapot::tessellate;
use gz_shade::color::{course12_byte, linear_from_srgb_byte, srgb_byte};

/// How far the teapot's triangles are from its patches, in the middle of each quad's diagonal: the distance in units of the model,
/// in which the pot is 6.4 long, and the angle in degrees between the interpolated and the true normal.
///
/// `segments` is 1 to 200. Quads whose normal is nowhere defined are left out.
pub fn patch_errors(segments: u32) -> (Errors, Errors) {
    // The vertices of twice as many segments: every other one is a corner of ours, those between are the true middles.
    let fine = tessellate(2 * segments, true);
    let row = 2 * segments as usize + 1;
    let (mut distance, mut angle) = (Errors::default(), Errors::default());
    for (points, normals) in fine.positions.chunks_exact(row * row).zip(fine.normals.chunks_exact(row * row)) {
        for (i, j) in (0..segments as usize).flat_map(|j| (0..segments as usize).map(move |i| (2 * i, 2 * j))) {
            let at = |i: usize, j: usize| {
                let k = i + row * j;
                (points[k].as_dvec3(), normals[k].as_dvec3())
            };
            let ((a, na), (b, nb), (middle, normal)) = (at(i, j), at(i + 2, j + 2), at(i + 1, j + 1));
            let Some(interpolated) = (na + nb).try_normalize().filter(|_| normal.length() > 0.5) else { continue };
            // Along the normal: where on the patch the middle lies is no error.
            distance.add(((a + b) / 2.0 - middle).dot(normal).abs());
            angle.add(interpolated.cross(normal).length().atan2(interpolated.dot(normal)).to_degrees());
        }
    }
    (distance, angle)
}

pub(super) fn patches_table() -> Table {
    let row = |segments: u32| {
        let (distance, angle) = patch_errors(segments);
        let cells = [figure(distance.max), figure(distance.mean()), figure(angle.max), figure(angle.mean())];
        let counts = [segments.to_string(), (64 * segments * segments).to_string()];
        counts.into_iter().chain(cells).chain([distance.n.to_string()]).collect()
    };
    Table {
        title: "Triangles for patches".to_owned(),
        how: "The teapot in its own units, 6.4 from spout to handle: the middles of the quads' diagonals against the same places of the \
              Bezier patches. Distance is along the patch's normal; the angle is between the interpolated normal and the patch's."
            .to_owned(),
        columns: vec!["segments", "triangles", "distance, max", "mean", "degrees, max", "mean", "n quads"],
        rows: [4, 10, 16, 32].map(row).to_vec(),
    }
}

/// The greatest error of a channel that is written to a byte and read back, over `n` channels from 0 to `most`.
pub fn write_error(n: u32, most: f32, write: impl Fn(f32) -> u8, read: impl Fn(u8) -> f32) -> f64 {
    let channel = |k: u32| most * k as f32 / (n - 1) as f32;
    (0..n).map(channel).map(|c| (f64::from(read(write(c))) - f64::from(c)).abs()).fold(0.0, f64::max)
}

/// What the course's byte stands for.
fn course12_channel_of(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}

pub(super) fn codes_table() -> Table {
    const CHANNELS: u32 = 1 << 16;
    let row = |name: &str, write: fn(f32) -> u8, read: fn(u8) -> f32| {
        let [dark, all] = [0.1, 1.0].map(|most| figure(write_error(CHANNELS, most, write, read)));
        vec![name.to_owned(), dark, all, CHANNELS.to_string()]
    };
    Table {
        title: "Colours as bytes".to_owned(),
        how: "Channels spread evenly from 0, written as a byte and read back as linear values; the greatest error up to 0.1, where the \
              eye tells steps apart best, and up to 1. The course cuts to 12 bits and keeps the upper 8."
            .to_owned(),
        columns: vec!["code", "max error up to 0.1", "max error up to 1", "n each"],
        rows: vec![
            row("sRGB, rounded (default)", srgb_byte, linear_from_srgb_byte),
            row("12 bits, cut (course)", course12_byte, course12_channel_of),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_the_segments_leave_a_quarter_of_the_distance_and_of_the_angle() {
        let ([coarse, fine], [coarse_angle, fine_angle]) = {
            let (a, b) = (patch_errors(16), patch_errors(32));
            ([a.0, b.0], [a.1, b.1])
        };
        let ratio = |a: Errors, b: Errors| a.mean() / b.mean();
        assert!((3.8..4.2).contains(&ratio(coarse, fine)), "{coarse:?} {fine:?}");
        assert!((3.5..4.5).contains(&ratio(coarse_angle, fine_angle)), "{coarse_angle:?} {fine_angle:?}");
        assert!(coarse.max < 0.02 && coarse.n > 8000, "{coarse:?}");
    }

    #[test]
    fn a_course_byte_is_off_by_up_to_a_step_and_srgb_is_finer_in_the_dark() {
        let course = [0.1, 1.0].map(|most| write_error(4096, most, course12_byte, course12_channel_of));
        let srgb = [0.1, 1.0].map(|most| write_error(4096, most, srgb_byte, linear_from_srgb_byte));
        assert!(course.iter().all(|&error| error > 0.003 && error < 0.004), "{course:?}");
        assert!(srgb[0] < course[0] / 2.0 && srgb[1] > srgb[0] && srgb[1] < 0.005, "{srgb:?}");
    }
}
