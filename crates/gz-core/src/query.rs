//! The one question that everything above asks, in batches.

use crate::{GzCoord, GzRay, GzRay32, Hit, NO_TRI, Passages, TriBuffer, TriClass, TriId};
use glam::DVec3;

/// A property of the rays of a batch: the same for all, or one each.
///
/// What rays share lets an implementation share work: a common origin (primary rays), a common direction (one light's shadow rays).
#[derive(Clone, Copy, Debug)]
pub enum PerRay<'a, T> {
    /// Every ray has this value.
    One(T),
    /// Ray `i` has value `i`; as long as the batch.
    Each(&'a [T]),
}

impl<'a, T: Copy> PerRay<'a, T> {
    /// The value of ray `i`.
    pub fn get(&self, i: usize) -> T {
        match *self {
            Self::One(value) => value,
            Self::Each(values) => values[i],
        }
    }

    /// Whether all rays have one value.
    pub(crate) fn is_one(&self) -> bool {
        matches!(self, Self::One(_))
    }

    /// The value that all rays have, else what `other` says.
    pub(crate) fn or(self, other: Self) -> Self {
        if let Self::One(_) = self { self } else { other }
    }

    /// The length that this property forces on a batch, if any.
    fn forced_len(&self) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Each(values) => Some(values.len()),
        }
    }
}

/// Rays as they are given to a batch.
#[derive(Clone, Copy, Debug)]
pub enum Given<'a> {
    /// Property by property: see [`GzRay`] for what each means. Those given for each ray are as long as the batch.
    Properties {
        /// Origins in trace space.
        origin: PerRay<'a, DVec3>,
        /// Directions in trace space.
        direction: PerRay<'a, GzCoord>,
        /// Lower ends of t, strict.
        tmin: PerRay<'a, f32>,
        /// Upper ends of t, strict.
        tmax: PerRay<'a, f32>,
    },
    /// Ray by ray. What some of them share is for the query to find out.
    Rays(&'a [GzRay32]),
}

/// Rays asked about together.
#[derive(Clone, Copy, Debug)]
pub struct RayBatch<'a> {
    len: usize,
    given: Given<'a>,
    /// For each ray a triangle that it is known not to hit, such as the one that it leaves by [`crate::leave_surface`], or
    /// [`crate::NO_TRI`]: testing it is then saved. It does not change any answer; see [`Self::leaving`].
    pub leaves: Option<&'a [TriId]>,
}

impl<'a> RayBatch<'a> {
    /// A batch of `len` rays, property by property. What all rays have in common is best given as [`PerRay::One`].
    ///
    /// # Panics
    ///
    /// If a property given per ray has another length than `len`.
    pub fn new(
        len: usize,
        origin: PerRay<'a, DVec3>,
        direction: PerRay<'a, GzCoord>,
        tmin: PerRay<'a, f32>,
        tmax: PerRay<'a, f32>,
    ) -> Self {
        for forced in [origin.forced_len(), direction.forced_len(), tmin.forced_len(), tmax.forced_len()] {
            assert!(forced.is_none_or(|n| n == len), "every property of a batch of {len} rays is one or {len} values");
        }
        Self { len, given: Given::Properties { origin, direction, tmin, tmax }, leaves: None }
    }

    /// Rays with t in (0, infinity).
    pub fn unbounded(len: usize, origin: PerRay<'a, DVec3>, direction: PerRay<'a, GzCoord>) -> Self {
        Self::new(len, origin, direction, PerRay::One(0.0), PerRay::One(f32::INFINITY))
    }

    /// Rays with origins in f32, taken as they lie in memory. Neighbours should go the same way where they can; which of them have an origin
    /// or a direction in common need not be known.
    ///
    /// ```
    /// use gz_core::{BruteForce, ClassMask, GzCoord, GzRay32, Hit, RayBatch, RayQuery, TriBuffer};
    ///
    /// let corners = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [0.0, 4.0, 5.0]].map(GzCoord::from_array);
    /// let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2]])?;
    /// let ray = |x: f32| GzRay32 { origin: [x, 1.0, 0.0].into(), tmin: 0.0, direction: GzCoord::Z, tmax: f32::INFINITY };
    /// let rays = [ray(1.0), ray(3.5)];
    ///
    /// let mut hits = [Hit::MISS; 2];
    /// BruteForce::new(&tris).closest_hits(&RayBatch::of_rays(&rays), ClassMask::ALL, &mut hits);
    /// assert_eq!((hits[0].t, hits[1]), (5.0, Hit::MISS));
    /// # Ok::<(), gz_core::TriError>(())
    /// ```
    pub fn of_rays(rays: &'a [GzRay32]) -> Self {
        Self { len: rays.len(), given: Given::Rays(rays), leaves: None }
    }

    /// The same rays, each known not to hit the triangle `leaves[i]`. A wrong promise may show in the answer, or not.
    ///
    /// # Panics
    ///
    /// If `leaves` is not as long as the batch.
    #[must_use]
    pub fn leaving(self, leaves: &'a [TriId]) -> Self {
        assert!(leaves.len() == self.len, "one triangle a ray");
        Self { leaves: Some(leaves), ..self }
    }

    /// The triangle that ray `i` is known not to hit, or [`crate::NO_TRI`].
    pub fn left_by(&self, i: usize) -> TriId {
        self.leaves.map_or(NO_TRI, |leaves| leaves[i])
    }

    /// The rays as they were given.
    #[inline]
    pub fn given(&self) -> &Given<'a> {
        &self.given
    }

    /// The number of rays.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no ray.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Ray `i` by itself.
    pub fn ray(&self, i: usize) -> GzRay {
        match self.given {
            Given::Properties { origin, direction, tmin, tmax } => {
                GzRay { origin: origin.get(i), direction: direction.get(i), tmin: tmin.get(i), tmax: tmax.get(i) }
            }
            Given::Rays(rays) => rays[i].into(),
        }
    }
}

/// A set of triangle classes: a query sees only triangles whose class is in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassMask(u8);

impl ClassMask {
    /// Every class.
    pub const ALL: Self = Self(u8::MAX);
    /// No class.
    pub const NONE: Self = Self(0);

    /// The set of one class.
    pub const fn only(class: TriClass) -> Self {
        Self(1 << class as u8)
    }

    /// Both sets together.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The classes that are not in the set.
    #[must_use]
    pub const fn others(self) -> Self {
        Self(!self.0)
    }

    /// Whether `class` is in the set.
    pub const fn has(self, class: TriClass) -> bool {
        self.0 & (1 << class as u8) != 0
    }
}

/// The triangles that a query sees.
#[derive(Clone, Copy, Debug)]
pub struct Targets<'t> {
    tris: &'t TriBuffer,
    classes: ClassMask,
    all: bool,
}

impl<'t> Targets<'t> {
    /// Those of `tris` whose class is in `classes`.
    pub fn new(tris: &'t TriBuffer, classes: ClassMask) -> Self {
        Self { tris, classes, all: classes == ClassMask::ALL }
    }

    /// Whether the query sees a triangle.
    #[inline(always)]
    pub fn sees(&self, tri: TriId) -> bool {
        self.all || self.classes.has(self.tris.class(tri))
    }

    /// Whether a triangle's class is in `classes`.
    #[inline(always)]
    pub fn is_of(&self, tri: TriId, classes: ClassMask) -> bool {
        classes.has(self.tris.class(tri))
    }

    /// Corners of all triangles, seen or not.
    #[inline(always)]
    pub fn positions(&self) -> &'t [[GzCoord; 3]] {
        self.tris.positions()
    }

    /// Corners of one triangle.
    #[inline(always)]
    pub fn position(&self, tri: TriId) -> &'t [GzCoord; 3] {
        self.tris.position(tri)
    }
}

/// Which triangle does a ray hit first, and does it hit any?
///
/// The line of a ray meets a triangle when the signed volumes U, V, W of the line against its three edges are all at least 0 or all
/// at most 0 and their sum D is not 0: triangles are closed and have two faces, a ray in the plane misses, a triangle without area
/// is never hit. The hit lies at t = M / D and counts when `tmin < t < tmax`. The answer is the least (t, triangle number), t
/// compared exactly; [`Hit::t`] is that t rounded once. Every implementation answers with these bits, whatever it skips.
pub trait RayQuery: Sync {
    /// The triangles asked about.
    fn tris(&self) -> &TriBuffer;

    /// The front-most hit of each ray among the triangles of `classes`, into `hits`.
    ///
    /// # Panics
    ///
    /// If `hits` is not as long as `rays`.
    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]);

    /// Whether each ray hits anything among the triangles of `classes`, into `occluded`.
    ///
    /// Equal to asking whether [`Self::closest_hits`] finds a hit.
    ///
    /// # Panics
    ///
    /// If `occluded` is not as long as `rays`.
    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]);

    /// What rays meet that go through triangles of the classes `through` and are stopped by all others: [`Passages`] says what exactly.
    ///
    /// Such as shadow rays in a scene with glass. Given here is the way by the questions above; whoever knows better answers the same.
    fn passages(&self, rays: &RayBatch<'_>, through: ClassMask, passages: &mut Passages) {
        passages.ask(self, rays, through);
    }

    /// The front-most hit of one ray.
    fn closest_hit(&self, ray: &GzRay) -> Hit {
        let mut hit = [Hit::MISS];
        self.closest_hits(&single(ray), ClassMask::ALL, &mut hit);
        hit[0]
    }

    /// Whether one ray hits anything.
    fn any_hit(&self, ray: &GzRay) -> bool {
        let mut occluded = [false];
        self.any_hits(&single(ray), ClassMask::ALL, &mut occluded);
        occluded[0]
    }
}

fn single(ray: &GzRay) -> RayBatch<'static> {
    RayBatch::new(1, PerRay::One(ray.origin), PerRay::One(ray.direction), PerRay::One(ray.tmin), PerRay::One(ray.tmax))
}
