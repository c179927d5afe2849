//! Fog: what rays bring fades with the way that they went.
//!
//! Each ray fades what it brings by its own way alone, and the rays behind it did so before: together that is
//! the way from the eye.

use phong_bvh::{Rays8, lanes};
use phong_scene::{Background, Rgb};

use super::Paths;
use super::bundle::Radiance8;
use super::interactions::Interactions;
use crate::math::lanes::{direction, set};
use crate::terms::Term;
use crate::view::{Fog, View};
use crate::witness::{Branch, Faded, Witness};

/// A ray's way in fog.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    /// How far from the eye it starts.
    from: f32,
    /// How far from the eye it ends.
    to: f32,
    /// What a scene unit of it counts.
    scale: f32,
}

impl Way {
    /// That of a ray which goes on from the end of this one, before its own end is known.
    pub(super) fn on(&self, branch: Branch) -> Self {
        let scale = if branch == Branch::Through { self.scale } else { 1.0 };
        Self { from: self.to, to: f32::INFINITY, scale }
    }
}

/// Finds out how far rays went: of each in `ways`, by its lane. Those that met nothing went on for ever.
pub(super) fn measure(
    fog: &Fog,
    rays: &[Rays8],
    interactions: &Interactions,
    paths: &Paths,
    ways: &mut Vec<[Way; 8]>,
) {
    ways.clear();
    for (i, (rays, surfaces)) in rays.iter().zip(&interactions.surfaces).enumerate() {
        let mut eight = [Way { from: 0.0, to: f32::INFINITY, scale: 1.0 }; 8];
        for lane in lanes(rays.there) {
            let met = interactions.hits[i].met >> lane & 1 != 0;
            let way = &mut eight[lane];
            if let Some(behind) = paths.ways.get(8 * i + lane) {
                *way = *behind;
                if met {
                    way.to = way.from + interactions.hits[i].get(lane).t * way.scale;
                } else if let Some((_, t)) = interactions.lamp(i, lane) {
                    way.to = way.from + t * way.scale;
                }
            } else if let Some((_, t)) = interactions.lamp(i, lane) {
                let ray = rays.get(lane);
                let p = ray.origin + f64::from(t) * ray.dir.as_dvec3();
                (way.to, way.scale) = fog.distance(p, ray.dir);
            } else if met {
                let p = glam::DVec3::from_array(surfaces.p.map(|all| all[lane]));
                (way.to, way.scale) = fog.distance(p, direction(&rays.dir, lane).to_vec());
            }
        }
        ways.push(eight);
    }
}

/// Fades what rays brought; where the fog `glows`, it adds its own light.
/// Over a transparent background there is no fog where nothing is met.
pub(super) fn fade<W: Witness>(
    view: &View,
    fog: &Fog,
    glows: bool,
    rays: &[Rays8],
    ways: &[[Way; 8]],
    out: &mut [Radiance8],
    witness: &mut W,
) {
    let is_transparent = view.background() == Background::Transparent;
    for ((rays, ways), out) in rays.iter().zip(ways).zip(out) {
        let hidden = if is_transparent { rays.there & out.met } else { rays.there };
        for lane in lanes(hidden) {
            let Way { from, to, .. } = ways[lane];
            let clear = fog.clear(from, to);
            let light = if glows { fog.color * (1.0 - clear) } else { Rgb::BLACK };
            let terms = out.terms.get(lane).behind(clear, light);
            for (term, value) in terms.iter() {
                set(&mut out.terms[term], lane, value.to_array());
            }
            if W::LISTENS {
                witness.faded(&Faded { distance: to, clear, color: fog.color, light });
            }
        }
        out.brought = out.brought.with(Term::Fog);
    }
}
