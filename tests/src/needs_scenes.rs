//! One small scene for each need, in which nothing else is needed.
//!
//! All of them are the same matt flat teapot on a floor under ambient light, which needs nothing, with one thing added.

use gz_core::Attributes;
use gz_shade::FrameStats;
use std::path::{Path, PathBuf};

/// A scene in which one thing is needed.
#[derive(Clone, Debug)]
pub struct NeedScene {
    /// The field of [`gz_shade::SceneNeeds`] that it is about.
    pub need: &'static str,
    /// Another field that this need brings with it.
    pub also: Option<&'static str>,
    /// The scene file.
    pub toml: String,
    /// What its triangles carry beside positions.
    pub attributes: Attributes,
    /// What rays it casts beside one primary ray a pixel: a name of [`further_rays`].
    pub rays: Option<&'static str>,
}

/// Width and height of these scenes in pixels.
pub const SIZE: (u32, u32) = (48, 36);

/// Samples a pixel of the scene that is antialiased.
pub const SAMPLES: u64 = 3;

/// The file that the textured scene reads: a PPM of three by two texels.
const PICTURE: (&str, &[u8]) =
    ("picture.ppm", b"P6\n3 2\n255\n\xff\x20\x10\x10\xe0\x30\x20\x40\xff\xf0\xf0\x20\x80\x00\x80\x10\x90\x90");

/// Rays beside one primary ray a pixel of a picture of [`SIZE`], by kind.
pub fn further_rays(stats: &FrameStats) -> [(&'static str, u64); 4] {
    [
        ("shadow rays", stats.shadow_rays),
        ("mirror rays", stats.mirror_rays),
        ("glass rays", stats.glass_rays),
        ("further samples", stats.primary_rays - u64::from(SIZE.0 * SIZE.1)),
    ]
}

/// What a scene adds to the plain one.
#[derive(Default)]
struct Added {
    /// Keys of `[render]`.
    render: &'static str,
    /// Further keys of the teapot's material.
    teapot: &'static str,
    /// The floor's material, if not the teapot's.
    floor: Option<&'static str>,
    /// Further keys of each mesh.
    mesh: &'static str,
    /// Tables.
    tables: &'static str,
}

impl Added {
    fn toml(&self) -> String {
        let Self { render, teapot, floor, mesh, tables } = self;
        let floor_name = if floor.is_some() { "floor" } else { "teapot" };
        let floor = floor.map_or_else(String::new, |keys| format!("[[material]]\nname = \"floor\"\n{keys}\n"));
        let render = if render.contains("shadow") { (*render).to_owned() } else { format!("shadow = \"off\"\n{render}") };
        let (width, height) = SIZE;
        format!(
            "background = [0.2, 0.3, 0.5]\nambient = 1\n[render]\nsize = [{width}, {height}]\n{render}\n\
             [camera]\nposition = [1, 5, 11]\nlook_at = [0, 1.2, 0]\n\
             [[material]]\nname = \"teapot\"\n{teapot}\n{floor}\
             [[mesh]]\nteapot = {{ segments = 3 }}\nmaterial = \"teapot\"\n{mesh}\n\
             [[mesh]]\nquad = [[-5, 0, 5], [5, 0, 5], [5, 0, -5], [-5, 0, -5]]\nmaterial = \"{floor_name}\"\n{mesh}\n{tables}"
        )
    }
}

const FLAT: &str = "interpolate = \"flat\"";
const LIGHT: &str = "[[light]]\ndirection = [1, 2, 1]\ncolor = 0.8";
const NOTHING: Attributes = Attributes { normals: false, uvs: false, colors: false, materials: false, classes: false };

/// The scene that needs nothing.
pub fn plain() -> String {
    Added { teapot: FLAT, ..Added::default() }.toml()
}

/// The scene that needs nothing, with a teapot of 230 thousand triangles.
pub fn plain_and_large() -> String {
    plain().replace("segments = 3", "segments = 60")
}

/// The scenes, in the order of the fields of [`gz_shade::SceneNeeds`].
pub fn all() -> Vec<NeedScene> {
    let scene = |need, attributes, added: Added| NeedScene { need, also: None, toml: added.toml(), attributes, rays: None };
    let with_rays = |kind, scene: NeedScene| NeedScene { rays: Some(kind), ..scene };
    let and_normals = |scene: NeedScene| NeedScene { also: Some("smooth_normals"), ..scene };
    let (normals, uvs) = (Attributes { normals: true, ..NOTHING }, Attributes { uvs: true, ..NOTHING });
    let none = Added::default;
    vec![
        with_rays(
            "shadow rays",
            scene("shadows", NOTHING, Added { render: "shadow = \"opaque\"", teapot: FLAT, tables: LIGHT, ..none() }),
        ),
        with_rays(
            "mirror rays",
            scene("mirrors", NOTHING, Added { teapot: "kind = \"mirror\"\ninterpolate = \"flat\"", ..none() }),
        ),
        // The corner normals say which side of glass is outside.
        and_normals(with_rays(
            "glass rays",
            scene(
                "glass",
                Attributes { classes: true, ..normals },
                Added { teapot: "kind = \"glass\"\ninterpolate = \"flat\"", ..none() },
            ),
        )),
        scene(
            "image_textures",
            uvs,
            Added {
                teapot: "interpolate = \"flat\"\ntexture = \"picture\"",
                tables: "[[texture]]\nname = \"picture\"\nfile = \"picture.ppm\"",
                ..none()
            },
        ),
        scene(
            "procedural_textures",
            uvs,
            Added {
                teapot: "interpolate = \"flat\"\ntexture = \"squares\"",
                tables: "[[texture]]\nname = \"squares\"\nchecker = { across = 4, down = 4, colors = [1, 0.1] }",
                ..none()
            },
        ),
        scene("smooth_normals", normals, Added { teapot: "interpolate = \"phong\"", tables: LIGHT, ..none() }),
        and_normals(scene("gouraud", normals, Added { teapot: "interpolate = \"gouraud\"", tables: LIGHT, ..none() })),
        scene(
            "app_colors",
            Attributes { colors: true, ..NOTHING },
            Added {
                teapot: "interpolate = \"flat\"\nsurface = \"app_color\"",
                mesh: "app_color = { direction = [0.7, 0.5, 0.5], color = [0.9, 0.6, 0.8] }",
                ..none()
            },
        ),
        scene(
            "materials",
            Attributes { materials: true, ..NOTHING },
            Added { teapot: FLAT, floor: Some("interpolate = \"flat\"\nka = 0.5"), ..none() },
        ),
        with_rays("further samples", scene("antialiasing", NOTHING, Added { render: "aa = 3", teapot: FLAT, ..none() })),
    ]
}

/// Writes a scene and the picture that one of them reads into `folder`, which is made; returns the scene's path.
///
/// # Errors
///
/// If the folder cannot be written to.
pub fn write(folder: &Path, name: &str, toml: &str) -> std::io::Result<PathBuf> {
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join(PICTURE.0), PICTURE.1)?;
    let path = folder.join(format!("{name}.toml"));
    std::fs::write(&path, toml)?;
    Ok(path)
}
