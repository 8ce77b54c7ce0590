//! How much light a boundary reflects: the exact Fresnel equations, and Schlick's approximation of the paper.

use crate::Fresnel;
use crate::refraction::cos_transmitted;

/// Fraction of unpolarised light reflected at a boundary, by `rule`.
///
/// `cos_i` is the cosine between normal and incoming ray, clamped to [0, 1]; `eta` = n1 / n2, the index on the incoming side over the
/// other, above 0. Returns a fraction in [0, 1]: 1 under total internal reflection, 0 where the indices are equal (Schlick's formula
/// alone would reflect at grazing angles there, where there is no boundary).
pub fn reflectance(rule: Fresnel, cos_i: f64, eta: f64) -> f64 {
    if eta == 1.0 {
        return 0.0;
    }
    match rule {
        Fresnel::Exact => fresnel(cos_i, eta),
        Fresnel::Schlick => schlick(cos_i, eta),
    }
}

/// Fraction of unpolarised light reflected at a boundary, exactly.
///
/// Arguments and range as [`reflectance`]. Source: the Fresnel equations, mean of both polarisations.
pub fn fresnel(cos_i: f64, eta: f64) -> f64 {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let Some(cos_t) = cos_transmitted(cos_i, eta) else { return 1.0 };
    if cos_t == 0.0 && cos_i == 0.0 {
        return 1.0; // grazing along a boundary of equal indices: 0 / 0 below
    }
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    (perpendicular * perpendicular + parallel * parallel) / 2.0
}

/// Fraction of light reflected at a boundary, Schlick's approximation.
///
/// Arguments and range as [`reflectance`]. The paper prints it for light that comes from the thin side. From the dense side
/// (`eta` > 1) it holds with the cosine *behind* the boundary, and 1 under total reflection; with `cos_i` it would be wrong by up to
/// 0.96 at eta 1.5. From either side the error at eta 1.5 is then at most 0.036.
///
/// Source: the paper, equations 2 and 3: R0 = (n - 1)^2 / (n + 1)^2 and R = R0 + (1 - cos)^5 (1 - R0).
pub fn schlick(cos_i: f64, eta: f64) -> f64 {
    let cos = if eta > 1.0 {
        let Some(cos_t) = cos_transmitted(cos_i, eta) else { return 1.0 };
        cos_t
    } else {
        cos_i.clamp(0.0, 1.0)
    };
    let r0 = ((eta - 1.0) / (eta + 1.0)) * ((eta - 1.0) / (eta + 1.0));
    let m = 1.0 - cos;
    r0 + (m * m) * (m * m) * m * (1.0 - r0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLASS: f64 = 1.5;

    #[test]
    fn head_on_both_give_r0() {
        for eta in [1.0 / GLASS, GLASS] {
            assert!((fresnel(1.0, eta) - 0.04).abs() < 1e-15);
            assert!((schlick(1.0, eta) - 0.04).abs() < 1e-15);
        }
    }

    #[test]
    fn brewsters_angle_reflects_half_of_the_perpendicular_share() {
        // tan B = n2/n1: the parallel share vanishes, the perpendicular one is ((n^2 - 1) / (n^2 + 1))^2.
        let cos = 1.0 / (1.0 + GLASS * GLASS).sqrt();
        let s = (GLASS * GLASS - 1.0) / (GLASS * GLASS + 1.0);
        assert!((fresnel(cos, 1.0 / GLASS) - s * s / 2.0).abs() < 1e-15);
    }

    #[test]
    fn g1_no_boundary_reflects_nothing() {
        for rule in [Fresnel::Exact, Fresnel::Schlick] {
            for cos in [0.0, 0.01, 0.5, 1.0] {
                assert_eq!(reflectance(rule, cos, 1.0), 0.0);
            }
        }
        assert_eq!(fresnel(0.0, 1.0), 1.0); // the limit along the boundary, not a NaN
    }

    #[test]
    fn grazing_and_total_reflection_reflect_all() {
        for rule in [Fresnel::Exact, Fresnel::Schlick] {
            assert!((reflectance(rule, 0.0, 1.0 / GLASS) - 1.0).abs() < 1e-15);
            assert_eq!(reflectance(rule, 0.5, GLASS), 1.0); // 60 degrees, beyond 41.8
        }
    }

    #[test]
    fn g11_schlick_with_the_transmitted_cosine_stays_near_the_truth_from_both_sides() {
        for eta in [1.0 / GLASS, GLASS] {
            let worst = (0..=10_000)
                .map(|k| f64::from(k) / 10_000.0)
                .map(|cos| (schlick(cos, eta) - fresnel(cos, eta)).abs())
                .fold(0.0, f64::max);
            assert!(worst > 0.03 && worst < 0.037, "{worst}");
        }
    }

    #[test]
    fn shares_stay_between_0_and_1_for_any_cosine() {
        for eta in [1e-3, 0.4, 0.9999, 1.0001, 2.4, 1e3] {
            for cos in [-0.1, 0.0, 1e-300, 1e-8, 0.5, 1.0, 1.0 + 4e-7] {
                for rule in [Fresnel::Exact, Fresnel::Schlick] {
                    let r = reflectance(rule, cos, eta);
                    assert!((0.0..=1.0).contains(&r), "{rule:?} {cos} {eta}: {r}");
                }
            }
        }
    }
}
