use super::super::scratch::{CAMERA, COURSE_CAMERA, Folder, draft, draft_with};
use super::super::settings::Overrides;
use gz_core::{CameraModel, GzColor, GzCoord, GzTextureIndex};
use gz_shade::{Scene, SceneNeeds};

fn placed(toml: &str) -> Scene {
    draft(toml).place(SceneNeeds::ALL).unwrap()
}

fn mesh(keys: &str) -> String {
    format!("{CAMERA}[[mesh]]\nfile = \"t.obj\"\n{keys}\n")
}

fn near(a: GzCoord, b: [f32; 3]) -> bool {
    (a - GzCoord::from_array(b)).abs().max_element() < 1e-6
}

#[test]
fn the_last_listed_step_acts_first() {
    let scene = placed(&mesh("place = [{ translate = [10, 0, 0] }, { rotate_z = 90 }, { scale = [3, 1, 1] }]"));
    // (1, 0, 0) is scaled to (3, 0, 0), turned to (0, 3, 0), moved to (10, 3, 0).
    assert_eq!(scene.tris.position(0).map(|p| p.to_array()), [[10.0, 3.0, 0.0], [8.0, 0.0, 0.0], [10.0, 0.0, 0.0]]);
}

#[test]
fn a_matrix_step_is_row_major_and_acts_on_columns() {
    let rows = "place = [{ matrix = [[0, 1, 0, 5], [1, 0, 0, 0], [0, 0, 2, -1], [0, 0, 0, 1]] }]";
    assert_eq!(placed(&mesh(rows)).tris.position(0)[0], GzCoord::new(5.0, 1.0, -1.0));
}

#[test]
fn identity_keeps_every_bit() {
    let odd = "v 0.1 -0.0 1e-40\nv 3e38 1.17549435e-38 -0.3\nv -0.0 16777217 7\nf 1 2 3\n";
    let folder = Folder::new().with("o.obj", odd).with("s.toml", format!("{CAMERA}[[mesh]]\nfile = \"o.obj\"\n"));
    let scene = folder.read("s.toml", &Overrides::default()).unwrap().place(SceneNeeds::ALL).unwrap();
    let bits = scene.tris.position(0).map(|p| p.to_array().map(f32::to_bits));
    let expected = [[0.1, -0.0, 1e-40], [3e38, 1.175_494_4e-38, -0.3], [-0.0, 16_777_216.0, 7.0]];
    assert_eq!(bits, expected.map(|p: [f32; 3]| p.map(f32::to_bits)));
}

#[test]
fn a_mirroring_placement_swaps_corners_in_all_arrays_and_keeps_the_outside() {
    let plain = placed(&mesh(""));
    let scene = placed(&mesh("place = [{ scale = [-1, 1, 1] }]"));
    assert_eq!(scene.tris.position(0).map(|p| p.to_array()), [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
    let uvs = [[0.25, 0.0], [0.0, 0.0], [0.0, 0.5]].map(GzTextureIndex::from_array);
    assert_eq!(scene.tris.uvs(0), Some(&uvs));
    // Mirrored across x = 0 the normal along z stays, and so does the side that the winding calls outside.
    assert_eq!(scene.tris.normals(0).unwrap()[1], GzCoord::Z);
    assert_eq!(plain.tris.face_normal(0), scene.tris.face_normal(0));
}

#[test]
fn computed_and_flat_normals_of_a_mirrored_mesh_point_outside_too() {
    for normals in ["smooth", "flat"] {
        for scale in ["[1, 1, 1]", "[-1, 1, 1]", "[1, -2, 1]", "[1, 1, -1]"] {
            let keys = format!("place = [{{ scale = {scale} }}]\nnormals = \"{normals}\"");
            let toml = mesh(&keys).replace("t.obj", "bare.obj");
            let scene = placed(&toml);
            let expected = if scale.ends_with("-1]") { [0.0, 0.0, -1.0] } else { [0.0, 0.0, 1.0] };
            assert!(near(scene.tris.normals(0).unwrap()[2], expected), "{normals} {scale}");
            assert!(near(scene.tris.face_normal(0).as_vec3(), expected), "{normals} {scale}");
        }
    }
}

#[test]
fn normals_go_by_the_inverse_transpose_and_are_unit() {
    let slope = "v 0 0 0\nv 1 -1 0\nv 0 0 1\nvn 3 3 0\nf 1//1 2//1 3//1\n";
    let toml = format!("{CAMERA}[[mesh]]\nfile = \"slope.obj\"\nplace = [{{ scale = [2, 1, 1] }}]\n");
    let folder = Folder::new().with("slope.obj", slope).with("s.toml", toml);
    let scene = folder.read("s.toml", &Overrides::default()).unwrap().place(SceneNeeds::ALL).unwrap();
    // The slope now falls 1 in 2, so its normal is (1, 2, 0) / sqrt 5.
    let k = 5.0_f32.sqrt();
    assert!(near(scene.tris.normals(0).unwrap()[0], [1.0 / k, 2.0 / k, 0.0]), "{:?}", scene.tris.normals(0));
}

#[test]
fn flat_normals_take_the_side_of_the_normals_in_the_file() {
    let against = "v 1 0 0\nv 0 2 0\nv 0 0 0\nvn 0.6 0 -0.8\nf 1//1 2//1 3//1\n";
    let toml = format!("{CAMERA}[[mesh]]\nfile = \"against.obj\"\nnormals = \"flat\"\n");
    let folder = Folder::new().with("against.obj", against).with("s.toml", toml);
    let scene = folder.read("s.toml", &Overrides::default()).unwrap().place(SceneNeeds::ALL).unwrap();
    assert_eq!(scene.tris.normals(0), Some(&[GzCoord::NEG_Z; 3]));
}

#[test]
fn course_cameras_place_the_teapots_first_vertex_where_it_is_known_to_be() {
    let place = "place = [{ matrix = [[3.25, 0, 0, 0], [0, 3.25, 0, -3.25], [0, 0, 3.25, 3.5], [0, 0, 0, 1]] }, \
        { matrix = [[0.866, 0, -0.5, 0], [0, 1, 0, 0], [0.5, 0, 0.866, 0], [0, 0, 0, 1]] }, \
        { matrix = [[1, 0, 0, 0], [0, 0.7071, 0.7071, 0], [0, -0.7071, 0.7071, 0], [0, 0, 0, 1]] }]";
    let triangle = "triangles = [[[1.4, 2.25, 0], [1, 0, 0], [0, 1, 0]]]";
    let toml = |model| format!("[camera]\nmodel = \"{model}\"\n{COURSE_CAMERA}[[mesh]]\n{triangle}\n{place}\n");
    for model in ["homework", "paper"] {
        let p = placed(&toml(model)).tris.position(0)[0];
        assert!((p - GzCoord::new(3.75547, 3.81249, 28.54613)).abs().max_element() < 2e-5, "{model} {p}");
    }
    let p = placed(&toml("screen")).tris.position(0)[0];
    assert!((p.x - 153.6594).abs() < 1e-3 && (p.y - 101.951).abs() < 1e-3, "{p}");
    assert!((p.z - 2_032_852_512.0).abs() < 1000.0, "{p}");
}

#[test]
fn normals_are_in_image_space_under_course_cameras() {
    let toml = format!("[camera]\nmodel = \"homework\"\n{COURSE_CAMERA}[[mesh]]\nfile = \"t.obj\"\n");
    // The camera's axes along z of the world: the third column of Xiw.
    assert!(near(placed(&toml).tris.normals(0).unwrap()[0], [-0.830092, -0.432094, 0.352480]));
}

#[test]
fn a_dropped_triangle_keeps_its_number_and_does_not_widen_the_box() {
    let near_one = "[[0, 0, 1], [1, 0, 1], [0, 1, 1]]";
    let behind = "[[0, 0, 1], [1, 0, -1], [0, 1, 1]]";
    let view = "position = [0, 0, 0]\nlook_at = [0, 0, 1]\n";
    let toml = |model: &str, triangles: &[&str]| {
        let list = triangles.join(", ");
        format!("ambient = 1\n[camera]\nmodel = \"{model}\"\n{view}[[mesh]]\ntriangles = [{list}]\n")
    };
    for order in [[near_one, behind], [behind, near_one]] {
        let kept = order.iter().position(|&t| t == near_one).unwrap();
        let draft = draft(&toml("homework", &order));
        assert_eq!((draft.dropped, draft.triangles(), &draft.scene.used[..]), (1, 2, &[1][..]));
        assert_eq!(draft.warnings.len(), 1, "{:?}", draft.warnings);
        let scene = draft.place(SceneNeeds::ALL).unwrap();
        assert_eq!(scene.tris.len(), 2);
        let [a, b, c] = *scene.tris.position(1 - kept as u32);
        assert!(a == b && b == c && a == scene.tris.position(kept as u32)[0]);
        assert_ne!(scene.tris.face_normal(kept as u32), glam::DVec3::ZERO);
    }
    assert_eq!(draft(&toml("paper", &[behind])).dropped, 0);
    let all = draft(&toml("screen", &[behind, behind])).place(SceneNeeds::ALL).unwrap();
    assert_eq!(all.tris.positions(), [[GzCoord::ZERO; 3]; 2]);
}

#[test]
fn only_what_is_needed_is_stored() {
    let none = SceneNeeds {
        shadows: false,
        mirrors: false,
        glass: false,
        image_textures: false,
        procedural_textures: false,
        smooth_normals: false,
        gouraud: false,
        app_colors: false,
        materials: false,
        antialiasing: false,
    };
    let scene = draft(&mesh("")).place(none).unwrap();
    assert_eq!((scene.tris.bytes(), scene.tris.normals(0), scene.tris.uvs(0)), (36, None, None));
    let scene = draft(&mesh("")).place(SceneNeeds { smooth_normals: true, ..none }).unwrap();
    assert_eq!((scene.tris.bytes(), scene.tris.uvs(0)), (72, None));
}

#[test]
fn app_color_is_the_homeworks_flat_colour() {
    let colour = "app_color = { direction = [0.707, 0.5, 0.5], color = [0.95, 0.65, 0.88] }";
    let expected = GzColor::new(0.95, 0.65, 0.88) * 0.5;
    // Model space: a placement that turns the normal does not change the colour.
    for keys in [colour.to_owned(), format!("{colour}\nplace = [{{ rotate_x = 90 }}]")] {
        assert_eq!(placed(&mesh(&keys)).tris.color(0), Some(expected));
    }
    let bright = colour.replace("0.5]", "7]");
    assert_eq!(placed(&mesh(&bright)).tris.color(0), Some(GzColor::new(0.95, 0.65, 0.88)));
}

#[test]
fn overridden_triangles_stand_where_the_scene_says() {
    let change = "override = [{ triangle = 0, image_vertices = [[1, 2, 3], [4, 5, 6], [7, 8, 10]], normal = [0, 0, -2] }]";
    let toml = format!("[camera]\nmodel = \"paper\"\n{COURSE_CAMERA}[[mesh]]\nfile = \"t.obj\"\n{change}\n");
    let scene = placed(&toml);
    assert_eq!(scene.tris.position(0).map(|p| p.to_array()), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 10.0]]);
    assert_eq!(scene.tris.normals(0), Some(&[GzCoord::NEG_Z; 3]));
    // A mirroring placement has no say over vertices that are given where they are to be.
    let mirrored = format!("{toml}place = [{{ scale = -1 }}]\n");
    assert_eq!(placed(&mirrored).tris.position(0), scene.tris.position(0));
    let without = toml.replace(", normal = [0, 0, -2]", "");
    let n = placed(&without).tris.normals(0).unwrap()[0].as_dvec3();
    assert!((n - scene.tris.face_normal(0)).length() < 1e-6, "{n}");
}

#[test]
fn a_placement_beyond_f32_names_the_mesh_and_the_triangle() {
    let draft = draft(&mesh("place = [{ scale = 3e38 }, { scale = 10 }]"));
    let error = draft.place(SceneNeeds::ALL).unwrap_err();
    assert_eq!((error.line, error.message.as_str()), (Some(4), "triangle 0 is placed beyond the range of f32"));
}

#[test]
fn another_camera_model_places_in_another_space() {
    let toml = format!("ambient = 1\n[camera]\nmodel = \"homework\"\n{COURSE_CAMERA}[[mesh]]\nfile = \"t.obj\"\n");
    let overrides = Overrides { camera: Some(CameraModel::Pinhole), ..Overrides::default() };
    let scene = draft_with(&toml, &overrides).place(SceneNeeds::ALL).unwrap();
    assert_eq!(scene.tris.position(0)[1], GzCoord::new(0.0, 2.0, 0.0));
    assert_eq!(scene.tris.normals(0), Some(&[GzCoord::Z; 3]));
}
