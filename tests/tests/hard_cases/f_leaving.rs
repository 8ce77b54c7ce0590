//! F: rays that leave a surface. Each case is settled from the exact hit point, a rational one (`gz_tests::hard::leaving`); `cargo xtask
//! verify rays` runs as many of them as is asked for.

use super::made::{Made, dark, looking, matt, sun};
use super::{shaded, v};
use gz_core::glam::DVec3;
use gz_core::kernel::hit_weights;
use gz_core::{GzColor, GzCoord, GzRay, LeavePolicy, leave_surface, side_of};
use gz_shade::{Falloff, GzLight, Interpolate, LightKind, Material, MaterialKind, Sight};
use gz_tests::hard::leaving::{Label, Outcome, Wrong, run};
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::{buffer, settled};

/// Runs a label; the exact way is right in all cases, and undecided in none but those of F5.
fn exact(label: Label, count: u64) -> Outcome {
    let outcome = run(label, label as u64, count);
    let Outcome { cases, blocked, undecided, wrong, .. } = outcome;
    println!("{label:?}: {cases} cases, {blocked} blocked, {undecided} undecided, wrong by policy {wrong:?}");
    assert!(cases == count && outcome.is_clean(), "{outcome:?}");
    assert!(label == Label::F5 || undecided == 0);
    outcome
}

/// What a policy got wrong.
fn by(outcome: &Outcome, policy: LeavePolicy) -> Wrong {
    let at = LeavePolicy::ALL.iter().position(|p| *p == policy).expect("it is one of them");
    outcome.wrong[at]
}

#[test]
fn f01_flat_quads() {
    let outcome = exact(Label::F1, 6000);
    // The paper's stipple: half of all rays start behind the surface.
    assert!(by(&outcome, LeavePolicy::Bare).acne > 2000 && by(&outcome, LeavePolicy::USUAL_EPSILON).acne > 500);
    assert_eq!(by(&outcome, LeavePolicy::WaechterBinder).acne, 0);
}

#[test]
fn f02_near_the_diagonal() {
    let outcome = exact(Label::F2, 6000);
    // To leave out the triangle left is not enough: the other half of the quad is not it.
    assert!(by(&outcome, LeavePolicy::Identity).acne > 100);
    assert!(by(&outcome, LeavePolicy::Identity).acne < by(&outcome, LeavePolicy::Bare).acne);
}

#[test]
fn f03_convex_fold() {
    let outcome = exact(Label::F3, 6000);
    assert_eq!(outcome.blocked, 0, "nothing rises over a convex fold");
    assert!(by(&outcome, LeavePolicy::Identity).acne > 100);
}

#[test]
fn f04_inside_a_box_near_an_edge() {
    let outcome = exact(Label::F4, 6000);
    for policy in [LeavePolicy::Identity, LeavePolicy::WaechterBinder, LeavePolicy::ErrorBound] {
        let Wrong { acne, leaks } = by(&outcome, policy);
        assert!(acne > 0 && leaks > 0, "{policy:?} slips through walls and meets them at once");
    }
}

#[test]
fn f05_exactly_on_an_edge_or_corner() {
    let outcome = exact(Label::F5, 4000);
    // From the very edge a ray may go out past the neighbouring wall, which it meets when it starts a few roundings within.
    assert!(outcome.undecided > 0 && outcome.undecided < outcome.cases / 20, "{outcome:?}");
}

#[test]
fn f06_thin_gaps() {
    let outcome = exact(Label::F6, 6000);
    // What is moved by more than the gap is beyond the plate.
    for policy in [LeavePolicy::USUAL_EPSILON, LeavePolicy::WaechterBinder, LeavePolicy::ErrorBound] {
        assert!(by(&outcome, policy).leaks > 300, "{policy:?}");
    }
}

#[test]
fn f07_resting_on_the_floor() {
    // A block stands on the floor, coplanar with it where they touch: under it and right beside it, on the far side from the light, it is
    // dark.
    let floor =
        [[v(-9.0, -9.0, 0.0), v(9.0, -9.0, 0.0), v(9.0, 9.0, 0.0)], [v(-9.0, -9.0, 0.0), v(9.0, 9.0, 0.0), v(-9.0, 9.0, 0.0)]];
    let block = meshes::block(v(-1.0, -1.0, 0.0), v(1.0, 1.0, 2.0));
    let triangles: Vec<[GzCoord; 3]> = floor.into_iter().chain(block.triangles()).collect();
    let to_light = v(-1.0, 0.1, 1.0);
    let (mut rays, mut dark) = (Vec::new(), Vec::new());
    for (k, corners) in floor.iter().enumerate() {
        for i in 0..400 {
            let x = f64::from(i) * 0.015 - 2.5;
            let beside = [0.0, 1e-7, -1e-7, 1e-12][i as usize % 4];
            let at = DVec3::new(x + beside, if k == 0 { x.min(0.9) - 1.2 } else { x.max(-0.9) + 1.2 }.clamp(-0.9, 0.9), 9.0);
            let down = GzRay::from_f64(at, GzCoord::NEG_Z);
            if !gz_core::kernel::is_hit(&down, corners) {
                continue;
            }
            let origin = leave_surface(corners, hit_weights(&down, corners), to_light).expect("the light is above the floor");
            rays.push(GzRay::from_f64(origin, to_light));
            dark.push(at.x);
        }
    }
    // The contact edge itself, to the last roundings.
    for x in [1.0, 1.0f64.next_up(), 1.0 + 1e-15, 1.0 - 1e-15, -1.0, (-1.0f64).next_down()] {
        let down = GzRay::from_f64(DVec3::new(x, 0.5, 9.0), GzCoord::NEG_Z);
        let tri = floor.iter().find(|corners| gz_core::kernel::is_hit(&down, corners)).expect("it is over the floor");
        rays.push(GzRay::from_f64(leave_surface(tri, hit_weights(&down, tri), to_light).expect("it is above"), to_light));
        dark.push(x);
    }
    let hits = settled("F7", &buffer(triangles), &rays);
    assert!(rays.len() > 300);
    for (hit, x) in hits.iter().zip(&dark) {
        // The shadow reaches from the block's left edge to two units beyond its right one. The last roundings of its left edge are light's
        // or the block's as the ray has it.
        let within = *x > -1.0 + 1e-9 && *x < 2.99;
        assert!(hit.is_hit() || !within, "light under the block at {x}");
        assert!(!hit.is_hit() || *x > -1.0 - 1e-9, "shadow before the block at {x}");
    }
}

#[test]
fn f08_grazing_light() {
    let outcome = exact(Label::F8, 6000);
    assert_eq!(outcome.blocked, 0, "a floor does not shadow itself");
    assert!(by(&outcome, LeavePolicy::Bare).acne > 500);
    // And in a picture: no stipple.
    let mut made = Made::default();
    let floor = made.material(matt());
    made.wall(0.0, 9.0, floor);
    made.lights = vec![sun([1.0, 0.37, 1e-4])];
    let frame = shaded("F8", &made);
    assert!(frame.colors.iter().all(|&color| color == frame.colors[0]) && frame.colors[0].x > 0.0);
}

#[test]
fn f09_light_behind_by_one_step() {
    // Directions on either side of a plane, one step of f32 apart: the side is that of exact arithmetic, whatever the cosine rounds to.
    let mut dice = Dice::new(9);
    let mut told = [0; 3];
    for _ in 0..400 {
        let corners: [GzCoord; 3] = std::array::from_fn(|_| dice.whole_point(9));
        let edge = corners[1] - corners[0];
        let (side_on, k) = (side_of(&corners, edge), dice.below(3));
        assert_eq!(side_on, 0, "an edge lies in the plane");
        for step in [-1, 0, 1] {
            let mut direction = edge;
            direction[k] = match step {
                1 => direction[k].next_up(),
                -1 => direction[k].next_down(),
                _ => direction[k],
            };
            let side = side_of(&corners, direction);
            told[(side + 1) as usize] += 1;
            let truth = gz_tests::truth::side(&corners.map(|p| p.to_array()), direction.to_array());
            assert_eq!(i32::from(side), truth);
            let origin = leave_surface(&corners, [0.3, 0.3, 0.4], direction);
            assert_eq!(origin.is_none(), side == 0);
            if let Some(origin) = origin {
                // It starts on that side, so it does not meet the triangle.
                let ray = GzRay::from_f64(origin, direction);
                assert!(!gz_core::kernel::is_hit(&ray, &corners));
            }
        }
    }
    assert!(told.iter().all(|&n| n > 100), "{told:?}");
    // In a picture: a light in the plane or behind it casts no ray, one step above it one from the lit side.
    for (z, lit) in [(0.0, false), (-1e-45, false), (f64::from(f32::from_bits(1)), true)] {
        let mut made = Made::default();
        let floor = made.material(Material { ks: GzColor::ONE, power: 0.0, ..matt() });
        made.wall(0.0, 9.0, floor);
        made.lights = vec![GzLight { kind: LightKind::Directional(DVec3::new(1.0, 0.0, z)), color: GzColor::ONE }];
        let frame = shaded("F9", &made);
        assert_eq!((frame.stats.shadow_rays > 0, frame.stats.absorbed), (lit, 0), "{z:e}");
        let sights = made.explain(8, 8)[0].lights[0].sight;
        assert_eq!(matches!(sights, Sight::Behind), !lit);
    }
}

#[test]
fn f10_shading_normal_that_disagrees() {
    // Corner normals lean so far that the mirror of the direction at them goes below the surface: it is mirrored at the plane instead, and
    // counted. That is no matter of precision, so no offset hides it.
    let mut made = Made { background: gz_shade::Background::Plain(GzColor::ONE), ..Made::default() };
    let mirror = made.material(Material { interpolate: Interpolate::Phong, ..dark(MaterialKind::Mirror { ior: None }) });
    made.wall(0.0, 9.0, mirror);
    for tri in &mut made.tris {
        tri.normals = [v(0.99, 0.0, 0.14).normalize(); 3];
    }
    let frame = shaded("F10", &made);
    assert!(frame.stats.below_surface > 0 && frame.stats.mirror_rays > 0 && frame.stats.nan_pixels == 0);
    let scene = made.scene(None);
    for (i, j) in [(0, 0), (8, 8), (15, 3), (3, 15)] {
        let nodes = made.explain(i, j);
        for node in nodes.iter().filter(|node| node.parent.is_some()) {
            let parent = &nodes[node.parent.unwrap_or_default()];
            let corners = scene.tris.position(parent.hit.tri);
            assert_eq!(side_of(corners, node.ray.direction), -side_of(corners, parent.ray.direction));
        }
    }
}

#[test]
fn f11_corner_of_mirrors() {
    let mut made = Made {
        background: gz_shade::Background::Plain(GzColor::ONE),
        camera: looking([3.0, 2.5, 2.0], [0.3; 3], 20.0),
        ..Made::default()
    };
    made.rules.depth = 16;
    let mirror = made.material(dark(MaterialKind::Mirror { ior: None }));
    let w = 50.0;
    made.quad([[0.0, 0.0, 0.0], [w, 0.0, 0.0], [w, 0.0, w], [0.0, 0.0, w]], [0.0, 1.0, 0.0], mirror);
    made.quad([[0.0, 0.0, 0.0], [0.0, w, 0.0], [0.0, w, w], [0.0, 0.0, w]], [1.0, 0.0, 0.0], mirror);
    made.quad([[0.0, 0.0, 0.0], [w, 0.0, 0.0], [w, w, 0.0], [0.0, w, 0.0]], [0.0, 0.0, 1.0], mirror);
    let frame = shaded("F11", &made);
    // All energy comes back, and every ray that met three mirrors returns parallel to itself.
    assert!(frame.colors.iter().all(|&color| color == GzColor::ONE) && frame.stats.depth_cuts == 0);
    let mut back = 0;
    for (i, j) in (0..16).flat_map(|i| (0..16).map(move |j| (i, j))) {
        let nodes = made.explain(i, j);
        assert!(nodes.len() <= 4 && !nodes[nodes.len() - 1].hit.is_hit());
        if nodes.len() == 4 {
            assert!((nodes[0].ray.direction + nodes[3].ray.direction).length() < 1e-6);
            back += 1;
        }
    }
    assert!(back > 200, "{back} of 256");
}

#[test]
fn f12_coordinates_around_zero() {
    let outcome = exact(Label::F12, 6000);
    assert_eq!(outcome.blocked, 0);
    assert!(by(&outcome, LeavePolicy::Bare).acne > 1000);
}

#[test]
fn f13_lights_on_and_between_triangles() {
    let plate = |z: f32, r: f32| [[v(-r, -r, z), v(r, -r, z), v(r, r, z)], [v(-r, -r, z), v(r, r, z), v(-r, r, z)]];
    let gap = 1e-3;
    let triangles = [plate(0.0, 2.0), plate(gap, 5.0)].concat();
    let lamp = |x: f64, y: f64, z: f64| GzLight {
        kind: LightKind::Point { position: DVec3::new(x, y, z), falloff: Falloff::NONE },
        color: GzColor::ONE,
    };
    let corners = triangles[0];
    let mut dice = Dice::new(13);
    let (mut rays, mut blocked) = (Vec::new(), Vec::new());
    for _ in 0..300 {
        let [wa, wb, wc] = dice.weights();
        let point = corners[0].as_dvec3() * wa + corners[1].as_dvec3() * wb + corners[2].as_dvec3() * wc;
        let (x, y) = (2.0 * dice.unit() - 1.0, 2.0 * dice.unit() - 1.0);
        // Within the gap, on the plate above, a hair below and beyond it.
        let gap = f64::from(gap);
        for (z, dark) in [(gap / 2.0, false), (gap, false), (gap * (1.0 - 1e-6), false), (gap * 1.001, true), (1.0, true)] {
            let arrival = lamp(x, y, z).arrive(point);
            let origin = leave_surface(&corners, [wa, wb, wc], arrival.direction).expect("the lamp is above");
            rays.push(GzRay { tmax: arrival.tmax, ..GzRay::from_f64(origin, arrival.direction) });
            blocked.push(dark);
        }
    }
    let hits = settled("F13", &buffer(triangles), &rays);
    for ((ray, hit), blocked) in rays.iter().zip(&hits).zip(&blocked) {
        assert_eq!(hit.is_hit(), *blocked, "{ray:?}");
    }
}

#[test]
fn f14_the_source_is_never_met() {
    // Of all the other cases: from a point strictly on one side of its plane, a flat triangle is behind the ray.
    for label in Label::ALL {
        let outcome = run(label, 1000 + label as u64, 500);
        assert!(outcome.cases == 500 && outcome.is_clean(), "{label:?}: {outcome:?}");
    }
}
