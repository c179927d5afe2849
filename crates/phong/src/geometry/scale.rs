//! Which objects are far larger than the others, or far away from them: f32 about a common middle is then too
//! coarse, for the large ones or for those that stand on them.

use glam::{DVec3, Vec3};
use phong_scene::{Bounds, Shape};

use super::flatten::Placed;
use crate::math::wide;

/// How many times the usual size an object has, or its own size it is away, that f32 is too coarse for: a
/// rounding is then 1/4096 of the others, or of its own.
const MUCH: f64 = 4096.0;
/// The most objects that get a place of their own because they are far away.
const MOST_ASTRAY: usize = 64;
/// Points of a mesh or a cloud that its size is guessed from.
const SAMPLE: usize = 256;
/// Triangles of the largest mesh that can be met one by one in f64.
pub(super) const FEW_TRIANGLES: usize = 64;

/// The middle and the usual size of what is written one by one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    /// What is taken off the coordinates of all of it.
    pub(super) center: DVec3,
    /// The size that a quarter of all objects do not reach.
    usual: f64,
    /// Whether objects that are far away from the centre get a place of their own.
    has_room: bool,
}

impl Scale {
    /// Of all objects of a scene.
    ///
    /// The centre is the middle of the box around those that are not far larger than the others, or, where that
    /// box is far larger than they are, their median; rounded to a power of two about as large as they reach,
    /// so that scenes written around the origin stay as they were written, and the rest lose no digits.
    pub(super) fn of(placed: &[Placed<'_>]) -> Self {
        let extents: Vec<(Bounds, bool)> = placed.iter().map(extent).collect();
        let sizes = extents.iter().map(|(bounds, _)| bounds.size().max_element());
        let mut sizes: Vec<f64> = sizes.filter(|&size| size > 0.0 && size.is_finite()).collect();
        let quarter = sizes.len() / 4;
        let usual = if sizes.is_empty() {
            f64::INFINITY
        } else {
            *sizes.select_nth_unstable_by(quarter, f64::total_cmp).1
        };
        let mut scale = Self { center: DVec3::ZERO, usual, has_room: true };
        let loose = extents.iter().filter(|(bounds, is_loose)| {
            *is_loose && !bounds.is_empty() && !scale.is_large(*bounds)
        });
        let loose: Vec<Bounds> = loose.map(|(bounds, _)| *bounds).collect();
        scale.center = middle(&loose, usual);
        scale.has_room = loose.iter().filter(|b| scale.is_astray(**b)).count() <= MOST_ASTRAY;
        scale
    }

    /// Whether an object is so much larger than the others that it is to be met in f64.
    pub(super) fn is_large(&self, bounds: Bounds) -> bool {
        bounds.size().max_element() > MUCH * self.usual
    }

    /// Whether an object that is not large is so far from the centre that it is to have its own.
    pub(super) fn is_astray(&self, bounds: Bounds) -> bool {
        let away = (bounds.center() - self.center).abs().max_element();
        self.has_room && away > MUCH * bounds.size().max_element().max(f64::MIN_POSITIVE)
    }
}

/// About where an object reaches, and whether it is one of those written one by one. Empty for a plane.
fn extent(placed: &Placed<'_>) -> (Bounds, bool) {
    let to_world = placed.to_world;
    let sample = |origin: DVec3, count: usize, at: &dyn Fn(usize) -> Vec3| {
        let numbers = (0..count).step_by(count.div_ceil(SAMPLE).max(1));
        let points = numbers.map(|i| to_world.transform_point3(origin + at(i).as_dvec3()));
        (points.fold(Bounds::EMPTY, |b, p| b.union(Bounds { min: p, max: p })), false)
    };
    match &placed.object.shape {
        Shape::Mesh(mesh) => {
            let corner = |i: usize| mesh.positions[mesh.indices[i / 3][i % 3] as usize];
            sample(mesh.origin, 3 * mesh.indices.len(), &corner)
        }
        Shape::Points(points) => {
            let center = |i: usize| Vec3::from_slice(&points.spheres[i]);
            sample(points.origin, points.spheres.len(), &center)
        }
        Shape::Cylinders(cylinders) => {
            let end = |i: usize| Vec3::from_slice(&cylinders.segments[i][0]);
            sample(cylinders.origin, cylinders.segments.len(), &end)
        }
        shape => (shape.bounds(to_world), true),
    }
}

/// The middle of some boxes, of things of a usual size.
fn middle(boxes: &[Bounds], usual: f64) -> DVec3 {
    let around = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
    if around.is_empty() {
        return DVec3::ZERO;
    }
    let size = around.size().max_element();
    if size == 0.0 {
        return around.center();
    }
    if size <= MUCH * usual {
        let step = wide::power_of_two_above(size);
        return (around.center() / step).round() * step;
    }
    let median = |axis: usize| {
        let mut all: Vec<f64> = boxes.iter().map(|b| b.center()[axis]).collect();
        let half = all.len() / 2;
        *all.select_nth_unstable_by(half, f64::total_cmp).1
    };
    let step = wide::power_of_two_above(usual);
    (DVec3::new(median(0), median(1), median(2)) / step).round() * step
}
