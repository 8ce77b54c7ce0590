//! P10 to P13, P16 to P18: surfaces that are closed, left, mirrored and refracted.

use super::inputs::{rays, shots, triangles};
use gz_bsp::BspTree;
use gz_core::glam::DVec3;
use gz_core::kernel::{hit_weights, is_hit};
use gz_core::{GzCoord, GzRay, RayQuery, leave_surface, side_of};
use gz_shade::optics::fresnel;
use gz_shade::reflection::reflect;
use gz_shade::refraction::refract;
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::{buffer, truth_ray, truth_triangle};
use gz_tests::truth::{Fraction, Meeting, plain, plane_t};
use proptest::prelude::*;

/// A jittered sphere from a seed, and rays at its corners, edges and anything.
fn sphere(seed: u64, n: usize, offset: f64, outside: bool) -> (meshes::Mesh, Vec<GzRay>) {
    let mut dice = Dice::new(seed);
    let centre = dice.direction() * offset;
    let mesh = meshes::jittered_sphere(&mut dice, n, centre);
    let edges = mesh.edges();
    let rays = (0..24)
        .map(|k| {
            let origin = if outside { centre + dice.direction() * 15.0 } else { centre + dice.point(0.5) };
            let origin = origin.as_vec3();
            let direction = match k % 3 {
                0 => (centre + dice.point(3.0) - origin.as_dvec3()).as_vec3(),
                1 => mesh.points[dice.below(mesh.points.len())] - origin,
                _ => {
                    let [a, b] = dice.pick(&edges).map(|p| mesh.points[p]);
                    a + (b - a) * dice.between(0.0, 1.0) - origin
                }
            };
            GzRay::new(origin, direction)
        })
        .collect();
    (mesh, rays)
}

fn direction() -> impl Strategy<Value = DVec3> {
    any::<u64>().prop_map(|seed| Dice::new(seed).direction())
}

/// Two unit vectors, the second turned against the first.
fn meeting() -> impl Strategy<Value = (DVec3, DVec3)> {
    (direction(), direction()).prop_map(|(d, n)| (d, if d.dot(n) > 0.0 { -n } else { n }))
}

proptest! {
    #[test]
    fn p10_from_inside_a_closed_mesh_every_ray_hits(seed in any::<u64>(), n in 4usize..12, offset in prop_oneof![Just(0.0), Just(1e2), Just(1e4)]) {
        let (mesh, rays) = sphere(seed, n, offset, false);
        let tris = buffer(mesh.triangles());
        let tree = BspTree::build(&tris);
        for ray in &rays {
            prop_assert!(tree.closest_hit(ray).is_hit() && tree.any_hit(ray), "{:?}", ray);
        }
    }

    #[test]
    fn p11_a_line_crosses_a_closed_mesh_an_even_number_of_times(seed in any::<u64>(), n in 4usize..10) {
        let (mesh, rays) = sphere(seed, n, 0.0, true);
        let triangles: Vec<_> = mesh.triangles().iter().map(truth_triangle).collect();
        let tris = buffer(mesh.triangles());
        let tree = BspTree::build(&tris);
        for ray in &rays {
            // Where the line passes through an edge or a corner, a crossing is not what a triangle says.
            let line = truth_ray(ray).line();
            let Some(line) = line else { continue };
            let exact = plain::hits(&line, &triangles);
            let on_an_edge = |m: &Meeting| m.u.sign() == 0 || m.v.sign() == 0 || m.u == one_less(&m.v);
            if exact.iter().any(|(_, m)| on_an_edge(m)) {
                continue;
            }
            let (mut crossings, mut rest) = (0, *ray);
            loop {
                let hit = tree.closest_hit(&rest);
                if !hit.is_hit() {
                    break;
                }
                crossings += 1;
                rest.tmin = hit.t.next_up();
            }
            prop_assert_eq!(exact.len() % 2, 0);
            // Of crossings within one step of f32 only the first counts here.
            let (mut expected, mut behind) = (0, f64::NEG_INFINITY);
            for (_, m) in exact.iter().filter(|(_, m)| m.t.sign() > 0) {
                if m.t.cmp_number(behind).is_gt() {
                    expected += 1;
                    behind = m.t.to_f32().next_up().into();
                }
            }
            prop_assert_eq!(crossings, expected);
        }
    }

    #[test]
    fn p12_t_is_among_those_of_the_corners(triangles in triangles(), shots in shots()) {
        for (ray, corners) in rays(&shots, &triangles).iter().zip(triangles.iter().cycle()) {
            let tris = buffer([*corners]);
            let hit = BspTree::build(&tris).closest_hit(ray);
            if !hit.is_hit() {
                continue;
            }
            // The projections of the corners on the ray, exactly: (p - o).d, against T d.d with a step of f32 to spare.
            let d = ray.direction.as_dvec3();
            let along = |p: GzCoord| (p.as_dvec3() - ray.origin).dot(d) / d.length_squared();
            let at = corners.map(along);
            let (least, most) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
            if least.is_finite() && most.is_finite() && hit.t.is_finite() {
                // f64 errs by a few parts in 2^52 of the largest term.
                let reach = corners.iter().map(|p| (p.as_dvec3() - ray.origin).abs().max_element()).fold(0.0, f64::max);
                let slack = 1e-6 * f64::from(hit.t).abs() + 1e-12 * reach / d.length() + f64::from(f32::MIN_POSITIVE);
                prop_assert!(f64::from(hit.t) >= least - slack && f64::from(hit.t) <= most + slack, "{} in {} {}", hit.t, least, most);
            }
        }
    }

    #[test]
    fn p13_weights_are_weights(triangles in triangles(), shots in shots()) {
        for (ray, corners) in rays(&shots, &triangles).iter().zip(triangles.iter().cycle()) {
            if !ray.is_valid() || !is_hit(ray, corners) {
                continue;
            }
            let (weights, tris) = (hit_weights(ray, corners), buffer([*corners]));
            let sum: f64 = weights.iter().sum();
            // Cutting to [0, 1] takes no more than a weight may be off, 2^-36.
            prop_assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)) && (sum - 1.0).abs() <= 2f64.powi(-36), "{:?}", weights);
            let hit = BspTree::build(&tris).closest_hit(ray);
            prop_assert!((0.0..=1.0).contains(&hit.u) && (0.0..=1.0).contains(&hit.v) && hit.weights().iter().all(|w| (0.0..=1.0).contains(w)));
        }
    }

    #[test]
    fn p16_leaving_rays_start_on_their_side(triangles in triangles(), shots in shots(), toward in direction()) {
        let tris = buffer(triangles.iter().copied());
        let tree = BspTree::build(&tris);
        for ray in rays(&shots, &triangles) {
            let hit = tree.closest_hit(&ray);
            if !hit.is_hit() {
                continue;
            }
            let (corners, direction) = (tris.position(hit.tri), toward.as_vec3());
            let side = side_of(corners, direction);
            let origin = leave_surface(corners, hit_weights(&ray, corners), direction);
            prop_assert_eq!(origin.is_none(), side == 0);
            let Some(origin) = origin else { continue };
            let leaving = GzRay::from_f64(origin, direction);
            // On that side by exact arithmetic: the line from there against the direction's way meets the plane behind it, if at all.
            let line = truth_ray(&leaving).line();
            let behind = line.is_some_and(|line| plane_t(&line, &truth_triangle(corners)).is_some_and(|t| t.sign() < 0));
            prop_assert!(behind || !leaving.is_valid(), "it starts on its side");
            prop_assert!(!leaving.is_valid() || (tree.closest_hit(&leaving).tri != hit.tri && !is_hit(&leaving, corners)));
        }
    }

    #[test]
    fn p17_there_and_back((d, n) in meeting(), eta in 0.4f64..2.5) {
        let back = reflect(reflect(d, n), n);
        prop_assert!((back - d).length() < 4e-15 && (reflect(d, n).length() - 1.0).abs() < 2e-15);
        let r = fresnel(-d.dot(n), eta);
        prop_assert!((0.0..=1.0).contains(&r));
        match refract(d, n, eta) {
            None => prop_assert_eq!(r, 1.0),
            Some(through) => {
                // Back along the way it came. Snell's law is about sines: a cosine near 0, on either side, loses what its square keeps.
                let (cos_i, cos_t) = (d.dot(n).abs(), through.dot(n).abs());
                let may_err = 1e-14 * eta.max(1.0 / eta).powi(2) / (cos_i * cos_t).max(1e-14);
                let back = refract(-through, -n, 1.0 / eta);
                prop_assert!(may_err > 0.1 || back.is_some_and(|back| (back + d).length() < may_err), "{:?}", back);
                // What is not reflected goes through, and the same from the other side.
                prop_assert!((fresnel(cos_t, 1.0 / eta) - r).abs() < may_err);
            }
        }
    }

    #[test]
    fn p18_no_boundary_changes_nothing((d, n) in meeting()) {
        prop_assert_eq!(refract(d, n, 1.0), Some(d));
        prop_assert_eq!(gz_shade::optics::reflectance(gz_shade::Fresnel::Exact, -d.dot(n), 1.0), 0.0);
    }
}

/// 1 - v.
fn one_less(v: &Fraction) -> Fraction {
    v.minus(1.0).negated()
}
