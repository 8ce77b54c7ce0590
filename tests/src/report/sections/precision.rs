//! Shading in f32 against the same in f64.

use crate::bench::timing::{median, take_turns};
use crate::cells;
use crate::model::{placed, primary_hits, shot_by, sized};
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_bsp::BspTree;
use gz_core::glam::{DVec3, Vec3};
use gz_core::kernel::hit_weights;
use gz_shade::Scene;
use std::ops::{Add, Mul, Sub};

const COLUMNS: [Column; 6] = [
    Column::new("shading", "local shading", "", Kind::Label),
    Column::new("rmse", "RMSE, linear", "", Kind::Figure),
    Column::new("max", "greatest error, linear", "", Kind::Figure),
    Column::new("bytes", "channels another byte", "%", Kind::Figure),
    Column::new("ns_per_hit", "time", "ns/hit", Kind::Time),
    Column::new("saved", "time saved", "%", Kind::Time),
];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "precision",
    chapter: Chapter::Model,
    title: "Shading in f32 against f64",
    how: "The shading equation of the scene <code>plain</code> (interpolated normals, two lights, highlights) on its primary hits, written \
          once and run in f32 and in f64, and the product's own, which keeps points and normals in f64 and colours in f32. Against f64; \
          linear values, 1 for full intensity. Hits are exact in all of them. Times, in a run of their own, are of the equation alone.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| Ok(["in f32", "the product's", "in f64"].map(str::to_owned).to_vec()),
    measure,
    says,
};

/// A vector of three numbers of some precision.
trait Vector: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<<Self as Vector>::Scalar, Output = Self> {
    /// Its numbers.
    type Scalar: Copy + PartialOrd + Mul<Output = Self::Scalar>;
    const ZERO: Self::Scalar;
    const ONE: Self::Scalar;
    const TWO: Self::Scalar;
    const MINUS: Self::Scalar;
    fn from_f64(v: DVec3) -> Self;
    fn scalar(x: f64) -> Self::Scalar;
    fn along(self, other: Self) -> Self::Scalar;
    /// Each number times that of the other.
    fn times(self, other: Self) -> Self;
    fn unit(self) -> Self;
    fn to_f64(self) -> [f64; 3];
}

impl Vector for Vec3 {
    type Scalar = f32;
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;
    const TWO: f32 = 2.0;
    const MINUS: f32 = -1.0;
    fn from_f64(v: DVec3) -> Self {
        v.as_vec3()
    }
    fn scalar(x: f64) -> f32 {
        x as f32
    }
    fn along(self, other: Self) -> f32 {
        self.dot(other)
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn unit(self) -> Self {
        self.normalize_or_zero()
    }
    fn to_f64(self) -> [f64; 3] {
        self.to_array().map(f64::from)
    }
}

impl Vector for DVec3 {
    type Scalar = f64;
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    const TWO: f64 = 2.0;
    const MINUS: f64 = -1.0;
    fn from_f64(v: DVec3) -> Self {
        v
    }
    fn scalar(x: f64) -> f64 {
        x
    }
    fn along(self, other: Self) -> f64 {
        self.dot(other)
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn unit(self) -> Self {
        self.normalize_or_zero()
    }
    fn to_f64(self) -> [f64; 3] {
        self.to_array()
    }
}

/// A hit as the shading equation takes it.
struct Site<V: Vector> {
    normals: [V; 3],
    weights: [V::Scalar; 3],
    /// Against the ray.
    eye: V,
    /// Which lights are on the viewer's side of the triangle.
    lit: Vec<bool>,
    ambient: V,
    diffuse: V,
    specular: V,
    power: u32,
}

/// A light: where to, and its colour.
struct Lamp<V> {
    direction: V,
    color: V,
}

/// ka la + sum of le (kd N.L + ks (R.E)^power), two-sided as the product has it.
fn shade<V: Vector>(site: &Site<V>, lamps: &[Lamp<V>]) -> V {
    let [a, b, c] = site.normals;
    let n = (a * site.weights[0] + b * site.weights[1] + c * site.weights[2]).unit();
    let mut sum = site.ambient;
    for (lamp, lit) in lamps.iter().zip(&site.lit) {
        let (nl, ne) = (n.along(lamp.direction), n.along(site.eye));
        let same_side = (nl >= V::ZERO && ne >= V::ZERO) || (nl <= V::ZERO && ne <= V::ZERO);
        if !*lit || !same_side {
            continue;
        }
        // The reflected direction is the same for both signs of the normal.
        let r = n * (V::TWO * nl) - lamp.direction;
        let re = r.along(site.eye);
        let clamped = if re > V::ONE {
            V::ONE
        } else if re > V::ZERO {
            re
        } else {
            V::ZERO
        };
        let (mut highlight, mut square, mut bits) = (V::ONE, clamped, site.power);
        while bits != 0 {
            if bits & 1 == 1 {
                highlight = highlight * square;
            }
            square = square * square;
            bits >>= 1;
        }
        let nl = if nl < V::ZERO { nl * V::MINUS } else { nl };
        sum = sum + lamp.color.times(site.diffuse * nl + site.specular * highlight);
    }
    sum
}

fn sites<V: Vector>(scene: &Scene) -> Vec<Site<V>> {
    let of = |(ray, hit): (gz_core::GzRay, gz_core::Hit)| {
        let (corners, material) = (scene.tris.position(hit.tri), scene.material(hit.tri));
        let face = scene.tris.face_normal(hit.tri);
        let normals = scene.tris.normals(hit.tri).map_or([face; 3], |normals| normals.map(|n| n.as_dvec3()));
        let eye = -ray.direction.as_dvec3();
        let lit = scene.lights.iter().map(|light| light.arrive(DVec3::ZERO).direction.as_dvec3().dot(face) * eye.dot(face) > 0.0);
        Site {
            normals: normals.map(V::from_f64),
            weights: hit_weights(&ray, corners).map(V::scalar),
            eye: V::from_f64(eye),
            lit: lit.collect(),
            ambient: V::from_f64((material.ka * scene.ambient).as_dvec3()),
            diffuse: V::from_f64(material.kd.as_dvec3()),
            specular: V::from_f64(material.ks.as_dvec3()),
            power: material.power as u32,
        }
    };
    primary_hits(scene).filter(|(_, hit)| hit.is_hit()).map(of).collect()
}

fn lamps<V: Vector>(scene: &Scene) -> Vec<Lamp<V>> {
    let of = |light: &gz_shade::GzLight| Lamp {
        direction: V::from_f64(light.arrive(DVec3::ZERO).direction.as_dvec3()),
        color: V::from_f64(light.color.as_dvec3()),
    };
    scene.lights.iter().map(of).collect()
}

fn all<V: Vector>(sites: &[Site<V>], lamps: &[Lamp<V>]) -> Vec<[f64; 3]> {
    sites.iter().map(|site| shade(site, lamps).to_f64()).collect()
}

/// RMSE, greatest error, and the share of channels that are written as another byte.
fn errors(found: &[[f64; 3]], truth: &[[f64; 3]]) -> (f64, f64, f64) {
    let pairs = || found.iter().flatten().zip(truth.iter().flatten());
    let n = pairs().count().max(1) as f64;
    let squares: f64 = pairs().map(|(a, b)| (a - b) * (a - b)).sum();
    let greatest = pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let byte = |x: f64| gz_shade::color::srgb_byte(x as f32);
    let others = pairs().filter(|(a, b)| byte(**a) != byte(**b)).count();
    ((squares / n).sqrt(), greatest, 100.0 * others as f64 / n)
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let (width, height) = run.size((16, 12), (320, 240), (1280, 960));
    let (scene, needs) = placed("plain", &sized(width, height))?;
    // Errors.
    let (singles, doubles) = (sites::<Vec3>(&scene), sites::<DVec3>(&scene));
    let (lamps32, lamps64) = (lamps::<Vec3>(&scene), lamps::<DVec3>(&scene));
    let truth = all(&doubles, &lamps64);
    let in_f32 = errors(&all(&singles, &lamps32), &truth);
    let frame = shot_by(&scene, needs, &BspTree::build(&scene.tris)).frame;
    let hits = primary_hits(&scene).map(|(_, hit)| hit.is_hit());
    let product: Vec<[f64; 3]> =
        frame.colors.iter().zip(hits).filter(|(_, hit)| *hit).map(|(color, _)| color.to_array().map(f64::from)).collect();
    let product = errors(&product, &truth);
    // Times.
    let mut turns: Vec<Box<dyn FnMut() + '_>> = vec![
        Box::new(|| drop(std::hint::black_box(all(&singles, &lamps32)))),
        Box::new(|| drop(std::hint::black_box(all(&doubles, &lamps64)))),
    ];
    let times = take_turns(run.size(1, 9, 31), &mut turns);
    drop(turns);
    let n = truth.len() as u64;
    let ns = |k: usize| median(&times[k]) * 1e9 / n.max(1) as f64;
    let settings = format!("{}; {width}x{height}, {} rounds, 1 thread", run.mode.name(), times[0].len());
    let row = |name: &str, (rmse, max, bytes): (f64, f64, f64), ns: Option<f64>, saved: Option<f64>| Row {
        cells: cells![name, rmse, max, bytes, ns, saved],
        n,
        settings: settings.clone(),
    };
    let rows = vec![
        row("in f32", in_f32, Some(ns(0)), Some(100.0 * (1.0 - ns(0) / ns(1)))),
        row("the product's", product, None, None),
        row("in f64", (0.0, 0.0, 0.0), Some(ns(1)), Some(0.0)),
    ];
    Ok(Measured { rows, pictures: Vec::new() })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let (Some(single), Some(product)) = (table.row("shading", "in f32"), table.row("shading", "the product's")) else {
        return String::new();
    };
    let of = |row: usize, name: &str| table.number(row, name).unwrap_or(f64::NAN);
    let so = if of(single, "bytes") < 1.0 && of(product, "bytes") < 1.0 {
        "Neither is seen: it is hits, not colours, that need more digits."
    } else {
        "That may be seen."
    };
    format!(
        "Shading in f32 is off by {} at most, the product's by {}, where a step of a byte is about 0.004; {} and {} of the bytes written \
         change. {so}",
        numbers.say("f32 max", of(single, "max"), "max", ""),
        numbers.say("product max", of(product, "max"), "max", ""),
        numbers.say("f32", of(single, "bytes"), "bytes", " %"),
        numbers.say("product", of(product, "bytes"), "bytes", " %"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::run::Mode;

    #[test]
    fn the_equation_here_is_the_products() {
        let rows = measure(&Run::new(Mode::Tiny, 1, false)).unwrap().rows;
        let table = Table { columns: COLUMNS.to_vec(), rows };
        for row in 0..2 {
            assert!(table.number(row, "max").unwrap() < 1e-4, "{:?}", table.rows[row]);
        }
        assert!(table.rows[0].n > 50);
    }
}
