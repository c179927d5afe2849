//! Shadow acne: lit points that lack the light of a lamp, strewn over a surface.

use phong_scene::Rgb;

use super::Prepared;
use super::mistakes::Curve;
use super::picture::{Level, Residual, Theirs, encode, residual};
use super::shade::{Wrong, shade};

/// At least this share of a dark point's lit neighbours is lit: strewn, not a shadow.
const STREWN: f64 = 0.2;
/// Fewer dark points than this share of the picture are no pattern.
const LEAST: f64 = 2e-3;
/// Of a point's lights this many may be missing in any combination.
const MOST_LIGHTS: usize = 5;

/// How far the picture is off if dark points are forgiven, and what they look like; `None` if
/// there is no such pattern.
pub(super) fn look(right: &Prepared, theirs: &Theirs) -> Option<(Residual, String)> {
    let ours: Vec<Rgb> =
        right.points.iter().map(|point| shade(point, &Wrong::default()).total()).collect();
    let differs = |ours: [f32; 3], theirs: [Level; 3]| {
        ours.iter().zip(theirs).any(|(ours, theirs)| theirs.apart(*ours) > Residual::NOTICED)
    };
    // The value a point has with some of its lights missing, if that is what they drew.
    let darkened = |i: usize| -> Option<[f32; 3]> {
        let drawn = theirs.at(i, right.size, None);
        if !right.inner[i] || !differs(encode(ours[i], Curve::Right), drawn) {
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
            let sum = shade(&dark, &Wrong::default());
            let value = encode(sum.total(), Curve::Right);
            (!differs(value, drawn)).then_some(value)
        })
    };
    let dark: Vec<Option<[f32; 3]>> = (0..right.points.len()).map(darkened).collect();
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
    let mended = residual(
        right.size,
        &right.inner,
        |i| dark[i].unwrap_or_else(|| encode(ours[i], Curve::Right)),
        |i| theirs.at(i, right.size, None),
    );
    let seen = format!(
        "{count} lit points lack a light, and {:.0} % of their neighbours do not",
        100.0 * strewn
    );
    Some((mended, seen))
}
