//! What the loaders' tests share.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A folder of its own for one test, removed at the end.
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new() -> Self {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("gz-load-{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // A folder left behind is no reason to fail a test that passed.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The next number of a splitmix64 sequence: enough for tests, and the same everywhere.
pub(crate) fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

/// `bytes` with one to four random changes: a byte replaced, removed, repeated, or taken from `alphabet`; now and then cut short.
pub(crate) fn mutated(bytes: &[u8], alphabet: &[u8], state: &mut u64) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random(state) % 4 {
        if bytes.is_empty() {
            break;
        }
        let at = random(state) as usize % bytes.len();
        match random(state) % 8 {
            0 => bytes[at] = random(state) as u8,
            1 | 2 => bytes[at] = alphabet[random(state) as usize % alphabet.len()],
            3 => drop(bytes.remove(at)),
            4 | 5 => bytes.insert(at, alphabet[random(state) as usize % alphabet.len()]),
            6 => bytes.insert(at, bytes[at]),
            _ => bytes.truncate(at.max(bytes.len() / 2)),
        }
    }
    bytes
}

/// The course's data folder, where `GZ_HW_DATA` points; a line says so when it is absent.
pub(crate) fn course_data() -> Option<PathBuf> {
    let folder = std::env::var_os("GZ_HW_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: GZ_HW_DATA is not set");
    }
    folder
}
