//! What a user gets wrong first: the exact message, on one line, and the exit code.

use crate::folder::{Folder, SCENE};

const RENDER: &str = "render scene.toml -o out.png";

/// A folder whose scene is `text`.
fn scene(name: &str, text: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("scene.toml", text);
    folder
}

#[test]
fn a_missing_scene_is_an_input_error() {
    let folder = Folder::new("missing");
    folder.fails("render none.toml -o out.png", 1, "none.toml: no such file");
    folder.fails("info none.obj", 1, "none.obj: no such file");
    folder.fails("pixel none.asc 1 1", 1, "none.asc: no such file");
}

#[test]
fn a_mesh_that_is_missing_is_told_with_the_line_that_names_it() {
    let folder = scene("mesh", &SCENE.replace("teapot = { segments = 3, bottom = true }", "file = \"no.obj\""));
    folder.fails(RENDER, 3, "scene.toml:9: no such file: no.obj");
}

#[test]
fn a_scene_has_one_of_three_extensions() {
    let folder = Folder::with_scene("extension");
    // Its picture would have the same name, which is not what is wrong.
    folder.write("a.png", "");
    folder.fails("render a.png", 3, "a.png: a scene is a .toml, .obj or .asc file");
    folder.write("a.txt", SCENE);
    let ended = folder.gz("render a.txt -o out.png");
    assert_eq!((ended.code, ended.err.lines().count()), (3, 1));
    assert!(ended.err.starts_with("gz: a.txt: ") && ended.err.contains(".toml, .obj"), "{}", ended.err);
}

#[test]
fn a_picture_has_one_of_three_extensions() {
    let folder = Folder::with_scene("format");
    folder.fails("render scene.toml -o a.gif", 2, "a.gif: cannot write .gif pictures: use png, ppm or pfm");
    folder.fails("render scene.toml -o a", 2, "a: a picture needs an extension: png, ppm or pfm");
}

#[test]
fn a_bad_number_is_told_with_its_line() {
    let folder = scene("number", &SCENE.replace("fov = 40.0", "fov = 40,0"));
    let ended = folder.gz(RENDER);
    assert_eq!((ended.code, ended.err.lines().count()), (3, 1));
    assert!(ended.err.starts_with("gz: scene.toml:4: "), "{}", ended.err);

    let folder = scene("word", &SCENE.replace("segments = 3", "segments = \"three\""));
    let ended = folder.gz(RENDER);
    assert_eq!((ended.code, ended.err.lines().count()), (3, 1));
    assert!(ended.err.starts_with("gz: scene.toml:9: "), "{}", ended.err);

    folder.write("bad.obj", "v 0 0 0\nv 1 0 x\nv 0 1 0\nf 1 2 3\n");
    let ended = folder.gz("render bad.obj -o out.png");
    assert_eq!((ended.code, ended.err.lines().count()), (3, 1));
    assert!(ended.err.starts_with("gz: bad.obj:2: "), "{}", ended.err);
}

#[test]
fn an_unknown_material_is_told_with_the_line_that_names_it() {
    let folder = scene("material", &format!("{SCENE}material = \"brass\"\n"));
    folder.fails(RENDER, 3, "scene.toml:10: material \"brass\" is not defined");
}

#[test]
fn an_unknown_key_is_told_with_its_line() {
    let folder = scene("key", &SCENE.replace("color =", "colour ="));
    folder.fails(RENDER, 3, "scene.toml:7: unknown key \"colour\" (did you mean \"color\"?)");
}

#[test]
fn a_size_of_zero_is_refused_in_the_scene_and_on_the_command_line() {
    let folder = scene("zero", &format!("[render]\nsize = [0, 10]\n{SCENE}"));
    folder.fails(RENDER, 3, "scene.toml:2: size must be 1 to 65535 pixels each way, not 0 x 10");
    let message = "invalid value '8x0' for '--size <WxH>': width and height must be whole numbers from 1 to 65535";
    folder.fails(&format!("{RENDER} --size 8x0"), 2, message);
}

#[test]
fn a_scene_without_triangles_is_refused() {
    let folder = scene("empty", SCENE.split("[[mesh]]").next().expect("a scene"));
    folder.fails(RENDER, 3, "scene.toml: no triangles");
}

#[test]
fn course_data_that_is_missing_comes_with_a_hint() {
    let folder = scene("course", &SCENE.replace("teapot = { segments = 3, bottom = true }", "file = \"hw:pot4.asc\""));
    let message = "scene.toml:9: \"hw:pot4.asc\" is course data: set GZ_HW_DATA to the folder of course data";
    folder.fails(RENDER, 3, message);
}

#[test]
fn an_output_that_cannot_be_written_is_found_out_before_the_scene_is_read() {
    let folder = Folder::with_scene("unwritable");
    std::fs::create_dir(folder.path().join("pictures.png")).expect("the folder is writable");
    // The scene does not exist either: that the output is told first shows that it was looked at first.
    folder.fails("render none.toml -o nowhere/a.png", 1, "nowhere/a.png: there is no folder nowhere");
    folder.fails("render none.toml -o pictures.png", 1, "pictures.png: is a folder, not a file");
    folder.fails("render none.toml -o out.png --stats-json nowhere/s", 1, "nowhere/s: there is no folder nowhere");
    folder.fails("render none.toml -o out.png --tbuffer scene.toml/t", 1, "scene.toml/t: there is no folder scene.toml");
}

#[test]
fn no_file_is_written_over_another_of_the_same_run() {
    let folder = Folder::with_scene("same");
    folder.fails(
        "render scene.toml -o out.png --stats-json scene.toml",
        2,
        "scene.toml: --stats-json would overwrite the scene itself",
    );
    folder.fails("render scene.toml -o out.png --tbuffer ./out.png", 2, "./out.png: --output and --tbuffer name the same file");
    folder.fails("render scene.toml --stats-json a --tbuffer a", 2, "a: --stats-json and --tbuffer name the same file");
    assert_eq!(folder.read("scene.toml"), SCENE.as_bytes());
}

#[test]
fn options_that_contradict_the_scene_or_each_other_are_refused() {
    let folder = Folder::with_scene("options");
    folder.fails(&format!("{RENDER} --accel tree"), 2, "invalid value 'tree' for '--accel <HOW>': it is one of brute, bsp");
    folder.fails(&format!("{RENDER} --size 8x8 --crop 0,0,9,8"), 2, "--crop 0,0,9,8 reaches beyond the picture of 8x8");
    let message = "--tbuffer: an antialiased pixel has no single T-value, use --aa none";
    folder.fails(&format!("{RENDER} --aa 4 --tbuffer t.hits"), 2, message);
    folder.write("soft.toml", &format!("[render]\naa = 4\n{SCENE}"));
    folder.fails("render soft.toml -o out.png --tbuffer t.hits", 2, message);
    folder.fails("pixel scene.toml 8 3 --size 8x8", 2, "pixel 8 3 is outside of the picture of 8x8");
    let message = "a picture of 65535x65535 has more than 268435456 pixels: render it in parts with --crop";
    folder.fails(&format!("{RENDER} --size 65535x65535"), 2, message);
}

#[test]
fn mistakes_on_the_command_line_are_one_line_too() {
    let folder = Folder::new("usage");
    folder.fails("render", 2, "the following required arguments were not provided: <SCENE>");
    folder.fails("rendr a.toml", 2, "unrecognized subcommand 'rendr'; tip: a similar subcommand exists: 'render'");
    folder.fails("render a.toml --sise 8x8", 2, "unexpected argument '--sise' found; tip: a similar argument exists: '--size'");
    folder.fails("render a.toml --depth 33", 2, "invalid value '33' for '--depth <N>': 33 is not in 0..=32");
}

#[test]
fn a_scale_belongs_to_a_heat_map_and_visits_to_a_tree() {
    let folder = Folder::with_scene("heat-usage");
    let why = "--view-max is the end of a scale: use it with --view visits or tests";
    for view in ["", "--view t"] {
        folder.fails(&format!("{RENDER} {view} --view-max 9"), 2, why);
    }
    let why = "--view visits: brute force visits no nodes, --view tests counts the triangles that it looks at";
    folder.fails(&format!("{RENDER} --accel brute --view visits"), 2, why);
    assert_eq!(folder.gz(&format!("{RENDER} --view tests --view-max 0")).code, 2);
    let why = "--view-scale is of colours that stand for counts: use it with --view visits or tests";
    folder.fails(&format!("{RENDER} --view id --view-scale log"), 2, why);
    folder.fails(
        &format!("{RENDER} --view tests --view-level 3"),
        2,
        "--view-level is a level of cells: use it with --view cells",
    );
    folder.fails(&format!("{RENDER} --view cells --accel brute"), 2, "--view cells: brute force has no cells");
}
