//! What a scene does not need is neither stored nor traced, and nobody can see that.

use gz_app::load::{self, Draft, Overrides};
use gz_bsp::BspTree;
use gz_core::Attributes;
use gz_shade::{Frame, FrameStats, Scene, SceneNeeds};
use gz_tests::counting::Counting;
use gz_tests::needs_scenes::{self, NeedScene};
use gz_tests::scenes;
use std::path::{Path, PathBuf};

/// Small, with each scene's own antialiasing.
const SMALL: Overrides = Overrides { size: Some((128, 96)), ..Overrides::NONE };

fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("needs")
}

fn draft(name: &str, toml: &str) -> Draft {
    let path = needs_scenes::write(&folder(), name, toml).unwrap();
    load::scene(&path, &Overrides::default()).unwrap()
}

/// The picture, and what the query was asked for it.
fn counted(scene: &Scene, needs: SceneNeeds) -> (Frame, [(&'static str, u64, u64); 3]) {
    let tree = BspTree::build(&scene.tris);
    let query = Counting::new(&tree);
    let frame = scenes::shade(scene, needs, &query, 32);
    let counts = query.against(&frame.stats);
    (frame, counts)
}

fn picture(draft: Draft, needs: SceneNeeds) -> Frame {
    counted(&draft.place(needs).unwrap(), needs).0
}

/// `needs` without the one of this name.
fn without(mut needs: SceneNeeds, need: &str) -> SceneNeeds {
    *field(&mut needs, need) = false;
    needs
}

fn field<'a>(needs: &'a mut SceneNeeds, need: &str) -> &'a mut bool {
    match need {
        "shadows" => &mut needs.shadows,
        "mirrors" => &mut needs.mirrors,
        "glass" => &mut needs.glass,
        "image_textures" => &mut needs.image_textures,
        "procedural_textures" => &mut needs.procedural_textures,
        "smooth_normals" => &mut needs.smooth_normals,
        "gouraud" => &mut needs.gouraud,
        "app_colors" => &mut needs.app_colors,
        "materials" => &mut needs.materials,
        "antialiasing" => &mut needs.antialiasing,
        _ => panic!("there is no need {need}"),
    }
}

/// Counts that are not zero though only primary rays were cast, one a pixel or more.
fn beyond_primary(stats: &FrameStats) -> Vec<&'static str> {
    let rows = stats.rows().into_iter().filter(|(name, count)| *count > 0 && !name.starts_with("primary"));
    rows.map(|(name, _)| name).collect()
}

#[test]
fn rays_counted_at_the_query_are_those_that_the_statistics_tell() {
    let (mut rays, mut names) = (0, Vec::new());
    for name in scenes::usable() {
        let (scene, needs) = scenes::placed(&name, &SMALL);
        for (kind, counted, told) in counted(&scene, needs).1 {
            assert_eq!(counted, told, "{name}: {kind}");
            rays += counted;
        }
        names.push(name);
    }
    println!("{rays} rays of {} scenes counted", names.len());
    assert!(rays > 500_000 && names.len() >= 5, "{rays} rays of {names:?}");
}

#[test]
fn computed_needs_and_all_needs_give_equal_pixels_on_every_scene() {
    for name in scenes::usable() {
        let (scene, needs) = scenes::placed(&name, &SMALL);
        let (computed, _) = counted(&scene, needs);
        let full = scenes::draft(&name, &SMALL).place(SceneNeeds::ALL).unwrap();
        assert_eq!(full.tris.attributes(), Attributes::ALL);
        let (all, _) = counted(&full, SceneNeeds::ALL);
        assert_eq!(scenes::color_bits(&computed.colors), scenes::color_bits(&all.colors), "{name}");
        assert_eq!(computed.stats, all.stats, "{name}");
        assert_eq!(computed.stats.nan_pixels, 0, "{name}");
    }
}

#[test]
fn the_plain_scene_of_assets_casts_primary_rays_only_and_stores_no_texture_coordinates() {
    let (scene, needs) = scenes::placed("plain", &SMALL);
    let (frame, _) = counted(&scene, needs);
    assert_eq!(beyond_primary(&frame.stats), Vec::<&str>::new());
    assert_eq!((frame.stats.rays(), frame.stats.primary_rays), (128 * 96, 128 * 96));
    assert!(scene.tris.uvs(0).is_none() && !scene.tris.attributes().uvs && !scene.tris.attributes().classes);
}

#[test]
fn a_scene_that_needs_nothing_stores_positions_only() {
    let draft = draft("nothing", &needs_scenes::plain());
    let needs = SceneNeeds::of(&draft.scene);
    assert!(SceneNeeds::reasons(&draft.scene).iter().all(|reason| reason.because.is_none()));
    let scene = draft.place(needs).unwrap();
    assert_eq!(scene.tris.bytes(), 36 * scene.tris.len());
    assert_eq!(beyond_primary(&counted(&scene, needs).0.stats), Vec::<&str>::new());
}

#[test]
fn for_each_need_there_is_a_scene_in_which_only_that_counts() {
    let scenes = needs_scenes::all();
    let names: Vec<&str> = scenes.iter().map(|scene| scene.need).collect();
    let plain = draft("plain", &needs_scenes::plain());
    assert_eq!(names, SceneNeeds::reasons(&plain.scene).map(|reason| reason.need));
    for NeedScene { need, also, toml, attributes, rays } in scenes {
        // Only this is asked for,
        let draft_of = draft(need, &toml);
        let asked: Vec<&str> =
            SceneNeeds::reasons(&draft_of.scene).iter().filter(|it| it.because.is_some()).map(|it| it.need).collect();
        assert!(asked.contains(&need) && asked.iter().all(|&it| it == need || Some(it) == also), "{need}: {asked:?}");
        // only its arrays are stored,
        let needs = SceneNeeds::of(&draft_of.scene);
        let scene = draft_of.place(needs).unwrap();
        assert_eq!(scene.tris.attributes(), attributes, "{need}");
        assert_eq!(scene.tris.bytes(), attributes.bytes_per_triangle() * scene.tris.len(), "{need}");
        // and only its rays are cast.
        let (frame, counts) = counted(&scene, needs);
        for (kind, counted, told) in counts {
            assert_eq!(counted, told, "{need}: {kind}");
        }
        let pixels = u64::from(needs_scenes::SIZE.0 * needs_scenes::SIZE.1);
        let samples = if need == "antialiasing" { needs_scenes::SAMPLES } else { 1 };
        let stats = &frame.stats;
        assert_eq!(stats.primary_rays, samples * pixels, "{need}");
        for (kind, count) in needs_scenes::further_rays(stats) {
            assert_eq!(count > 0, rays == Some(kind), "{need}: {count} {kind}");
        }
        assert_eq!(stats.tint_queries, 0, "{need}");
    }
}

#[test]
fn computed_needs_are_enough_and_none_of_them_is_too_much() {
    for NeedScene { need, toml, .. } in needs_scenes::all() {
        let needs = SceneNeeds::of(&draft(need, &toml).scene);
        let computed = scenes::color_bits(&picture(draft(need, &toml), needs).colors);
        let all = scenes::color_bits(&picture(draft(need, &toml), SceneNeeds::ALL).colors);
        assert_eq!(computed, all, "{need}: enough");
        let less = scenes::color_bits(&picture(draft(need, &toml), without(needs, need)).colors);
        let differing = computed.iter().zip(&less).filter(|(a, b)| a != b).count();
        assert!(differing > 20, "without {need} only {differing} pixels differ");
    }
}
