//! Small renders of the scenes in `assets/scenes` against references in `tests/golden`.
//!
//! T-values and triangles must be equal to the bit, colours at most 1/255 a channel apart. A difference writes
//! expected | difference | actual to `target/golden-failures`. `cargo xtask golden --bless` makes the present renders the references.

use gz_app::compare::{Difference, hits, pictures};
use gz_app::load::{self, Overrides};
use gz_app::picture::Picture;
use gz_app::view::trace_hits;
use gz_app::{hits_file, output, sheet};
use gz_bsp::BspTree;
use gz_core::{Hit, TileGrid};
use gz_shade::{Antialias, Scene, SceneNeeds, shade_frame};
use std::path::{Path, PathBuf};

/// Width of a golden picture in pixels; the height follows the scene's shape.
const WIDTH: u32 = 128;

/// What a scene looks like, small.
struct Render {
    picture: Picture,
    /// The same as bytes, for the file.
    rgb: Vec<u8>,
    hits: Vec<Hit>,
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the tests lie in the workspace").to_owned()
}

/// The scenes that need no course data, which would not be there on every machine and whose pictures are not ours to publish.
fn scenes() -> Vec<PathBuf> {
    let folder = workspace().join("assets/scenes");
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut scenes: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|e| e == "toml") && !names_course_data(path));
    scenes.sort();
    scenes
}

fn names_course_data(path: &Path) -> bool {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.lines().any(|line| !line.trim_start().starts_with('#') && line.contains("hw:"))
}

fn place(path: &Path, overrides: &Overrides) -> (Scene, SceneNeeds) {
    let draft = load::scene(path, overrides).unwrap_or_else(|error| panic!("{error}"));
    let needs = SceneNeeds::of(&draft.scene);
    (draft.place(needs).unwrap_or_else(|error| panic!("{error}")), needs)
}

fn render(path: &Path) -> Render {
    let full = load::scene(path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}")).scene.camera;
    let height = (WIDTH * full.height()).div_ceil(full.width());
    let small = Overrides { size: Some((WIDTH, height)), ..Overrides::default() };
    let grid = TileGrid::whole(WIDTH, height, 32);

    let (scene, needs) = place(path, &small);
    let query = BspTree::build(&scene.tris);
    let frame = shade_frame(&scene, needs, &query, &grid, &|_| ());
    let rgb = output::rgb8(&frame.colors, scene.rules.color_code);

    // T-values belong to the middle of a pixel: one ray each, whatever the scene's antialiasing.
    let (plain, _) = place(path, &Overrides { aa: Some(Antialias::None), ..small });
    let hits = trace_hits(&plain, &BspTree::build(&plain.tris), &grid);
    Render { picture: Picture::of_bytes(WIDTH, height, &rgb), rgb, hits }
}

/// The complaint about one half of a render, with a sheet of it, or nothing.
fn complain(name: &str, found: Result<Difference, String>, sheet: impl Fn() -> sheet::Sheet) -> Option<String> {
    let found = match found {
        Ok(found) if found.over == 0 => return None,
        Ok(found) => found,
        Err(reason) => return Some(format!("{name}: {reason}")),
    };
    let folder = workspace().join("target/golden-failures");
    let file = folder.join(name);
    let sheet = sheet();
    std::fs::create_dir_all(&folder).expect("target is writable");
    std::fs::write(&file, output::png(sheet.width, sheet.height, &sheet.rgb).expect("a sheet can be encoded"))
        .expect("target is writable");
    Some(format!(
        "{name}: {} of {} pixels differ, {} too much, most by {}: see {}",
        found.differing,
        found.pixels,
        found.over,
        found.max,
        file.display()
    ))
}

fn check(stem: &str, render: &Render, picture_file: &Path, hits_file_path: &Path) -> Vec<String> {
    let missing = |file: &Path| format!("{}: no reference: look at the scene, then cargo xtask golden --bless", file.display());
    let mut complaints = Vec::new();
    match Picture::read(picture_file) {
        Err(_) => complaints.push(missing(picture_file)),
        Ok(expected) => complaints.extend(complain(&format!("{stem}.png"), pictures(&expected, &render.picture, 1.0), || {
            sheet::of_pictures(&expected, &render.picture)
        })),
    }
    match std::fs::read(hits_file_path).map_err(|error| error.to_string()).and_then(|bytes| hits_file::decode(&bytes)) {
        Err(_) => complaints.push(missing(hits_file_path)),
        Ok(expected) => complaints.extend(complain(&format!("{stem}.hits.png"), hits(&expected, &render.hits, 0.0), || {
            sheet::of_hits(WIDTH, &expected, &render.hits)
        })),
    }
    complaints
}

fn bless(render: &Render, picture_file: &Path, hits_file_path: &Path) {
    std::fs::create_dir_all(picture_file.parent().expect("a file in a folder")).expect("the references are writable");
    let png = output::png(WIDTH, render.picture.height, &render.rgb).expect("a render can be encoded");
    // A picture that is within the tolerance stays as it is, so that blessing one scene does not touch the others.
    let same = Picture::read(picture_file).is_ok_and(|old| pictures(&old, &render.picture, 1.0).is_ok_and(|d| d.over == 0));
    if !same {
        std::fs::write(picture_file, png).expect("the references are writable");
        println!("blessed {}", picture_file.display());
    }
    let hits = hits_file::encode(&render.hits);
    if std::fs::read(hits_file_path).ok().as_deref() != Some(&hits) {
        std::fs::write(hits_file_path, hits).expect("the references are writable");
        println!("blessed {}", hits_file_path.display());
    }
}

#[test]
fn scenes_look_as_they_did() {
    let references = workspace().join("tests/golden");
    let blessing = std::env::var_os("GZ_BLESS").is_some_and(|value| value == "1");
    let scenes = scenes();
    assert!(!scenes.is_empty(), "assets/scenes holds no scene that needs no course data");
    let mut complaints = Vec::new();
    for scene in &scenes {
        let stem = scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let (picture_file, hits_file_path) = (references.join(format!("{stem}.png")), references.join(format!("{stem}.hits")));
        let render = render(scene);
        if blessing {
            bless(&render, &picture_file, &hits_file_path);
        }
        complaints.extend(check(&stem, &render, &picture_file, &hits_file_path));
    }
    assert!(complaints.is_empty(), "golden images differ\n{}", complaints.join("\n"));
}

#[test]
fn every_reference_has_its_scene() {
    let stems: Vec<_> = scenes().iter().map(|scene| scene.file_stem().unwrap_or_default().to_owned()).collect();
    let Ok(entries) = std::fs::read_dir(workspace().join("tests/golden")) else {
        return; // none yet: the other test says so
    };
    let orphans: Vec<_> = entries
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|file| !stems.iter().any(|stem| file.file_stem() == Some(stem)))
        .collect();
    assert!(orphans.is_empty(), "references without a scene: {orphans:?}");
}
