//! The surfaces that the rays of a bundle met, eight side by side, so that lights can be worked
//! out for eight at once.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};
use glam::Vec3;
use phong_bvh::{Hit, Ray, Surfaces8};
use phong_scene::Rgb;

use crate::compile::{CompiledScene, Dressed};
use crate::interaction::SurfaceInteraction;
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, dot, load3};

/// The surfaces that the rays of a bundle met, in the order of the rays.
#[derive(Clone)]
pub(super) struct Met {
    /// For each surface the bundle's ray that met it.
    pub(super) rays: Vec<u32>,
    /// For each ray of the bundle what it met.
    pub(super) hits: Vec<Hit>,
    pub(super) eights: Vec<Eight>,
}

/// Eight surfaces, number by number. Those beyond the last are 0, and no light is above them.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(super) struct Eight {
    pub(super) p: Lanes3,
    p_error: Lanes3,
    ng: Lanes3,
    pub(super) n: Lanes3,
    pub(super) e: Lanes3,
    pub(super) color: Lanes3,
    pub(super) material: [u32; 8],
    /// What the lights have added so far.
    pub(super) diffuse: Lanes3,
    pub(super) specular: Lanes3,
}

impl Met {
    /// The surfaces that the rays numbered `of` met.
    pub(super) fn new(scene: &CompiledScene, rays: &[Ray], hits: Vec<Hit>, of: Vec<u32>) -> Self {
        let mut eights = Vec::with_capacity(of.len().div_ceil(8));
        for of in of.chunks(8) {
            let Surfaces8 { p, p_error, ng } = scene.bvh().surface8(rays, &hits, of);
            let mut eight = Eight { p, p_error, ng, ..Eight::NONE };
            for (lane, &of) in of.iter().enumerate() {
                let (ng, e) = (direction(&ng, lane), -Dir3::from_unit(rays[of as usize].dir));
                let Dressed { n, material, color } = scene.dressed(&hits[of as usize], ng, e);
                set(&mut eight.n, lane, n.to_array());
                set(&mut eight.e, lane, e.to_array());
                set(&mut eight.color, lane, color.to_array());
                eight.material[lane] = material;
            }
            eights.push(eight);
        }
        Self { rays: of, hits, eights }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.rays.len()
    }

    /// The same surfaces in the dark.
    pub(super) fn without_light(&self) -> Self {
        let mut dark = self.clone();
        for eight in &mut dark.eights {
            (eight.diffuse, eight.specular) = (Eight::NONE.diffuse, Eight::NONE.specular);
        }
        dark
    }

    /// The number of the material of a surface.
    pub(super) fn material(&self, k: usize) -> usize {
        self.eights[k / 8].material[k % 8] as usize
    }

    /// The diffuse colour of a surface.
    pub(super) fn color(&self, k: usize) -> Rgb {
        Rgb::from(get(&self.eights[k / 8].color, k % 8))
    }

    /// What the lights have added to the diffuse and the specular term of a surface.
    pub(super) fn light(&self, k: usize) -> (Rgb, Rgb) {
        let (eight, lane) = (&self.eights[k / 8], k % 8);
        (Rgb::from(get(&eight.diffuse, lane)), Rgb::from(get(&eight.specular, lane)))
    }

    /// A surface as it was given.
    pub(super) fn at(&self, k: usize) -> SurfaceInteraction {
        let (eight, lane) = (&self.eights[k / 8], k % 8);
        SurfaceInteraction {
            hit: self.hits[self.rays[k] as usize],
            material: eight.material[lane],
            p: Vec3::from(get(&eight.p, lane)),
            p_error: Vec3::from(get(&eight.p_error, lane)),
            ng: direction(&eight.ng, lane),
            n: direction(&eight.n, lane),
            e: direction(&eight.e, lane),
            color: Rgb::from(get(&eight.color, lane)),
        }
    }
}

impl Eight {
    const NONE: Self = Self {
        p: [[0.0; 8]; 3],
        p_error: [[0.0; 8]; 3],
        ng: [[0.0; 8]; 3],
        n: [[0.0; 8]; 3],
        e: [[0.0; 8]; 3],
        color: [[0.0; 8]; 3],
        material: [0; 8],
        diffuse: [[0.0; 8]; 3],
        specular: [[0.0; 8]; 3],
    };

    /// Where a light in direction `l` is above the horizon: that of the surface as it is, and that
    /// of N.
    #[inline(always)]
    pub(super) fn is_above<S: Simd>(&self, simd: S, l: [f32x8<S>; 3]) -> mask32x8<S> {
        let zero = f32x8::splat(simd, 0.0);
        let (n, ng, e) = (load3(simd, &self.n), load3(simd, &self.ng), load3(simd, &self.e));
        let over = dot(l, ng);
        let over = dot(ng, e).simd_lt(zero).select(-over, over);
        dot(l, n).simd_gt(zero) & over.simd_gt(zero)
    }

    /// Where rays in directions `l` start: [`phong_bvh::offset_origin`], to the bit.
    #[inline(always)]
    pub(super) fn origins<S: Simd>(&self, simd: S, l: [f32x8<S>; 3]) -> [f32x8<S>; 3] {
        let zero = f32x8::splat(simd, 0.0);
        let (p, error, ng) =
            (load3(simd, &self.p), load3(simd, &self.p_error), load3(simd, &self.ng));
        let below = dot(l, ng).simd_lt(zero);
        let keep = dot([ng[0].abs(), ng[1].abs(), ng[2].abs()], error);
        let [x, y, z] = ng;
        [
            away(simd, p[0], keep * below.select(-x, x)),
            away(simd, p[1], keep * below.select(-y, y)),
            away(simd, p[2], keep * below.select(-z, z)),
        ]
    }
}

/// `p + offset`, rounded away from `p`.
#[inline(always)]
fn away<S: Simd>(simd: S, p: f32x8<S>, offset: f32x8<S>) -> f32x8<S> {
    let zero = f32x8::splat(simd, 0.0);
    let down = offset.simd_lt(zero);
    let moved = p + offset;
    // The next number up; down is up in a mirror.
    let up = down.select(-moved, moved);
    let bits: u32x8<S> = up.bitcast();
    let next: f32x8<S> = up.simd_gt(zero).select(bits + 1, bits - 1).bitcast();
    let least = f32x8::splat(simd, f32::from_bits(1));
    let next = up.simd_eq(zero).select(least, next);
    let next = down.select(-next, next);
    (down | offset.simd_gt(zero)).select(next, moved)
}

/// A ray towards a light.
#[inline]
pub(super) fn shadow_ray(origins: &Lanes3, l: &Lanes3, distance: f32, lane: usize) -> Ray {
    let dir = Vec3::from(get(l, lane));
    Ray { t_max: distance, ..Ray::new(Vec3::from(get(origins, lane)), dir) }
}

/// The direction in one lane.
#[inline]
pub(super) fn direction(lanes: &Lanes3, lane: usize) -> Dir3 {
    Dir3::from_unit(Vec3::from(get(lanes, lane)))
}

/// Three numbers of one lane.
#[inline]
pub(super) fn get(lanes: &Lanes3, lane: usize) -> [f32; 3] {
    [lanes[0][lane], lanes[1][lane], lanes[2][lane]]
}

#[inline]
pub(super) fn set(lanes: &mut Lanes3, lane: usize, [x, y, z]: [f32; 3]) {
    (lanes[0][lane], lanes[1][lane], lanes[2][lane]) = (x, y, z);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::lanes::store3;

    #[test]
    fn horizons_and_starts_of_eight_have_the_bits_of_one() {
        let simd = fearless_simd::Fallback::new();
        let x = |i: usize, k: usize| ((i * 37 + k * 61) % 83) as f32 / 41.5 - 1.0;
        let dir =
            |i: usize, k: usize| Dir3::new(Vec3::new(x(i, k), x(i, k + 1), x(i, k + 2))).unwrap();
        let mut above = 0;
        for round in 0..40 {
            let (mut eight, mut l) = (Eight::NONE, [[0.0; 8]; 3]);
            for lane in 0..8 {
                let i = 8 * round + lane;
                // Coordinates that are 0, and normals along an axis, are the odd cases.
                let p = if lane == 0 { [0.0, -0.0, x(i, 2)] } else { [x(i, 1), x(i, 2), 5.0] };
                set(&mut eight.p, lane, p);
                set(&mut eight.p_error, lane, [1e-7 * x(i, 3).abs(), 0.0, 2e-7]);
                let ng = if lane == 1 { -Dir3::Y } else { dir(i, 4) };
                set(&mut eight.ng, lane, ng.to_array());
                let e = dir(i, 7);
                set(&mut eight.n, lane, dir(i, 5).facing(e).to_array());
                set(&mut eight.e, lane, e.to_array());
                set(&mut l, lane, dir(i, 11).to_array());
            }
            let l8 = load3(simd, &l);
            let (mask, origins) =
                (eight.is_above(simd, l8).to_bitmask(), store3(eight.origins(simd, l8)));
            let met = Met { rays: (0..8).collect(), hits: vec![Hit::NONE; 8], eights: vec![eight] };
            for lane in 0..8 {
                let (at, l) = (met.at(lane), direction(&l, lane));
                let is_above = l.dot(at.n) > 0.0 && l.dot(at.facing_ng()) > 0.0;
                assert_eq!(mask >> lane & 1 != 0, is_above);
                let start = at.spawn(l, 1.0).origin.to_array();
                assert_eq!(get(&origins, lane).map(f32::to_bits), start.map(f32::to_bits));
                above += u32::from(is_above);
            }
        }
        assert!((100..300).contains(&above), "{above}");
    }
}
