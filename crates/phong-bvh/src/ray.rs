//! Rays and what they hit.

use glam::{Vec2, Vec3};

/// A ray: the points `origin + t · dir` for `t_min < t < t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Where it starts. Finite.
    pub origin: Vec3,
    /// Hits at this `t` or nearer do not count. ≥ 0.
    pub t_min: f32,
    /// Its direction, of unit length to rounding; so `t` is distance. Finite.
    pub dir: Vec3,
    /// Hits at this `t` or farther do not count. May be infinite.
    pub t_max: f32,
}

impl Ray {
    /// A ray without an end.
    pub const fn new(origin: Vec3, dir: Vec3) -> Self {
        Self { origin, t_min: 0.0, dir, t_max: f32::INFINITY }
    }

    /// The point at distance `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.dir
    }
}

/// The closest hit of a ray, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// Distance along the ray; infinite where nothing was hit.
    pub t: f32,
    /// Number of the primitive over all geometry in the order it was given; `u32::MAX`: none.
    /// Of two hits at the same `t` the lower number is the hit.
    pub prim: u32,
    /// Triangles: barycentric weight of the second corner. Else 0.
    pub u: f32,
    /// Triangles: barycentric weight of the third corner. Else 0.
    pub v: f32,
}

impl Hit {
    /// Nothing was hit.
    pub const NONE: Self = Self { t: f32::INFINITY, prim: u32::MAX, u: 0.0, v: 0.0 };

    /// Whether something was hit.
    pub const fn is_some(&self) -> bool {
        self.prim != u32::MAX
    }
}

/// The surface at a hit: what geometry alone can say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, re-solved more exactly than `ray.at(hit.t)`.
    pub p: Vec3,
    /// Bound on the error of each coordinate of `p`; rays leave the surface from beyond it.
    pub p_error: Vec3,
    /// Unit geometric normal, not turned towards the ray: outwards for closed shapes, by the right
    /// hand for triangles.
    pub ng: Vec3,
}

/// Where on its surface a hit is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates {
    /// Surface coordinates in [0, 1]²: triangles barycentric, spheres longitude and latitude, round
    /// solids angle and height, flat ones flat. On a plane lengths along two axes, without bounds.
    pub uv: Vec2,
    /// Unit tangent along growing `uv.x`, perpendicular to the geometric normal.
    pub tangent: Vec3,
}
