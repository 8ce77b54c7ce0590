//! Classes of hard rays, in blocks that follow from a seed.

use super::Dice;
use super::company::Company;
use super::meshes::{self, Corners, Mesh};
use gz_core::glam::DVec3;
use gz_core::{GzCoord, GzRay};

/// What makes the rays of a block hard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Aimed at edges that triangles share.
    Edges,
    /// Aimed at corners that triangles share.
    Vertices,
    /// At 1e-7 to 1e-2 radians to a triangle's plane.
    Grazing,
    /// At triangles a hundred to ten million times as long as thick.
    Needles,
    /// Along axes, with zeros of both signs.
    Axis,
    /// In the plane of a triangle or of a cut, or one step of f32 beside it.
    InPlane,
    /// Far from the origin of space, to 1e6.
    Offsets,
    /// In scenes of 1e-18 to 1e18.
    Scales,
    /// At triangles that are copies, nearly copies, or in one plane.
    Duplicates,
    /// On whole numbers, where everything ties.
    Grids,
    /// At anything, from anywhere, within any ends.
    Random,
}

/// Triangles, and rays to ask about.
#[derive(Clone, Debug)]
pub struct Block {
    /// Corners of the triangles.
    pub triangles: Vec<Corners>,
    /// The rays, [`RAYS`] of them.
    pub rays: Vec<GzRay>,
    /// What those of a run have in common.
    pub company: Company,
}

/// Rays of a block.
pub const RAYS: usize = 1024;

/// Blocks in a row that differ in what their rays have in common.
pub const TURNS: u64 = 4;

/// Triangles, and rays from anywhere.
type Scattered = (Vec<Corners>, Vec<GzRay>);

impl Class {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Edges,
        Self::Vertices,
        Self::Grazing,
        Self::Needles,
        Self::Axis,
        Self::InPlane,
        Self::Offsets,
        Self::Scales,
        Self::Duplicates,
        Self::Grids,
        Self::Random,
    ];

    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Edges => "edges",
            Self::Vertices => "vertices",
            Self::Grazing => "grazing",
            Self::Needles => "needles",
            Self::Axis => "axis",
            Self::InPlane => "in-plane",
            Self::Offsets => "offsets",
            Self::Scales => "scales",
            Self::Duplicates => "duplicates",
            Self::Grids => "grids",
            Self::Random => "random",
        }
    }

    /// Block `number` of this class; the same from the same seed. Of [`TURNS`] blocks in a row, the rays of all but one go in company.
    pub fn block(self, seed: u64, number: u64) -> Block {
        let company = match number % TURNS {
            0 => Company::None,
            // These lose what is hard about them when they start elsewhere.
            _ if matches!(self, Self::Grazing | Self::Axis | Self::InPlane) => Company::Way,
            1 => Company::Origin,
            2 => Company::Near,
            _ => Company::Direction,
        };
        let (triangles, mut rays) = self.scattered(seed, number);
        company.gather(&mut rays);
        if self == Self::Scales {
            with_other_lengths(&mut Dice::new(!seed ^ number), &mut rays);
        }
        Block { triangles, rays, company }
    }

    /// Triangles and rays from anywhere.
    fn scattered(self, seed: u64, number: u64) -> Scattered {
        let start = seed ^ (number * Self::ALL.len() as u64 + self as u64 + 1).wrapping_mul(0xa076_1d64_78bd_642f);
        let mut dice = Dice::new(start);
        // A generator that has run a little: neighbouring starts are unrelated.
        dice.bits();
        let dice = &mut dice;
        match self {
            Self::Edges => {
                let mesh = closed(dice, DVec3::ZERO);
                mesh_rays(dice, mesh, at_edge)
            }
            Self::Vertices => {
                let mesh = closed(dice, DVec3::ZERO);
                mesh_rays(dice, mesh, |dice, mesh, _| mesh.points[dice.below(mesh.points.len())].as_dvec3())
            }
            Self::Grazing => grazing(dice),
            Self::Needles => needles(dice),
            Self::Axis => axis(dice),
            Self::InPlane => in_plane(dice),
            Self::Offsets => offsets(dice),
            Self::Scales => scaled(dice),
            Self::Duplicates => duplicates(dice),
            Self::Grids => grids(dice),
            Self::Random => random(dice),
        }
    }
}

/// A closed mesh around `centre`: of corners that share many triangles, or few.
fn closed(dice: &mut Dice, centre: DVec3) -> Mesh {
    match dice.below(4) {
        0 if centre == DVec3::ZERO => meshes::cube(),
        1 => {
            let slivers = 3 + dice.below(60);
            moved(meshes::pole_fan(dice, slivers), centre)
        }
        n => {
            let columns = 5 + 4 * n;
            meshes::jittered_sphere(dice, columns, centre)
        }
    }
}

fn moved(mut mesh: Mesh, by: DVec3) -> Mesh {
    mesh.points.iter_mut().for_each(|p| *p = (p.as_dvec3() + by).as_vec3());
    mesh
}

/// A point of an edge.
fn at_edge(dice: &mut Dice, mesh: &Mesh, edges: &[[usize; 2]]) -> DVec3 {
    let [a, b] = dice.pick(edges).map(|k| mesh.points[k].as_dvec3());
    a + (b - a) * dice.unit()
}

/// Rays from inside and from outside of a mesh at what `aim` gives; of the cube, exactly at it.
fn mesh_rays(dice: &mut Dice, mesh: Mesh, aim: impl Fn(&mut Dice, &Mesh, &[[usize; 2]]) -> DVec3) -> Scattered {
    let edges = mesh.edges();
    let rays = (0..RAYS)
        .map(|k| {
            let reach = if k % 4 == 0 { 20.0 } else { 0.5 };
            let target = aim(dice, &mesh, &edges);
            if mesh.points.len() == 98 {
                // Whole numbers, the middle of an edge too: nothing is rounded.
                let [a, b] = dice.pick(&edges).map(|k| mesh.points[k]);
                let origin = dice.whole_point(if k % 4 == 0 { 20 } else { 5 });
                return GzRay::new(origin, if k % 2 == 0 { (a + b) * 0.5 - origin } else { a - origin });
            }
            shot(dice.point(reach), target, k)
        })
        .collect();
    (mesh.triangles(), rays)
}

/// From an f32 origin, or from the f64 one itself.
fn shot(origin: DVec3, target: DVec3, k: usize) -> GzRay {
    let origin = if k.is_multiple_of(3) { origin } else { origin.as_vec3().as_dvec3() };
    GzRay::from_f64(origin, (target - origin).as_vec3())
}

/// A point of a triangle: inside, on an edge, a corner.
fn on(dice: &mut Dice, corners: &Corners) -> DVec3 {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let [wa, wb, wc] = match dice.below(6) {
        0 => [1.0, 0.0, 0.0],
        1 => {
            let w = dice.unit();
            [w, 1.0 - w, 0.0]
        }
        _ => dice.weights(),
    };
    a * wa + b * wb + c * wc
}

fn grazing(dice: &mut Dice) -> Scattered {
    let mut triangles: Vec<Corners> = (0..40)
        .map(|_| std::array::from_fn(|_| (dice.point(1.0) * DVec3::new(5.6, 4.85, 0.7) + DVec3::Z * 3.0).as_vec3()))
        .collect();
    // A floor of large and small triangles in one plane.
    let frame = dice.frame();
    let place = |s: f64, t: f64| (frame[0] * s + frame[1] * t).as_vec3();
    triangles.extend((0..40).map(|k| {
        let (s, t, size) = (dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0, if k % 8 == 0 { 30.0 } else { 2.0 });
        [place(s, t), place(s + size, t), place(s, t + size)]
    }));
    let rays = (0..RAYS)
        .map(|k| {
            let corners = dice.pick(&triangles);
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let n = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z);
            let d = dice.direction();
            let flat = (d - n * d.dot(n)).try_normalize().unwrap_or(DVec3::X);
            let d = flat + n * (dice.magnitude(-7.0, -2.0) * dice.sign());
            let target = on(dice, &corners);
            shot(target - d * f64::from(dice.between(1.0, 600.0)), target, k)
        })
        .collect();
    (triangles, rays)
}

fn needles(dice: &mut Dice) -> Scattered {
    let triangles: Vec<Corners> = (0..40)
        .flat_map(|_| {
            let (aspect, centre) = (dice.magnitude(2.0, 7.0), dice.point(3.0));
            meshes::needles(dice, aspect, centre)
        })
        .collect();
    let rays = aimed(dice, &triangles, 10.0);
    (triangles, rays)
}

/// Rays at triangles from up to `away` from them.
fn aimed(dice: &mut Dice, triangles: &[Corners], away: f64) -> Vec<GzRay> {
    (0..RAYS)
        .map(|k| {
            let corners = dice.pick(triangles);
            let target = on(dice, &corners);
            shot(target + dice.direction() * (away * (0.05 + dice.unit())), target, k)
        })
        .collect()
}

fn axis(dice: &mut Dice) -> Scattered {
    let mut triangles = meshes::soup(dice, 100, 0.4);
    triangles.extend(meshes::integer_field(dice, 6).iter().map(|t| t.map(|p| p * 0.25 - 0.75)));
    let rays = (0..RAYS)
        .map(|k| {
            let corners = dice.pick(&triangles);
            let target = on(dice, &corners).as_vec3();
            let zero = if dice.sign() > 0.0 { 0.0 } else { -0.0 };
            let mut direction = GzCoord::splat(zero);
            direction[dice.below(3)] = (dice.sign() * if k % 5 == 0 { dice.magnitude(-3.0, 3.0) } else { 1.0 }) as f32;
            if k % 4 == 0 {
                direction[dice.below(3)] = dice.sign() as f32;
            }
            GzRay::new(target - direction * dice.between(0.5, 3.0), direction)
        })
        .collect();
    (triangles, rays)
}

fn in_plane(dice: &mut Dice) -> Scattered {
    let mut triangles = meshes::soup(dice, 60, 0.5);
    // Walls across the axes at halves and quarters of the box, where cuts fall, and triangles that touch them.
    for k in 0..40 {
        let (axis, plane) = (k % 3, dice.pick(&[-0.5f32, 0.0, 0.5, -1.0, 1.0]));
        let mut corners: Corners = std::array::from_fn(|_| dice.point(1.0).as_vec3());
        let touching = 1 + dice.below(3);
        corners.iter_mut().take(touching).for_each(|p| p[axis] = plane);
        triangles.push(corners);
    }
    let rays = (0..RAYS)
        .map(|k| {
            let [a, b, c] = dice.pick(&triangles);
            let axis = dice.below(3);
            match k % 4 {
                // Along an edge's line, and within a plane as f32 has it.
                0 => GzRay::new(a - (b - a), b - a),
                1 => {
                    let (s, t) = (dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
                    let d = (b - a) * s + (c - a) * t;
                    GzRay::new(a - d * 2.0, d)
                }
                // In a plane across an axis, where a cut may be, and a step beside it.
                _ => {
                    let plane = dice.pick(&[-0.5f32, 0.0, 0.5, a[axis], 1.0]);
                    let (mut origin, mut direction) = (dice.point(1.5).as_vec3(), dice.direction().as_vec3());
                    origin[axis] = if k % 8 == 2 { plane.next_up() } else { plane };
                    direction[axis] = dice.pick(&[0.0, -0.0, f32::from_bits(1), 1e-30, -1e-20]);
                    GzRay::new(origin, direction)
                }
            }
        })
        .map(|ray| if ray.direction == GzCoord::ZERO { GzRay { direction: GzCoord::X, ..ray } } else { ray })
        .collect();
    (triangles, rays)
}

fn offsets(dice: &mut Dice) -> Scattered {
    let offset = dice.direction() * dice.pick(&[1e2, 1e3, 1e4, 1e5, 1e6]);
    if dice.below(3) == 0 {
        let mesh = closed(dice, offset);
        let edges = mesh.edges();
        let aim = |dice: &mut Dice| {
            if dice.below(2) == 0 { at_edge(dice, &mesh, &edges) } else { mesh.points[dice.below(mesh.points.len())].as_dvec3() }
        };
        let rays = (0..RAYS).map(|k| shot(offset + dice.point(if k % 4 == 0 { 20.0 } else { 0.5 }), aim(dice), k)).collect();
        return (mesh.triangles(), rays);
    }
    let place = |p: GzCoord| (p.as_dvec3() * 4.0 + offset).as_vec3();
    let triangles: Vec<Corners> = meshes::soup(dice, 200, 0.5).iter().map(|corners| corners.map(place)).collect();
    let rays = aimed(dice, &triangles, 12.0);
    (triangles, rays)
}

fn scaled(dice: &mut Dice) -> Scattered {
    let scale = dice.magnitude(-18.0, 18.0);
    let triangles: Vec<Corners> =
        meshes::soup(dice, 150, 0.5).iter().map(|corners| corners.map(|p| (p.as_dvec3() * scale).as_vec3())).collect();
    let rays = aimed(dice, &triangles, 3.0 * scale);
    (triangles, rays)
}

/// Gives every other ray a direction of another length than the way to where it is aimed: near 1, whatever the scale of the scene.
fn with_other_lengths(dice: &mut Dice, rays: &mut [GzRay]) {
    let longest = rays.iter().map(|ray| f64::from(ray.direction.abs().max_element())).fold(0.0, f64::max);
    let factor = dice.magnitude(-3.0, 3.0) / longest;
    for ray in rays.iter_mut().step_by(2) {
        ray.direction = (ray.direction.as_dvec3() * factor).as_vec3();
    }
}

fn duplicates(dice: &mut Dice) -> Scattered {
    let mut triangles = meshes::soup(dice, 40, 0.6);
    for k in 0..40 {
        let [a, b, c] = triangles[k];
        let axis = dice.below(3);
        let mut nearer = [a, b, c];
        nearer.iter_mut().for_each(|p| p[axis] = p[axis].next_up());
        let inner = [(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5];
        triangles.extend([[a, b, c], [c, b, a], nearer, inner]);
    }
    // Coplanar ones in a plane of sixteenths.
    triangles.extend((0..40).map(|_| {
        std::array::from_fn(|_| {
            let p = dice.whole_point(24) * 0.0625;
            GzCoord::new(p.x, p.y, 0.5 * p.x + p.y + 0.25)
        })
    }));
    let rays = aimed(dice, &triangles, 4.0);
    (triangles, rays)
}

fn grids(dice: &mut Dice) -> Scattered {
    let size = 4 + dice.below(8);
    let triangles = meshes::integer_field(dice, size);
    let rays = (0..RAYS)
        .map(|k| {
            let origin = dice.whole_point(size as i32 + 3);
            let target = match k % 3 {
                0 => dice.pick(&triangles)[0],
                1 => dice.whole_point(size as i32),
                _ => {
                    let [a, b, _] = dice.pick(&triangles);
                    // The middle of an edge, from an origin that keeps the difference whole or half.
                    (a + b) * 0.5
                }
            };
            let direction =
                if k % 7 == 0 { dice.pick(&[GzCoord::X, GzCoord::Y, GzCoord::Z, GzCoord::NEG_Z]) } else { target - origin };
            GzRay::new(origin, if direction == GzCoord::ZERO { GzCoord::NEG_Z } else { direction })
        })
        .collect();
    (triangles, rays)
}

fn random(dice: &mut Dice) -> Scattered {
    let size = dice.magnitude(-1.0, 0.3);
    let triangles = meshes::soup(dice, 256, size);
    let rays = (0..RAYS)
        .map(|k| {
            let ray = shot(dice.point(3.0), dice.point(1.0), k);
            match k % 8 {
                0 => GzRay { tmin: dice.between(-1.0, 1.0), tmax: dice.between(0.5, 2.0), ..ray },
                1 => GzRay { tmin: f32::NEG_INFINITY, ..ray },
                _ => ray,
            }
        })
        .collect();
    (triangles, rays)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::settled;
    use crate::judge::{buffer, truth_ray};

    #[test]
    fn blocks_follow_from_their_seed_and_hit_something() {
        for class in Class::ALL {
            for number in 4..4 + TURNS {
                let (block, again, other) = (class.block(1, number), class.block(1, number), class.block(1, number + TURNS));
                assert!(block.triangles == again.triangles && block.rays == again.rays, "{class:?}");
                assert!(block.rays.len() == RAYS && block.rays != other.rays && block.triangles.len() >= 6, "{class:?}");
                let some: Vec<GzRay> = block.rays.iter().copied().step_by(5).collect();
                let hits = settled(class.name(), &buffer(block.triangles.iter().copied()), &some);
                let count = hits.iter().filter(|hit| hit.is_hit()).count();
                assert!(count > 20, "{class:?}, {:?}: {count} of {} hit", block.company, some.len());
                assert!(block.rays.iter().filter(|ray| truth_ray(ray).line().is_some()).count() > RAYS / 2, "{class:?}");
            }
        }
    }
}
