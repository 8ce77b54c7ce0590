//! Our tree against other ray tracers, on the same rays in the same run: `cargo xtask bench peers`.
//!
//! Competitors are shared libraries with the C interface of `tests/peers/harness/peer.h`; `harness/race.cpp` loads them and lets them
//! take turns. Here is what comes before, the workshop with its meshes, and what comes after, the tables.

mod builds;
mod frame_rays;
mod meshes;
mod options;
mod scaling;
mod traces;
mod workshop;

use gz_app::error::AppError;
use meshes::Mesh;
pub(super) use options::workshop_folder;
use options::{MESHES, Options};
use workshop::Workshop;

/// Does what `words` ask for, printing as it goes.
///
/// # Errors
///
/// Usage errors, tools that are missing, meshes that cannot be had, and answers that robust Embree does not share.
pub fn run(words: &[String]) -> Result<(), AppError> {
    let options = Options::parse(words)?;
    let workshop = Workshop::open(&options.dir)?;
    let meshes = meshes(&workshop, &options)?;
    if options.build { builds::run(&workshop, &options, &meshes) } else { traces::run(&workshop, &options, &meshes) }
}

/// The meshes asked for. Of those that nobody asked for by name, one that cannot be had is left out, which is said.
fn meshes(workshop: &Workshop, options: &Options) -> Result<Vec<Mesh>, AppError> {
    if !options.meshes.is_empty() {
        return options.meshes.iter().map(|name| meshes::mesh(workshop, name)).collect();
    }
    let mut found = Vec::new();
    for name in MESHES {
        match meshes::mesh(workshop, name) {
            Ok(mesh) => found.push(mesh),
            Err(error) => println!("{name}: left out: {error}"),
        }
    }
    if found.is_empty() { Err(AppError::Io("there is no mesh to race on".to_owned())) } else { Ok(found) }
}
