//! Textures.

use super::fault::Faults;
use super::shape;
use super::value::values;
use crate::limits::LARGEST;
use crate::texture::{MapRange, Texture, TextureKind, TextureSpace};

/// Judges a texture.
pub(crate) fn texture(texture: &Texture, faults: &mut Faults) {
    values(texture, None, faults);
    if let TextureKind::Gradient { from, to, .. } = texture.kind
        && from == to
    {
        faults.say("to", "`to` is where `from` is: the gradient has no length");
    }
    if let TextureKind::Image { border, tint, .. } = &texture.kind {
        faults.color("border", *border, LARGEST);
        faults.color("tint", *tint, LARGEST);
    }
    if let TextureKind::Grid { axes, .. } = texture.kind
        && texture.space == TextureSpace::Uv
        && axes.of(texture.space)[2]
    {
        let message = "`axes` has z, which is 0 everywhere in `uv`: all would be line";
        faults.say("axes", message);
    }
    if let TextureKind::Map { range, nan, axis, .. } = texture.kind {
        faults.color("nan", nan, LARGEST);
        if let Some(axis) = axis {
            faults.direction("axis", axis);
        }
        if let MapRange::Between([low, high]) = range {
            let finite = faults.finite("range", low) && faults.finite("range", high);
            if finite && low == high {
                faults.say("range", "`range` ends where it begins: it has no length");
            }
        }
    }
    shape::transform(&texture.transform, faults);
}
