//! docs/SCENE.md and the keys that the program reads are the same.

use super::keys::*;
use super::scratch::draft;
use super::values::GradientKeys;
use super::words::{Kind, LightSpace, Mode, NormalsRule, Words};
use gz_core::CameraModel;
use gz_shade::{ColorCode, Eye, Fresnel, GlassBlend, Interpolate, MirrorBlend, ShadowRule, Surface, TextureLookup};
use serde::Deserialize;
use serde::de::value::Error;
use serde::de::{Deserializer, Error as _, Visitor};
use serde::forward_to_deserialize_any;

const REFERENCE: &str = include_str!("../../../../docs/SCENE.md");

/// Hears which keys a table has when it asks to be read, and then refuses.
struct Keys<'a>(&'a mut Vec<&'static str>);

impl<'de> Deserializer<'de> for Keys<'_> {
    type Error = Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        _visitor: V,
    ) -> Result<V::Value, Error> {
        self.0.extend(fields);
        Err(Error::custom("keys heard"))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Error> {
        Err(Error::custom("not a table"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct newtype_struct seq tuple
        tuple_struct map enum identifier ignored_any
    }
}

fn keys<'de, T: Deserialize<'de>>() -> Vec<&'static str> {
    let mut keys = Vec::new();
    assert!(T::deserialize(Keys(&mut keys)).is_err());
    keys
}

/// The text below the heading `heading`, up to the next heading.
fn section(heading: &str) -> &'static str {
    let start = REFERENCE.find(&format!("# {heading}\n")).unwrap_or_else(|| panic!("no heading {heading}"));
    let body = REFERENCE[start..].split_once('\n').map_or("", |(_, body)| body);
    body.split("\n#").next().unwrap_or_default()
}

/// The keys that a table of the reference lists, in its order.
fn listed(heading: &str) -> Vec<&'static str> {
    section(heading).lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect()
}

#[test]
fn every_key_is_in_the_reference_and_the_other_way_round() {
    let tables = [
        ("Top of the file", keys::<SceneKeys>()),
        ("`background` as a table", keys::<GradientKeys>()),
        ("`[render]`", keys::<RenderKeys>()),
        ("`[camera]`", keys::<CameraKeys>()),
        ("`[[light]]`", keys::<LightKeys>()),
        ("`[[texture]]`", keys::<TextureKeys>()),
        ("`checker`", keys::<CheckerKeys>()),
        ("`or` of a texture", keys::<TextureOrKeys>()),
        ("`[[material]]`", keys::<MaterialKeys>()),
        ("`[[mesh]]`", keys::<MeshKeys>()),
        ("`teapot`", keys::<TeapotKeys>()),
        ("A step of `place`", keys::<PlaceKeys>()),
        ("`override`", keys::<OverrideKeys>()),
        ("`app_color`", keys::<AppColorKeys>()),
    ];
    for (heading, mut keys) in tables {
        assert!(!keys.is_empty(), "{heading}");
        let mut listed = listed(heading);
        keys.sort_unstable();
        listed.sort_unstable();
        assert_eq!(listed, keys, "{heading}");
    }
}

#[test]
fn every_word_is_in_the_row_of_its_key() {
    fn check<T: Words>(heading: &str, key: &str) {
        let row = section(heading).lines().find(|line| line.starts_with(&format!("| `{key}` |"))).unwrap();
        let listed: Vec<&str> = row.split('|').nth(2).unwrap().split('"').skip(1).step_by(2).collect();
        let known: Vec<&str> = T::WORDS.iter().map(|&(word, _)| word).collect();
        assert_eq!(listed, known, "{key}");
    }
    check::<Mode>("`[render]`", "mode");
    check::<Fresnel>("`[render]`", "fresnel");
    check::<ShadowRule>("`[render]`", "shadow");
    check::<Eye>("`[render]`", "eye");
    check::<MirrorBlend>("`[render]`", "mirror_blend");
    check::<GlassBlend>("`[render]`", "glass_blend");
    check::<ColorCode>("`[render]`", "color_code");
    check::<CameraModel>("`[camera]`", "model");
    check::<LightSpace>("`[[light]]`", "space");
    check::<TextureLookup>("`[[texture]]`", "lookup");
    check::<Kind>("`[[material]]`", "kind");
    check::<Interpolate>("`[[material]]`", "interpolate");
    check::<Surface>("`[[material]]`", "surface");
    check::<NormalsRule>("`[[mesh]]`", "normals");
}

#[test]
fn the_table_of_modes_is_what_the_modes_are() {
    for (column, mode) in [(2, Mode::Physical), (3, Mode::Homework), (4, Mode::Paper)] {
        let r = mode.rules();
        let says = |key: &str| {
            let row = section("Modes").lines().find(|line| line.starts_with(&format!("| `{key}` |"))).unwrap();
            row.split('|').nth(column).unwrap().trim()
        };
        fn word<T: Words + PartialEq>(meaning: T) -> &'static str {
            T::WORDS.iter().find(|(_, known)| *known == meaning).unwrap().0
        }
        assert_eq!(says("shadow"), word(r.shadow), "{mode:?}");
        assert_eq!(says("eye"), word(r.eye), "{mode:?}");
        assert_eq!(says("mirror_blend"), word(r.mirror_blend), "{mode:?}");
        assert_eq!(says("glass_blend"), word(r.glass_blend), "{mode:?}");
        assert_eq!(says("color_code"), word(r.color_code), "{mode:?}");
        assert_eq!(says("clamp_levels"), r.clamp_levels.to_string(), "{mode:?}");
        assert_eq!(says("screen_interpolation"), r.screen_interpolation.to_string(), "{mode:?}");
        assert_eq!(says("geometric_sides"), r.geometric_sides.to_string(), "{mode:?}");
        assert_eq!(says("flat_textures"), r.flat_textures.to_string(), "{mode:?}");
    }
}

#[test]
fn the_example_is_a_scene_without_a_complaint() {
    let example = REFERENCE.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let draft = draft(example);
    assert_eq!(draft.warnings, [""; 0]);
    assert_eq!((draft.scene.materials.len(), draft.scene.lights.len()), (2, 1));
}
