//! The properties of vertices that are used, and what each is.

use crate::mesh::Field;

/// What a number of a vertex can be: places in [`Row`].
pub(super) const RADIUS: usize = 3;
pub(super) const NORMAL: usize = 4;
pub(super) const COLOR: usize = 7;
pub(super) const UV: usize = 10;
pub(super) const ALPHA: usize = 12;
/// The first of those that maps show, whose names the scene says.
pub(super) const FIELD: usize = 13;

/// Numbers of a vertex that are looked at.
pub(super) const WIDTH: usize = FIELD + Field::MOST;

/// One vertex: x, y, z, radius, nx, ny, nz, red, green, blue, u, v, alpha, and what maps show; 0 where
/// the file has none.
pub(super) type Row = [f64; WIDTH];

/// Names of each place of a row; the first that the file has counts.
pub(super) const NAMES: [&[&str]; WIDTH] = [
    &["x"],
    &["y"],
    &["z"],
    &["radius"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["red", "diffuse_red", "r"],
    &["green", "diffuse_green", "g"],
    &["blue", "diffuse_blue", "b"],
    &["s", "u", "texture_u", "texture_s"],
    &["t", "v", "texture_v", "texture_t"],
    &["alpha", "diffuse_alpha", "a"],
    &[],
    &[],
    &[],
    &[],
];

/// Whether a property of this name says anything that is drawn.
pub(super) fn is_used(name: &str) -> bool {
    let lists = ["vertex_indices", "vertex_index"];
    NAMES.iter().any(|names| names.contains(&name)) || lists.contains(&name)
}
