//! What may stand as a key's value, and what holds if the key is not written.

use std::fmt;

use super::Table;
use crate::color::maps;
use crate::limits::Range;
use crate::scene::Image;
use crate::wording::list;

/// What may stand as a key's value. No number is ever NaN, infinite or beyond `LARGEST`.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// `true` or `false`.
    Flag,
    /// A whole number between two, both included.
    Integer(u64, u64),
    /// A number.
    Number(Range),
    /// A number, or this word.
    NumberOr(Range, &'static str),
    /// `[x, y, z]`, any three numbers.
    Point,
    /// `[x, y, z]`, not all 0.
    Direction,
    /// A number (grey), `[r, g, b]` (linear), `"#rrggbb"` or a CSS name (sRGB); none negative.
    Color,
    /// As [`Kind::Color`], with no channel above 1.
    Reflectance,
    /// As [`Kind::Color`], or `"object"`: the object's own colour.
    ColorOrObject,
    /// A colour, `"transparent"`, or a table `{ top, bottom }`.
    Background,
    /// One of these words.
    Word(&'static [&'static str]),
    /// Free text, not empty.
    Text,
    /// The path of a file, relative to the folder of the file that names it.
    File,
    /// The name of a material.
    Material,
    /// The name of a group.
    Group,
    /// The name of a texture.
    Texture,
    /// What only a texture can give.
    Map,
    /// `[width, height]`, whole numbers from 1 to 1,048,576.
    Size,
    /// `[c, l, q]`, none negative, not all 0.
    Attenuation,
    /// Three points.
    Points,
    /// Three directions.
    Directions,
    /// `[x, y]`, any two numbers.
    Pair,
    /// Three `[u, v]`.
    Uvs,
    /// `true`, `false`, or an angle in degrees between 0 and 180.
    Smooth,
    /// A number or `[x, y, z]`, none 0.
    Scale,
    /// `[ax, ay, az, degrees]`, or a list of them.
    Rotate,
    /// Four rows of four numbers, applied to column vectors; the last row is `[0, 0, 0, 1]`.
    Matrix,
    /// Two colours.
    TwoColors,
    /// A list of `[t, colour]`, t from 0 to 1 and never falling, at least one; or the name of a colour map.
    Stops,
    /// A table.
    Table(&'static Table),
    /// Any number of tables, in order: `[[name]]`.
    Tables(&'static Table),
    /// Tables by names of the user's choosing: `[name.NAME]`.
    Named(&'static Table),
    /// `true`, `false`, or the name of a material.
    Cap,
    /// A list of names, at least one.
    Names,
    /// A path, or a list of paths; parts of names may be left open.
    Files,
    /// A number, or a list of numbers.
    Numbers,
    /// Three whole numbers, each from 1 to so many.
    Counts(u32),
    /// `[low, high]`, two numbers that differ, or "auto".
    Interval,
    /// Values by the path of a scene's key.
    Values,
    /// Options of another program, by its own words.
    Options,
}

impl Kind {
    /// What a value of this kind is, as the end of "it must be …".
    pub(crate) fn words(self) -> String {
        match self {
            Self::Flag => "`true` or `false`".to_owned(),
            Self::Integer(min, max) if max == u64::MAX => {
                format!("a whole number, {min} or above")
            }
            Self::Integer(min, max) if min == max => min.to_string(),
            Self::Integer(min, max) => format!("a whole number from {min} to {max}"),
            Self::Number(range) if range.is_any() => "a number".to_owned(),
            Self::Number(range) => format!("a number {}", range.words()),
            Self::NumberOr(range, word) => format!("a number {}, or \"{word}\"", range.words()),
            Self::Point => "three numbers, `[x, y, z]`".to_owned(),
            Self::Pair => "two numbers, `[x, y]`".to_owned(),
            Self::Direction => "three numbers, `[x, y, z]`, not all 0".to_owned(),
            Self::Color | Self::Reflectance => {
                "a colour: a number, `[r, g, b]`, \"#rrggbb\" or a CSS name".to_owned()
            }
            Self::ColorOrObject => {
                "a colour (a number, `[r, g, b]`, \"#rrggbb\", a CSS name) or \"object\"".to_owned()
            }
            Self::Background => {
                "a colour, \"transparent\", or `{ top = .., bottom = .. }`".to_owned()
            }
            Self::Word(words) => list(words.iter().copied(), "or"),
            Self::Text => "text".to_owned(),
            Self::File => "the path of a file, in quotes".to_owned(),
            Self::Material => "the name of a material, in quotes".to_owned(),
            Self::Group => "the name of a group, in quotes".to_owned(),
            Self::Texture => "the name of a texture, in quotes".to_owned(),
            Self::Map => "a table `{ texture = .. }`".to_owned(),
            Self::Size => {
                format!("`[width, height]`, whole numbers from 1 to {}", Image::LARGEST)
            }
            Self::Attenuation => "`[c, l, q]`, 0 or above, not all 0".to_owned(),
            Self::Points => "three points, `[[x, y, z], [x, y, z], [x, y, z]]`".to_owned(),
            Self::Directions => "three directions, `[[x, y, z], [x, y, z], [x, y, z]]`".to_owned(),
            Self::Uvs => "three pairs, `[[u, v], [u, v], [u, v]]`".to_owned(),
            Self::Smooth => "`true`, `false` or an angle from 0 to 180 degrees".to_owned(),
            Self::Scale => "a number or `[x, y, z]`, none 0".to_owned(),
            Self::Rotate => "`[ax, ay, az, degrees]`, or a list of them".to_owned(),
            Self::Matrix => "four rows of four numbers".to_owned(),
            Self::TwoColors => "two colours, `[A, B]`".to_owned(),
            Self::Stops => format!(
                "a list of `[t, colour]`, t from 0 to 1 and never falling, or a colour map: {}",
                list(maps::NAMES.into_iter(), "or")
            ),
            Self::Table(_) => "a table".to_owned(),
            Self::Tables(_) => "a list of tables".to_owned(),
            Self::Named(_) => "tables by name".to_owned(),
            Self::Cap => "`true`, `false` or the name of a material, in quotes".to_owned(),
            Self::Names => "a list of names, in quotes".to_owned(),
            Self::Files => "the path of a file or a list of paths, in quotes".to_owned(),
            Self::Numbers => "a number or a list of numbers".to_owned(),
            Self::Counts(most) => format!("`[a, b, c]`, whole numbers from 1 to {most}"),
            Self::Interval => "two numbers, `[low, high]`, or \"auto\"".to_owned(),
            Self::Values => "lists of values by the path of a key".to_owned(),
            Self::Options => "words and numbers by name".to_owned(),
        }
    }
}

/// What holds if a key is not written.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Default {
    /// That is an error.
    Required,
    /// This truth value.
    Flag(bool),
    /// This whole number.
    Integer(u64),
    /// This number; for a colour, this grey.
    Number(f64),
    /// These two numbers.
    Pair([f64; 2]),
    /// These three numbers.
    Vector([f64; 3]),
    /// This width and height.
    Size([u32; 2]),
    /// This word.
    Word(&'static str),
    /// What these words say; the reader works it out.
    Said(&'static str),
}

impl fmt::Display for Default {
    /// As it would be written in the text, or in words.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Required => f.write_str("required"),
            Self::Flag(flag) => write!(f, "`{flag}`"),
            Self::Integer(n) => write!(f, "`{n}`"),
            Self::Number(n) => write!(f, "`{n}`"),
            Self::Pair([x, y]) => write!(f, "`[{x}, {y}]`"),
            Self::Vector([x, y, z]) => write!(f, "`[{x}, {y}, {z}]`"),
            Self::Size([w, h]) => write!(f, "`[{w}, {h}]`"),
            Self::Word(word) => write!(f, "`\"{word}\"`"),
            Self::Said(words) => f.write_str(words),
        }
    }
}
