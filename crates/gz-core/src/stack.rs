//! The homework's matrix stack: placing by push and pop.

use crate::GzMatrix;

/// Matrices that place a model, the last pushed acting first, and beside each the one that takes its normals along.
///
/// The homework's `Ximage` and `Xnorm` in one: [`Self::push`] multiplies from the right, as `GzPushMatrix` does. Deeper than 100
/// levels is refused, as there.
#[derive(Clone, Debug)]
pub struct MatrixStack {
    levels: Vec<Level>,
}

#[derive(Clone, Copy, Debug)]
struct Level {
    place: GzMatrix,
    xnorm: GzMatrix,
}

/// A stack is full, empty, or was given a matrix that is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StackError {
    /// 100 matrices are on the stack.
    Full,
    /// Nothing is left to pop.
    Empty,
    /// The matrix has an entry that is not finite.
    NotFinite,
}

impl std::fmt::Display for StackError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Full => "more than 100 matrices pushed",
            Self::Empty => "no matrix left to pop",
            Self::NotFinite => "a matrix entry is not finite",
        })
    }
}

impl std::error::Error for StackError {}

/// The course's `MATLEVELS`.
const MAX_LEVELS: usize = 100;

impl Default for MatrixStack {
    fn default() -> Self {
        Self::new()
    }
}

impl MatrixStack {
    /// A stack on which nothing was pushed: model space is world space.
    pub fn new() -> Self {
        Self { levels: Vec::new() }
    }

    /// Puts `matrix` to the right of what is there: it acts before all that was pushed earlier.
    ///
    /// # Errors
    ///
    /// If the stack is full or the matrix is not finite.
    pub fn push(&mut self, matrix: &GzMatrix) -> Result<(), StackError> {
        if !matrix.is_finite() {
            return Err(StackError::NotFinite);
        }
        if self.levels.len() == MAX_LEVELS {
            return Err(StackError::Full);
        }
        let place = self.world_from_model().times(matrix);
        let xnorm = self.xnorm().times(&matrix.homework_normal_matrix());
        self.levels.push(Level { place, xnorm });
        Ok(())
    }

    /// Takes back the last push.
    ///
    /// # Errors
    ///
    /// If nothing was pushed.
    pub fn pop(&mut self) -> Result<(), StackError> {
        self.levels.pop().map(|_| ()).ok_or(StackError::Empty)
    }

    /// The product of all that was pushed. The homework's Xwm.
    pub fn world_from_model(&self) -> GzMatrix {
        self.levels.last().map_or(GzMatrix::IDENTITY, |level| level.place)
    }

    /// The matrix for normals: the inverse transpose of [`Self::world_from_model`], right for every placement.
    pub fn normal_matrix(&self) -> GzMatrix {
        self.world_from_model().normal_matrix()
    }

    /// The matrix for normals as the course builds it, from rotations alone; right for rotations and uniform scales.
    pub fn xnorm(&self) -> GzMatrix {
        self.levels.last().map_or(GzMatrix::IDENTITY, |level| level.xnorm)
    }

    /// How many matrices are on the stack.
    pub fn depth(&self) -> usize {
        self.levels.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// The course's placement of the teapot, HW3 to HW6.
    fn course() -> MatrixStack {
        let mut stack = MatrixStack::new();
        // Four digits, as the course has them.
        let (s, r) = (3.25, 7071.0 / 10_000.0);
        for rows in [
            [[s, 0.0, 0.0, 0.0], [0.0, s, 0.0, -3.25], [0.0, 0.0, s, 3.5], [0.0, 0.0, 0.0, 1.0]],
            [[0.866, 0.0, -0.5, 0.0], [0.0, 1.0, 0.0, 0.0], [0.5, 0.0, 0.866, 0.0], [0.0, 0.0, 0.0, 1.0]],
            [[1.0, 0.0, 0.0, 0.0], [0.0, r, r, 0.0], [0.0, -r, r, 0.0], [0.0, 0.0, 0.0, 1.0]],
        ] {
            stack.push(&GzMatrix(rows)).unwrap();
        }
        stack
    }

    #[test]
    fn course_placement_has_the_known_product() {
        let expected =
            [[2.814500, 1.149037, -1.149037, 0.0], [0.0, 2.298075, 2.298075, -3.25], [1.625, -1.990133, 1.990133, 3.5]];
        for (row, expected) in course().world_from_model().0.iter().zip(expected) {
            assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{row:?} {expected:?}");
        }
    }

    #[test]
    fn xnorm_and_inverse_transpose_agree_on_the_course_placement() {
        let (stack, n) = (course(), DVec3::new(0.3, -0.9, 0.2));
        let (a, b) = (stack.xnorm().vector(n).normalize(), stack.normal_matrix().vector(n).normalize());
        // The course's rotation rows have four digits, so they are rotations to 1e-4 only.
        assert!((a - b).length() < 2e-4, "{a} {b}");
    }

    #[test]
    fn pop_takes_back_one_push_and_the_ends_are_errors() {
        let mut stack = course();
        let before = stack.world_from_model();
        stack.push(&GzMatrix::rotate_z(10.0)).unwrap();
        stack.pop().unwrap();
        assert_eq!((stack.depth(), stack.world_from_model()), (3, before));
        for _ in 0..3 {
            stack.pop().unwrap();
        }
        assert_eq!(stack.pop(), Err(StackError::Empty));
        for _ in 0..100 {
            stack.push(&GzMatrix::IDENTITY).unwrap();
        }
        assert_eq!(stack.push(&GzMatrix::IDENTITY), Err(StackError::Full));
    }
}
