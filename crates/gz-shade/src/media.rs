//! Which glass a ray is in: its stack of media.

use gz_core::MaterialId;

/// A stack of media, a handle into [`MediaStacks`]. The top is what the ray runs through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Media(u32);

impl Media {
    /// Nothing entered: air.
    pub(crate) const AIR: Self = Self(0);
}

/// A boundary crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// Index of refraction on the incoming side.
    pub(crate) n1: f64,
    /// Index of refraction on the other side.
    pub(crate) n2: f64,
    /// The stack on the other side.
    pub(crate) after: Media,
    /// The ray leaves a medium that it never entered.
    pub(crate) unmatched: bool,
}

/// One medium on a stack, and what lies below it.
#[derive(Clone, Copy, Debug)]
struct Layer {
    medium: MaterialId,
    ior: f64,
    below: Media,
}

/// All stacks of a tile's rays. Stacks share what they have in common, so that a ray's stack is one number.
///
/// A medium is told by its material. Leaving takes the topmost layer of that material out, wherever it is: where a glass and the
/// water in it overlap, the last one entered counts until it is left, and the hidden boundaries have equal indices on both sides and
/// do nothing. Where their walls coincide, a ray sees only the wall with the lower triangle number; listing the inner medium first
/// makes that the water's, which is the one that counts.
///
/// Leaving a medium never entered (a camera in glass, a single sheet seen from behind) is taken as having entered it from where the
/// ray is, at first from air: the ray comes out of that medium into what its stack says, and the case is counted.
#[derive(Debug, Default)]
pub(crate) struct MediaStacks {
    layers: Vec<Layer>,
}

/// Index of refraction of air and of vacuum; the difference (3e-4) is not modelled.
const AIR_IOR: f64 = 1.0;

impl MediaStacks {
    /// Forgets all stacks.
    pub(crate) fn clear(&mut self) {
        self.layers.clear();
    }

    /// What happens where a ray with stack `media` crosses the surface of `medium`, inwards or outwards.
    pub(crate) fn cross(&mut self, media: Media, medium: MaterialId, ior: f64, entering: bool) -> Crossing {
        let n1 = self.ior(media);
        if entering {
            return Crossing { n1, n2: ior, after: self.push(media, medium, ior), unmatched: false };
        }
        match self.without(media, medium) {
            Some(after) => Crossing { n1, n2: self.ior(after), after, unmatched: false },
            None => Crossing { n1: ior, n2: n1, after: media, unmatched: true },
        }
    }

    /// Index of refraction of what a ray with this stack runs through.
    pub(crate) fn ior(&self, media: Media) -> f64 {
        self.layer(media).map_or(AIR_IOR, |layer| layer.ior)
    }

    fn layer(&self, media: Media) -> Option<Layer> {
        let at = media.0.checked_sub(1)?;
        Some(self.layers[at as usize])
    }

    fn push(&mut self, below: Media, medium: MaterialId, ior: f64) -> Media {
        self.layers.push(Layer { medium, ior, below });
        Media(self.layers.len() as u32) // 32 levels of a tile's rays stay far below 2^32
    }

    /// `media` without its topmost layer of `medium`, if it has one.
    fn without(&mut self, media: Media, medium: MaterialId) -> Option<Media> {
        let top = self.layer(media)?;
        if top.medium == medium {
            return Some(top.below);
        }
        let below = self.without(top.below, medium)?;
        Some(self.push(below, top.medium, top.ior))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLASS: (MaterialId, f64) = (3, 1.5);
    const WATER: (MaterialId, f64) = (5, 1.33);

    #[test]
    fn entering_and_leaving_come_back_to_air() {
        let mut stacks = MediaStacks::default();
        let into = stacks.cross(Media::AIR, GLASS.0, GLASS.1, true);
        assert_eq!((into.n1, into.n2, into.unmatched), (1.0, 1.5, false));
        let out = stacks.cross(into.after, GLASS.0, GLASS.1, false);
        assert_eq!(out, Crossing { n1: 1.5, n2: 1.0, after: Media::AIR, unmatched: false });
    }

    #[test]
    fn g9_overlapping_media_hide_their_inner_boundaries() {
        let mut stacks = MediaStacks::default();
        let glass = stacks.cross(Media::AIR, GLASS.0, GLASS.1, true).after;
        let water = stacks.cross(glass, WATER.0, WATER.1, true);
        assert_eq!((water.n1, water.n2), (1.5, 1.33));
        let hidden = stacks.cross(water.after, GLASS.0, GLASS.1, false);
        assert_eq!((hidden.n1, hidden.n2, hidden.unmatched), (1.33, 1.33, false));
        let wall = stacks.cross(hidden.after, GLASS.0, GLASS.1, true);
        assert_eq!((wall.n1, wall.n2), (1.33, 1.5));
        let hidden = stacks.cross(wall.after, WATER.0, WATER.1, false);
        assert_eq!((hidden.n1, hidden.n2), (1.5, 1.5));
        let out = stacks.cross(hidden.after, GLASS.0, GLASS.1, false);
        assert_eq!((out.n1, out.n2, out.after), (1.5, 1.0, Media::AIR));
    }

    #[test]
    fn g10_leaving_a_medium_never_entered_comes_out_of_it() {
        let mut stacks = MediaStacks::default();
        let out = stacks.cross(Media::AIR, GLASS.0, GLASS.1, false);
        assert_eq!(out, Crossing { n1: 1.5, n2: 1.0, after: Media::AIR, unmatched: true });
        let water = stacks.cross(Media::AIR, WATER.0, WATER.1, true).after;
        let out = stacks.cross(water, GLASS.0, GLASS.1, false);
        assert_eq!((out.n1, out.n2, out.after, out.unmatched), (1.5, 1.33, water, true));
    }
}
