//! Boxes along the axes that hold geometry, in f64.

use glam::{DAffine3, DVec3, Vec3};
use rayon::prelude::*;

use crate::{Mesh, Points, Scene, Shape};

/// A box along the axes; `min ≤ max` unless empty.
///
/// ```
/// use glam::DVec3;
/// use phong_scene::Bounds;
/// let b = Bounds::EMPTY.with(DVec3::ZERO).with(DVec3::ONE);
/// assert_eq!(b.center(), DVec3::splat(0.5));
/// assert_eq!(b.union(Bounds::EMPTY), b);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates; +∞ if empty.
    pub min: DVec3,
    /// The corner with the largest coordinates; −∞ if empty.
    pub max: DVec3,
}

impl Bounds {
    /// Holds nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// Whether it holds nothing at all; a single point is something.
    pub fn is_empty(self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// The middle; meaningless if empty.
    pub fn center(self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Lengths of the edges; 0 if empty.
    pub fn size(self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.max - self.min }
    }

    /// The smallest box that holds this and a point.
    #[must_use]
    pub fn with(self, p: DVec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The eight corners.
    pub fn corners(self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// The smallest box that holds this box's image under `transform`; empty stays empty.
    #[must_use]
    pub fn transformed(self, transform: &DAffine3) -> Self {
        if self.is_empty() {
            return self;
        }
        self.corners()
            .into_iter()
            .fold(Self::EMPTY, |b, corner| b.with(transform.transform_point3(corner)))
    }
}

impl Mesh {
    /// The smallest box that holds every triangle; positions that no triangle uses do not count.
    pub fn bounds(&self) -> Bounds {
        let (min, max) = self
            .indices
            .par_iter()
            .with_min_len(1 << 12)
            .fold(empty, |b, triangle| {
                triangle.iter().fold(b, |(min, max), &i| {
                    let p = self.positions[i as usize];
                    (min.min(p), max.max(p))
                })
            })
            .reduce(empty, join);
        Bounds { min: self.origin + min.as_dvec3(), max: self.origin + max.as_dvec3() }
    }
}

impl Points {
    /// The smallest box that holds every sphere.
    pub fn bounds(&self) -> Bounds {
        let (min, max) = self
            .spheres
            .par_iter()
            .with_min_len(1 << 12)
            .fold(empty, |(min, max), &[x, y, z, radius]| {
                let center = Vec3::new(x, y, z);
                (min.min(center - radius), max.max(center + radius))
            })
            .reduce(empty, join);
        Bounds { min: self.origin + min.as_dvec3(), max: self.origin + max.as_dvec3() }
    }
}

impl Shape {
    /// A box that holds the shape in its own space, the smallest but for instances, whose boxes
    /// within boxes may be larger; `None` for a plane, which no box holds. `groups` are the
    /// boxes of the scene's groups, in order.
    fn bounds(&self, groups: &[Bounds]) -> Option<Bounds> {
        let around = |center: DVec3, half: DVec3| Bounds { min: center - half, max: center + half };
        // A disc reaches r √(1 − n²) along an axis to which its unit normal has the cosine n.
        let disc = |center: DVec3, normal: DVec3, radius: f64| {
            let n = normal.try_normalize().unwrap_or(DVec3::ZERO);
            let reach = (DVec3::ONE - n * n).max(DVec3::ZERO);
            around(center, radius * DVec3::new(reach.x.sqrt(), reach.y.sqrt(), reach.z.sqrt()))
        };
        Some(match *self {
            Self::Plane { .. } => return None,
            Self::Sphere { center, radius } => around(center, DVec3::splat(radius)),
            Self::Triangle { points, .. } => points.into_iter().fold(Bounds::EMPTY, Bounds::with),
            Self::Disc { center, normal, radius } => disc(center, normal, radius),
            Self::Box { min, max } => Bounds { min, max },
            Self::Cylinder { from, to, radius, .. } => {
                disc(from, to - from, radius).union(disc(to, to - from, radius))
            }
            Self::Cone { from, to, radius, radius_to, .. } => {
                disc(from, to - from, radius).union(disc(to, to - from, radius_to))
            }
            Self::Torus { center, axis, radius, tube } => {
                let ring = disc(center, axis, radius);
                Bounds { min: ring.min - tube, max: ring.max + tube }
            }
            Self::Mesh(ref mesh) => mesh.bounds(),
            Self::Points(ref points) => points.bounds(),
            Self::Instance(group) => groups.get(group.0 as usize).copied().unwrap_or(Bounds::EMPTY),
        })
    }
}

impl Scene {
    /// A box that holds every object but the planes, which have no end; empty if there is none.
    ///
    /// It is the smallest where no object is turned or nested; a turned one counts with the box
    /// of its box.
    pub fn bounds(&self) -> Bounds {
        let mut groups = Vec::with_capacity(self.groups.len());
        let all = |objects: &[crate::Object], groups: &[Bounds]| {
            objects
                .iter()
                .filter_map(|o| Some(o.shape.bounds(groups)?.transformed(&o.transform)))
                .fold(Bounds::EMPTY, Bounds::union)
        };
        for group in &self.groups {
            // A group holds instances of earlier groups only.
            let bounds = all(&group.objects, &groups);
            groups.push(bounds);
        }
        all(&self.objects, &groups)
    }
}

fn empty() -> (Vec3, Vec3) {
    (Vec3::INFINITY, Vec3::NEG_INFINITY)
}

fn join(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> (Vec3, Vec3) {
    (a.0.min(b.0), a.1.max(b.1))
}
