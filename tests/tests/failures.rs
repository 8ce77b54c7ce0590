//! The failures that the paper tells of must show when they are made again, and their cures must cure.

use gz_app::load::Overrides;
use gz_core::BruteForce;
use gz_tests::failures::{self, Failure};
use gz_tests::scenes::{placed, shade};

const WIDTH: u32 = 64;

/// The share of pixels that the mistake changes, in per cent.
fn spoilt(failure: &Failure) -> f64 {
    let pixels = failure.cure.rgb.len() / 3;
    assert_eq!((failure.wrong.rgb.len(), pixels), (failure.cure.rgb.len(), (failure.cure.width * failure.cure.height) as usize));
    100.0 * failure.differing() as f64 / pixels as f64
}

#[test]
fn each_failure_shows_and_is_named_once() {
    let all = failures::all(WIDTH).unwrap();
    for failure in &all {
        println!("{}: {:.1} % of the pixels", failure.name, spoilt(failure));
        assert!(spoilt(failure) > 1.0, "{}: {:.2} %", failure.name, spoilt(failure));
        assert!(failure.why.ends_with('.') && failure.wrong.caption != failure.cure.caption);
    }
    let mut names: Vec<_> = all.iter().map(|failure| failure.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 5);
}

#[test]
fn stipple_is_cured_to_the_picture_of_brute_force() {
    let (scene, needs) = placed("shadows", &Overrides { size: Some((WIDTH, 48)), ..Overrides::NONE });
    let right = shade(&scene, needs, &BruteForce::new(&scene.tris), 16);
    let right = gz_app::output::rgb8(&right.colors, scene.rules.color_code);
    assert!(failures::shadow_stipple(WIDTH).unwrap().cure.rgb == right);
}

#[test]
fn no_picture_is_made_from_course_data() {
    // Whatever folder the environment names, the scene behind the pictures reads no file of it.
    let text = std::fs::read_to_string(gz_tests::rendered::scene_path("shadows")).unwrap();
    assert!(!text.contains("hw:"));
}
