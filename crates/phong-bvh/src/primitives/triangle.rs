//! The watertight triangle.
//!
//! The ray is taken as the z axis of a sheared space: z is the axis along which its direction is
//! longest, `x' = (v − o)_x − S_x (v − o)_z`, `S_x = d_x / d_z`, and so for y (Woop, Benthin and Wald,
//! *Watertight ray/triangle intersection*, JCGT 2(1), 2013). The ray hits where the origin of x', y'
//! lies inside; the edge functions `U = C × B`, `V = A × C`, `W = B × A` must agree in sign.
//!
//! **Why no ray slips through an edge.** x' and y' depend on the vertex and the ray alone, so two
//! triangles agree on a shared edge's ends. From there on the verdict is exact: products of two f32
//! are exact in f64, and their difference, rounded once, has the right sign. So U of one triangle is
//! the negative of U of its neighbour, and one of the two is hit.
//!
//! **Filter and verdict.** Eight triangles are first tried in f32. Rounding is monotone: from
//! `a > b` follows `fl(a) ≥ fl(b)`, so an edge function's sign in f32 is right or it is 0. The filter
//! lets zeros pass, hence every triangle the verdict would accept; few others. What is returned
//! (`t`, `u`, `v`) is the verdict's, a scalar function of ray and triangle: every level, every leaf
//! layout and brute force call the same one, and agree bit for bit.
//!
//! Coordinates beyond 10¹⁸ overflow the filter's products.

use fearless_simd::{Simd, f32x8, f64x4, prelude::*};
use glam::{DVec3, Vec3};

use crate::{local::Ray, node8::Row, primitives::splat3};

/// What the test needs of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear {
    /// x, y and z of the sheared space as axes of the world; z is where the direction is longest.
    pub(crate) axes: [usize; 3],
    /// The origin along these axes.
    pub(crate) origin: [f32; 3],
    /// `S_x` and `S_y`.
    pub(crate) slope: [f32; 2],
    /// The direction along z.
    pub(crate) along: f32,
    /// Hits at this `t` or nearer do not count.
    pub(crate) t_min: f32,
    /// Hits at this `t` or farther do not count.
    pub(crate) t_max: f32,
}

impl Shear {
    /// Prepares a ray.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray) -> Self {
        let (o, d) = (ray.origin.to_array(), ray.dir.to_array());
        let [ax, ay, az] = ray.dir.abs().to_array();
        let z = if ax >= ay && ax >= az {
            0
        } else if ay >= az {
            1
        } else {
            2
        };
        let [x, y] = [(z + 1) % 3, (z + 2) % 3];
        Self {
            axes: [x, y, z],
            origin: [o[x], o[y], o[z]],
            slope: [d[x] / d[z], d[y] / d[z]],
            along: d[z],
            t_min: ray.t_min,
            t_max: ray.t_max,
        }
    }

    /// A corner in the sheared space; z is along the ray but not divided by its direction.
    #[inline(always)]
    fn corner(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        let z = z - self.origin[2];
        let x = x - self.origin[0] - self.slope[0] * z;
        let y = y - self.origin[1] - self.slope[1] * z;
        [x, y, z]
    }

    /// [`verdict`] on corners as they are in the world.
    pub(crate) fn intersect(&self, corners: [Vec3; 3]) -> Option<[f32; 3]> {
        let [x, y, z] = self.axes;
        verdict(self, corners.map(|v| [v[x], v[y], v[z]]))
    }

    /// [`verdict`] on one lane of a block.
    #[inline(always)]
    pub(crate) fn intersect_lane(&self, block: &[Row; BLOCK], lane: usize) -> Option<[f32; 3]> {
        let at = |corner: usize, axis: usize| block[corner + (axis & 3)].0[lane & 7];
        let [x, y, z] = self.axes;
        let a = [at(0, x), at(0, y), at(0, z)];
        let b = [at(3, x), at(3, y), at(3, z)];
        let c = [at(6, x), at(6, y), at(6, z)];
        verdict(self, [a, b, c])
    }
}

/// Distance and barycentric weights of the second and third corner, or none; the corners' coordinates
/// in the order of the ray's axes.
#[inline(always)]
fn verdict(ray: &Shear, [a, b, c]: [[f32; 3]; 3]) -> Option<[f32; 3]> {
    let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) = (ray.corner(a), ray.corner(b), ray.corner(c));
    let product = |p: f32, q: f32| f64::from(p) * f64::from(q);
    let u = product(cx, by) - product(cy, bx);
    let v = product(ax, cy) - product(ay, cx);
    let w = product(bx, ay) - product(by, ax);
    let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    let det = u + v + w;
    if !inside || det == 0.0 {
        return None;
    }
    let along = f64::from(ray.along);
    let scale = 1.0 / (det * along);
    let t = ((u * f64::from(az) + v * f64::from(bz) + w * f64::from(cz)) * scale) as f32;
    let scale = scale * along;
    (ray.t_min < t && t < ray.t_max).then_some([t, (v * scale) as f32, (w * scale) as f32])
}

/// Whether a triangle has no area, and so is never hit.
pub(crate) fn is_degenerate([a, b, c]: [Vec3; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    (b - a).cross(c - a) == DVec3::ZERO
}

/// Eight triangles: x, y and z of each corner, then their numbers.
pub(crate) const BLOCK: usize = 10;

/// [`Shear`] for eight triangles at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear8<S: Simd> {
    axes: [usize; 3],
    origin: [f32x8<S>; 3],
    slope: [f32x8<S>; 2],
}

impl<S: Simd> Shear8<S> {
    /// Spreads a prepared ray over the lanes.
    #[inline(always)]
    pub(crate) fn new(simd: S, ray: &Shear) -> Self {
        Self {
            axes: ray.axes,
            origin: splat3(simd, ray.origin),
            slope: [f32x8::splat(simd, ray.slope[0]), f32x8::splat(simd, ray.slope[1])],
        }
    }

    /// The lanes [`verdict`] may accept: none that it would is missing.
    #[inline(always)]
    pub(crate) fn filter(&self, simd: S, block: &[Row; BLOCK]) -> u32 {
        let [ax, ay] = self.corner(simd, block, 0);
        let [bx, by] = self.corner(simd, block, 3);
        let [cx, cy] = self.corner(simd, block, 6);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let least = u.min(v).min(w);
        let most = u.max(v).max(w);
        let zero = f32x8::splat(simd, 0.0);
        (least.simd_ge(zero) | most.simd_le(zero)).to_bitmask() as u32
    }

    #[inline(always)]
    fn corner(&self, simd: S, block: &[Row; BLOCK], first: usize) -> [f32x8<S>; 2] {
        let load = |axis: usize| f32x8::load_array_ref(simd, &block[first + (axis & 3)].0);
        let [x, y, z] = self.axes;
        let z = load(z) - self.origin[2];
        let x = load(x) - self.origin[0] - self.slope[0] * z;
        let y = load(y) - self.origin[1] - self.slope[1] * z;
        [x, y]
    }
}

/// [`Shear`] of eight rays, whose directions are longest along the same axis, for one triangle at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shears<S: Simd> {
    pub(crate) origin: [f32x8<S>; 3],
    pub(crate) slope: [f32x8<S>; 2],
    pub(crate) along: f32x8<S>,
    pub(crate) t_min: f32x8<S>,
    pub(crate) t_max: f32x8<S>,
}

impl<S: Simd> Shears<S> {
    /// The rays that hit a triangle, its corners' coordinates in the order of the rays' axes; and where, as
    /// [`verdict`] has it, step by step.
    #[inline(always)]
    pub(crate) fn intersect(
        &self,
        simd: S,
        [a, b, c]: [[f32x8<S>; 3]; 3],
        among: u32,
    ) -> (u32, [f32x8<S>; 3]) {
        let zero = f32x8::splat(simd, 0.0);
        let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) =
            (self.corner(a), self.corner(b), self.corner(c));
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let inside = u.min(v).min(w).simd_ge(zero) | u.max(v).max(w).simd_le(zero);
        if inside.to_bitmask() as u32 & among == 0 {
            return (0, [zero; 3]);
        }
        let (ax, ay, az) = (ax.widen(), ay.widen(), az.widen());
        let (bx, by, bz) = (bx.widen(), by.widen(), bz.widen());
        let (cx, cy, cz) = (cx.widen(), cy.widen(), cz.widen());
        let along = self.along.widen();
        let (low, [t, v, w]) =
            verdict4(simd, along.0, [[ax.0, ay.0, az.0], [bx.0, by.0, bz.0], [cx.0, cy.0, cz.0]]);
        let (high, [t_high, v_high, w_high]) =
            verdict4(simd, along.1, [[ax.1, ay.1, az.1], [bx.1, by.1, bz.1], [cx.1, cy.1, cz.1]]);
        let (t, v, w) = (t.narrow(t_high), v.narrow(v_high), w.narrow(w_high));
        let within = self.t_min.simd_lt(t) & t.simd_lt(self.t_max);
        ((low | high << 4) & within.to_bitmask() as u32 & among, [t, v, w])
    }

    /// [`Shear::corner`], step by step.
    #[inline(always)]
    fn corner(&self, [x, y, z]: [f32x8<S>; 3]) -> [f32x8<S>; 3] {
        let z = z - self.origin[2];
        let x = x - self.origin[0] - self.slope[0] * z;
        let y = y - self.origin[1] - self.slope[1] * z;
        [x, y, z]
    }
}

/// [`verdict`] from the corners in the sheared space of each of four rays, step by step.
#[inline(always)]
fn verdict4<S: Simd>(
    simd: S,
    along: f64x4<S>,
    [[ax, ay, az], [bx, by, bz], [cx, cy, cz]]: [[f64x4<S>; 3]; 3],
) -> (u32, [f64x4<S>; 3]) {
    let zero = f64x4::splat(simd, 0.0);
    let u = cx * by - cy * bx;
    let v = ax * cy - ay * cx;
    let w = bx * ay - by * ax;
    let inside = (u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero))
        | (u.simd_le(zero) & v.simd_le(zero) & w.simd_le(zero));
    let det = u + v + w;
    let hit = inside & !det.simd_eq(zero);
    let scale = f64x4::splat(simd, 1.0) / (det * along);
    let t = (u * az + v * bz + w * cz) * scale;
    let scale = scale * along;
    (hit.to_bitmask() as u32, [t, v * scale, w * scale])
}

/// [`Shear`] of many rays as one: every number from a least to a greatest.
///
/// Rounding is monotone, so what any of the rays would compute lies within what is computed here.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShearBounds {
    /// [`Shear::axes`], the same for all.
    pub(crate) axes: [usize; 3],
    /// The least and the greatest origin along each.
    pub(crate) origin: [[f32; 2]; 3],
    /// The least and the greatest slopes.
    pub(crate) slope: [[f32; 2]; 2],
}

/// The least and the greatest.
type Between<S> = [f32x8<S>; 2];

impl ShearBounds {
    /// The lanes that some ray may hit: none is missing.
    #[inline(always)]
    pub(crate) fn filter<S: Simd>(&self, simd: S, block: &[Row; BLOCK]) -> u32 {
        let [ax, ay] = self.corner(simd, block, 0);
        let [bx, by] = self.corner(simd, block, 3);
        let [cx, cy] = self.corner(simd, block, 6);
        let u = minus(times(cx, by), times(cy, bx));
        let v = minus(times(ax, cy), times(ay, cx));
        let w = minus(times(bx, ay), times(by, ax));
        let least = u[1].min(v[1]).min(w[1]);
        let most = u[0].max(v[0]).max(w[0]);
        let zero = f32x8::splat(simd, 0.0);
        (least.simd_ge(zero) | most.simd_le(zero)).to_bitmask() as u32
    }

    #[inline(always)]
    fn corner<S: Simd>(&self, simd: S, block: &[Row; BLOCK], first: usize) -> [Between<S>; 2] {
        let load = |axis: usize| f32x8::load_array_ref(simd, &block[first + (axis & 3)].0);
        let ([x, y, z], [ox, oy, oz]) = (self.axes, self.origin);
        let (x, y, z) = (load(x), load(y), load(z));
        let spread = |[low, high]: [f32; 2]| [f32x8::splat(simd, low), f32x8::splat(simd, high)];
        let z = [z - oz[1], z - oz[0]];
        let x = minus([x - ox[1], x - ox[0]], times(spread(self.slope[0]), z));
        let y = minus([y - oy[1], y - oy[0]], times(spread(self.slope[1]), z));
        [x, y]
    }
}

#[inline(always)]
fn minus<S: Simd>(a: Between<S>, b: Between<S>) -> Between<S> {
    [a[0] - b[1], a[1] - b[0]]
}

#[inline(always)]
fn times<S: Simd>(a: Between<S>, b: Between<S>) -> Between<S> {
    let (p, q, r, s) = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]);
    [p.min(q).min(r.min(s)), p.max(q).max(r.max(s))]
}

/// The corners of one lane.
#[cfg(test)]
pub(crate) fn corners(block: &[Row; BLOCK], lane: usize) -> [[f32; 3]; 3] {
    let corner =
        |i: usize| [block[i].0[lane & 7], block[i + 1].0[lane & 7], block[i + 2].0[lane & 7]];
    [corner(0), corner(3), corner(6)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hit_has_its_distance_and_the_weights_of_its_corners() {
        let ray = Shear::new(&Ray::new(Vec3::new(0.25, 0.5, 3.0), Vec3::NEG_Z));
        let corners = [Vec3::Z, Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0)];
        assert_eq!(ray.intersect(corners), Some([2.0, 0.25, 0.5]));
        let back = [corners[0], corners[2], corners[1]];
        assert_eq!(ray.intersect(back), Some([2.0, 0.5, 0.25]), "from behind as well");
    }

    #[test]
    fn a_triangle_without_area_is_degenerate_and_a_thin_one_is_not() {
        let [p, q] = [Vec3::ZERO, Vec3::ONE];
        assert!(is_degenerate([p, p, q]) && is_degenerate([p, q, 2.0 * q]));
        assert!(!is_degenerate([p, q, Vec3::new(2.0, 2.0, 2.0f32.next_up())]));
    }
}
