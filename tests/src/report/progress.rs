//! What is being measured, told line by line on standard error.

use std::time::Instant;

/// Tells what is going on and how long it took.
#[derive(Debug)]
pub struct Progress {
    speaks: bool,
    start: Instant,
}

impl Progress {
    /// One that starts now. Without `speaks` it says nothing.
    pub fn new(speaks: bool) -> Self {
        Self { speaks, start: Instant::now() }
    }

    /// Says a line, with the seconds since the start.
    pub fn say(&self, text: &str) {
        if self.speaks {
            eprintln!("{:6.1} s  {text}", self.start.elapsed().as_secs_f64());
        }
    }
}
