//! The shapes that are written out, and where any shape is placed.

use glam::{DAffine3, DMat3, DVec3};

use super::notes::Notes;
use super::table::Values;
use crate::check::shape as judge;
use crate::shape::Shape;
use crate::transform::is_regular;
use crate::wording::Word;

/// A shape of this kind; `None`: something is wrong, which has been said.
pub(super) fn shape(kind: &str, v: &Values, notes: &mut Notes) -> Option<Shape> {
    let mut shape = Shape::of_word(kind)?;
    v.fill(&mut shape)?;
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::shape(&shape, faults));
    sound.then_some(shape)
}

/// Scale, then rotate, then translate; or the matrix alone.
pub(super) fn transform(v: &Values, notes: &mut Notes) -> Option<DAffine3> {
    let three = ["scale", "rotate", "translate"];
    if v.has("matrix") {
        if let Some(other) = three.into_iter().find(|key| v.has(key)) {
            let help = "write the matrix alone, or none";
            notes.error(v.spot_of(other), format!("`{other}` stands beside `matrix`")).help =
                Some(help.to_owned());
            return None;
        }
        return v.matrix("matrix");
    }
    if !three.into_iter().any(|key| v.has(key)) {
        return Some(DAffine3::IDENTITY);
    }
    let scale = if v.has("scale") { v.vector("scale")? } else { DVec3::ONE };
    placement(v, scale, notes)
}

/// This scale, then `rotate`, then `translate`.
pub(super) fn placement(v: &Values, scale: DVec3, notes: &mut Notes) -> Option<DAffine3> {
    let rotations = if v.has("rotate") { v.rotations("rotate")? } else { Vec::new() };
    let mut matrix = DMat3::from_diagonal(scale);
    for rotation in rotations {
        // Rounding apart, any length of axis will do; one too small to have a direction not.
        let Some(axis) = rotation.truncate().try_normalize() else {
            notes.error(v.spot_of("rotate"), "`rotate` is about an axis too short to tell");
            return None;
        };
        matrix = turn(axis, rotation.w) * matrix;
    }
    if !is_regular(matrix) {
        notes
            .error(v.spot_of("scale"), "`scale` leaves nothing that can be told from a flat thing");
        return None;
    }
    Some(DAffine3 { matrix3: matrix, translation: v.vector("translate")? })
}

/// The rotation by an angle in degrees about a unit axis, right-handed (Rodrigues' formula);
/// exact for right angles about the axes of space.
fn turn(axis: DVec3, degrees: f64) -> DMat3 {
    let degrees = degrees % 360.0; // exact
    let (sin, cos) = match degrees {
        0.0 => (0.0, 1.0),
        90.0 | -270.0 => (1.0, 0.0),
        180.0 | -180.0 => (0.0, -1.0),
        270.0 | -90.0 => (-1.0, 0.0),
        _ => libm::sincos(degrees.to_radians()),
    };
    let column = |e: DVec3| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos));
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_about_an_axis_is_exact() {
        for degrees in [90.0, 450.0, -270.0] {
            let matrix = turn(DVec3::Z, degrees);
            assert_eq!([matrix * DVec3::X, matrix * DVec3::Y], [DVec3::Y, -DVec3::X]);
        }
        assert_eq!(turn(DVec3::X, 180.0) * DVec3::Y, -DVec3::Y);
        assert_eq!(turn(DVec3::Y, -90.0) * DVec3::X, DVec3::Z);
        assert_eq!(turn(DVec3::Y, 720.0), DMat3::IDENTITY);
    }

    #[test]
    fn a_rotation_is_right_handed_and_keeps_lengths() {
        let third = turn(DVec3::ONE.normalize_or_zero(), 120.0);
        assert!((third * DVec3::X).distance(DVec3::Y) < 1e-15);
        assert!((third * DVec3::new(1.0, -2.0, 3.0)).distance(DVec3::new(3.0, 1.0, -2.0)) < 1e-14);
    }
}
