//! The keys of tone.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::limits::Range;
use crate::tone::{Tone, ToneCurve};
use crate::wording::Word;

keyed!(Tone, |_| &TONE);

/// `[tone]`.
pub(crate) static TONE: Table = Table {
    name: "tone",
    doc: "How light becomes what a PNG shows: exposure, white balance and a curve, in this order, before the \
          sRGB curve. EXR and PFM hold the light as it is.",
    select: Some("curve"),
    keys: &[&[
        Key::new(
            "exposure",
            Kind::NumberOr(Tone::EXPOSURE, "auto"),
            Default::Number(0.0),
            "Stops by which the picture is made brighter: each doubles the light. `\"auto\"` makes the \
             geometric mean luminance of what is lit 0.18.",
        )
        .of(field!(Tone.exposure)),
        Key::new(
            "white_balance",
            Kind::Number(Tone::WHITE_BALANCE),
            Default::Said("none"),
            "Colour temperature of the light that is to look white, kelvin.",
        )
        .of(field!(Tone.white_balance)),
        Key::new(
            "neutral",
            Kind::Color,
            Default::Said("none"),
            "The colour that is to look grey, in place of `white_balance`.",
        )
        .of(field!(Tone.neutral)),
        Key::new(
            "curve",
            Kind::Word(ToneCurve::WORDS),
            Default::Word("clamp"),
            "How light beyond white is brought into the range of a display.",
        )
        .of(field!(Tone.curve)),
        Key::new(
            "white",
            Kind::Number(Range::POSITIVE),
            Default::Number(4.0),
            "The luminance that becomes white.",
        )
        .of(field!(Tone.curve = ToneCurve::{Reinhard}.white))
        .only(&["reinhard"]),
    ]],
};
