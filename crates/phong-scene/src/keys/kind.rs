//! What may stand as a key's value, and what holds if the key is not written.

use super::Table;

/// The largest magnitude of any number in a scene: its square still fits an f32.
pub(crate) const LARGEST: f64 = 1e18;

/// What may stand as a key's value. No number is ever NaN, infinite or beyond [`LARGEST`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// `true` or `false`.
    Flag,
    /// A whole number between two, both included.
    Integer(u64, u64),
    /// A number.
    Number(Range),
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
    /// `[width, height]`, whole numbers from 1 to 1,048,576.
    Size,
    /// `[c, l, q]`, none negative, not all 0.
    Attenuation,
    /// Three points.
    Points,
    /// Three directions.
    Directions,
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
    /// A table.
    Table(&'static Table),
    /// Any number of tables, in order: `[[name]]`.
    Tables(&'static Table),
    /// Tables by names of the user's choosing: `[name.NAME]`.
    Named(&'static Table),
    /// Known, but not built yet.
    NotYet,
}

/// An interval of numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    /// The lower end.
    pub(crate) min: f64,
    /// The upper end.
    pub(crate) max: f64,
    /// Whether `min` itself is in it.
    pub(crate) min_included: bool,
    /// Whether `max` itself is in it.
    pub(crate) max_included: bool,
}

impl Range {
    /// Above 0.
    pub(crate) const POSITIVE: Self =
        Self { min: 0.0, max: LARGEST, min_included: false, max_included: true };
    /// 0 or above.
    pub(crate) const NOT_NEGATIVE: Self = Self::closed(0.0, LARGEST);

    /// From `min` to `max`, both included.
    pub(crate) const fn closed(min: f64, max: f64) -> Self {
        Self { min, max, min_included: true, max_included: true }
    }

    /// From `min` to `max`, neither included.
    pub(crate) const fn open(min: f64, max: f64) -> Self {
        Self { min, max, min_included: false, max_included: false }
    }

    /// From `min`, not included, to `max`, included.
    pub(crate) const fn above(min: f64, max: f64) -> Self {
        Self { min, max, min_included: false, max_included: true }
    }

    /// Whether it holds `v`.
    pub(crate) fn holds(&self, v: f64) -> bool {
        (if self.min_included { v >= self.min } else { v > self.min })
            && (if self.max_included { v <= self.max } else { v < self.max })
    }

    /// What a number in it is: `above 0`, `from 0 to 90`, `above 0 and below 180`.
    pub(crate) fn words(&self) -> String {
        let Self { min, max, min_included, max_included } = *self;
        let lower = if min_included { format!("from {min}") } else { format!("above {min}") };
        match max_included {
            _ if max >= LARGEST && min_included => format!("{min} or above"),
            _ if max >= LARGEST => lower,
            true if min_included => format!("{lower} to {max}"),
            true => format!("{lower} up to {max}"),
            false => format!("{lower} and below {max}"),
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
    /// These three numbers.
    Vector([f64; 3]),
    /// This width and height.
    Size([u32; 2]),
    /// This word.
    Word(&'static str),
    /// What these words say; the reader works it out.
    Said(&'static str),
}
