//! What a ray query answers.

/// The number of a triangle in its buffer, counting from 0.
pub type TriId = u32;

/// The triangle number of a miss.
pub const NO_TRI: TriId = u32::MAX;

/// The front-most triangle on a ray, or a miss.
///
/// Two hits are equal when triangle, t, u and v are. A miss is told by [`Self::is_hit`] alone: t is also infinite when a true
/// T-value is beyond the f32 range.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// The T-value: the exact t rounded once to f32. Infinity for a miss.
    pub t: f32,
    /// The triangle, [`NO_TRI`] for a miss. Of several at equal exact t, the lowest number.
    pub tri: TriId,
    /// Weight of the second vertex, in [0, 1]. 0 for a miss.
    pub u: f32,
    /// Weight of the third vertex, in [0, 1]. 0 for a miss.
    pub v: f32,
}

impl Hit {
    /// No triangle on the ray.
    pub const MISS: Self = Self { t: f32::INFINITY, tri: NO_TRI, u: 0.0, v: 0.0 };

    /// Whether a triangle was hit.
    pub fn is_hit(&self) -> bool {
        self.tri != NO_TRI
    }

    /// The weights of the three vertices, in f64; they sum to 1 up to rounding and none is negative.
    pub fn weights(&self) -> [f64; 3] {
        let (u, v) = (f64::from(self.u), f64::from(self.v));
        [(1.0 - u - v).max(0.0), u, v]
    }
}
