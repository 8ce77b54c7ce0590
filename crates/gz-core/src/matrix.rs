//! The 4 x 4 matrix of the homework, in f64.

use glam::DVec3;

/// A 4 x 4 matrix: row-major, applied to column vectors, so a translation stands in the fourth column.
///
/// The homework's `GzMatrix`, but in f64: a vertex is placed in f64 and rounded to f32 once, at the end. Sums are written out in
/// one order without fused multiply-adds, so that a placed vertex has the same bits on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GzMatrix(pub [[f64; 4]; 4]);

impl GzMatrix {
    /// The matrix that changes nothing; a point keeps its bits.
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]);

    /// Rotation about the x axis, `degrees` from y towards z. The homework's `GzRotXMat`.
    pub fn rotate_x(degrees: f64) -> Self {
        let (s, c) = sin_cos_degrees(degrees);
        Self([[1.0, 0.0, 0.0, 0.0], [0.0, c, -s, 0.0], [0.0, s, c, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Rotation about the y axis, `degrees` from z towards x. The homework's `GzRotYMat`.
    pub fn rotate_y(degrees: f64) -> Self {
        let (s, c) = sin_cos_degrees(degrees);
        Self([[c, 0.0, s, 0.0], [0.0, 1.0, 0.0, 0.0], [-s, 0.0, c, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Rotation about the z axis, `degrees` from x towards y. The homework's `GzRotZMat`.
    pub fn rotate_z(degrees: f64) -> Self {
        let (s, c) = sin_cos_degrees(degrees);
        Self([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Translation by `by`. The homework's `GzTrxMat`.
    pub fn translate(by: DVec3) -> Self {
        Self([[1.0, 0.0, 0.0, by.x], [0.0, 1.0, 0.0, by.y], [0.0, 0.0, 1.0, by.z], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Scale by `by` along each axis. The homework's `GzScaleMat`.
    pub fn scale(by: DVec3) -> Self {
        Self([[by.x, 0.0, 0.0, 0.0], [0.0, by.y, 0.0, 0.0], [0.0, 0.0, by.z, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// The product `self * right`: `right` acts first.
    pub fn times(&self, right: &Self) -> Self {
        let (a, b) = (&self.0, &right.0);
        Self(std::array::from_fn(|i| {
            std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j])
        }))
    }

    /// The four homogeneous coordinates of the point `p` (w = 1) after this matrix.
    pub fn homogeneous(&self, p: DVec3) -> [f64; 4] {
        self.0.map(|r| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3])
    }

    /// The point `p` after this matrix. The fourth row is taken as (0, 0, 0, 1): no division.
    pub fn point(&self, p: DVec3) -> DVec3 {
        let [x, y, z, _] = self.homogeneous(p);
        DVec3::new(x, y, z)
    }

    /// The direction `v` after this matrix: translation does not act.
    pub fn vector(&self, v: DVec3) -> DVec3 {
        let r = &self.0;
        let row = |i: usize| r[i][0] * v.x + r[i][1] * v.y + r[i][2] * v.z;
        DVec3::new(row(0), row(1), row(2))
    }

    /// Determinant of the upper left 3 x 3 part: negative for a placement that mirrors, 0 for one that flattens.
    pub fn det3(&self) -> f64 {
        let [a, b, c] = self.columns3();
        a.dot(b.cross(c))
    }

    /// The matrix that takes normals along with this one: the inverse transpose of the 3 x 3 part, up to a positive factor.
    ///
    /// Results need renormalising. A mirroring placement keeps the normal on its side of the surface. Where [`Self::det3`] is 0 the
    /// result is not meaningful.
    pub fn normal_matrix(&self) -> Self {
        // Columns of the cofactor matrix are cross products of the columns; dividing by |det| only changes the length.
        let [a, b, c] = self.columns3();
        let sign = if self.det3() < 0.0 { -1.0 } else { 1.0 };
        let (x, y, z) = (b.cross(c) * sign, c.cross(a) * sign, a.cross(b) * sign);
        Self([[x.x, y.x, z.x, 0.0], [x.y, y.y, z.y, 0.0], [x.z, y.z, z.z, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// The 3 x 3 part without translation, divided by the length of its first row.
    ///
    /// This is how the homework's `Xnorm` stack removes a uniform scale; it is right for rotations and uniform scales only.
    pub fn homework_normal_matrix(&self) -> Self {
        let r = &self.0;
        let k = (r[0][0] * r[0][0] + r[0][1] * r[0][1] + r[0][2] * r[0][2]).sqrt();
        let row = |i: usize| [r[i][0] / k, r[i][1] / k, r[i][2] / k, 0.0];
        Self([row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]])
    }

    /// Whether every entry is a finite number.
    pub fn is_finite(&self) -> bool {
        self.0.iter().flatten().all(|x| x.is_finite())
    }

    fn columns3(&self) -> [DVec3; 3] {
        let r = &self.0;
        [0, 1, 2].map(|j| DVec3::new(r[0][j], r[1][j], r[2][j]))
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => libm::sincos(degrees.to_radians()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_turn_one_axis_into_the_next() {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        assert_eq!(GzMatrix::rotate_x(90.0).vector(y), z);
        assert_eq!(GzMatrix::rotate_y(90.0).vector(z), x);
        assert_eq!(GzMatrix::rotate_z(90.0).vector(x), y);
        assert!((GzMatrix::rotate_y(-30.0).0[0][0] - 0.866_025_403_784_438_6).abs() < 1e-15);
    }

    #[test]
    fn product_lets_the_right_factor_act_first() {
        let m = GzMatrix::translate(DVec3::X).times(&GzMatrix::scale(DVec3::splat(2.0)));
        assert_eq!(m.point(DVec3::ONE), DVec3::new(3.0, 2.0, 2.0));
    }

    #[test]
    fn identity_keeps_every_bit_of_an_f32_point() {
        let p = DVec3::new(f64::from(0.1f32), f64::from(-1e-20f32), f64::from(3e30f32));
        assert_eq!(GzMatrix::IDENTITY.point(p), p);
    }

    #[test]
    fn normals_stay_perpendicular_under_uneven_scale_and_keep_their_side_when_mirrored() {
        let m = GzMatrix::rotate_x(20.0).times(&GzMatrix::scale(DVec3::new(-1.0, 4.0, 0.5)));
        let (tangent, normal) = (DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0));
        let (t, n) = (m.vector(tangent), m.normal_matrix().vector(normal));
        assert!(t.dot(n).abs() < 1e-12, "{}", t.dot(n));
        assert!(m.vector(normal).dot(n) > 0.0);
    }
}
