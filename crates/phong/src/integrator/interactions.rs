//! The surfaces that the rays of a bundle hit, eight side by side, each in the lane of its ray.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};
use glam::{DVec3, Vec3};
use phong_bvh::{Hits8, Kernel, Ray, Rays8, Surfaces8, lanes, offset_origin};
use phong_scene::{Background, Rgb};

use super::bundle::Radiance8;
use super::crossing::{Crossings, Departure};
use super::lamps::{self, Lamps8};
use super::{Integrator, Paths};
use crate::interaction::SurfaceInteraction;
use crate::material::Material;
use crate::math::lanes::{
    Lanes3, add, direction, dot, get, load3, scale, select3, set, splat3, store3,
};
use crate::terms::{Term, TermSet};
use crate::view::{Coincidences, MadeMaterial, Shading8, View};
use crate::witness::Branch;

/// The surfaces that the rays of a bundle hit, eight for eight rays. The numbers of rays that hit
/// nothing are unspecified.
#[derive(Default)]
pub(super) struct Interactions {
    pub(super) hits: Vec<Hits8>,
    pub(super) surfaces: Vec<Surfaces8>,
    pub(super) shading: Vec<Shading8>,
    /// Materials made for surfaces that textures vary, numbered behind those of the view.
    pub(super) made: Vec<MadeMaterial>,
    /// What was met where more than the closest hit counts.
    pub(super) crossings: Crossings,
    /// The index of refraction of the far side relative to the near one, eight for eight rays; NaN: the
    /// material's own. Empty: that of all.
    pub(super) etas: Vec<[f32; 8]>,
    /// The share of each surface that is there, eight for eight rays. Empty: all of all.
    pub(super) covers: Vec<[f32; 8]>,
    /// How wide each ray is at its surface, eight for eight rays. Empty: no image asks.
    pub(super) widths: Vec<[f32; 8]>,
    /// The lamps that rays see, eight for eight rays. Empty: there are none.
    pub(super) lamps: Vec<Lamps8>,
}

impl Interactions {
    /// Intersects rays with the scene, and begins their radiance with the background and the terms that
    /// need no light. `passed` is how many see-through surfaces are behind the rays. `height` gives the place
    /// in a gradient background, 0 to 1, of a ray that hits nothing.
    pub(super) fn intersect(
        &mut self,
        integrator: &Integrator<'_>,
        rays: &[Rays8],
        paths: &Paths,
        passed: u32,
        height: &dyn Fn(usize, usize) -> f32,
        out: &mut Vec<Radiance8>,
    ) {
        let scene = integrator.scene;
        self.hits.resize(rays.len(), Hits8::NONE);
        self.surfaces.resize(rays.len(), Surfaces8::default());
        self.shading.resize(rays.len(), Shading8::NONE);
        self.made.clear();
        self.covers.clear();
        if scene.has_see_through() {
            self.covers.resize(rays.len(), [1.0; 8]);
        }
        out.resize(rays.len(), Radiance8::NONE);
        scene.intersect_eights(rays, &mut self.hits);
        self.etas.clear();
        match scene.coincidences() {
            None => scene.surface_eights(rays, &self.hits, &mut self.surfaces),
            Some(coincidences) => self.settle(scene, coincidences, rays, &paths.departures),
        }
        self.widths.clear();
        if scene.has_footprints() {
            integrator.measure_widths(rays, &self.hits, paths, &mut self.widths);
        }
        lamps::find(scene, rays, &mut self.hits, &mut self.lamps);
        scene.world().run(BeginRadiance {
            scene,
            lift: integrator.shadows && integrator.terminator,
            height,
            rays,
            interactions: self,
            passed,
            out,
        });
    }

    /// Goes on from the closest hits to what is met first.
    fn settle(
        &mut self,
        scene: &View,
        coincidences: &Coincidences,
        rays: &[Rays8],
        departures: &[Departure],
    ) {
        let Self { hits, surfaces, crossings, etas, .. } = self;
        let rays = crossings.settle(scene, coincidences, rays, departures, hits);
        scene.surface_eights(rays, hits, surfaces);
        etas.resize(rays.len(), [f32::NAN; 8]);
        for (ray, eta, error) in crossings.each() {
            let (i, lane) = (ray / 8, ray % 8);
            set(&mut surfaces[i].p_error, lane, error.to_array());
            surfaces[i].coarse = true;
            etas[i][lane] = eta.unwrap_or(f32::NAN);
        }
    }

    /// What a mirror or glass ray knows of where it starts. A ray that meets another surface at once
    /// starts before the one it crossed.
    pub(super) fn depart(&self, branch: Branch, i: usize, lane: usize, ray: &mut Ray) -> Departure {
        let Some(crossing) = self.crossings.of(i, lane) else { return Departure::default() };
        match branch {
            // A ray that goes straight on is still in what it was in.
            Branch::Reflection | Branch::Through => crossing.reflected(),
            Branch::Transmission => {
                let (departure, starts_before) = crossing.refracted();
                if starts_before {
                    let surface = &self.surfaces[i];
                    let p = DVec3::from_array(surface.p.map(|all| all[lane]));
                    let [error, ng] = [&surface.p_error, &surface.ng].map(|v| get(v, lane).into());
                    ray.origin = offset_origin(p, error, ng, -ray.dir);
                }
                departure
            }
        }
    }

    /// The lamp that a ray sees: the number of its light, and how far it is.
    pub(super) fn lamp(&self, i: usize, lane: usize) -> Option<(usize, f32)> {
        let lamps = self.lamps.get(i).filter(|lamps| lamps.seen >> lane & 1 != 0)?;
        Some((lamps.light[lane] as usize, lamps.t[lane]))
    }

    /// A box around all surfaces, by its middle and half its size; `None`: there are none.
    pub(super) fn bounds(&self) -> Option<[DVec3; 2]> {
        // Lane by lane: straight code, which the compiler makes vector code of.
        let (mut low, mut high) = ([[f64::INFINITY; 8]; 3], [[f64::NEG_INFINITY; 8]; 3]);
        for (hits, surfaces) in self.hits.iter().zip(&self.surfaces) {
            if hits.met == 0 {
                continue;
            }
            for axis in 0..3 {
                let (p, low, high) = (&surfaces.p[axis], &mut low[axis], &mut high[axis]);
                for lane in 0..8 {
                    let is_met = hits.met >> lane & 1 != 0;
                    let least = if is_met { p[lane] } else { f64::INFINITY };
                    let most = if is_met { p[lane] } else { f64::NEG_INFINITY };
                    low[lane] = if least < low[lane] { least } else { low[lane] };
                    high[lane] = if most > high[lane] { most } else { high[lane] };
                }
            }
        }
        let low = DVec3::from(low.map(|all| all.into_iter().fold(f64::INFINITY, f64::min)));
        let high = DVec3::from(high.map(|all| all.into_iter().fold(f64::NEG_INFINITY, f64::max)));
        (low.x <= high.x).then(|| [(low + high) / 2.0, (high - low) / 2.0])
    }

    /// The surface that one ray hit. `materials` are as many as the view has.
    pub(super) fn at(
        &self,
        rays: &[Rays8],
        i: usize,
        lane: usize,
        materials: usize,
    ) -> SurfaceInteraction {
        let (surface, shading) = (&self.surfaces[i], &self.shading[i]);
        let number = shading.material[lane];
        let made = (number as usize).checked_sub(materials).map(|made| &self.made[made]);
        SurfaceInteraction {
            hit: self.hits[i].get(lane),
            material: made.map_or(number, |made| made.number),
            p: DVec3::from_array(surface.p.map(|all| all[lane])),
            p_error: Vec3::from(get(&surface.p_error, lane)),
            ng: direction(&surface.ng, lane),
            n: direction(&shading.n, lane),
            e: -direction(&rays[i].dir, lane),
            color: Rgb::from(get(&shading.color, lane)),
            eta: self.etas.get(i).map(|etas| etas[lane]).filter(|eta| !eta.is_nan()),
            width: self.widths.get(i).map_or(0.0, |widths| widths[lane]),
        }
    }
}

/// To the eyes of eight rays: E.
#[inline(always)]
pub(super) fn to_eye<S: Simd>(simd: S, rays: &Rays8) -> [f32x8<S>; 3] {
    let [x, y, z] = load3(simd, &rays.dir);
    [-x, -y, -z]
}

/// The first of the materials of the surfaces `left`, and which of them have it, a bit each.
#[inline(always)]
pub(super) fn same_material<S: Simd>(simd: S, material: &[u32; 8], left: u32) -> (usize, u32) {
    let number = material[left.trailing_zeros() as usize & 7];
    let all = u32x8::load_array_ref(simd, material);
    let same = all.simd_eq(u32x8::splat(simd, number)).to_bitmask() as u32;
    (number as usize, same & left)
}

/// The material of this number: one of the view's, or one made for surfaces that textures vary.
#[inline(always)]
pub(super) fn material<'m>(
    view: &'m View,
    made: &'m [MadeMaterial],
    number: usize,
) -> &'m Material {
    let own = view.materials();
    own.get(number).unwrap_or_else(|| &made[number - own.len()].material)
}

struct BeginRadiance<'a> {
    scene: &'a View,
    /// Whether shadow rays from smooth meshes start above the face.
    lift: bool,
    height: &'a dyn Fn(usize, usize) -> f32,
    rays: &'a [Rays8],
    interactions: &'a mut Interactions,
    /// How many see-through surfaces are behind the rays.
    passed: u32,
    out: &'a mut [Radiance8],
}

impl Kernel for BeginRadiance<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        /// What lights add to in any case, and the ambient term.
        const LOCAL: TermSet = TermSet::of(&[Term::Ambient, Term::Diffuse, Term::Specular]);
        let Self { scene, lift, height, rays, interactions, passed, out } = self;
        let Interactions { hits, surfaces, shading, made, covers, widths, lamps, .. } =
            interactions;
        let eights = rays.iter().zip(hits).zip(surfaces).zip(shading).zip(out);
        for (i, ((((rays, hits), surface), shading), out)) in eights.enumerate() {
            let met = hits.met;
            let seen = lamps.get(i).map_or(0, |lamps| lamps.seen);
            out.begin(met | seen);
            if let Some(lamps) = lamps.get(i).filter(|lamps| lamps.seen != 0) {
                out.brought = out.brought.with(Term::Emission);
                for lane in lanes(seen) {
                    let number = lamps.light[lane] as usize;
                    let light = &scene.lights()[number];
                    set(&mut out.terms[Term::Emission], lane, light.color().to_array());
                }
            }
            let missed = rays.there & !met & !seen;
            if missed != 0 {
                out.brought = out.brought.with(Term::Background);
                let to = &mut out.terms[Term::Background];
                match (scene.background(), scene.sky()) {
                    (Background::Transparent, _) => {}
                    (_, Some(sky)) => {
                        for lane in lanes(missed) {
                            set(to, lane, sky.radiance(rays.get(lane).dir).to_array());
                        }
                    }
                    (Background::Color(color), None) => {
                        let missed = mask32x8::from_bitmask(simd, missed.into());
                        let black = f32x8::splat(simd, 0.0);
                        let color = splat3(black, color.to_array());
                        *to = store3(select3(missed, color, [black; 3]));
                    }
                    (Background::Gradient { top, bottom }, None) => {
                        for lane in lanes(missed) {
                            let height = height(i, lane);
                            let seen = (1.0 - height) * top + height * bottom;
                            set(to, lane, seen.to_array());
                        }
                    }
                }
            }
            if met == 0 {
                continue;
            }
            let (ng, e) = (load3(simd, &surface.ng), to_eye(simd, rays));
            scene.shading8(simd, hits, ng, e, lift, shading);
            if scene.is_clipped() {
                scene.shade_caps8(hits, &store3(e), shading);
            }
            if scene.has_textures() {
                let met = (rays, &*hits, &*surface);
                scene.vary(simd, met, widths.get(i), shading, made);
            }
            out.brought = out.brought.or(LOCAL);
            let mut left = met;
            while left != 0 {
                let (number, same) = same_material(simd, &shading.material, left);
                left &= !same;
                let material = material(scene, made, number);
                let color = load3(simd, &shading.color);
                let same = mask32x8::from_bitmask(simd, same.into());
                let mut cover = None;
                if let (Some(covers), true) = (covers.get_mut(i), material.is_see_through()) {
                    let n_dot_e = dot(load3(simd, &shading.n), e);
                    let all = f32x8::load_array_ref(simd, covers);
                    let own = same.select(material.cover(n_dot_e, passed), all);
                    *covers = own.into();
                    cover = Some(own);
                }
                let there = |color| cover.map_or(color, |cover| scale(cover, color));
                let own = there(material.ambient_of(color, scene.ambient()));
                add_in(simd, &mut out.terms[Term::Ambient], same, own);
                if material.glows() {
                    out.brought = out.brought.with(Term::Emission);
                    let own = there(material.emission_of(color));
                    add_in(simd, &mut out.terms[Term::Emission], same, own);
                }
            }
        }
    }
}

/// Adds to a sum in the lanes of `same`: 0 in the others, for processors write some lanes of eight slowly.
#[inline(always)]
pub(super) fn add_in<S: Simd>(simd: S, sum: &mut Lanes3, same: mask32x8<S>, more: [f32x8<S>; 3]) {
    let none = f32x8::splat(simd, 0.0);
    *sum = store3(add(load3(simd, sum), select3(same, more, [none; 3])));
}

/// Where a light in direction `l` is above the horizon of `n`.
#[inline(always)]
pub(super) fn is_above<S: Simd>(l: [f32x8<S>; 3], n: [f32x8<S>; 3]) -> mask32x8<S> {
    dot(l, n).simd_gt(f32x8::splat(l[0].token(), 0.0))
}

#[cfg(test)]
mod tests {
    use phong_bvh::{offset_origins, offset_sides, whole};

    use super::*;
    use crate::math::Dir3;

    #[test]
    fn horizons_and_starts_of_eight_have_the_bits_of_one() {
        let simd = fearless_simd::Fallback::new();
        let x = |i: usize, k: usize| ((i * 37 + k * 61) % 83) as f32 / 41.5 - 1.0;
        let dir =
            |i: usize, k: usize| Dir3::new(Vec3::new(x(i, k), x(i, k + 1), x(i, k + 2))).unwrap();
        let mut above = 0;
        for round in 0..40 {
            let mut surface = Surfaces8 { coarse: true, ..Surfaces8::default() };
            let mut shading = Shading8::NONE;
            let (mut rays, mut l) = (Rays8::NONE, [[0.0; 8]; 3]);
            for lane in 0..8 {
                let i = 8 * round + lane;
                // Coordinates that are 0, and normals along an axis, are the odd cases.
                let p = if lane == 0 { [0.0, -0.0, x(i, 2)] } else { [x(i, 1), x(i, 2), 5.0] };
                for (to, from) in surface.p.iter_mut().zip(p) {
                    to[lane] = from.into();
                }
                set(&mut surface.p_error, lane, [1e-7 * x(i, 3).abs(), 0.0, 2e-7]);
                let ng = if lane == 1 { -Dir3::Y } else { dir(i, 4) };
                set(&mut surface.ng, lane, ng.to_array());
                let e = dir(i, 7);
                set(&mut shading.n, lane, dir(i, 5).facing(e).to_array());
                set(&mut shading.front, lane, ng.facing(e).to_array());
                set(&mut rays.dir, lane, (-e).to_array());
                set(&mut l, lane, dir(i, 11).to_array());
            }
            let l8 = load3(simd, &l);
            let (n, front) = (load3(simd, &shading.n), load3(simd, &shading.front));
            let mask = (is_above(l8, n) & is_above(l8, front)).to_bitmask();
            let mut origins = [[0.0; 8]; 3];
            offset_origins(simd, &surface, l8, &mut origins);
            let sides = offset_sides(simd, &surface, front).map(|[low, high]| whole(low, high));
            let interactions = Interactions {
                hits: vec![Hits8::NONE],
                surfaces: vec![surface],
                shading: vec![shading],
                ..Interactions::default()
            };
            for lane in 0..8 {
                let (at, l) = (interactions.at(&[rays], 0, lane, 1), direction(&l, lane));
                let is_above = l.dot(at.n) > 0.0 && l.dot(at.facing_ng()) > 0.0;
                assert_eq!(mask >> lane & 1 != 0, is_above);
                let start = at.spawn(l, 1.0).origin.to_array();
                let origin = origins.map(|all| all[lane]);
                assert_eq!(origin.map(f64::to_bits), start.map(f64::to_bits));
                if is_above {
                    let side = sides.map(|all| all[lane]);
                    assert_eq!(side.map(f64::to_bits), start.map(f64::to_bits));
                }
                above += u32::from(is_above);
            }
        }
        assert!((100..300).contains(&above), "{above}");
    }
}
