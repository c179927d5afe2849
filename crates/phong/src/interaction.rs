//! Where a ray met a surface: all that shading needs to know.

use glam::{DVec3, Vec3};
use phong_bvh::{Hit, Ray, offset_origin};
use phong_scene::Rgb;

use crate::math::Dir3;

/// Where a ray met a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// What was hit, and how far along the ray.
    pub hit: Hit,
    /// Number of the material, from 0.
    pub material: u32,
    /// The point, in the world.
    pub p: DVec3,
    /// Bound on the error of each coordinate of `p`, and on what is lost where a ray that starts there
    /// meets the same object again.
    pub p_error: Vec3,
    /// Geometric normal as the surface has it: outwards, whichever side the ray comes from.
    pub ng: Dir3,
    /// Shading normal, on the side of the geometric normal that the ray comes from: N. At a silhouette
    /// N·E may be below 0.
    pub n: Dir3,
    /// To the eye: against the ray. E.
    pub e: Dir3,
    /// The diffuse colour here: the geometry's own, else the material's. Linear.
    pub color: Rgb,
    /// The index of refraction of the far side relative to this one, where glasses meet or fill one
    /// another; `None`: it is the material's own.
    pub eta: Option<f32>,
    /// How wide the ray is there, across it, in units of the world: what a look-up of a texture stands for.
    /// 0: a point.
    pub width: f32,
}

impl SurfaceInteraction {
    /// The geometric normal on the side the ray comes from.
    #[inline]
    pub fn facing_ng(&self) -> Dir3 {
        self.ng.facing(self.e)
    }

    /// Whether the ray comes from outside: the side the geometric normal points to.
    #[inline]
    pub fn from_outside(&self) -> bool {
        self.ng.dot(self.e) >= 0.0
    }

    /// A ray that leaves the surface in direction `dir`, starting beyond the error of `p`.
    #[inline]
    pub fn spawn(&self, dir: Dir3, t_max: f32) -> Ray {
        let d = dir.to_vec();
        let origin = offset_origin(self.p, self.p_error, self.ng.to_vec(), d);
        Ray { t_max, ..Ray::new(origin, d) }
    }
}
