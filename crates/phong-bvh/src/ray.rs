//! Rays of the world and what they hit.

use glam::{DVec3, Vec2, Vec3};

/// A ray: the points `origin + t · dir` for `t_min < t < t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts. Finite.
    pub origin: DVec3,
    /// Hits at this `t` or nearer do not count. ≥ 0.
    pub t_min: f32,
    /// Its direction, of unit length to rounding; so `t` is distance. Finite.
    pub dir: Vec3,
    /// Hits at this `t` or farther do not count. May be infinite.
    pub t_max: f32,
}

impl Ray {
    /// A ray without an end.
    ///
    /// ```
    /// use glam::{DVec3, Vec3};
    /// use phong_bvh::Ray;
    ///
    /// let ray = Ray::new(DVec3::new(1e12, 0.25, 0.0), Vec3::Y);
    /// assert_eq!(ray.at(2.0), DVec3::new(1e12, 2.25, 0.0));
    /// ```
    pub fn new(origin: impl Into<DVec3>, dir: Vec3) -> Self {
        Self { origin: origin.into(), t_min: 0.0, dir, t_max: f32::INFINITY }
    }

    /// The point at distance `t`.
    pub fn at(&self, t: f32) -> DVec3 {
        self.origin + f64::from(t) * self.dir.as_dvec3()
    }
}

/// The closest hit of a ray, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray; infinite where nothing was hit.
    pub t: f32,
    /// Number of the part of the world; `u32::MAX`: none. Of two hits at the same `t` the one of the
    /// lower part is the hit, and within a part the one of the lower primitive.
    pub part: u32,
    /// Number of the primitive within its part.
    pub prim: u32,
    /// Triangles: barycentric weight of the second corner. Cylinders of a bundle: 1 in the half of the second
    /// end. Else 0.
    pub u: f32,
    /// Triangles: barycentric weight of the third corner. Else 0.
    pub v: f32,
}

impl Hit {
    /// Nothing was hit.
    pub const NONE: Self =
        Self { t: f32::INFINITY, part: u32::MAX, prim: u32::MAX, u: 0.0, v: 0.0 };

    /// Whether something was hit.
    pub const fn is_some(&self) -> bool {
        self.part != u32::MAX
    }
}

/// What tracing one ray cost. Differs between SIMD levels and presets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Nodes visited.
    pub nodes: u32,
    /// Primitives (or blocks of them) tested.
    pub primitives: u32,
}

/// The surface at a hit: what geometry alone can say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, re-solved more exactly than `ray.at(hit.t)`.
    pub p: DVec3,
    /// Bound on the error of each coordinate of `p`, and on what is lost where a ray that starts there
    /// meets the same part again; rays leave the surface from beyond it.
    pub p_error: Vec3,
    /// Unit geometric normal, not turned towards the ray: outwards for closed shapes, by the right
    /// hand for triangles, in a part that is not mirrored.
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
