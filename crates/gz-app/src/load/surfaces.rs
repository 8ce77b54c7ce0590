//! `[[texture]]` and `[[material]]`, and the list of materials that a scene's meshes draw from.

use super::keys::{CheckerKeys, MaterialKeys, TextureKeys};
use super::picture;
use super::source::{Finder, is_course_data};
use super::words::{Kind, Mode, hint};
use crate::error::LoadError;
use gz_core::{GzColor, MaterialId};
use gz_shade::{Interpolate, Material, MaterialKind, Procedural, Surface, Texture, TextureLookup};
use std::collections::HashMap;
use std::path::PathBuf;
use toml::Spanned;

/// The index of refraction of glass that does not say.
pub(super) const DEFAULT_IOR: f32 = 1.5;

/// Indices of refraction that make sense; beyond them lie slips of the keyboard. The greatest known are below 50.
pub(super) const IORS: std::ops::RangeInclusive<f64> = 0.01..=100.0;

/// Materials and textures of a scene while it is read.
#[derive(Debug)]
pub(super) struct Palette {
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Texture>,
    /// Texture files of MTL materials, read once each.
    pub(super) by_path: HashMap<PathBuf, usize>,
    /// How textures are looked up where nothing is said.
    pub(super) lookup: TextureLookup,
    /// Whether texture files are sRGB where nothing is said.
    pub(super) srgb: bool,
    /// Whether mirror and glass have a matt colour of their own where nothing is said.
    bodies_are_matt: bool,
    defaults: [Option<MaterialId>; 2],
}

impl Palette {
    /// Nothing yet, with the defaults of `mode`.
    pub(super) fn new(mode: Mode) -> Self {
        let physical = mode == Mode::Physical;
        Self {
            materials: Vec::new(),
            textures: Vec::new(),
            by_path: HashMap::new(),
            lookup: if physical { TextureLookup::Repeat } else { TextureLookup::Homework },
            srgb: physical,
            bodies_are_matt: !physical,
            defaults: [None, None],
        }
    }

    /// A material of this kind before keys change it.
    ///
    /// The course's coefficients. Under physical rules clear glass and polished metal have no matt colour.
    pub(super) fn base(&self, kind: MaterialKind) -> Material {
        let matt = self.bodies_are_matt || kind == MaterialKind::Phong;
        let base = Material { kind, ..Material::default() };
        if matt { base } else { Material { ka: GzColor::ZERO, kd: GzColor::ZERO, ..base } }
    }

    /// Puts a material on the list.
    ///
    /// # Errors
    ///
    /// If there are 65536 already: triangles name a material by 16 bits.
    pub(super) fn add(&mut self, material: Material) -> Result<MaterialId, String> {
        let id = MaterialId::try_from(self.materials.len()).map_err(|_| "more than 65536 materials".to_owned())?;
        self.materials.push(material);
        Ok(id)
    }

    /// The material of triangles that have none.
    pub(super) fn fallback(&mut self, surface: Surface) -> Result<MaterialId, String> {
        let slot = usize::from(surface == Surface::AppColor);
        if let Some(id) = self.defaults[slot] {
            return Ok(id);
        }
        let interpolate = if surface == Surface::AppColor { Interpolate::Flat } else { Interpolate::Phong };
        let id = self.add(Material { name: "default".to_owned(), surface, interpolate, ..Material::default() })?;
        self.defaults[slot] = Some(id);
        Ok(id)
    }
}

/// The names that a scene file gave its materials.
pub(super) type MaterialNames = HashMap<String, MaterialId>;

/// The material that a scene calls `name`.
pub(super) fn named(finder: &Finder<'_>, names: &MaterialNames, name: &Spanned<String>) -> Result<MaterialId, LoadError> {
    lookup_name(finder, names, name, "material")
}

fn lookup_name<T: Copy>(
    finder: &Finder<'_>,
    names: &HashMap<String, T>,
    name: &Spanned<String>,
    what: &str,
) -> Result<T, LoadError> {
    names.get(name.get_ref()).copied().ok_or_else(|| {
        let mut known: Vec<&str> = names.keys().map(String::as_str).collect();
        known.sort_unstable();
        let hint = hint(name.get_ref(), &known);
        finder.text.error(name.span(), format!("{what} \"{}\" is not defined{hint}", name.get_ref()))
    })
}

/// Reads textures and materials.
pub(super) fn palette(
    finder: &Finder<'_>,
    textures: &[Spanned<TextureKeys>],
    materials: &[Spanned<MaterialKeys>],
    mode: Mode,
    warnings: &mut Vec<String>,
) -> Result<(Palette, MaterialNames), LoadError> {
    let mut palette = Palette::new(mode);
    let mut texture_names = HashMap::new();
    for keys in textures {
        let name = &keys.get_ref().name;
        let texture = texture(finder, keys, &palette, warnings)?;
        palette.textures.push(texture);
        define(finder, &mut texture_names, name, palette.textures.len() - 1, "texture")?;
    }
    let mut names = MaterialNames::new();
    for keys in materials {
        let name = &keys.get_ref().name;
        let material = material(finder, keys, &palette, &texture_names)?;
        let id = palette.add(material).map_err(|message| finder.text.error(name.span(), message))?;
        define(finder, &mut names, name, id, "material")?;
    }
    Ok((palette, names))
}

fn define<T>(
    finder: &Finder<'_>,
    names: &mut HashMap<String, T>,
    name: &Spanned<String>,
    value: T,
    what: &str,
) -> Result<(), LoadError> {
    match names.insert(name.get_ref().clone(), value) {
        None => Ok(()),
        Some(_) => Err(finder.text.error(name.span(), format!("{what} \"{}\" is defined twice", name.get_ref()))),
    }
}

fn texture(
    finder: &Finder<'_>,
    texture: &Spanned<TextureKeys>,
    palette: &Palette,
    warnings: &mut Vec<String>,
) -> Result<Texture, LoadError> {
    let keys = texture.get_ref();
    let refuse = |span, message: &str| Err(finder.text.error(span, message));
    let Some(file) = &keys.file else {
        let Some(given) = &keys.checker else { return refuse(texture.span(), "a texture needs a file or a checker") };
        if keys.lookup.is_some() || keys.shift.is_some() || keys.srgb.is_some() || keys.or.is_some() {
            return refuse(texture.span(), "lookup, shift, srgb and or belong to a texture with a file");
        }
        return checker(finder, given);
    };
    if let Some(checker) = &keys.checker {
        return refuse(checker.span(), "a texture has a file or a checker, not both");
    }
    if let Some(or) = &keys.or
        && !is_course_data(file.get_ref())
    {
        return refuse(or.span(), "or stands in for course data: file must begin with hw:");
    }
    let read = |path: PathBuf, shift| {
        let lookup = keys.lookup.map_or(palette.lookup, |word| word.0);
        picture::texture(&path, lookup, keys.srgb.unwrap_or(palette.srgb), shift).map(Texture::Image)
    };
    match (finder.find(file), &keys.or) {
        (Ok(path), _) => read(path, keys.shift.unwrap_or(false)),
        (Err(absent), Some(or)) if absent.is_course_data => {
            warnings.push(format!("{}; its stand-in is used", absent.error));
            match (&or.get_ref().file, &or.get_ref().checker) {
                // The shift undoes what the course's loader does to the course's file; another file has no need of it.
                (Some(file), None) => read(finder.find(file).map_err(|absent| absent.error)?, false),
                (None, Some(given)) => checker(finder, given),
                _ => refuse(or.span(), "or of a texture needs a file or a checker"),
            }
        }
        (Err(absent), _) => Err(absent.error),
    }
}

fn checker(finder: &Finder<'_>, checker: &Spanned<CheckerKeys>) -> Result<Texture, LoadError> {
    let keys = checker.get_ref();
    let (across, down) = (keys.across.f32(), keys.down.f32());
    if !(across > 0.0 && down > 0.0) {
        return Err(finder.text.error(checker.span(), "a checker needs across and down above 0"));
    }
    let colors = keys.colors.map_or([GzColor::ONE, GzColor::ZERO], |colors| colors.map(|color| color.0));
    Ok(Texture::Procedural(Procedural::Checker { across, down, colors }))
}

fn material(
    finder: &Finder<'_>,
    material: &Spanned<MaterialKeys>,
    palette: &Palette,
    textures: &HashMap<String, usize>,
) -> Result<Material, LoadError> {
    let keys = material.get_ref();
    let ior = match &keys.ior {
        None => None,
        Some(ior) if IORS.contains(&ior.get_ref().0) => Some(ior.get_ref().f32()),
        Some(ior) => {
            let message = format!("ior must be {} to {}, not {}", IORS.start(), IORS.end(), ior.get_ref().0);
            return Err(finder.text.error(ior.span(), message));
        }
    };
    let kind = match (keys.kind.map_or(Kind::Phong, |word| word.0), ior) {
        (Kind::Phong, None) => MaterialKind::Phong,
        (Kind::Phong, Some(_)) => {
            return Err(finder.text.error(material.span(), "ior belongs to a material of kind mirror or glass"));
        }
        (Kind::Mirror, ior) => MaterialKind::Mirror { ior },
        (Kind::Glass, ior) => MaterialKind::Glass { ior: ior.unwrap_or(DEFAULT_IOR) },
    };
    let base = palette.base(kind);
    let power = match &keys.power {
        None => base.power,
        Some(power) if power.get_ref().0 >= 0.0 => power.get_ref().f32(),
        Some(power) => {
            let message = format!("power must not be negative: {}", power.get_ref().0);
            return Err(finder.text.error(power.span(), message));
        }
    };
    let texture = keys.texture.as_ref().map(|name| lookup_name(finder, textures, name, "texture")).transpose()?;
    Ok(Material {
        name: keys.name.get_ref().clone(),
        ka: keys.ka.map_or(base.ka, |color| color.0),
        kd: keys.kd.map_or(base.kd, |color| color.0),
        ks: keys.ks.map_or(base.ks, |color| color.0),
        power,
        kind,
        tint: keys.tint.map_or(base.tint, |color| color.0),
        texture,
        interpolate: keys.interpolate.map_or(base.interpolate, |word| word.0),
        surface: keys.surface.map_or(base.surface, |word| word.0),
    })
}
