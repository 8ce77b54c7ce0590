//! G: glass.

use super::made::{Made, dark, heaviest_leaf, looking};
use super::shaded;
use gz_core::glam::DVec3;
use gz_core::{GzColor, GzCoord, LeavePolicy};
use gz_shade::optics::{fresnel, reflectance, schlick};
use gz_shade::refraction::{cos_transmitted, refract};
use gz_shade::{Background, FrameStats, Fresnel, Material, MaterialKind};
use gz_tests::folder::Folder;
use gz_tests::hard::Dice;
use gz_tests::hard::leaving::{Label, Wrong, run};

fn glass(ior: f32) -> Material {
    dark(MaterialKind::Glass { ior })
}

/// A white world with one material of glass.
fn white_world(ior: f32) -> Made {
    let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
    made.rules.depth = 12;
    made.material(glass(ior));
    made
}

#[test]
fn g01_index_of_one() {
    let mut dice = Dice::new(1);
    for _ in 0..1000 {
        let (d, n) = (dice.direction(), dice.direction());
        let n = if d.dot(n) > 0.0 { -n } else { n };
        assert_eq!(refract(d, n, 1.0), Some(d), "bit for bit");
        for rule in [Fresnel::Exact, Fresnel::Schlick] {
            assert_eq!(reflectance(rule, -d.dot(n), 1.0), 0.0);
        }
    }
    let mut made = white_world(1.0);
    made.background = Background::Gradient { bottom: GzColor::ZERO, top: GzColor::new(0.3, 0.6, 0.9) };
    let without = made.shade().colors;
    made.block([-1.0; 3], [1.0; 3], false, 0);
    let frame = shaded("G1", &made);
    assert!(frame.colors == without && frame.stats.glass_rays > 0);
}

#[test]
fn g02_index_below_one() {
    // Swapped sides: the way in at 1 / n is the way out at n, in direction and in reflected share.
    let mut dice = Dice::new(2);
    for eta in [0.66, 1.0 / 1.33] {
        for _ in 0..500 {
            let (d, n) = (dice.direction(), dice.direction());
            let n = if d.dot(n) > 0.0 { -n } else { n };
            let Some(through) = refract(d, n, eta) else {
                assert_eq!(fresnel(-d.dot(n), eta), 1.0);
                continue;
            };
            let back = refract(-through, -n, 1.0 / eta).expect("the way back is open");
            assert!((back + d).length() < 1e-7, "{back} {d}");
            assert!((fresnel(-d.dot(n), eta) - fresnel(-through.dot(n), 1.0 / eta)).abs() < 1e-7);
        }
    }
    // A bubble in a picture: from outside it reflects totally beyond its critical angle.
    let mut made = white_world(0.66);
    made.block([-1.0; 3], [1.0; 3], false, 0);
    made.camera = looking([2.0, 1.5, 4.0], [0.0; 3], 30.0);
    let frame = shaded("G2", &made);
    assert!(frame.stats.total_reflections > 0 && frame.stats.nan_pixels == 0);
}

#[test]
fn g03_indices_that_are_errors() {
    let folder = Folder::new("g03");
    let message = |ior: &str| {
        let text = format!(
            "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n[[material]]\nname = \"m\"\nkind = \"glass\"\nior = {ior}\n"
        );
        let path = folder.write("s.toml", text);
        let error = gz_app::load::scene(&path, &gz_app::load::Overrides::NONE).unwrap_err();
        assert_eq!((error.line, error.io), (Some(7), false), "{error}");
        error.message
    };
    for (ior, expected) in [
        ("0", "ior must be 0.01 to 100, not 0"),
        ("-1.5", "ior must be 0.01 to 100, not -1.5"),
        ("1e9", "ior must be 0.01 to 100, not 1000000000"),
    ] {
        assert_eq!(message(ior), expected);
    }
    for ior in ["nan", "inf", "-inf", "1e39"] {
        assert!(message(ior).contains("not a finite number"), "{ior}: {}", message(ior));
    }
    for ior in ["0", "-2", "nan", "inf", "1e9"] {
        folder.write("m.mtl", format!("newmtl m\nNi {ior}\n"));
        let path = folder.write("t.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
        let error = gz_app::load::obj::load(&path).unwrap_err();
        assert!(error.path.ends_with("m.mtl") && error.line == Some(2), "{error}");
    }
}

#[test]
fn g04_cosine_above_one() {
    // Vectors normalised in f32 are longer than 1 as often as not by a rounding; a root of 1 - c^2 is then no number.
    let mut dice = Dice::new(4);
    let (mut above, mut not_a_number) = (0, 0);
    for _ in 0..20_000 {
        let n = dice.direction().as_vec3().normalize();
        let c = n.dot(n);
        above += u32::from(c > 1.0);
        not_a_number += u32::from((1.0 - c * c).sqrt().is_nan());
        let cos = cos_transmitted(f64::from(c), 1.5).expect("along the normal nothing is totally reflected");
        assert!((0.9999..=1.0).contains(&cos));
        assert!(fresnel(f64::from(c), 1.5) > 0.039 && fresnel(f64::from(c), 1.5) < 0.041);
    }
    println!("G4: {above} of 20000 above 1, {not_a_number} plain roots are no number");
    assert!(above > 1000 && not_a_number == above);
}

#[test]
fn g05_critical_angle() {
    let critical = (1.0f64 / 1.5).asin();
    let (mut dice, mut wrong_in_f32, mut asked) = (Dice::new(5), 0, 0);
    for k in 0..2000 {
        let off = 1e-7 * (f64::from(k) / 1000.0 - 1.0);
        if off.abs() < 1e-12 {
            continue;
        }
        let theta = critical + off;
        let d = DVec3::new(theta.sin(), -theta.cos(), 0.0);
        assert_eq!(refract(d, DVec3::Y, 1.5).is_none(), off > 0.0, "{off:e}");
        // The same somewhere in space, with vectors and sums of f32.
        let [x, n, _] = dice.frame();
        let cos = -(x * theta.sin() - n * theta.cos()).as_vec3().dot(n.as_vec3());
        let inside = 1.0 - 2.25 * (1.0 - cos * cos) < 0.0;
        wrong_in_f32 += u32::from(inside != (off > 0.0));
        asked += 1;
    }
    println!("G5: within 1e-7 of the critical angle, f32 tells {wrong_in_f32} of {asked} wrong");
    assert!(wrong_in_f32 > asked / 20);
    // At the angle itself the ray goes on along the surface; k is 0 and not below.
    assert_eq!(cos_transmitted(0.0, 1.0), Some(0.0));
}

#[test]
fn g06_total_reflection_has_no_direction() {
    let d = DVec3::new(0.8, -0.6, 0.0);
    assert_eq!(refract(d, DVec3::Y, 1.5), None);
    // glam's own gives the zero vector, which as a direction of a ray hits nothing, silently.
    assert_eq!(d.refract(DVec3::Y, 1.5), DVec3::ZERO);
    let zero = gz_core::GzRay::new(GzCoord::ZERO, GzCoord::ZERO);
    assert!(!zero.is_valid());
    for (cos, eta) in [(f64::NAN, 1.5), (0.5, f64::NAN)] {
        assert_eq!(cos_transmitted(cos, eta), None);
    }
    // In a picture: a block seen flat from inside reflects totally and loses nothing.
    let mut made = white_world(1.5);
    made.rules.depth = 32;
    made.block([-1.0; 3], [1.0; 3], false, 0);
    made.camera = looking([0.0, 0.0, 0.5], [1.0, 0.02, 0.5], 10.0);
    let frame = shaded("G6", &made);
    assert!(frame.stats.nan_pixels == 0 && frame.stats.absorbed == 0);
}

/// The exact way is right in all cases of a label, and decided in all; the others' wrong answers.
fn exact(label: Label) -> [Wrong; LeavePolicy::ALL.len()] {
    let outcome = run(label, label as u64, 6000);
    println!("{label:?}: {} cases, {} blocked, wrong by policy {:?}", outcome.cases, outcome.blocked, outcome.wrong);
    assert!((outcome.cases, outcome.undecided) == (6000, 0) && outcome.is_clean(), "{outcome:?}");
    assert!(outcome.blocked > 5990, "there is another face");
    outcome.wrong
}

#[test]
fn g07_thin_slab() {
    let wrong = exact(Label::G7);
    assert!(wrong[3].leaks > 1000, "an epsilon of 1e-4 misses the other face of a slab of 1e-5: {wrong:?}");
    // Rays come out parallel to how they went in.
    for thickness in [1e-3, 1e-5] {
        let mut made = white_world(1.5);
        made.block([-4.0, -4.0, 0.0], [4.0, 4.0, thickness], false, 0);
        assert_eq!(shaded("G7", &made).stats.unmatched_exits, 0);
        for (i, j) in [(8, 8), (0, 0), (15, 5), (2, 13)] {
            let nodes = made.explain(i, j);
            let out = heaviest_leaf(&nodes);
            assert!((out.ray.direction - nodes[0].ray.direction).length() < 1e-6 && out.depth == 2, "{thickness}");
        }
    }
}

#[test]
fn g08_thin_slab_far_away() {
    let wrong = exact(Label::G8);
    // 256 steps of f32 at 100 are 2e-3: the slab is skipped almost always.
    assert!(wrong[4].leaks > 5000, "{wrong:?}");
}

#[test]
fn g09_touching_media() {
    // Water in glass: walls that reach into the water, and walls that coincide with it, the water listed first.
    for cavity in [0.75, 0.8] {
        let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
        made.rules.depth = 8;
        let (water, bottle) = (made.material(glass(1.33)), made.material(glass(1.5)));
        made.block([-0.8; 3], [0.8; 3], false, water);
        made.block([-cavity; 3], [cavity; 3], true, bottle);
        made.block([-1.0; 3], [1.0; 3], false, bottle);
        let frame = shaded("G9", &made);
        assert_eq!((frame.stats.unmatched_exits, frame.stats.nan_pixels), (0, 0), "{cavity}");
        let nodes = made.explain(6, 7);
        let path: Vec<_> = nodes.iter().filter(|node| node.factor.x > 0.5).collect();
        let sine = |k: usize| path[k].ray.direction.truncate().length();
        assert!((1.5 * sine(1) - sine(0)).abs() < 1e-6 && (1.33 * sine(2) - sine(0)).abs() < 1e-6, "{cavity}");
    }
}

#[test]
fn g10_camera_inside_glass() {
    let mut made = white_world(1.5);
    made.camera = looking([0.1, 0.0, 0.2], [0.1, 0.0, -1.0], 100.0);
    made.block([-1.0; 3], [1.0; 3], false, 0);
    let frame = shaded("G10", &made);
    assert!(frame.stats.unmatched_exits > 100 && frame.stats.total_reflections > 0 && frame.stats.nan_pixels == 0);
    let nodes = made.explain(9, 9);
    let (inside, outside) = (nodes[0].ray.direction, heaviest_leaf(&nodes).ray.direction);
    // Out of the dense medium: away from the normal, by the triangle's side and not by the shading normal's.
    assert!((outside.truncate().length() / inside.truncate().length() - 1.5).abs() < 1e-5);
}

#[test]
fn g11_schlick_from_the_dense_side() {
    let (mut printed, mut ours, mut from_air, mut weak) = (0f64, 0f64, 0f64, 0f64);
    for k in 0..=10_000 {
        let cos = f64::from(k) / 10_000.0;
        // As the paper prints it, with the cosine on the incoming side, whichever that is.
        let r0 = (0.5f64 / 2.5).powi(2);
        let as_printed = r0 + (1.0 - cos).powi(5) * (1.0 - r0);
        printed = printed.max((as_printed - fresnel(cos, 1.5)).abs());
        ours = ours.max((schlick(cos, 1.5) - fresnel(cos, 1.5)).abs());
        from_air = from_air.max((schlick(cos, 1.0 / 1.5) - fresnel(cos, 1.0 / 1.5)).abs());
        weak = weak.max((schlick(cos, 1.0 / 1.1) - fresnel(cos, 1.0 / 1.1)).abs());
    }
    println!(
        "G11: greatest error: as printed from the dense side {printed:.2}, ours {ours:.3}, from air {from_air:.3}, index 1.1 {weak:.2}"
    );
    assert!(printed > 0.9 && ours < 0.037 && from_air < 0.037 && weak > 0.2 && weak < 0.22);
}

#[test]
fn g12_depth_limit() {
    // What a limit of 3 cuts off a slab before a mirror is a number in the statistics.
    for (depth, most) in [(3, 0.1), (5, 0.95), (16, 1.0)] {
        let mut made = white_world(1.5);
        let mirror = made.material(dark(MaterialKind::Mirror { ior: None }));
        made.block([-4.0, -4.0, 0.0], [4.0, 4.0, 0.5], false, 0).wall(-1.0, 40.0, mirror);
        made.rules.depth = depth;
        let frame = shaded("G12", &made);
        let lacking: f64 = frame.colors.iter().map(|color| 1.0 - f64::from(color.x)).sum();
        let stats = frame.stats;
        let counted = (stats.depth_cut_weight + stats.weak_weight) as f64 * FrameStats::WEIGHT_UNIT;
        assert!((lacking - counted).abs() < 1e-3, "depth {depth}: {lacking} {counted}");
        let middle = frame.colors[8 * 16 + 8].x;
        assert!(middle <= most && stats.depth_cuts > 0, "depth {depth}: {middle}");
    }
}

#[test]
fn g13_at_an_edge_of_the_exit_face() {
    exact(Label::G13);
}
