//! What placements do to what is not a point: radii and normals.

use glam::DMat3;

/// The factor of a matrix that is one scale and a rotation or mirroring, under which a sphere stays
/// a sphere; `None` if it is not one, within 1e-12 of its square.
///
/// ```
/// use glam::{DMat3, DVec3};
/// use phong_scene::even_scale;
/// assert_eq!(even_scale(DMat3::from_diagonal(DVec3::new(2.0, -2.0, 2.0))), Some(2.0));
/// assert_eq!(even_scale(DMat3::from_diagonal(DVec3::new(2.0, 2.0, 3.0))), None);
/// ```
pub fn even_scale(m: DMat3) -> Option<f64> {
    let square = m.x_axis.length_squared();
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * square;
    let even = close(m.y_axis.length_squared(), square)
        && close(m.z_axis.length_squared(), square)
        && close(m.x_axis.dot(m.y_axis), 0.0)
        && close(m.x_axis.dot(m.z_axis), 0.0)
        && close(m.y_axis.dot(m.z_axis), 0.0);
    even.then(|| square.sqrt())
}

/// What turns normals when `m` turns points: the matrix of cofactors, of the sign that keeps
/// outward normals outward. It exists for a singular `m` too, and keeps no length.
///
/// ```
/// use glam::{DMat3, DVec3};
/// // A slope of 45° squeezed to half its width is steeper, and its normal flatter.
/// let squeeze = DMat3::from_diagonal(DVec3::new(0.5, 1.0, 1.0));
/// let normal = phong_scene::cofactor(squeeze) * DVec3::new(1.0, 1.0, 0.0);
/// assert_eq!(normal.normalize(), DVec3::new(2.0, 1.0, 0.0).normalize());
/// ```
pub fn cofactor(m: DMat3) -> DMat3 {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let c = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if m.determinant() < 0.0 { -c } else { c }
}

/// Whether a matrix can be undone, in numbers an f64 holds.
pub(crate) fn is_regular(matrix: DMat3) -> bool {
    let inverse = matrix.inverse();
    matrix.determinant() != 0.0 && inverse.is_finite()
}
