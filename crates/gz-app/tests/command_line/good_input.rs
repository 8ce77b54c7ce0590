//! `gz` as a user runs it: files written, figures printed, exit codes.

use crate::folder::{Folder, SCENE};
use image::RgbImage;
use serde_json::Value;

fn picture(folder: &Folder, name: &str) -> RgbImage {
    image::load_from_memory(&folder.read(name)).unwrap_or_else(|error| panic!("{name}: {error}")).to_rgb8()
}

#[test]
fn without_a_command_the_help_is_printed() {
    let folder = Folder::new("help");
    let ended = folder.done("");
    assert!(ended.out.contains("Usage: gz") && ended.out.contains("Exit codes:"), "{}", ended.out);
    assert_eq!(folder.done("--version").out, format!("gz {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_render_leaves_its_picture_and_nothing_else() {
    let folder = Folder::with_scene("plain");
    let ended = folder.done("render scene.toml --size 40x30");
    assert_eq!(folder.names(), ["scene.png", "scene.toml"]);
    assert_eq!(picture(&folder, "scene.png").dimensions(), (40, 30));
    assert!(ended.err.starts_with("scene.png: 40x30, ") && ended.err.lines().count() == 1, "{}", ended.err);
    assert!(ended.out.is_empty());
}

#[test]
fn threads_and_tiles_do_not_show_and_a_crop_is_that_part() {
    let folder = Folder::with_scene("threads");
    folder.done("render scene.toml -o a.ppm --size 70x50 --threads 1 --tile 64");
    for options in ["--threads 2 --tile 8", "--threads 7 --tile 64", "--threads 7 --tile 1"] {
        folder.done(&format!("render scene.toml -o b.ppm --size 70x50 {options}"));
        assert!(folder.read("a.ppm") == folder.read("b.ppm"), "{options}");
    }
    folder.done("render scene.toml -o crop.png --size 70x50 --crop 20,10,61,33");
    let whole = picture(&folder, "a.ppm");
    let part = image::imageops::crop_imm(&whole, 20, 10, 41, 23).to_image();
    assert!(picture(&folder, "crop.png") == part);
    assert!(part.pixels().any(|p| p != part.get_pixel(0, 0)), "the part shows something");
}

#[test]
fn a_crop_is_that_part_in_every_view_of_every_camera() {
    let folder = Folder::with_scene("view-crop");
    for camera in ["pinhole", "homework", "paper", "screen"] {
        for view in ["t", "id", "normal", "visits --view-max 30", "tests --view-max 200", "cells"] {
            let options = format!("--camera {camera} --size 48x48 --view {view} --progress none");
            folder.done(&format!("render scene.toml -o whole.png {options}"));
            folder.done(&format!("render scene.toml -o part.png {options} --crop 18,20,30,41"));
            let part = image::imageops::crop_imm(&picture(&folder, "whole.png"), 18, 20, 12, 21).to_image();
            assert!(picture(&folder, "part.png") == part, "{camera} {view}");
            assert!(part.pixels().any(|p| p != part.get_pixel(0, 0)), "{camera} {view}: the part shows something");
        }
    }
}

#[test]
fn one_sample_has_a_t_value() {
    let folder = Folder::with_scene("one-sample");
    folder.done("render scene.toml -o a.png --size 32x24 --tbuffer none.hits");
    folder.done("render scene.toml -o b.png --size 32x24 --tbuffer one.hits --aa 1");
    folder.write("one.toml", &format!("[render]\naa = 1\n{SCENE}"));
    folder.done("render one.toml -o c.png --size 32x24 --tbuffer scene.hits");
    assert!(folder.read("none.hits") == folder.read("one.hits") && folder.read("none.hits") == folder.read("scene.hits"));
    assert!(folder.read("a.png") == folder.read("b.png"));
}

#[test]
fn all_formats_hold_the_same_picture() {
    let folder = Folder::with_scene("formats");
    for name in ["a.png", "a.ppm", "a.pfm"] {
        folder.done(&format!("render scene.toml -o {name} --size 24x16 --progress none"));
    }
    assert_eq!(picture(&folder, "a.png"), picture(&folder, "a.ppm"));
    let (width, height, colors) = gz_app::pfm::decode(&folder.read("a.pfm")).unwrap();
    assert_eq!(gz_app::output::rgb8(&colors, gz_shade::ColorCode::Srgb), picture(&folder, "a.png").into_raw());
    assert_eq!((width, height), (24, 16));
}

#[test]
fn a_t_buffer_has_a_hit_for_each_pixel_and_follows_the_crop() {
    let folder = Folder::with_scene("tbuffer");
    folder.done("render scene.toml -o a.png --size 32x24 --tbuffer whole.hits");
    folder.done("render scene.toml -o b.png --size 32x24 --tbuffer part.hits --crop 4,3,30,20 --tile 5");
    let (whole, part) = (folder.read("whole.hits"), folder.read("part.hits"));
    assert_eq!((whole.len(), part.len()), (32 * 24 * 16, 26 * 17 * 16));
    for row in 0..17 {
        assert!(part[row * 26 * 16..][..26 * 16] == whole[((row + 3) * 32 + 4) * 16..][..26 * 16], "row {row}");
    }
    let hits = gz_app::hits_file::decode(&whole).unwrap();
    assert!(hits.iter().any(|hit| hit.is_hit()) && hits.iter().any(|hit| !hit.is_hit()));
}

#[test]
fn views_differ_from_the_picture_and_from_each_other() {
    let folder = Folder::with_scene("views");
    folder.done("render scene.toml -o colour.ppm --size 32x24");
    for view in ["t", "id", "normal"] {
        folder.done(&format!("render scene.toml -o {view}.ppm --size 32x24 --view {view}"));
    }
    let files = ["colour", "t", "id", "normal"].map(|name| folder.read(&format!("{name}.ppm")));
    for (i, a) in files.iter().enumerate() {
        assert!(files[..i].iter().all(|b| a != b), "view {i}");
    }
}

#[test]
fn heat_maps_tell_their_range_and_share_a_scale() {
    let folder = Folder::with_scene("heat");
    // `nodes and leaves entered: 3 to 71, mean 20.4; ...`
    let most = |out: &str| -> u64 { out.split(" to ").nth(1).unwrap().split(',').next().unwrap().parse().unwrap() };
    for (view, accel) in
        [("visits", "--split sah"), ("visits", "--split midpoint"), ("tests", "--split sah"), ("tests", "--split midpoint")]
    {
        let line = format!("render scene.toml -o own.png --size 32x24 --progress none --view {view} {accel}");
        let out = folder.done(&line).out;
        let full = most(&out);
        assert!(full > 0 && out.lines().count() == 1 && out.contains(&format!("to {full}, light yellow\n")), "{out}");
        assert_eq!(out, folder.done(&format!("{line} --threads 1 --tile 5")).out);
        // The same scale by its number is the same picture; a longer one is darker; a shorter one is told.
        let same = folder.read("own.png");
        folder.done(&format!("{line} --view-max {full}"));
        assert!(folder.read("own.png") == same, "{line}");
        folder.done(&format!("{line} --view-max {}", 4 * full));
        let brightest = picture(&folder, "own.png").pixels().map(|p| p.0[0]).max().unwrap();
        assert!(brightest < 128, "{line}: {brightest}");
        assert!(folder.done(&format!("{line} --view-max 1")).out.contains(" pixels are above that\n"));
    }
    let log = folder.done("render scene.toml -o log.png --size 32x24 --view tests --view-max 576 --view-scale log").out;
    assert!(log.contains("; colours by the logarithm from 0, dark blue, to 576"), "{log}");
    // Every triangle for every ray: 64 segments^2 with the bottom.
    let out = folder.done("render scene.toml -o brute.png --size 32x24 --accel brute --view tests").out;
    assert!(out.starts_with("triangles looked at: 576 to 576, mean 576.00; colours from 0, dark blue, to 576"), "{out}");
}

#[test]
fn cells_are_drawn_over_the_picture() {
    let folder = Folder::with_scene("cells");
    folder.done("render scene.toml -o plain.png --size 64x48");
    let plain = picture(&folder, "plain.png");
    // How many there are to draw: leaves as `gz info --tree` counts them, and levels of a binary tree.
    for (accel, level, drawn) in [
        ("--split midpoint --max-depth 3 --min-size 0", "", "8 leaves drawn\n"),
        ("--split midpoint --max-depth 3 --min-size 0", "--view-level 1", "1 cells of level 1 and leaves above it drawn\n"),
        ("--split midpoint --max-depth 3 --min-size 0", "--view-level 3", "4 cells of level 3 and leaves above it drawn\n"),
        ("--split sah", "--view-level 1", "8 cells of level 1 and leaves above it drawn\n"),
    ] {
        let out = folder.done(&format!("render scene.toml -o cells.png --size 64x48 --view cells {accel} {level}")).out;
        assert_eq!(out, drawn, "{accel} {level}");
        let cells = picture(&folder, "cells.png");
        let lighter = cells.pixels().zip(plain.pixels()).filter(|(a, b)| a.0.iter().zip(b.0).any(|(&a, b)| a > b)).count();
        assert!((40..1500).contains(&lighter), "{accel} {level}: {lighter} pixels are lighter, under lines");
    }
    let tree = folder.done("info scene.toml --tree").out;
    let out = folder.done("render scene.toml -o cells.png --size 64x48 --view cells").out;
    let leaves = out.split(' ').next().unwrap();
    assert!(tree.contains(&format!("  leaves     {leaves}, 0 empty")), "{out}{tree}");
}

#[test]
fn statistics_count_what_was_done() {
    let folder = Folder::with_scene("stats");
    folder.done("render scene.toml -o a.png --size 32x24 --crop 0,0,32,12 --stats-json s.json --threads 2 --tile 7");
    let stats: Value = serde_json::from_slice(&folder.read("s.json")).unwrap();
    assert_eq!(stats["rays"]["primary"], 32 * 12);
    assert_eq!(stats["size"], serde_json::json!([32, 24]));
    assert_eq!(stats["crop"], serde_json::json!([0, 0, 32, 12]));
    assert_eq!(stats["counters"]["nan_pixels"], 0);
    assert_eq!((&stats["settings"]["threads"], &stats["settings"]["tile"]), (&Value::from(2), &Value::from(7)));
    let triangles = stats["triangles"].as_u64().unwrap();
    assert_eq!(stats["bytes"]["triangles"].as_u64().unwrap(), triangles * stats["bytes"]["per_triangle"].as_u64().unwrap());
    let seconds = stats["seconds"].as_object().unwrap();
    let phases: f64 = seconds.iter().filter(|(name, _)| *name != "total").map(|(_, s)| s.as_f64().unwrap()).sum();
    assert!((phases - seconds["total"].as_f64().unwrap()).abs() < 1e-9);
}

#[test]
fn progress_is_plain_or_json_or_silent() {
    let folder = Folder::with_scene("progress");
    let plain = folder.done("render scene.toml --size 32x32 --tile 8 --progress plain").err;
    assert!(plain.lines().next().is_some_and(|line| line.trim_start().starts_with("10%")), "{plain}");
    assert!(plain.lines().any(|line| line.trim_start().starts_with("100%")), "{plain}");
    let json = folder.done("render scene.toml --size 32x32 --tile 8 --progress json").err;
    let events: Vec<Value> = json.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect();
    assert_eq!(events.last().unwrap()["event"], "done");
    assert_eq!(events[events.len() - 2]["percent"], 100);
    assert_eq!(folder.done("render scene.toml --size 32x32 --progress none").err, "");
    assert_eq!(folder.done("render scene.toml --size 32x32").err.lines().count(), 1);
}

#[test]
fn explain_tells_needs_and_rays() {
    let folder = Folder::with_scene("explain");
    let out = folder.done("render scene.toml --size 16x16 --explain").out;
    assert!(out.lines().any(|line| line.trim_start().starts_with("shadows") && line.contains("yes")), "{out}");
    assert!(out.lines().any(|line| line.trim_start().starts_with("glass") && line.ends_with("no")), "{out}");
    assert!(out.contains("primary 256, shadow"), "{out}");
}

#[test]
fn comparing_ends_with_4_beyond_the_tolerance_and_draws_a_sheet() {
    let folder = Folder::with_scene("compare");
    folder.done("render scene.toml -o a.png --size 24x16 --tbuffer a.hits");
    folder.done("render scene.toml -o b.png --size 24x16 --tbuffer b.hits --kernel plane --fresnel schlick");
    folder.done("render scene.toml -o c.png --size 24x16 --view normal");
    assert!(folder.done("compare a.png a.png").out.contains("differing         0 "));
    folder.done("compare a.hits a.hits --size 24x16");
    let ended = folder.gz("compare a.png c.png --sheet sheet.png");
    assert_eq!(ended.code, 4, "{}", ended.out);
    assert!(ended.err.starts_with("gz: a.png and c.png differ in ") && ended.err.lines().count() == 1, "{}", ended.err);
    assert_eq!(picture(&folder, "sheet.png").dimensions(), (3 * 24 + 8, 16));
    folder.done("compare a.png c.png --tolerance 255");
    // The plain kernel finds the same triangles here; its T-values may differ in the last bits.
    folder.done("compare a.hits b.hits --tolerance 1e-5");
    assert_eq!(folder.gz("compare a.png a.hits").code, 2);
    assert_eq!(folder.gz("compare a.png none.png").code, 1);
}

#[test]
fn other_ways_to_leave_a_surface_are_for_comparison() {
    let folder = Folder::with_scene("leave");
    folder.done("render scene.toml -o a.ppm --size 24x16");
    folder.done("render scene.toml -o exact.ppm --size 24x16 --leave exact --stats-json s.json");
    folder.done("compare a.ppm exact.ppm");
    let stats = std::fs::read_to_string(folder.path().join("s.json")).unwrap();
    assert!(stats.contains("\"leave\": \"exact\""), "{stats}");
    for policy in ["identity", "epsilon", "epsilon=0.001", "waechter-binder", "error-bound"] {
        folder.done(&format!("render scene.toml -o b.ppm --size 24x16 --leave {policy}"));
        assert_eq!(picture(&folder, "b.ppm").dimensions(), (24, 16));
    }
    // Half of the shadow rays that start at the bare f32 point meet the surface that they leave.
    folder.done("render scene.toml -o b.ppm --size 24x16 --leave bare");
    assert_eq!(folder.gz("compare a.ppm b.ppm").code, 4);
    assert_eq!(folder.gz("render scene.toml -o b.ppm --leave always").code, 2);
}

#[test]
fn the_tree_of_a_render_is_shown_on_request() {
    let folder = Folder::with_scene("tree");
    assert!(!folder.done("info scene.toml").out.contains("random lines"));
    for (options, words) in [("", "groups of triangles"), ("--split midpoint --max-depth 6", "triangles tested")] {
        let out = folder.done(&format!("info scene.toml --tree {options}")).out;
        assert!(out.contains(words) && out.contains("of 10000 random lines through the scene's box (seed 1)"), "{out}");
        assert_eq!(out, folder.done(&format!("info scene.toml --tree --threads 1 {options}")).out, "the same each time");
    }
    folder.fails("info scene.toml --tree --accel brute", 2, "--tree: brute force has no tree");
}

#[test]
fn a_pixel_and_a_scene_are_explained() {
    let folder = Folder::with_scene("pixel");
    let out = folder.done("pixel scene.toml 16 14 --size 32x24 --compare brute").out;
    assert!(out.contains("hit        triangle ") && out.contains("primary ray from"), "{out}");
    for part in ["visited    ", " tests in f64", "ambient adds [", "light 0 adds [", "own colour ["] {
        assert!(out.contains(part), "{part} in {out}");
    }
    for part in ["compare    brute has the same triangle, T, u and v, to the bit\n", "walk       ", ", of the pixel [1, 1, 1]\n"]
    {
        assert!(out.contains(part), "{part} in {out}");
    }
    assert!(folder.done("pixel scene.toml 0 0 --size 32x24 --kernel plane --compare brute").out.contains("hit        nothing"));
    let out = folder.done("info scene.toml --size 32x24").out;
    assert!(out.contains("picture    32x24, camera pinhole\n") && out.contains("lights     1\n"), "{out}");
}

#[test]
fn a_pixel_tells_its_walk_by_each_way_to_answer() {
    let folder = Folder::with_scene("pixel-walk");
    let told = |options: &str| folder.done(&format!("pixel scene.toml 16 14 --size 32x24 {options}")).out;
    for options in ["", "--split midpoint", "--split midpoint --max-depth 2"] {
        let out = told(options);
        // The walk is told as it is counted.
        let walk: Vec<&str> = out.lines().skip_while(|line| !line.starts_with("walk ")).skip(1).collect();
        let steps = walk.iter().take_while(|line| line.starts_with("  ")).filter(|line| !line.starts_with("    "));
        let (leaves, nodes): (Vec<&&str>, Vec<&&str>) = steps.partition(|line| line.starts_with("  leaf"));
        assert!(out.contains(&format!("visited    {} nodes, {} leaves", nodes.len(), leaves.len())), "{options}: {out}");
        // What is hit first was found on it, and the first rung differs: the paper's walk has no f32.
        let hit = out.lines().find_map(|line| line.strip_prefix("hit        triangle ")).unwrap().split(' ').next().unwrap();
        assert!(walk.iter().any(|line| line.starts_with(&format!("    triangle {hit} hit at T = "))), "{options}: {out}");
        assert_eq!(out.contains("by f32"), options.is_empty(), "{options}: {out}");
    }
    let brute = told("--accel brute");
    assert!(brute.contains("visited    576 triangles") && brute.contains("tested     ") && !brute.contains("walk "), "{brute}");
    assert!(told("--kernel woop").contains(" missed\n    triangle "), "a rounded test proves nothing");
}

#[test]
fn a_pixel_is_told_to_programs_too() {
    let folder = Folder::with_scene("pixel-json");
    let told = |options: &str| -> Value {
        serde_json::from_str(&folder.done(&format!("pixel scene.toml 16 14 --size 32x24 --json {options}")).out).unwrap()
    };
    let (pixel, brute) = (told("--compare brute"), told("--accel brute"));
    assert_eq!((&pixel["hit"], &pixel["compare"]["same_bits"]), (&brute["hit"], &Value::Bool(true)));
    assert_eq!((&pixel["on_ray"], &pixel["color"], &pixel["bytes"]), (&brute["on_ray"], &brute["color"], &brute["bytes"]));
    assert_eq!(pixel["on_ray"][0], pixel["hit"]);
    let (walk, visits) = (pixel["walk"].as_array().unwrap(), &pixel["visits"]);
    assert_eq!(walk.len() as u64, visits["nodes"].as_u64().unwrap() + visits["leaves"].as_u64().unwrap());
    assert_eq!((brute["tested"].as_array().unwrap().len(), brute["walk"].as_array().unwrap().len()), (576, 0));
    // One ray, its parts sum to its colour.
    let node = &pixel["rays"][0];
    assert_eq!(
        (&node["kind"], &node["parent"], &node["share"]),
        (&Value::from("primary"), &Value::Null, &serde_json::json!([1.0, 1.0, 1.0]))
    );
    let sum = |k: usize| node["ambient"][k].as_f64().unwrap() + node["lights"][0]["color"][k].as_f64().unwrap();
    assert!((0..3).all(|k| (sum(k) - node["local"][k].as_f64().unwrap()).abs() < 1e-6), "{node}");
    // The pixel that is written.
    folder.done("render scene.toml -o a.png --size 32x24");
    let pixel_written = picture(&folder, "a.png").get_pixel(16, 14).0;
    assert_eq!(pixel["bytes"], serde_json::json!(pixel_written));
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = Folder::with_scene("pipe");
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_gz"))
        .args(["info", "scene.toml"])
        .current_dir(folder.path())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("gz can be started");
    drop(child.stdout.take());
    let ended = child.wait_with_output().expect("gz ends by itself");
    assert_eq!((ended.status.code(), ended.stderr.as_slice()), (Some(0), &b""[..]));
}
