//! Where the values of keys are kept in what their tables describe, so that the reader, the writer and
//! the check of a key need nothing but its row.

use std::fmt;

use super::value::Value;
use super::{Key, Table};
use crate::ambient_occlusion::AmbientOcclusion;
use crate::camera::Camera;
use crate::clip::Clip;
use crate::fog::Fog;
use crate::furniture::{Axes, FurnitureStyle, Legend, PointLabel, ScaleBar, Title};
use crate::light::Light;
use crate::material::Material;
use crate::outline::Outline;
use crate::scene::Image;
use crate::shape::Shape;
use crate::sky::Sky;
use crate::texture::Texture;
use crate::tone::Tone;

/// Where a key's value is kept.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Field {
    /// Nowhere by itself: the reader and the writer of the table work it out.
    None,
    Image(Access<Image>),
    AmbientOcclusion(Access<AmbientOcclusion>),
    Sky(Access<Sky>),
    Fog(Access<Fog>),
    Clip(Access<Clip>),
    Outline(Access<Outline>),
    FurnitureStyle(Access<FurnitureStyle>),
    Title(Access<Title>),
    ScaleBar(Access<ScaleBar>),
    Axes(Access<Axes>),
    Legend(Access<Legend>),
    PointLabel(Access<PointLabel>),
    Tone(Access<Tone>),
    Camera(Access<Camera>),
    Light(Access<Light>),
    Texture(Access<Texture>),
    Material(Access<Material>),
    Shape(Access<Shape>),
}

/// How a value is got and set.
pub(crate) struct Access<T> {
    /// The value; `None`: this one has none, or it is left to the default.
    pub(crate) get: fn(&T) -> Option<Value>,
    /// Sets it; `None`: it is none of this kind.
    pub(crate) set: fn(&mut T, Value) -> Option<()>,
}

/// What a table describes.
pub(crate) trait Keyed: Sized {
    /// The table.
    fn table(&self) -> &'static Table;

    /// The place of a value, if it is one of this type.
    fn access(field: &Field) -> Option<&Access<Self>>;
}

impl Key {
    /// The value that stands in `of` for this key; `None` as [`Access::get`] has it, or where the
    /// key has no field.
    pub(crate) fn get<T: Keyed>(&self, of: &T) -> Option<Value> {
        (T::access(&self.field)?.get)(of)
    }
}

impl Table {
    /// What the selecting key says of a thing that this table describes.
    pub(crate) fn word_of<T: Keyed>(&self, of: &T) -> Option<&'static str> {
        match self.find(self.select?, None)?.get(of)? {
            Value::Word(word) => Some(word),
            _ => None,
        }
    }
}

/// The field of a struct, or a field that some kinds of an enum have:
/// `field!(Light.color)`, `field!(Light.kind = LightKind::{Point | Spot}.radius)`.
macro_rules! field {
    ($of:ident . $field:ident) => {
        $crate::keys::Field::$of($crate::keys::Access {
            get: |of| $crate::keys::Stored::value(&of.$field),
            set: |of, value| {
                of.$field = $crate::keys::Stored::of(value)?;
                Some(())
            },
        })
    };
    ($of:ident $(. $place:ident)? = $kind:ident :: { $($variant:ident)|+ } . $field:ident) => {
        $crate::keys::Field::$of($crate::keys::Access {
            get: |of| match &(*of)$(.$place)? {
                $($kind::$variant { $field, .. })|+ => $crate::keys::Stored::value($field),
                _ => None,
            },
            set: |of, value| match &mut (*of)$(.$place)? {
                $($kind::$variant { $field, .. })|+ => {
                    *$field = $crate::keys::Stored::of(value)?;
                    Some(())
                }
                _ => None,
            },
        })
    };
}
pub(super) use field;

/// What describes a type, of whose fields [`Field`] has a kind of the same name:
/// `keyed!(Light, |_| &LIGHT)`.
macro_rules! keyed {
    ($of:ident, $table:expr) => {
        impl $crate::keys::Keyed for $of {
            fn table(&self) -> &'static Table {
                let table: fn(&Self) -> &'static Table = $table;
                table(self)
            }

            fn access(field: &$crate::keys::Field) -> Option<&$crate::keys::Access<Self>> {
                match field {
                    $crate::keys::Field::$of(access) => Some(access),
                    _ => None,
                }
            }
        }
    };
}
pub(super) use keyed;

// Not derived, since `T` itself need be none of these.
impl<T> Clone for Access<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Access<T> {}

impl<T> fmt::Debug for Access<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Access")
    }
}
