//! A mesh that shines: points of its triangles chosen by solid angle.
//!
//! From a point each triangle is seen under a solid angle, from whichever side. One is chosen by these, and within
//! it a direction evenly: the mean over all places is that of a point light over the solid angles of the
//! triangles. Of a closed body without hollows that is the mean over the solid angle of the body, since every
//! direction to it meets two of its triangles.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use phong_bvh::{Lanes, lanes::cross};
use phong_scene::Light;

use super::angle::{half_turn, on_circle};
use super::area::clamp;
use crate::math::lanes::{add, dot, scale, select3, splat3, sub};

/// A triangle seen at a smaller slope than this is seen from its own plane, where it gives nothing: so does the
/// surface itself to its own points.
const GRAZING: f32 = 1e-5;

/// A triangle of a smaller solid angle is filled as a flat one: rounding would show.
const FLAT: f32 = 1e-3;

/// The triangles of a mesh that shines.
#[derive(Clone, Debug, Default)]
pub(super) struct LuminousMesh {
    triangles: Arc<[Triangle]>,
    /// The middle of its surface.
    pub(super) middle: DVec3,
}

/// A triangle, about the middle of its mesh.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [Vec3; 3],
    /// At right angles to it, and as long as twice its area.
    normal: Vec3,
    /// [`GRAZING`] by that length.
    grazing: f32,
}

impl Triangle {
    fn new(corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        Self { corners, normal, grazing: GRAZING * normal.length() }
    }

    /// The solid angle that it is seen under from where `toward` leads to the middle of its mesh, by van Oosterom and
    /// Strackee, *The Solid Angle of a Plane Triangle*, 1983; 0 from its own plane.
    #[inline(always)]
    fn solid_angle<F: Lanes<Scalar = f32>>(&self, toward: [F; 3]) -> F {
        let [a, b, c] = self.corners;
        let (a, b, c) = (to_corner(toward, a), to_corner(toward, b), to_corner(toward, c));
        let volume = dot(a, splat3(a[0], self.normal.to_array())).abs();
        let (la, lb, lc) = (dot(a, a).sqrt(), dot(b, b).sqrt(), dot(c, c).sqrt());
        let grazing = la.max(lb).max(lc) * self.grazing;
        let rest = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        F::select(volume.gt(grazing), half_turn([rest, volume]) * 2.0, volume.splat(0.0))
    }
}

impl LuminousMesh {
    pub(super) fn new(triangles: &[[DVec3; 3]]) -> Self {
        let area = |[a, b, c]: &[DVec3; 3]| (*b - *a).cross(*c - *a).length();
        let whole: f64 = triangles.iter().map(area).sum();
        let middle = |triangle: &[DVec3; 3]| {
            let [a, b, c] = triangle;
            (*a + *b + *c) / 3.0 * (area(triangle) / whole)
        };
        let sum = triangles.iter().map(middle).sum::<DVec3>();
        let middle = if sum.is_finite() { sum } else { DVec3::ZERO };
        let about = |triangle: &[DVec3; 3]| {
            Triangle::new(triangle.map(|corner| (corner - middle).as_vec3()))
        };
        Self { triangles: triangles.iter().map(about).collect(), middle }
    }

    /// How far from a point its farthest corner is.
    pub(super) fn reach_about(&self, center: DVec3) -> f64 {
        let corners = self.triangles.iter().flat_map(|triangle| triangle.corners);
        let distance = |corner: Vec3| (self.middle + corner.as_dvec3()).distance(center);
        corners.map(distance).fold(0.0, f64::max)
    }

    /// The way to a point of it from where `toward` leads to its middle, by a `place` of the unit square; by the middle
    /// of that, to its own. It is 0 where nothing of it is seen.
    #[inline(always)]
    pub(super) fn choose<F: Lanes<Scalar = f32>>(&self, toward: [F; 3], place: [F; 2]) -> [F; 3] {
        let (zero, one) = (place[0].splat(0.0), place[0].splat(1.0));
        let mut angles = [zero; Light::MOST_TRIANGLES];
        let mut whole = zero;
        for (angle, triangle) in angles.iter_mut().zip(&*self.triangles) {
            *angle = triangle.solid_angle(toward);
            whole = whole + *angle;
        }
        // Of those that are seen, the last that begins before the place.
        let target = place[0] * whole;
        let mut chosen = [[zero; 3]; 3];
        let (mut before, mut begin, mut angle) = (zero, zero, zero);
        for (triangle, &own) in self.triangles.iter().zip(&angles) {
            let is_next = own.gt(zero) & !target.lt(before);
            let [a, b, c] = triangle.corners;
            chosen[0] = select3(is_next, splat3(zero, a.to_array()), chosen[0]);
            chosen[1] = select3(is_next, splat3(zero, b.to_array()), chosen[1]);
            chosen[2] = select3(is_next, splat3(zero, c.to_array()), chosen[2]);
            begin = F::select(is_next, before, begin);
            angle = F::select(is_next, own, angle);
            before = before + own;
        }
        let is_seen = angle.gt(zero);
        let part = (target - begin) / F::select(is_seen, angle, one);
        let part = F::select(part.gt(one), one, part);
        let [a, b, c] = chosen;
        let ways = [add(toward, a), add(toward, b), add(toward, c)];
        let way = within(ways, [part, place[1]], angle);
        let (half, none) = (place[0].splat(0.5), [zero; 3]);
        let is_middle = place[0].eq(half) & place[1].eq(half);
        let way = select3(is_middle, toward, way);
        select3(is_seen, way, none)
    }
}

#[inline(always)]
fn to_corner<F: Lanes<Scalar = f32>>(toward: [F; 3], corner: Vec3) -> [F; 3] {
    add(toward, splat3(toward[0], corner.to_array()))
}

/// The way to a point of a triangle that fills its solid angle evenly: after Arvo, *Stratified Sampling of
/// Spherical Triangles*, 1995.
#[inline(always)]
fn within<F: Lanes<Scalar = f32>>([a, b, c]: [[F; 3]; 3], [u, v]: [F; 2], angle: F) -> [F; 3] {
    let (zero, one) = (u.splat(0.0), u.splat(1.0));
    let root = u.sqrt();
    let flat = add(scale(one - root, a), add(scale(root * (one - v), b), scale(root * v, c)));
    let is_flat = angle.lt(one * FLAT);
    if F::all(is_flat) {
        return flat;
    }
    let (x, y, z) = (unit(a), unit(b), unit(c));
    let (across, along) = (cross(x, y), cross(x, z));
    let share = one / (dot(across, across) * dot(along, along)).sqrt();
    // The angle at the first corner, by its cosine and sine.
    let (cos, sin) = (dot(across, along) * share, dot(x, cross(y, z)).abs() * share);
    let [area_cos, area_sin] = on_circle(u * angle);
    let (s, t) = (area_sin * cos - area_cos * sin, area_cos * cos + area_sin * sin);
    let (p, q) = (t - cos, s + sin * dot(x, y));
    let corner = edge(x, z, ((q * t - p * s) * cos - q) / ((q * s + p * t) * sin));
    let way = edge(y, corner, one - v * (one - dot(corner, y)));
    let normal = cross(sub(b, a), sub(c, a));
    let t = dot(a, normal) / dot(way, normal);
    let is_met = t.gt(zero) & t.lt(zero.splat(f32::INFINITY)) & !is_flat;
    select3(is_met, scale(t, way), flat)
}

/// The direction at an angle, given by its cosine, from one direction towards another.
#[inline(always)]
fn edge<F: Lanes<Scalar = f32>>(from: [F; 3], to: [F; 3], cosine: F) -> [F; 3] {
    let one = cosine.splat(1.0);
    let cosine = clamp(cosine, -one, one);
    let aside = unit(sub(to, scale(dot(to, from), from)));
    add(scale(cosine, from), scale((one - cosine * cosine).at_least(0.0).sqrt(), aside))
}

/// The direction of `v`; NaN where there is none.
#[inline(always)]
fn unit<F: Lanes<Scalar = f32>>(v: [F; 3]) -> [F; 3] {
    scale(v[0].splat(1.0) / dot(v, v).sqrt(), v)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> impl Iterator<Item = [f64; 2]> {
        let at = move |i: usize| (i as f64 + 0.5) / n as f64;
        (0..n * n).map(move |i| [at(i % n), at(i / n)])
    }

    /// The ways from a point to corners.
    fn ways(triangle: [DVec3; 3], p: DVec3) -> [[f32; 3]; 3] {
        triangle.map(|corner| (corner - p).as_vec3().to_array())
    }

    fn solid_angle(triangle: [DVec3; 3], p: DVec3) -> f32 {
        let [a, b, c] = triangle;
        let middle = (a + b + c) / 3.0;
        let about = Triangle::new(triangle.map(|corner| (corner - middle).as_vec3()));
        about.solid_angle((middle - p).as_vec3().to_array())
    }

    const TRIANGLE: [DVec3; 3] =
        [DVec3::new(-0.5, -0.4, 0.0), DVec3::new(0.7, -0.3, 0.1), DVec3::new(0.0, 0.6, -0.2)];

    #[test]
    fn a_corner_of_a_cube_is_an_eighth_of_all_directions() {
        let angle = solid_angle([DVec3::X, DVec3::Y, DVec3::Z], DVec3::ZERO);
        assert!((angle - std::f32::consts::FRAC_PI_2).abs() < 1e-6, "{angle}");
        assert_eq!(solid_angle(TRIANGLE, TRIANGLE[0].midpoint(TRIANGLE[1])), 0.0);
    }

    #[test]
    fn places_of_a_triangle_are_even_over_its_solid_angle() {
        for p in [[0.1, 0.0, 0.3], [0.0, 0.1, 2.0], [3.0, -1.0, 1.0], [20.0, 10.0, -40.0]] {
            let corners = ways(TRIANGLE, DVec3::from_array(p));
            let angle = solid_angle(TRIANGLE, DVec3::from_array(p));
            // The mean over the area, each point by the solid angle that it is seen under.
            let [a, b, c] = TRIANGLE.map(|corner| corner - DVec3::from_array(p));
            let normal = (b - a).cross(c - a);
            let (mut expected, mut whole) = (DVec3::ZERO, 0.0);
            for [u, v] in grid(300) {
                let root = u.sqrt();
                let way = a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
                let square = way.length_squared();
                let share = way.dot(normal).abs() / (square * square.sqrt()) / 2.0 / 90_000.0;
                expected += share * way.normalize_or_zero();
                whole += share;
            }
            assert!((whole / f64::from(angle) - 1.0).abs() < 2e-3, "{p:?}: {whole} and {angle}");
            let ways = grid(60).map(|place| within(corners, place.map(|v| v as f32), angle));
            let mut mean = DVec3::ZERO;
            for way in ways.map(|way| Vec3::from(way).as_dvec3()) {
                assert!((way - a).dot(normal).abs() < 1e-5 * way.length(), "in its plane");
                mean += way.normalize_or_zero() / 3600.0;
            }
            let expected = expected / whole;
            assert!(mean.distance(expected) < 2e-3, "{p:?}: {mean} instead of {expected}");
        }
    }

    #[test]
    fn triangles_are_chosen_by_their_solid_angles_and_the_middle_stands_for_all() {
        let beside = TRIANGLE.map(|corner| corner + DVec3::new(4.0, 0.0, 0.0));
        let mesh = LuminousMesh::new(&[TRIANGLE, beside]);
        let p = DVec3::new(0.2, 0.1, 1.0);
        let [near, far] = [TRIANGLE, beside].map(|triangle| solid_angle(triangle, p));
        let toward = (mesh.middle - p).as_vec3().to_array();
        let way = |place: [f64; 2]| mesh.choose(toward, place.map(|v| v as f32));
        let chosen = grid(100).filter(|&place| way(place)[0] < 1.0).count();
        assert!((chosen as f32 / 1e4 - near / (near + far)).abs() < 0.01, "{chosen}");
        assert_eq!(way([0.5; 2]), toward);
        assert_eq!(LuminousMesh::default().choose(toward, [0.1, 0.2]), [0.0; 3]);
    }
}
