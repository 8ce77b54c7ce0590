//! What `cargo xtask verify` runs: hard rays, whole frames and builds against the independent truth and each other.

mod certifier;
mod hashes;
mod options;
mod rays;
mod record;
mod scene;
mod state;
mod tables;

pub use certifier::{Certificate, Kind, certify};
pub use hashes::{Hash, hashes, of_hits};
pub use options::{RayOptions, SceneOptions};
pub use rays::verify_rays;
pub use record::{KERNELS, Record};
pub use scene::verify_scenes;
pub use tables::bounded;
