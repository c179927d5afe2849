//! Buffers, and the numbers that accessors find in them.

use std::borrow::Cow;
use std::io;

use rayon::prelude::*;

use super::bytes::Bytes;
use super::json::{At, Fault, Result};
use super::uri::load;
use crate::limits::Limits;
use crate::source::{Source, trouble};

/// The bytes of all buffers.
pub(super) struct Buffers {
    /// Each, or why it cannot be used.
    all: Vec<std::result::Result<Bytes, Fault>>,
}

/// What kinds of numbers an accessor holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(at: &At<'_>) -> Result<Self> {
        Ok(match at.whole()? {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            other => return Err(at.fault(format!("{other} is no type of components"))),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number that bytes stand for, as many as it takes; the others are of another size.
    #[inline]
    fn load(self, bytes: &[u8]) -> f64 {
        let two = || bytes.first_chunk().copied().unwrap_or_default();
        let four = || bytes.first_chunk().copied().unwrap_or_default();
        let one = bytes.first().copied().unwrap_or_default();
        match self {
            Self::I8 => f64::from(one.cast_signed()),
            Self::U8 => f64::from(one),
            Self::I16 => f64::from(i16::from_le_bytes(two())),
            Self::U16 => f64::from(u16::from_le_bytes(two())),
            Self::U32 => f64::from(u32::from_le_bytes(four())),
            Self::F32 => f64::from(f32::from_le_bytes(four())),
        }
    }

    /// What a normalised number is divided by.
    fn most(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 | Self::F32 => 1.0,
        }
    }
}

/// Rows that are read at once are at most so many, and lie within about so many bytes.
const PIECE: [usize; 2] = [1 << 14, 1 << 18];

/// Most files that are open at once.
const OPEN: usize = 16;

/// Some bytes of a buffer, of a view of it.
struct View<'b> {
    bytes: &'b Bytes,
    start: u64,
    length: u64,
    /// How far apart its rows begin, if it says so.
    stride: Option<usize>,
    pointer: String,
}

impl<'b> View<'b> {
    /// So many bytes of it from one on; `None`: they are not there.
    fn part(&self, at: &At<'_>, from: u64, length: u64) -> Result<Option<Cow<'b, [u8]>>> {
        if from.checked_add(length).is_none_or(|end| end > self.length) {
            return Ok(None);
        }
        let part = self.bytes.part(self.start + from, length as usize);
        part.map(Some).map_err(|error| at.fault(unread(&error)))
    }
}

fn unread(error: &io::Error) -> String {
    format!("its bytes cannot be read: {}", trouble(error))
}

/// What an accessor says of its rows.
struct Accessor<'a> {
    at: At<'a>,
    component: Component,
    /// Numbers of a row.
    width: usize,
    count: usize,
    normalized: bool,
}

/// Where the rows of an accessor lie.
struct Layout<'b> {
    view: View<'b>,
    /// Where the first row begins in the buffer.
    start: u64,
    /// How far apart rows begin.
    stride: usize,
    /// Bytes of a row.
    row: usize,
}

impl Layout<'_> {
    /// Makes a value of each row, by all threads.
    fn each<T: Send>(
        &self,
        values: &mut [T],
        make: impl Fn(&[u8], &mut [T]) + Sync,
    ) -> io::Result<()> {
        let rows = PIECE[0].min(PIECE[1] / self.stride.max(1)).max(1);
        let read = |room: &mut Vec<u8>, (number, values): (usize, &mut [T])| {
            let start = self.start + (number * rows * self.stride) as u64;
            let length = (values.len() - 1) * self.stride + self.row;
            make(self.view.bytes.piece(start, length, room)?, values);
            Ok(())
        };
        values.par_chunks_mut(rows).enumerate().map_init(Vec::new, read).collect()
    }

    /// The rows in bytes that begin with the first of them.
    fn rows<'b>(&self, bytes: &'b [u8]) -> impl Iterator<Item = &'b [u8]> {
        let (stride, row) = (self.stride, self.row);
        (0..).map_while(move |i: usize| bytes.get(i * stride..)?.get(..row))
    }

    /// Whether the numbers lie side by side.
    fn is_packed(&self) -> bool {
        self.stride == self.row
    }
}

impl Buffers {
    /// Reads all buffers of a document: what stands in the file itself, behind it, or beside it.
    pub(super) fn read(
        root: &At<'_>,
        path: &str,
        binary: Option<Bytes>,
        source: &dyn Source,
        limits: &Limits,
    ) -> Result<Self> {
        let mut binary = binary;
        let mut room = limits.bytes;
        let mut open = OPEN;
        let mut read = |at: At<'_>| -> Result<Bytes> {
            let length = at.need("byteLength")?.whole()?;
            if length > room {
                return Err(at.fault(format!("it takes {length} bytes of memory; {room} are left")));
            }
            room -= length;
            let bytes = match at.get("uri") {
                Some(uri) => load(&uri, path, source, length, open > 0)?,
                None if at.pointer == "/buffers/0" => binary.take().unwrap_or_default(),
                None => Bytes::default(),
            };
            open -= usize::from(matches!(bytes, Bytes::Filed { .. }));
            if bytes.len() < length {
                let there = bytes.len();
                return Err(at.fault(format!("only {there} of its {length} bytes are there")));
            }
            Ok(bytes)
        };
        Ok(Self { all: root.list("buffers")?.into_iter().map(&mut read).collect() })
    }

    /// A view of a buffer.
    fn view(&self, root: &At<'_>, index: &At<'_>) -> Result<View<'_>> {
        let view = root.item("bufferViews", index.index()?).map_err(|f| index.fault(f.message))?;
        let buffer = view.need("buffer")?;
        let bytes = match self.all.get(buffer.index()?) {
            Some(Ok(bytes)) => bytes,
            Some(Err(fault)) => return Err(fault.clone()),
            None => return Err(buffer.fault("there is no such buffer")),
        };
        let (offset, length) =
            (view.whole_or_zero("byteOffset")?, view.need("byteLength")?.whole()?);
        if offset.checked_add(length).is_none_or(|end| end > bytes.len()) {
            return Err(
                view.fault(format!("it goes beyond the {} bytes of its buffer", bytes.len()))
            );
        }
        let stride = match view.get("byteStride") {
            Some(at) => Some(at.index()?).filter(|stride| *stride > 0),
            None => None,
        };
        Ok(View { bytes, start: offset, length, stride, pointer: view.pointer })
    }

    /// The bytes of a view of a buffer.
    pub(super) fn bytes(&self, root: &At<'_>, index: &At<'_>) -> Result<Cow<'_, [u8]>> {
        let view = self.view(root, index)?;
        Ok(view.part(index, 0, view.length)?.unwrap_or_default())
    }

    /// The rows of an accessor, normalised where it says so, of so many numbers each: further ones are left
    /// out, and those that are not there are 0.
    pub(super) fn rows<const N: usize>(
        &self,
        root: &At<'_>,
        index: &At<'_>,
        limits: &Limits,
    ) -> Result<Vec<[f32; N]>> {
        let accessor = Accessor::of(root, index, limits)?;
        let Accessor { ref at, component, width, count, .. } = accessor;
        let layout = self.layout(root, &accessor)?;
        let mut rows = vec![[0.0; N]; count];
        let size = component.size();
        if let Some(layout) = layout {
            let packed = layout.is_packed() && component == Component::F32 && width == N;
            let make = |bytes: &[u8], rows: &mut [[f32; N]]| {
                if packed {
                    for (to, from) in rows.as_flattened_mut().iter_mut().zip(bytes.as_chunks().0) {
                        *to = f32::from_le_bytes(*from);
                    }
                    return;
                }
                for (row, from) in rows.iter_mut().zip(layout.rows(bytes)) {
                    for (to, from) in row.iter_mut().zip(from.chunks_exact(size)) {
                        *to = accessor.number(from);
                    }
                }
            };
            layout.each(&mut rows, make).map_err(|error| at.fault(unread(&error)))?;
        }
        if let Some(sparse) = at.get("sparse") {
            let places = self.sparse(root, &sparse, "indices")?;
            let bytes = self.sparse_values(root, &sparse, (places.len() * width * size) as u64)?;
            for (k, place) in places.into_iter().enumerate() {
                let row = rows.get_mut(place as usize);
                let from = bytes.get(k * width * size..(k + 1) * width * size);
                let (Some(row), Some(from)) = (row, from) else {
                    return Err(sparse
                        .fault(format!("row {place} is none of the {count}, or has no value")));
                };
                for (number, bytes) in row.iter_mut().zip(from.chunks_exact(size)) {
                    *number = accessor.number(bytes);
                }
            }
        }
        Ok(rows)
    }

    /// The whole numbers of an accessor, as of indices, N together; what is left of the last is left out.
    pub(super) fn indices<const N: usize>(
        &self,
        root: &At<'_>,
        index: &At<'_>,
        limits: &Limits,
    ) -> Result<Vec<[u32; N]>> {
        let at = root.item("accessors", index.index()?).map_err(|f| index.fault(f.message))?;
        let component = Component::of(&at.need("componentType")?)?;
        if component != Component::U32 {
            let accessor = Accessor::of(root, index, limits)?;
            let layout = self.layout(root, &accessor)?.filter(|_| at.get("sparse").is_none());
            if let (Some(layout), 1) = (layout, accessor.width) {
                return whole(&accessor, &layout);
            }
            // Of several numbers a row, each is an index.
            let all: Vec<u32> = match accessor.width {
                1 => flat(&self.rows::<1>(root, index, limits)?),
                2 => flat(&self.rows::<2>(root, index, limits)?),
                3 => flat(&self.rows::<3>(root, index, limits)?),
                4 => flat(&self.rows::<4>(root, index, limits)?),
                9 => flat(&self.rows::<9>(root, index, limits)?),
                _ => flat(&self.rows::<16>(root, index, limits)?),
            };
            return Ok(all.as_chunks().0.to_vec());
        }
        // An f32 does not hold them.
        let count = at.need("count")?.index()?;
        let view = self.view(root, &at.need("bufferView")?)?;
        let offset = at.whole_or_zero("byteOffset")?;
        let stride = view.stride.unwrap_or(4);
        let fits = count.checked_sub(1).and_then(|last| last.checked_mul(stride)?.checked_add(4));
        let end = fits.and_then(|n| offset.checked_add(n as u64));
        if count > 0 && end.is_none_or(|end| end > view.length) {
            return Err(at.fault(format!("its {count} rows go beyond its view's bytes")));
        }
        let layout = Layout { start: view.start.saturating_add(offset), view, stride, row: 4 };
        whole(&Accessor { at, component, width: 1, count, normalized: false }, &layout)
    }

    /// Where the rows of an accessor lie; `None`: it names no view, so that they are all zeros.
    fn layout(&self, root: &At<'_>, accessor: &Accessor<'_>) -> Result<Option<Layout<'_>>> {
        let Accessor { at, component, width, count, .. } = accessor;
        let Some(view) = at.get("bufferView") else { return Ok(None) };
        let view = self.view(root, &view)?;
        let offset = at.whole_or_zero("byteOffset")?;
        let row = width * component.size();
        let stride = view.stride.unwrap_or(row);
        let needed = (*count as u64)
            .saturating_sub(1)
            .saturating_mul(stride as u64)
            .saturating_add(row as u64)
            .saturating_add(offset);
        if *count > 0 && needed > view.length {
            let View { length: there, pointer, .. } = view;
            return Err(at.fault(format!(
                "its {count} rows need {needed} bytes, but {pointer} has {there}"
            )));
        }
        Ok(Some(Layout { start: view.start.saturating_add(offset), view, stride, row }))
    }

    /// The row numbers of a sparse accessor.
    fn sparse(&self, root: &At<'_>, sparse: &At<'_>, key: &str) -> Result<Vec<u32>> {
        let at = sparse.need(key)?;
        let component = Component::of(&at.need("componentType")?)?;
        let view = self.view(root, &at.need("bufferView")?)?;
        let count = sparse.need("count")?.whole()?;
        let offset = at.whole_or_zero("byteOffset")?;
        let size = component.size();
        let bytes = view.part(&at, offset, count.saturating_mul(size as u64))?;
        let bytes = bytes.ok_or_else(|| at.fault("it goes beyond the bytes of its view"))?;
        Ok(bytes.chunks_exact(size).map(|bytes| component.load(bytes) as u32).collect())
    }

    /// As many bytes of a sparse accessor's values as are there, and no more than so many.
    fn sparse_values(&self, root: &At<'_>, sparse: &At<'_>, most: u64) -> Result<Cow<'_, [u8]>> {
        let at = sparse.need("values")?;
        let view = self.view(root, &at.need("bufferView")?)?;
        let offset = at.whole_or_zero("byteOffset")?;
        let length = view.length.checked_sub(offset).map_or(0, |rest| rest.min(most));
        let bytes = view.part(&at, offset, length)?;
        bytes.ok_or_else(|| at.fault("it begins beyond the bytes of its view"))
    }
}

impl<'a> Accessor<'a> {
    /// The accessor of a number; its rows are within the limits.
    fn of(root: &At<'a>, index: &At<'_>, limits: &Limits) -> Result<Self> {
        let at = root.item("accessors", index.index()?).map_err(|f| index.fault(f.message))?;
        let component = Component::of(&at.need("componentType")?)?;
        let kind = at.need("type")?;
        let width = match kind.text()? {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" | "MAT2" => 4,
            "MAT3" => 9,
            "MAT4" => 16,
            other => return Err(kind.fault(format!("`{other}` is no type of an accessor"))),
        };
        let count = at.need("count")?.whole()?;
        // Three corners a triangle; what fits is known before anything is allocated.
        let most = limits.vertices.max(limits.triangles.saturating_mul(3));
        let bytes = count.saturating_mul(4 * width as u64);
        if count > most || bytes > limits.bytes {
            return Err(at.fault(format!("{count} rows are more than are allowed")));
        }
        let normalized = at.get("normalized").map_or(Ok(false), |at| at.flag())?;
        Ok(Self { at, component, width, count: count as usize, normalized })
    }

    /// The number that bytes stand for.
    fn number(&self, bytes: &[u8]) -> f32 {
        let value = self.component.load(bytes);
        let whole = self.component != Component::F32;
        (if self.normalized && whole { (value / self.component.most()).max(-1.0) } else { value })
            as f32
    }
}

/// The whole numbers of rows of one each.
fn whole<const N: usize>(accessor: &Accessor<'_>, layout: &Layout<'_>) -> Result<Vec<[u32; N]>> {
    let mut all = vec![[0; N]; accessor.count / N];
    let make = |bytes: &[u8], all: &mut [u32]| match accessor.component {
        Component::U32 if layout.is_packed() => {
            let each = all.iter_mut().zip(bytes.as_chunks().0);
            each.for_each(|(to, from)| *to = u32::from_le_bytes(*from));
        }
        Component::U16 if layout.is_packed() && !accessor.normalized => {
            let each = all.iter_mut().zip(bytes.as_chunks().0);
            each.for_each(|(to, from)| *to = u32::from(u16::from_le_bytes(*from)));
        }
        Component::U32 => {
            for (to, from) in all.iter_mut().zip(layout.rows(bytes)) {
                *to = u32::from_le_bytes(from.first_chunk().copied().unwrap_or_default());
            }
        }
        _ => {
            let each = all.iter_mut().zip(layout.rows(bytes));
            each.for_each(|(to, from)| *to = accessor.number(from) as u32);
        }
    };
    let read = layout.each(all.as_flattened_mut(), make);
    read.map_err(|error| accessor.at.fault(unread(&error)))?;
    Ok(all)
}

/// All numbers of rows as whole ones.
fn flat<const N: usize>(rows: &[[f32; N]]) -> Vec<u32> {
    rows.as_flattened().iter().map(|n| *n as u32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalised_numbers_go_from_minus_one_to_one() {
        assert_eq!(Component::I8.load(&[0x80]), -128.0);
        assert_eq!(Component::U16.load(&[0xff, 0xff]) / Component::U16.most(), 1.0);
    }
}
