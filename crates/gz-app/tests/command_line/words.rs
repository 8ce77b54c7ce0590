//! P23 for the command line: no words make it panic or say more than one line.

use crate::folder::Folder;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn p23_no_words_make_the_command_panic(words in prop::collection::vec(prop_oneof![
        6 => prop::sample::select(vec![
            "render", "query", "info", "pixel", "compare", "scene.toml", "none.toml", "none.obj", "a.hits", ".", "..", "--size", "0x0", "1x1",
            "99999999999999999999", "-1", "--aa", "--crop", "0,0,1,1", "1,1,0,0", "--leave", "epsilon=x", "--kernel", "woop", "--rays", "--hits",
            "--mesh", "--threads", "-o", "x.png", "--accel", "brute", "--split", "midpoint", "--max-depth", "--depth", "--tile", "--", "-",
        ]).prop_map(str::to_owned),
        1 => "[!-~]{1,12}".prop_map(|word| word.replace('/', "_")),
    ], 0..9)) {
        // A scene of two pixels, so that what is understood is done quickly.
        let folder = Folder::new("words");
        folder.write("scene.toml", &crate::folder::SCENE.replace("[camera]", "[render]\nsize = [2, 1]\n[camera]"));
        let ended = folder.gz(&words.join(" "));
        prop_assert!((0..=4).contains(&ended.code), "{:?}: {}", words, ended.code);
        prop_assert!(!ended.err.contains("panicked"), "{:?}: {}", words, ended.err);
        // A failure is told in one line; what is done may say more (progress, warnings).
        prop_assert!(ended.code == 0 || ended.err.lines().filter(|line| !line.starts_with("gz: warning")).count() >= 1, "{:?}", words);
        prop_assert!(ended.code != 2 || ended.err.lines().count() == 1, "{:?}: {}", words, ended.err);
        prop_assert!(!folder.names().iter().any(|name| name.ends_with(".part")), "{:?} left half a file", words);
    }
}
