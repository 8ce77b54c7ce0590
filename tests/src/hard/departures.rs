//! Hits and the directions in which rays leave them: cases F and G.

use super::Dice;
use super::meshes::{self, Corners};
use gz_core::glam::DVec3;
use gz_core::{GzCoord, GzRay, side_of};

/// A hard case of leaving a surface, by its label in the list of hard cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Label {
    /// A flat quad in two triangles, at offsets to 1e6, left anywhere in any direction.
    F1,
    /// The same, left within 1e-4 of the diagonal at 1e-3 to 1e-1 radians.
    F2,
    /// A strip that is folded by 1e-3 radians, left at its fold.
    F3,
    /// The inside of a box, left 1e-7 to 1e-2 of its size from an edge.
    F4,
    /// The inside of a box, left exactly at an edge or a corner.
    F5,
    /// A plate 1e-2 to 1e-6 above a surface.
    F6,
    /// A floor of many triangles under a light that is 1e-4 above it.
    F8,
    /// Small quads around the origin, whose coordinates are on either side of 0.
    F12,
    /// A slab 1e-3 or 1e-5 thick that a ray goes into: it must meet the other face.
    G7,
    /// The same at an offset of 100, 1e-4 thick.
    G8,
    /// A ray into a block, straight to an edge of a face that it could leave by.
    G13,
}

impl Label {
    /// All of them.
    pub const ALL: [Self; 11] =
        [Self::F1, Self::F2, Self::F3, Self::F4, Self::F5, Self::F6, Self::F8, Self::F12, Self::G7, Self::G8, Self::G13];

    /// What it is about, in a few words.
    pub fn what(self) -> &'static str {
        match self {
            Self::F1 => "flat quads, offsets to 1e6",
            Self::F2 => "the same near the diagonal, grazing",
            Self::F3 => "folds of 1e-3 rad",
            Self::F4 => "in a box, near an edge",
            Self::F5 => "in a box, on an edge or corner",
            Self::F6 => "gaps of 1e-6 to 1e-2",
            Self::F8 => "a floor, light 1e-4 above it",
            Self::F12 => "coordinates around 0",
            Self::G7 => "into slabs 1e-5, 1e-3 thick",
            Self::G8 => "into a slab 1e-4 thick at 100",
            Self::G13 => "into a block, at an edge",
        }
    }

    /// Triangles to leave.
    pub(super) fn stage(self, dice: &mut Dice) -> Stage {
        let frame = match self {
            // A frame in which nothing is rounded, as often as not.
            Self::F8 if dice.sign() > 0.0 => [DVec3::X, DVec3::Y, DVec3::Z],
            _ => dice.frame(),
        };
        let offset = match self {
            Self::F1 | Self::F2 => dice.pick(&[0.0, 1e2, 1e4, 1e6]),
            Self::F3 | Self::F6 => dice.pick(&[0.0, 1e2]),
            Self::F4 => dice.pick(&[0.0, 1e2, 1e4]),
            Self::G8 => 1e2,
            _ => 0.0,
        };
        let size = match self {
            Self::F6 => dice.magnitude(-6.0, -2.0),
            Self::F12 => dice.magnitude(-4.0, -1.5),
            Self::G7 => dice.pick(&[1e-3, 1e-5]),
            Self::G8 => 1e-4,
            _ => 1.0,
        };
        let centre = match self {
            Self::F5 => (dice.whole_point(1) * dice.pick(&[0.0, 100.0, 1000.0])).as_dvec3(),
            _ => dice.direction() * offset,
        };
        let mut stage = Stage { label: self, triangles: Vec::new(), centre, frame, size };
        stage.triangles = stage.build(dice);
        stage
    }
}

/// Triangles, and where on them the cases of a label lie.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    label: Label,
    pub(super) triangles: Vec<Corners>,
    centre: DVec3,
    /// Two directions along the surface, and the one off it.
    frame: [DVec3; 3],
    /// Of the gap, slab or quad that the label is about.
    size: f64,
}

/// One way on from one hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    /// The ray that hits the surface.
    pub(super) ray: GzRay,
    /// Where the leaving ray ends.
    pub(super) tmax: f32,
    onward: GzCoord,
    through: bool,
}

impl Case {
    /// The direction in which it goes on from the triangle hit; `None` when that is not to the side to which it should go.
    pub(super) fn onward(&self, corners: &Corners) -> Option<GzCoord> {
        let came = side_of(corners, self.ray.direction);
        let wanted = if self.through { came } else { -came };
        (wanted != 0 && side_of(corners, self.onward) == wanted).then_some(self.onward)
    }
}

impl Stage {
    /// The point at (s, t) on the surface and `h` off it.
    fn at(&self, s: f64, t: f64, h: f64) -> DVec3 {
        let [x, y, n] = self.frame;
        self.centre + x * s + y * t + n * h
    }

    fn build(&self, dice: &mut Dice) -> Vec<Corners> {
        let quad = |size: f64, h: f64| -> [Corners; 2] {
            let at = |s: f64, t: f64| self.at(s * size, t * size, h).as_vec3();
            let [a, b, c, d] = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
            [[a, b, c], [a, c, d]]
        };
        let block = |thickness: f64| -> Vec<Corners> {
            let mesh = meshes::block(GzCoord::NEG_ONE, GzCoord::ONE);
            let place = |p: GzCoord| self.at(p.x.into(), p.y.into(), f64::from(p.z) * thickness / 2.0).as_vec3();
            mesh.triangles().iter().map(|corners| corners.map(place)).collect()
        };
        match self.label {
            Label::F1 | Label::F2 => quad(1.0, 0.0).to_vec(),
            Label::F3 => {
                let (a, b) = (self.at(-1.0, 0.0, 0.0).as_vec3(), self.at(1.0, 0.0, 0.0).as_vec3());
                let wing = |t: f64| self.at(dice.unit() - 0.5, t, -5e-4).as_vec3();
                let [c, d] = [1.0, -1.0].map(wing);
                vec![[a, b, c], [b, a, d]]
            }
            Label::F4 | Label::G13 => block(2.0),
            Label::F5 => {
                let centre = self.centre.as_vec3();
                meshes::cube().triangles().iter().map(|corners| corners.map(|p| p + centre)).collect()
            }
            Label::F6 => [quad(1.0, 0.0), quad(3.0, self.size)].concat(),
            Label::F8 => {
                let point = |i: usize, j: usize| self.at(i as f64 / 2.0 - 2.0, j as f64 / 2.0 - 2.0, 0.0).as_vec3();
                let cell = |(i, j)| {
                    let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
                    [[a, b, c], [a, c, d]]
                };
                (0..8).flat_map(|i| (0..8).map(move |j| (i, j))).flat_map(cell).collect()
            }
            Label::F12 => quad(self.size, 0.0).to_vec(),
            Label::G7 | Label::G8 => block(self.size),
        }
    }

    pub(super) fn case(&self, dice: &mut Dice) -> Case {
        let inside = |dice: &mut Dice| 1.98 * dice.unit() - 0.99;
        let [.., n] = self.frame;
        match self.label {
            Label::F1 => {
                let aim = self.at(inside(dice), inside(dice), 0.0);
                self.bounce(dice, aim, 2.0, |dice| hemisphere(dice, n))
            }
            Label::F2 => {
                let (along, off) = (inside(dice), 7e-5 * (2.0 * dice.unit() - 1.0));
                let aim = self.at(along + off, along - off, 0.0);
                self.bounce(dice, aim, 2.0, |dice| self.grazing(dice, -3.0, -1.0))
            }
            Label::F3 => {
                let aim = self.at(inside(dice), 0.0, 0.0);
                self.bounce(dice, aim, 2.0, |dice| self.grazing(dice, -4.0, -1.0))
            }
            Label::F4 => self.near_an_edge(dice),
            Label::F5 => self.on_an_edge(dice),
            Label::F6 => {
                // From within the gap, and steep enough for the plate to be in the way.
                let aim = self.at(inside(dice), inside(dice), 0.0);
                let origin = aim + n * (0.5 * self.size) + self.flat(dice) * 0.01;
                let out = |dice: &mut Dice| (hemisphere(dice, n) + n * 0.5).normalize();
                case(origin, aim, out(dice), false)
            }
            Label::F8 => {
                let aim = self.at(2.0 * inside(dice), 2.0 * inside(dice), 0.0);
                self.bounce(dice, aim, 2.0, |dice| self.grazing(dice, -4.0, -4.0))
            }
            Label::F12 => {
                let aim = self.at(self.size * inside(dice), self.size * inside(dice), 0.0);
                self.bounce(dice, aim, 0.1, |dice| hemisphere(dice, n))
            }
            Label::G7 | Label::G8 => {
                let aim = self.at(inside(dice), inside(dice), self.size / 2.0);
                let origin = aim + (hemisphere(dice, n) + n * 0.2) * 2.0;
                // As steep as glass bends at least.
                let onward = -(hemisphere(dice, n) + n * 0.7).normalize();
                case(origin, aim, onward, true)
            }
            Label::G13 => {
                let aim = self.at(inside(dice), inside(dice), 1.0);
                let origin = aim + (hemisphere(dice, n) + n * 0.2) * 2.0;
                // One of the four edges of the far face, or of the four beside it.
                let (side, along) = (dice.sign(), 2.0 * dice.unit() - 1.0);
                let target = match dice.below(3) {
                    0 => self.at(side, along, -1.0),
                    1 => self.at(along, side, -1.0),
                    _ => self.at(side, dice.sign(), along),
                };
                case(origin, aim, target - aim, true)
            }
        }
    }

    /// In the box [-1, 1]^3 of the frame: a hit near the edge of two walls.
    fn near_an_edge(&self, dice: &mut Dice) -> Case {
        let off = 1.0 - 2.0 * dice.magnitude(-7.0, -2.0);
        let [wall, near] = [dice.sign(), dice.sign() * off];
        let along = 1.9 * dice.unit() - 0.95;
        let k = dice.below(3);
        let turned = |p: [f64; 3]| self.at(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
        let from = [0, 1, 2].map(|_| 1.6 * dice.unit() - 0.8);
        let (aim, origin) = (turned([wall, near, along]), self.at(from[0], from[1], from[2]));
        if dice.sign() > 0.0 {
            // To a light inside: nothing is in the way, as the box is convex.
            let light = [0, 1, 2].map(|_| 1.6 * dice.unit() - 0.8);
            return Case { tmax: 1.0, ..case(origin, aim, self.at(light[0], light[1], light[2]) - aim, false) };
        }
        // Off to anywhere: a wall is in the way.
        let inward = (turned([0.0, near, along]) - aim).normalize();
        case(origin, aim, hemisphere(dice, inward), false)
    }

    /// In the cube of whole numbers: a hit exactly on an edge or corner, and from there into the cube, or anywhere.
    fn on_an_edge(&self, dice: &mut Dice) -> Case {
        let corners = dice.pick(&self.triangles);
        let (a, b) = (corners[0], corners[1]);
        let centre = self.centre.as_vec3();
        let (origin, parts) = (dice.whole_point(5) + centre, 1 + dice.below(6));
        let part = dice.below(parts + 1) as f32;
        // Whole numbers below 2^24: nothing is rounded.
        let direction = a * (parts as f32 - part) + b * part - origin * parts as f32;
        let at = origin + direction / parts as f32;
        // To a light inside, beyond a point inside, anywhere at all.
        let (onward, tmax) = match dice.below(4) {
            0 => (dice.direction().as_vec3(), f32::INFINITY),
            1 => (dice.point(7.0).as_vec3() + centre - at, 1.0),
            _ => (dice.point(7.0).as_vec3() + centre - at, f32::INFINITY),
        };
        Case { ray: GzRay::new(origin, direction), tmax, onward, through: false }
    }

    /// A hit at `aim` from up to `away` off the surface, and a direction off it.
    fn bounce(&self, dice: &mut Dice, aim: DVec3, away: f64, onward: impl FnOnce(&mut Dice) -> DVec3) -> Case {
        let [.., n] = self.frame;
        let origin = aim + (hemisphere(dice, n) + n * 0.2) * (away * (0.1 + dice.unit()));
        case(origin, aim, onward(dice), false)
    }

    /// A unit vector along the surface.
    fn flat(&self, dice: &mut Dice) -> DVec3 {
        let [x, y, _] = self.frame;
        let around = dice.direction();
        (x * around.x + y * around.y).try_normalize().unwrap_or(x)
    }

    /// A direction that leaves the surface at 10^lo to 10^hi radians.
    fn grazing(&self, dice: &mut Dice, lo: f64, hi: f64) -> DVec3 {
        let [.., n] = self.frame;
        self.flat(dice) + n * dice.magnitude(lo, hi)
    }
}

fn case(origin: DVec3, aim: DVec3, onward: DVec3, through: bool) -> Case {
    let ray = GzRay::from_f64(origin, (aim - origin).as_vec3());
    Case { ray, tmax: f32::INFINITY, onward: onward.as_vec3(), through }
}

/// A direction on the side of `n`.
fn hemisphere(dice: &mut Dice, n: DVec3) -> DVec3 {
    let d = dice.direction();
    if d.dot(n) < 0.0 { -d } else { d }
}
