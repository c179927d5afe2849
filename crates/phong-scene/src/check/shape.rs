//! Shapes that are written out, and where they are placed.

use glam::{DAffine3, DVec3};

use super::fault::Faults;
use super::value::values;
use crate::shape::Shape;
use crate::transform::is_regular;

/// Judges a shape by itself; what meshes, points and bundles of cylinders hold is judged elsewhere.
pub(crate) fn shape(shape: &Shape, faults: &mut Faults) {
    values(shape, None, faults);
    match *shape {
        Shape::Triangle { points: [a, b, c], .. }
            if faults.spare(&["points"]) && (b - a).cross(c - a) == DVec3::ZERO =>
        {
            faults.say("points", "the corners lie on one line: a triangle without area");
        }
        Shape::Box { min, max } if faults.spare(&["min", "max"]) => cuboid(min, max, faults),
        Shape::Cylinder { from, to, .. } => axis(from, to, faults),
        Shape::Cone { from, to, radius, radius_to, .. } => {
            axis(from, to, faults);
            if radius == 0.0 && radius_to == 0.0 {
                faults.say("radius", "`radius` and `radius_to` are both 0: only a line");
            }
        }
        Shape::Torus { radius, tube, .. }
            if faults.spare(&["radius", "tube"]) && tube >= radius =>
        {
            let message = format!("`tube` is not below `radius`, which is {radius}");
            let help = "the ring must have a hole: `radius` is to the middle of the tube";
            faults.say("tube", message).help = Some(help.to_owned());
        }
        _ => {}
    }
}

fn cuboid(min: DVec3, max: DVec3, faults: &mut Faults) {
    let axes = ['x', 'y', 'z'].into_iter().zip(min.to_array().into_iter().zip(max.to_array()));
    for (axis, (min, max)) in axes {
        if min >= max {
            let message = format!("`max` is not above `min` in {axis}: {max} and {min}");
            faults.say("max", message);
            return;
        }
    }
}

/// `from` and `to`, which must differ.
fn axis(from: DVec3, to: DVec3, faults: &mut Faults) {
    if faults.spare(&["from", "to"]) && (to - from).try_normalize().is_none() {
        faults.say("to", "`to` is where `from` is: no axis");
    }
}

/// Judges a placement.
pub(crate) fn transform(transform: &DAffine3, faults: &mut Faults) {
    let m = transform.matrix3;
    let columns = [m.x_axis, m.y_axis, m.z_axis, transform.translation];
    let finite = columns.into_iter().all(|v| faults.vector("matrix", v));
    if finite && !is_regular(m) {
        faults.say("matrix", "`matrix` is singular: it leaves nothing of the shape");
    }
}
