//! Textures.

use super::fault::Faults;
use super::shape;
use super::value::values;
use crate::limits::LARGEST;
use crate::texture::{Texture, TextureKind};

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
    shape::transform(&texture.transform, faults);
}
