//! Other ways to leave a surface, for comparison with the exact one.

use crate::leave::leave_surface;
use crate::{GzCoord, GzRay};
use glam::DVec3;

/// Where shadow, mirror and glass rays start, and what they do not see.
///
/// [`Self::Exact`] is the only one whose answers are right by proof. The others start, as is usual, from the hit point in f32, which lies
/// on either side of its triangle, and cure that each in its own way; the report counts what that costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LeavePolicy {
    /// [`leave_surface`]: from a point in f64 that is proved to be on the side that the ray goes to.
    #[default]
    Exact,
    /// From the hit point in f32, with no cure.
    Bare,
    /// The paper's rule: the triangle that the ray leaves is not seen. Its neighbours are, so that a flat quad shadows itself along its
    /// diagonal.
    Identity,
    /// Hits up to this t do not count. Too small or too large, depending on the scene's scale.
    Epsilon(f32),
    /// The point is moved along the normal by 256 of its own steps, near the origin of space by 2^-16.
    WaechterBinder,
    /// The point is moved along the normal out of the box of its own rounding errors.
    ErrorBound,
}

impl LeavePolicy {
    /// [`Self::Epsilon`] with the number that is most often seen, 1e-4.
    pub const USUAL_EPSILON: Self = Self::Epsilon(1e-4);

    /// All of them, the exact one first, with the usual epsilon.
    pub const ALL: [Self; 6] =
        [Self::Exact, Self::Bare, Self::Identity, Self::USUAL_EPSILON, Self::WaechterBinder, Self::ErrorBound];

    /// The ray that leaves the triangle along `direction` at the point with these `weights`; `None` when the exact rule has no way out.
    ///
    /// Whoever asks about it has to mind [`Self::skips_source`].
    pub fn leave(self, corners: &[GzCoord; 3], weights: [f64; 3], direction: GzCoord) -> Option<GzRay> {
        let origin = match self {
            Self::Exact => leave_surface(corners, weights, direction)?,
            _ => self.cured(corners, weights, direction),
        };
        Some(GzRay { tmin: self.tmin(), ..GzRay::from_f64(origin, direction) })
    }

    /// Where rays start by the rules that are no proof.
    fn cured(self, corners: &[GzCoord; 3], weights: [f64; 3], direction: GzCoord) -> DVec3 {
        let (point, error) = rounded_point(corners, weights);
        // The least f32 is 2^-149, so that no origin is too small for a ray.
        match self {
            Self::WaechterBinder => by_integer_steps(point, leaving_normal(corners, direction)).as_dvec3(),
            Self::ErrorBound => out_of_error_box(point, error, leaving_normal(corners, direction)).as_dvec3(),
            Self::Exact | Self::Bare | Self::Identity | Self::Epsilon(_) => point.as_dvec3(),
        }
    }

    /// Whether rays start from the places of a [`crate::SurfacePoint`].
    pub fn needs_starts(self) -> bool {
        self == Self::Exact
    }

    /// Hits of leaving rays at or before this t do not count.
    pub fn tmin(self) -> f32 {
        if let Self::Epsilon(t) = self { t } else { 0.0 }
    }

    /// Whether hits on the triangle that a ray leaves do not count.
    pub fn skips_source(self) -> bool {
        self == Self::Identity
    }
}

/// 2^-24, the unit roundoff of f32.
const U: f32 = f32::EPSILON / 2.0;

/// The hit point in f32, and how far each coordinate may be off: the weighted sum of three corners passes up to seven roundings a term.
fn rounded_point(corners: &[GzCoord; 3], weights: [f64; 3]) -> (GzCoord, GzCoord) {
    let [a, b, c] = *corners;
    let [wa, wb, wc] = weights.map(|w| w as f32);
    let seven = 7.0 * U / (1.0 - 7.0 * U);
    (a * wa + b * wb + c * wc, ((a * wa).abs() + (b * wb).abs() + (c * wc).abs()) * seven)
}

/// The unit normal in f32 that points the way of `direction`, as rounded numbers have it.
fn leaving_normal(corners: &[GzCoord; 3], direction: GzCoord) -> GzCoord {
    let [a, b, c] = *corners;
    let n = (b - a).cross(c - a).normalize_or_zero();
    if n.dot(direction) < 0.0 { -n } else { n }
}

/// Source: C. Wächter, N. Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, chapter 6: the bits of
/// a coordinate, taken as an integer, move by 256 times the normal's component; below 1/32 the coordinate moves by 2^-16 of it instead.
fn by_integer_steps(point: GzCoord, normal: GzCoord) -> GzCoord {
    let moved = |p: f32, n: f32| {
        if p.abs() < 1.0 / 32.0 {
            return p + n * (1.0 / 65_536.0);
        }
        let steps = (256.0 * n) as i32;
        // Bits grow away from 0.
        let steps = if p < 0.0 { -steps } else { steps };
        f32::from_bits(p.to_bits().wrapping_add_signed(steps))
    };
    GzCoord::new(moved(point.x, normal.x), moved(point.y, normal.y), moved(point.z, normal.z))
}

/// Source: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th edition, section 6.8.6: along the normal as far as the
/// corners of the error box reach, then one step more in each coordinate, away from the surface.
fn out_of_error_box(point: GzCoord, error: GzCoord, normal: GzCoord) -> GzCoord {
    let offset = normal * normal.abs().dot(error);
    let beyond = |p: f32, offset: f32| match p + offset {
        moved if offset > 0.0 => moved.next_up(),
        moved if offset < 0.0 => moved.next_down(),
        moved => moved,
    };
    GzCoord::new(beyond(point.x, offset.x), beyond(point.y, offset.y), beyond(point.z, offset.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::side_of;

    fn triangle(offset: f32) -> [GzCoord; 3] {
        [[0.0, 0.0, 0.1], [1.0, 0.1, 0.4], [0.2, 1.0, -0.3]].map(|p| GzCoord::from_array(p) + offset)
    }

    const WEIGHTS: [f64; 3] = [0.3, 0.3, 0.4];

    #[test]
    fn the_exact_rule_is_the_default_and_unchanged() {
        let policy = LeavePolicy::default();
        let corners = triangle(3.0);
        for direction in [GzCoord::Z, GzCoord::NEG_Z, GzCoord::new(0.3, 0.1, 0.2)] {
            let ray = policy.leave(&corners, WEIGHTS, direction).unwrap();
            let origin = leave_surface(&corners, WEIGHTS, direction).unwrap();
            assert_eq!(ray, GzRay::from_f64(origin, direction));
        }
        assert!(!policy.skips_source() && policy.tmin() == 0.0);
        assert_eq!(policy.leave(&corners, WEIGHTS, corners[1] - corners[0]), None);
    }

    #[test]
    fn all_start_near_the_hit_and_the_offsets_on_the_leaving_side() {
        for offset in [0.0, 7.0, -1e3] {
            let corners = triangle(offset);
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let point = a * WEIGHTS[0] + b * WEIGHTS[1] + c * WEIGHTS[2];
            for direction in [GzCoord::Z, GzCoord::NEG_Z] {
                let side = side_of(&corners, direction);
                let normal = (b - a).cross(c - a).normalize() * f64::from(side);
                for policy in LeavePolicy::ALL {
                    let ray = policy.leave(&corners, WEIGHTS, direction).unwrap();
                    let moved = (ray.origin - point).length();
                    assert!(moved < 1e-4 + 3e-4 * f64::from(offset.abs()), "{policy:?} moves {moved} at {offset}");
                    let offsets = matches!(policy, LeavePolicy::WaechterBinder | LeavePolicy::ErrorBound);
                    assert!(!offsets || (ray.origin - point).dot(normal) > 0.0, "{policy:?} at {offset}");
                    assert_eq!((ray.tmin, ray.tmax), (policy.tmin(), f32::INFINITY));
                }
            }
        }
    }

    #[test]
    fn integer_steps_are_256_of_the_coordinates_own() {
        let moved = by_integer_steps(GzCoord::new(1.0, -1.0, 0.01), GzCoord::ONE);
        assert_eq!((moved.x, moved.y), (1.0 + 256.0 * f32::EPSILON, -1.0 + 128.0 * f32::EPSILON));
        assert_eq!(moved.z, 0.01 + 1.0 / 65_536.0);
    }

    #[test]
    fn the_error_box_holds_the_point() {
        let corners = triangle(100.0);
        let ((point, error), [a, b, c]) = (rounded_point(&corners, WEIGHTS), corners.map(|p| p.as_dvec3()));
        let off = (point.as_dvec3() - (a * WEIGHTS[0] + b * WEIGHTS[1] + c * WEIGHTS[2])).abs();
        assert!(off.cmple(error.as_dvec3()).all() && error.max_element() < 1e-4, "{off} {error}");
        let out = out_of_error_box(point, error, GzCoord::Z);
        assert!(out.z >= point.z + error.z && out.x == point.x);
    }

    #[test]
    fn only_identity_skips_and_only_epsilon_waits() {
        let skipping: Vec<_> = LeavePolicy::ALL.into_iter().filter(|policy| policy.skips_source()).collect();
        assert_eq!(skipping, [LeavePolicy::Identity]);
        assert_eq!(LeavePolicy::Epsilon(0.25).tmin(), 0.25);
    }
}
