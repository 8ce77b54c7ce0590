//! What is accepted or refused at the borders: ranges of values, line ends, many tables, and what mesh files name.

use super::scratch::{BARE_OBJ, CAMERA, Folder, message};
use super::settings::Overrides;

const MESH: &str = "[[mesh]]\nfile = \"t.obj\"\n";

fn bare(obj: &str, mtl: &str) -> Result<super::Draft, String> {
    Folder::new().with("a.obj", obj).with("c.mtl", mtl).read("a.obj", &Overrides::default())
}

#[test]
fn colours_and_cameras_beyond_what_shading_holds_are_refused_with_their_line() {
    let cases = [
        (format!("ambient = 2e6\n{CAMERA}{MESH}"), "s.toml:1: a colour must be at most 1000000, not 2000000"),
        (
            format!("{CAMERA}[[material]]\nname = \"g\"\nkind = \"glass\"\ntint = [0.5, 2, 1]\n{MESH}"),
            "s.toml:7: a tint must be at most 1, not 2",
        ),
        (format!("{CAMERA}{MESH}crease = 181\n"), "s.toml:6: crease must be 0 to 180 degrees, not 181"),
        (
            format!("[camera]\nposition = [1e-50, 0, 1]\nlook_at = [0, 0, 0]\n{MESH}"),
            "s.toml:1: the camera's position is where rays cannot start: its coordinates must be 0 or 2^-150 to 2^128",
        ),
    ];
    for (scene, expected) in cases {
        assert_eq!(message(&scene), expected);
    }
    assert_eq!(message(&format!("ambient = 1e6\n{CAMERA}{MESH}crease = 180\n")), "nothing is wrong");
}

#[test]
fn old_mac_line_ends_are_accepted_and_counted() {
    assert_eq!(message(&format!("{CAMERA}{MESH}").replace('\n', "\r")), "nothing is wrong");
    assert_eq!(
        message(&format!("{CAMERA}{MESH}crease = 181\n").replace('\n', "\r")),
        "s.toml:6: crease must be 0 to 180 degrees, not 181"
    );
}

#[test]
fn ten_thousand_meshes_know_their_lines() {
    let mesh = "[[mesh]]\ntriangles = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]\n";
    let scene = format!("{CAMERA}{}", mesh.repeat(10_000));
    let draft = Folder::new().with("s.toml", &scene).read("s.toml", &Overrides::default()).unwrap();
    assert_eq!((draft.triangles(), draft.parts[9999].line), (10_000, Some(4 + 2 * 9999)));
}

#[test]
fn a_texture_that_cannot_be_read_is_named_by_its_line_with_its_options() {
    let obj = format!("mtllib c.mtl\nusemtl m\n{BARE_OBJ}");
    let said = bare(&obj, "newmtl m\nmap_Kd -s 1 1 1 no.png\n").unwrap_err();
    assert_eq!(said, "c.mtl:2: no such file: no.png (map_Kd option -s is not supported, ignored)");
    let said = bare(&obj, "newmtl m\n\nmap_Kd c.mtl\n").unwrap_err();
    assert_eq!(said, "c.mtl:3: not a PNG, JPEG or PPM picture: c.mtl");
    // What no triangle uses may be missing.
    assert!(bare(BARE_OBJ, "newmtl m\nmap_Kd no.png\n").is_ok());
}

#[test]
fn a_mesh_that_no_camera_can_stand_before_is_refused() {
    let said = bare("v 3e38 0 0\nv 0 3e38 0\nv -3e38 0 0\nf 1 2 3\n", "").unwrap_err();
    assert!(said.starts_with("a.obj: the mesh is too large or too small to be framed"), "{said}");
    assert!(bare("v 1e37 0 0\nv 0 1e37 0\nv 0 0 0\nf 1 2 3\n", "").is_ok());
}

#[test]
fn smoothing_groups_reach_the_mesh() {
    let squares = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let groups = |faces: &str| bare(&format!("{squares}{faces}"), "").unwrap().parts.remove(0).mesh.smoothing;
    assert_eq!(groups("f 1 2 3\nf 1 3 4\n"), [0; 0]);
    let free = crate::mesh::UNGROUPED;
    assert_eq!(groups("f 1 2 3 4\ns 7\nf 1 2 3\ns off\nf 1 2 3 4\ns 0\nf 1 3 4\n"), [free, free, 7, 0, 0, 0]);
    let draft = bare(&format!("{squares}s on\nf 1 2 3\ns 1 2\n"), "").unwrap();
    assert_eq!(
        draft.warnings,
        ["2 smoothing groups neither off nor a number, ignored"].map(|what| {
            // Warnings keep the folder, which has a new name each time.
            let at = draft.warnings[0].find(":5: ").unwrap();
            format!("{}:5: {what}", &draft.warnings[0][..at])
        })
    );
}
