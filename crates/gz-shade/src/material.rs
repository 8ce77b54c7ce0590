//! What a surface is made of.

use gz_core::{GzColor, TriClass};

/// How normals or colours vary over a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolate {
    /// One normal a triangle: its face normal (`GZ_FLAT`).
    Flat,
    /// Shaded at the corners, colours interpolated: Gouraud (`GZ_COLOR`).
    Gouraud,
    /// Normals interpolated, shaded at the hit: Phong (`GZ_NORMALS`).
    #[default]
    Phong,
}

/// What happens to a ray at a surface beside local shading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MaterialKind {
    /// Local shading only.
    #[default]
    Phong,
    /// Reflects. With an index of refraction the reflected share follows Fresnel; without one it is `tint` whole (an ideal metal).
    Mirror {
        /// Index of refraction of the mirror's body, above 0; `None` for an ideal mirror.
        ior: Option<f32>,
    },
    /// Reflects and refracts by Fresnel and Snell.
    Glass {
        /// Index of refraction inside, above 0.
        ior: f32,
    },
}

/// Where the colour of local shading comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Surface {
    /// The shading equation with Ka, Kd, Ks (HW4 on).
    #[default]
    Shaded,
    /// The colour that the application gave each triangle, unlit (`GZ_RGB_COLOR` with `GZ_FLAT`; HW2 and HW3).
    AppColor,
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the scene.
    pub name: String,
    /// Ambient coefficient.
    pub ka: GzColor,
    /// Diffuse coefficient.
    pub kd: GzColor,
    /// Specular coefficient.
    pub ks: GzColor,
    /// Specular power (the homework's distribution coefficient), at least 0. Integers are computed by repeated squaring.
    pub power: f32,
    /// Mirror, glass or neither.
    pub kind: MaterialKind,
    /// Multiplies what a mirror reflects and what glass lets through.
    pub tint: GzColor,
    /// Index into the scene's textures.
    pub texture: Option<usize>,
    /// Flat, Gouraud or Phong.
    pub interpolate: Interpolate,
    /// Shaded or coloured by the application.
    pub surface: Surface,
}

impl Default for Material {
    /// White, half matt, no texture.
    fn default() -> Self {
        Self {
            name: String::new(),
            ka: GzColor::splat(0.1),
            kd: GzColor::splat(0.7),
            ks: GzColor::splat(0.3),
            power: 32.0,
            kind: MaterialKind::Phong,
            tint: GzColor::ONE,
            texture: None,
            interpolate: Interpolate::Phong,
            surface: Surface::Shaded,
        }
    }
}

impl Material {
    /// How triangles of this material meet shadow rays.
    pub fn class(&self) -> TriClass {
        match self.kind {
            MaterialKind::Glass { .. } => TriClass::Glass,
            _ => TriClass::Opaque,
        }
    }
}
