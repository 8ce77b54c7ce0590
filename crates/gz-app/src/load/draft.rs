//! A scene that is read but not placed: enough to know what it needs, with the meshes waiting.

use super::part::Part;
use super::surfaces::Palette;
use crate::error::LoadError;
use gz_core::{GzCamera, GzColor, MaterialId, NO_TRI, TriBuffer, TriError};
use gz_shade::{Background, GzLight, Material, Scene, ShadeRules, Surface};
use std::path::Path;

/// A scene before its triangles are placed.
///
/// [`gz_shade::SceneNeeds::of`] answers from [`Self::scene`] already; [`Self::place`] then stores only what is needed.
#[derive(Debug)]
pub struct Draft {
    /// The scene with an empty triangle buffer. `used` is filled: triangles that the camera drops are not counted in it.
    pub scene: Scene,
    /// What was odd but usable, one line each with its file.
    pub warnings: Vec<String>,
    /// Triangles that the camera model drops for a corner behind the view plane. They keep their number and are never hit.
    pub dropped: u64,
    pub(super) parts: Vec<Part>,
    pub(super) numbers: MaterialNumbers,
}

impl Draft {
    /// All triangles, those dropped included: the length of the triangle buffer after placing.
    pub fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.mesh.triangles.len()).sum()
    }
}

/// From the palette's numbers to the scene's: materials in use come first, so that a single one is number 0 and need not be
/// stored with each triangle; triangles without texture coordinates get an untextured twin.
#[derive(Debug)]
pub(super) struct MaterialNumbers(Vec<[MaterialId; 2]>);

impl MaterialNumbers {
    /// The scene's number for a triangle of palette material `material`, with texture coordinates or without.
    pub(super) fn of(&self, material: MaterialId, has_uv: bool) -> MaterialId {
        self.0[usize::from(material)][usize::from(!has_uv)]
    }
}

/// The parts of a scene that are not triangles or materials.
#[derive(Debug)]
pub(super) struct Surroundings {
    pub(super) camera: GzCamera,
    pub(super) lights: Vec<GzLight>,
    pub(super) ambient: GzColor,
    pub(super) background: Background,
    pub(super) rules: ShadeRules,
}

/// Puts a draft together and counts which materials are in use.
///
/// # Errors
///
/// If there is no triangle or there are too many, a material needs a colour that its mesh does not have, or there are too many
/// materials. Errors that concern no mesh name `path`.
pub(super) fn assemble(
    path: &Path,
    around: Surroundings,
    parts: Vec<Part>,
    mut palette: Palette,
    mut warnings: Vec<String>,
) -> Result<Draft, LoadError> {
    let total: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    if total == 0 {
        return Err(LoadError::bad(path, None, "no triangles"));
    }
    if !u32::try_from(total).is_ok_and(|n| n < NO_TRI) {
        return Err(LoadError::bad(path, None, TriError::TooMany.to_string()));
    }
    let Surroundings { camera, lights, ambient, background, rules } = around;
    let (counts, dropped) = count(&camera, &parts, &palette, &mut warnings)?;
    if dropped > 0 {
        warnings.push(format!("{}: {dropped} of {total} triangles reach behind the view plane and are dropped", path.display()));
    }
    if lights.is_empty() && ambient == GzColor::ZERO && palette.materials.iter().any(|m| m.surface == Surface::Shaded) {
        warnings.push(format!("{}: there is no light, and no ambient light either", path.display()));
    }
    let (numbers, materials, used) = number(&mut palette, &counts).map_err(|why| LoadError::bad(path, None, why))?;
    let textures = palette.textures;
    let tris = TriBuffer::new();
    let scene = Scene { tris, camera, lights, ambient, background, materials, used, textures, rules };
    Ok(Draft { scene, warnings, dropped, parts, numbers })
}

/// Triangles of each palette material, with texture coordinates and without.
type Counts = Vec<[u64; 2]>;

fn count(camera: &GzCamera, parts: &[Part], palette: &Palette, warnings: &mut Vec<String>) -> Result<(Counts, u64), LoadError> {
    let mut counts: Counts = vec![[0; 2]; palette.materials.len()];
    let mut dropped = 0;
    for part in parts {
        let mut untextured = 0_u64;
        for (i, tri) in part.mesh.triangles.iter().enumerate() {
            if part.is_dropped(camera, i) {
                dropped += 1;
                continue;
            }
            let id = usize::from(part.material(i));
            let material = &palette.materials[id];
            if material.surface == Surface::AppColor && part.app_color.is_none() {
                let name = &material.name;
                return Err(part.error(format!("material \"{name}\" shows the application's colour: the mesh needs app_color")));
            }
            untextured += u64::from(material.texture.is_some() && tri.uv.is_none());
            counts[id][usize::from(tri.uv.is_none())] += 1;
        }
        if untextured > 0 {
            let label = &part.label;
            warnings.push(format!("{label}: {untextured} triangles have no texture coordinates and show no texture"));
        }
    }
    Ok((counts, dropped))
}

type Numbered = (MaterialNumbers, Vec<Material>, Vec<u64>);

/// A material of the scene on its way to its number.
struct Row {
    used: u64,
    material: Material,
    /// The entries of [`MaterialNumbers`] that name it.
    serves: Vec<(usize, usize)>,
}

fn number(palette: &mut Palette, counts: &Counts) -> Result<Numbered, String> {
    let mut rows = Vec::with_capacity(counts.len());
    for (id, (material, &[with, without])) in palette.materials.drain(..).zip(counts).enumerate() {
        if material.texture.is_some() && without > 0 {
            let twin = Material { texture: None, ..material.clone() };
            rows.push(Row { used: with, material, serves: vec![(id, 0)] });
            rows.push(Row { used: without, material: twin, serves: vec![(id, 1)] });
        } else {
            rows.push(Row { used: with + without, material, serves: vec![(id, 0), (id, 1)] });
        }
    }
    // Stable, so the scene's order stays within each half.
    rows.sort_by_key(|row| row.used == 0);
    let mut numbers = vec![[0; 2]; counts.len()];
    let (mut materials, mut used) = (Vec::with_capacity(rows.len()), Vec::with_capacity(rows.len()));
    for (number, row) in rows.into_iter().enumerate() {
        let number = MaterialId::try_from(number).map_err(|_| "more than 65536 materials".to_owned())?;
        for (id, slot) in row.serves {
            numbers[id][slot] = number;
        }
        materials.push(row.material);
        used.push(row.used);
    }
    Ok((MaterialNumbers(numbers), materials, used))
}
