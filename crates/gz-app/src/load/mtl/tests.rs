//! MTL text in, materials, warnings and messages out.

use super::*;

fn parse(text: &str) -> Result<(Vec<MeshMaterial>, Vec<String>), String> {
    let (mut materials, mut warnings) = (Materials::default(), Vec::new());
    read(Path::new("dir/a.mtl"), Path::new("dir"), text.as_bytes(), &mut materials, &mut warnings).map_err(|e| e.to_string())?;
    Ok((materials.list, warnings))
}

fn error(text: &str) -> String {
    parse(text).unwrap_err()
}

#[test]
fn every_key_is_read() {
    let text = "# head\nnewmtl red wood\nKa .1 .2 .3\n\tKd 1\nKs 0 0 0 # none\r\nNs 96.078431\nNi 1.45\n\
                Tf 0.5 0.6 0.7\nillum 7\nmap_Kd tex\\my wood.png\n";
    let (materials, warnings) = parse(text).unwrap();
    let expected = MeshMaterial {
        name: "red wood".into(),
        ka: Some([0.1, 0.2, 0.3]),
        kd: Some([1.0; 3]),
        ks: Some([0.0; 3]),
        ns: Some(96.078_43),
        ni: Some(1.45),
        tf: Some([0.5, 0.6, 0.7]),
        illum: Some(7),
        map_kd: Some(MeshTexture { file: "dir/tex/my wood.png".into(), library: "dir/a.mtl".into(), line: 10, dropped: vec![] }),
    };
    assert_eq!((materials, warnings), (vec![expected], vec![]));
}

#[test]
fn one_number_is_grey_and_none_is_an_error() {
    assert_eq!(parse("newmtl a\nKd 0.5").unwrap().0[0].kd, Some([0.5; 3]));
    assert_eq!(error("newmtl a\nKd"), "dir/a.mtl:2: Kd takes 1 or 3 numbers, not 0");
    assert_eq!(error("newmtl a\nKs 1 2"), "dir/a.mtl:2: Ks takes 1 or 3 numbers, not 2");
}

#[test]
fn values_out_of_range_are_errors() {
    assert_eq!(error("newmtl a\nKd nan 0 0"), r#"dir/a.mtl:2: Kd is not finite: "nan""#);
    assert_eq!(error("newmtl a\nKd 0 x 0"), r#"dir/a.mtl:2: "x" is not a number"#);
    assert_eq!(error("newmtl a\nKd 0,5 0 0"), r#"dir/a.mtl:2: "0,5" is not a number: decimals need a point, not a comma"#);
    assert_eq!(error("newmtl a\n\nNs -1"), "dir/a.mtl:3: Ns must not be negative: -1");
    assert_eq!(error("newmtl a\nNi 0"), "dir/a.mtl:2: Ni must be 0.01 to 100, not 0");
    assert_eq!(error("newmtl a\nTf -1 0 0"), "dir/a.mtl:2: Tf must not be negative: -1");
    assert_eq!(error("newmtl"), "dir/a.mtl:1: newmtl without a name");
}

#[test]
fn an_odd_line_loses_no_material() {
    let text = "Kd 1 1 1\nnewmtl a\nKd 1 0 0\nillum 99999\nd -halo 0.5\n\
                newmtl b\nKd spectral x.rfl 1\nfoo bar\nfoo\nillum\nnewmtl c\nNs 3";
    let (materials, warnings) = parse(text).unwrap();
    let names: Vec<_> = materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "c"]);
    assert_eq!((materials[0].kd, materials[0].illum, materials[2].ns), (Some([1.0, 0.0, 0.0]), None, Some(3.0)));
    let expected = [
        "dir/a.mtl:1: Kd before the first newmtl, ignored",
        r#"dir/a.mtl:4: illum takes a number from 0 to 10, not "99999", ignored"#,
        "dir/a.mtl:7: Kd spectral colours are not supported, ignored",
        r#"dir/a.mtl:8: unknown key "foo", ignored"#,
        r#"dir/a.mtl:10: illum takes a number from 0 to 10, not "", ignored"#,
        "dir/a.mtl:5: 1 d line ignored: opacity is not supported",
    ];
    assert_eq!(warnings, expected);
}

#[test]
fn what_would_change_the_picture_is_told_once_a_key() {
    let text = "newmtl a\nd 1\nTr 0\nKe 0 0 0\nnewmtl b\nd 0.5\nd 0.2\nTr 1\nKe 0 0 2\nmap_d x.png\n";
    let expected = [
        "dir/a.mtl:6: 2 d lines ignored: opacity is not supported",
        "dir/a.mtl:8: 1 Tr line ignored: transparency is not supported",
        "dir/a.mtl:9: 1 Ke line ignored: emission is not supported",
        "dir/a.mtl:10: 1 map_d line ignored: opacity is not supported",
    ];
    assert_eq!(parse(text).unwrap().1, expected);
}

#[test]
fn colours_beyond_the_range_of_shading_are_refused() {
    assert_eq!(error("newmtl a\nTf 1 3e38 1"), "dir/a.mtl:2: Tf must be at most 1, not 3e38");
    assert_eq!(error("newmtl a\nKd 2e6"), "dir/a.mtl:2: Kd must be at most 1000000, not 2e6");
    assert_eq!(error("newmtl a\nKs 2\nillum 3"), "dir/a.mtl:1: Ks of a mirror (illum 3) is its tint and must be at most 1");
}

#[test]
fn a_material_defined_again_keeps_its_place_and_warns() {
    let (materials, warnings) = parse("newmtl a\nNs 1\nnewmtl b\nnewmtl a\nNi 2").unwrap();
    assert_eq!((materials.len(), materials[0].ns, materials[0].ni), (2, None, Some(2.0)));
    assert_eq!(warnings, [r#"dir/a.mtl:4: material "a" is defined again, the last one is used"#]);
}

#[test]
fn options_of_a_texture_are_named_and_its_file_is_found() {
    let map = |text: &str| {
        parse(&format!("newmtl a\nmap_Kd {text}"))
            .map(|(list, warnings)| (list[0].map_kd.as_ref().map(|map| map.file.clone()), warnings))
    };
    let option = |name| format!("dir/a.mtl:2: map_Kd option {name} is not supported, ignored");
    assert_eq!(map("-s 1 1 1 t.png"), Ok((Some("dir/t.png".into()), vec![option("-s")])));
    assert_eq!(map("-o 1 my t.png"), Ok((Some("dir/my t.png".into()), vec![option("-o")])));
    assert_eq!(map("-clamp on -mm 0 1 3"), Ok((Some("dir/3".into()), vec![option("-clamp"), option("-mm")])));
    assert_eq!(map("-s").unwrap_err(), "dir/a.mtl:2: map_Kd without a file name");
    assert_eq!(map("").unwrap_err(), "dir/a.mtl:2: map_Kd without a file name");
}

#[test]
fn a_texture_outside_the_folder_is_refused() {
    for file in ["../../etc/passwd", "/etc/passwd", r"..\x.png", r"C:\x.png", "a/../../b.png", "..", "."] {
        let expected = format!("dir/a.mtl:2: texture {file:?} is outside the folder of the mesh");
        assert_eq!(error(&format!("newmtl a\nmap_Kd {file}")), expected);
    }
}
