//! How far rays that start far from everything may be moved along before they meet anything.
//!
//! Distances and directions of rays are f32. Seen from a million times their size away, things a hair apart are
//! as far as each other, and neighbouring rays are the same ray. Rays that start near the things again
//! have neither trouble, so a camera far away starts its rays there.

use glam::DVec3;

use super::{Instance, World, loose::Loose};

/// What is left of the way for rounding, relative.
const SHORT: f64 = 1e-9;

/// The box around all that has bounds, in the world; none: nothing has.
pub(super) fn bounds(loose: &Loose, instances: &[Instance]) -> Option<[DVec3; 2]> {
    let of_tree = loose.tree().bounds().map(|bounds| loose.frame().bounds(bounds, DVec3::ZERO));
    let of_instance = |instance: &Instance| {
        instance.tree.bounds().map(|bounds| instance.frame.bounds(bounds, DVec3::ZERO))
    };
    let all = of_tree.into_iter().chain(instances.iter().filter_map(of_instance));
    all.reduce(|[low, high], [other_low, other_high]| [low.min(other_low), high.max(other_high)])
}

impl World {
    /// The box around everything but planes, in the world; none: there is nothing else.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        self.bounds
    }

    /// A distance along the ray from `origin` towards `dir`, which is unit, before which it meets nothing:
    /// just before the box around everything and before every plane. 0 within the box, and where it meets
    /// nothing at all.
    ///
    /// ```
    /// use glam::{DVec3, Vec3};
    /// use phong_bvh::{BuildOptions, Primitives, Sphere, World};
    ///
    /// let ball = Primitives::spheres(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]);
    /// let world = World::of(vec![ball], BuildOptions::default())?;
    /// let ahead = world.approach(DVec3::new(1e7, 0.0, 0.0), DVec3::NEG_X);
    /// assert!(1e7 - 100.0 < ahead && ahead < 1e7 - 1.0);
    /// assert_eq!(world.approach(DVec3::ZERO, DVec3::X), 0.0);
    /// # Ok::<(), phong_bvh::BuildError>(())
    /// ```
    pub fn approach(&self, origin: DVec3, dir: DVec3) -> f64 {
        let to_box = self.bounds.map_or(f64::INFINITY, |bounds| enter(bounds, origin, dir));
        let to_planes = self.loose.planes().iter().map(|(plane, _)| {
            let point = plane.point + self.loose.frame().origin();
            let t = (point - origin).dot(plane.normal) / dir.dot(plane.normal);
            if t >= 0.0 { t } else { f64::INFINITY }
        });
        let nearest = to_planes.fold(to_box, f64::min);
        if nearest.is_finite() { nearest * (1.0 - SHORT) } else { 0.0 }
    }
}

/// How far it is to a box: 0 within it, +∞ if it is never met.
fn enter([low, high]: [DVec3; 2], origin: DVec3, dir: DVec3) -> f64 {
    let (mut near, mut far) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let (a, b) =
            ((low[axis] - origin[axis]) / dir[axis], (high[axis] - origin[axis]) / dir[axis]);
        // 0 / 0 is NaN, which neither `max` nor `min` takes: the ray lies in that side of the box.
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    if near <= far { near } else { f64::INFINITY }
}
