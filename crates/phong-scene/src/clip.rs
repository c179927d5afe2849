//! Clipping: what is cut away, and what the cut shows.
//!
//! ```toml
//! [[clip]]
//! point = [0, 1, 0]
//! normal = [0, 0, 1]
//!
//! [[clip]]
//! kind = "box"
//! min = [-1, -1, -1]
//! max = [1, 1, 1]
//! keep = "inside"
//! cap = "plaster"
//! objects = ["mesh 1"]
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `kind` | `plane` or `box` | `"plane"` | What it cuts along. |
//! | `point` (plane) | three numbers, `[x, y, z]` | required | Any point of the plane. |
//! | `normal` (plane) | three numbers, `[x, y, z]`, not all 0 | required | What lies on the side that it points to is cut away; any length. |
//! | `min` (box) | three numbers, `[x, y, z]` | required | The corner with the lowest coordinates. |
//! | `max` (box) | three numbers, `[x, y, z]` | required | The corner with the highest coordinates. |
//! | `keep` (box) | `outside` or `inside` | `"outside"` | Which part stays. |
//! | `cap` | `true`, `false` or the name of a material, in quotes | `true` | Whether closed objects look solid where they are cut, in their own material or another; false: one looks into them. |
//! | `objects` | a list of names, in quotes | all objects | The names of the objects that it cuts, or of the instances they are in. |

use std::collections::BTreeSet;

use glam::DVec3;

use crate::diagnostic::Place;
use crate::material::MaterialId;
use crate::wording::words;

/// What is cut away of objects: it is neither seen nor does it cast a shadow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    /// What it cuts along.
    pub kind: ClipKind,
    /// What is seen where it cuts through something closed.
    pub cap: Cap,
    /// The names of the objects that it cuts, or of the instances they are in; empty: all.
    pub objects: Vec<String>,
    /// Where it was written.
    pub place: Place,
}

impl Clip {
    /// The most of them in a scene.
    pub const MOST: usize = 32;

    /// The objects that it cuts.
    pub fn cut_objects(&self) -> CutObjects<'_> {
        CutObjects { names: self.objects.iter().map(String::as_str).collect() }
    }
}

/// The objects that a clip cuts, found by name: there may be very many of both.
#[derive(Clone, Debug)]
pub struct CutObjects<'a> {
    /// None: all are cut.
    names: BTreeSet<&'a str>,
}

impl CutObjects<'_> {
    /// Whether the object of this name is one of them; within an instance that is `instance 1 / sphere 2`, and
    /// the name of the instance is enough.
    pub fn has(&self, name: &str) -> bool {
        let mut ends = name.match_indices(" / ").map(|(end, _)| end).chain([name.len()]);
        self.names.is_empty() || ends.any(|end| self.names.contains(&name[..end]))
    }
}

/// What a clip cuts along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClipKind {
    /// All on one side of a plane is cut away.
    Plane {
        /// Any point of the plane.
        point: DVec3,
        /// Points to the side that is cut away; not 0.
        normal: DVec3,
    },
    /// What is within a box along the axes is cut away, or all that is not.
    Box {
        /// The corner with the lowest coordinates.
        min: DVec3,
        /// The corner with the highest coordinates.
        max: DVec3,
        /// Which part stays. Default outside.
        keep: Keep,
    },
}

words!(ClipKind {
    "plane" = Plane { point: DVec3::ZERO, normal: DVec3::Z },
    "box" = Box { min: DVec3::ZERO, max: DVec3::ONE, keep: Keep::Outside },
});

impl Default for ClipKind {
    /// All that has a z above 0.
    fn default() -> Self {
        Self::Plane { point: DVec3::ZERO, normal: DVec3::Z }
    }
}

/// Which part a box leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keep {
    /// What is outside: the box is a notch.
    #[default]
    Outside,
    /// What is within: all else is cut away.
    Inside,
}

words!(Keep { "outside" = Outside, "inside" = Inside });

/// What is seen where a clip cuts through something closed. What is open has no cap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cap {
    /// The cut face, of the object's own material.
    #[default]
    Own,
    /// The inner side of the object.
    Open,
    /// The cut face, of this material.
    Of(MaterialId),
}
