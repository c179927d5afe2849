//! Light that goes through things in a straight line: what of it is left behind see-through surfaces.

use std::borrow::Cow;

use phong_bvh::{Hit, Ray, offset_origin};
use phong_scene::Rgb;

use super::Integrator;
use crate::interaction::SurfaceInteraction;
use crate::material::Material;
use crate::view::View;

/// A light is lost behind more surfaces than this.
const MOST_SURFACES: usize = 100;

impl Integrator<'_> {
    /// What is left of a light, channel by channel, at the other end of a ray that meets something; what
    /// `counts` says no to is not met.
    pub(super) fn left_of_light(&self, ray: &Ray, counts: impl Fn(&Hit) -> bool) -> Rgb {
        let (view, mut ray, mut left) = (self.scene, *ray, Rgb::WHITE);
        for _ in 0..MOST_SURFACES {
            let hit = view.intersect(&ray);
            if !hit.is_some() {
                return left;
            }
            let at = view.interaction(&ray, &hit);
            if counts(&hit) {
                left = left * passes(view, &ray, &at);
                if left.is_black() {
                    return left;
                }
            }
            let origin = offset_origin(at.p, at.p_error, at.ng.to_vec(), ray.dir);
            ray = Ray { origin, t_max: ray.t_max - hit.t, ..ray };
            if ray.t_max <= 0.0 {
                return left;
            }
        }
        Rgb::BLACK
    }
}

/// What is left of a light behind one surface.
fn passes(view: &View, ray: &Ray, at: &SurfaceInteraction) -> Rgb {
    material_met(view, ray, at).passes(at.n.dot(at.e).max(0.0))
}

/// The material of a surface as it is where a ray met it.
pub(super) fn material_met<'v>(
    view: &'v View,
    ray: &Ray,
    at: &SurfaceInteraction,
) -> Cow<'v, Material> {
    if view.has_textures() {
        let point = view.texture_point_of(ray, at);
        return Cow::Owned(view.material_at(at.material, &point));
    }
    Cow::Borrowed(&view.materials()[at.material as usize])
}
