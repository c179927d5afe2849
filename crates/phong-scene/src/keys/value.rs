//! Values of keys, and what types of the scene hold them.

use glam::{DAffine3, DVec2, DVec3, DVec4};

use crate::ambient_occlusion::OcclusionDistance;
use crate::color::Rgb;
use crate::furniture::BarLength;
use crate::scene::Background;
use crate::texture::{MapRange, Param, TextureRef};
use crate::tone::Exposure;
use crate::wording::Word;

/// The value of a key, read or to be written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Flag(bool),
    Integer(u64),
    Number(f64),
    Vector(DVec3),
    Vectors([DVec3; 3]),
    Pair(DVec2),
    Uvs([DVec2; 3]),
    Rotations(Vec<DVec4>),
    Matrix(DAffine3),
    Size([u32; 2]),
    Color(Rgb),
    Background(Background),
    Word(&'static str),
    Text(String),
    Colors([Rgb; 2]),
    Stops(Vec<(f32, Rgb)>),
    Textured(TextureRef),
    Texts(Vec<(String, std::ops::Range<usize>)>),
    Numbers(Vec<f64>),
}

/// What the value of a key is kept as.
pub(crate) trait Stored: Sized {
    /// It as a value; `None`: the key is not written.
    fn value(&self) -> Option<Value>;

    /// What a value is kept as; `None`: it is none of this kind.
    fn of(value: Value) -> Option<Self>;
}

macro_rules! stored {
    ($($type:ty: $kind:ident, $to:expr, $of:expr;)+) => {$(
        impl Stored for $type {
            fn value(&self) -> Option<Value> {
                let to: fn(&Self) -> _ = $to;
                Some(Value::$kind(to(self)))
            }

            fn of(value: Value) -> Option<Self> {
                let Value::$kind(value) = value else { return None };
                let of: fn(_) -> Self = $of;
                Some(of(value))
            }
        }
    )+};
}

stored! {
    bool: Flag, |flag| *flag, |flag| flag;
    u64: Integer, |n| *n, |n| n;
    u32: Integer, |n| (*n).into(), |n: u64| n as u32;
    f64: Number, |x| *x, |x| x;
    f32: Number, |x| short(*x), |x: f64| x as f32;
    DVec3: Vector, |v| *v, |v| v;
    [f64; 3]: Vector, |v| (*v).into(), |v: DVec3| v.to_array();
    [DVec3; 3]: Vectors, |v| *v, |v| v;
    DVec2: Pair, |v| *v, |v| v;
    [DVec2; 3]: Uvs, |v| *v, |v| v;
    [u32; 2]: Size, |size| *size, |size| size;
    Rgb: Color, |color| *color, |color| color;
    [Rgb; 2]: Colors, |colors| *colors, |colors| colors;
    Vec<(f32, Rgb)>: Stops, Clone::clone, |stops| stops;
    String: Text, Clone::clone, |text| text;
    TextureRef: Textured, |by| *by, |by| by;
}

impl<W: Word> Stored for W {
    fn value(&self) -> Option<Value> {
        Some(Value::Word(self.word()))
    }

    fn of(value: Value) -> Option<Self> {
        let Value::Word(word) = value else { return None };
        Self::of_word(word)
    }
}

impl<T: Stored> Stored for Option<T> {
    /// `None` is not written.
    fn value(&self) -> Option<Value> {
        self.as_ref().and_then(T::value)
    }

    fn of(value: Value) -> Option<Self> {
        T::of(value).map(Some)
    }
}

impl<T: Stored> Stored for Param<T> {
    fn value(&self) -> Option<Value> {
        match self {
            Self::Constant(value) => value.value(),
            Self::Textured(by) => Some(Value::Textured(*by)),
        }
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Textured(by) => Some(Self::Textured(by)),
            value => T::of(value).map(Self::Constant),
        }
    }
}

impl Stored for Background {
    fn value(&self) -> Option<Value> {
        Some(match *self {
            Self::Color(color) => Value::Color(color),
            other => Value::Background(other),
        })
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Color(color) => Some(Self::Color(color)),
            Value::Background(background) => Some(background),
            _ => None,
        }
    }
}

impl Stored for MapRange {
    fn value(&self) -> Option<Value> {
        Some(match self {
            Self::Auto => Value::Word("auto"),
            Self::Between(range) => Value::Numbers(range.to_vec()),
        })
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Word(_) => Some(Self::Auto),
            Value::Numbers(range) => range.try_into().ok().map(Self::Between),
            _ => None,
        }
    }
}

/// What is `"auto"` or a number.
macro_rules! stored_or_auto {
    ($($type:ident: $of:ident;)+) => {$(
        impl Stored for $type {
            fn value(&self) -> Option<Value> {
                Some(match *self {
                    Self::Auto => Value::Word("auto"),
                    Self::$of(number) => Value::Number(number),
                })
            }

            fn of(value: Value) -> Option<Self> {
                match value {
                    Value::Word(_) => Some(Self::Auto),
                    Value::Number(number) => Some(Self::$of(number)),
                    _ => None,
                }
            }
        }
    )+};
}

stored_or_auto! {
    OcclusionDistance: Units;
    BarLength: Units;
    Exposure: Stops;
}

/// An f32 as the number of fewest digits that is rounded to it.
pub(crate) fn short(x: f32) -> f64 {
    let text = x.to_string().parse();
    text.ok().filter(|&n: &f64| (n as f32).to_bits() == x.to_bits()).unwrap_or_else(|| x.into())
}

/// Degrees of few digits that are turned into these very radians.
pub(super) fn degrees(radians: f32) -> f64 {
    let exact = f64::from(radians).to_degrees();
    let same = |degrees: &f64| degrees.to_radians() as f32 == radians;
    let rounded = (0..17).filter_map(|digits| format!("{exact:.digits$}").parse().ok());
    rounded.into_iter().find(same).unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_come_back_as_they_were_written() {
        for written in [0.0, 20.0, 33.3, 90.0] {
            assert_eq!(degrees(f64::to_radians(written) as f32), written);
        }
    }

    #[test]
    fn every_f32_is_what_its_short_form_is_rounded_to() {
        // A stride that is prime to 2^32 visits all exponents and many mantissas.
        for i in 0..200_000_u32 {
            let x = f32::from_bits(i.wrapping_mul(2_654_435_761));
            if x.is_finite() {
                assert_eq!((short(x) as f32).to_bits(), x.to_bits(), "{x:e}");
            }
        }
    }
}
