//! The directions and weights of mirror and refracted rays, eight at a time.

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::{DVec3, Vec3};
use phong_bvh::{Kernel, Lanes, Ray, Rays8, offset_origins};
use phong_scene::Rgb;

use super::interactions::{Interactions, material, same_material, to_eye};
use crate::material::Material;
use crate::math::lanes::{
    Lanes3, dot, get, load3, mirror, neg, normalize, put3, scale, select3, splat3,
};
use crate::reflectance::fresnel;
use crate::view::View;
use crate::witness::Branch;

/// The mirror or refracted rays of eight surfaces.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(super) struct Scattered8 {
    origin: [[f64; 8]; 3],
    dir: Lanes3,
    weight: Lanes3,
    /// The reflectance F where the material uses it, else NaN.
    fresnel: [f32; 8],
    /// The index of refraction of the far side relative to the near one.
    pub(super) eta: [f32; 8],
    /// The surfaces whose ray has a weight above 0, one bit each.
    pub(super) there: u32,
}

impl Scattered8 {
    pub(super) const NONE: Self = Self {
        origin: [[0.0; 8]; 3],
        dir: [[0.0; 8]; 3],
        weight: [[0.0; 8]; 3],
        fresnel: [f32::NAN; 8],
        eta: [1.0; 8],
        there: 0,
    };

    /// The direction of the ray of one surface.
    pub(super) fn dir(&self, lane: usize) -> Vec3 {
        get(&self.dir, lane).into()
    }

    /// The ray of one surface.
    pub(super) fn ray(&self, lane: usize) -> Ray {
        let origin = self.origin.map(|all| all[lane]);
        Ray::new(DVec3::from_array(origin), self.dir(lane))
    }

    /// Its weight, and F where the material uses it.
    pub(super) fn weight(&self, lane: usize) -> (Rgb, Option<f32>) {
        let fresnel = Some(self.fresnel[lane]).filter(|f| !f.is_nan());
        (Rgb::from(get(&self.weight, lane)), fresnel)
    }
}

/// Works out the mirror rays, or the refracted ones, of all surfaces.
pub(super) struct Scatter<'a> {
    pub(super) scene: &'a View,
    pub(super) branch: Branch,
    pub(super) rays: &'a [Rays8],
    pub(super) interactions: &'a Interactions,
    pub(super) to: &'a mut [Scattered8],
}

impl Kernel for Scatter<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { scene, branch, rays, interactions, to } = self;
        for (i, (rays, to)) in rays.iter().zip(to).enumerate() {
            let (surface, shading) = (&interactions.surfaces[i], &interactions.shading[i]);
            to.there = 0;
            let mut left = interactions.hits[i].met;
            while left != 0 {
                let (number, same) = same_material(simd, &shading.material, left);
                // What is in lanes without a ray is unspecified, and the others are yet to come.
                let lanes = if left == interactions.hits[i].met { 0xff } else { same };
                left &= !same;
                let material = material(scene, &interactions.made, number);
                let cover = interactions.covers.get(i).filter(|_| material.is_see_through());
                let cover = cover.map(|covers| f32x8::load_array_ref(simd, covers));
                if branch == Branch::Through && cover.is_none()
                    || branch != Branch::Through && !material.bounces()
                {
                    continue;
                }
                let at = Side::new(
                    material,
                    load3(simd, &shading.n),
                    load3(simd, &surface.ng),
                    to_eye(simd, rays),
                );
                let at = match interactions.etas.get(i) {
                    Some(etas) => at.with_eta(f32x8::load_array_ref(simd, etas)),
                    None => at,
                };
                let (dir, weight, share) = match branch {
                    Branch::Reflection => at.mirrored(material),
                    Branch::Transmission => at.refracted(material),
                    Branch::Through => at.straight_on(cover),
                };
                let weight = match cover {
                    Some(cover) if branch != Branch::Through => scale(cover, weight),
                    _ => weight,
                };
                let zero = weight[0].splat(0.0);
                let black =
                    weight[0].simd_eq(zero) & weight[1].simd_eq(zero) & weight[2].simd_eq(zero);
                to.there |= same & !(black.to_bitmask() as u32);
                if lanes == 0xff {
                    offset_origins(simd, surface, dir, &mut to.origin);
                    to.fresnel = share.into();
                    to.eta = at.eta.into();
                } else {
                    let mut origins = [[0.0; 8]; 3];
                    offset_origins(simd, surface, dir, &mut origins);
                    let (shares, etas) = (<[f32; 8]>::from(share), <[f32; 8]>::from(at.eta));
                    for lane in phong_bvh::lanes(lanes) {
                        for (to, from) in to.origin.iter_mut().zip(origins) {
                            to[lane] = from[lane];
                        }
                        to.fresnel[lane] = shares[lane];
                        to.eta[lane] = etas[lane];
                    }
                }
                put3(simd, &mut to.dir, lanes, dir);
                put3(simd, &mut to.weight, lanes, weight);
            }
        }
    }
}

/// The direction of a ray, its weight, and F, which is NaN where the material does not use it.
type Scattered<F> = ([F; 3], [F; 3], F);

/// One surface or eight, seen from the side the rays came from.
struct Side<F> {
    /// On the side of `facing`; N·E may be below 0.
    n: [F; 3],
    e: [F; 3],
    /// The geometric normal on this side.
    facing: [F; 3],
    /// The index of refraction of the far side relative to this one.
    eta: F,
}

impl<F: Lanes<Scalar = f32>> Side<F> {
    #[inline(always)]
    fn new(material: &Material, n: [F; 3], ng: [F; 3], e: [F; 3]) -> Self {
        let cos = dot(ng, e);
        let inside = cos.lt(cos.splat(0.0));
        let facing = select3(inside, neg(ng), ng);
        let eta = F::select(inside, cos.splat(1.0 / material.ior), cos.splat(material.ior));
        Self { n, e, facing, eta }
    }

    /// With other indices of refraction where there are any: where `eta` is not NaN.
    #[inline(always)]
    fn with_eta(self, eta: F) -> Self {
        Self { eta: F::select(eta.gt(eta.splat(0.0)), eta, self.eta), ..self }
    }

    /// The exact reflectance.
    #[inline(always)]
    fn dielectric(&self) -> F {
        fresnel::boundary(dot(self.n, self.e).at_least(0.0), self.eta)
    }

    /// The mirror ray.
    #[inline(always)]
    fn mirrored(&self, material: &Material) -> Scattered<F> {
        let Self { n, e, facing, eta } = *self;
        // A shading normal can send the mirror ray into the surface.
        let dir = onto(mirror(n, e), facing);
        let weight = splat3(eta, material.reflection.to_array());
        if material.fresnel {
            let f = self.dielectric();
            return (dir, scale(f, weight), f);
        }
        let not_asked = eta.splat(f32::NAN);
        if material.transmission.is_black() {
            return (dir, weight, not_asked);
        }
        // Under total reflection the mirror ray has the refracted one's weight as well.
        let both = splat3(eta, (material.reflection + material.transmission).to_array());
        (dir, select3(self.refract().1, weight, both), not_asked)
    }

    /// The ray that goes straight on, beside the share of the surface that is there.
    #[inline(always)]
    fn straight_on(&self, cover: Option<F>) -> Scattered<F> {
        let one = self.eta.splat(1.0);
        let rest = one - cover.unwrap_or(one);
        (neg(self.e), [rest; 3], one.splat(f32::NAN))
    }

    /// The refracted ray; without weight under total internal reflection.
    #[inline(always)]
    fn refracted(&self, material: &Material) -> Scattered<F> {
        let (dir, passes) = self.refract();
        let zero = self.eta.splat(0.0);
        let weight = splat3(zero, material.transmission.to_array());
        let (weight, f) = if material.fresnel {
            let f = self.dielectric();
            (scale(f.splat(1.0) - f, weight), f)
        } else {
            (weight, zero.splat(f32::NAN))
        };
        (dir, select3(passes, weight, [zero; 3]), f)
    }

    /// The direction of the refracted ray, and where there is one.
    #[inline(always)]
    fn refract(&self) -> ([F; 3], F::Mask) {
        let Self { n, e, facing, eta } = *self;
        let (dir, passes) = refract(n, e, eta);
        // A shading normal can keep the ray on this side.
        (onto(dir, neg(facing)), passes)
    }
}

/// How far above the tangent plane a ray is bent that would leave on the wrong side: the sine of the angle.
const CLEARANCE: f32 = 1e-4;

/// `dir` where it leaves on this side of the tangent plane; elsewhere turned by the least angle that takes it
/// just above the plane. (A mirror ray about the geometric normal instead would jump as the shading normal
/// turns.)
#[inline(always)]
fn onto<F: Lanes<Scalar = f32>>(dir: [F; 3], side: [F; 3]) -> [F; 3] {
    let along = dot(dir, side);
    let above = along.gt(along.splat(0.0));
    if F::all(above) {
        return dir;
    }
    let by = along.splat(CLEARANCE) - along;
    let bent = [dir[0] + by * side[0], dir[1] + by * side[1], dir[2] + by * side[2]];
    select3(above, dir, normalize(bent))
}

/// Snell's law: `sin θ_i = η sin θ_t`, η the index of the far side relative to the near one, `e`
/// and `n` on the near side. The direction, and where there is one: not under total internal
/// reflection.
#[inline(always)]
fn refract<F: Lanes<Scalar = f32>>(n: [F; 3], e: [F; 3], eta: F) -> ([F; 3], F::Mask) {
    let one = eta.splat(1.0);
    let cos_i = dot(n, e);
    let sin2_t = (one - cos_i * cos_i).at_least(0.0) / (eta * eta);
    let cos_t = (one - sin2_t).at_least(0.0).sqrt();
    let along = cos_i / eta - cos_t;
    let dir = normalize([
        along * n[0] - e[0] / eta,
        along * n[1] - e[1] / eta,
        along * n[2] - e[2] / eta,
    ]);
    (dir, sin2_t.lt(one))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::math::Dir3;

    /// Snell's law in f64, about a normal on the side of `e`.
    fn snell(n: DVec3, e: DVec3, eta: f64) -> Option<DVec3> {
        let across = n * n.dot(e) - e;
        let sin = across.length() / eta;
        let along = (sin < 1.0).then(|| (1.0 - sin * sin).sqrt())?;
        Some(across / eta - along * n)
    }

    #[test]
    fn eight_rays_go_on_as_snell_and_the_mirror_have_it_each_by_itself() {
        let simd = fearless_simd::Fallback::new();
        let x = |i: usize, k: usize| ((i * 37 + k * k * 61 + i * k * 13) % 83) as f64 / 41.5 - 1.0;
        let unit = |v: DVec3| v.normalize_or(DVec3::X);
        let dir = |i: usize, k: usize| unit(DVec3::new(x(i, k), x(i, k + 1), x(i, k + 2)));
        let material = |fresnel| {
            let (reflection, transmission) = (Rgb::grey(0.25), Rgb::new(0.5, 0.75, 0.0));
            let written = phong_scene::ConstantMaterial {
                reflection,
                transmission,
                fresnel,
                ior: 1.5,
                ..phong_scene::ConstantMaterial::default()
            };
            Material::new(&written, Dir3::Z)
        };
        let [plain, exact] = [material(false), material(true)];
        let lanes = |v: [DVec3; 8]| -> [f32x8<_>; 3] {
            let lanes = std::array::from_fn(|k| std::array::from_fn(|i| v[i][k] as f32));
            load3(simd, &lanes)
        };
        let (mut total, mut passed, mut turned) = (0, 0, 0);
        for round in 0..100 {
            let e: [DVec3; 8] = std::array::from_fn(|i| dir(8 * round + i, 0));
            let ng: [DVec3; 8] = std::array::from_fn(|i| dir(8 * round + i, 5));
            // Shading normals lie about the real one, far off in some lanes.
            let n: [DVec3; 8] = std::array::from_fn(|i| {
                let n = unit(ng[i] + 0.2 * (i % 4) as f64 * dir(8 * round + i, 9));
                if n.dot(ng[i]) * ng[i].dot(e[i]) < 0.0 { -n } else { n }
            });
            let (n8, ng8, e8) = (lanes(n), lanes(ng), lanes(e));
            let at = Side::new(&plain, n8, ng8, e8);
            let (mirrored, refracted) = (at.mirrored(&plain), at.refracted(&plain));
            let shared = [at.mirrored(&exact), at.refracted(&exact)];
            for i in 0..8 {
                let inside = ng[i].dot(e[i]) < 0.0;
                let facing = if inside { -ng[i] } else { ng[i] };
                let eta = if inside { 1.0 / 1.5 } else { 1.5 };
                let mirror = |n: DVec3| 2.0 * n.dot(e[i]) * n - e[i];
                let onto = |dir: DVec3, side: DVec3| {
                    let along = dir.dot(side);
                    if along > 0.0 { dir } else { unit(dir + (1e-4 - along) * side) }
                };
                turned += u32::from(mirror(n[i]).dot(facing) <= 0.0);
                let want = onto(mirror(n[i]), facing);
                let lane =
                    |v: [f32x8<_>; 3]| DVec3::new(v[0][i].into(), v[1][i].into(), v[2][i].into());
                let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 2e-5, "{a} is not {b}");
                near(lane(mirrored.0), want);
                let want = snell(n[i], e[i], eta).map(|dir| onto(dir, -facing));
                let weight = DVec3::new(0.5, 0.75, 0.0);
                let Some(dir) = want else {
                    assert_eq!(lane(refracted.1), DVec3::ZERO);
                    assert_eq!(lane(mirrored.1), weight + DVec3::splat(0.25));
                    total += 1;
                    continue;
                };
                near(lane(refracted.0), dir);
                assert_eq!([lane(refracted.1), lane(mirrored.1)], [weight, DVec3::splat(0.25)]);
                let f = f64::from(shared[0].2[i]);
                assert!(f > 0.0 && f <= 1.0 && f64::from(shared[1].2[i]) == f);
                near(lane(shared[0].1), DVec3::splat(0.25 * f));
                near(lane(shared[1].1), (1.0 - f) * weight);
                passed += 1;
            }
        }
        assert!(total > 50 && passed > 300 && turned > 10, "{total}, {passed}, {turned}");
    }
}
