//! Bulk geometry in flat arrays: indexed triangles, spheres at points, cylinders along segments.
//!
//! The arrays are [`Shared`]: a clone of a mesh refers to the same ones, and so do the trees that
//! the renderer builds. Nothing copies them.

mod blocks;
mod closed;
mod colored;
mod cylinders;
mod few;
mod fields;
mod groups;
mod part;
mod polygon;
mod shared;
mod smooth;
mod spacing;
mod tidy;
mod weld;

pub use cylinders::{Caps, Cylinders};
pub(crate) use few::Few;
pub use fields::Field;
pub(crate) use groups::FLAT;
pub(crate) use polygon::cut_polygons;
pub use shared::Shared;
pub(crate) use spacing::radius_that_touches;
pub(crate) use tidy::collapse_faces;
pub(crate) use weld::{Hash, Weld};

use glam::{DVec3, Vec2, Vec3};

use crate::color::Rgb;

/// In `normal_indices` and `uv_indices`: this corner has none (the geometric normal; (0, 0)).
pub const NO_INDEX: u32 = u32::MAX;

/// Values of an array that one thread looks through before another takes the next.
pub(crate) const PIECE: usize = 1 << 12;

/// Indexed triangles. Every index is in range and every number finite.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Added, in f64, to every position: data far from the origin keep their detail.
    pub origin: DVec3,
    /// Positions relative to `origin`, in scene units.
    pub positions: Shared<Vec3>,
    /// Three positions a triangle, counter-clockwise seen from outside.
    pub indices: Shared<[u32; 3]>,
    /// Shading normals, any length but 0; empty: the geometric normal everywhere.
    pub normals: Shared<Vec3>,
    /// Three normals a triangle, or [`NO_INDEX`]; empty: the same as `indices`.
    pub normal_indices: Shared<[u32; 3]>,
    /// Texture coordinates; empty: none.
    pub uvs: Shared<Vec2>,
    /// Three texture coordinates a triangle, or [`NO_INDEX`]; empty: the same as `indices`.
    pub uv_indices: Shared<[u32; 3]>,
    /// A linear colour a position, which replaces the material's; empty: none.
    pub colors: Shared<Rgb>,
    /// A material a triangle (an index into the scene's); empty: the object's for all.
    pub face_materials: Shared<u32>,
    /// Numbers that the positions have, which maps show; most have none.
    pub fields: Vec<Field>,
}

/// A sphere at every point. Radii > 0, every number finite.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Added, in f64, to every centre.
    pub origin: DVec3,
    /// `[x, y, z, radius]` each, centres relative to `origin`.
    pub spheres: Shared<[f32; 4]>,
    /// A linear colour a point, which replaces the material's; empty: none.
    pub colors: Shared<Rgb>,
    /// The radius of all, if nobody gave one and the reader guessed it: a picture that cannot show
    /// spheres so small may draw larger ones. `None`: the radii are as they were meant.
    pub guessed: Option<f32>,
    /// Numbers that the points have, which maps show; most have none.
    pub fields: Vec<Field>,
}
