use super::super::scratch::{BARE_OBJ, CAMERA, Folder, TRIANGLE_ASC, TRIANGLE_OBJ, message};
use super::super::settings::Overrides;
use super::scene;
use std::path::Path;

/// Lines 1 to 3 are the camera; what `rest` says begins on line 4.
fn says(rest: &str) -> String {
    message(&format!("{CAMERA}{rest}\n"))
}

const MESH: &str = "[[mesh]]\nfile = \"t.obj\"\n";

#[test]
fn each_mistake_in_a_table_is_one_line_with_its_place() {
    let cases = [
        // TOML itself and unknown names.
        ("[render", "s.toml:4: unclosed table, expected `]`"),
        ("[render]\nsize = [1, 2]\nsize = [1, 2]", "s.toml:6: duplicate key"),
        ("[render]\ndepht = 3", "s.toml:5: unknown key \"depht\" (did you mean \"depth\"?)"),
        ("[[light]]\ncolour = 1", "s.toml:5: unknown key \"colour\" (did you mean \"color\"?)"),
        (
            "[[texture]]\nname = \"x\"\nzzzzzz = 1",
            "s.toml:6: unknown key \"zzzzzz\" (known: name, file, lookup, shift, srgb, checker, or)",
        ),
        ("[lights]", "s.toml:4: unknown key \"lights\" (did you mean \"light\"?)"),
        ("[[light]]\ndirection = [0, 0, 1]", "s.toml:4: key \"color\" is missing"),
        // Values of the wrong kind.
        ("[[light]]\ncolor = \"grey\"", "s.toml:5: expected a number or an array of three, found string \"grey\""),
        ("ambient = 1", "s.toml:4: \"ambient\" belongs above the first [table]: here it is a key of that table"),
        ("[render]\ndepth = 1.5", "s.toml:5: expected i64, found floating point 1.5"),
        ("[render]\naa = \"hw7\"", "s.toml:5: expected \"none\", \"hw6\" or a number of samples, found string \"hw7\""),
        ("[render]\naa = 0", "s.toml:5: aa must be 1 to 4096 samples, not 0"),
        ("[render]\nfresnel = \"schlik\"", "s.toml:5: \"schlik\" is not known here (did you mean \"schlick\"?)"),
        ("[render]\nshadow = \"hard\"", "s.toml:5: \"hard\" is not known here (known: tinted, opaque, off)"),
        ("[[light]]\ndirection = [0, 1]\ncolor = 1", "s.toml:5: expected an array of length 3, found 2 elements"),
        ("[[light]]\ndirection = [0, nan, 1]\ncolor = 1", "s.toml:5: NaN is not a finite number in the range of f32"),
        (
            "[[light]]\ndirection = [0, 1e39, 1]\ncolor = 1",
            "s.toml:5: 1000000000000000000000000000000000000000 is not a finite number in the range of f32",
        ),
        // Values out of range.
        ("[render]\nsize = [0, 600]", "s.toml:5: size must be 1 to 65535 pixels each way, not 0 x 600"),
        ("[render]\nsize = [800, 65536]", "s.toml:5: size must be 1 to 65535 pixels each way, not 800 x 65536"),
        ("[render]\ndepth = 33", "s.toml:5: depth must be 0 to 32, not 33"),
        ("[render]\ndepth = -1", "s.toml:5: depth must be 0 to 32, not -1"),
        ("[[light]]\ndirection = [0, 0, 0]\ncolor = 1", "s.toml:5: a light's direction must not be zero"),
        ("[[light]]\ndirection = [0, 1, 0]\ncolor = [1, -0.5, 1]", "s.toml:6: a colour must not be negative: -0.5"),
        ("[[light]]\nposition = [0, 1, 0]\nfalloff = [0, 0, 0]\ncolor = 1", "s.toml:6: a falloff must not be zero throughout"),
        ("[[light]]\nposition = [0, 1, 0]\nfalloff = [1, -1, 0]\ncolor = 1", "s.toml:6: a falloff must not be negative"),
        (
            "[[light]]\ndirection = [0, 1, 0]\nfalloff = [1, 0, 0]\ncolor = 1",
            "s.toml:6: falloff belongs to a light with a position",
        ),
        ("[[light]]\ncolor = 1", "s.toml:4: a light needs a direction or a position"),
        (
            "[[light]]\ndirection = [0, 1, 0]\nposition = [0, 1, 0]\ncolor = 1",
            "s.toml:6: a light has a direction or a position, not both",
        ),
        ("[[material]]\nname = \"m\"\nkind = \"glass\"\nior = 0", "s.toml:7: ior must be 0.01 to 100, not 0"),
        ("[[material]]\nname = \"m\"\nior = 1.5", "s.toml:4: ior belongs to a material of kind mirror or glass"),
        ("[[material]]\nname = \"m\"\npower = -2", "s.toml:6: power must not be negative: -2"),
        ("[[texture]]\nname = \"t\"", "s.toml:4: a texture needs a file or a checker"),
        ("[[texture]]\nname = \"t\"\nchecker = { across = 0, down = 1 }", "s.toml:6: a checker needs across and down above 0"),
        (
            "[[texture]]\nname = \"t\"\nsrgb = true\nchecker = { across = 1, down = 1 }",
            "s.toml:4: lookup, shift, srgb and or belong to a texture with a file",
        ),
        (
            "[[texture]]\nname = \"t\"\nfile = \"a.png\"\nchecker = { across = 1, down = 1 }",
            "s.toml:7: a texture has a file or a checker, not both",
        ),
        // Names.
        ("[[material]]\nname = \"m\"\n[[material]]\nname = \"m\"", "s.toml:7: material \"m\" is defined twice"),
        ("[[material]]\nname = \"m\"\ntexture = \"wood\"", "s.toml:6: texture \"wood\" is not defined"),
        ("[[texture]]\nname = \"t\"\nfile = \"no.png\"", "s.toml:6: no such file: no.png"),
        ("[[mesh]]\nfile = \"no.obj\"", "s.toml:5: no such file: no.obj"),
        ("", "s.toml: no triangles"),
        ("mesh = []", "s.toml:4: unknown key \"mesh\" (known: model, position, look_at, up, fov)"),
    ];
    for (rest, expected) in cases {
        assert_eq!(says(rest), expected, "{rest}");
    }
}

#[test]
fn each_mistake_about_a_mesh_is_one_line_with_its_place() {
    let cases = [
        ("material = \"brass\"", "s.toml:6: material \"brass\" is not defined"),
        ("teapot = { segments = 2 }", "s.toml:4: a mesh has only one of file, teapot, quad and triangles"),
        ("place = [{ scale = 0 }]", "s.toml:6: this step makes the mesh flat: it is singular"),
        ("place = [\n{ rotate_x = 1 },\n{ scale = [1, 1, 0] }]", "s.toml:8: this step makes the mesh flat: it is singular"),
        (
            "place = [{ rotate_x = 1, scale = 1 }]",
            "s.toml:6: a step of place is one of scale, rotate_x, rotate_y, rotate_z, translate and matrix",
        ),
        (
            "place = [{ scale = 1e38 }, { scale = 1e38 }, { scale = 1e38 }]",
            "s.toml:4: the steps of place together leave the range of f64",
        ),
        ("place = [{}]", "s.toml:6: a step of place is one of scale, rotate_x, rotate_y, rotate_z, translate and matrix"),
        (
            "place = [{ turn = 1 }]",
            "s.toml:6: unknown key \"turn\" (known: scale, rotate_x, rotate_y, rotate_z, translate, matrix)",
        ),
        (
            "place = [{ matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]] }]",
            "s.toml:6: the last row of matrix must be 0, 0, 0, 1",
        ),
        ("override = [{ triangle = 1 }]", "s.toml:6: triangle 1 does not exist: the mesh has 1, counted from 0"),
        ("override = [{ triangle = 0 }, { triangle = 0 }]", "s.toml:6: triangle 0 is overridden twice"),
        (
            "override = [{ triangle = 0, normal = [0, 0, 1] }]",
            "s.toml:6: image_vertices and normal need the camera model homework or paper",
        ),
        ("override = [{ triangle = 0, material = \"brass\" }]", "s.toml:6: material \"brass\" is not defined"),
        ("or = { teapot = { segments = 2 } }", "s.toml:6: or stands in for course data: file must begin with hw:"),
    ];
    for (rest, expected) in cases {
        assert_eq!(says(&format!("{MESH}{rest}")), expected, "{rest}");
    }
    let unknown = "[[material]]\nname = \"brass\"\n[[mesh]]\nteapot = { segments = 1 }\nmaterial = \"bras\"";
    assert_eq!(says(unknown), "s.toml:8: material \"bras\" is not defined (did you mean \"brass\"?)");
    let colour = "[[material]]\nname = \"m\"\nsurface = \"app_color\"\n[[mesh]]\nfile = \"t.obj\"\nmaterial = \"m\"";
    assert_eq!(says(colour), "s.toml:7: material \"m\" shows the application's colour: the mesh needs app_color");
    assert_eq!(says("[[mesh]]"), "s.toml:4: a mesh needs file, teapot, quad or triangles");
    for segments in [0, 401, -3] {
        let expected = format!("s.toml:5: segments must be 1 to 400, not {segments}");
        assert_eq!(says(&format!("[[mesh]]\nteapot = {{ segments = {segments} }}")), expected);
    }
    assert_eq!(says("[[mesh]]\nfile = \"s.toml\""), "s.toml:5: \"s.toml\" is not a mesh that can be read: .obj and .asc can");
}

#[test]
fn each_mistake_about_the_camera_is_one_line_with_its_place() {
    let view = |rest: &str| format!("ambient = 1\n[camera]\n{rest}\n");
    let cases = [
        (String::new(), "s.toml: the scene has no [camera]"),
        (view("look_at = [0, 0, 0]"), "s.toml:2: the camera has no position"),
        (view("position = [0, 0, 0]"), "s.toml:2: the camera has no look_at"),
        (view("model = \"homework\""), "s.toml:2: the camera has no position"),
        (
            view("model = \"orthographic\""),
            "s.toml:3: \"orthographic\" is not known here (known: pinhole, homework, paper, screen)",
        ),
        (view("position = [1, 1, 1]\nlook_at = [1, 1, 1]"), "s.toml:2: camera position and look_at are the same point"),
        (view("position = [0, 9, 0]\nlook_at = [0, 0, 0]"), "s.toml:2: camera up is zero or parallel to the viewing direction"),
        (
            view("position = [0, 0, 9]\nlook_at = [0, 0, 0]\n\nfov = 180"),
            "s.toml:6: camera fov must lie between 0 and 180 degrees",
        ),
    ];
    for (toml, expected) in cases {
        assert_eq!(message(&toml), expected, "{toml}");
    }
    let point_light = "[camera]\nmodel = \"screen\"\n[[light]]\nposition = [0, 0, 1]\ncolor = 1\n";
    let why = "a light with a position does not work under the screen camera: what it sees has no place in the world";
    assert_eq!(message(point_light), format!("s.toml:4: {why}"));
}

#[test]
fn files_that_are_no_scenes_are_told_apart() {
    let folder = Folder::new().with("a.stl", "").with("bad.toml", b"a = 1\nb = \xff\n".as_slice()).with("empty.asc", "\r");
    let says = |name| folder.read(name, &Overrides::default()).unwrap_err();
    assert_eq!(says("a.stl"), "a.stl: a scene is a .toml, .obj or .asc file");
    assert_eq!(says("none"), "none: a scene is a .toml, .obj or .asc file");
    assert_eq!(says("none.toml"), "none.toml: no such file");
    assert_eq!(says("none.obj"), "none.obj: no such file");
    assert_eq!(says("bad.toml"), "bad.toml:2: not UTF-8 text");
    assert_eq!(says("empty.asc"), "empty.asc: no triangles");
    let missing = scene(&folder.path().join("none.toml"), &Overrides::default()).unwrap_err();
    let refused = scene(&folder.path().join("a.stl"), &Overrides::default()).unwrap_err();
    assert_eq!((missing.io, refused.io), (true, false));
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_do_not_move_lines() {
    let toml = format!("\u{feff}{}[render]\r\ndepth = 99\r\n", CAMERA.replace('\n', "\r\n"));
    assert_eq!(message(&toml), "s.toml:5: depth must be 0 to 32, not 99");
}

#[test]
fn overrides_out_of_range_are_refused_too() {
    let folder = Folder::new().with("t.obj", TRIANGLE_OBJ).with("s.toml", format!("{CAMERA}{MESH}"));
    for scene in ["s.toml", "t.obj"] {
        let says = |overrides: Overrides| folder.read(scene, &overrides).unwrap_err();
        let none = Overrides::default();
        assert_eq!(says(Overrides { depth: Some(40), ..none }), format!("{scene}: depth must be 0 to 32, not 40"));
        let size = format!("{scene}: picture width and height must be 1 to 65535");
        assert_eq!(says(Overrides { size: Some((0, 5)), ..none }), size);
        assert_eq!(says(Overrides { size: Some((5, 70_000)), ..none }), size);
    }
}

const COURSE_SCENE: &str = "[[mesh]]\nfile = \"hw:pot.asc\"\n";

#[test]
fn absent_course_data_says_how_to_get_it() {
    let folder = Folder::new().with("s.toml", format!("{CAMERA}{COURSE_SCENE}"));
    let none = Overrides::default();
    let unset = folder.read("s.toml", &none).unwrap_err();
    assert_eq!(unset, "s.toml:5: \"hw:pot.asc\" is course data: set GZ_HW_DATA to the folder of course data");
    let course = Folder::new().with("pot.asc", TRIANGLE_ASC);
    assert!(folder.read_with_course("s.toml", &none, Some(course.path())).is_ok());
    let elsewhere = folder.read_with_course("s.toml", &none, Some(folder.path())).unwrap_err();
    assert_eq!(elsewhere, "s.toml:5: no such file: pot.asc (GZ_HW_DATA must be the folder of course data)");
    let error = super::scene_with(&folder.path().join("s.toml"), &none, None).unwrap_err();
    assert!(!error.io, "absent course data is a scene that cannot be used, exit code 3");
}

#[test]
fn a_stand_in_takes_over_place_and_material_and_only_when_course_data_is_absent() {
    let toml = format!(
        "{CAMERA}[[material]]\nname = \"m\"\n[[mesh]]\nfile = \"hw:pot.asc\"\nmaterial = \"m\"\nplace = [{{ scale = 2 }}]\n\
         override = [{{ triangle = 0, material = \"m\" }}]\nor = [{{ file = \"t.obj\" }}, {{ file = \"t.obj\", place = [] }}]\n"
    );
    let folder = Folder::new().with("s.toml", &toml).with("t.obj", TRIANGLE_OBJ).with("pot.asc", TRIANGLE_ASC);
    let none = Overrides::default();
    let stood_in = folder.read("s.toml", &none).unwrap();
    let warning = "s.toml:7: \"hw:pot.asc\" is course data: set GZ_HW_DATA to the folder of course data; its stand-in is used";
    assert_eq!(
        stood_in.warnings.iter().map(|w| folder.short(w)).collect::<Vec<_>>(),
        [warning, "s.toml: there is no light, and no ambient light either"]
    );
    assert_eq!((stood_in.triangles(), stood_in.scene.materials.len()), (2, 1));
    let scene = stood_in.place(gz_shade::SceneNeeds::ALL).unwrap();
    assert_eq!([scene.tris.position(0)[0].x, scene.tris.position(1)[0].x], [2.0, 1.0]);
    let course = folder.read_with_course("s.toml", &none, Some(folder.path())).unwrap();
    assert_eq!((course.triangles(), course.warnings.len()), (1, 1));

    let nested = toml.replace("{ file = \"t.obj\" }", "{ file = \"hw:a.asc\", or = { file = \"t.obj\" } }");
    let folder = folder.with("s.toml", nested);
    assert_eq!(folder.read("s.toml", &none).unwrap_err(), "s.toml:11: a stand-in cannot have one itself");
}

#[test]
fn bare_meshes_are_scenes() {
    let folder = Folder::new().with("a.OBJ", BARE_OBJ).with("b.asc", TRIANGLE_ASC);
    for name in ["a.OBJ", "b.asc"] {
        let draft = folder.read(name, &Overrides::default()).unwrap();
        assert_eq!((draft.scene.lights.len(), draft.triangles(), draft.warnings.len()), (3, 1, 0), "{name}");
        assert_eq!((draft.scene.camera.width(), draft.scene.camera.height()), (800, 600));
        assert_eq!(draft.scene.used, [1]);
    }
    assert!(scene(Path::new("nowhere.asc"), &Overrides::default()).unwrap_err().io);
}
