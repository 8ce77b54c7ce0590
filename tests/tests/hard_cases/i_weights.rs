//! I: what varies over a triangle.

use super::made::{Made, matt, sun};
use super::{shaded, v};
use gz_core::glam::DVec3;
use gz_core::kernel::hit_weights;
use gz_core::{GzColor, GzCoord, GzRay, GzTextureIndex};
use gz_shade::{ImageTexture, Interpolate, Texture, TextureLookup};
use gz_tests::folder::Folder;
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::{buffer, settled, truth_ray, truth_triangle};
use gz_tests::truth::Meeting;

#[test]
fn i01_weights_at_a_corner_and_within() {
    let mut dice = Dice::new(1);
    // Whole numbers, so that the ray meets the corner exactly: its weights are 1, 0 and 0, in f64 to the last bits.
    for _ in 0..300 {
        let corners: [GzCoord; 3] = std::array::from_fn(|_| dice.whole_point(9));
        let origin = dice.whole_point(9) + v(0.0, 0.0, 40.0);
        for k in 0..3 {
            let ray = GzRay::new(origin, corners[k] - origin);
            let hit = settled("I1", &buffer([corners]), &[ray])[0];
            if hit.is_hit() {
                let mut expected = [0.0; 3];
                expected[k] = 1.0;
                assert_eq!([hit.u, hit.v], [expected[1] as f32, expected[2] as f32]);
                let weights = hit_weights(&ray, &corners);
                assert!(weights.iter().zip(expected).all(|(w, e)| (w - e).abs() <= 4.0 * f64::EPSILON), "{weights:?}");
                // What they interpolate is the corner's own, to the bit.
                let uv = [0.1f32, 0.7, 0.3].map(f64::from);
                let at = (0..3).map(|k| weights[k] * uv[k]).sum::<f64>() as f32;
                assert_eq!(f64::from(at), uv[k]);
            }
        }
    }
    // Anywhere: within [0, 1], and 1 in sum but for what cutting to [0, 1] takes, which is no more than a weight may be off.
    let (triangles, mut hits) = (meshes::soup(&mut dice, 200, 0.5), 0);
    for k in 0..4000 {
        let corners = dice.pick(&triangles);
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let [wa, wb, wc] = [dice.weights(), [0.5, 0.5, 0.0], [1e-9, 1.0 - 1e-9, 0.0]][k % 3];
        let origin = (dice.direction() * 3.0).as_vec3();
        let ray = GzRay::new(origin, (a * wa + b * wb + c * wc - origin.as_dvec3()).as_vec3());
        if !gz_core::kernel::is_hit(&ray, &corners) {
            continue; // aimed at an edge, it may miss: weights are then of no meaning
        }
        hits += 1;
        let weights = hit_weights(&ray, &corners);
        let sum: f64 = weights.iter().sum();
        assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)) && (sum - 1.0).abs() <= 2f64.powi(-36), "{weights:?}");
    }
    assert!(hits > 2000, "{hits}");
}

#[test]
fn i02_odd_texture_coordinates() {
    let one = |lookup| Texture::Image(ImageTexture { width: 1, height: 1, texels: vec![GzColor::new(0.25, 0.5, 0.75)], lookup });
    for lookup in [TextureLookup::Repeat, TextureLookup::Homework, TextureLookup::PaperEdge] {
        for (u, v) in [(1.0, 1.0), (-0.0, 0.5), (1e9, -1e9), (f32::NAN, 0.5), (f32::INFINITY, f32::NEG_INFINITY), (0.5, 1e-45)] {
            let color = one(lookup).color(GzTextureIndex::new(u, v));
            let expected = GzColor::new(0.25, 0.5, 0.75);
            assert!(
                color.is_finite() && (color == expected || lookup == TextureLookup::PaperEdge),
                "{lookup:?} {u} {v}: {color}"
            );
        }
    }
    // A picture without pixels is refused with its name.
    let folder = Folder::new("i02");
    for (name, text) in [("a.ppm", "P6\n0 0\n255\n"), ("b.ppm", "P6\n1 0\n255\n"), ("c.ppm", "P6\n0 7\n255\n")] {
        let path = folder.write(name, text);
        let error = gz_app::load::picture::texture(&path, TextureLookup::Repeat, true, false).unwrap_err();
        assert!(error.to_string().starts_with(&format!("{}: ", path.display())), "{error}");
    }
}

#[test]
fn i03_weights_on_needles() {
    let mut dice = Dice::new(3);
    let (mut worst_f64, mut worst_stored, mut n) = (0f64, 0f64, 0);
    for _ in 0..200 {
        let corners = meshes::needles(&mut dice, 1e6, DVec3::ZERO)[0];
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let [wa, wb, wc] = dice.weights();
        let aim = a * wa + b * wb + c * wc;
        let ray = GzRay::from_f64(aim + dice.direction() * 4.0, GzCoord::ZERO);
        let ray = GzRay { direction: (aim - ray.origin).as_vec3(), ..ray };
        let Some(truth) = truth_ray(&ray).line().and_then(|line| Meeting::of(&line, &truth_triangle(&corners))) else { continue };
        let hit = settled("I3", &buffer([corners]), &[ray])[0];
        let weights = hit_weights(&ray, &corners);
        let off = |weight: f64, truth: &gz_tests::truth::Fraction| truth.minus(weight).to_f64().abs();
        worst_f64 = worst_f64.max(off(weights[1], &truth.u)).max(off(weights[2], &truth.v));
        worst_stored = worst_stored.max(off(hit.u.into(), &truth.u)).max(off(hit.v.into(), &truth.v));
        n += 1;
    }
    println!("I3: {n} needles, weights off by at most {worst_f64:e} in f64 and {worst_stored:e} as stored");
    // 2^-36 is what is promised for shading; f32 rounds to 2^-25 at 1.
    assert!(n > 100 && worst_f64 < 2f64.powi(-36) && worst_stored <= 2f64.powi(-24));
}

#[test]
fn i04_opposite_normals() {
    // Along the line where the sum of corner normals vanishes, the face's own normal stands in.
    let mut made = Made { lights: vec![sun([0.0, 0.0, 1.0])], ..Made::default() };
    let phong = made.material(gz_shade::Material { interpolate: Interpolate::Phong, ..matt() });
    made.wall(0.0, 9.0, phong);
    let flat = shaded("I4, flat", &made).colors;
    for tri in &mut made.tris {
        tri.normals = [GzCoord::X, GzCoord::NEG_X, GzCoord::X];
    }
    let frame = shaded("I4", &made);
    assert!(frame.stats.nan_pixels == 0 && frame.colors.iter().all(|color| color.is_finite()));
    for tri in &mut made.tris {
        tri.normals = [GzCoord::ZERO; 3];
    }
    assert_eq!(shaded("I4, none", &made).colors, flat);
}
