//! The bound of the conservative f32 filter, which never rejects a triangle that the ray's line meets; `group.rs` applies it.
//!
//! e = 2^-24 is the unit roundoff of f32. The shear of Woop, Benthin and Wald (JCGT 2:1, 2013) brings the ray to the z axis, so each
//! edge function is two products. It differs from theirs in what it is for: it only rejects, by a bound, and never accepts.
//!
//! **Why no hit is rejected.** For each axis k let R be at least every |vertex - origin| along it. The origin is rounded to f32, each
//! difference rounds once, so a difference errs by at most e (R + |o|)(1 + 2e). The slope S = dx/dz, |S| <= 1, is rounded to f32. A sheared
//! coordinate x = Ax - S Az then errs by e (Rx + |ox|) and |S| e (Rz + |oz|) (both differences), |S| e Rz for the slope, as much for the
//! product, and e (Rx + |S| Rz) for the subtraction: in all less than 4 e (Rx + |ox| + |S| (Rz + |oz|)); delta has 5.5 in place of 4 for
//! terms of order e^2 and its own roundings. An edge function Cx By - Cy Bx computed from sheared coordinates that are at most X and Y in
//! magnitude is off by at most 2 (X dy + Y dx + dx dy) through its inputs and 4 e X Y (1 + e) through its own roundings. With X' = X + dx and
//! Y' = Y + dy the bound E = 2.1 (X' dy + Y' dx) + 5 e X' Y' + 2^-124 covers both, the roundings of E itself, and underflow, with or
//! without flush-to-zero. A true hit has edge functions of one sign or 0, so the computed ones cannot be below -E and above E at once.
//! Fused multiply-adds only remove roundings.

use crate::{GzCoord, GzRay};

/// A ray as the filter sees it.
#[derive(Clone, Copy, Debug)]
pub struct FilterRay {
    /// Axes: the direction is largest along the last.
    pub(super) axes: [usize; 3],
    pub(super) origin: [f32; 3],
    pub(super) slope: [f32; 2],
    /// How far the sheared coordinates of a corner may be off.
    pub(super) delta: [f32; 2],
}

/// 2^60: squares of sheared coordinates beyond it could overflow, so the filter then lets everything through.
const REACH: f32 = (1u64 << 60) as f32;
pub(super) const E: f32 = f32::EPSILON / 2.0;
/// 2^-124.
pub(super) const FLOOR: f32 = f32::MIN_POSITIVE * 4.0;

impl FilterRay {
    /// Prepares a valid `ray` for triangles whose coordinates along each axis are at most `scene_reach` in magnitude; `None` when
    /// coordinates are too large for the filter's bound, 2^60 with the origin's added.
    pub fn new(ray: &GzRay, scene_reach: GzCoord) -> Option<Self> {
        let d = ray.direction.as_dvec3().to_array();
        let z = if d[0].abs() >= d[1].abs() && d[0].abs() >= d[2].abs() {
            0
        } else if d[1].abs() >= d[2].abs() {
            1
        } else {
            2
        };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let origin = ray.origin.to_array();
        // R + |o| by axis, with R = scene_reach + |o|.
        let [x, y, z] = axes.map(|k| f64::from(scene_reach[k]) + 2.0 * origin[k].abs());
        if x.max(y).max(z) > f64::from(REACH) {
            return None;
        }
        let slope = [d[axes[0]] / d[axes[2]], d[axes[1]] / d[axes[2]]];
        // 2^-125 of z for a slope that is too small for f32.
        let delta =
            |across: f64, slope: f64| (5.5 * f64::from(E) * (across + slope.abs() * z) + f64::from(FLOOR) / 2.0 * z) as f32;
        Some(Self {
            axes,
            origin: axes.map(|k| origin[k] as f32),
            slope: slope.map(|s| s as f32),
            delta: [delta(x, slope[0]), delta(y, slope[1])],
        })
    }
}
