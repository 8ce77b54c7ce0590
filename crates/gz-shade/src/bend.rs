//! How rays meet mirrors and glass and are bent there, eight at a time: the formulas of `reflection`, `refraction` and `optics` with their bits.
// Lanes and channels are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use crate::Fresnel;
use crate::eight::{
    Rows, above, arrays, coord, dot, lanes, load, minus, narrow, plus, select, set, signs, times, unit_range, vector, widen,
};
use crate::hits::EightHits;
use gz_core::simd::{Doubles, EightDoubles, Lanes, Simd, Task, dispatch};
use gz_core::{GzCoord, SimdLevel, TriBuffer, side_of};

/// How eight rays meet their surfaces.
#[derive(Debug)]
pub(crate) struct Meetings {
    /// Directions of the rays, at length 1.
    pub(crate) d: Rows,
    /// Shading normals at length 1, turned against the rays: d.n <= 0.
    pub(crate) n: Rows,
    /// Cosines between the normals and the incoming rays, in [0, 1].
    pub(crate) cos: [f64; 8],
    /// The sides of the triangles that the rays go to.
    pub(crate) to_side: [i8; 8],
    /// The lanes whose rays come from outside.
    pub(crate) entering: u32,
}

impl Meetings {
    /// Of rays along `directions` to the sides `to_side` at `hits`.
    ///
    /// With `geometric` sides the triangle itself says where a ray comes from and whether that is outside; the shading normal, taken on that
    /// side, only bends directions. Where it leans away from the ray all the same (at the silhouette of a coarse mesh) it is brought back to
    /// where the ray grazes it: there all is reflected, as it is in the limit. Otherwise normals alone say where a ray comes from.
    pub(crate) fn of(hits: &EightHits, directions: &[GzCoord; 8], to_side: [i8; 8], geometric: bool) -> Self {
        let directions = directions.map(|d| d.to_array());
        let (mut meetings, leaning) = dispatch(SimdLevel::best(), Meet { hits, directions: &directions, to_side, geometric });
        for k in lanes(leaning) {
            let (d, n) = (vector(&meetings.d, k), vector(&meetings.n, k));
            let grazed = (n - d * d.dot(n)).try_normalize();
            let n = grazed.unwrap_or_else(|| vector(&hits.at.normal, k) * -f64::from(to_side[k]));
            set(&mut meetings.n, k, n);
            meetings.cos[k] = (-d.dot(n)).clamp(0.0, 1.0);
        }
        meetings
    }
}

struct Meet<'h> {
    hits: &'h EightHits,
    directions: &'h [[f32; 3]; 8],
    to_side: [i8; 8],
    geometric: bool,
}

impl Task for Meet<'_> {
    /// The meetings, and the lanes whose normals lean away from the ray.
    type Output = (Meetings, u32);

    #[inline(always)]
    fn run<S: Simd>(self) -> Self::Output {
        let Self { hits, directions, to_side, geometric } = self;
        let zero = <S::Doubles>::splat(0.0);
        let d = widen::<S>(&<S::Eight>::unzip3(directions));
        let scale = <S::Doubles>::splat(1.0).over(dot(&d, &d).sqrt());
        let has_length = above(scale, zero) & scale.at_most(<S::Doubles>::splat(f64::MAX));
        let d = select(&times(&d, scale), has_length, &[zero; 3]);
        let n = load::<S::Doubles>(&hits.normal);
        let mut entering = above(zero, dot(&d, &n));
        if geometric {
            entering = 0;
            for k in 0..8 {
                entering |= u32::from(hits.outside[k] != to_side[k]) << k;
            }
        }
        let n = times(&n, signs(entering));
        let slope = dot(&d, &n);
        let cos = unit_range(slope.times(<S::Doubles>::splat(-1.0)));
        let leaning = if geometric { !slope.at_most(zero) & 0xff } else { 0 };
        (Meetings { d: arrays(&d), n: arrays(&n), cos: cos.array(), to_side, entering }, leaning)
    }
}

/// Eight directions that rays go on along, and the sides of the triangles that they lead to.
#[derive(Debug)]
pub(crate) struct Bent {
    directions: [[f32; 8]; 3],
    up: u32,
    down: u32,
}

impl Bent {
    #[inline(always)]
    fn of<S: Simd>(hits: &EightHits, directions: &[S::Doubles; 3]) -> Self {
        let rounded = narrow::<S>(directions);
        let (up, down) = hits.at.sides(&widen::<S>(&rounded));
        Self { directions: gz_core::simd::arrays3(rounded), up, down }
    }

    /// That of lane `k`.
    pub(crate) fn lane(&self, k: usize, tris: &TriBuffer, hits: &EightHits) -> (GzCoord, i8) {
        let direction = coord(&self.directions, k);
        let side = if self.up >> k & 1 != 0 {
            1
        } else if self.down >> k & 1 != 0 {
            -1
        } else {
            side_of(tris.position(hits.tris[k]), direction)
        };
        (direction, side)
    }
}

/// What surfaces do to eight rays.
#[derive(Debug)]
pub(crate) struct Bends {
    /// The share of the light that is reflected, as [`crate::optics::reflectance`] has it.
    pub(crate) share: [f64; 8],
    /// Where that goes.
    pub(crate) reflected: Bent,
    /// Where the rest goes, if it goes anywhere.
    pub(crate) refracted: Bent,
    /// The lanes in which it does not: total internal reflection.
    pub(crate) total: u32,
}

impl Bends {
    /// At surfaces with `eta` = n1 / n2, the index on the incoming side over the other; `refracting` if any light goes through.
    pub(crate) fn of(hits: &EightHits, meetings: &Meetings, eta: &[f64; 8], rule: Fresnel, refracting: bool) -> Self {
        dispatch(SimdLevel::best(), Bend { hits, meetings, eta, rule, refracting })
    }
}

struct Bend<'h> {
    hits: &'h EightHits,
    meetings: &'h Meetings,
    eta: &'h [f64; 8],
    rule: Fresnel,
    refracting: bool,
}

impl Task for Bend<'_> {
    type Output = Bends;

    #[inline(always)]
    fn run<S: Simd>(self) -> Bends {
        let Self { hits, meetings, eta, rule, refracting } = self;
        let (zero, one, two) = (<S::Doubles>::splat(0.0), <S::Doubles>::splat(1.0), <S::Doubles>::splat(2.0));
        let (d, n) = (load::<S::Doubles>(&meetings.d), load::<S::Doubles>(&meetings.n));
        let (cos, eta) = (<S::Doubles>::load(&meetings.cos), <S::Doubles>::load(eta));
        let same = eta.at_most(one) & one.at_most(eta);
        // 1. The cosine behind the boundary.
        let k = one.minus(eta.times(eta).times(one.minus(cos).times(one.plus(cos))));
        let passes = zero.at_most(k);
        let behind = k.or_more(zero).sqrt();
        // 2. The share that is reflected.
        let share = match rule {
            Fresnel::Exact => fresnel(cos, behind, eta).select(passes, one),
            Fresnel::Schlick => {
                let dense = above(eta, one);
                schlick(behind.select(dense, cos), eta).select(passes | !dense, one)
            }
        };
        let share = zero.select(same, share);
        // 3. The directions.
        let reflected = minus(&d, &times(&n, two.times(dot(&d, &n))));
        let mut refracted = d;
        if refracting {
            let bent = plus(&times(&d, eta), &times(&n, eta.times(cos).minus(behind)));
            let unit = times(&bent, one.over(dot(&bent, &bent).sqrt()));
            refracted = select(&d, same, &unit);
        }
        let (reflected, refracted) = (Bent::of::<S>(hits, &reflected), Bent::of::<S>(hits, &refracted));
        Bends { share: share.array(), reflected, refracted, total: !(passes | same) & 0xff }
    }
}

/// As [`crate::optics::fresnel`] has it, where light passes.
#[inline(always)]
fn fresnel<D: EightDoubles>(cos: D, behind: D, eta: D) -> D {
    let (zero, one) = (D::splat(0.0), D::splat(1.0));
    let (thin, dense) = (eta.times(cos), eta.times(behind));
    let perpendicular = thin.minus(behind).over(thin.plus(behind));
    let parallel = cos.minus(dense).over(cos.plus(dense));
    let mean = perpendicular.times(perpendicular).plus(parallel.times(parallel)).over(D::splat(2.0));
    one.select(cos.at_most(zero) & behind.at_most(zero), mean)
}

/// As [`crate::optics::schlick`] has it, with the cosine on the thin side.
#[inline(always)]
fn schlick<D: EightDoubles>(cos: D, eta: D) -> D {
    let one = D::splat(1.0);
    let root = eta.minus(one).over(eta.plus(one));
    let (r0, m) = (root.times(root), one.minus(cos));
    let square = m.times(m);
    r0.plus(square.times(square).times(m).times(one.minus(r0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hits::tests::{dice, eight};
    use crate::optics::reflectance;
    use crate::reflection::reflect;
    use crate::refraction::refract;
    use gz_core::SimdLevel;

    #[test]
    fn shares_and_directions_are_those_of_the_plain_formulas_at_every_level() {
        let (mut unit, mut total, mut told) = (dice(), 0, 0);
        for round in 0..300u32 {
            let (tris, mut hits, rays) = eight(&mut unit);
            for k in 0..8 {
                let leaning = GzCoord::new(unit(), unit(), unit()).as_dvec3();
                set(&mut hits.normal, k, (vector(&hits.at.normal, k) + leaning * 0.3).normalize());
                hits.outside[k] = if unit() < 0.0 { 1 } else { -1 };
            }
            let directions = rays.map(|ray| ray.direction.to_array());
            let eta = std::array::from_fn(|k| [1.0, 1.5, 1.0 / 1.5, 0.2, 7.0][(round as usize + k) % 5]);
            let rule = if round % 2 == 0 { Fresnel::Exact } else { Fresnel::Schlick };
            for &level in SimdLevel::available() {
                let geometric = round % 3 != 0;
                let to_side = hits.at.to_side;
                let (meetings, leaning) = dispatch(level, Meet { hits: &hits, directions: &directions, to_side, geometric });
                for k in 0..8 {
                    let (d, stored) = (rays[k].direction.as_dvec3().normalize_or_zero(), vector(&hits.normal, k));
                    let entering = if geometric { hits.outside[k] != to_side[k] } else { d.dot(stored) < 0.0 };
                    assert_eq!((vector(&meetings.d, k), meetings.entering >> k & 1 != 0), (d, entering));
                    let n = if entering { stored } else { -stored };
                    assert_eq!((vector(&meetings.n, k), leaning >> k & 1 != 0), (n, geometric && d.dot(n) > 0.0));
                    assert_eq!(meetings.cos[k], (-d.dot(n)).clamp(0.0, 1.0));
                }
                let bends = dispatch(level, Bend { hits: &hits, meetings: &meetings, eta: &eta, rule, refracting: true });
                for k in 0..8 {
                    let (d, n) = (vector(&meetings.d, k), vector(&meetings.n, k));
                    assert_eq!(bends.share[k], reflectance(rule, meetings.cos[k], eta[k]), "{rule:?} {} at {level:?}", eta[k]);
                    let corners = tris.position(hits.tris[k]);
                    let reflected = reflect(d, n).as_vec3();
                    assert_eq!(bends.reflected.lane(k, &tris, &hits), (reflected, side_of(corners, reflected)));
                    let refracted = refract(d, n, eta[k]).map(|direction| direction.as_vec3());
                    assert_eq!(bends.total >> k & 1 != 0, refracted.is_none());
                    total += u32::from(refracted.is_none());
                    if let Some(refracted) = refracted {
                        assert_eq!(bends.refracted.lane(k, &tris, &hits), (refracted, side_of(corners, refracted)));
                        told += 1;
                    }
                }
            }
        }
        assert!(total > 500 && told > 2000, "{total} reflected totally, {told} refracted");
    }
}
