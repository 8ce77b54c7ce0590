//! Hard rays in company: those of a run share their origin, or nearly so, and go to neighbouring places, as the rays of a picture do.
//!
//! A tree sends rays that go the same way through its nodes together, with kernels of their own. Rays from anywhere to anywhere part at the
//! root and would never see them.

use gz_core::glam::DVec3;
use gz_core::{GzCoord, GzRay};

/// Rays of a run: as many as a tree sends together.
pub const RUN: usize = 64;

/// What the rays of a run have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Company {
    /// Nothing: every ray comes from somewhere else.
    None,
    /// They start where the first one does, and are aimed at neighbouring points.
    Origin,
    /// They start close to where the first one does.
    Near,
    /// They have the first one's direction, each from a start of its own, as those to a distant light.
    Direction,
    /// They go the same way along each axis, or in one direction; no ray is changed, only their order.
    Way,
}

impl Company {
    /// Puts `rays` in runs. A ray is aimed at its point at t = 1, and still is afterwards, as well as f32 directions can.
    pub(super) fn gather(self, rays: &mut [GzRay]) {
        match self {
            Self::None => {}
            Self::Way => {
                let octant = |ray: &GzRay| ray.direction.to_array().map(|x| x < 0.0);
                let bits = |ray: &GzRay| ray.direction.to_array().map(f32::to_bits);
                rays.sort_by_key(|ray| (octant(ray), bits(ray)));
            }
            Self::Origin | Self::Near | Self::Direction => {
                along_a_curve(rays);
                rays.chunks_mut(RUN).for_each(|run| self.share(run));
            }
        }
    }

    fn share(self, run: &mut [GzRay]) {
        // Whole numbers stay whole, so that nothing becomes rounded that was not.
        let whole = run.iter().all(|ray| ray.origin.fract() == DVec3::ZERO);
        let Some(first) = run.first().copied() else { return };
        for ray in run {
            let (aim, apart) = (target(ray), ray.origin - first.origin);
            let origin = match self {
                Self::Near if whole => first.origin + apart.clamp(DVec3::NEG_ONE, DVec3::ONE),
                Self::Near => first.origin + apart * (1.0 / 128.0),
                Self::Direction => aim - first.direction.as_dvec3(),
                _ => first.origin,
            };
            let direction = if self == Self::Direction { first.direction } else { (aim - origin).as_vec3() };
            if direction != GzCoord::ZERO {
                (ray.origin, ray.direction) = (origin, direction);
            }
        }
    }
}

/// Where a ray is aimed.
fn target(ray: &GzRay) -> DVec3 {
    ray.origin + ray.direction.as_dvec3()
}

/// Sorts rays so that neighbours are aimed at neighbouring points: along a curve that takes the bits of all coordinates in turn.
fn along_a_curve(rays: &mut [GzRay]) {
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for ray in rays.iter() {
        (least, most) = (least.min(target(ray)), most.max(target(ray)));
    }
    const BITS: u32 = 8;
    let place = |ray: &GzRay| {
        let steps = (target(ray) - least) / (most - least).max(DVec3::splat(f64::MIN_POSITIVE)) * f64::from((1u32 << BITS) - 1);
        let steps = steps.to_array().map(|x| x as u32);
        (0..BITS).rev().fold(0u32, |place, bit| steps.iter().fold(place, |place, x| place << 1 | x >> bit & 1))
    };
    rays.sort_by_key(place);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hard::Dice;

    fn rays() -> Vec<GzRay> {
        let mut dice = Dice::new(1);
        let ray = |dice: &mut Dice| {
            let (origin, aim) = (dice.point(3.0), dice.point(1.0));
            GzRay::from_f64(origin, (aim - origin).as_vec3())
        };
        (0..1024).map(|_| ray(&mut dice)).collect()
    }

    /// How far apart the aims of a run are, on average over the runs.
    fn spread(rays: &[GzRay]) -> f64 {
        let runs = rays.chunks(RUN).map(|run| {
            let middle = run.iter().map(target).sum::<DVec3>() / run.len() as f64;
            run.iter().map(|ray| (target(ray) - middle).length()).sum::<f64>() / run.len() as f64
        });
        runs.sum::<f64>() / (rays.len() / RUN) as f64
    }

    #[test]
    fn runs_share_their_origin_and_keep_their_aims() {
        let before = rays();
        for company in [Company::Origin, Company::Near, Company::Direction] {
            let mut after = before.clone();
            company.gather(&mut after);
            assert!(spread(&after) < 0.6 * spread(&before), "{company:?}: {} {}", spread(&after), spread(&before));
            for run in after.chunks(RUN) {
                let apart = run.iter().map(|ray| (ray.origin - run[0].origin).length()).fold(0.0, f64::max);
                let turned = run.iter().map(|ray| (ray.direction - run[0].direction).length()).fold(0.0, f32::max);
                match company {
                    Company::Origin => assert!(apart == 0.0 && turned > 0.0),
                    Company::Near => assert!(apart > 0.0 && apart < 0.1 && turned > 0.0, "{apart}"),
                    _ => assert!(apart > 0.1 && turned == 0.0),
                }
            }
            // The same aims but for the rounding of directions, in another order.
            let nearest = |aim: DVec3| before.iter().map(|ray| (target(ray) - aim).length()).fold(f64::INFINITY, f64::min);
            assert!(after.iter().all(|ray| nearest(target(ray)) < 1e-6));
        }
    }

    #[test]
    fn whole_numbers_stay_whole() {
        let mut dice = Dice::new(2);
        let all: Vec<GzRay> = (0..200).map(|_| GzRay::new(dice.whole_point(9), GzCoord::Z + dice.whole_point(4) * 2.0)).collect();
        for company in [Company::Origin, Company::Near, Company::Direction] {
            let mut all = all.clone();
            company.gather(&mut all);
            assert!(all.iter().all(|ray| ray.origin.fract() == DVec3::ZERO && ray.direction.fract() == GzCoord::ZERO));
        }
    }

    #[test]
    fn rays_that_go_the_same_way_come_together_unchanged() {
        let before = rays();
        let mut after = before.clone();
        Company::Way.gather(&mut after);
        let octants = |rays: &[GzRay]| {
            let octant = |ray: &GzRay| ray.direction.to_array().map(|x| x < 0.0);
            rays.windows(2).filter(|pair| octant(&pair[0]) != octant(&pair[1])).count()
        };
        assert!(octants(&before) > 500 && octants(&after) == 7);
        assert!(before.iter().all(|ray| after.contains(ray)));
    }
}
