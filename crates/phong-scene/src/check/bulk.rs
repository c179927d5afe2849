//! Meshes, points and cylinders: lengths of arrays, indices, numbers.

#![expect(clippy::needless_bitwise_bool, reason = "a branch for each number would cost more")]

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::fault::{Faults, not_held};
use crate::color::Rgb;
use crate::limits::{LARGEST, Range};
use crate::mesh::{Caps, Cylinders, Field, Mesh, NO_INDEX, PIECE, Points};
use crate::wording::quoted;

/// Judges a mesh, whose faces may be of so many materials.
pub(super) fn mesh(mesh: &Mesh, materials: usize, faults: &mut Faults) {
    faults.vector("origin", mesh.origin);
    let (vertices, triangles) = (mesh.positions.len(), mesh.indices.len());
    let most = u64::from(u32::MAX) - 1;
    for (field, count) in [("positions", vertices), ("indices", triangles)] {
        if count == 0 {
            faults.say(field, format!("`{field}` is empty"));
        } else if count as u64 > most {
            faults.say(field, format!("`{field}` holds {count}; the most are {most}"));
        }
    }
    vectors(&mesh.positions, "positions", faults);
    vectors(&mesh.normals, "normals", faults);
    let right = |uv: &Vec2| are_held(&uv.to_array());
    first(&mesh.uvs, "uvs", right, |uv| wrong_numbers(&uv.to_array()), faults);
    colors(&mesh.colors, "positions", vertices, faults);
    corners(&mesh.indices, "indices", vertices, triangles, false, faults);
    let kinds = [
        ("normals", mesh.normals.len(), "normal_indices", &mesh.normal_indices),
        ("uvs", mesh.uvs.len(), "uv_indices", &mesh.uv_indices),
    ];
    for (values, count, field, indices) in kinds {
        if !indices.is_empty() {
            corners(indices, field, count, triangles, true, faults);
        } else if count > 0 && count != vertices {
            let message = format!(
                "`{values}` holds {count} for {vertices} positions; without `{field}` it is one each"
            );
            faults.say(values, message);
        }
    }
    directions(mesh, faults);
    let faces = &mesh.face_materials;
    if !faces.is_empty() && faces.len() != triangles {
        let message = format!("`face_materials` holds {} for {triangles} triangles", faces.len());
        faults.say("face_materials", message);
    }
    let right = |&m: &u32| (m as usize) < materials;
    let outside = |&m: &u32| Some(format!("is {m}, but there are {materials} materials"));
    first(faces, "face_materials", right, outside, faults);
    fields(&mesh.fields, vertices, faults);
}

/// Judges points.
pub(super) fn points(points: &Points, faults: &mut Faults) {
    faults.vector("origin", points.origin);
    if points.spheres.is_empty() {
        faults.say("spheres", "`spheres` is empty");
    }
    first(&points.spheres, "spheres", is_ball, wrong_ball, faults);
    colors(&points.colors, "spheres", points.spheres.len(), faults);
    fields(&points.fields, points.spheres.len(), faults);
}

/// Judges cylinders.
pub(super) fn cylinders(cylinders: &Cylinders, faults: &mut Faults) {
    let Cylinders { origin, segments, colors: pairs, caps, fields: numbers, .. } = cylinders;
    faults.vector("origin", *origin);
    if segments.is_empty() {
        faults.say("segments", "`segments` is empty");
    }
    let wrong = |ends: &[[f32; 4]; 2]| {
        let empty = || {
            let without_length = *caps != Caps::Round && Cylinders::is_empty(ends);
            without_length.then(|| "has no length, and its ends are not round".to_owned())
        };
        wrong_ball(&ends[0]).or_else(|| wrong_ball(&ends[1])).or_else(empty)
    };
    let right = |ends: &[[f32; 4]; 2]| {
        is_ball(&ends[0]) & is_ball(&ends[1]) & (*caps == Caps::Round || !Cylinders::is_empty(ends))
    };
    first(segments, "segments", right, wrong, faults);
    colors(pairs.as_flattened(), "ends of segments", 2 * segments.len(), faults);
    fields(numbers, 2 * segments.len(), faults);
}

/// Judges fields of so many points; what is no number there is drawn as such.
fn fields(fields: &[Field], points: usize, faults: &mut Faults) {
    for Field { name, values } in fields {
        if values.len() != points {
            let (name, count) = (quoted(name), values.len());
            faults.say(
                "fields",
                format!("`fields`: {name} holds {count} numbers for {points} points"),
            );
        }
    }
}

/// Whether all is well with `[x, y, z, radius]`.
fn is_ball(ball: &[f32; 4]) -> bool {
    are_held(ball) & (ball[3] > 0.0)
}

/// What is wrong with it, if anything is.
fn wrong_ball(ball: &[f32; 4]) -> Option<String> {
    wrong_numbers(ball).or_else(|| {
        let radius = f64::from(ball[3]);
        let held = Range::POSITIVE.holds(radius);
        (!held).then(|| format!("has the radius {radius}; it must be above 0"))
    })
}

/// Says what is wrong with the first value that is not `right`, and how many more there are.
///
/// `right` is asked of every value, so it is plain arithmetic; the words are found for one alone.
fn first<T: Sync>(
    values: &[T],
    field: &'static str,
    right: impl Fn(&T) -> bool + Sync,
    wrong: impl Fn(&T) -> Option<String>,
    faults: &mut Faults,
) {
    // All of a piece, without a branch for each.
    let is_right = |piece: &[T]| piece.iter().fold(true, |all, value| all & right(value));
    let count = |piece: &[T]| {
        let wrong = || piece.iter().filter(|value| !right(value)).count();
        if is_right(piece) { 0 } else { wrong() }
    };
    let count: usize = values.par_chunks(PIECE).map(count).sum();
    let Some(number) = values.iter().position(|value| count > 0 && !right(value)) else { return };
    let what = wrong(&values[number]).unwrap_or_default();
    let more = if count > 1 { format!(", and {} more", count - 1) } else { String::new() };
    faults.say(field, format!("`{field}` {number} {what}{more}"));
}

/// Whether all are numbers that a scene may hold.
fn are_held(values: &[f32]) -> bool {
    values.iter().fold(true, |all, v| all & (v.abs() <= LARGEST as f32))
}

fn vectors(values: &[Vec3], field: &'static str, faults: &mut Faults) {
    let right = |v: &Vec3| are_held(&v.to_array());
    first(values, field, right, |v| wrong_numbers(&v.to_array()), faults);
}

fn wrong_numbers(values: &[f32]) -> Option<String> {
    values.iter().find_map(|&v| not_held(v.into()))
}

fn colors(colors: &[Rgb], per: &str, count: usize, faults: &mut Faults) {
    if !colors.is_empty() && colors.len() != count {
        faults.say("colors", format!("`colors` holds {} for {count} {per}", colors.len()));
    }
    let wrong = |color: &Rgb| {
        let negative = || {
            let below = color.to_array().iter().any(|&channel| channel < 0.0);
            below.then(|| "is negative; there is no light below 0".to_owned())
        };
        wrong_numbers(&color.to_array()).or_else(negative)
    };
    let right = |color: &Rgb| {
        let channels = color.to_array();
        are_held(&channels) & channels.iter().fold(true, |all, &channel| all & (channel >= 0.0))
    };
    first(colors, "colors", right, wrong, faults);
}

/// Three indices a triangle, each below `count`, or none where that is `optional`.
fn corners(
    indices: &[[u32; 3]],
    field: &'static str,
    count: usize,
    triangles: usize,
    optional: bool,
    faults: &mut Faults,
) {
    if indices.len() != triangles {
        let message = format!("`{field}` holds {} for {triangles} triangles", indices.len());
        faults.say(field, message);
    }
    // No index is as high as `u32::MAX`, which is none.
    let most = u32::try_from(count).unwrap_or(u32::MAX);
    let is_right = |i: u32| (i < most) | (optional & (i == NO_INDEX));
    let right = |corners: &[u32; 3]| corners.iter().fold(true, |all, &i| all & is_right(i));
    let wrong = |corners: &[u32; 3]| {
        let index = corners.iter().find(|&&i| !is_right(i))?;
        Some(format!("holds the index {index}, but there are {count}"))
    };
    first(indices, field, right, wrong, faults);
}

/// Normals that corners use must have a direction.
fn directions(mesh: &Mesh, faults: &mut Faults) {
    let used = if mesh.normal_indices.is_empty() { &mesh.indices } else { &mesh.normal_indices };
    let none = |i: &u32| {
        // What is out of range or no number has been said.
        mesh.normals.get(*i as usize).is_some_and(|n: &Vec3| *n == Vec3::ZERO)
    };
    if !mesh.normals.par_iter().with_min_len(PIECE).any(|n| *n == Vec3::ZERO) {
        return;
    }
    let wrong = |corners: &[u32; 3]| {
        let index = corners.iter().find(|i| none(i))?;
        Some(format!("uses the normal {index}, which is [0, 0, 0] and has no direction"))
    };
    let field = if mesh.normal_indices.is_empty() { "indices" } else { "normal_indices" };
    first(used, field, |corners| !corners.iter().any(none), wrong, faults);
}
