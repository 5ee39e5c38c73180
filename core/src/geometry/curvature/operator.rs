//! The shape operator at a point.

use glam::{DMat3, DVec3};

/// How a surface curves at a point: the second fundamental form in an orthonormal frame of the
/// tangent plane, positive where the surface bulges outward (a convex limb).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeOperator {
    /// Outward unit normal.
    pub normal: DVec3,
    /// First unit tangent.
    pub u: DVec3,
    /// Second unit tangent; `u`, `v`, `normal` are right-handed.
    pub v: DVec3,
    /// Normal curvature along `u`, in 1/mm.
    pub kuu: f64,
    /// Twist between `u` and `v`, in 1/mm.
    pub kuv: f64,
    /// Normal curvature along `v`, in 1/mm.
    pub kvv: f64,
}

impl ShapeOperator {
    /// The operator in the tangent plane across `normal` that acts as `tensor` does there;
    /// `tensor` is symmetric, in 1/mm.
    #[must_use]
    pub fn from_tensor(normal: DVec3, tensor: DMat3) -> Self {
        let (u, v) = normal.any_orthonormal_pair();
        let (u, v) = if u.cross(v).dot(normal) < 0.0 { (v, u) } else { (u, v) };
        let (tu, tv) = (tensor * u, tensor * v);
        let kuv = 0.5 * (u.dot(tv) + v.dot(tu));
        Self { normal, u, v, kuu: u.dot(tu), kuv, kvv: v.dot(tv) }
    }

    /// The operator as a symmetric tensor of space, zero along the normal, in 1/mm. Tensors of
    /// different points can be averaged; operators in their own frames cannot.
    #[must_use]
    pub fn tensor(&self) -> DMat3 {
        let along = |a: DVec3| {
            let (x, y) = (a.dot(self.u), a.dot(self.v));
            self.u * (self.kuu * x + self.kuv * y) + self.v * (self.kuv * x + self.kvv * y)
        };
        DMat3::from_cols(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// Normal curvature along a direction of any length, projected to the tangent plane, in
    /// 1/mm; the mean curvature when nothing of the direction lies in the tangent plane.
    #[must_use]
    pub fn normal_curvature(&self, direction: DVec3) -> f64 {
        let (x, y) = (direction.dot(self.u), direction.dot(self.v));
        let squared = x * x + y * y;
        // Below this share of its square, the projection is rounding.
        if squared <= 1e-24 * direction.length_squared() {
            return self.mean();
        }
        (self.kuu * x * x + 2.0 * self.kuv * x * y + self.kvv * y * y) / squared
    }

    /// Mean curvature (κ₁ + κ₂) / 2, in 1/mm.
    #[must_use]
    pub fn mean(&self) -> f64 {
        0.5 * (self.kuu + self.kvv)
    }

    /// Gaussian curvature κ₁ κ₂, in 1/mm².
    #[must_use]
    pub fn gaussian(&self) -> f64 {
        self.kuu * self.kvv - self.kuv * self.kuv
    }

    /// The principal curvatures in 1/mm, the larger first, with their unit directions.
    #[must_use]
    pub fn principal(&self) -> [(f64, DVec3); 2] {
        let half = 0.5 * (self.kuu - self.kvv);
        let spread = half.hypot(self.kuv);
        let (sin, cos) = (0.5 * self.kuv.atan2(half)).sin_cos();
        [
            (self.mean() + spread, cos * self.u + sin * self.v),
            (self.mean() - spread, cos * self.v - sin * self.u),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_operator_turns_by_eulers_formula() {
        let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let (u, _) = normal.any_orthonormal_pair();
        let v = normal.cross(u);
        let shape = ShapeOperator { normal, u, v, kuu: 0.03, kuv: 0.0, kvv: -0.01 };
        for degrees in [0.0_f64, 30.0, 60.0, 90.0, 200.0] {
            let (s, c) = degrees.to_radians().sin_cos();
            let want = 0.03 * c * c - 0.01 * s * s;
            let direction = 7.0 * (c * u + s * v) + 3.0 * normal;
            assert!((shape.normal_curvature(direction) - want).abs() < 1e-15);
            let again = ShapeOperator::from_tensor(normal, shape.tensor());
            assert!((again.normal_curvature(direction) - want).abs() < 1e-15);
            assert!((again.gaussian() + 3e-4).abs() < 1e-15);
        }
        let [(large, a), (small, b)] = shape.principal();
        assert!((large - 0.03).abs() < 1e-15 && (small + 0.01).abs() < 1e-15);
        assert!(a.cross(u).length() < 1e-12 && b.cross(v).length() < 1e-12);
        assert!((shape.normal_curvature(normal) - 0.01).abs() < 1e-15);
    }
}
