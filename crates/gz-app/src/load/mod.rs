//! Files in.
//!
//! [`scene`] reads a scene file, or a bare mesh, to a [`Draft`]; [`Draft::place`] gives the scene to render. In between,
//! [`gz_shade::SceneNeeds::of`] looks at the draft and decides what placing has to store.

pub mod asc;
pub mod obj;
pub mod picture;

mod bare;
mod draft;
mod entries;
mod inline;
mod keys;
mod lights;
#[cfg(test)]
mod meaning_tests;
mod mtl;
mod normals;
mod own_material;
mod part;
mod place;
mod polygon;
#[cfg(test)]
mod range_tests;
#[cfg(test)]
mod reference_tests;
mod scene_file;
#[cfg(test)]
mod scratch;
mod settings;
mod source;
mod spot;
mod surfaces;
#[cfg(test)]
mod testing;
mod text;
mod values;
mod words;

pub use draft::Draft;
pub use scene_file::{expect_scene, scene};
pub use settings::Overrides;
