//! What breaks OBJ loaders, each with the message that a user gets.

use super::super::testing::Scratch;
use super::*;

/// Three vertices on lines 1 to 3, for a face on line 4.
const V3: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn read(text: impl AsRef<[u8]>) -> Result<Mesh, String> {
    parse(Path::new("nowhere/t.obj"), text.as_ref()).map_err(|error| error.to_string())
}

fn error(text: impl AsRef<[u8]>) -> String {
    read(text).unwrap_err()
}

#[test]
fn a_texture_index_before_the_first_is_out_of_range() {
    assert_eq!(error(format!("{V3}vt 0 0\nf 1/-5/1 2 3")), "nowhere/t.obj:5: texture index -5 but only 1 defined");
    assert_eq!(error(format!("{V3}f 1//-5 2 3")), "nowhere/t.obj:4: normal index -5 but only 0 defined");
}

#[test]
fn an_index_near_the_end_of_its_type_is_out_of_range() {
    let expected = "nowhere/t.obj:4: normal index 6148914691236517206 but only 0 defined";
    assert_eq!(error(format!("{V3}f 1//6148914691236517206 2 3")), expected);
    for huge in ["99999999999999999999999999", "-99999999999999999999999999"] {
        let message = error(format!("{V3}f {huge} 2 3"));
        assert!(message == format!("nowhere/t.obj:4: position index {huge} but only 3 defined"), "{message}");
    }
}

#[test]
fn an_index_of_zero_is_an_error_in_every_field() {
    assert_eq!(error(format!("{V3}f 0 1 2")), "nowhere/t.obj:4: position index 0: indices count from 1");
    assert_eq!(error(format!("{V3}f 1/0 1 2")), "nowhere/t.obj:4: texture index 0: indices count from 1");
    assert_eq!(error(format!("{V3}f 1//0 1 2")), "nowhere/t.obj:4: normal index 0: indices count from 1");
}

#[test]
fn a_position_index_out_of_range_is_an_error() {
    assert_eq!(error(format!("{V3}f 1 2 4")), "nowhere/t.obj:4: position index 4 but only 3 defined");
    // A negative index counts from its own line: the vertex behind it does not help.
    assert_eq!(error(format!("{V3}f -1 -2 -4\nv 0 0 1")), "nowhere/t.obj:4: position index -4 but only 3 defined");
}

#[test]
fn a_face_corner_that_is_none_is_named() {
    for word in ["x", "1/2/3/4", "/1", "1.5", "1e3", "--1", "1//x"] {
        assert_eq!(error(format!("{V3}f 1 2 {word}")), format!("nowhere/t.obj:4: {word:?} is not a face corner"));
    }
}

#[test]
fn fields_at_some_corners_only_are_dropped_for_the_triangle_and_counted() {
    let text = format!("{V3}vt 0 0\nvn 0 0 1\nf 1/1/1 2 3/1/1\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/ 2// 3\nf 1/1 2/1 3\n");
    let mesh = read(text).unwrap();
    let has: Vec<_> = mesh.triangles.iter().map(|tri| (tri.uv.is_some(), tri.normal.is_some())).collect();
    assert_eq!(has, [(false, false), (true, false), (false, true), (false, false), (false, false)]);
    let expected = [
        "nowhere/t.obj:6: 2 triangles with texture coordinates at some corners only, left without",
        "nowhere/t.obj:6: 1 triangle with normals at some corners only, left without",
    ];
    assert_eq!(mesh.warnings, expected);
}

#[test]
fn a_coordinate_that_is_not_finite_is_named() {
    for word in ["nan", "inf", "-infinity", "1e999"] {
        assert_eq!(error(format!("v 0 0 0\nv 1 {word} 0\n")), format!("nowhere/t.obj:2: coordinate is not finite: {word:?}"));
    }
    assert_eq!(error("vn 0 nan 0"), r#"nowhere/t.obj:1: normal is not finite: "nan""#);
    assert_eq!(error("vt inf 0"), r#"nowhere/t.obj:1: texture coordinate is not finite: "inf""#);
}

#[test]
fn a_bad_number_is_named() {
    assert_eq!(error("# head\nv 1 x 2"), r#"nowhere/t.obj:2: "x" is not a number"#);
    assert_eq!(error("v 1 2"), "nowhere/t.obj:1: v takes 3 numbers (4 with w, 6 or 7 with a colour), not 2");
    assert_eq!(error("v 1 2 3 4 5"), "nowhere/t.obj:1: v takes 3 numbers (4 with w, 6 or 7 with a colour), not 5");
    assert_eq!(error("vt"), "nowhere/t.obj:1: vt takes 1 to 3 numbers, not 0");
    assert_eq!(error("vn 1 2"), "nowhere/t.obj:1: vn takes 3 numbers, not 2");
    assert_eq!(error("v 1 2 3 0"), "nowhere/t.obj:1: a vertex with w = 0 is infinitely far away");
    assert_eq!(
        error("v 1e30 2 3 1e-30"),
        "nowhere/t.obj:1: coordinate is not finite after division by w = 0.000000000000000000000000000001"
    );
}

#[test]
fn comma_decimals_get_a_hint() {
    assert_eq!(error("v 0,5 1 2"), r#"nowhere/t.obj:1: "0,5" is not a number: decimals need a point, not a comma"#);
}

#[test]
fn numbers_too_small_become_zero_and_a_triangle_without_area_warns() {
    let mesh = read("v 0 0 0\nv 1e-60 0 0\nv 0 1 0\nf 1 2 3").unwrap();
    assert_eq!(mesh.positions[1].to_array(), [0.0; 3]);
    assert_eq!(mesh.warnings, ["nowhere/t.obj:4: 1 triangle without area, numbered but never hit"]);
}

#[test]
fn repeated_indices_stay_and_are_numbered() {
    let mesh = read(format!("{V3}f 1 1 1\nf 1 2 2 3\nf 1 2 3\n")).unwrap();
    assert_eq!(mesh.triangles.len(), 4);
    assert_eq!((mesh.triangles[0].position, mesh.triangles[3].position), ([0; 3], [0, 1, 2]));
    assert_eq!(mesh.warnings, ["nowhere/t.obj:4: 2 triangles without area, numbered but never hit"]);
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_first_line() {
    let scratch = Scratch::new();
    let path = scratch.write("bom.obj", format!("\u{feff}{V3}f 1 2 3\n").as_bytes());
    assert_eq!(load(&path).unwrap().positions.len(), 3);
}

#[test]
fn latin_1_in_comments_and_names_is_accepted() {
    let scratch = Scratch::new();
    scratch.write("caf\u{e9}.mtl", b"# \xfcber\nnewmtl gr\xfcn\nKd 0 1 0\n");
    let obj = [b"# caf\xe9\nmtllib caf\xe9.mtl\no caf\xe9\n".as_slice(), V3.as_bytes(), b"usemtl gr\xfcn\nf 1 2 3\n"].concat();
    let mesh = load(&scratch.write("a.obj", &obj)).unwrap();
    assert_eq!((mesh.triangles[0].material, mesh.materials[0].name.as_str()), (Some(0), "gr\u{fc}n"));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
}

#[test]
fn a_comment_after_a_face_is_accepted() {
    assert_eq!(read(format!("{V3}f 1 2 3 # 4 5\nf 3 2 1#x")).unwrap().triangles.len(), 2);
}

#[test]
fn a_backslash_continues_a_line() {
    let mesh = read(format!("{V3}f 1 2 \\\n 3\nf 1 \\\r\n2 \\\r\n3\n")).unwrap();
    assert_eq!(mesh.triangles.len(), 2);
    assert_eq!(error(format!("{V3}f 1 2 \\\n 9\n")), "nowhere/t.obj:4: position index 9 but only 3 defined");
}

#[test]
fn every_line_end_is_accepted_and_counted() {
    for end in ["\r", "\n", "\r\n"] {
        let text = format!("{V3}f 1 2 3\nf 1 2 x\n").replace('\n', end);
        assert_eq!(error(text), r#"nowhere/t.obj:5: "x" is not a face corner"#, "{end:?}");
    }
}

#[test]
fn no_triangles_is_an_error() {
    for text in ["", "\n", V3, "l 1 2\np 1", "g only\nf 1", "hello"] {
        assert_eq!(error(text), "nowhere/t.obj: no triangles", "{text:?}");
    }
}

#[test]
fn faces_of_fewer_than_three_corners_are_counted_and_ignored() {
    let mesh = read(format!("{V3}f 1 2\nf 1\nf\nl 1 2 3\np 1 2 3\nf 1 2 3\n")).unwrap();
    assert_eq!(mesh.triangles.len(), 1);
    assert_eq!(mesh.warnings, ["nowhere/t.obj:4: 3 faces of fewer than three corners, ignored"]);
}

#[test]
fn a_huge_polygon_that_is_not_convex_is_refused() {
    let count = crate::load::polygon::MAX_CONCAVE as u32 + 1;
    let vertex = |k: u32| format!("v {k} {} 0\n", if k == 5 { 40 } else { k * k / 2 });
    let text: String = (0..count).map(vertex).collect();
    let face: String = (1..=count).map(|k| format!(" {k}")).collect();
    let expected = "nowhere/t.obj:4098: a polygon of 4097 corners that is not convex: at most 4096 are cut";
    assert_eq!(error(format!("{text}f{face}")), expected);
}

#[test]
fn a_line_beyond_the_limit_is_refused() {
    let long = format!("{V3}# {}", "x".repeat(MAX_LINE));
    assert_eq!(error(long), format!("nowhere/t.obj:4: a line of {} bytes: at most {MAX_LINE} are read", MAX_LINE + 2));
}

#[test]
fn unknown_material_names_warn_once() {
    let mesh = read(format!("{V3}usemtl brass\nf 1 2 3\nusemtl brass\nf 1 2 3\n")).unwrap();
    assert_eq!(mesh.triangles[1].material, None);
    assert_eq!(mesh.warnings, [r#"nowhere/t.obj:4: material "brass" is not defined, the default is used"#]);
}

#[test]
fn unknown_keywords_and_curves_warn_once() {
    let mesh = read(format!("foo 1\nfoo 2\ncurv 0 1 1 2\nend\ns off\no x\ng\n{V3}f 1 2 3\n")).unwrap();
    let expected = [
        r#"nowhere/t.obj:1: unknown keyword "foo", ignored"#,
        "nowhere/t.obj:3: curves and free-form surfaces are not supported, ignored",
    ];
    assert_eq!(mesh.warnings, expected);
}

#[test]
fn a_missing_library_warns_and_the_others_are_read() {
    let scratch = Scratch::new();
    scratch.write("b.mtl", b"newmtl b\n");
    scratch.write("two words.mtl", b"newmtl t\n");
    let text =
        format!("mtllib none.mtl b.mtl\nmtllib two words.mtl\nmtllib b.mtl\nmtllib\n{V3}usemtl b\nf 1 2 3\nusemtl t\nf 1 2 3\n");
    let path = scratch.write("a.obj", text.as_bytes());
    let mesh = load(&path).unwrap();
    assert_eq!([mesh.triangles[0].material, mesh.triangles[1].material], [Some(0), Some(1)]);
    let at = path.display();
    let expected =
        [format!("{at}:4: mtllib without a file name"), format!("{at}:1: material library \"none.mtl\": no such file")];
    assert_eq!(mesh.warnings, expected);
}

#[test]
fn a_library_outside_the_folder_is_refused() {
    for name in ["../b.mtl", "/etc/passwd"] {
        let expected = format!("nowhere/t.obj:1: material library {name:?} is outside the folder of the mesh");
        assert_eq!(error(format!("mtllib {name}\n{V3}f 1 2 3\n")), expected);
    }
}

#[test]
fn an_error_in_a_library_names_the_library() {
    let scratch = Scratch::new();
    let library = scratch.write("b.mtl", b"newmtl b\nKd nan 0 0\n");
    let path = scratch.write("a.obj", format!("mtllib b.mtl\n{V3}f 1 2 3\n").as_bytes());
    assert_eq!(load(&path).unwrap_err().to_string(), format!("{}:2: Kd is not finite: \"nan\"", library.display()));
}

#[test]
fn a_texture_beside_a_library_in_a_subfolder_is_found() {
    let scratch = Scratch::new();
    scratch.write("sub/b.mtl", b"newmtl b\nmap_Kd wood.png\n");
    let path = scratch.write("a.obj", format!("mtllib sub/b.mtl\n{V3}f 1 2 3\n").as_bytes());
    let map = load(&path).unwrap().materials[0].map_kd.clone();
    assert_eq!(map.map(|map| map.file), Some(scratch.path().join("sub/wood.png")));
}

#[test]
fn normals_become_unit_and_zero_ones_count_as_missing() {
    let mesh = read(format!("{V3}vn 0 0 2\nvn 0 0 0\nvn 1e-42 0 0\nvn 0 0.6 0.8\nf 1//1 2//3 3//4\nf 1//1 2//1 3//2\n")).unwrap();
    let given: Vec<_> = mesh.normals.iter().map(|n| n.to_array()).collect();
    assert_eq!(given, [[0.0, 0.0, 1.0], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8]]);
    assert_eq!((mesh.triangles[0].normal, mesh.triangles[1].normal), (Some([0, 2, 3]), None));
    assert_eq!(mesh.warnings, ["nowhere/t.obj:9: 1 triangle with a normal of length 0, left without"]);
}

#[test]
fn faces_may_name_vertices_that_come_later() {
    assert_eq!(read(format!("f 1 2 3\n{V3}")).unwrap().triangles[0].position, [0, 1, 2]);
}
