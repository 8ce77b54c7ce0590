//! The ray-triangle tests that are there for comparison, under one name.
//!
//! Each is written as it is usually written, without tolerances, and answers what its rounded numbers say. The report and the lessons show
//! what each of them gets wrong, and where; a render reaches them only when it asks for one by name.

use super::Closest;
use super::baldwin_weber::baldwin_weber;
use super::moeller_trumbore::{moeller_trumbore, moeller_trumbore_f64};
use super::plane::plane_then_inside;
use super::pluecker::pluecker;
use super::woop::woop;
use crate::{GzCoord, GzRay, Kernel};

/// T-value and weights of the second and third corner by the rounded test `kernel`; `None` for a miss.
///
/// `ray` is valid. [`Kernel::Certified`] is not such a test, as its answer depends on no rounding; asked all the same, it is asked about
/// this triangle alone.
pub fn plain(kernel: Kernel, ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    match kernel {
        Kernel::Certified => certified(ray, corners),
        Kernel::Plane => plane_then_inside(ray, corners),
        Kernel::MoellerTrumbore => moeller_trumbore(ray, corners),
        Kernel::MoellerTrumboreF64 => moeller_trumbore_f64(ray, corners),
        Kernel::Woop => woop::<false>(ray, corners),
        Kernel::WoopFused => woop::<true>(ray, corners),
        Kernel::Pluecker => pluecker(ray, corners),
        Kernel::BaldwinWeber => baldwin_weber(ray, corners),
    }
}

fn certified(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    let (mut closest, positions) = (Closest::default(), std::slice::from_ref(corners));
    closest.consider(ray, 0, positions);
    let hit = closest.hit(ray, positions);
    hit.is_hit().then_some((hit.t, hit.u, hit.v))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle whose axis of largest normal component is each axis in turn, wound both ways.
    fn triangles() -> impl Iterator<Item = [GzCoord; 3]> {
        let turned = |k: usize, [x, y, z]: [f32; 3]| {
            let mut p = GzCoord::ZERO;
            (p[k], p[(k + 1) % 3], p[(k + 2) % 3]) = (x, y, z);
            p
        };
        let corners = [[2.0, -3.0, -4.0], [2.5, 5.0, -3.0], [1.5, -1.0, 6.0]];
        (0..3).flat_map(move |k| {
            let [a, b, c] = corners.map(|p| turned(k, p));
            [[a, b, c], [a, c, b], [-a, -b, -c]]
        })
    }

    #[test]
    fn all_agree_on_rays_well_inside_and_well_outside() {
        let origins = [GzCoord::ZERO, GzCoord::new(0.5, -0.25, 0.125), GzCoord::new(9.0, 8.0, 7.0)];
        let weights = [[0.2, 0.3], [0.6, 0.2], [0.1, 0.8], [-0.1, 0.5], [0.7, 0.6], [0.5, -0.2]];
        let mut compared = 0;
        for corners in triangles() {
            for origin in origins {
                for [u, v] in weights {
                    let [a, b, c] = corners;
                    let target = a * (1.0 - u - v) + b * u + c * v;
                    let inside = u > 0.0 && v > 0.0 && u + v < 1.0;
                    for length in [0.5, 1.0, -1.0] {
                        let ray = GzRay::new(origin, (target - origin) * length);
                        let hits = inside && length > 0.0;
                        for kernel in Kernel::ALL {
                            let found = plain(kernel, &ray, &corners);
                            assert_eq!(found.is_some(), hits, "{kernel:?} {ray:?} {corners:?}");
                            if let Some((t, found_u, found_v)) = found {
                                assert!((t * length - 1.0).abs() < 1e-5, "{kernel:?}: t {t}");
                                assert!(
                                    (found_u - u).abs() < 1e-5 && (found_v - v).abs() < 1e-5,
                                    "{kernel:?}: {found_u} {found_v}"
                                );
                                assert_eq!(plain(kernel, &GzRay { tmax: t.next_down(), ..ray }, &corners), None, "{kernel:?}");
                                assert_eq!(plain(kernel, &GzRay { tmin: t.next_up(), ..ray }, &corners), None, "{kernel:?}");
                            }
                            compared += 1;
                        }
                    }
                }
            }
        }
        assert_eq!(compared, 9 * 3 * 6 * 3 * 8);
    }

    #[test]
    fn what_cannot_be_hit_is_missed_by_all() {
        let wall = [[-9.0, -9.0, 2.0], [9.0, -9.0, 2.0], [0.0, 9.0, 2.0]].map(GzCoord::from_array);
        let down = GzRay::new(GzCoord::ZERO, GzCoord::Z);
        for kernel in Kernel::ALL {
            // No area, in the plane, numbers that overflow to infinities and NaN.
            assert_eq!(plain(kernel, &down, &[GzCoord::Z; 3]), None, "{kernel:?}");
            assert_eq!(plain(kernel, &down, &[GzCoord::ZERO, GzCoord::Z, GzCoord::Z * 2.0]), None, "{kernel:?}");
            assert_eq!(plain(kernel, &GzRay::new(GzCoord::new(-20.0, 0.0, 2.0), GzCoord::X), &wall), None, "{kernel:?}");
            let far = [[3e38, -3e38, 3e38], [3e38, 3e38, 3e38], [3e38, 0.0, -3e38]].map(GzCoord::from_array);
            assert_eq!(plain(kernel, &GzRay::new(GzCoord::ZERO, GzCoord::NEG_X), &far), None, "{kernel:?}");
        }
    }
}
