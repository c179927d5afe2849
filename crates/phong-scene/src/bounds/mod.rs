//! Boxes along the axes that hold geometry, in f64.

#![expect(clippy::needless_bitwise_bool, reason = "a branch for each number would cost more")]

mod reach;

use glam::{DAffine3, DVec3, Vec3};
use rayon::prelude::*;

use crate::mesh::{Mesh, PIECE, Points};
use crate::scene::{Group, Object, Scene};
use crate::shape::Shape;

/// Along the axes, and against them.
const AXES: [DVec3; 6] = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];

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
}

/// How far around its likely place an index is looked for, before it is everywhere.
const NEAR: usize = 1 << 14;

impl Mesh {
    /// The smallest box that holds every triangle; positions that no triangle uses do not count.
    pub fn bounds(&self) -> Bounds {
        let (min, max) = self.extremes();
        Bounds { min: self.origin + min.as_dvec3(), max: self.origin + max.as_dvec3() }
    }

    /// The same relative to the origin.
    fn extremes(&self) -> (Vec3, Vec3) {
        let boxes: Vec<(Vec3, Vec3)> = self
            .positions
            .par_chunks(PIECE)
            .map(|piece| piece.iter().fold(empty(), |b, p| (b.0.min(*p), b.1.max(*p))))
            .collect();
        let all = boxes.iter().copied().fold(empty(), join);
        // Most meshes use all their positions. Then it is the box of these, as it is if only those on its
        // sides are used, and the corners need not be looked up one by one.
        if self.reaches_sides(all, &boxes) { all } else { self.extremes_of_corners() }
    }

    /// Whether a triangle has a corner on each side of a box around all positions, which is that of the
    /// boxes around pieces.
    fn reaches_sides(&self, all: (Vec3, Vec3), boxes: &[(Vec3, Vec3)]) -> bool {
        let on_side = |side: usize| {
            let of = |(min, max): &(Vec3, Vec3)| if side < 3 { min[side] } else { max[side - 3] };
            let start = boxes.iter().position(|piece| of(piece) == of(&all))? * PIECE;
            let mut rest = self.positions.get(start..)?.iter();
            let number = rest.position(|p| p[side % 3] == of(&all))?;
            u32::try_from(start + number).ok()
        };
        let corners = self.indices.as_flattened();
        let is_used = |number: u32| {
            // Positions mostly lie in the order of their use.
            let about = number as usize * corners.len() / self.positions.len();
            is_among(number, corners, about)
        };
        (0..6).all(|side| on_side(side).is_some_and(is_used))
    }

    /// The box of all corners.
    fn extremes_of_corners(&self) -> (Vec3, Vec3) {
        self.indices
            .par_iter()
            .with_min_len(PIECE)
            .fold(empty, |b, triangle| {
                let corners = triangle.iter().filter_map(|&i| self.positions.get(i as usize));
                corners.fold(b, |(min, max), p| (min.min(*p), max.max(*p)))
            })
            .reduce(empty, join)
    }
}

/// Whether `number` is one of `all`, perhaps about the middle of so many.
fn is_among(number: u32, all: &[u32], about: usize) -> bool {
    // Pieces without a branch for each.
    let is_in = |piece: &[u32]| piece.iter().fold(false, |any, &n| any | (n == number));
    let near = about.saturating_sub(NEAR)..(about + NEAR).min(all.len());
    all.get(near).is_some_and(|near| near.chunks(PIECE).any(is_in))
        || all.par_chunks(PIECE).any(is_in)
}

impl Points {
    /// The smallest box that holds every sphere.
    pub fn bounds(&self) -> Bounds {
        let (min, max) = self
            .spheres
            .par_iter()
            .with_min_len(PIECE)
            .fold(empty, |(min, max), &[x, y, z, radius]| {
                let center = Vec3::new(x, y, z);
                (min.min(center - radius), max.max(center + radius))
            })
            .reduce(empty, join);
        Bounds { min: self.origin + min.as_dvec3(), max: self.origin + max.as_dvec3() }
    }
}

impl Shape {
    /// The smallest box that holds it where it is placed. Empty for a plane, which has no end, and
    /// for an instance, whose group is the scene's.
    pub fn bounds(&self, to_world: DAffine3) -> Bounds {
        let across = to_world.matrix3.transpose();
        let reach = self.reach(AXES.map(|axis| across * axis), &[]);
        reach.map_or(Bounds::EMPTY, |[a, b, c, d, e, f]| Bounds {
            min: to_world.translation - DVec3::new(d, e, f),
            max: to_world.translation + DVec3::new(a, b, c),
        })
    }
}

impl Scene {
    /// The smallest box that holds every object but the planes, which have no end; empty if there
    /// is none. Of an instance it holds the box around its group's.
    pub fn bounds(&self) -> Bounds {
        bounds_with(&self.objects, &self.groups)
    }
}

impl Object {
    /// The smallest box that holds it, of its instance the box around its group's; empty if it has
    /// no end. `groups` are the boxes of the groups.
    pub(crate) fn bounds(&self, groups: &[Bounds]) -> Bounds {
        match &self.shape {
            // Without arithmetic in between, and in one pass.
            Shape::Mesh(mesh) if self.transform == DAffine3::IDENTITY => return mesh.bounds(),
            Shape::Points(p) if self.transform == DAffine3::IDENTITY => return p.bounds(),
            _ => {}
        }
        self.reach(AXES, groups).map_or(Bounds::EMPTY, |[a, b, c, d, e, f]| Bounds {
            min: -DVec3::new(d, e, f),
            max: DVec3::new(a, b, c),
        })
    }
}

/// The smallest box that holds every object, with these groups; [`Scene::bounds`] of what is no scene yet.
pub(crate) fn bounds_with(objects: &[Object], groups: &[Group]) -> Bounds {
    bounds_of(objects, &bounds_of_groups(groups))
}

/// The box of every group.
fn bounds_of_groups(groups: &[Group]) -> Vec<Bounds> {
    let mut bounds = Vec::with_capacity(groups.len());
    for group in groups {
        // A group holds instances of earlier groups only.
        let next = bounds_of(&group.objects, &bounds);
        bounds.push(next);
    }
    bounds
}

fn bounds_of(objects: &[Object], groups: &[Bounds]) -> Bounds {
    objects.iter().map(|object| object.bounds(groups)).fold(Bounds::EMPTY, Bounds::union)
}

fn empty() -> (Vec3, Vec3) {
    (Vec3::INFINITY, Vec3::NEG_INFINITY)
}

fn join(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> (Vec3, Vec3) {
    (a.0.min(b.0), a.1.max(b.1))
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    use crate::shape::GroupId;

    fn object(shape: Shape, transform: DAffine3) -> Object {
        Object { shape, transform, ..Object::default() }
    }

    fn scene(objects: Vec<Object>) -> Scene {
        Scene { objects, ..Scene::default() }
    }

    fn close(a: Bounds, min: [f64; 3], max: [f64; 3]) {
        let (min, max) = (DVec3::from(min), DVec3::from(max));
        let error = (a.min - min).abs().max((a.max - max).abs()).max_element();
        assert!(error < 1e-12, "{a:?} is not {min} to {max}");
    }

    #[test]
    fn round_shapes_reach_exactly_as_far_as_their_rims() {
        let (half, center) = (0.5_f64.sqrt(), DVec3::new(1.0, 2.0, 3.0));
        let tilted = DVec3::new(3.0, 3.0, 0.0);
        let bounds = |shape| bounds_of(&[object(shape, DAffine3::IDENTITY)], &[]);
        close(
            bounds(Shape::Disc { center, normal: tilted, radius: 2.0 }),
            [1.0 - 2.0 * half, 2.0 - 2.0 * half, 1.0],
            [1.0 + 2.0 * half, 2.0 + 2.0 * half, 5.0],
        );
        let (from, to) = (DVec3::ZERO, DVec3::Y * 4.0);
        close(
            bounds(Shape::Cylinder { from, to, radius: 1.0, capped: false }),
            [-1.0, 0.0, -1.0],
            [1.0, 4.0, 1.0],
        );
        close(
            bounds(Shape::Cone { from, to, radius: 0.5, radius_to: 2.0, capped: true }),
            [-2.0, 0.0, -2.0],
            [2.0, 4.0, 2.0],
        );
        close(
            bounds(Shape::Torus { center, axis: DVec3::Z, radius: 2.0, tube: 0.5 }),
            [-1.5, -0.5, 2.5],
            [3.5, 4.5, 3.5],
        );
    }

    #[test]
    fn a_torus_on_the_slant_reaches_as_far_as_points_on_it_do() {
        let (axis, radius, tube) = (DVec3::new(1.0, 2.0, 3.0), 2.0, 0.5);
        let turn = DQuat::from_rotation_arc(DVec3::Z, axis.normalize_or(DVec3::Z));
        let mut reached = Bounds::EMPTY;
        for i in 0..400 {
            let u = f64::from(i) * std::f64::consts::TAU / 400.0;
            for j in 0..400 {
                let v = f64::from(j) * std::f64::consts::TAU / 400.0;
                let r = radius + tube * libm::cos(v);
                let p = DVec3::new(r * libm::cos(u), r * libm::sin(u), tube * libm::sin(v));
                reached = reached.with(turn * p);
            }
        }
        let torus = Shape::Torus { center: DVec3::ZERO, axis, radius, tube };
        let bounds = bounds_of(&[object(torus, DAffine3::IDENTITY)], &[]);
        assert!((bounds.max - reached.max).min_element() >= 0.0, "{bounds:?} {reached:?}");
        assert!((bounds.max - reached.max).max_element() < 1e-3, "{bounds:?} {reached:?}");
    }

    #[test]
    fn a_scene_holds_all_objects_where_they_are_placed_but_planes() {
        let ball = Shape::Sphere { center: DVec3::X, radius: 1.0 };
        let plane = Shape::Plane { point: DVec3::splat(99.0), normal: DVec3::Y };
        let up = DAffine3::from_translation(DVec3::Y * 10.0);
        let mut all = scene(vec![
            object(plane, DAffine3::IDENTITY),
            object(Shape::Instance(GroupId(1)), up),
            object(ball.clone(), DAffine3::from_scale(DVec3::splat(2.0))),
        ]);
        let inner = object(Shape::Instance(GroupId(0)), up);
        let group = |objects| Group { name: String::new(), objects };
        all.groups = vec![group(vec![object(ball, DAffine3::IDENTITY)]), group(vec![inner])];
        close(all.bounds(), [0.0, -2.0, -2.0], [4.0, 21.0, 2.0]);
        assert!(scene(Vec::new()).bounds().is_empty());
    }

    #[test]
    fn what_is_turned_and_stretched_has_the_smallest_box_too() {
        let turn = DAffine3::from_quat(DQuat::from_rotation_arc(DVec3::X, DVec3::Z));
        let stretch = DAffine3::from_scale(DVec3::new(3.0, 1.0, 1.0));
        let ball = Shape::Sphere { center: DVec3::X, radius: 1.0 };
        let bounds = |shape, transform| bounds_of(&[object(shape, transform)], &[]);
        close(bounds(ball, turn * stretch), [-1.0, -1.0, 0.0], [1.0, 1.0, 6.0]);
        // The corners of a turned square's box are not the square's.
        let eighth = DAffine3::from_quat(DQuat::from_rotation_arc(
            DVec3::X,
            DVec3::new(1.0, 1.0, 0.0).normalize_or(DVec3::X),
        ));
        let positions = [Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y, Vec3::splat(9.0)].into();
        let indices = [[0, 1, 2], [0, 2, 3]].into();
        let square = Shape::Mesh(Box::new(Mesh { positions, indices, ..Mesh::default() }));
        let half = 0.5_f64.sqrt();
        close(bounds(square, eighth), [-half, -half, 0.0], [half, half, 0.0]);
    }

    #[test]
    fn the_origin_of_bulk_data_is_added_in_f64() {
        let origin = DVec3::new(1e9, 0.0, 0.0);
        let points =
            Points { origin, spheres: [[0.25, 0.0, 0.0, 0.125]].into(), ..Points::default() };
        close(points.bounds(), [1e9 + 0.125, -0.125, -0.125], [1e9 + 0.375, 0.125, 0.125]);
        let stray = Vec3::splat(1e6);
        let mesh = Mesh {
            origin,
            positions: [Vec3::ZERO, stray, Vec3::X, Vec3::Y].into(),
            indices: [[0, 2, 3]].into(),
            ..Mesh::default()
        };
        close(mesh.bounds(), [1e9, 0.0, 0.0], [1e9 + 1.0, 1.0, 0.0]);
    }
}
