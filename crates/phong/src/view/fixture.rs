//! What a light is mounted in: the surfaces that its position lies in, and the luminous bodies around it.
//!
//! A lamp in the plane of a ceiling is meant to be seen from the room, and one within a glowing ball from
//! outside the ball. Rays towards such lights end short of the surface, on their own side of it, or at
//! the body.

use glam::{DVec3, Vec3};
use phong_bvh::{Hit, Primitives, Ray, World};

use crate::geometry::Geometry;
use crate::material::Material;

/// How many surfaces a light may lie in: three meet in the corner of a room.
const MOST_SURFACES: usize = 4;
/// How many surfaces are passed in looking for those that matter.
const MOST_PASSED: usize = 64;

/// What a light is mounted in; of most lights nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fixture {
    /// How far the light may be from where it was written, by rounding, scene units.
    pub(crate) error: f32,
    /// Surfaces that it lies in, to rounding.
    pub(crate) surfaces: Vec<Mounting>,
    /// Part and primitive of each luminous body that it is within, sorted.
    bodies: Vec<[u32; 2]>,
}

/// A surface that a light lies in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mounting {
    /// Its unit normal there.
    pub(crate) normal: Vec3,
    /// How far from the light, along the normal, a ray must end so that no rounding takes it across.
    pub(crate) keep: f32,
}

impl Fixture {
    /// Looks around a light at `at`, in a picture taken from `eye`.
    pub(super) fn of(geometry: &Geometry, materials: &[Material], at: DVec3, eye: DVec3) -> Self {
        let off = at - geometry.center();
        let rounding = f64::from(f32::EPSILON) * (off.x.abs() + off.y.abs() + off.z.abs());
        let world = geometry.world();
        // How large the place is that the light stands in, since rays towards it are rounded by that: the
        // third nearest thing along the axes, so that neither the surface that it lies in nor the horizon
        // counts.
        let first = |dir: Vec3| f64::from(world.intersect(&Ray::new(at, dir)).t);
        let mut around = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(first);
        around.sort_by(f64::total_cmp);
        // In the open it is as far as everything, and no farther than a near eye.
        let to_all = world.bounds().map_or(f64::INFINITY, |[low, high]| {
            (high - low).length() + at.distance((low + high) / 2.0)
        });
        let size = if around[2].is_finite() { around[2] } else { to_all.min(at.distance(eye)) };
        let slack = rounding + size * f64::from(f32::EPSILON);
        Self {
            error: rounding as f32,
            surfaces: surfaces(world, at, slack),
            bodies: bodies(geometry, materials, at),
        }
    }

    /// That of a light that is a mesh, whose primitives these are, sorted: it does not shade its own light.
    pub(super) fn of_mesh(bodies: Vec<[u32; 2]>, error: f32) -> Self {
        Self { error, surfaces: Vec::new(), bodies }
    }

    /// Whether it is within luminous bodies, or one itself.
    pub(crate) fn has_bodies(&self) -> bool {
        !self.bodies.is_empty()
    }

    /// Whether this is one of the luminous bodies that it is within, or is.
    pub(crate) fn is_body(&self, hit: &Hit) -> bool {
        self.bodies.binary_search(&[hit.part, hit.prim]).is_ok()
    }
}

/// The surfaces that come as near to a point as their own error and `slack`.
fn surfaces(world: &World, at: DVec3, slack: f64) -> Vec<Mounting> {
    let mut found: Vec<Mounting> = Vec::new();
    let reach = 64.0 * slack;
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let start = Ray::new(at - reach * axis, axis.as_vec3());
        let whole = Ray { t_max: (2.0 * reach) as f32, ..start };
        for (ray, hit) in passed(world, whole) {
            let surface = world.surface(&ray, &hit);
            let normal = surface.ng;
            let error = slack + f64::from(normal.abs().dot(surface.p_error));
            if (at - surface.p).dot(normal.as_dvec3()).abs() > error {
                continue;
            }
            let keep = (2.0 * error) as f32;
            let count = found.len();
            let known = found.iter_mut().find(|known| known.normal.dot(normal).abs() > 0.999);
            match known {
                Some(known) => known.keep = known.keep.max(keep),
                None if count < MOST_SURFACES => found.push(Mounting { normal, keep }),
                None => {}
            }
        }
    }
    found
}

/// The luminous bodies that a point is within: those that a ray from it leaves.
fn bodies(geometry: &Geometry, materials: &[Material], at: DVec3) -> Vec<[u32; 2]> {
    if !materials.iter().any(Material::glows) {
        return Vec::new();
    }
    let world = geometry.world();
    let left = passed(world, Ray::new(at, Vec3::X)).filter(|(ray, hit)| {
        let material = geometry.batch(hit.part).material(hit.prim);
        materials[material as usize].glows()
            && is_convex(world.primitives(hit.part))
            && world.surface(ray, hit).ng.x > 0.0
    });
    let mut bodies: Vec<_> = left.map(|(_, hit)| [hit.part, hit.prim]).collect();
    bodies.sort_unstable();
    bodies
}

/// Whether primitives are bodies that a line enters once and leaves once.
fn is_convex(primitives: &Primitives) -> bool {
    match primitives {
        Primitives::Spheres(_) => true,
        Primitives::Solid(solid) => solid.shape.is_convex(),
        Primitives::Triangles { .. } | Primitives::Plane(_) | Primitives::Cylinders { .. } => false,
    }
}

/// The hits along a ray, from near to far, each with the part of the ray that met it.
fn passed(world: &World, ray: Ray) -> impl Iterator<Item = (Ray, Hit)> + '_ {
    let mut rest = Some(ray);
    let next = move || {
        let ray = rest?;
        let hit = world.intersect(&ray);
        if !hit.is_some() {
            return None;
        }
        let surface = world.surface(&ray, &hit);
        let origin = phong_bvh::offset_origin(surface.p, surface.p_error, surface.ng, ray.dir);
        rest = Some(Ray { origin, t_max: ray.t_max - hit.t, ..ray }).filter(|ray| ray.t_max > 0.0);
        Some((ray, hit))
    };
    std::iter::from_fn(next).take(MOST_PASSED)
}
