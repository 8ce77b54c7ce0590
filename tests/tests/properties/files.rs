//! P22 and P23: files in and out.

use super::inputs::{point, shots, triangles};
use gz_app::error::LoadError;
use gz_app::load::{self, Overrides};
use gz_app::mesh::Mesh;
use gz_app::picture::Picture;
use gz_app::rays_file::RayFormat;
use gz_app::{hits_file, pfm};
use gz_core::{GzColor, GzCoord, Hit};
use gz_shade::TextureLookup;
use gz_tests::folder::Folder;
use proptest::prelude::*;
use std::fmt::Write;

/// A mesh as OBJ text, positions and triangles only.
fn obj(positions: &[GzCoord], triangles: &[[u32; 3]]) -> String {
    let mut text = String::new();
    for p in positions {
        let _ = writeln!(text, "v {:e} {:e} {:e}", p.x, p.y, p.z); // writing to a string cannot fail
    }
    for [a, b, c] in triangles {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    text
}

fn bits(points: &[GzCoord]) -> Vec<[u32; 3]> {
    points.iter().map(|p| p.to_array().map(f32::to_bits)).collect()
}

/// Texts of every kind that is read, to be damaged.
const CORPUS: [(&str, &str); 6] = [
    (
        "a.obj",
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0.5\nv 0 1e-3 -2\nv 1 1 1\nvn 0 0 1\nvt 0.5 0.25\nusemtl m\ns 1\nf 1/1/1 2/1/1 3//1 -1\ng x\nf 1 2 4 3\n",
    ),
    ("a.mtl", "newmtl m\nKa 0.1 0.1 0.1\nKd 0.5\nKs 0 0 0\nNs 10\nNi 1.5\nTf 1 1 1\nillum 7\nmap_Kd -s 1 1 1 a.ppm\n"),
    ("a.asc", "triangle\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n"),
    (
        "a.toml",
        "ambient = 0.2\nbackground = [0, 0.5, 1]\n[render]\nsize = [8, 6]\ndepth = 3\n[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\nfov = 40.0\n[[light]]\ndirection = [1, 2, 3]\n[[material]]\nname = \"m\"\nkind = \"glass\"\nior = 1.5\n[[mesh]]\nfile = \"a.obj\"\nmaterial = \"m\"\nplace = [{ scale = 2 }, { rotate_y = 30 }]\n",
    ),
    ("a.ppm", "P6\n2 2\n255\n0123456789ab"),
    ("b.ppm", "P3\n2 1\n255\n1 2 3 4 5 6\n"),
];

/// One way to damage bytes.
#[derive(Clone, Debug)]
enum Damage {
    Set(usize, u8),
    Cut(usize),
    Insert(usize, Vec<u8>),
    Repeat(usize, usize),
}

fn damage() -> impl Strategy<Value = Vec<Damage>> {
    let odd = prop_oneof![
        Just(b"nan".to_vec()),
        Just(b"1e999".to_vec()),
        Just(b"-5".to_vec()),
        Just(b"0/0/0".to_vec()),
        Just(b"6148914691236517206".to_vec()),
        Just(b"\xef\xbb\xbf".to_vec()),
        Just(b"\r".to_vec()),
        Just(b"\\\n".to_vec()),
        Just(b"../../x".to_vec()),
        prop::collection::vec(any::<u8>(), 1..6),
    ];
    let one = prop_oneof![
        4 => (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Damage::Set(at, byte)),
        1 => any::<usize>().prop_map(Damage::Cut),
        4 => (any::<usize>(), odd).prop_map(|(at, bytes)| Damage::Insert(at, bytes)),
        1 => (any::<usize>(), any::<usize>()).prop_map(|(from, to)| Damage::Repeat(from, to)),
    ];
    prop::collection::vec(one, 0..8)
}

fn damaged(text: &[u8], damage: &[Damage]) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for step in damage {
        let len = bytes.len() + 1;
        match step {
            Damage::Set(at, byte) => {
                if let Some(b) = bytes.get_mut(at % len) {
                    *b = *byte;
                }
            }
            Damage::Cut(at) => bytes.truncate(at % len),
            Damage::Insert(at, more) => {
                let at = at % len;
                bytes.splice(at..at, more.iter().copied());
            }
            Damage::Repeat(from, to) => {
                let (from, to) = (from % len, to % len);
                bytes.extend_from_within(from.min(to)..from.max(to));
            }
        }
    }
    bytes
}

/// One line that begins with the file's name.
fn is_told(error: &LoadError, name: &str) -> bool {
    let message = error.to_string();
    !message.contains('\n') && message.contains(name.split('.').next().unwrap_or_default())
}

proptest! {
    #[test]
    fn p22_what_is_written_is_read_back(points in prop::collection::vec(point(), 3..20), picks in prop::collection::vec(any::<[u8; 3]>(), 1..30)) {
        let folder = Folder::new("p22");
        let triangles: Vec<[u32; 3]> = picks.iter().map(|pick| pick.map(|k| u32::from(k) % points.len() as u32)).collect();
        let text = obj(&points, &triangles);
        let read = |text: &str| -> Mesh { load::obj::load(&folder.write("t.obj", text)).expect("a mesh") };
        let mesh = read(&text);
        let corners: Vec<[u32; 3]> = mesh.triangles.iter().map(|tri| tri.position).collect();
        prop_assert_eq!((bits(&mesh.positions), &corners), (bits(&points), &triangles));
        // And once more from what was read.
        let again = read(&obj(&mesh.positions, &corners));
        prop_assert_eq!(bits(&again.positions), bits(&mesh.positions));
    }

    #[test]
    fn p22_rays_and_hits_are_read_back(triangles in triangles(), shots in shots()) {
        let rays = super::inputs::rays(&shots, &triangles);
        for format in [RayFormat::F32, RayFormat::F64] {
            let (mut bytes, mut again) = (Vec::new(), Vec::new());
            rays.iter().for_each(|ray| format.encode(ray, &mut bytes));
            format.decode(&bytes).for_each(|ray| format.encode(&ray, &mut again));
            prop_assert!(bytes == again);
        }
        let tris = gz_tests::judge::buffer(triangles);
        let hits: Vec<Hit> = rays.iter().map(|ray| gz_core::RayQuery::closest_hit(&gz_core::BruteForce::new(&tris), ray)).collect();
        let bytes = hits_file::encode(&hits);
        prop_assert_eq!(gz_tests::scenes::hit_bits(&hits_file::decode(&bytes).expect("hits")), gz_tests::scenes::hit_bits(&hits));
    }

    #[test]
    fn p22_float_pictures_are_read_back(width in 1u32..9, colors in prop::collection::vec([-1e3f32..1e3, 0.0..1.0f32, 0.0..1e-30f32], 1..9)) {
        let colors: Vec<GzColor> = (0..width as usize).flat_map(|_| colors.iter().map(|c| GzColor::from_array(*c))).collect();
        let folder = Folder::new("p22-pfm");
        let path = folder.write("a.pfm", pfm::encode(width, &colors));
        let picture = Picture::read(&path).expect("a picture");
        prop_assert_eq!((picture.width, picture.height as usize), (width, colors.len() / width as usize));
        let back: Vec<GzColor> = picture.rgb.iter().map(|rgb| GzColor::from_array(*rgb)).collect();
        prop_assert_eq!(gz_tests::scenes::color_bits(&back), gz_tests::scenes::color_bits(&colors));
    }

    #[test]
    fn p23_no_bytes_make_a_loader_panic(which in 0usize..6, damage in damage(), bytes in prop::option::weighted(0.1, prop::collection::vec(any::<u8>(), 0..300))) {
        let folder = Folder::new("p23");
        for (name, text) in CORPUS {
            folder.write(name, text);
        }
        let (name, text) = CORPUS[which];
        let path = folder.write(name, bytes.unwrap_or_else(|| damaged(text.as_bytes(), &damage)));
        // Each file by itself, and the scene that names the others.
        let told = |error: &LoadError| assert!(is_told(error, name), "{error}");
        match which {
            0 => drop(load::obj::load(&path).inspect_err(told)),
            2 => drop(load::asc::load(&path).inspect_err(told)),
            4 | 5 => drop(load::picture::texture(&path, TextureLookup::Repeat, true, false).inspect_err(told)),
            _ => {}
        }
        if let Ok(draft) = load::scene(&folder.path().join("a.toml"), &Overrides::NONE).inspect_err(|error| assert!(!error.to_string().contains('\n'))) {
            // What loads can be placed, and every corner is a number.
            if draft.triangles() < 10_000 {
                let needs = gz_shade::SceneNeeds::of(&draft.scene);
                if let Ok(scene) = draft.place(needs) {
                    prop_assert!(scene.tris.positions().iter().flatten().all(|p| p.is_finite()));
                }
            }
        }
        let bytes = std::fs::read(&path).expect("it was written");
        let _ = hits_file::decode(&bytes); // refused or not, it returns
        let _ = Picture::read(&path);
        prop_assert_eq!(RayFormat::F32.decode(&bytes).count(), bytes.len() / 32);
    }
}
