//! Ways to leave a surface, from shadow rays to glass: the exact one, and those it is compared with.

mod common;

use common::*;
use gz_core::{GzColor, LeavePolicy};
use gz_shade::*;

/// A slanted wall whose points round to both sides of it, lit from where the camera is.
fn slanted(policy: LeavePolicy) -> Made {
    let mut made = Made { lights: vec![sun([0.1, 0.2, 1.0])], ..Made::default() };
    made.rules.leave = policy;
    let wall = made.material(matt());
    made.quad([[-9.0, -9.0, -1.3], [9.0, -9.0, 0.7], [9.0, 9.0, 1.9], [-9.0, 9.0, -0.1]], [-0.1, -0.07, 1.0], wall);
    made
}

/// Pixels that a policy shades otherwise than the exact one does.
fn wrong(made: &dyn Fn(LeavePolicy) -> Made, policy: LeavePolicy) -> usize {
    let (exact, other) = (made(LeavePolicy::Exact).shade(), made(policy).shade());
    assert_eq!(exact.stats.primary_hits, other.stats.primary_hits);
    exact.colors.iter().zip(&other.colors).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-3).count()
}

#[test]
fn a_bare_start_stipples_a_lit_wall_and_every_cure_cures_it_here() {
    assert!(slanted(LeavePolicy::Exact).shade().colors.iter().all(|color| color.x > 0.5));
    assert!(wrong(&slanted, LeavePolicy::Bare) > 40, "of 256");
    for policy in [LeavePolicy::Identity, LeavePolicy::USUAL_EPSILON, LeavePolicy::WaechterBinder, LeavePolicy::ErrorBound] {
        assert_eq!(wrong(&slanted, policy), 0, "{policy:?}");
    }
    assert!(wrong(&slanted, LeavePolicy::Epsilon(0.0)) > 40, "an epsilon of 0 cures nothing");
}

#[test]
fn what_stands_nearer_than_an_epsilon_throws_no_shadow() {
    // Light comes in flat from the right, past a board that stands on its edge 0.2 away from the wall's middle column.
    let dark_pixels = |policy| {
        let mut made = Made { lights: vec![sun([1.0, 0.0, 0.5])], ..Made::default() };
        made.rules.leave = policy;
        let wall = made.material(matt());
        made.wall(0.0, 9.0, wall);
        made.quad([[0.5, -9.0, 0.01], [0.5, 9.0, 0.01], [0.5, 9.0, 0.4], [0.5, -9.0, 0.4]], [1.0, 0.0, 0.0], wall);
        made.shade().colors.iter().filter(|color| color.x == 0.0).count()
    };
    let exact = dark_pixels(LeavePolicy::Exact);
    assert!(exact > 20, "{exact}");
    assert_eq!(dark_pixels(LeavePolicy::Identity), exact);
    assert!(dark_pixels(LeavePolicy::Epsilon(1.0)) < exact / 2, "the shadow is there for another reason");
}

#[test]
fn mirrors_and_glass_follow_the_policy_too() {
    let world = |policy| {
        let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
        made.rules.leave = policy;
        made.rules.depth = 12;
        made.camera = looking([2.0, 1.5, 4.0], [0.0; 3], 30.0);
        let glass = made.material(dark(MaterialKind::Glass { ior: 1.5 }));
        let mirror = made.material(dark(MaterialKind::Mirror { ior: None }));
        made.block([-1.0; 3], [1.0; 3], false, glass);
        made.quad([[-9.0, -3.0, -9.0], [9.0, -3.1, -9.0], [9.0, -3.2, 9.0], [-9.0, -3.1, 9.0]], [0.0, 1.0, 0.0], mirror);
        made
    };
    let exact = world(LeavePolicy::Exact).shade();
    assert!(exact.stats.mirror_rays > 0 && exact.stats.glass_rays > 0);
    // Without a cure rays meet the face that they leave, and are caught between its sides.
    let bare = world(LeavePolicy::Bare).shade();
    assert!(bare.stats.glass_rays > exact.stats.glass_rays && wrong(&world, LeavePolicy::Bare) > 20);
    for policy in [LeavePolicy::Identity, LeavePolicy::USUAL_EPSILON, LeavePolicy::ErrorBound] {
        assert!(wrong(&world, policy) < 8, "{policy:?}: {}", wrong(&world, policy));
    }
}

#[test]
fn identity_sees_other_glass_and_not_its_own() {
    // A tinted pane under a lamp: its own shadow ray does not tint, another pane's does.
    let panes = |count: u8, policy| {
        let mut made = Made { lights: vec![lamp([0.0, 0.0, 9.0])], ..Made::default() };
        made.rules.leave = policy;
        let wall = made.material(matt());
        let mut glass = dark(MaterialKind::Glass { ior: 1.0 });
        glass.tint = GzColor::new(0.5, 1.0, 1.0);
        let glass = made.material(glass);
        made.camera = looking([0.0, 0.0, 1.0], [0.0; 3], 40.0);
        made.wall(0.0, 9.0, wall);
        for k in 0..count {
            made.wall(3.0 + f32::from(k), 9.0, glass);
        }
        made.middle()
    };
    for policy in [LeavePolicy::Exact, LeavePolicy::Identity] {
        let (none, one, two) = (panes(0, policy), panes(1, policy), panes(2, policy));
        assert!(none.x > 0.6 && (one.x / none.x - 0.5).abs() < 1e-4 && (two.x / none.x - 0.25).abs() < 1e-4, "{policy:?}");
    }
}
