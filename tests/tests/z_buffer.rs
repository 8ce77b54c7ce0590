//! Scan conversion and rays look through the same points: they may differ by rounding alone.

use gz_core::glam::DVec3;
use gz_core::{GzCoord, NO_TRI, View};
use gz_tests::z_buffer::{same_view, teapot_view};

#[test]
fn the_two_buffers_of_a_view_agree_but_for_edges() {
    let view = teapot_view(160).unwrap();
    let it = view.difference();
    println!("{it:?}");
    assert!(it.both > 160 * 160 / 2, "{it:?}");
    // Edges of triangles that are several pixels long; a floor of 8 by 8 quads and a teapot of 16 segments.
    assert!(it.only_z + it.only_t < it.both / 200 && it.other < it.both / 20, "{it:?}");
    // Screen z in f32 tells a part of the depths apart that T-values do.
    assert!(it.depths_t > it.both / 2 && it.depths_z > 1000 && it.depths_z < it.depths_t / 2, "{it:?}");
    for shot in [view.z_shot(), view.t_shot(), view.difference_shot()] {
        assert_eq!((shot.width, shot.height, shot.rgb.len()), (160, 160, 3 * 160 * 160));
        assert!(shot.rgb.iter().any(|&byte| byte != shot.rgb[0]), "{}", shot.caption);
    }
}

#[test]
fn a_wall_has_the_known_z_and_t() {
    // A wall at distance 3 from the view plane, with fov 90: d = 1, so that w = 4 and z = 3/4 of the greatest; T from d behind the plane is 4.
    let view = View { position: DVec3::ZERO, look_at: DVec3::Z, up: DVec3::Y, fov: 90.0 };
    let wall = [[-90.0, -90.0, 3.0], [90.0, -90.0, 3.0], [0.0, 90.0, 3.0]].map(GzCoord::from_array);
    let behind = wall.map(|p| p - GzCoord::Z * 4.0);
    let both = same_view(&[behind, wall], view, 8, 8).unwrap();
    let middle = 4 * 8 + 4;
    let (z, t) = (both.z[middle], both.t[middle]);
    assert_eq!((z.tri, t.tri), (0, 0), "the one behind is dropped");
    assert!((f64::from(z.z) / f64::from(i32::MAX) - 0.75).abs() < 1e-6 && (t.t - 4.0).abs() < 1e-6, "{z:?} {t:?}");
    assert!(both.z.iter().all(|pixel| pixel.tri != NO_TRI));
}
