//! What can be put as an attribute, and what can go wrong.

use glam::DVec3;
use gz_core::{CameraError, GzColor, StackError, TriError};
use gz_shade::{Interpolate, MaterialKind, Texture};

/// What [`GzRender::gz_put_attribute`](super::GzRender::gz_put_attribute) sets: a token with its value.
#[derive(Clone, Debug, PartialEq)]
pub enum GzAttribute {
    /// `GZ_RGB_COLOR`: the colour of the triangles that follow, unlit (HW2, HW3) until an interpolation mode is set.
    RgbColor(GzColor),
    /// `GZ_INTERPOLATE`: flat, Gouraud (`GZ_COLOR`) or Phong (`GZ_NORMALS`); the triangles that follow are lit.
    Interpolate(Interpolate),
    /// `GZ_DIRECTIONAL_LIGHT`: one more light. `direction` points from the surface to the light, in image space, and is used as given.
    DirectionalLight {
        /// To the light; neither zero nor NaN.
        direction: DVec3,
        /// Its colour.
        color: GzColor,
    },
    /// `GZ_AMBIENT_LIGHT`.
    AmbientLight(GzColor),
    /// `GZ_AMBIENT_COEFFICIENT`, Ka.
    AmbientCoefficient(GzColor),
    /// `GZ_DIFFUSE_COEFFICIENT`, Kd.
    DiffuseCoefficient(GzColor),
    /// `GZ_SPECULAR_COEFFICIENT`, Ks.
    SpecularCoefficient(GzColor),
    /// `GZ_DISTRIBUTION_COEFFICIENT`: the specular power, at least 0.
    DistributionCoefficient(f32),
    /// `GZ_TEXTURE_MAP`; `None` is the homework's null function.
    TextureMap(Option<Texture>),
    /// The paper's own addition, a mark on triangles there (`isMirror`, `isTransparent`): mirror, glass or neither.
    Kind(MaterialKind),
}

/// Why one of the homework's calls failed, where the course returned `GZ_FAILURE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HomeworkError {
    /// The camera does not define a view.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The matrix stack is full or empty, or the matrix not finite.
    #[error(transparent)]
    Stack(#[from] StackError),
    /// The triangle has a coordinate that is not finite, or there are too many.
    #[error(transparent)]
    Triangle(#[from] TriError),
    /// A call came before `gz_begin_render`.
    #[error("gz_begin_render has not been called")]
    NotBegun,
    /// An eleventh directional light.
    #[error("more than 10 directional lights")]
    TooManyLights,
    /// A light without direction.
    #[error("a light's direction is zero or not finite")]
    LightDirection,
    /// More than 65536 combinations of attributes.
    #[error("more than 65536 materials")]
    TooManyMaterials,
    /// A specular power that is negative or NaN.
    #[error("the specular power is negative or not a number")]
    Power,
}
