//! The definition word for word: every triangle, in integers, with nothing left out and nothing estimated.

use super::{Found, Line, Meeting, Ray, Triangle};

/// All hits of `line`, the front-most first; at equal t the lower number first.
pub fn hits(line: &Line, triangles: &[Triangle]) -> Vec<(u32, Meeting)> {
    let mut hits: Vec<(u32, Meeting)> =
        (0..).zip(triangles).filter_map(|(tri, corners)| Some((tri, Meeting::of(line, corners)?))).collect();
    // Stable, and the numbers were in order.
    hits.sort_by(|(_, one), (_, other)| one.t.cmp(&other.t));
    hits
}

/// The front-most hit of a ray.
pub fn closest(ray: &Ray, triangles: &[Triangle]) -> Option<Found> {
    let hits = hits(&ray.line()?, triangles);
    let (tri, meeting) = hits.first()?;
    Some(Found { tri: *tri, t: meeting.t.to_f32(), u: meeting.u.to_f32(), v: meeting.v.to_f32() })
}

/// The triangles that share the least t of a ray, in order; none for a miss.
pub fn tied(ray: &Ray, triangles: &[Triangle]) -> Vec<u32> {
    let hits = ray.line().map_or_else(Vec::new, |line| hits(&line, triangles));
    let Some((_, first)) = hits.first() else { return Vec::new() };
    hits.iter().take_while(|(_, meeting)| meeting.t == first.t).map(|(tri, _)| *tri).collect()
}
