//! A mesh that shines: points of its triangles chosen by solid angle.
//!
//! From a point each triangle is seen under a solid angle, from whichever side. One is chosen by these, and within
//! it a direction evenly: the mean over all places is that of a point light over the solid angles of the
//! triangles. Of a closed body without hollows that is the mean over the solid angle of the body, since every
//! direction to it meets two of its triangles.

use std::sync::Arc;

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::{DVec3, Vec3};
use phong_scene::Light;

use super::{Reach, arrival};
use crate::math::Dir3;
use crate::math::lanes::{load3, set};
use crate::math::wide::{atan2, sin_cos};

/// A triangle seen at a smaller slope than this is seen from its own plane, where it gives nothing: so does the
/// surface itself to its own points.
const GRAZING: f64 = 1e-5;

/// A triangle of a smaller solid angle is filled as a flat one.
const FLAT: f64 = 1e-6;

/// The triangles of a mesh that shines.
#[derive(Clone, Debug, Default)]
pub(super) struct LuminousMesh {
    triangles: Arc<[[DVec3; 3]]>,
    /// The middle of its surface.
    middle: DVec3,
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
        Self {
            triangles: triangles.into(),
            middle: if sum.is_finite() { sum } else { DVec3::ZERO },
        }
    }

    /// How far from a point its farthest corner is.
    pub(super) fn reach_about(&self, center: DVec3) -> f64 {
        let corners = self.triangles.iter().flatten();
        corners.map(|corner| corner.distance(center)).fold(0.0, f64::max)
    }

    /// How it reaches a point.
    pub(super) fn reach(
        &self,
        attenuation: [f32; 3],
        p: DVec3,
        place: [f32; 2],
    ) -> Option<Reach<Dir3, f32>> {
        let toward = self.choose(p, place.map(f64::from))?;
        let Reach { l, distance, share } = arrival(toward.as_vec3().to_array(), attenuation);
        (l != [0.0; 3]).then(|| Reach { l: Dir3::from_unit(Vec3::from(l)), distance, share })
    }

    /// How it reaches eight points, one after the other; `l` is 0 where nothing of it is seen.
    pub(super) fn reach8<S: Simd>(
        &self,
        simd: S,
        attenuation: [f32; 3],
        p: &[[f64; 8]; 3],
        place: Option<&[[f32; 8]; 2]>,
    ) -> Reach<[f32x8<S>; 3], f32x8<S>> {
        let (mut l, mut distance, mut share) = ([[0.0; 8]; 3], [0.0; 8], [0.0; 8]);
        for lane in 0..8 {
            let p = DVec3::from_array(p.map(|all| all[lane]));
            let place = place.map_or([0.5; 2], |place| place.map(|all| all[lane]));
            if let Some(reach) = self.reach(attenuation, p, place) {
                set(&mut l, lane, reach.l.to_array());
                (distance[lane], share[lane]) = (reach.distance, reach.share);
            }
        }
        let load = |lanes: &[f32; 8]| f32x8::load_array_ref(simd, lanes);
        Reach { l: load3(simd, &l), distance: load(&distance), share: load(&share) }
    }

    /// The way from a point to one of its own, by a place of the unit square; from the middle of that, to the
    /// middle of the surface. `None`: nothing of it is seen from there.
    pub(super) fn choose(&self, p: DVec3, [u, v]: [f64; 2]) -> Option<DVec3> {
        let seen = |triangle: &[DVec3; 3]| triangle.map(|corner| corner - p);
        let mut angles = [0.0; Light::MOST_TRIANGLES];
        for (angle, triangle) in angles.iter_mut().zip(&*self.triangles) {
            *angle = solid_angle(seen(triangle));
        }
        let whole: f64 = angles[..self.triangles.len().min(angles.len())].iter().sum();
        if whole <= 0.0 {
            return None;
        }
        if u == 0.5 && v == 0.5 {
            return Some(self.middle - p);
        }
        let (target, mut before, mut chosen) = (u * whole, 0.0, None);
        for (triangle, angle) in self.triangles.iter().zip(angles) {
            if angle > 0.0 {
                chosen = Some((triangle, (target - before) / angle, angle));
                before += angle;
                if target < before {
                    break;
                }
            }
        }
        let (triangle, u, angle) = chosen?;
        Some(within(seen(triangle), [u.clamp(0.0, 1.0), v], angle))
    }
}

/// The solid angle of a triangle whose corners these are the ways to, by van Oosterom and Strackee, *The Solid
/// Angle of a Plane Triangle*, 1983; 0 from its own plane.
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let volume = a.dot(normal).abs();
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    if volume <= GRAZING * normal.length() * la.max(lb).max(lc) {
        return 0.0;
    }
    let rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * atan2(volume, rest)
}

/// The way to a point of a triangle that fills its solid angle evenly: after Arvo, *Stratified Sampling of
/// Spherical Triangles*, 1995.
fn within([a, b, c]: [DVec3; 3], [u, v]: [f64; 2], angle: f64) -> DVec3 {
    let flat = || {
        let root = u.sqrt();
        a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v)
    };
    if angle < FLAT {
        return flat();
    }
    let [x, y, z] = [a, b, c].map(DVec3::normalize_or_zero);
    let (across, along) = (x.cross(y), x.cross(z));
    let sizes = across.length() * along.length();
    // The angle at the first corner, by its cosine and sine.
    let (cos, sin) = (across.dot(along) / sizes, x.dot(y.cross(z)).abs() / sizes);
    let (area_sin, area_cos) = sin_cos(u * angle);
    let (s, t) = (area_sin * cos - area_cos * sin, area_cos * cos + area_sin * sin);
    let (p, q) = (t - cos, s + sin * x.dot(y));
    let cosine = ((q * t - p * s) * cos - q) / ((q * s + p * t) * sin);
    let cosine = cosine.clamp(-1.0, 1.0);
    let edge = |from: DVec3, to: DVec3, cosine: f64| {
        let aside = (to - to.dot(from) * from).normalize_or_zero();
        cosine * from + (1.0 - cosine * cosine).max(0.0).sqrt() * aside
    };
    let corner = edge(x, z, cosine);
    let way = edge(y, corner, 1.0 - v * (1.0 - corner.dot(y)));
    let normal = (b - a).cross(c - a);
    let t = a.dot(normal) / way.dot(normal);
    if t.is_finite() && t > 0.0 { way * t } else { flat() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> impl Iterator<Item = [f64; 2]> {
        let at = move |i: usize| (i as f64 + 0.5) / n as f64;
        (0..n * n).map(move |i| [at(i % n), at(i / n)])
    }

    const TRIANGLE: [DVec3; 3] =
        [DVec3::new(-0.5, -0.4, 0.0), DVec3::new(0.7, -0.3, 0.1), DVec3::new(0.0, 0.6, -0.2)];

    #[test]
    fn a_corner_of_a_cube_is_an_eighth_of_all_directions() {
        let angle = solid_angle([DVec3::X, DVec3::Y, DVec3::Z]);
        assert!((angle - std::f64::consts::FRAC_PI_2).abs() < 1e-12, "{angle}");
        let from_its_plane = TRIANGLE.map(|corner| corner - TRIANGLE[0].midpoint(TRIANGLE[1]));
        assert_eq!(solid_angle(from_its_plane), 0.0);
    }

    #[test]
    fn places_of_a_triangle_are_even_over_its_solid_angle() {
        for p in [[0.1, 0.0, 0.3], [0.0, 0.1, 2.0], [3.0, -1.0, 1.0], [20.0, 10.0, -40.0]] {
            let ways = TRIANGLE.map(|corner| corner - DVec3::from_array(p));
            let angle = solid_angle(ways);
            // The mean over the area, each point by the solid angle that it is seen under.
            let [a, b, c] = ways;
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
            assert!((whole / angle - 1.0).abs() < 2e-3, "{p:?}: {whole} and {angle}");
            let ways = grid(60).map(|place| within([a, b, c], place, angle));
            let mut mean = DVec3::ZERO;
            for way in ways {
                assert!((way - a).dot(normal).abs() < 1e-9 * way.length(), "in its plane");
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
        let [near, far] = [TRIANGLE, beside].map(|t| solid_angle(t.map(|corner| corner - p)));
        let chosen = grid(100).filter(|&place| mesh.choose(p, place).unwrap().x < 1.0).count();
        assert!((chosen as f64 / 1e4 - near / (near + far)).abs() < 0.01, "{chosen}");
        assert_eq!(mesh.choose(p, [0.5; 2]), Some(mesh.middle - p));
        assert_eq!(LuminousMesh::default().choose(p, [0.1, 0.2]), None);
    }
}
