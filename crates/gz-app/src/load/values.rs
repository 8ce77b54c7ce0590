//! Values of scene keys that are more than a word: numbers, colours, vectors, and keys that take one thing or another.

use glam::DVec3;
use gz_core::GzColor;
use gz_shade::{Antialias, Background};
use serde::de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::marker::PhantomData;
use toml::Spanned;

/// A number within the range of f32, whole or not. TOML's `nan` and `inf` are refused here, so nothing later can meet them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Number(pub(super) f64);

impl Number {
    fn checked<E: de::Error>(value: f64) -> Result<Self, E> {
        if value.abs() <= f64::from(f32::MAX) {
            Ok(Self(value))
        } else {
            Err(E::custom(format!("{value} is not a finite number in the range of f32")))
        }
    }

    /// Rounded to f32; finite.
    pub(super) fn f32(self) -> f32 {
        self.0 as f32
    }
}

struct NumberVisitor;

impl Visitor<'_> for NumberVisitor {
    type Value = Number;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number")
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Number, E> {
        Number::checked(value as f64)
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Number, E> {
        Number::checked(value as f64)
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Number, E> {
        Number::checked(value)
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberVisitor)
    }
}

/// Three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Xyz(pub(super) DVec3);

impl<'de> Deserialize<'de> for Xyz {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [x, y, z] = <[Number; 3]>::deserialize(deserializer)?;
        Ok(Self(DVec3::new(x.0, y.0, z.0)))
    }
}

/// One number for all three axes, or three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OneOrThree {
    One(Number),
    Three([Number; 3]),
}

struct OneOrThreeVisitor;

impl<'de> Visitor<'de> for OneOrThreeVisitor {
    type Value = OneOrThree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or an array of three")
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<OneOrThree, E> {
        Number::checked(value as f64).map(OneOrThree::One)
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<OneOrThree, E> {
        Number::checked(value).map(OneOrThree::One)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<OneOrThree, A::Error> {
        <[Number; 3]>::deserialize(de::value::SeqAccessDeserializer::new(seq)).map(OneOrThree::Three)
    }
}

impl<'de> Deserialize<'de> for OneOrThree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrThreeVisitor)
    }
}

impl OneOrThree {
    /// The numbers for x, y and z.
    pub(super) fn xyz(self) -> DVec3 {
        match self {
            Self::One(n) => DVec3::splat(n.0),
            Self::Three([x, y, z]) => DVec3::new(x.0, y.0, z.0),
        }
    }
}

/// A linear colour: one number for grey or three for red, green and blue, none negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Color(pub(super) GzColor);

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        color(OneOrThree::deserialize(deserializer)?)
    }
}

/// A colour of which no channel is above 1: what takes part of the light on its way must not add any, bounce after bounce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tint(pub(super) GzColor);

impl<'de> Deserialize<'de> for Tint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Color(tint) = Color::deserialize(deserializer)?;
        match tint.max_element() {
            most if most <= 1.0 => Ok(Self(tint)),
            most => Err(de::Error::custom(format!("a tint must be at most 1, not {most}"))),
        }
    }
}

/// The greatest channel of a colour. Products of several of them with the light of 32 bounces stay far within f32.
pub(super) const MAX_COLOR: f32 = 1e6;

fn color<E: de::Error>(value: OneOrThree) -> Result<Color, E> {
    let color = value.xyz().as_vec3();
    if color.min_element() < 0.0 {
        return Err(E::custom(format!("a colour must not be negative: {}", color.min_element())));
    }
    if color.max_element() > MAX_COLOR {
        return Err(E::custom(format!("a colour must be at most {MAX_COLOR}, not {}", color.max_element())));
    }
    Ok(Color(color))
}

/// `aa`: a word or a number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aa(pub(super) Antialias);

/// More samples a pixel than this are taken for a slip; the picture would not come to an end.
pub(super) const MAX_SAMPLES: i64 = 4096;

struct AaVisitor;

impl Visitor<'_> for AaVisitor {
    type Value = Aa;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"none\", \"hw6\" or a number of samples")
    }

    fn visit_str<E: de::Error>(self, word: &str) -> Result<Aa, E> {
        match word {
            "none" => Ok(Aa(Antialias::None)),
            "hw6" => Ok(Aa(Antialias::Hw6)),
            _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
        }
    }

    fn visit_i64<E: de::Error>(self, samples: i64) -> Result<Aa, E> {
        let count = u32::try_from(samples).ok().filter(|_| (1..=MAX_SAMPLES).contains(&samples));
        let count = count.ok_or_else(|| E::custom(format!("aa must be 1 to {MAX_SAMPLES} samples, not {samples}")))?;
        Ok(Aa(Antialias::Samples(count)))
    }
}

impl<'de> Deserialize<'de> for Aa {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AaVisitor)
    }
}

/// `background`: a colour, two colours `[bottom, top]`, or a table of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BackgroundValue(pub(super) Background);

/// The table form of a gradient.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GradientKeys {
    bottom: Color,
    top: Color,
}

struct BackgroundVisitor;

impl<'de> Visitor<'de> for BackgroundVisitor {
    type Value = BackgroundValue;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a colour, two colours [bottom, top] or { bottom, top }")
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<BackgroundValue, E> {
        self.visit_f64(value as f64)
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<BackgroundValue, E> {
        let Color(color) = color(OneOrThree::One(Number::checked(value)?))?;
        Ok(BackgroundValue(Background::Plain(color)))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<BackgroundValue, A::Error> {
        let mut items: Vec<OneOrThree> = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(BackgroundValue(match items[..] {
            [OneOrThree::One(r), OneOrThree::One(g), OneOrThree::One(b)] => {
                Background::Plain(color::<A::Error>(OneOrThree::Three([r, g, b]))?.0)
            }
            [bottom, top] => Background::Gradient { bottom: color::<A::Error>(bottom)?.0, top: color::<A::Error>(top)?.0 },
            _ => return Err(de::Error::invalid_length(items.len(), &self)),
        }))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<BackgroundValue, A::Error> {
        let GradientKeys { bottom, top } = GradientKeys::deserialize(MapAccessDeserializer::new(map))?;
        Ok(BackgroundValue(Background::Gradient { bottom: bottom.0, top: top.0 }))
    }
}

impl<'de> Deserialize<'de> for BackgroundValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(BackgroundVisitor)
    }
}

/// One table, or an array of them.
#[derive(Debug)]
pub(super) enum OneOrMany<T> {
    One(Box<T>),
    Many(Vec<Spanned<T>>),
}

struct OneOrManyVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for OneOrManyVisitor<T> {
    type Value = OneOrMany<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table or an array of tables")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OneOrMany<T>, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(|one| OneOrMany::One(Box::new(one)))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<OneOrMany<T>, A::Error> {
        Vec::deserialize(de::value::SeqAccessDeserializer::new(seq)).map(OneOrMany::Many)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrManyVisitor(PhantomData))
    }
}
