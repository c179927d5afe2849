//! What a solid is, said a second time: functions that change sign at its surfaces, marched along
//! the ray in small steps. Slow, and sharing no code with what it judges.

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use phong_bvh::{Canonical, Ray, Solid};
use proptest::prelude::*;

/// A solid with the inverse of its transform made from the transform's parts.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) solid: Solid,
    scale: DVec3,
    turn: DQuat,
    at: DVec3,
}

impl Placed {
    pub(crate) fn new(shape: Canonical, scale: DVec3, turn: DQuat, at: DVec3) -> Self {
        let matrix3 = DMat3::from_quat(turn) * DMat3::from_diagonal(scale);
        let to_world = DAffine3 { matrix3, translation: at };
        Self { solid: Solid { shape, to_world }, scale, turn, at }
    }

    /// A point of the world in the solid's own space.
    pub(crate) fn local(&self, p: DVec3) -> DVec3 {
        self.turn.conjugate() * (p - self.at) / self.scale
    }

    /// The point of a ray at `t` in the solid's own space: the difference first, so that nothing is lost of a solid
    /// that is small and far from the origin.
    pub(crate) fn local_at(&self, ray: &Ray, t: f64) -> DVec3 {
        let p = (ray.origin - self.at) + t * ray.dir.as_dvec3();
        self.turn.conjugate() * p / self.scale
    }

    /// Whether a ray lies so nearly within the plane of a flat solid that rounding decides where it meets it.
    pub(crate) fn is_within_plane(&self, ray: &Ray) -> bool {
        let d = self.turn.conjugate() * ray.dir.as_dvec3() / self.scale;
        matches!(self.solid.shape, Canonical::Disc | Canonical::Triangle)
            && d.z.abs() < 1e-8 * d.length()
    }

    /// Around all of it.
    pub(crate) fn bounding_sphere(&self) -> (DVec3, f64) {
        let (low, high) = match self.solid.shape {
            Canonical::Sphere | Canonical::Box => (DVec3::NEG_ONE, DVec3::ONE),
            Canonical::Disc => (DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)),
            Canonical::Triangle => (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)),
            Canonical::Cylinder { .. } => (DVec3::new(-1.0, -1.0, 0.0), DVec3::ONE),
            Canonical::Cone { radius, radius_to, .. } => {
                let r = radius.max(radius_to);
                (DVec3::new(-r, -r, 0.0), DVec3::new(r, r, 1.0))
            }
            Canonical::Torus { tube } => {
                let r = 1.0 + tube;
                (DVec3::new(-r, -r, -tube), DVec3::new(r, r, tube))
            }
        };
        let middle = self.at + self.turn * (self.scale * (0.5 * (low + high)));
        (middle, (self.scale * (0.5 * (high - low))).length())
    }

    /// A function of the solid's own space with opposite signs on both sides of its surface; only
    /// where [`Placed::belongs`] is positive is a change of sign the surface.
    pub(crate) fn side(&self, p: DVec3) -> f64 {
        let rho = (p.x * p.x + p.y * p.y).sqrt();
        let ends = (-p.z).max(p.z - 1.0);
        match self.solid.shape {
            Canonical::Sphere => (p.x * p.x + p.y * p.y + p.z * p.z).sqrt() - 1.0,
            Canonical::Disc | Canonical::Triangle => p.z,
            Canonical::Box => p.x.abs().max(p.y.abs()).max(p.z.abs()) - 1.0,
            Canonical::Cylinder { capped: true } => (rho - 1.0).max(ends),
            Canonical::Cylinder { capped: false } => rho - 1.0,
            Canonical::Cone { radius, radius_to, capped } => {
                let off = rho - (radius * (1.0 - p.z) + radius_to * p.z);
                if capped { off.max(ends) } else { off }
            }
            Canonical::Torus { tube } => ((rho - 1.0) * (rho - 1.0) + p.z * p.z).sqrt() - tube,
        }
    }

    /// How far within the surface's edge a point is, in the solid's own space; negative beyond it.
    pub(crate) fn belongs(&self, p: DVec3) -> f64 {
        match self.solid.shape {
            Canonical::Disc => 1.0 - (p.x * p.x + p.y * p.y).sqrt(),
            Canonical::Triangle => p.x.min(p.y).min(1.0 - p.x - p.y),
            Canonical::Cylinder { capped: false } | Canonical::Cone { capped: false, .. } => {
                p.z.min(1.0 - p.z)
            }
            _ => f64::INFINITY,
        }
    }

    /// The unit normal in the world by differences, where the surface is smooth; the length of the
    /// gradient as well.
    pub(crate) fn normal(&self, p: DVec3) -> (DVec3, f64) {
        let (_, size) = self.bounding_sphere();
        let h = 1e-6 * size;
        let along = |axis: DVec3| {
            let [ahead, behind] = [p + h * axis, p - h * axis].map(|p| self.side(self.local(p)));
            (ahead - behind) / (2.0 * h)
        };
        let gradient = DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
        (gradient / gradient.length(), gradient.length())
    }

    /// The `t` near that of a hit, which is rounded to f32, at which the sign function is least.
    pub(crate) fn on_surface(&self, ray: &Ray, t: f64) -> f64 {
        let value = |t: f64| self.side(self.local_at(ray, t)).abs();
        let ulp = f64::from((t as f32).next_up()) - t;
        (-512..=512)
            .map(|i| t + ulp * f64::from(i) / 512.0)
            .min_by(|a, b| value(*a).total_cmp(&value(*b)))
            .unwrap_or(t)
    }

    /// Every `t` at which the line of `ray` passes the surface, as far as steps of a thousandth of
    /// the solid show.
    pub(crate) fn march(&self, ray: &Ray) -> Vec<f64> {
        const STEPS: u32 = 2000;
        let (o, d) = (ray.origin, ray.dir.as_dvec3());
        let (middle, radius) = self.bounding_sphere();
        let nearest = (middle - o).dot(d) / d.dot(d);
        let reach = 1.01 * radius / d.length();
        let value = |t: f64| self.side(self.local_at(ray, t));
        let mut found = Vec::new();
        let at = |i: u32| nearest + reach * (2.0 * f64::from(i) / f64::from(STEPS) - 1.0);
        for i in 0..STEPS {
            let (mut low, mut high) = (at(i), at(i + 1));
            let below = value(low) < 0.0;
            if (value(high) < 0.0) == below {
                continue;
            }
            for _ in 0..60 {
                let t = 0.5 * (low + high);
                if (value(t) < 0.0) == below {
                    low = t;
                } else {
                    high = t;
                }
            }
            if self.belongs(self.local_at(ray, low)) > 0.0 {
                found.push(low);
            }
        }
        found
    }
}

/// All kinds of shapes.
pub(crate) fn shapes() -> impl Strategy<Value = Canonical> {
    let radii = || prop_oneof![Just(0.0), Just(1.0), 0.01..3.0_f64];
    prop_oneof![
        Just(Canonical::Sphere),
        Just(Canonical::Disc),
        Just(Canonical::Triangle),
        Just(Canonical::Box),
        any::<bool>().prop_map(|capped| Canonical::Cylinder { capped }),
        (radii(), 0.01..3.0_f64, any::<bool>(), any::<bool>()).prop_map(|(r, s, swap, capped)| {
            let (radius, radius_to) = if swap { (s, r) } else { (r, s) };
            Canonical::Cone { radius, radius_to, capped }
        }),
        (0.02..0.98_f64).prop_map(|tube| Canonical::Torus { tube }),
    ]
}

/// A direction.
pub(crate) fn directions() -> impl Strategy<Value = DVec3> {
    let axes = [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    prop_oneof![
        1 => proptest::sample::select(axes.to_vec()),
        7 => (-1.0..1.0_f64, 0.0..6.3_f64).prop_map(|(z, angle)| {
            let rho = (1.0 - z * z).sqrt();
            DVec3::new(rho * libm::cos(angle), rho * libm::sin(angle), z)
        }),
    ]
}

/// A shape of size 1e-3 to 1e4, stretched, turned, perhaps mirrored, up to 1e4 away.
pub(crate) fn placed() -> impl Strategy<Value = Placed> {
    let stretch = || prop_oneof![Just(1.0), 0.1..1.0_f64, Just(-1.0)];
    let turn = prop_oneof![
        Just(DQuat::IDENTITY),
        (directions(), 0.0..6.3_f64).prop_map(|(axis, angle)| DQuat::from_axis_angle(axis, angle)),
    ];
    let away = prop_oneof![Just(0.0), 0.0..4.0_f64];
    let at = (directions(), away).prop_map(|(v, e)| v * (libm::exp10(e) - 1.0));
    (shapes(), -3.0..4.0_f64, [stretch(), stretch(), stretch()], turn, at).prop_map(
        |(shape, size, stretch, turn, at)| {
            Placed::new(shape, libm::exp10(size) * DVec3::from_array(stretch), turn, at)
        },
    )
}

/// A ray from `distance` sizes away towards (or past) a point in or near the solid.
pub(crate) fn ray_at(placed: &Placed, from: DVec3, to: DVec3, distance: f64) -> Ray {
    let (middle, radius) = placed.bounding_sphere();
    let target = middle + 0.6 * radius * to;
    let origin = (target + distance * radius * from).as_vec3();
    let dir = (target - origin.as_dvec3()).try_normalize().unwrap_or(DVec3::X);
    Ray::new(origin, dir.as_vec3().try_normalize().unwrap_or(Vec3::X))
}
