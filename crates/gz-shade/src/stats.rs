//! What a frame took, counted.

/// Counts of a frame. Integers throughout, so that the order of tiles and threads cannot show in a sum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Rays from the camera.
    pub primary_rays: u64,
    /// Shadow rays: one for each light that would add something to a hit that counts.
    pub shadow_rays: u64,
    /// Further questions that shadow rays take in scenes with glass, asked one by one: where something is in the way whether it is opaque, and
    /// then what glass they meet. A query may answer all of them in one walk.
    pub tint_queries: u64,
    /// Rays reflected by mirrors.
    pub mirror_rays: u64,
    /// Rays reflected and refracted by glass.
    pub glass_rays: u64,
    /// Camera rays that hit a triangle.
    pub primary_hits: u64,
    /// Mirror and glass rays that hit a triangle.
    pub secondary_hits: u64,
    /// Hits on mirrors and glass that kept their local colour because of the depth limit.
    pub depth_cuts: u64,
    /// Weight of the branches not followed for that, summed in units of [`FrameStats::WEIGHT_UNIT`].
    pub depth_cut_weight: u64,
    /// Branches not followed because they weigh less than 2^-16 of their pixel.
    pub weak_branches: u64,
    /// Their weight, summed in units of [`FrameStats::WEIGHT_UNIT`].
    pub weak_weight: u64,
    /// Branches not followed because 1024 heavier ones, or equal and earlier ones, go on from the same sample at the same depth.
    pub crowded_branches: u64,
    /// Their weight, summed in units of [`FrameStats::WEIGHT_UNIT`].
    pub crowded_weight: u64,
    /// Shadow, mirror and glass rays that would have run in the plane of the triangle they start on: black.
    pub absorbed: u64,
    /// Reflections and refractions by an interpolated normal that would have come out on the wrong side of the triangle, and were
    /// mirrored at its plane.
    pub below_surface: u64,
    /// Boundaries at which a ray left a medium that it had never entered.
    pub unmatched_exits: u64,
    /// Total internal reflections.
    pub total_reflections: u64,
    /// Samples with a colour that is not a number. There must be none.
    pub nan_pixels: u64,
}

impl FrameStats {
    /// One unit of the summed weights: 2^-32 of a pixel's full weight.
    pub const WEIGHT_UNIT: f64 = 1.0 / 4_294_967_296.0;

    /// Rays of all kinds, without [`Self::tint_queries`].
    pub fn rays(&self) -> u64 {
        self.primary_rays + self.shadow_rays + self.mirror_rays + self.glass_rays
    }

    /// `weight` in whole units; NaN and negative weights are 0.
    pub(crate) fn units(weight: f32) -> u64 {
        (f64::from(weight) / Self::WEIGHT_UNIT) as u64
    }

    /// Each count with its name, in a fixed order, for printing.
    pub fn rows(&self) -> [(&'static str, u64); 18] {
        [
            ("primary_rays", self.primary_rays),
            ("shadow_rays", self.shadow_rays),
            ("tint_queries", self.tint_queries),
            ("mirror_rays", self.mirror_rays),
            ("glass_rays", self.glass_rays),
            ("primary_hits", self.primary_hits),
            ("secondary_hits", self.secondary_hits),
            ("depth_cuts", self.depth_cuts),
            ("depth_cut_weight", self.depth_cut_weight),
            ("weak_branches", self.weak_branches),
            ("weak_weight", self.weak_weight),
            ("crowded_branches", self.crowded_branches),
            ("crowded_weight", self.crowded_weight),
            ("absorbed", self.absorbed),
            ("below_surface", self.below_surface),
            ("unmatched_exits", self.unmatched_exits),
            ("total_reflections", self.total_reflections),
            ("nan_pixels", self.nan_pixels),
        ]
    }
}

impl std::ops::AddAssign for FrameStats {
    fn add_assign(&mut self, other: Self) {
        // Taken apart whole, so that a new count cannot be forgotten here.
        let Self {
            primary_rays,
            shadow_rays,
            tint_queries,
            mirror_rays,
            glass_rays,
            primary_hits,
            secondary_hits,
            depth_cuts,
            depth_cut_weight,
            weak_branches,
            weak_weight,
            crowded_branches,
            crowded_weight,
            absorbed,
            below_surface,
            unmatched_exits,
            total_reflections,
            nan_pixels,
        } = other;
        self.primary_rays += primary_rays;
        self.shadow_rays += shadow_rays;
        self.tint_queries += tint_queries;
        self.mirror_rays += mirror_rays;
        self.glass_rays += glass_rays;
        self.primary_hits += primary_hits;
        self.secondary_hits += secondary_hits;
        self.depth_cuts += depth_cuts;
        self.depth_cut_weight = self.depth_cut_weight.saturating_add(depth_cut_weight);
        self.weak_branches += weak_branches;
        self.weak_weight = self.weak_weight.saturating_add(weak_weight);
        self.crowded_branches += crowded_branches;
        self.crowded_weight = self.crowded_weight.saturating_add(crowded_weight);
        self.absorbed += absorbed;
        self.below_surface += below_surface;
        self.unmatched_exits += unmatched_exits;
        self.total_reflections += total_reflections;
        self.nan_pixels += nan_pixels;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_count_every_field() {
        let one = FrameStats {
            primary_rays: 1,
            shadow_rays: 1,
            tint_queries: 1,
            mirror_rays: 1,
            glass_rays: 1,
            primary_hits: 1,
            secondary_hits: 1,
            depth_cuts: 1,
            depth_cut_weight: 1,
            weak_branches: 1,
            weak_weight: 1,
            crowded_branches: 1,
            crowded_weight: 1,
            absorbed: 1,
            below_surface: 1,
            unmatched_exits: 1,
            total_reflections: 1,
            nan_pixels: 1,
        };
        let mut sum = one;
        sum += one;
        assert!(sum.rows().iter().all(|&(_, count)| count == 2));
        assert_eq!(sum.rays(), 8);
    }

    #[test]
    fn weights_become_whole_units() {
        assert_eq!((FrameStats::units(1.0), FrameStats::units(-1.0), FrameStats::units(f32::NAN)), (1 << 32, 0, 0));
    }
}
