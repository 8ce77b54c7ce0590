//! What a render did: rays, bytes, seconds.

use crate::args;
use crate::job::RenderJob;
use gz_core::Tile;
use gz_shade::{FrameStats, Scene};
use serde_json::{Value, json};
use std::time::Instant;

/// Seconds by phase, in the order of the phases.
#[derive(Clone, Debug)]
pub struct Clock {
    last: Instant,
    phases: Vec<(&'static str, f64)>,
}

impl Clock {
    /// Starts now.
    pub fn start() -> Self {
        Self { last: Instant::now(), phases: Vec::new() }
    }

    /// What ran since the last lap was `phase`.
    pub fn lap(&mut self, phase: &'static str) {
        let now = Instant::now();
        self.phases.push((phase, now.duration_since(self.last).as_secs_f64()));
        self.last = now;
    }

    /// Seconds of all phases together.
    pub fn total(&self) -> f64 {
        self.phases.iter().map(|(_, seconds)| seconds).sum()
    }

    fn json(&self) -> Value {
        let mut phases: serde_json::Map<_, _> = self.phases.iter().map(|(name, s)| ((*name).to_owned(), json!(s))).collect();
        phases.insert("total".to_owned(), json!(self.total()));
        Value::Object(phases)
    }
}

/// `primary 4, shadow 3, mirror 2, glass 1`.
pub fn rays_by_kind(frame: &FrameStats) -> String {
    let FrameStats { primary_rays, shadow_rays, mirror_rays, glass_rays, .. } = frame;
    format!("primary {primary_rays}, shadow {shadow_rays}, mirror {mirror_rays}, glass {glass_rays}")
}

/// What a render did, to be told to people and programs.
#[derive(Debug)]
pub struct RenderStats<'a> {
    /// What was asked for.
    pub job: &'a RenderJob,
    /// The scene, placed.
    pub scene: &'a Scene,
    /// The pixels rendered.
    pub area: Tile,
    /// Rays and other counts.
    pub frame: &'a FrameStats,
    /// Threads used.
    pub threads: usize,
    /// Seconds by phase.
    pub clock: &'a Clock,
}

impl RenderStats<'_> {
    /// One line for people: `out/teapot.png: 800x600, 1408 triangles, 2000000 rays (primary 480000, ...) in 3.21 s`.
    pub fn summary(&self) -> String {
        format!(
            "{}: {}x{}, {} triangles, {} rays ({}) in {:.2} s",
            self.job.output.path().display(),
            self.area.width(),
            self.area.height(),
            self.scene.tris.len(),
            self.frame.rays(),
            rays_by_kind(self.frame),
            self.clock.total(),
        )
    }

    /// All of it for programs. Times are in seconds, sizes in bytes; counts are exact.
    pub fn json(&self) -> Value {
        let (scene, frame, job) = (self.scene, self.frame, self.job);
        let counters: serde_json::Map<_, _> =
            frame.rows().map(|(name, count)| (name.to_owned(), json!(count))).into_iter().collect();
        json!({
            "scene": job.scene.display().to_string(),
            "picture": job.output.path().display().to_string(),
            "size": [scene.camera.width(), scene.camera.height()],
            "crop": [self.area.x0, self.area.y0, self.area.x1, self.area.y1],
            "triangles": scene.tris.len(),
            "bytes": {
                "triangles": scene.tris.bytes(),
                "per_triangle": scene.tris.attributes().bytes_per_triangle(),
                "textures": crate::info::texture_bytes(scene),
            },
            "needs": crate::explain::needs_in_use(scene),
            "rays": {
                "primary": frame.primary_rays,
                "shadow": frame.shadow_rays,
                "mirror": frame.mirror_rays,
                "glass": frame.glass_rays,
                "total": frame.rays(),
            },
            "counters": counters,
            "seconds": self.clock.json(),
            "settings": {
                "camera": args::camera_name(scene.camera.model()),
                "accel": job.accel.name(),
                "kernel": args::kernel_name(job.accel.kernel()),
                "depth": scene.rules.depth,
                "fresnel": args::fresnel_name(scene.rules.fresnel),
                "leave": args::leave_name(scene.rules.leave),
                "aa": args::antialias_name(scene.rules.antialias),
                "threads": self.threads,
                "tile": job.tile,
            },
        })
    }
}
