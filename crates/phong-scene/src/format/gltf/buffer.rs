//! Buffers, and the numbers that accessors find in them.

use glam::{Vec2, Vec3, Vec4};

use super::json::{At, Fault, Result};
use super::uri::load;
use crate::limits::Limits;
use crate::source::Source;

/// The bytes of all buffers.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    /// Each, or why it cannot be used.
    all: Vec<std::result::Result<Vec<u8>, Fault>>,
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

/// Numbers in rows of the same length.
#[derive(Debug)]
pub(super) struct Rows {
    /// Numbers of a row.
    pub(super) width: usize,
    pub(super) count: usize,
    numbers: Vec<f32>,
}

impl Rows {
    /// One row; missing numbers are 0.
    #[inline]
    fn row<const N: usize>(&self, i: usize) -> [f32; N] {
        let row = self.numbers.get(i * self.width..(i + 1) * self.width).unwrap_or_default();
        std::array::from_fn(|k| row.get(k).copied().unwrap_or(0.0))
    }

    pub(super) fn vectors(&self) -> Vec<Vec3> {
        (0..self.count).map(|i| Vec3::from(self.row::<3>(i))).collect()
    }

    pub(super) fn pairs(&self) -> Vec<Vec2> {
        (0..self.count).map(|i| Vec2::from(self.row::<2>(i))).collect()
    }

    pub(super) fn quadruples(&self) -> Vec<Vec4> {
        (0..self.count).map(|i| Vec4::from(self.row::<4>(i))).collect()
    }

    pub(super) fn matrices(&self) -> Vec<[f32; 16]> {
        (0..self.count).map(|i| self.row(i)).collect()
    }
}

impl Buffers {
    /// Reads all buffers of a document: what stands in the file itself, behind it, or beside it.
    pub(super) fn read(
        root: &At<'_>,
        path: &str,
        binary: Option<Vec<u8>>,
        source: &dyn Source,
        limits: &Limits,
    ) -> Result<Self> {
        let mut binary = binary;
        let mut room = limits.bytes;
        let mut read = |at: At<'_>| -> Result<Vec<u8>> {
            let length = at.need("byteLength")?.whole()?;
            if length > room {
                return Err(at.fault(format!("it takes {length} bytes of memory; {room} are left")));
            }
            room -= length;
            let bytes = match at.get("uri") {
                Some(uri) => load(&uri, path, source, length)?,
                None if at.pointer == "/buffers/0" => binary.take().unwrap_or_default(),
                None => Vec::new(),
            };
            if (bytes.len() as u64) < length {
                let there = bytes.len();
                return Err(at.fault(format!("only {there} of its {length} bytes are there")));
            }
            Ok(bytes)
        };
        Ok(Self { all: root.list("buffers")?.into_iter().map(&mut read).collect() })
    }

    /// The bytes of a view of a buffer, and how far apart its rows begin, if it says so.
    fn view(&self, root: &At<'_>, index: &At<'_>) -> Result<(&[u8], Option<usize>, String)> {
        let view = root.item("bufferViews", index.index()?).map_err(|f| index.fault(f.message))?;
        let buffer = view.need("buffer")?;
        let bytes = match self.all.get(buffer.index()?) {
            Some(Ok(bytes)) => bytes,
            Some(Err(fault)) => return Err(fault.clone()),
            None => return Err(buffer.fault("there is no such buffer")),
        };
        let (offset, length) =
            (view.whole_or_zero("byteOffset")?, view.need("byteLength")?.whole()?);
        let end = offset.checked_add(length).filter(|end| *end <= bytes.len() as u64);
        let Some(end) = end else {
            return Err(
                view.fault(format!("it goes beyond the {} bytes of its buffer", bytes.len()))
            );
        };
        let stride = match view.get("byteStride") {
            Some(at) => Some(at.index()?).filter(|stride| *stride > 0),
            None => None,
        };
        Ok((&bytes[offset as usize..end as usize], stride, view.pointer))
    }

    /// The bytes of a view of a buffer.
    pub(super) fn bytes(&self, root: &At<'_>, index: &At<'_>) -> Result<&[u8]> {
        self.view(root, index).map(|(bytes, ..)| bytes)
    }

    /// The rows of an accessor, normalised where it says so.
    pub(super) fn rows(&self, root: &At<'_>, index: &At<'_>, limits: &Limits) -> Result<Rows> {
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
        let count = count as usize;
        let normalized = at.get("normalized").map_or(Ok(false), |at| at.flag())?;
        let scale = if normalized { component.most() } else { 1.0 };
        let value = |bytes: &[u8]| {
            let value = component.load(bytes);
            (if normalized { (value / scale).max(-1.0) } else { value }) as f32
        };
        let size = component.size();
        let mut numbers = Vec::new();
        match at.get("bufferView") {
            None => numbers.resize(count * width, 0.0),
            Some(view) => {
                let (bytes, stride, pointer) = self.view(root, &view)?;
                let offset = at.whole_or_zero("byteOffset")?;
                let stride = stride.unwrap_or(width * size);
                let needed = (count as u64)
                    .saturating_sub(1)
                    .saturating_mul(stride as u64)
                    .saturating_add((width * size) as u64)
                    .saturating_add(offset);
                if count > 0 && needed > bytes.len() as u64 {
                    let there = bytes.len();
                    return Err(at.fault(format!(
                        "its {count} rows need {needed} bytes, but {pointer} has {there}"
                    )));
                }
                numbers.reserve_exact(count * width);
                for row in (0..count).map(|i| offset as usize + i * stride) {
                    let row = &bytes[row..row + width * size];
                    if component == Component::F32 {
                        numbers
                            .extend(row.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)));
                    } else {
                        numbers.extend(row.chunks_exact(size).map(value));
                    }
                }
            }
        }
        if let Some(sparse) = at.get("sparse") {
            let places = self.sparse(root, &sparse, "indices")?;
            let (bytes, component_of_values) = (self.sparse_values(root, &sparse)?, component);
            for (k, place) in places.into_iter().enumerate() {
                let row = (place as usize).checked_mul(width).filter(|_| (place as usize) < count);
                let from = bytes.get(k * width * size..(k + 1) * width * size);
                let (Some(row), Some(from)) = (row, from) else {
                    return Err(sparse
                        .fault(format!("row {place} is none of the {count}, or has no value")));
                };
                for (number, bytes) in
                    numbers[row..row + width].iter_mut().zip(from.chunks_exact(size))
                {
                    *number = if component_of_values == Component::F32 {
                        component.load(bytes) as f32
                    } else {
                        value(bytes)
                    };
                }
            }
        }
        Ok(Rows { width, count, numbers })
    }

    /// The whole numbers of an accessor, as of indices.
    pub(super) fn indices(
        &self,
        root: &At<'_>,
        index: &At<'_>,
        limits: &Limits,
    ) -> Result<Vec<u32>> {
        let at = root.item("accessors", index.index()?).map_err(|f| index.fault(f.message))?;
        let component = at.need("componentType")?;
        if Component::of(&component)? != Component::U32 {
            let rows = self.rows(root, index, limits)?;
            return Ok(rows.numbers.iter().map(|n| *n as u32).collect());
        }
        // An f32 does not hold them.
        let count = at.need("count")?.index()?;
        let (bytes, stride, _) = self.view(root, &at.need("bufferView")?)?;
        let offset = at.whole_or_zero("byteOffset")? as usize;
        let stride = stride.unwrap_or(4);
        let fits = count.checked_sub(1).and_then(|last| last.checked_mul(stride)?.checked_add(4));
        let fits = count == 0
            || fits.and_then(|n| n.checked_add(offset)).is_some_and(|n| n <= bytes.len());
        if !fits {
            return Err(at.fault(format!("its {count} rows go beyond its view's bytes")));
        }
        let row =
            |i: usize| bytes[offset + i * stride..].first_chunk().copied().unwrap_or_default();
        Ok((0..count).map(|i| u32::from_le_bytes(row(i))).collect())
    }

    /// The row numbers of a sparse accessor.
    fn sparse(&self, root: &At<'_>, sparse: &At<'_>, key: &str) -> Result<Vec<u32>> {
        let at = sparse.need(key)?;
        let component = Component::of(&at.need("componentType")?)?;
        let (bytes, _, _) = self.view(root, &at.need("bufferView")?)?;
        let count = sparse.need("count")?.index()?;
        let offset = at.whole_or_zero("byteOffset")? as usize;
        let size = component.size();
        let end = count.checked_mul(size).and_then(|length| length.checked_add(offset));
        let bytes = end.and_then(|end| bytes.get(offset..end));
        let bytes = bytes.ok_or_else(|| at.fault("it goes beyond the bytes of its view"))?;
        Ok(bytes.chunks_exact(size).map(|bytes| component.load(bytes) as u32).collect())
    }

    fn sparse_values(&self, root: &At<'_>, sparse: &At<'_>) -> Result<&[u8]> {
        let at = sparse.need("values")?;
        let (bytes, _, _) = self.view(root, &at.need("bufferView")?)?;
        let offset = at.whole_or_zero("byteOffset")? as usize;
        bytes.get(offset..).ok_or_else(|| at.fault("it begins beyond the bytes of its view"))
    }
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
