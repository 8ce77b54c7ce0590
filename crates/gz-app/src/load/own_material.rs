//! The materials that a mesh file brings: MTL values as a material of the renderer.

use super::picture;
use super::surfaces::{DEFAULT_IOR, Palette};
use crate::error::LoadError;
use crate::mesh::{Mesh, MeshMaterial, MeshTexture};
use gz_core::{GzColor, MaterialId};
use gz_shade::{Material, MaterialKind, Surface, Texture};
use std::path::Path;

/// Puts the materials that triangles of `mesh` use on the list. Entry `k` is for `mesh.materials[k]`; an unused one is `None`.
///
/// # Errors
///
/// If a texture cannot be used, or there are too many materials.
pub(super) fn own_materials(
    palette: &mut Palette,
    mesh: &Mesh,
    path: &Path,
    warnings: &mut Vec<String>,
) -> Result<Vec<Option<MaterialId>>, LoadError> {
    let mut in_use = vec![false; mesh.materials.len()];
    for tri in &mesh.triangles {
        if let Some(used) = tri.material.and_then(|m| in_use.get_mut(usize::from(m))) {
            *used = true;
        }
    }
    let mut ids = Vec::with_capacity(in_use.len());
    for (material, used) in mesh.materials.iter().zip(in_use) {
        ids.push(if used { Some(add(palette, material, path, warnings)?) } else { None });
    }
    Ok(ids)
}

fn add(palette: &mut Palette, material: &MeshMaterial, path: &Path, warnings: &mut Vec<String>) -> Result<MaterialId, LoadError> {
    let mut made = shaded(palette, material);
    if let Some(illum) = material.illum.filter(|&illum| !(0..=3).contains(&illum) && !(5..=7).contains(&illum)) {
        let name = &material.name;
        warnings.push(format!("{}: illum {illum} of material \"{name}\" is shown as illum 2", path.display()));
    }
    if let Some(map) = &material.map_kd {
        let file = &map.file;
        made.texture = Some(match palette.by_path.get(file) {
            Some(&known) => known,
            None => {
                let read = picture::texture(file, palette.lookup, palette.srgb, false).map_err(|error| refused(map, &error))?;
                palette.textures.push(Texture::Image(read));
                palette.by_path.insert(file.clone(), palette.textures.len() - 1);
                palette.textures.len() - 1
            }
        });
    }
    palette.add(made).map_err(|message| LoadError::bad(path, None, message))
}

/// What is wrong with a texture, at the line that names it. Warnings are lost with the mesh, so dropped options are told here.
fn refused(map: &MeshTexture, error: &LoadError) -> LoadError {
    let mut message = format!("{}: {}", error.message, map.file.display());
    if !map.dropped.is_empty() {
        message += &format!(" (map_Kd option {} is not supported, ignored)", map.dropped.join(", "));
    }
    LoadError::bad(&map.library, map.line, message)
}

/// The material without its texture.
///
/// `illum` 0 and 1 have no highlight; 3 is an ideal mirror that reflects by Ks, 5 one that reflects by Fresnel; 6 and 7 are glass,
/// tinted by Tf; everything else is Phong. A value that the file does not give is the renderer's default.
fn shaded(palette: &Palette, given: &MeshMaterial) -> Material {
    let kind = match given.illum {
        Some(3) => MaterialKind::Mirror { ior: None },
        Some(5) => MaterialKind::Mirror { ior: Some(given.ni.unwrap_or(DEFAULT_IOR)) },
        Some(6 | 7) => MaterialKind::Glass { ior: given.ni.unwrap_or(DEFAULT_IOR) },
        _ => MaterialKind::Phong,
    };
    let base = palette.base(kind);
    let color = |value: Option<[f32; 3]>, default: GzColor| value.map_or(default, GzColor::from_array);
    let tint = match given.illum {
        Some(3) => color(given.ks, base.tint),
        Some(6 | 7) => color(given.tf, base.tint),
        _ => base.tint,
    };
    let ks = if matches!(given.illum, Some(0 | 1)) { GzColor::ZERO } else { color(given.ks, base.ks) };
    Material {
        name: given.name.clone(),
        ka: color(given.ka, base.ka),
        kd: color(given.kd, base.kd),
        ks,
        power: given.ns.unwrap_or(base.power),
        tint,
        surface: Surface::Shaded,
        ..base
    }
}

#[cfg(test)]
mod tests {
    use super::super::words::Mode;
    use super::*;

    fn mtl(illum: Option<u32>) -> MeshMaterial {
        MeshMaterial {
            name: "m".to_owned(),
            ka: None,
            kd: Some([0.2, 0.3, 0.4]),
            ks: Some([0.9, 0.8, 0.7]),
            ns: Some(7.0),
            ni: Some(1.3),
            tf: Some([0.5, 1.0, 1.0]),
            illum,
            map_kd: None,
        }
    }

    #[test]
    fn illum_decides_the_kind() {
        let palette = Palette::new(Mode::Physical);
        let of = |illum| shaded(&palette, &mtl(illum));
        assert_eq!((of(None).kind, of(Some(2)).kind), (MaterialKind::Phong, MaterialKind::Phong));
        assert_eq!(of(Some(3)).kind, MaterialKind::Mirror { ior: None });
        assert_eq!(of(Some(3)).tint, GzColor::new(0.9, 0.8, 0.7));
        assert_eq!(of(Some(5)).kind, MaterialKind::Mirror { ior: Some(1.3) });
        assert_eq!(of(Some(7)).kind, MaterialKind::Glass { ior: 1.3 });
        assert_eq!(of(Some(6)).tint, GzColor::new(0.5, 1.0, 1.0));
        assert_eq!((of(Some(1)).ks, of(Some(2)).ks), (GzColor::ZERO, GzColor::new(0.9, 0.8, 0.7)));
        assert_eq!((of(None).power, of(None).kd), (7.0, GzColor::new(0.2, 0.3, 0.4)));
        assert_eq!((of(None).ka, of(Some(6)).ka), (GzColor::splat(0.1), GzColor::ZERO));
    }

    #[test]
    fn an_unknown_illum_is_phong_with_a_warning() {
        let (mut palette, mut warnings) = (Palette::new(Mode::Physical), Vec::new());
        add(&mut palette, &mtl(Some(9)), Path::new("a.obj"), &mut warnings).unwrap();
        assert_eq!(warnings, ["a.obj: illum 9 of material \"m\" is shown as illum 2"]);
        assert_eq!(palette.materials[0].kind, MaterialKind::Phong);
    }
}
