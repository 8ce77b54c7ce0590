//! `gz query`: a file of rays against a mesh, hits to a file.

use crate::accel::Accel;
use crate::cli::QueryArgs;
use crate::error::{AppError, LoadError};
use crate::load::{self, Overrides};
use crate::new_file::NewFile;
use crate::progress::say;
use crate::rays_file::RayFormat;
use crate::{hits_file, threads};
use gz_core::{CameraModel, ClassMask, GzRay, Hit, PerRay, RayBatch, RayQuery, TriBuffer};
use gz_shade::SceneNeeds;
use rayon::prelude::*;
use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::time::Instant;

/// Rays read, traced and written at a time.
const AT_A_TIME: usize = 1 << 20;

/// Rays of one batch: a thread's share of [`AT_A_TIME`].
const A_BATCH: usize = 1 << 12;

/// The hit that `--any` writes for a ray that meets something.
const OCCLUDED: Hit = Hit { t: 0.0, tri: 0, u: 0.0, v: 0.0 };

/// Answers a file of rays and returns what there is to say about it.
///
/// # Errors
///
/// If a file cannot be read or written, the mesh cannot be used, or the length of the rays makes no whole number of them.
pub fn query(args: &QueryArgs) -> Result<String, AppError> {
    let accel = Accel::of(&args.accel)?;
    let (path, format) = match (&args.rays, &args.rays64) {
        (Some(path), None) => (path, RayFormat::F32),
        (None, Some(path)) => (path, RayFormat::F64),
        _ => return Err(AppError::Usage("one file of rays is needed: --rays or --rays64".to_owned())),
    };
    let file = NewFile::at(&args.hits)?;
    for (other, what) in [(path, "rays"), (&args.mesh, "mesh")] {
        if file.is(other) {
            return Err(AppError::Usage(format!("{}: --hits would overwrite the {what}", args.hits.display())));
        }
    }
    let rays = Rays::open(path, format)?;
    threads::with(args.threads, || answer(args, &accel, rays, &file))
}

fn answer(args: &QueryArgs, accel: &Accel, mut rays: Rays, file: &NewFile) -> Result<String, AppError> {
    let tris = triangles(&args.mesh)?;
    let start = Instant::now();
    let built = accel.build(&tris)?;
    let build = start.elapsed().as_secs_f64();
    let (mut hit, mut trace) = (0u64, 0.0);
    let total = rays.left;
    file.write_with(|out| {
        while let Some(block) = rays.next_block()? {
            let start = Instant::now();
            let hits = answers(built.query(), &block, args.any);
            trace += start.elapsed().as_secs_f64();
            hit += hits.iter().filter(|hit| hit.is_hit()).count() as u64;
            out.write_all(&hits_file::encode(&hits)).map_err(|error| file.refused(&error))?;
        }
        Ok(())
    })?;
    let speed = if trace > 0.0 { total as f64 / trace * 1e-6 } else { 0.0 };
    Ok(format!(
        "triangles  {}\nanswered   {}\nrays       {total}, {hit} hit\nbuild      {build:.6} s\ntrace      {trace:.6} s, {} threads\n\
         speed      {speed:.3} Mrays/s\n",
        tris.len(),
        built.describe(),
        rayon::current_num_threads(),
    ))
}

/// The triangles of a mesh in its own coordinates, or of a scene in world space.
fn triangles(path: &Path) -> Result<TriBuffer, AppError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let mesh = match extension.as_str() {
        "obj" => load::obj::load(path)?,
        "asc" => load::asc::load(path)?,
        _ => {
            let overrides = Overrides { camera: Some(CameraModel::Pinhole), ..Overrides::NONE };
            let draft = load::scene(path, &overrides)?;
            draft.warnings.iter().for_each(|warning| say(&format!("gz: warning: {warning}")));
            let needs = SceneNeeds::of(&draft.scene);
            return Ok(draft.place(needs)?.tris);
        }
    };
    mesh.warnings.iter().for_each(|warning| say(&format!("gz: warning: {warning}")));
    let corners: Vec<[u32; 3]> = mesh.triangles.iter().map(|tri| tri.position).collect();
    TriBuffer::from_indexed(&mesh.positions, &corners).map_err(|error| LoadError::bad(path, None, error.to_string()).into())
}

/// The front-most hits of `rays` in order; for `any`, [`OCCLUDED`] for those that meet something.
fn answers(query: &dyn RayQuery, rays: &[GzRay], any: bool) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    rays.par_chunks(A_BATCH).zip(hits.par_chunks_mut(A_BATCH)).for_each(|(rays, hits)| {
        let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
        let (tmin, tmax): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
        let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
        let batch = RayBatch::new(rays.len(), origin, direction, PerRay::Each(&tmin), PerRay::Each(&tmax));
        if any {
            let mut occluded = vec![false; rays.len()];
            query.any_hits(&batch, ClassMask::ALL, &mut occluded);
            hits.iter_mut().zip(occluded).filter(|(_, occluded)| *occluded).for_each(|(hit, _)| *hit = OCCLUDED);
        } else {
            query.closest_hits(&batch, ClassMask::ALL, hits);
        }
    });
    hits
}

/// A file of rays, read block by block.
struct Rays {
    path: std::path::PathBuf,
    format: RayFormat,
    file: std::fs::File,
    left: u64,
}

impl Rays {
    fn open(path: &Path, format: RayFormat) -> Result<Self, AppError> {
        let refused = |error: &std::io::Error| AppError::Load(LoadError::io(path, error));
        let file = std::fs::File::open(path).map_err(|error| refused(&error))?;
        let about = file.metadata().map_err(|error| refused(&error))?;
        if about.is_dir() {
            return Err(AppError::Io(format!("{}: is a folder, not a file", path.display())));
        }
        let (bytes, each) = (about.len(), format.ray_bytes() as u64);
        if !bytes.is_multiple_of(each) {
            let message = format!("{bytes} bytes are not a whole number of rays of {each} bytes");
            return Err(LoadError::bad(path, None, message).into());
        }
        Ok(Self { path: path.to_owned(), format, file, left: bytes / each })
    }

    fn next_block(&mut self) -> Result<Option<Vec<GzRay>>, AppError> {
        let count = self.left.min(AT_A_TIME as u64) as usize;
        if count == 0 {
            return Ok(None);
        }
        let mut bytes = vec![0; count * self.format.ray_bytes()];
        self.file.read_exact(&mut bytes).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => AppError::Io(format!("{}: became shorter while it was read", self.path.display())),
            _ => LoadError::io(&self.path, &error).into(),
        })?;
        self.left -= count as u64;
        Ok(Some(self.format.decode(&bytes).collect()))
    }
}
