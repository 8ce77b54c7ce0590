//! The conservative f32 filter: sixteen triangles at a time, never rejecting one that the ray's line meets.
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

use crate::simd::SimdLevel;
use crate::{Bounds, GzCoord, GzRay, TriId};

/// Triangles side by side in one block.
pub(crate) const LANES: usize = 16;

/// Sixteen triangles, coordinate by coordinate.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(crate) struct Block {
    /// `v[3 * corner + axis][lane]`.
    v: [[f32; LANES]; 9],
}

/// All triangles in blocks, in order; the last block is filled up with copies of its first triangle, which are never reported.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    blocks: Vec<Block>,
    count: usize,
    bounds: Bounds,
}

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

impl Blocks {
    pub(crate) fn new(positions: &[[GzCoord; 3]]) -> Self {
        let blocks = positions
            .chunks(LANES)
            .map(|group| {
                let corner = |lane: usize| group.get(lane).unwrap_or(&group[0]);
                Block { v: std::array::from_fn(|k| std::array::from_fn(|lane| corner(lane)[k / 3].to_array()[k % 3])) }
            })
            .collect();
        let bounds = Bounds::of(positions.iter().flatten().copied());
        Self { blocks, count: positions.len(), bounds }
    }

    /// The number of blocks.
    pub(crate) fn len(&self) -> usize {
        self.blocks.len()
    }

    /// The numbers of all triangles of the blocks `from..to`.
    pub(crate) fn triangles(&self, from: usize, to: usize) -> std::ops::Range<TriId> {
        // A TriId holds every number of a buffer.
        (from * LANES) as TriId..(to * LANES).min(self.count) as TriId
    }

    /// Bytes that the blocks take.
    pub(crate) fn bytes(&self) -> usize {
        self.blocks.len() * size_of::<Block>()
    }

    /// The ray prepared, or `None` when coordinates are too large for the filter's bound.
    pub(crate) fn prepare(&self, ray: &GzRay) -> Option<FilterRay> {
        FilterRay::new(ray, self.bounds.reaches())
    }

    /// Appends the numbers of all triangles of the blocks `from..to` that `ray` may hit.
    pub(crate) fn survivors(&self, level: SimdLevel, ray: &FilterRay, from: usize, to: usize, out: &mut Vec<TriId>) {
        let first = out.len();
        crate::simd::filter(level, &self.blocks[from..to], ray, (from * LANES) as TriId, out);
        // Fillers of the last block sit at the end and are the only numbers that do not exist.
        while out.len() > first && out[out.len() - 1] as usize >= self.count {
            out.pop();
        }
    }
}

/// The filter's one body; each SIMD level compiles it for itself.
#[inline(always)]
pub(crate) fn filter_body(blocks: &[Block], ray: &FilterRay, first: TriId, out: &mut Vec<TriId>) {
    let [kx, ky, kz] = ray.axes;
    let ([ox, oy, oz], [sx, sy], [dx, dy]) = (ray.origin, ray.slope, ray.delta);
    let mut id = first;
    for block in blocks {
        let v = &block.v;
        let corner = |c: usize| (&v[3 * c + kx], &v[3 * c + ky], &v[3 * c + kz]);
        let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) = (corner(0), corner(1), corner(2));
        let mut keep = [0u32; LANES];
        for i in 0..LANES {
            let (z0, z1, z2) = (az[i] - oz, bz[i] - oz, cz[i] - oz);
            let (x0, y0) = ((ax[i] - ox) - sx * z0, (ay[i] - oy) - sy * z0);
            let (x1, y1) = ((bx[i] - ox) - sx * z1, (by[i] - oy) - sy * z1);
            let (x2, y2) = ((cx[i] - ox) - sx * z2, (cy[i] - oy) - sy * z2);
            let (u, v, w) = (x2 * y1 - y2 * x1, x0 * y2 - y0 * x2, x1 * y0 - y1 * x0);
            let mx = greater(greater(x0.abs(), x1.abs()), x2.abs()) + dx;
            let my = greater(greater(y0.abs(), y1.abs()), y2.abs()) + dy;
            let bound = my * (2.1 * dx + 5.0 * E * mx) + (mx * (2.1 * dy) + FLOOR);
            // NaN compares false: what cannot be judged is kept.
            let below = (u < -bound) | (v < -bound) | (w < -bound);
            let above = (u > bound) | (v > bound) | (w > bound);
            keep[i] = u32::from(!(below & above));
        }
        if keep.iter().fold(0, |any, &k| any | k) != 0 {
            for (lane, &kept) in keep.iter().enumerate() {
                if kept != 0 {
                    out.push(id + lane as TriId);
                }
            }
        }
        id += LANES as TriId;
    }
}

/// The processor's maximum: `f32::max` has rules for NaN that cost two more instructions.
#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
