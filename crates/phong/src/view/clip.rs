//! What is cut away of a view's objects: a ray goes on from a hit that is cut away, and meets a cap where it
//! comes out of what is cut away inside something closed.
//!
//! Each clip takes one stretch of a ray, or all but one. It is found in f64 and rounded once, so that hits
//! and caps are held against the same numbers. Whether the end of a stretch is inside an object is counted
//! on the rest of the very ray: of a mesh the crossings, outwards less inwards; of anything else whether
//! it is left where it is met next.

mod stretch;

use std::cmp::Reverse;

use glam::{DVec3, Vec2, Vec3};
use phong_bvh::{Coordinates, Hit, Hits8, Primitives, Ray, Rays8, Surface, Surfaces8, lanes};
use phong_scene::{Cap, Clip};

use super::View;
use crate::geometry::Geometry;
use crate::math::Dir3;
use crate::math::lanes::set;
use stretch::{Along, Stretch};

/// Up to so many surfaces that are cut away are passed on the way to one that is not.
const MOST_PASSED: usize = 100_000;

/// Crossings of a mesh no farther apart than this, in their distance, are one: through an edge that two
/// faces share.
const SAME: f32 = 4.0 * f32::EPSILON;

/// What is cut away.
#[derive(Clone, Debug)]
pub(crate) struct Clipping {
    cuts: Vec<Cut>,
    /// The cuts that each object knows, a bit each.
    of_object: Vec<u32>,
    /// The cuts that all objects know.
    of_all: u32,
    /// Whether any of them shows what closed objects are filled with.
    has_caps: bool,
}

#[derive(Clone, Debug)]
struct Cut {
    along: Along,
    cap: Cap,
}

/// What the cuts take of one ray.
struct Taken {
    stretches: [Stretch; Clip::MOST],
    count: usize,
}

impl Taken {
    /// The cuts among `known` that take what is at this distance.
    fn at(&self, t: f32, known: u32) -> u32 {
        lanes(known).filter(|&cut| self.stretches[cut].takes(t)).fold(0, |all, cut| all | 1 << cut)
    }

    fn all(&self) -> &[Stretch] {
        &self.stretches[..self.count]
    }

    /// Whether they take anything of a ray between its ends.
    fn touches(&self, ray: &Ray) -> bool {
        self.all().iter().any(|stretch| stretch.touches(ray.t_min, ray.t_max))
    }
}

/// The number of the cut, and of its face, at whose cap a ray was met; `None`: at a surface.
///
/// A cap's hit names what is inside, and says so by a first coordinate that no surface has; the second one
/// is the first of the surface beyond.
#[inline]
pub(crate) fn cap_of(hit: &Hit) -> Option<(usize, usize)> {
    (hit.u < -0.5).then(|| {
        let code = (-hit.u - 1.0) as usize;
        (code / 8, code % 8)
    })
}

/// The hit of a cap at a distance, inside what is met at `beyond`.
fn cap_hit(t: f32, cut: usize, face: usize, beyond: &Hit) -> Hit {
    Hit { t, u: -1.0 - (8 * cut + face) as f32, v: beyond.u, ..*beyond }
}

impl Clipping {
    /// That of these clips; `None`: nothing is cut away.
    pub(super) fn of(clips: &[Clip], geometry: &Geometry) -> Option<Self> {
        if clips.is_empty() {
            return None;
        }
        let clips = &clips[..clips.len().min(Clip::MOST)];
        let cuts: Vec<_> =
            clips.iter().map(|clip| Cut { along: Along::of(&clip.kind), cap: clip.cap }).collect();
        let cut_objects: Vec<_> = clips.iter().map(Clip::cut_objects).collect();
        let known = |name: &str| {
            let cut_by = cut_objects.iter().enumerate().filter(|(_, cut)| cut.has(name));
            cut_by.fold(0, |all, (number, _)| all | 1 << number)
        };
        let of_object: Vec<u32> =
            geometry.objects().iter().map(|object| known(&object.name)).collect();
        let of_all = of_object.iter().fold(u32::MAX, |all, own| all & own);
        let has_caps = cuts.iter().any(|cut| cut.cap != Cap::Open);
        Some(Self { cuts, of_object, of_all, has_caps })
    }

    fn take(&self, ray: &Ray) -> Taken {
        let mut taken = Taken { stretches: [Stretch::NONE; Clip::MOST], count: self.cuts.len() };
        for (stretch, cut) in taken.stretches.iter_mut().zip(&self.cuts) {
            *stretch = cut.along.stretch(ray);
        }
        taken
    }

    /// What a ray meets first, given the closest hit of all.
    fn first(&self, view: &View, ray: &Ray, closest: Hit, found: &mut Vec<Hit>) -> Hit {
        let taken = self.take(ray);
        if !taken.touches(ray) {
            return closest;
        }
        let kept = self.kept(view, ray, closest, &taken, found);
        let mut caps = Vec::new();
        self.caps(view, &Ray { t_max: kept.t.min(ray.t_max), ..*ray }, &taken, found, &mut caps);
        caps.first().copied().unwrap_or(kept)
    }

    /// The closest hit that is not cut away.
    fn kept(
        &self,
        view: &View,
        ray: &Ray,
        closest: Hit,
        taken: &Taken,
        found: &mut Vec<Hit>,
    ) -> Hit {
        let mut hit = closest;
        for _ in 0..MOST_PASSED {
            if !hit.is_some() {
                return Hit::NONE;
            }
            let by = taken.at(hit.t, self.of_object[view.object(&hit) as usize]);
            if by == 0 {
                return hit;
            }
            // Where all objects are cut away the ray goes on to where that ends.
            let ends = lanes(by & self.of_all).map(|cut| taken.stretches[cut].end_after(hit.t));
            let mut t_min = ends.fold(hit.t, f32::max);
            if t_min == hit.t {
                // What else is met there may not be cut away.
                let there = Ray { t_min: hit.t.next_down(), t_max: hit.t.next_up(), ..*ray };
                view.world().every(&there, found);
                let is_kept = |other: &&Hit| {
                    let known = self.of_object[view.object(other) as usize];
                    other.t == hit.t && taken.at(other.t, known) == 0
                };
                if let Some(other) = found.iter().find(is_kept) {
                    return *other;
                }
                t_min = hit.t;
            }
            if t_min >= ray.t_max {
                return Hit::NONE;
            }
            hit = view.world().intersect(&Ray { t_min, ..*ray });
        }
        Hit::NONE
    }

    /// The caps that a ray meets nearest between its ends: of all closed objects that it is in there, in the
    /// order in which they count.
    fn caps(
        &self,
        view: &View,
        ray: &Ray,
        taken: &Taken,
        found: &mut Vec<Hit>,
        caps: &mut Vec<Hit>,
    ) {
        caps.clear();
        if !self.has_caps {
            return;
        }
        let mut ends: Vec<(f32, usize, usize)> = Vec::new();
        for (number, (stretch, cut)) in taken.all().iter().zip(&self.cuts).enumerate() {
            if let (Some((t, face)), true) = (stretch.comes_out(), cut.cap != Cap::Open)
                && ray.t_min < t
                && t < ray.t_max
            {
                ends.push((t, number, face));
            }
        }
        ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (t, cut, face) in ends {
            view.world().every(&Ray { t_min: t, t_max: f32::INFINITY, ..*ray }, found);
            let at = |hit: &Hit| cap_hit(t, cut, face, hit);
            let known = |hit: &&Hit| {
                let own = self.of_object[view.object(hit) as usize];
                own >> cut & 1 != 0 && taken.at(t, own & !(1 << cut)) == 0
            };
            let beyond: Vec<Hit> = found.iter().filter(known).copied().collect();
            caps.extend(surrounding(view, ray, &beyond).iter().map(at));
            if !caps.is_empty() {
                caps.sort_by_key(|hit| {
                    let material = &view.materials()[view.material_of(hit) as usize];
                    (
                        Reverse(material.priority),
                        !material.transmission.is_black(),
                        hit.part,
                        hit.prim,
                    )
                });
                return;
            }
        }
    }
}

/// Of what a ray meets beyond a point: the surfaces by which it leaves the closed things that the point is in.
fn surrounding(view: &View, ray: &Ray, beyond: &[Hit]) -> Vec<Hit> {
    let mut left = Vec::new();
    // Of meshes every crossing: the object, the distance, 1 outwards and −1 inwards.
    let mut crossings: Vec<(u32, f32, i32, Hit)> = Vec::new();
    for hit in beyond {
        let object = view.object(hit);
        if !view.geometry().is_closed(object) {
            continue;
        }
        let out = view.world().surface(ray, hit).ng.dot(ray.dir) > 0.0;
        let facets = view.geometry().corners(hit.part, hit.prim).is_some();
        if facets || matches!(view.world().primitives(hit.part), Primitives::Triangles { .. }) {
            crossings.push((object, hit.t, if out { 1 } else { -1 }, *hit));
        } else if out {
            left.push(*hit);
        }
    }
    crossings.sort_by(|a, b| (a.0, a.2).cmp(&(b.0, b.2)).then(a.1.total_cmp(&b.1)));
    crossings.dedup_by(|b, a| (a.0, a.2) == (b.0, b.2) && b.1 - a.1 <= SAME * b.1);
    for of_object in crossings.chunk_by(|a, b| a.0 == b.0) {
        let sum: i32 = of_object.iter().map(|crossing| crossing.2).sum();
        let first = of_object.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        left.extend(first.filter(|_| sum != 0).map(|first| first.3));
    }
    left
}

impl View {
    /// What a ray meets first: [`World::intersect`](phong_bvh::World::intersect), but for what is cut away.
    pub fn intersect(&self, ray: &Ray) -> Hit {
        self.first_kept(ray, self.world().intersect(ray), &mut Vec::new())
    }

    /// The same, given the closest hit of all that there is.
    pub(crate) fn first_kept(&self, ray: &Ray, closest: Hit, found: &mut Vec<Hit>) -> Hit {
        match &self.clipping {
            None => closest,
            Some(clipping) => clipping.first(self, ray, closest, found),
        }
    }

    /// What each ray of a bundle meets first.
    pub(crate) fn intersect_eights(&self, rays: &[Rays8], hits: &mut [Hits8]) {
        self.world().intersect_eights(rays, hits);
        let Some(clipping) = &self.clipping else { return };
        let mut found = Vec::new();
        for (rays, hits) in rays.iter().zip(hits) {
            for lane in lanes(rays.there) {
                let (ray, closest) = (rays.get(lane), hits.get(lane));
                // What is not met may still be a cap that the ray starts behind.
                let closest = if hits.met >> lane & 1 == 0 { Hit::NONE } else { closest };
                hits.set(lane, clipping.first(self, &ray, closest, &mut found));
            }
        }
    }

    /// Which rays of a bundle meet anything, a bit each.
    pub(crate) fn occluded_eights(&self, rays: &[Rays8], blocked: &mut [u32]) {
        self.world().occluded_eights(rays, blocked);
        self.clip_occluded(rays, blocked);
    }

    /// [`View::occluded_eights`] of rays that start close together and go everywhere.
    pub(crate) fn occluded_scattered(&self, rays: &[Rays8], blocked: &mut [u32]) {
        self.world().occluded_scattered(rays, blocked);
        self.clip_occluded(rays, blocked);
    }

    /// Corrects what is said of rays that meet what is cut away, or a cap.
    fn clip_occluded(&self, rays: &[Rays8], blocked: &mut [u32]) {
        let Some(clipping) = &self.clipping else { return };
        let mut found = Vec::new();
        for (rays, blocked) in rays.iter().zip(blocked) {
            for lane in lanes(rays.there) {
                let (ray, bit) = (rays.get(lane), 1 << lane);
                let meets = *blocked & bit != 0;
                if !(meets || clipping.has_caps) || !clipping.take(&ray).touches(&ray) {
                    continue;
                }
                let closest = if meets { self.world().intersect(&ray) } else { Hit::NONE };
                let is_met = clipping.first(self, &ray, closest, &mut found).is_some();
                *blocked = *blocked & !bit | u32::from(is_met) << lane;
            }
        }
    }

    /// Every surface that a ray meets: [`World::every`](phong_bvh::World::every), but for what is cut
    /// away, and with the caps that it meets nearest.
    pub(crate) fn every(&self, ray: &Ray, found: &mut Vec<Hit>) {
        self.world().every(ray, found);
        let Some(clipping) = &self.clipping else { return };
        let taken = clipping.take(ray);
        if !taken.touches(ray) {
            return;
        }
        found.retain(|hit| {
            let known = clipping.of_object[self.object(hit) as usize];
            taken.at(hit.t, known) == 0
        });
        let mut caps = Vec::new();
        clipping.caps(self, ray, &taken, &mut Vec::new(), &mut caps);
        found.append(&mut caps);
    }

    /// The surface at a hit of `ray`, or the cap.
    pub(crate) fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        match self.cap_surface(ray, hit) {
            Some(surface) => surface,
            None => self.world().surface(ray, hit),
        }
    }

    /// [`View::surface`] of a bundle.
    pub(crate) fn surface_eights(&self, rays: &[Rays8], hits: &[Hits8], to: &mut [Surfaces8]) {
        self.world().surface_eights(rays, hits, to);
        if self.clipping.is_none() {
            return;
        }
        for ((rays, hits), to) in rays.iter().zip(hits).zip(to) {
            for lane in lanes(hits.met) {
                let Some(cap) = self.cap_surface(&rays.get(lane), &hits.get(lane)) else {
                    continue;
                };
                for axis in 0..3 {
                    to.p[axis][lane] = cap.p[axis];
                }
                set(&mut to.p_error, lane, cap.p_error.to_array());
                set(&mut to.ng, lane, cap.ng.to_array());
                to.coarse = true;
            }
        }
    }

    fn cap_surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        let clipping = self.clipping.as_ref()?;
        let (cut, face) = cap_of(hit)?;
        let along = &clipping.cuts[cut].along;
        let p = along.onto(face, ray.origin + f64::from(hit.t) * ray.dir.as_dvec3());
        // It is on the cut to f64; a ray that leaves it must leave it in f32.
        let p_error = (p.abs().as_vec3() + Vec3::splat(hit.t)) * (4.0 * f32::EPSILON);
        Some(Surface { p, p_error, ng: along.normal(face).as_vec3() })
    }

    /// The number of the clip, from 0, at whose cap a ray was met; `None`: at a surface.
    pub(crate) fn cap(&self, hit: &Hit) -> Option<usize> {
        self.clipping.as_ref().and(cap_of(hit)).map(|(cut, _)| cut)
    }

    /// The number of the material at a hit, caps included.
    pub(crate) fn material_of(&self, hit: &Hit) -> u32 {
        let own = || self.geometry.batch(hit.part).material(hit.prim);
        self.cap_material(hit).unwrap_or_else(own)
    }

    /// The material of a cap that is not of the object's own; `None`: the object's.
    pub(super) fn cap_material(&self, hit: &Hit) -> Option<u32> {
        let clipping = self.clipping.as_ref()?;
        match clipping.cuts[cap_of(hit)?.0].cap {
            Cap::Of(material) => Some(material.0),
            _ => None,
        }
    }

    /// Where on a cap a hit of `ray` is; `None`: it is at a surface.
    pub(super) fn cap_coordinates(&self, ray: &Ray, hit: &Hit) -> Option<Coordinates> {
        let Surface { p, ng, .. } = self.cap_surface(ray, hit)?;
        let (u, v): (DVec3, DVec3) = ng.as_dvec3().any_orthonormal_pair();
        Some(Coordinates { uv: Vec2::new(p.dot(u) as f32, p.dot(v) as f32), tangent: u.as_vec3() })
    }

    /// The normal of a cap on the side that faces the eye; `None`: it is a surface.
    pub(super) fn cap_normal(&self, hit: &Hit, e: Dir3) -> Option<Dir3> {
        let clipping = self.clipping.as_ref()?;
        let (cut, face) = cap_of(hit)?;
        let normal = clipping.cuts[cut].along.normal(face).as_vec3();
        Some(Dir3::from_unit(normal).facing(e))
    }
}
