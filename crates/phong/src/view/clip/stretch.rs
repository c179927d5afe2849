//! What a clip takes of a ray.

use glam::DVec3;
use phong_bvh::Ray;
use phong_scene::{ClipKind, Keep};

/// What a clip cuts along.
#[derive(Clone, Copy, Debug)]
pub(super) enum Along {
    /// Cuts away all on the side that `normal`, a unit vector, points to.
    Plane { point: DVec3, normal: DVec3 },
    /// Cuts away what is inside, or all that is outside.
    Box { min: DVec3, max: DVec3, keeps_inside: bool },
}

/// A stretch of a ray, or all but it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// Where it begins and ends; the same: nothing is in it.
    from: f32,
    to: f32,
    /// The faces of the clip there.
    faces: [u8; 2],
    /// Whether it is what is left, and all else is taken.
    is_left: bool,
}

impl Stretch {
    /// Takes nothing.
    pub(super) const NONE: Self =
        Self { from: f32::INFINITY, to: f32::INFINITY, faces: [0; 2], is_left: false };

    /// Whether it takes what is at this distance.
    pub(super) fn takes(&self, t: f32) -> bool {
        if self.is_left {
            t < self.from || t > self.to || self.from == self.to
        } else {
            self.from < t && t < self.to
        }
    }

    /// Whether it takes anything between two distances.
    pub(super) fn touches(&self, t_min: f32, t_max: f32) -> bool {
        if self.is_left {
            self.from > t_min || self.to < t_max || self.from == self.to
        } else {
            self.from < self.to && self.from < t_max && self.to > t_min
        }
    }

    /// Where what it takes at this distance ends.
    pub(super) fn end_after(&self, t: f32) -> f32 {
        if !self.is_left {
            self.to
        } else if t < self.from && self.from < self.to {
            self.from
        } else {
            f32::INFINITY
        }
    }

    /// Where a ray comes out of what it takes, and the number of the face there; `None`: it does not.
    pub(super) fn comes_out(&self) -> Option<(f32, usize)> {
        let (t, face) = if self.is_left { (self.from, 0) } else { (self.to, 1) };
        (self.from < self.to && t.is_finite()).then(|| (t, usize::from(self.faces[face])))
    }
}

impl Along {
    pub(super) fn of(kind: &ClipKind) -> Self {
        match *kind {
            ClipKind::Plane { point, normal } => {
                Self::Plane { point, normal: normal.normalize_or(DVec3::Z) }
            }
            ClipKind::Box { min, max, keep } => {
                Self::Box { min, max, keeps_inside: keep == Keep::Inside }
            }
        }
    }

    /// What it takes of a ray.
    pub(super) fn stretch(&self, ray: &Ray) -> Stretch {
        let (origin, dir) = (ray.origin, ray.dir.as_dvec3());
        match *self {
            Self::Plane { point, normal } => {
                let (away, along) = ((point - origin).dot(normal), dir.dot(normal));
                let at = (away / along) as f32;
                let (from, to) = match along {
                    _ if along > 0.0 => (at, f32::INFINITY),
                    _ if along < 0.0 => (f32::NEG_INFINITY, at),
                    _ if away < 0.0 => (f32::NEG_INFINITY, f32::INFINITY),
                    _ => return Stretch::NONE,
                };
                Stretch { from, to, faces: [0; 2], is_left: false }
            }
            Self::Box { min, max, keeps_inside } => {
                let nowhere = Stretch { is_left: keeps_inside, ..Stretch::NONE };
                let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
                let mut faces = [0; 2];
                for axis in 0..3 {
                    let (o, d) = (origin[axis], dir[axis]);
                    if d == 0.0 {
                        if o <= min[axis] || o >= max[axis] {
                            return nowhere;
                        }
                        continue;
                    }
                    let (low, high) = ((min[axis] - o) / d, (max[axis] - o) / d);
                    let lower = 2 * axis as u8;
                    let (near, far, sides) =
                        if d > 0.0 { (low, high, [0, 1]) } else { (high, low, [1, 0]) };
                    if near > from {
                        (from, faces[0]) = (near, lower + sides[0]);
                    }
                    if far < to {
                        (to, faces[1]) = (far, lower + sides[1]);
                    }
                }
                let (from, to) = (from as f32, to as f32);
                if from >= to {
                    return nowhere;
                }
                Stretch { from, to, faces, is_left: keeps_inside }
            }
        }
    }

    /// The unit normal of a face, to the side that is cut away.
    pub(super) fn normal(&self, face: usize) -> DVec3 {
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Box { keeps_inside, .. } => {
                let mut normal = DVec3::ZERO;
                let outwards = if face % 2 == 1 { 1.0 } else { -1.0 };
                normal[face / 2] = if keeps_inside { outwards } else { -outwards };
                normal
            }
        }
    }

    /// The point of a face next to a point near it.
    pub(super) fn onto(&self, face: usize, mut p: DVec3) -> DVec3 {
        match *self {
            Self::Plane { point, normal } => p - (p - point).dot(normal) * normal,
            Self::Box { min, max, .. } => {
                p[face / 2] = if face % 2 == 1 { max[face / 2] } else { min[face / 2] };
                p
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn a_plane_takes_a_ray_up_to_where_it_comes_out_of_it() {
        let along =
            Along::of(&ClipKind::Plane { point: DVec3::ZERO, normal: DVec3::new(0.0, 0.0, 2.0) });
        let into = along.stretch(&Ray::new(DVec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z));
        assert!(into.takes(4.9) && !into.takes(5.1));
        assert_eq!(into.comes_out(), Some((5.0, 0)));
        let out = along.stretch(&Ray::new(DVec3::new(0.0, 0.0, -5.0), Vec3::Z));
        assert!(!out.takes(4.9) && out.takes(5.1) && out.comes_out().is_none());
        let beside = |z| along.stretch(&Ray::new(DVec3::new(0.0, 0.0, z), Vec3::X));
        assert!(beside(1.0).takes(3.0) && !beside(-1.0).takes(3.0) && !beside(0.0).takes(3.0));
    }

    #[test]
    fn a_box_takes_what_is_in_it_or_all_else() {
        let of = |keep| {
            let kind = ClipKind::Box { min: DVec3::NEG_ONE, max: DVec3::ONE, keep };
            Along::of(&kind)
        };
        let ray = |y| Ray::new(DVec3::new(0.0, y, 5.0), Vec3::NEG_Z);
        let notch = of(Keep::Outside).stretch(&ray(0.0));
        assert!(!notch.takes(3.9) && notch.takes(5.0) && !notch.takes(6.1));
        // The lower face along z, whose normal is to the inside: what is cut away.
        assert_eq!(notch.comes_out(), Some((6.0, 4)));
        assert_eq!(of(Keep::Outside).normal(4), DVec3::Z);
        let block = of(Keep::Inside).stretch(&ray(0.0));
        assert!(block.takes(3.9) && !block.takes(5.0) && block.takes(6.1));
        assert_eq!((block.comes_out(), block.end_after(1.0)), (Some((4.0, 5)), 4.0));
        assert_eq!((of(Keep::Inside).normal(5), block.end_after(7.0)), (DVec3::Z, f32::INFINITY));
        // A ray that misses the box, and one along its side.
        for y in [2.0, 1.0] {
            assert!(of(Keep::Inside).stretch(&ray(y)).takes(5.0));
            assert!(!of(Keep::Outside).stretch(&ray(y)).takes(5.0));
        }
    }
}
