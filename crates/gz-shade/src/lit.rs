//! How a light meets eight hits at a time: the shading equation of [`light_share`] and the sides that shadow rays go to.
//!
//! [`light_share`]: crate::phong::light_share
// Lanes and channels are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use crate::eight::{Rows, coord, dot, load, minus, set, signs, times, unit_range, vector, widen};
use crate::hits::EightHits;
use crate::item::Item;
use crate::powers::Powers;
use crate::{Arrival, GzLight, LightKind};
use glam::DVec3;
use gz_core::GzColor;
use gz_core::simd::{Doubles, EightDoubles, Lanes, Simd, Task, load3, splat3};

/// Eight lanes of a colour, a row for each channel.
type Colors = [[f32; 8]; 3];

/// Items among eight hits, as rows of what lights ask of them.
#[derive(Debug)]
pub(crate) struct EightItems {
    /// Which of the tree's hits they are.
    pub(crate) hits: usize,
    /// The lanes that are items.
    pub(crate) lanes: u32,
    /// The lanes whose viewer is on side 1 of the triangle, and on side -1; others are lit from both sides.
    viewers: [u32; 2],
    n: Rows,
    e: [[f32; 8]; 3],
    kd: Colors,
    ks: Colors,
    /// The lanes that have highlights, and their powers.
    shiny: u32,
    powers: Powers,
    /// The equation so far.
    sum: Colors,
}

impl EightItems {
    /// None yet of hits number `number`, `hits`.
    pub(crate) fn new(number: usize, hits: &EightHits) -> Self {
        let none = [[0.0; 8]; 3];
        let (n, e, kd, ks, powers, sum) = (hits.normal, none, none, none, Powers::default(), none);
        Self { hits: number, lanes: 0, viewers: [0; 2], n, e, kd, ks, shiny: 0, powers, sum }
    }

    /// Adds hit number `k`, which is not shaded at the corners.
    #[inline]
    pub(crate) fn add(&mut self, k: usize, item: &Item) {
        self.lanes |= 1 << k;
        self.viewers[0] |= u32::from(item.viewer == 1) << k;
        self.viewers[1] |= u32::from(item.viewer == -1) << k;
        if let Some(n) = item.n {
            set(&mut self.n, k, n);
        }
        for channel in 0..3 {
            self.e[channel][k] = item.e[channel];
            self.kd[channel][k] = item.k.kd[channel];
            self.ks[channel][k] = item.k.ks[channel];
            self.sum[channel][k] = item.sum[0][channel];
        }
        self.shiny |= u32::from(item.k.ks != GzColor::ZERO) << k;
        self.powers.set(k, item.k.power);
    }

    /// Adds `color` to the equation of hit `k`.
    #[inline]
    pub(crate) fn brighten(&mut self, k: usize, color: GzColor) {
        for channel in 0..3 {
            self.sum[channel][k] += color[channel];
        }
    }

    /// The equation of hit `k` so far.
    pub(crate) fn sum(&self, k: usize) -> GzColor {
        coord(&self.sum, k)
    }

    /// How `light` meets them.
    #[inline(always)]
    fn lit_by<S: Simd>(&self, hits: &EightHits, light: &GzLight, casting: bool) -> EightLit {
        let arrivals = Arrivals::<S>::of(light, hits);
        let mut lit = EightLit { color: [[0.0; 8]; 3], up: 0, dark: 0, open: 0 };
        // 1. Is the light on the viewer's side of the triangle?
        let seen_from = self.viewers[0] | self.viewers[1];
        if casting || seen_from != 0 {
            let (up, down) = hits.at.sides(&arrivals.direction);
            lit.open |= !(up | down) & if casting { self.lanes } else { seen_from };
            lit.up = up;
            lit.dark = self.viewers[0] & down | self.viewers[1] & up;
        }
        // 2. Diffuse light, on the side of the normal that both light and viewer are on.
        let zero = <S::Doubles>::splat(0.0);
        let (n, l, e) = (load::<S::Doubles>(&self.n), arrivals.to_light, widen::<S>(&load3(&self.e)));
        let (nl, ne) = (dot(&n, &l), dot(&n, &e));
        let front = zero.at_most(nl) & zero.at_most(ne);
        let back = nl.at_most(zero) & ne.at_most(zero);
        let turned = signs::<S::Doubles>(front);
        let (n, nl) = (times(&n, turned), nl.times(turned));
        let diffuse = S::narrow(nl);
        let mut color = [diffuse; 3];
        for channel in 0..3 {
            color[channel] = <S::Eight>::load(&self.kd[channel]).times(diffuse);
        }
        // 3. Highlights.
        let shiny = self.shiny & self.lanes & (front | back) & !lit.dark;
        if shiny != 0 {
            let r = minus(&times(&n, <S::Doubles>::splat(2.0).times(nl)), &l);
            let highlight = S::narrow(self.powers.of(unit_range(dot(&r, &e)), shiny));
            for channel in 0..3 {
                let with = color[channel].plus(<S::Eight>::load(&self.ks[channel]).times(highlight));
                color[channel] = with.select(self.shiny, color[channel]);
            }
        }
        // 4. In the light's colour.
        let (none, mut nothing) = (<S::Eight>::splat(0.0), !0);
        for channel in 0..3 {
            let light = color[channel].select(front | back, none).times(arrivals.color[channel]);
            nothing &= light.at_most(none) & none.at_most(light);
            lit.color[channel] = light.array();
        }
        lit.dark |= nothing;
        lit
    }
}

/// How a light reaches eight points.
struct Arrivals<S: Simd> {
    to_light: [S::Doubles; 3],
    direction: [S::Doubles; 3],
    color: [S::Eight; 3],
}

impl<S: Simd> Arrivals<S> {
    #[inline(always)]
    fn of(light: &GzLight, hits: &EightHits) -> Self {
        if let LightKind::Directional(to_light) = light.kind {
            let [x, y, z] = to_light.to_array();
            let to_light = [<S::Doubles>::splat(x), <S::Doubles>::splat(y), <S::Doubles>::splat(z)];
            let direction = widen::<S>(&splat3(light.arrive(DVec3::ZERO).direction.to_array()));
            return Self { to_light, direction, color: splat3(light.color.to_array()) };
        }
        let (mut to_light, mut direction, mut color) = ([[0.0; 8]; 3], [[0.0; 8]; 3], [[0.0; 8]; 3]);
        for k in 0..8 {
            let Arrival { to_light: l, direction: d, color: c, .. } = light.arrive(vector(&hits.at.point, k));
            set(&mut to_light, k, l);
            (direction[0][k], direction[1][k], direction[2][k]) = (d.x, d.y, d.z);
            (color[0][k], color[1][k], color[2][k]) = (c.x, c.y, c.z);
        }
        Self { to_light: load(&to_light), direction: widen::<S>(&load3(&direction)), color: load3(&color) }
    }
}

/// How one light meets eight items, before anything in the way is asked for.
#[derive(Debug)]
pub(crate) struct EightLit {
    /// What it adds.
    color: Colors,
    /// The lanes from which the light is on side 1 of the triangle.
    pub(crate) up: u32,
    /// The lanes to which it adds nothing.
    pub(crate) dark: u32,
    /// The lanes that have to be asked by themselves: [`Item::lit_by`]. What else is said of them does not hold.
    pub(crate) open: u32,
}

impl EightLit {
    /// What it adds to lane `k`.
    pub(crate) fn color(&self, k: usize) -> GzColor {
        coord(&self.color, k)
    }
}

/// One light and all items of a tree.
pub(crate) struct LightAll<'a> {
    pub(crate) items: &'a [EightItems],
    pub(crate) hits: &'a [EightHits],
    pub(crate) light: &'a GzLight,
    /// Whether shadow rays are cast.
    pub(crate) casting: bool,
    /// How the light meets each of `items`.
    pub(crate) lit: &'a mut Vec<EightLit>,
}

impl Task for LightAll<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        self.lit.clear();
        for items in self.items {
            self.lit.push(items.lit_by::<S>(&self.hits[items.hits], self.light, self.casting));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Falloff;
    use crate::hits::tests::{dice, eight};
    use crate::phong::{Coefficients, light_share};
    use gz_core::simd::dispatch;
    use gz_core::{GzCoord, SimdLevel, side_of};

    #[test]
    fn what_a_light_adds_is_what_it_adds_to_one_hit_at_every_level() {
        let (mut unit, mut dark, mut bright, mut open) = (dice(), 0, 0, 0);
        for round in 0..300usize {
            let (tris, hits, rays) = eight(&mut unit);
            let mut items = EightItems::new(0, &hits);
            let of: [Item; 8] = std::array::from_fn(|k| {
                // A round of whole powers only, and one of all.
                let power = [0.0, 1.0, 40.0, 65535.0, 65536.0, 2.5, 1e9, 7.0][if round % 2 == 0 { k % 4 } else { k }];
                let color = |x: f32| GzColor::new(x.abs(), 0.5, x * x);
                let ks = if (round + k) % 3 == 0 { GzColor::ZERO } else { color(unit()) };
                let coefficients = Coefficients { ka: GzColor::ONE, kd: color(unit()), ks, power };
                let n = GzCoord::new(unit(), unit(), unit()).as_dvec3().normalize();
                let viewer = if round % 5 == 0 { 0 } else { -hits.at.to_side[k] };
                Item { corners: None, n: Some(n), e: -rays[k].direction, viewer, k: coefficients, sum: [GzColor::ZERO; 3] }
            });
            of.iter().enumerate().for_each(|(k, item)| items.add(k, item));
            let place = GzCoord::new(unit(), unit(), unit()).as_dvec3() * 3.0;
            let kind = if round % 3 == 0 {
                LightKind::Point { position: place, falloff: Falloff { c0: 1.0, c1: 0.1, c2: 0.0 } }
            } else {
                LightKind::Directional(place.normalize())
            };
            let (light, casting) = (GzLight { kind, color: GzColor::new(0.9, 0.6, 0.0) }, round % 2 == 0);
            for &level in SimdLevel::available() {
                let mut lit = Vec::new();
                let (items, hits, light) = (std::slice::from_ref(&items), std::slice::from_ref(&hits), &light);
                dispatch(level, LightAll { items, hits, light, casting, lit: &mut lit });
                for (k, item) in of.iter().enumerate() {
                    let arrival = light.arrive(vector(&hits[0].at.point, k));
                    let side = side_of(tris.position(hits[0].tris[k]), arrival.direction);
                    if lit[0].open >> k & 1 != 0 {
                        open += 1;
                        continue;
                    }
                    let share = light_share(&item.k, item.n.unwrap(), arrival.to_light, item.e.as_dvec3()) * arrival.color;
                    let adds = share != GzColor::ZERO && (item.viewer == 0 || side == item.viewer);
                    assert_eq!(lit[0].dark >> k & 1 == 0, adds, "round {round} lane {k} at {level:?}");
                    if adds {
                        bright += 1;
                        assert_eq!(lit[0].color(k), share, "round {round} lane {k} at {level:?}");
                        assert!(!casting || (lit[0].up >> k & 1 != 0) == (side == 1));
                    } else {
                        dark += 1;
                    }
                }
            }
        }
        assert!(dark > 1000 && bright > 1000 && open < 50, "{dark} dark, {bright} bright, {open} open");
    }
}
