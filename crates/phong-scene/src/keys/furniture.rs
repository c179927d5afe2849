//! The keys of what a figure needs beside its picture.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::furniture::{Anchor, Axes, FurnitureStyle, Hidden, Legend, PointLabel, ScaleBar, Title};
use crate::limits::Range;
use crate::wording::Word;

/// Where something stands; what stands at the same place before it is nearer to the edge.
macro_rules! place {
    ($of:ident, $default:literal) => {
        Key::new(
            "place",
            Kind::Word(Anchor::WORDS),
            Default::Word($default),
            "Where on the picture it stands; what stands there already is nearer to the edge.",
        )
        .of(field!($of.place))
    };
}

keyed!(FurnitureStyle, |_| &FURNITURE);

/// `[furniture]`.
pub(crate) static FURNITURE: Table = Table {
    name: "furniture",
    doc: "What title, scale bar, axes, legend and labels have in common. Points are 1/72 of an inch, by the \
          `dpi` of `[image]`.",
    select: None,
    keys: &[&[
        Key::new(
            "size",
            Kind::Number(FurnitureStyle::SIZE),
            Default::Number(9.0),
            "Height of letters, points; a title's are half as high again.",
        )
        .of(field!(FurnitureStyle.size)),
        Key::new(
            "color",
            Kind::Color,
            Default::Said("black or white, whichever stands out from the background"),
            "Colour of letters and lines.",
        )
        .of(field!(FurnitureStyle.color)),
        Key::new(
            "halo",
            Kind::Number(FurnitureStyle::HALO),
            Default::Number(1.0),
            "Width of an edge around letters and lines, points, white around dark ones and black around \
             bright ones; 0: there is none.",
        )
        .of(field!(FurnitureStyle.halo)),
        Key::new(
            "margin",
            Kind::Number(FurnitureStyle::LENGTH),
            Default::Number(9.0),
            "Distance from the edges of the picture, points.",
        )
        .of(field!(FurnitureStyle.margin)),
    ]],
};

keyed!(Title, |_| &TITLE);

/// `[title]`.
pub(crate) static TITLE: Table = Table {
    name: "title",
    doc: "A title, drawn onto the picture when it is done.",
    select: None,
    keys: &[&[
        Key::new("text", Kind::Text, Default::Required, "Its words.").of(field!(Title.text)),
        place!(Title, "top"),
    ]],
};

keyed!(ScaleBar, |_| &SCALE_BAR);

/// `[scale_bar]`.
pub(crate) static SCALE_BAR: Table = Table {
    name: "scale_bar",
    doc: "A bar that shows a length, at the distance of what the camera is focused on (`focus`, else \
          `look_at`): what is nearer looks larger to a perspective camera.",
    select: None,
    keys: &[&[
        Key::new(
            "length",
            Kind::NumberOr(Range::POSITIVE, "auto"),
            Default::Word("auto"),
            "Its length, in its unit. `\"auto\"` is the longest of 1, 2 or 5 times a power of ten that is \
             no more than a quarter of the picture's width.",
        )
        .of(field!(ScaleBar.length)),
        Key::new("unit", Kind::Text, Default::Said("none"), "What is written behind the number.")
            .of(field!(ScaleBar.unit)),
        Key::new(
            "factor",
            Kind::Number(Range::POSITIVE),
            Default::Number(1.0),
            "How many of the unit a scene unit is: 0.1 where a scene is in Å, and the bar is to be in nm.",
        )
        .of(field!(ScaleBar.factor)),
        place!(ScaleBar, "bottom-left"),
    ]],
};

keyed!(Axes, |_| &AXES);

/// `[axes]`.
pub(crate) static AXES: Table = Table {
    name: "axes",
    doc: "Three arrows that show which ways x (red), y (green) and z (blue) point.",
    select: None,
    keys: &[&[
        Key::new(
            "length",
            Kind::Number(FurnitureStyle::SIZE),
            Default::Number(24.0),
            "Length of an arrow that lies in the picture, points.",
        )
        .of(field!(Axes.length)),
        place!(Axes, "bottom-right"),
    ]],
};

keyed!(Legend, |_| &LEGEND);

/// `[legend]`.
pub(crate) static LEGEND: Table = Table {
    name: "legend",
    doc: "What the colours of a map stand for: a bar of them, with numbers beside it.",
    select: None,
    keys: &[&[
        Key::new(
            "texture",
            Kind::Texture,
            Default::Said("the first with a range that a material uses"),
            "The texture whose colours and whose range they are: of kind `map` or `gradient`.",
        )
        .of(field!(Legend.texture)),
        Key::new("map", Kind::Stops, Default::Said("the texture's"), "The colours from 0 to 1.")
            .of(field!(Legend.map)),
        Key::new(
            "from",
            Kind::Number(Range::ANY),
            Default::Said("the texture's, else 0"),
            "What the first colour stands for.",
        )
        .of(field!(Legend.from)),
        Key::new(
            "to",
            Kind::Number(Range::ANY),
            Default::Said("the texture's, else 1"),
            "What the last colour stands for; another number than `from`.",
        )
        .of(field!(Legend.to)),
        Key::new("text", Kind::Text, Default::Said("what the texture is of"), "What is measured.")
            .of(field!(Legend.text)),
        Key::new("unit", Kind::Text, Default::Said("the texture's"), "In which unit.")
            .of(field!(Legend.unit)),
        Key::new(
            "ticks",
            Kind::Integer(2, Legend::MOST_TICKS),
            Default::Integer(5),
            "About how many numbers stand beside it; they are round ones.",
        )
        .of(field!(Legend.ticks)),
        place!(Legend, "right"),
    ]],
};

keyed!(PointLabel, |_| &LABEL);

/// `[[label]]`.
pub(crate) static LABEL: Table = Table {
    name: "label",
    doc: "Words at a point of the scene. Of a part of the picture, those that can be hidden are drawn where \
          their point lies in the part.",
    select: None,
    keys: &[&[
        Key::new("text", Kind::Text, Default::Required, "The words.").of(field!(PointLabel.text)),
        Key::new("at", Kind::Point, Default::Required, "The point.").of(field!(PointLabel.at)),
        Key::new(
            "hidden",
            Kind::Word(Hidden::WORDS),
            Default::Word("behind"),
            "Whether they are hidden where something stands before the point, or never.",
        )
        .of(field!(PointLabel.hidden)),
        Key::new(
            "radius",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Number(0.0),
            "How far before the point something may stand without hiding it, in scene units: the radius \
             of the ball whose middle the point is.",
        )
        .of(field!(PointLabel.radius)),
        Key::new(
            "offset",
            Kind::Pair,
            Default::Pair([0.0, 0.0]),
            "How far from the point they begin, points, to the right and up; to the left (below 0) they \
             end there, and at 0 they are over its middle.",
        )
        .of(field!(PointLabel.offset)),
    ]],
};
