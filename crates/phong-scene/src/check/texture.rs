//! Textures.

use super::fault::Faults;
use super::shape;
use crate::limits::{LARGEST, Range};
use crate::texture::{Texture, TextureKind};

/// Judges a texture.
pub(crate) fn texture(texture: &Texture, faults: &mut Faults) {
    match &texture.kind {
        TextureKind::Checker { colors, scale } => {
            for &color in colors {
                faults.color("colors", color, LARGEST);
            }
            faults.number("scale", *scale, &Range::POSITIVE);
        }
        TextureKind::Gradient { axis, from, to, stops } => {
            faults.direction("axis", *axis);
            let ends = faults.finite("from", *from) & faults.finite("to", *to);
            if ends && from == to {
                faults.say("to", "`to` is where `from` is: the gradient has no length");
            }
            if stops.is_empty() {
                faults.say("stops", "`stops` is empty; a gradient has at least one stop");
            }
            let mut before = 0.0;
            for &(t, color) in stops {
                faults.color("stops", color, LARGEST);
                if !(0.0..=1.0).contains(&t) {
                    faults.say("stops", format!("`stops` have t from 0 to 1; this is {t}"));
                } else if t < before {
                    let message = format!("`stops` must not fall: {t} comes after {before}");
                    faults.say("stops", message);
                } else {
                    before = t;
                }
            }
        }
    }
    shape::transform(&texture.transform, faults);
}
