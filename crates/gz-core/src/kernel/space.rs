//! The space in which the f32 kernels work.

use crate::{Bounds, GzCoord};

/// Trace space with its axes stretched by powers of two, so that the scene reaches about as far along each: the bounds of the f32 kernels
/// take the greatest coordinate for all three.
///
/// Stretching rounds nothing and changes no t, and volumes by one common factor. Most scenes keep their axes; in screen space, where z runs
/// to 2^31 over a picture of some hundred pixels, x and y are stretched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSpace {
    /// What coordinates are multiplied by, at least 1.
    pub scale: GzCoord,
    /// The greatest magnitude of a coordinate along each axis, after that.
    pub reach: GzCoord,
}

/// 2^16: axes that reach this much less far than the longest are stretched. Not before: where only a wide ground makes a scene flat,
/// stretching turns the triangles of all that stands on it into needles, about which f32 decides little.
const UNEVEN: f32 = (1u32 << 16) as f32;
/// 2^30: what an axis is stretched by at most.
const MOST: f32 = (1u32 << 30) as f32;

impl FilterSpace {
    /// For triangles whose coordinates are at most `reach` in magnitude along each axis.
    pub fn new(reach: GzCoord) -> Self {
        let longest = reach.max_element();
        let stretch = |reach: f32| {
            let ratio = longest / reach;
            // Exact for what is left of a float when its fraction is cut.
            if ratio.is_finite() && ratio >= UNEVEN { f32::from_bits(ratio.min(MOST).to_bits() & 0xff80_0000) } else { 1.0 }
        };
        let scale = GzCoord::from_array(reach.to_array().map(stretch));
        Self { scale, reach: reach * scale }
    }

    /// The box in stretched coordinates.
    pub fn stretch(&self, bounds: &Bounds) -> Bounds {
        Bounds { min: bounds.min * self.scale, max: bounds.max * self.scale }
    }

    /// The box in trace space again.
    pub fn shrink(&self, bounds: &Bounds) -> Bounds {
        Bounds { min: bounds.min / self.scale, max: bounds.max / self.scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uneven_axes_are_stretched_by_powers_of_two_and_back() {
        let space = FilterSpace::new(GzCoord::new(300.0, 0.0, 2e9));
        assert_eq!(space.scale, GzCoord::new(4_194_304.0, 1.0, 1.0));
        assert_eq!(space.reach, GzCoord::new(1_258_291_200.0, 0.0, 2e9));
        let bounds = Bounds { min: GzCoord::new(-0.1, 0.0, 7.0), max: GzCoord::new(299.9, 0.0, 2e9) };
        assert_eq!(space.shrink(&space.stretch(&bounds)), bounds);
        for even in [GzCoord::new(630.0, 5.6, 630.0), GzCoord::ZERO, GzCoord::splat(f32::MAX)] {
            assert_eq!(FilterSpace::new(even), FilterSpace { scale: GzCoord::ONE, reach: even });
        }
        assert_eq!(FilterSpace::new(GzCoord::new(1e-30, 1.0, 1.0)).scale.x, MOST);
    }
}
