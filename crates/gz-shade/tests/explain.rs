//! A pixel taken apart: its parts make its colour.

mod common;

use common::*;
use gz_core::GzColor;
use gz_shade::*;

/// A wall under four lights: one free, one behind the wall, one that an opaque blind hides, one that tinted glass dims.
fn four_lights() -> Made {
    let mut made = Made { ambient: GzColor::splat(0.25), ..Made::default() };
    made.lights = vec![sun([0.0, 0.6, 0.8]), sun([0.0, 0.0, -1.0]), lamp([3.0, 0.0, 3.0]), lamp([-3.0, 0.0, 3.0])];
    let wall = made.material(matt());
    let pane = made.material(Material { tint: GzColor::new(0.5, 1.0, 0.25), ..dark(MaterialKind::Glass { ior: 1.5 }) });
    made.wall(0.0, 1.0, wall);
    let side = |x: f32| [[x, -1.0, 1.0], [x, 1.0, 1.0], [x, 1.0, 2.0], [x, -1.0, 2.0]];
    made.quad(side(1.5), [1.0, 0.0, 0.0], wall).quad(side(-1.5), [1.0, 0.0, 0.0], pane);
    made
}

#[test]
fn every_light_says_what_it_adds_and_why() {
    let nodes = four_lights().explain(8, 8);
    assert_eq!(nodes.len(), 1);
    let node = &nodes[0];
    let kinds: Vec<usize> = node.lights.iter().map(|part| part.light).collect();
    assert_eq!(kinds, [0, 1, 2, 3]);
    let Sight::Cast { share, blocker, ray } = node.lights[0].sight else { panic!("{:?}", node.lights[0]) };
    assert_eq!((share, blocker.is_hit(), ray.tmax), (GzColor::ONE, false, f32::INFINITY));
    assert_eq!((node.lights[1].sight, node.lights[1].color), (Sight::Behind, GzColor::ZERO));
    let Sight::Cast { share, blocker, ray } = node.lights[2].sight else { panic!("{:?}", node.lights[2]) };
    assert_eq!((share, node.lights[2].color), (GzColor::ZERO, GzColor::ZERO));
    assert!((2..4).contains(&blocker.tri) && blocker.t > 0.0 && blocker.t < ray.tmax, "{blocker:?}");
    let Sight::Cast { share, blocker, .. } = node.lights[3].sight else { panic!("{:?}", node.lights[3]) };
    assert_eq!((share, blocker.is_hit()), (GzColor::new(0.5, 1.0, 0.25), false));
}

#[test]
fn the_parts_make_the_local_colour() {
    let mut made = four_lights();
    for interpolate in [Interpolate::Flat, Interpolate::Gouraud] {
        made.materials[0].interpolate = interpolate;
        for (i, j) in [(8, 8), (6, 7), (9, 10)] {
            for node in made.explain(i, j).iter().filter(|node| node.hit.is_hit()) {
                let sum = node.lights.iter().fold(node.ambient, |sum, part| sum + part.color);
                assert!(node.ambient != GzColor::ZERO && (sum - node.local).abs().max_element() < 1e-6, "{node:?}");
            }
        }
    }
}

#[test]
fn without_shadows_no_ray_is_named() {
    let mut made = four_lights();
    made.rules.shadow = ShadowRule::Off;
    let node = &made.explain(8, 8)[0];
    assert_eq!([0, 1, 2, 3].map(|k| node.lights[k].sight == Sight::Unasked), [true, false, true, true]);
}
