//! Meshes that are hard to hit right.

use super::Dice;
use gz_core::GzCoord;
use gz_core::glam::DVec3;

/// Corners of triangles.
pub type Corners = [GzCoord; 3];

/// Corners that triangles share, and the three that each one has.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The corners.
    pub points: Vec<GzCoord>,
    /// The triangles.
    pub faces: Vec<[usize; 3]>,
}

impl Mesh {
    /// Corners of all triangles.
    pub fn triangles(&self) -> Vec<Corners> {
        self.faces.iter().map(|face| face.map(|k| self.points[k])).collect()
    }

    /// Every edge once, as two corners' numbers.
    pub fn edges(&self) -> Vec<[usize; 2]> {
        let pairs = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]];
        let mut edges: Vec<[usize; 2]> = self.faces.iter().flat_map(pairs).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The triangles that have corner `k`.
    pub fn around(&self, k: usize) -> Vec<u32> {
        (0..).zip(&self.faces).filter(|(_, face)| face.contains(&k)).map(|(tri, _)| tri).collect()
    }

    /// A grid of quads, each in two triangles; `place(i, j)` puts corner (i, j), and `wraps` joins the last column to the first.
    fn grid(columns: usize, rows: usize, wraps: bool, place: impl Fn(usize, usize) -> GzCoord) -> Self {
        let across = if wraps { columns } else { columns + 1 };
        let points = (0..=rows).flat_map(|j| (0..across).map(move |i| (i, j))).map(|(i, j)| place(i, j)).collect();
        let at = |i: usize, j: usize| j * across + i % across;
        let quad = |(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        let faces = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))).flat_map(quad).collect();
        Self { points, faces }
    }
}

/// pbrt's test mesh: a closed sphere of `n` by `n` quads around `centre`, each corner at its own distance of 1 to 6; triangles at the poles.
pub fn jittered_sphere(dice: &mut Dice, n: usize, centre: DVec3) -> Mesh {
    let mut mesh = Mesh::default();
    let mut put = |direction: DVec3| {
        mesh.points.push((centre + direction * (1.0 + 5.0 * dice.unit())).as_vec3());
        mesh.points.len() - 1
    };
    let (top, bottom) = (put(DVec3::Y), put(DVec3::NEG_Y));
    let rings: Vec<Vec<usize>> = (1..n)
        .map(|j| {
            let theta = std::f64::consts::PI * j as f64 / n as f64;
            let around = |i: usize| {
                let phi = std::f64::consts::TAU * i as f64 / n as f64;
                DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
            };
            (0..n).map(|i| put(around(i))).collect()
        })
        .collect();
    for i in 0..n {
        let next = (i + 1) % n;
        mesh.faces.push([top, rings[0][i], rings[0][next]]);
        mesh.faces.push([bottom, rings[n - 2][next], rings[n - 2][i]]);
        for pair in rings.windows(2) {
            mesh.faces.push([pair[0][i], pair[1][i], pair[1][next]]);
            mesh.faces.push([pair[0][i], pair[1][next], pair[0][next]]);
        }
    }
    mesh
}

/// The cube [-8, 8]^3, each face cut into 4 by 4 quads: all corners are multiples of 4.
pub fn cube() -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for side in [-8.0, 8.0] {
            let face = Mesh::grid(4, 4, false, |i, j| {
                let mut p = GzCoord::ZERO;
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, 4.0 * i as f32 - 8.0, 4.0 * j as f32 - 8.0);
                p
            });
            // Corners that faces share are one corner.
            let number = |mesh: &mut Mesh, p: GzCoord| {
                mesh.points.iter().position(|&q| q == p).unwrap_or_else(|| {
                    mesh.points.push(p);
                    mesh.points.len() - 1
                })
            };
            for corners in face.triangles() {
                let numbers = corners.map(|p| number(&mut mesh, p));
                mesh.faces.push(numbers);
            }
        }
    }
    mesh
}

/// A closed double cone: `n` slivers meet in each of its points, (0, 0, 2) and (0, 0, -2). Corner 0 is the first of them.
pub fn spindle(n: usize) -> Mesh {
    let mut points = vec![GzCoord::Z * 2.0, GzCoord::Z * -2.0];
    points.extend((0..n).map(|i| {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        GzCoord::new(angle.cos() as f32, angle.sin() as f32, 0.0)
    }));
    let faces = (0..n).flat_map(|i| {
        let (a, b) = (2 + i, 2 + (i + 1) % n);
        [[0, a, b], [1, b, a]]
    });
    Mesh { faces: faces.collect(), points }
}

/// A closed cap in a random frame around the origin: `n` slivers meet in corner 0, the pole, at distance 2; their rim is 10 degrees away,
/// and as many long ones close it from the other side.
pub fn pole_fan(dice: &mut Dice, n: usize) -> Mesh {
    let ([x, y, z], tilt) = (dice.frame(), 10f64.to_radians());
    let mut mesh = spindle(n);
    mesh.points[0] = (z * 2.0).as_vec3();
    mesh.points[1] = (z * -2.0).as_vec3();
    for (i, point) in mesh.points[2..].iter_mut().enumerate() {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        *point = (((x * angle.cos() + y * angle.sin()) * tilt.sin() + z * tilt.cos()) * 2.0).as_vec3();
    }
    mesh
}

/// A height field of whole numbers over a whole grid, with a wall in each grid plane of x here and there, and copies: ties everywhere.
pub fn integer_field(dice: &mut Dice, n: usize) -> Vec<Corners> {
    let heights: Vec<f32> = (0..(n + 1) * (n + 1)).map(|_| dice.whole(2) as f32).collect();
    let mesh = Mesh::grid(n, n, false, |i, j| GzCoord::new(i as f32, j as f32, heights[j * (n + 1) + i]));
    let mut triangles = mesh.triangles();
    for k in (0..=n).step_by(2) {
        let x = k as f32;
        triangles.push([GzCoord::new(x, 0.0, -3.0), GzCoord::new(x, n as f32, -3.0), GzCoord::new(x, 0.0, 3.0)]);
    }
    for k in (0..triangles.len()).step_by(5) {
        let [a, b, c] = triangles[k];
        triangles.push([c, a, b]);
    }
    triangles
}

/// Two needles that share their long edge: 10 long, 10 / `aspect` thick, in a random frame around `centre`.
pub fn needles(dice: &mut Dice, aspect: f64, centre: DVec3) -> [Corners; 2] {
    let [x, y, _] = dice.frame();
    let at = |s: f64, t: f64| (centre + x * (10.0 * s - 5.0) + y * (t * 10.0 / aspect)).as_vec3();
    let (a, b) = (at(0.0, 0.0), at(1.0, 0.0));
    [[a, b, at(dice.unit(), 1.0)], [b, a, at(dice.unit(), -1.0)]]
}

/// `n` small triangles with all three corners within `size` of a point of the cube [-1, 1]^3.
pub fn soup(dice: &mut Dice, n: usize, size: f64) -> Vec<Corners> {
    (0..n)
        .map(|_| {
            let centre = dice.point(1.0);
            std::array::from_fn(|_| (centre + dice.point(size)).as_vec3())
        })
        .collect()
}

/// A flat quad of side 2 in a random frame around `centre`, in two triangles that share the diagonal.
pub fn quad(dice: &mut Dice, centre: DVec3) -> [Corners; 2] {
    let [x, y, _] = dice.frame();
    let at = |s: f64, t: f64| (centre + x * s + y * t).as_vec3();
    let [a, b, c, d] = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    [[a, b, c], [a, c, d]]
}

/// The twelve triangles of a box between two corners, wound to the outside.
pub fn block(lo: GzCoord, hi: GzCoord) -> Mesh {
    let corner = |k: usize| GzCoord::new([lo.x, hi.x][k & 1], [lo.y, hi.y][k >> 1 & 1], [lo.z, hi.z][k >> 2 & 1]);
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh {
        points: (0..8).map(corner).collect(),
        faces: quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether every edge is that of two triangles, which pass it in opposite directions.
    fn is_closed(mesh: &Mesh) -> bool {
        let passes = |a: usize, b: usize| mesh.faces.iter().filter(|f| (0..3).any(|k| (f[k], f[(k + 1) % 3]) == (a, b))).count();
        mesh.edges().iter().all(|&[a, b]| passes(a, b) + passes(b, a) == 2)
    }

    #[test]
    fn closed_meshes_are_closed() {
        let sphere = jittered_sphere(&mut Dice::new(1), 8, DVec3::splat(100.0));
        assert!(is_closed(&sphere) && sphere.faces.len() == 2 * 8 * 7);
        assert!(is_closed(&cube()) && cube().faces.len() == 192 && cube().points.len() == 98);
        assert!(is_closed(&spindle(7)) && spindle(7).around(0).len() == 7);
        assert!(is_closed(&block(GzCoord::ZERO, GzCoord::ONE)));
        // A vertex within a face of the cube has valence 6.
        let inner = cube().points.iter().position(|&p| p == GzCoord::new(8.0, 0.0, 0.0)).unwrap();
        assert_eq!(cube().around(inner).len(), 6);
    }

    #[test]
    fn blocks_are_wound_to_the_outside() {
        let mesh = block(GzCoord::splat(1.0), GzCoord::splat(3.0));
        for [a, b, c] in mesh.triangles() {
            let out = (a + b + c) / 3.0 - GzCoord::splat(2.0);
            assert!((b - a).cross(c - a).dot(out) > 0.0);
        }
    }

    #[test]
    fn needles_have_their_aspect() {
        let [[a, b, c], _] = needles(&mut Dice::new(3), 1e4, DVec3::ZERO);
        let height = (b - a).cross(c - a).length() / (b - a).length();
        assert!(((b - a).length() - 10.0).abs() < 1e-4 && (height - 1e-3).abs() < 1e-5, "{height}");
    }
}
