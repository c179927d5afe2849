//! Shadow acne: lit points that lack the light of a lamp, strewn over a surface.

use rayon::prelude::*;

use super::fault::Fault;
use super::picture::{Level, Residual, Theirs};
use super::prepared::Prepared;
use super::shade::shade;
use super::tone::{Tone, encode};

/// At least this share of a dark point's lit neighbours is lit: strewn, not a shadow.
const STREWN: f64 = 0.2;
/// Fewer dark points than this share of the picture are no pattern.
const LEAST: f64 = 2e-3;
/// So many pixels are looked at first.
const SOME: usize = 1000;
/// This share of what is off must be dark points.
const MOST: f64 = 0.9;
/// Of a point's lights this many may be missing in any combination.
const MOST_LIGHTS: usize = 5;

/// The values that lit points have which lack a light, pixel by pixel, and what they look like;
/// `None` if there is no such pattern.
pub(super) type Strewn = (Vec<Option<[f32; 3]>>, String);

/// Looks for points that lack the light of a lamp; `some` pixels say whether that is worth while.
pub(super) fn look(right: &Prepared, theirs: &Theirs, some: &[usize]) -> Option<Strewn> {
    let nothing = Fault::default();
    let differs = |ours: [f32; 3], theirs: [Level; 3]| {
        ours.iter().zip(theirs).any(|(ours, theirs)| theirs.apart(*ours) > Residual::NOTICED)
    };
    // The value a point has with some of its lights missing, if that is what they drew.
    let darkened = |i: usize| -> Option<[f32; 3]> {
        let drawn = theirs.at(i, right.size, None)?;
        if !right.inner[i] || !differs(right.ours[i], drawn) {
            return None;
        }
        let surface = right.points[i].surface.as_ref()?;
        let visible: Vec<usize> =
            (0..surface.lights.len()).filter(|&light| surface.lights[light].visible).collect();
        // Every set of lights that may be missing; more than a few lights are not told apart.
        (1_u32..1 << visible.len().min(MOST_LIGHTS)).find_map(|missing| {
            let mut dark = right.points[i].clone();
            for (bit, &light) in visible.iter().enumerate() {
                if let (Some(surface), true) = (&mut dark.surface, missing >> bit & 1 != 0) {
                    surface.lights[light].visible = false;
                }
            }
            let sum = shade(&dark, &nothing, &right.facts);
            let value = encode(sum.total(), Tone::Right);
            (!differs(value, drawn)).then_some(value)
        })
    };
    let some = &some[..some.len().min(SOME)];
    let off = |&&i: &&usize| {
        theirs.at(i, right.size, None).is_some_and(|drawn| differs(right.ours[i], drawn))
    };
    let off: Vec<usize> = some.iter().filter(off).copied().collect();
    let explained = off.iter().filter(|&&i| darkened(i).is_some()).count();
    if (explained as f64) < MOST * off.len() as f64 {
        return None;
    }
    let dark: Vec<_> = (0..right.points.len()).into_par_iter().map(darkened).collect();
    let count = dark.iter().filter(|dark| dark.is_some()).count();
    let width = right.size[0] as usize;
    let (mut lit, mut neighbours) = (0_u64, 0_u64);
    for i in (0..dark.len()).filter(|&i| dark[i].is_some()) {
        // Inner pixels have all four.
        for j in [i.wrapping_sub(1), i + 1, i.wrapping_sub(width), i + width] {
            if right.inner.get(j) == Some(&true) {
                neighbours += 1;
                lit += u64::from(dark[j].is_none());
            }
        }
    }
    let strewn = lit as f64 / neighbours.max(1) as f64;
    if (count as f64) < LEAST * dark.len() as f64 || strewn < STREWN {
        return None;
    }
    let seen = format!(
        "{count} lit points lack a light, and {:.0} % of their neighbours do not",
        100.0 * strewn
    );
    Some((dark, seen))
}
