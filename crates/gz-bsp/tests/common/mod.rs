//! Scenes and rays that look for trouble, from a small generator whose seed is in the test.
#![allow(dead_code, reason = "each test file uses its own part")]

use gz_core::{Attributes, GzCoord, GzRay, GzTri, TriBuffer, TriClass};

pub(crate) struct Lcg(pub(crate) u64);

impl Lcg {
    pub(crate) fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    pub(crate) fn point(&mut self) -> GzCoord {
        GzCoord::from_array(std::array::from_fn(|_| self.unit()))
    }
}

pub(crate) fn buffer(triangles: impl IntoIterator<Item = [GzCoord; 3]>) -> TriBuffer {
    let mut tris = TriBuffer::new();
    for positions in triangles {
        tris.push(&GzTri { positions, ..GzTri::default() }).unwrap();
    }
    tris
}

/// The same triangles, all of glass but every `opaque`th.
pub(crate) fn glazed(tris: &TriBuffer, opaque: usize) -> TriBuffer {
    let mut glazed = TriBuffer::with_attributes(Attributes::ALL, tris.len());
    for (k, &positions) in tris.positions().iter().enumerate() {
        let class = if k % opaque == 0 { TriClass::Opaque } else { TriClass::Glass };
        glazed.push(&GzTri { positions, class, ..GzTri::default() }).unwrap();
    }
    glazed
}

/// Small triangles anywhere in the unit cube.
pub(crate) fn soup(lcg: &mut Lcg, n: usize, size: f32) -> TriBuffer {
    buffer((0..n).map(|_| {
        let centre = lcg.point();
        std::array::from_fn(|_| centre + lcg.point() * size)
    }))
}

/// Two triangles for each cell of an integer grid at integer heights, and a copy of every tenth.
pub(crate) fn grid(lcg: &mut Lcg, n: i32) -> TriBuffer {
    let heights: Vec<f32> = (0..=n).flat_map(|_| (0..=n).map(|_| (lcg.unit() * 3.0).floor()).collect::<Vec<_>>()).collect();
    let at = |x: i32, y: i32| GzCoord::new(x as f32, y as f32, heights[(y * (n + 1) + x) as usize]);
    let mut triangles: Vec<[GzCoord; 3]> = (0..n)
        .flat_map(|y| (0..n).map(move |x| (x, y)))
        .flat_map(|(x, y)| [[at(x, y), at(x + 1, y), at(x, y + 1)], [at(x + 1, y + 1), at(x, y + 1), at(x + 1, y)]])
        .collect();
    let copies: Vec<_> = triangles.iter().step_by(10).copied().collect();
    triangles.extend(copies);
    buffer(triangles)
}

/// Needles from one corner of space to another.
pub(crate) fn slivers(lcg: &mut Lcg, n: usize) -> TriBuffer {
    buffer((0..n).map(|_| {
        let (a, b) = (lcg.point(), lcg.point());
        [a, b, b + lcg.point() * 1e-6]
    }))
}

/// Rays aimed at corners, at edge midpoints, along axes, in the planes of cuts, and anywhere.
pub(crate) fn rays(lcg: &mut Lcg, tris: &TriBuffer, n: usize) -> Vec<GzRay> {
    let bounds = tris.bounds();
    let (centre, size) = (bounds.centre(), bounds.size());
    (0..n)
        .map(|k| {
            let triangle = tris.position((lcg.unit() * tris.len() as f32) as u32 % tris.len() as u32);
            let origin = centre + (lcg.point() - 0.5) * size * 3.0;
            let axis = GzCoord::AXES[k % 3] * if k % 2 == 0 { 1.0 } else { -1.0 };
            match k % 6 {
                0 => GzRay::new(origin, triangle[0] - origin),
                1 => GzRay::new(origin, (triangle[0] + triangle[1]) * 0.5 - origin),
                2 => GzRay::new(triangle[1] - axis * 2.0, axis),
                3 => {
                    // In the plane of the first cut along an axis, straight and tilted.
                    let mut origin = origin;
                    origin[(k + 1) % 3] = centre[(k + 1) % 3];
                    let mut direction = triangle[2] - origin;
                    direction[(k + 1) % 3] = if k % 4 == 0 { 0.0 } else { -0.0 };
                    GzRay::new(origin, direction)
                }
                4 => GzRay { tmin: -1.0, tmax: 0.7, ..GzRay::new(triangle[0], lcg.point() - 0.5) },
                _ => GzRay::new(origin, lcg.point() - 0.5),
            }
        })
        .collect()
}
