//! `cargo xtask verify builds` runs this in every build: the T-buffers of all scenes as numbers to compare.

use crate::bench::scenes::{asset_scenes, has_course_data, loaded};
use gz_app::error::AppError;
use gz_app::hits_file;
use gz_bsp::BspTree;
use gz_core::{Hit, SimdLevel, TBuffer};

/// The T-buffer of a scene at a SIMD level, as a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hash {
    /// The scene's stem.
    pub scene: String,
    /// The level that was asked for.
    pub level: SimdLevel,
    /// FNV-1a over the buffer in the hits format.
    pub hash: u64,
}

/// Width of the pictures.
const WIDTH: u32 = 320;

/// Every scene of assets that this machine can load, at every SIMD level that it has.
///
/// # Errors
///
/// If a scene cannot be loaded for another reason than absent course data.
pub fn hashes() -> Result<Vec<Hash>, AppError> {
    let mut hashes = Vec::new();
    for path in asset_scenes()? {
        let (scene, _) = match loaded(&path, WIDTH) {
            Ok(loaded) => loaded,
            Err(AppError::Load(error)) if !has_course_data() && error.message.contains("GZ_HW_DATA") => continue,
            Err(error) => return Err(error),
        };
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for &level in SimdLevel::available() {
            let hits = TBuffer::trace(&scene.camera, &BspTree::build(&scene.tris).with_simd(level)).hits;
            hashes.push(Hash { scene: name.clone(), level, hash: of_hits(&hits) });
        }
    }
    Ok(hashes)
}

/// A number for a T-buffer.
pub fn of_hits(hits: &[Hit]) -> u64 {
    let byte = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    hits_file::encode(hits).iter().fold(0xcbf2_9ce4_8422_2325, byte)
}

impl std::fmt::Display for Hash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {:?} {:016x}", self.scene, self.level, self.hash)
    }
}
