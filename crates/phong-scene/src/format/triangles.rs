//! What every reader of faces does with them, once it knows all positions: cut polygons, leave out
//! what cannot be seen, and say so.

use std::sync::Arc;

use super::text::{Findings, whole};
use crate::fragment::flat;
use crate::limits::Limits;
use crate::mesh::{Mesh, cut_polygons};

/// Replaces the fans of polygons by triangles that cover them; how many could not be covered is told.
///
/// `polygons` are the first triangle and the number of corners of every face of more than three.
pub(crate) fn cut(
    mesh: &mut Mesh,
    polygons: &[[u32; 2]],
    findings: &mut Findings,
    file: &Arc<str>,
) {
    let others: [&mut [[u32; 3]]; 2] = [&mut mesh.normal_indices, &mut mesh.uv_indices];
    let tangled = cut_polygons(&mesh.positions, polygons, &mut mesh.indices, others);
    if tangled > 0 {
        warn(findings, file, "tangled polygons", || {
            format!(
                "polygons that cross themselves or have no area: {tangled}; their shape is a guess"
            )
        });
    }
}

/// Takes away what cannot be seen, and says so; whether anything is left is an error or not.
///
/// So many triangles were made nothing of before, and that has been said.
pub(crate) fn tidy(mesh: &mut Mesh, said: u64, findings: &mut Findings, file: &Arc<str>) {
    let collapsed = mesh.drop_collapsed().saturating_sub(said);
    if collapsed > 0 {
        warn(findings, file, "collapsed triangles", || {
            format!("triangles that use a vertex twice: {collapsed}; they are left out")
        });
    }
    let zeros = mesh.mend_normals();
    if zeros > 0 {
        warn(findings, file, "normals of length 0", || {
            format!("normals without a direction: {zeros}; the geometric one stands in for them")
        });
    }
    if mesh.is_flat() {
        warn(findings, file, "flat models", || flat(mesh.indices.len()));
    }
}

/// Says how many faces had fewer than three corners, if any had.
pub(crate) fn tell_small(count: u64, findings: &mut Findings, file: &Arc<str>) {
    if count > 0 {
        warn(findings, file, "small faces", || {
            format!("faces of fewer than three corners: {count}; they are left out")
        });
    }
}

/// Says that no face is left, if none is; whether there is one.
pub(crate) fn any_left(mesh: &Mesh, findings: &mut Findings, file: &Arc<str>) -> bool {
    if mesh.indices.is_empty() {
        let message = || "there is nothing to draw: no face is left".to_owned();
        findings.error("empty models", || whole(file), message);
    }
    !mesh.indices.is_empty()
}

/// Whether so many triangles and vertices, in so many bytes, are within the limits; an error if not.
pub(crate) fn has_room(
    triangles: u64,
    vertices: u64,
    bytes: u64,
    limits: &Limits,
    file: &Arc<str>,
    findings: &mut Findings,
) -> bool {
    let message = if triangles > limits.triangles {
        format!("the model has more than {} triangles", limits.triangles)
    } else if vertices > limits.vertices {
        format!("the model has more than {} vertices", limits.vertices)
    } else if bytes > limits.bytes {
        format!("the model takes {bytes} bytes of memory or more; {} are allowed", limits.bytes)
    } else {
        return true;
    };
    findings.error("limits exceeded", || whole(file), || message);
    false
}

fn warn(
    findings: &mut Findings,
    file: &Arc<str>,
    plural: &'static str,
    tell: impl FnOnce() -> String,
) {
    findings.warning(plural, || whole(file), tell);
}
