//! What scene keys mean, key by key.

use super::Overrides;
use super::scratch::{CAMERA, COURSE_CAMERA, Folder, draft, draft_with, folder};
use glam::DVec3;
use gz_core::{CameraModel, GzColor, LeavePolicy, TriClass};
use gz_shade::{
    Antialias, Background, ColorCode, Eye, Falloff, Fresnel, GlassBlend, Interpolate, LightKind, MaterialKind, MirrorBlend,
    Procedural, SceneNeeds, ShadeRules, ShadowRule, Surface, Texture, TextureLookup,
};

const MESH: &str = "[[mesh]]\nfile = \"t.obj\"\n";

fn rules(render: &str) -> ShadeRules {
    draft(&format!("[render]\n{render}\n{CAMERA}{MESH}")).scene.rules
}

#[test]
fn the_camera_model_sets_the_mode_and_the_mode_sets_the_rules() {
    let with = |model: &str, render: &str| {
        draft(&format!("[render]\n{render}\n[camera]\nmodel = \"{model}\"\n{COURSE_CAMERA}{MESH}")).scene.rules
    };
    assert_eq!(with("pinhole", ""), ShadeRules::PHYSICAL);
    assert_eq!(with("homework", ""), ShadeRules::HOMEWORK);
    assert_eq!(with("screen", ""), ShadeRules::HOMEWORK);
    assert_eq!(with("paper", ""), ShadeRules::PAPER);
    assert_eq!(with("paper", "mode = \"physical\""), ShadeRules::PHYSICAL);
}

#[test]
fn each_render_key_changes_its_rule_and_no_other() {
    let base = ShadeRules::PHYSICAL;
    let cases = [
        ("depth = 0", ShadeRules { depth: 0, ..base }),
        ("depth = 32", ShadeRules { depth: 32, ..base }),
        ("aa = \"none\"", base),
        ("aa = \"hw6\"", ShadeRules { antialias: Antialias::Hw6, ..base }),
        ("aa = 16", ShadeRules { antialias: Antialias::Samples(16), ..base }),
        ("fresnel = \"schlick\"", ShadeRules { fresnel: Fresnel::Schlick, ..base }),
        ("shadow = \"off\"", ShadeRules { shadow: ShadowRule::Off, ..base }),
        ("eye = \"fixed\"", ShadeRules { eye: Eye::Fixed, ..base }),
        ("mirror_blend = \"add\"", ShadeRules { mirror_blend: MirrorBlend::Add, ..base }),
        ("glass_blend = \"add\"", ShadeRules { glass_blend: GlassBlend::Add, ..base }),
        ("reflect_last_light = true", ShadeRules { reflect_last_light: true, ..base }),
        ("clamp_levels = true", ShadeRules { clamp_levels: true, ..base }),
        ("screen_interpolation = true", ShadeRules { screen_interpolation: true, ..base }),
        ("geometric_sides = false", ShadeRules { geometric_sides: false, ..base }),
        ("flat_textures = false", ShadeRules { flat_textures: false, ..base }),
        ("color_code = \"course12\"", ShadeRules { color_code: ColorCode::Course12, ..base }),
        ("mode = \"homework\"\nshadow = \"opaque\"", ShadeRules { shadow: ShadowRule::Opaque, ..ShadeRules::HOMEWORK }),
    ];
    for (key, expected) in cases {
        assert_eq!(rules(key), expected, "{key}");
    }
}

#[test]
fn overrides_win_over_the_scene() {
    let toml = format!("[render]\nsize = [10, 20]\ndepth = 1\naa = 4\n{CAMERA}{MESH}");
    let scene = draft(&toml).scene;
    assert_eq!((scene.camera.width(), scene.camera.height(), scene.rules.depth), (10, 20, 1));
    let overrides = Overrides {
        size: Some((30, 40)),
        camera: Some(CameraModel::Paper),
        depth: Some(7),
        aa: Some(Antialias::None),
        fresnel: Some(Fresnel::Schlick),
        leave: Some(LeavePolicy::Bare),
    };
    let scene = draft_with(&toml, &overrides).scene;
    assert_eq!((scene.camera.width(), scene.camera.height(), scene.camera.model()), (30, 40, CameraModel::Paper));
    // The mode stays the one of the scene's own camera.
    assert_eq!(scene.rules, ShadeRules { depth: 7, fresnel: Fresnel::Schlick, leave: LeavePolicy::Bare, ..ShadeRules::PHYSICAL });
}

#[test]
fn sizes_and_views_have_defaults() {
    let camera = draft(&format!("{CAMERA}{MESH}")).scene.camera;
    let view = camera.spec().view.unwrap();
    assert_eq!((camera.width(), camera.height(), view.up, view.fov), (800, 600, DVec3::Y, 35.0));
    let screen = draft(&format!("[camera]\nmodel = \"screen\"\n{MESH}")).scene.camera;
    assert_eq!((screen.width(), screen.height(), screen.spec().view), (256, 256, None));
}

#[test]
fn backgrounds_and_ambient_take_their_forms() {
    let of = |top: &str| draft(&format!("{top}\n{CAMERA}{MESH}")).scene;
    assert_eq!(of("").background, Background::Plain(GzColor::ZERO));
    assert_eq!(of("background = 0.5").background, Background::Plain(GzColor::splat(0.5)));
    assert_eq!(of("background = 1").background, Background::Plain(GzColor::ONE));
    assert_eq!(of("background = [1, 0, 0.25]").background, Background::Plain(GzColor::new(1.0, 0.0, 0.25)));
    let gradient = Background::Gradient { bottom: GzColor::new(1.0, 0.0, 0.0), top: GzColor::splat(0.5) };
    assert_eq!(of("background = [[1, 0, 0], [0.5, 0.5, 0.5]]").background, gradient);
    assert_eq!(of("background = [[1, 0, 0], 0.5]").background, gradient);
    assert_eq!(of("background = { bottom = [1, 0, 0], top = 0.5 }").background, gradient);
    assert_eq!((of("").ambient, of("ambient = [0.1, 0.2, 0.3]").ambient), (GzColor::ZERO, GzColor::new(0.1, 0.2, 0.3)));
}

fn light(model: &str, keys: &str) -> LightKind {
    draft(&format!("[camera]\nmodel = \"{model}\"\n{COURSE_CAMERA}[[light]]\ncolor = 1\n{keys}\n{MESH}")).scene.lights[0].kind
}

fn close(a: DVec3, b: [f64; 3]) -> bool {
    (a - DVec3::from_array(b)).length() < 1e-5
}

#[test]
fn directions_are_kept_in_image_space_and_made_unit_in_world_space() {
    let as_given = DVec3::new(0.0, -0.7, -0.7);
    for model in ["homework", "paper", "screen"] {
        assert_eq!(light(model, "direction = [0, -0.7, -0.7]"), LightKind::Directional(as_given), "{model}");
    }
    let unit = light("pinhole", "direction = [0, -3, 0]");
    assert_eq!(unit, LightKind::Directional(DVec3::NEG_Y));
    // World z in the camera's axes is the third column of Xiw.
    let LightKind::Directional(d) = light("homework", "direction = [0, 0, 2]\nspace = \"world\"") else { panic!("a direction") };
    assert!(close(d, [-0.830092, -0.432094, 0.352480]), "{d}");
}

#[test]
fn image_space_means_the_same_under_a_pinhole_camera() {
    // The image's x axis in world space is the first row of Xiw, whichever way the pinhole camera's own x axis points.
    let LightKind::Directional(d) = light("pinhole", "direction = [2, 0, 0]\nspace = \"image\"") else { panic!("a direction") };
    assert!(close(d, [2.0 * 0.546798, 2.0 * 0.109360, 2.0 * -0.830092]), "{d}");
    let LightKind::Point { position, .. } = light("pinhole", "position = [0, 0, 10]\nspace = \"image\"") else {
        panic!("a point")
    };
    assert!(close(position, [-3.0 + 3.62551, -25.0 + 8.62737, -4.0 + 3.52480]), "{position}");
    // The same scene under another camera keeps its lights where they were.
    let toml = format!("[camera]\nmodel = \"homework\"\n{COURSE_CAMERA}[[light]]\ncolor = 1\ndirection = [2, 0, 0]\n{MESH}");
    let pinhole = Overrides { camera: Some(CameraModel::Pinhole), ..Overrides::default() };
    assert_eq!(draft_with(&toml, &pinhole).scene.lights[0].kind, LightKind::Directional(d));
}

#[test]
fn point_lights_have_a_place_and_a_falloff() {
    let point = light("pinhole", "position = [1, 2, 3]");
    assert_eq!(point, LightKind::Point { position: DVec3::new(1.0, 2.0, 3.0), falloff: Falloff::NONE });
    let LightKind::Point { position, falloff } =
        light("homework", "position = [-3, -25, -4]\nspace = \"world\"\nfalloff = [0, 0.5, 2]")
    else {
        panic!("a point")
    };
    // The camera stands at the origin of image space.
    assert!(close(position, [0.0; 3]), "{position}");
    assert_eq!(falloff, Falloff { c0: 0.0, c1: 0.5, c2: 2.0 });
}

#[test]
fn material_keys_fill_the_material() {
    let keys = "ka = 0.5\nkd = [1, 2, 3]\nks = 0\npower = 7.5\nkind = \"glass\"\nior = 1.25\ntint = [0.5, 1, 1]\ntexture = \"t\"\n\
        interpolate = \"gouraud\"\nsurface = \"shaded\"";
    let texture = "[[texture]]\nname = \"t\"\nchecker = { across = 4, down = 2.5, colors = [[1, 0, 0], 0.5] }\n";
    let toml = format!("{CAMERA}{texture}[[material]]\nname = \"m\"\n{keys}\n{MESH}material = \"m\"\n");
    let draft = draft(&toml);
    let m = &draft.scene.materials[0];
    assert_eq!((m.name.as_str(), m.ka, m.kd, m.ks), ("m", GzColor::splat(0.5), GzColor::new(1.0, 2.0, 3.0), GzColor::ZERO));
    assert_eq!((m.power, m.kind, m.tint), (7.5, MaterialKind::Glass { ior: 1.25 }, GzColor::new(0.5, 1.0, 1.0)));
    assert_eq!((m.texture, m.interpolate, m.surface), (Some(0), Interpolate::Gouraud, Surface::Shaded));
    let colors = [GzColor::new(1.0, 0.0, 0.0), GzColor::splat(0.5)];
    assert_eq!(draft.scene.textures, [Texture::Procedural(Procedural::Checker { across: 4.0, down: 2.5, colors })]);
    assert_eq!(draft.place(SceneNeeds::ALL).unwrap().tris.class(0), TriClass::Glass);
}

#[test]
fn mirror_and_glass_have_a_matt_colour_only_where_the_course_gives_them_one() {
    let of = |mode: &str, kind: &str| {
        let toml = format!(
            "[render]\nmode = \"{mode}\"\n{CAMERA}[[material]]\nname = \"m\"\nkind = \"{kind}\"\n{MESH}material = \"m\"\n"
        );
        let m = draft(&toml).scene.materials[0].clone();
        (m.kind, m.kd.x)
    };
    assert_eq!(of("physical", "mirror"), (MaterialKind::Mirror { ior: None }, 0.0));
    assert_eq!(of("physical", "glass"), (MaterialKind::Glass { ior: 1.5 }, 0.0));
    assert_eq!((of("physical", "phong").1, of("paper", "mirror").1, of("homework", "glass").1), (0.7, 0.7, 0.7));
}

#[test]
fn materials_in_use_come_first_and_are_counted() {
    let materials = "[[material]]\nname = \"a\"\n[[material]]\nname = \"b\"\n[[material]]\nname = \"c\"\n";
    let quad = "[[mesh]]\nquad = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]\n";
    let toml = format!(
        "{CAMERA}{materials}{MESH}material = \"c\"\n{quad}material = \"b\"\noverride = [{{ triangle = 1, material = \"c\" }}]\n"
    );
    let draft = draft(&toml);
    let names: Vec<&str> = draft.scene.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!((&names[..], &draft.scene.used[..]), (&["b", "c", "a"][..], &[1, 2, 0][..]));
    let tris = draft.place(SceneNeeds::ALL).unwrap().tris;
    assert_eq!([0, 1, 2].map(|tri| tris.material(tri)), [1, 0, 1]);
}

#[test]
fn a_single_material_in_use_is_number_zero_wherever_it_was_defined() {
    let toml = format!("{CAMERA}[[material]]\nname = \"spare\"\n[[material]]\nname = \"used\"\n{MESH}material = \"used\"\n");
    let draft = draft(&toml);
    assert_eq!((draft.scene.materials[0].name.as_str(), &draft.scene.used[..]), ("used", &[1, 0][..]));
    assert_eq!(draft.place(SceneNeeds::ALL).unwrap().tris.material(0), 0);
}

#[test]
fn triangles_without_texture_coordinates_get_the_material_without_its_texture() {
    let textured = "[[texture]]\nname = \"t\"\nchecker = { across = 1, down = 1 }\n[[material]]\nname = \"m\"\ntexture = \"t\"\n";
    let bare = "[[mesh]]\nfile = \"bare.obj\"\nmaterial = \"m\"\n";
    let toml = format!("ambient = 1\n{CAMERA}{textured}{MESH}material = \"m\"\n{bare}");
    let folder = folder(&toml);
    let draft = folder.read("s.toml", &Overrides::default()).unwrap();
    let warnings: Vec<String> = draft.warnings.iter().map(|warning| folder.short(warning)).collect();
    assert_eq!(warnings, ["bare.obj: 1 triangles have no texture coordinates and show no texture"]);
    assert_eq!((draft.scene.materials[0].texture, draft.scene.materials[1].texture), (Some(0), None));
    assert_eq!(draft.scene.used, [1, 1]);
    let tris = draft.place(SceneNeeds::ALL).unwrap().tris;
    assert_eq!((tris.material(0), tris.material(1)), (0, 1));
}

#[test]
fn a_mesh_without_a_material_has_the_default_one_or_shows_its_app_color() {
    let plain = draft(&format!("{CAMERA}{MESH}"));
    assert_eq!((plain.scene.materials.len(), plain.scene.materials[0].surface), (1, Surface::Shaded));
    let colour = "app_color = { direction = [0, 0, 1], color = 1 }";
    let coloured = draft(&format!("{CAMERA}{MESH}{colour}\n"));
    assert_eq!(coloured.scene.materials[0].surface, Surface::AppColor);
}

/// A 1 x 1 picture, mid grey.
const GREY_PPM: &[u8] = b"P6\n1 1\n255\n\x80\x80\x80";

#[test]
fn textures_take_lookup_and_encoding_from_their_keys_or_the_mode() {
    let of = |mode: &str, keys: &str| {
        let toml = format!(
            "ambient = 1\n[render]\nmode = \"{mode}\"\n{CAMERA}[[texture]]\nname = \"t\"\nfile = \"grey.ppm\"\n{keys}\n{MESH}"
        );
        let folder = folder(&toml).with("grey.ppm", GREY_PPM);
        let mut scene = folder.read("s.toml", &Overrides::default()).unwrap().scene;
        let Some(Texture::Image(image)) = scene.textures.pop() else { panic!("a picture") };
        (image.lookup, image.texels[0].x == 128.0 / 255.0)
    };
    assert_eq!(of("physical", ""), (TextureLookup::Repeat, false));
    assert_eq!(of("homework", ""), (TextureLookup::Homework, true));
    assert_eq!(of("paper", "lookup = \"paper_edge\""), (TextureLookup::PaperEdge, true));
    assert_eq!(of("physical", "srgb = false"), (TextureLookup::Repeat, true));
    assert_eq!(of("homework", "srgb = true"), (TextureLookup::Homework, false));
}

#[test]
fn a_texture_stands_in_for_course_data() {
    let texture = |or: &str| format!("{CAMERA}[[texture]]\nname = \"t\"\nfile = \"hw:logo.ppm\"\nor = {or}\n{MESH}");
    let read = |toml: &str| {
        let folder: Folder = folder(toml).with("grey.ppm", GREY_PPM);
        folder.read("s.toml", &Overrides::default()).map(|draft| draft.scene.textures)
    };
    assert!(matches!(read(&texture("{ file = \"grey.ppm\" }")).unwrap()[..], [Texture::Image(_)]));
    let checker = read(&texture("{ checker = { across = 2, down = 2 } }")).unwrap();
    assert!(matches!(checker[..], [Texture::Procedural(_)]));
    assert_eq!(read(&texture("{}")).unwrap_err(), "s.toml:7: or of a texture needs a file or a checker");
}

#[test]
fn every_kind_of_mesh_can_be_read() {
    let sources = [
        ("file = \"t.obj\"", 1),
        ("file = \"t.asc\"", 1),
        ("quad = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]", 2),
        ("triangles = [[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 1], [1, 0, 1], [1, 1, 1]]]", 2),
        ("teapot = { segments = 1, bottom = false }", 56),
        ("teapot = { segments = 2 }", 256),
    ];
    for (source, triangles) in sources {
        let draft = draft(&format!("{CAMERA}[[mesh]]\n{source}\n"));
        assert_eq!(draft.triangles(), triangles, "{source}");
        assert_eq!(draft.place(SceneNeeds::ALL).unwrap().tris.len(), triangles, "{source}");
    }
}
