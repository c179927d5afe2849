//! A canonical shape under an affine transform.

use glam::{DMat3, DVec3, Vec3};

use super::{
    box_, cone,
    crossing::{Crossings, Line},
    cylinder, disc, ellipsoid, facet,
    patch::Patch,
    torus,
};
use crate::{Canonical, Solid, local::Ray};

impl Solid {
    /// Where `ray` first meets the solid, or none: the distance, and of a triangle the weights of its second and
    /// third corner; else 0.
    ///
    /// Closed shapes are met from within too, and so are open cylinders and cones.
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<(f32, [f32; 2])> {
        let (line, start) = self.line(ray);
        let within = |t: f64| {
            let t = (start + t) as f32;
            (ray.t_min < t && t < ray.t_max).then_some(t)
        };
        let crossings = self.crossings(&line, |t| within(t).is_some());
        crossings.as_slice().iter().find_map(|crossing| {
            let weights = match self.shape {
                Canonical::Triangle => facet::weights(line.at(crossing.t)),
                _ => [0.0; 2],
            };
            Some((within(crossing.t)?, weights))
        })
    }

    /// The least box around the solid, in world space, rounded outwards: its lower and upper corner.
    pub fn bounds(&self) -> [Vec3; 2] {
        let m = &self.to_world.matrix3;
        let middle = self.to_world.translation;
        let [low, high] = match self.shape {
            Canonical::Sphere => around(middle, ellipsoid::reach(m)),
            Canonical::Disc => around(middle, disc::reach(m, 1.0)),
            Canonical::Triangle => facet::bounds(m, middle),
            Canonical::Box => around(middle, box_::reach(m)),
            Canonical::Cylinder { .. } => frustum(m, middle, [1.0, 1.0]),
            Canonical::Cone { radius, radius_to, .. } => frustum(m, middle, [radius, radius_to]),
            Canonical::Torus { tube } => around(middle, torus::reach(m, tube)),
        };
        // A few roundings of the sums above, then one to f32.
        let slack = 8.0 * f64::EPSILON * low.abs().max(high.abs());
        let (low, high) = (low - slack, high + slack);
        let down = |x: f64| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 };
        let up = |x: f64| -down(-x);
        [
            Vec3::new(down(low.x), down(low.y), down(low.z)),
            Vec3::new(up(high.x), up(high.y), up(high.z)),
        ]
    }

    /// No less than any coordinate in its parts: what roundings in f64 are relative to.
    pub(crate) fn largest(&self) -> DVec3 {
        let radius = match self.shape {
            Canonical::Cone { radius, radius_to, .. } => radius.max(radius_to).max(1.0),
            Canonical::Torus { tube } => 1.0 + tube,
            _ => 1.0,
        };
        radius * box_::reach(&self.to_world.matrix3) + self.to_world.translation.abs()
    }

    /// The surface where `ray` meets it at `t`, in world space: of the crossings the one nearest to
    /// `t`, solved again in f64.
    pub(crate) fn patch(&self, ray: &Ray, t: f32) -> Patch {
        let (line, start) = self.line(ray);
        let t = f64::from(t) - start;
        let (t, face) =
            self.crossings(&line, |_| false).nearest(t).map_or((t, 0), |c| (c.t, c.face));
        let p = line.at(t);
        let local = match self.shape {
            Canonical::Sphere => ellipsoid::patch(p),
            Canonical::Disc => disc::patch(p, 0.0, 1.0, true),
            Canonical::Triangle => facet::patch(p),
            Canonical::Box => box_::patch(p, face),
            Canonical::Cylinder { .. } => cylinder::patch(p, face),
            Canonical::Cone { radius, radius_to, .. } => cone::patch(p, [radius, radius_to], face),
            Canonical::Torus { tube } => torus::patch(p, tube),
        };
        // Normals are gradients, so they go by the transposed inverse, which also keeps them
        // outwards under a mirror image.
        let m = &self.to_world.matrix3;
        let inverse = m.inverse();
        // Of an ellipsoid the sharpest is its longest axis over the square of the shortest; and no
        // axis is longer or shorter than these norms.
        let norm = |m: &DMat3| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        let shrink = norm(&inverse);
        Patch {
            p: self.to_world.transform_point3(local.p),
            normal: inverse.transpose() * local.normal,
            tangent: *m * local.tangent,
            uv: local.uv,
            curvature: local.curvature * norm(m) * shrink * shrink,
        }
    }

    /// The line of `ray` in the solid's own space, from its point closest to the shape's middle,
    /// and the ray's `t` there.
    fn line(&self, ray: &Ray) -> (Line, f64) {
        let inverse = self.to_world.matrix3.inverse();
        // The difference first: it is exact where it matters, far from the world's origin.
        let o = inverse * (ray.origin.as_dvec3() - self.to_world.translation);
        let d = inverse * ray.dir.as_dvec3();
        let middle = match self.shape {
            Canonical::Cylinder { .. } | Canonical::Cone { .. } => DVec3::new(0.0, 0.0, 0.5),
            _ => DVec3::ZERO,
        };
        let start = (middle - o).dot(d) / d.length_squared();
        (Line { o: o + start * d, d }, start)
    }

    /// The crossings of `line`, at least up to the first that is `enough`.
    fn crossings(&self, line: &Line, enough: impl Fn(f64) -> bool) -> Crossings {
        match self.shape {
            Canonical::Sphere => ellipsoid::crossings(line),
            Canonical::Disc => disc::crossings(line),
            Canonical::Triangle => facet::crossings(line),
            Canonical::Box => box_::span(line).into(),
            Canonical::Cylinder { capped } => cylinder::crossings(line, capped),
            Canonical::Cone { radius, radius_to, capped } => {
                cone::crossings(line, [radius, radius_to], capped)
            }
            Canonical::Torus { tube } => torus::crossings(line, tube, enough),
        }
    }
}

/// The box that reaches as far to either side.
fn around(middle: DVec3, reach: DVec3) -> [DVec3; 2] {
    [middle - reach, middle + reach]
}

/// The box around two discs, at z = 0 and z = 1, whose hull the frustum is.
fn frustum(m: &DMat3, base: DVec3, [radius, radius_to]: [f64; 2]) -> [DVec3; 2] {
    let [low, high] = around(base, disc::reach(m, radius));
    let [low_to, high_to] = around(base + m.z_axis, disc::reach(m, radius_to));
    [low.min(low_to), high.max(high_to)]
}
