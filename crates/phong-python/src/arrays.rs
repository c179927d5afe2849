//! Arrays of numpy, read in one pass into the renderer's own: what is wrong is told with the
//! argument, the index, the value, and what is wanted.
//!
//! They are read while the interpreter waits, so that nobody changes them meanwhile, and nothing of
//! them is kept.

use glam::{DAffine3, DMat4, DVec3, Vec2, Vec3};
use half::f16;
use numpy::ndarray::{ArrayViewD, IxDyn};
use numpy::{PyArrayDescrMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use phong_scene::{LARGEST, Rgb, origin_of};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::errors::{kind_of, memory_error, type_error, value_error};
use crate::files::memory;

/// Positions that are looked at to find where they are best counted from.
const SAMPLES: usize = 4096;

/// What an array's numbers are in memory.
enum Values<'py> {
    F64(PyReadonlyArrayDyn<'py, f64>),
    F32(PyReadonlyArrayDyn<'py, f32>),
    F16(PyReadonlyArrayDyn<'py, f16>),
    I64(PyReadonlyArrayDyn<'py, i64>),
    U8(PyReadonlyArrayDyn<'py, u8>),
}

/// An array of numbers, and what the user calls it.
pub(crate) struct Numbers<'py> {
    name: &'static str,
    values: Values<'py>,
}

/// A number that is read as an f64, whatever it is in memory.
trait Number: Copy {
    fn read(self) -> f64;
}

macro_rules! numbers {
    ($($of:ty: $value:ident => $read:expr),*) => {
        $(impl Number for $of {
            #[inline(always)]
            fn read(self) -> f64 {
                let $value = self;
                $read
            }
        })*
    };
}

numbers!(f64: v => v, f32: v => v.into(), f16: v => v.to_f64(), i64: v => v as f64, u8: v => v.into());

/// Does something with an array's values, whatever they are in memory.
macro_rules! with {
    ($numbers:expr, |$view:ident| $body:expr) => {
        match &$numbers.values {
            Values::F64(array) => {
                let $view = array.as_array();
                $body
            }
            Values::F32(array) => {
                let $view = array.as_array();
                $body
            }
            Values::F16(array) => {
                let $view = array.as_array();
                $body
            }
            Values::I64(array) => {
                let $view = array.as_array();
                $body
            }
            Values::U8(array) => {
                let $view = array.as_array();
                $body
            }
        }
    };
}

/// `array` of another type, as numpy makes it.
fn converted<'py>(array: &Bound<'py, PyAny>, to: &str) -> PyResult<Bound<'py, PyAny>> {
    array.call_method1(intern!(array.py(), "astype"), (to,))
}

impl<'py> Numbers<'py> {
    /// The numbers of anything that numpy makes an array of.
    pub(crate) fn of(name: &'static str, object: &Bound<'py, PyAny>) -> PyResult<Self> {
        let py = object.py();
        // Masked values are no numbers: they are found as such, with their index.
        let masked =
            object.hasattr(intern!(py, "mask"))? && object.hasattr(intern!(py, "filled"))?;
        let object = if masked {
            &converted(object, "f8")?.call_method1("filled", (f64::NAN,))?
        } else {
            object
        };
        let array = py.import("numpy")?.call_method1("asarray", (object,)).map_err(|error| {
            let wrong = type_error(format!("{name} cannot be read as an array: {error}"));
            wrong.set_cause(py, Some(error));
            wrong
        })?;
        let untyped: Bound<'py, PyUntypedArray> = array.clone().cast_into()?;
        let dtype = untyped.dtype();
        let kind: char = dtype.getattr("kind")?.extract()?;
        if !matches!(kind, 'f' | 'i' | 'u') {
            let what = if untyped.len() == 0 && kind == 'O' { "empty" } else { "no number" };
            return Err(type_error(format!(
                "{name} must be an array of numbers; its dtype is {dtype} ({what})"
            )));
        }
        let aligned: bool = array.getattr("flags")?.getattr("aligned")?.extract()?;
        let native =
            !matches!(dtype.byteorder(), b'>' | b'<') || dtype.getattr("isnative")?.extract()?;
        let array = match (kind, dtype.itemsize(), aligned && native) {
            ('f', 2 | 4 | 8, true) | ('i', 8, true) | ('u', 1, true) => array,
            ('u', 1, _) => converted(&array, "u1")?,
            ('f', ..) | ('u', 8, _) => converted(&array, "f8")?,
            _ => converted(&array, "i8")?,
        };
        let unreadable = |error: numpy::BorrowError| type_error(format!("{name}: {error}"));
        macro_rules! read {
            ($into:ident) => {
                match array.cast::<numpy::PyArrayDyn<_>>() {
                    Ok(array) => {
                        use numpy::PyArrayMethods as _;
                        let values = Values::$into(array.try_readonly().map_err(unreadable)?);
                        return Ok(Self { name, values });
                    }
                    Err(_) => {}
                }
            };
        }
        read!(F64);
        read!(F32);
        read!(F16);
        read!(I64);
        read!(U8);
        Err(type_error(format!("{name} must be an array of numbers; its dtype is {dtype}")))
    }

    /// Its shape.
    pub(crate) fn shape(&self) -> Vec<usize> {
        with!(self, |view| view.shape().to_vec())
    }

    /// Whether its numbers are bytes.
    pub(crate) fn is_bytes(&self) -> bool {
        matches!(self.values, Values::U8(_))
    }

    /// Whether its numbers are whole by their type.
    pub(crate) fn is_whole(&self) -> bool {
        matches!(self.values, Values::U8(_) | Values::I64(_))
    }

    /// Its shape as numpy writes it.
    fn shape_text(&self) -> String {
        shape_text(&self.shape())
    }

    /// How many rows of `K` numbers it has: its shape must be (N, K).
    pub(crate) fn rows<const K: usize>(&self, each: &str) -> PyResult<usize> {
        match self.shape()[..] {
            [rows, columns] if columns == K => Ok(rows),
            _ => Err(value_error(format!(
                "{} must be of shape (N, {K}), {each}; it is {}",
                self.name,
                self.shape_text()
            ))),
        }
    }

    /// Every row of an (N, K) array, made into something; `make` says what is wrong with one.
    pub(crate) fn map_rows<const K: usize, T>(
        &self,
        make: impl Fn([f64; K]) -> Result<T, &'static str>,
    ) -> PyResult<Vec<T>> {
        with!(self, |view| read_rows(self.name, &view, make))
    }

    /// Every number of a one-dimensional array, or `count` times the one number there is.
    pub(crate) fn column(&self, count: usize) -> PyResult<Column<'_, 'py>> {
        match self.shape()[..] {
            [] => {
                Ok(Column { numbers: self, one: Some(with!(self, |view| view[IxDyn(&[])].read())) })
            }
            [len] if len == count => Ok(Column { numbers: self, one: None }),
            _ => Err(value_error(format!(
                "{} must be one number or an array of shape ({count},), one for each; it is {}",
                self.name,
                self.shape_text()
            ))),
        }
    }

    /// All numbers, row after row.
    pub(crate) fn flat(&self) -> PyResult<Vec<f64>> {
        with!(self, |view| {
            let count = view.len();
            if count as u64 > memory() / 16 {
                let name = self.name;
                return Err(memory_error(format!(
                    "{name}: there is no memory for {count} numbers"
                )));
            }
            Ok(view.iter().map(|v| v.read()).collect())
        })
    }
}

/// A shape as numpy writes it.
fn shape_text(shape: &[usize]) -> String {
    match shape {
        [] => "a single number".to_owned(),
        [one] => format!("({one},)"),
        more => {
            let sides: Vec<_> = more.iter().map(ToString::to_string).collect();
            format!("({})", sides.join(", "))
        }
    }
}

fn read_rows<const K: usize, N: Number, T>(
    name: &str,
    view: &ArrayViewD<'_, N>,
    make: impl Fn([f64; K]) -> Result<T, &'static str>,
) -> PyResult<Vec<T>> {
    let wrong = |index: usize, row: [f64; K], wanted: &str| {
        value_error(format!("{name}[{index}] is {}: {wanted}", row_text(&row)))
    };
    let mut all = Vec::new();
    let rows = view.shape()[0];
    // An array may be small in memory and have any number of rows.
    let fits = rows.checked_mul(size_of::<T>()).is_some_and(|bytes| bytes as u64 <= memory());
    if !fits || all.try_reserve_exact(rows).is_err() {
        return Err(memory_error(format!("{name}: there is no memory for {rows} rows")));
    }
    if let Some(numbers) = view.as_slice() {
        for (index, row) in numbers.as_chunks::<K>().0.iter().enumerate() {
            let row = row.map(Number::read);
            all.push(make(row).map_err(|wanted| wrong(index, row, wanted))?);
        }
    } else if let Ok(view) = view.view().into_dimensionality::<numpy::Ix2>() {
        for (index, row) in view.rows().into_iter().enumerate() {
            let row: [f64; K] = std::array::from_fn(|i| row[i].read());
            all.push(make(row).map_err(|wanted| wrong(index, row, wanted))?);
        }
    }
    Ok(all)
}

fn row_text(row: &[f64]) -> String {
    match row {
        [one] => one.to_string(),
        more => {
            let numbers: Vec<_> = more.iter().map(ToString::to_string).collect();
            format!("({})", numbers.join(", "))
        }
    }
}

/// A number for each of several things.
pub(crate) struct Column<'a, 'py> {
    numbers: &'a Numbers<'py>,
    one: Option<f64>,
}

impl Column<'_, '_> {
    /// Puts each number where `put` says; `wanted` is what each must be, and what is said if not.
    pub(crate) fn fill(
        &self,
        count: usize,
        is_right: impl Fn(f64) -> bool,
        wanted: &str,
        mut put: impl FnMut(usize, f32),
    ) -> PyResult<()> {
        let name = self.numbers.name;
        if let Some(value) = self.one {
            if !is_right(value) {
                return Err(value_error(format!("{name} is {value}: {wanted}")));
            }
            (0..count).for_each(|index| put(index, value as f32));
            return Ok(());
        }
        with!(self.numbers, |view| {
            for (index, value) in view.iter().map(|value| value.read()).enumerate() {
                if !is_right(value) {
                    return Err(value_error(format!("{name}[{index}] is {value}: {wanted}")));
                }
                put(index, value as f32);
            }
        });
        Ok(())
    }
}

/// Whether a number is such as a scene may hold.
fn is_held(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// What numbers of a scene must be.
const HELD: &str = "it must be finite, and at most 1e18 in size";
/// What radii must be.
pub(crate) const RADIUS: &str = "it must be above 0 and at most 1e18";

/// Whether a number is a radius, in f32 too.
pub(crate) fn is_radius(value: f64) -> bool {
    is_held(value) && value as f32 > 0.0
}

/// Points of the world: where they are counted from, and where they are from there.
pub(crate) fn points(numbers: &[&Numbers<'_>], each: &str) -> PyResult<(DVec3, Vec<Vec<Vec3>>)> {
    let mut samples = Vec::new();
    for array in numbers {
        let rows = array.rows::<3>(each)?;
        if let Values::F64(values) = &array.values {
            let view = values.as_array();
            let step = rows.div_ceil(SAMPLES).max(1);
            let at = |row: usize| DVec3::from_array([0, 1, 2].map(|i| view[IxDyn(&[row, i])]));
            samples.extend((0..rows).step_by(step).map(at));
        }
    }
    let origin = origin_of(samples);
    let point = |row: [f64; 3]| {
        let fits = row.iter().all(|&v| is_held(v));
        fits.then(|| (DVec3::from_array(row) - origin).as_vec3()).ok_or(HELD)
    };
    let all = numbers.iter().map(|array| array.map_rows(point)).collect::<PyResult<_>>()?;
    Ok((origin, all))
}

/// Directions: of any length but 0.
pub(crate) fn directions(numbers: &Numbers<'_>, each: &str) -> PyResult<Vec<Vec3>> {
    numbers.rows::<3>(each)?;
    numbers.map_rows(|row: [f64; 3]| {
        let v = DVec3::from_array(row).as_vec3();
        match row.iter().all(|&v| is_held(v)) {
            false => Err(HELD),
            true if v.try_normalize().is_none() => Err("it has no direction"),
            true => Ok(v),
        }
    })
}

/// Texture coordinates.
pub(crate) fn coordinates(numbers: &Numbers<'_>, each: &str) -> PyResult<Vec<Vec2>> {
    numbers.rows::<2>(each)?;
    numbers.map_rows(|[u, v]: [f64; 2]| {
        if is_held(u) && is_held(v) { Ok(Vec2::new(u as f32, v as f32)) } else { Err(HELD) }
    })
}

/// Faces: three whole numbers each, of vertices that there are.
pub(crate) fn faces(numbers: &Numbers<'_>, vertices: usize) -> PyResult<Vec<[u32; 3]>> {
    if !numbers.is_whole() {
        return Err(type_error(format!(
            "{} must be an array of whole numbers: the vertices of each triangle",
            numbers.name
        )));
    }
    if let [_, columns] = numbers.shape()[..]
        && columns > 3
    {
        return Err(value_error(format!(
            "{} must be of shape (N, 3), triangles; it is {}: cut its polygons first",
            numbers.name,
            numbers.shape_text()
        )));
    }
    numbers.rows::<3>("the vertices of each triangle")?;
    let last = vertices as f64;
    numbers
        .map_rows(|row: [f64; 3]| {
            let there = row.iter().all(|&v| v >= 0.0 && v < last && v <= f64::from(u32::MAX - 1));
            there.then(|| row.map(|v| v as u32)).ok_or("there is no such vertex")
        })
        .map_err(|error| {
            Python::attach(|py| {
                let message = format!("{} (there are {vertices}, counted from 0)", error.value(py));
                if error.is_instance_of::<pyo3::exceptions::PyValueError>(py) {
                    value_error(message)
                } else {
                    error
                }
            })
        })
}

/// A colour of text: `"#rrggbb"` or a CSS name.
fn color_of_text(name: &str, text: &Bound<'_, PyString>) -> PyResult<Rgb> {
    let text = text.to_cow()?;
    text.parse().map_err(|error: phong_scene::ColorError| value_error(format!("{name}: {error}")))
}

/// Colours, one for each of `count` things, or one for all: linear floats, or sRGB as bytes and text.
pub(crate) fn colors(
    name: &'static str,
    object: &Bound<'_, PyAny>,
    count: usize,
    each: &str,
) -> PyResult<Vec<Rgb>> {
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(vec![color_of_text(name, text)?; count]);
    }
    let numpy = object.py().import("numpy")?;
    // Names of colours, in a list or an array.
    let first = object.get_item(0).ok().filter(PyAnyMethods::is_instance_of::<PyString>);
    if first.is_some() && object.len().is_ok_and(|len| len == count) {
        let one = |(index, item): (usize, PyResult<Bound<'_, PyAny>>)| {
            let item = item?;
            let text = item.cast::<PyString>().map_err(|_| {
                type_error(format!("{name}[{index}] is no text, as the others are"))
            })?;
            color_of_text(&format!("{name}[{index}]"), text)
        };
        return object.try_iter()?.enumerate().map(one).collect();
    }
    drop(numpy);
    let numbers = Numbers::of(name, object)?;
    let shape = numbers.shape();
    let bytes = numbers.is_bytes();
    let whole = numbers.is_whole();
    let channel = |v: f64| -> Result<f32, &'static str> {
        match v {
            v if !is_held(v) => Err(HELD),
            v if v < 0.0 => Err("there is no light below 0"),
            v if whole && !bytes && v > 1.0 => {
                Err("linear light is written as floats; bytes of sRGB must be of dtype uint8")
            }
            v => Ok(v as f32),
        }
    };
    let color = |row: [f64; 3]| -> Result<Rgb, &'static str> {
        if bytes {
            return Ok(Rgb::from_srgb8(row.map(|v| v as u8)));
        }
        let [r, g, b] = row;
        Ok(Rgb::new(channel(r)?, channel(g)?, channel(b)?))
    };
    let opaque = if bytes { 255.0 } else { 1.0 };
    let of_four = |[r, g, b, a]: [f64; 4]| {
        if a != opaque {
            return Err(if bytes {
                "a colour has no opacity of its own: its fourth number must be 255, or left out"
            } else {
                "a colour has no opacity of its own: its fourth number must be 1, or left out"
            });
        }
        color([r, g, b])
    };
    match shape[..] {
        [] | [3 | 4] => {
            let values = numbers.flat()?;
            let one = match values[..] {
                [grey] => color([grey; 3]),
                [r, g, b] => color([r, g, b]),
                [r, g, b, a] => of_four([r, g, b, a]),
                _ => Err("it is no colour"),
            };
            let wrong = |wanted| value_error(format!("{name} is {}: {wanted}", row_text(&values)));
            Ok(vec![one.map_err(wrong)?; count])
        }
        [rows, 3] if rows == count => {
            let table = bytes.then(srgb_table);
            match table {
                // One power a level, and not one a pixel.
                Some(table) => numbers.map_rows(|[r, g, b]: [f64; 3]| {
                    Ok(Rgb::new(table[r as usize], table[g as usize], table[b as usize]))
                }),
                None => numbers.map_rows(color),
            }
        }
        [rows, 4] if rows == count => numbers.map_rows(of_four),
        _ => Err(value_error(format!(
            "{name} must be one colour, or of shape ({count}, 3), {each}; it is {}",
            shape_text(&shape)
        ))),
    }
}

/// The linear value of every byte of sRGB.
fn srgb_table() -> Vec<f32> {
    (0..=255).map(|byte| Rgb::from_srgb8([byte; 3]).r).collect()
}

/// Placements: of shape (4, 4) or (3, 4), or (N, 4, 4) or (N, 3, 4); for column vectors.
pub(crate) fn transforms(name: &'static str, object: &Bound<'_, PyAny>) -> PyResult<Vec<DAffine3>> {
    let numbers = Numbers::of(name, object)?;
    let shape = numbers.shape();
    let ([rows @ (3 | 4), 4] | [_, rows @ (3 | 4), 4]) = shape[..] else {
        return Err(value_error(format!(
            "{name} must be of shape (4, 4) or (N, 4, 4), for column vectors; it is {}",
            shape_text(&shape)
        )));
    };
    let values = numbers.flat()?;
    let one = |(index, values): (usize, &[f64])| {
        let wrong = |wanted: &str| {
            let at = if shape.len() == 3 { format!("{name}[{index}]") } else { name.to_owned() };
            value_error(format!("{at}: {wanted}"))
        };
        if let Some(bad) = values.iter().find(|v| !is_held(**v)) {
            return Err(wrong(&format!(
                "{bad} is in it; numbers must be finite, and at most 1e18 in size"
            )));
        }
        let mut all = [0.0; 16];
        all[15] = 1.0;
        all[..4 * rows].copy_from_slice(values);
        if all[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err(wrong("its last row must be [0, 0, 0, 1]; rows are for column vectors"));
        }
        let matrix = DAffine3::from_mat4(DMat4::from_cols_array(&all).transpose());
        let inverse = matrix.matrix3.inverse();
        if matrix.matrix3.determinant() == 0.0 || !inverse.is_finite() {
            return Err(wrong("it cannot be undone: it makes things flat"));
        }
        Ok(matrix)
    };
    values.chunks_exact(4 * rows).enumerate().map(one).collect()
}

/// An array of numpy that cannot be changed.
pub(crate) fn frozen<'py, T: numpy::Element>(
    py: Python<'py>,
    values: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    use numpy::PyArrayMethods as _;
    let array = numpy::PyArray1::from_vec(py, values);
    let array = array.reshape(shape.to_vec())?;
    let keys = PyDict::new(py);
    keys.set_item("write", false)?;
    array.call_method("setflags", (), Some(&keys))?;
    Ok(array.into_any())
}

/// What an argument is, where it is neither of two.
pub(crate) fn neither(name: &str, wanted: &str, value: &Bound<'_, PyAny>) -> PyErr {
    type_error(format!("{name} must be {wanted}, not {}", kind_of(value)))
}
