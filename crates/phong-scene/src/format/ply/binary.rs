//! Binary bodies, converted in parallel from positioned reads straight into the final arrays.
//!
//! Rows of one length (vertices without lists; faces all of whose lists are as long as those of the first)
//! are read by all threads. Rows of varying length are walked by one.

use std::io;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::body::{Body, Contents, FaceList, ORIGIN_SAMPLES};
use super::edges::{EdgePlan, Edges};
use super::extras::{ExtrasRow, Use};
use super::header::{Element, Encoding, Type};
use super::names::{Row, WIDTH};
use super::regular::Read;
use super::vertices::{Columns, Vertices, tell};
use super::walk::{BLOCK, Walk, load};
use crate::diagnostic::Severity;
use crate::format::faces::{Faces, Kind, out_of_range};
use crate::format::origin::origin_of;
use crate::format::text::Findings;

impl Body<'_> {
    /// Reads the elements one behind the other; stops at an error, which `findings` then hold.
    pub(super) fn read_binary(&mut self, contents: &mut Contents) -> io::Result<()> {
        let mut offset = self.header.body;
        let header = self.header;
        for element in &header.elements {
            let list = self.face_list(element);
            let edges = self.edges.clone().filter(|_| element.name == "edge");
            let walked = match element.stride() {
                stride if let Some(plan) = edges => {
                    let stride = stride.filter(|stride| self.has_rows(element, offset, *stride));
                    match stride {
                        Some(stride) => {
                            self.edges(&plan, (element, offset, stride), &mut contents.edges)?
                        }
                        None => self.walk_edges(&plan, element, offset, &mut contents.edges)?,
                    }
                }
                Some(stride) => {
                    let size = element.count.saturating_mul(stride as u64);
                    let there = self.blob.len().saturating_sub(offset);
                    if size > there {
                        let whole = if stride == 0 { 0 } else { there / stride as u64 };
                        self.tell_truncated(element, whole);
                        if self.plan.lenient && element.name == "vertex" {
                            let there = Element { count: whole, ..element.clone() };
                            self.vertices(&there, offset, stride, &mut contents.vertices)?;
                        }
                        return Ok(());
                    }
                    if element.name == "vertex" {
                        self.vertices(element, offset, stride, &mut contents.vertices)?;
                    }
                    Some(offset + size)
                }
                None if element.name == "vertex" => {
                    self.walk_vertices(element, offset, &mut contents.vertices)?
                }
                None => {
                    let bare = self.extras.is_none() || element.name != "face";
                    let uniform = match list.filter(|_| bare) {
                        Some(list) => {
                            self.uniform_faces(element, list, offset, &mut contents.faces)?
                        }
                        None => None,
                    };
                    match uniform {
                        None if !self.findings.any_error() => {
                            let read = match list {
                                Some(list) => {
                                    self.regular_faces(element, list, offset, contents)?
                                }
                                None => Read::default(),
                            };
                            self.walk_faces(element, list, (offset, read), contents)?
                        }
                        end => end,
                    }
                }
            };
            match walked {
                Some(end) if !self.findings.any_error() => offset = end,
                _ => return Ok(()),
            }
        }
        self.check_rest(offset)
    }

    /// Warns of bytes behind the last element, unless they are but blanks.
    fn check_rest(&mut self, offset: u64) -> io::Result<()> {
        let mut rest = [0; 16];
        let read = self.blob.read_full(&mut rest, offset)?;
        if !rest[..read].trim_ascii().is_empty() {
            let count = self.blob.len().saturating_sub(offset);
            self.warn("bytes behind the end", || {
                format!("{count} bytes behind the last element are ignored")
            });
        }
        Ok(())
    }

    /// Whether all rows of an element are there, of `stride` bytes each, at least 1.
    fn has_rows(&self, element: &Element, offset: u64, stride: usize) -> bool {
        let there = self.blob.len().saturating_sub(offset);
        stride > 0 && element.count.saturating_mul(stride as u64) <= there
    }

    /// Reads edges of `stride` bytes each, all of which are there; where they end.
    fn edges(
        &mut self,
        plan: &EdgePlan,
        (element, offset, stride): (&Element, u64, usize),
        edges: &mut Edges,
    ) -> io::Result<Option<u64>> {
        let make = Make::new(element, stride, self.header.encoding == Encoding::Big);
        let severity = self.plan.damage();
        let step = (BLOCK / stride).max(1) as u64;
        let blocks = element.count.div_ceil(step);
        let pieces = (0..blocks)
            .into_par_iter()
            .map_init(Vec::new, |buffer, block| {
                let first = block * step;
                let rows = (element.count - first).min(step) as usize;
                let bytes = self.block(buffer, offset + first * stride as u64, rows * stride)?;
                let (mut piece, mut findings) = (Edges::default(), Findings::default());
                for (number, row) in (first..).zip(bytes.chunks_exact(stride)) {
                    if let Err(fault) = piece.add(plan, &make.row(row, &plan.columns)) {
                        tell(&mut findings, severity, || self.whole(), "edge", number, &fault);
                    }
                }
                Ok((piece, findings))
            })
            .collect::<io::Result<Vec<_>>>()?;
        edges.reserve(plan, element.count as usize);
        for (piece, findings) in pieces {
            edges.append(piece);
            self.findings.append(findings);
        }
        Ok(Some(offset + element.count * stride as u64))
    }

    /// Reads vertices of `stride` bytes each, all of which are there.
    fn vertices(
        &mut self,
        element: &Element,
        offset: u64,
        stride: usize,
        vertices: &mut Vertices,
    ) -> io::Result<()> {
        let plan = &mut self.plan;
        let big = self.header.encoding == Encoding::Big;
        let make = Make::new(element, stride, big);
        let positions =
            [0, 1, 2].map(|axis| plan.columns[axis].map_or(Type::F32, |p| make.kinds[p]));
        if positions.iter().any(|k| matches!(k, Type::F64 | Type::I32 | Type::U32)) {
            let step = (element.count / ORIGIN_SAMPLES).max(1);
            let mut samples = Vec::new();
            let mut bytes = vec![0; stride];
            for number in (0..element.count).step_by(step as usize) {
                self.blob.read_full(&mut bytes, offset + number * stride as u64)?;
                let row = make.row(&bytes, &plan.columns);
                samples.push(DVec3::new(row[0], row[1], row[2]));
            }
            plan.origin = origin_of(samples);
        }
        let plan = &self.plan;
        *vertices = Vertices::zeros(plan, element.count as usize);
        let step = (BLOCK / stride).max(1);
        let mut rest = vertices.rest();
        let mut tasks = Vec::new();
        while rest.len() > 0 {
            let first = tasks.len() * step;
            tasks.push((first as u64, rest.take(step)));
        }
        let found = tasks
            .into_par_iter()
            .map_init(Vec::new, |buffer, (first, mut part)| {
                let bytes =
                    self.block(buffer, offset + first * stride as u64, part.len() * stride)?;
                let mut findings = Findings::default();
                if !part.fill(plan, &Rows { bytes, make: &make }) {
                    for (number, row) in (first..).zip(bytes.chunks_exact(stride)) {
                        if let Some(fault) = plan.blame(&make.row(row, &plan.columns)) {
                            let span = || self.whole();
                            let severity = Severity::Warning;
                            tell(&mut findings, severity, span, "vertex", number, &fault);
                        }
                    }
                }
                Ok(findings)
            })
            .collect::<io::Result<Vec<_>>>()?;
        for findings in found {
            self.findings.append(findings);
        }
        Ok(())
    }

    /// Reads faces that all have as many corners as the first, and says where they end; `None` if
    /// they do not, or after an error.
    fn uniform_faces(
        &mut self,
        element: &Element,
        list: FaceList,
        offset: u64,
        faces: &mut Faces,
    ) -> io::Result<Option<u64>> {
        let Some(layout) = Layout::of_first(self, element, list, offset)? else { return Ok(None) };
        let there = self.blob.len().saturating_sub(offset);
        if element.count.checked_mul(layout.stride as u64).is_none_or(|size| size > there) {
            return Ok(None);
        }
        let cuts = layout.corners - 2;
        let triangles = element.count.saturating_mul(cuts as u64);
        if !self.has_room(triangles, 12 * triangles) {
            return Ok(None);
        }
        let first = faces.indices.len();
        faces.indices.resize(first + triangles as usize, [0; 3]);
        let step = (BLOCK / layout.stride).max(1);
        let found = faces.indices[first..]
            .par_chunks_mut(step * cuts)
            .enumerate()
            .map_init(Vec::new, |buffer, (block, triangles)| {
                let number = block * step;
                let size = triangles.len() / cuts * layout.stride;
                let at = offset + (number * layout.stride) as u64;
                let bytes = self.block(buffer, at, size)?;
                Ok(layout.convert(bytes, number as u64, triangles, self))
            })
            .collect::<io::Result<Vec<_>>>()?;
        if found.iter().any(Option::is_none) {
            faces.indices.truncate(first);
            return Ok(None);
        }
        for findings in found.into_iter().flatten() {
            self.findings.append(findings);
        }
        if cuts > 1 {
            let fans = (0..element.count as usize).map(|i| (first + i * cuts) as u32);
            faces.polygons.extend(fans.map(|start| [start, layout.corners as u32]));
        }
        Ok(Some(offset + element.count * layout.stride as u64))
    }

    /// Reads vertices among lists; where they end, or `None` after an error.
    fn walk_vertices(
        &mut self,
        element: &Element,
        offset: u64,
        vertices: &mut Vertices,
    ) -> io::Result<Option<u64>> {
        let mut walk = Walk::new(self, offset);
        let mut findings = Findings::default();
        let mut values = Vec::with_capacity(element.properties.len());
        for number in 0..element.count {
            if !walk.row(element, &mut values)? {
                self.tell_truncated(element, number);
                return Ok(None);
            }
            let row = self.plan.columns.map(|column| column.map_or(0.0, |c| values[c]));
            vertices.push(&self.plan, &row);
            if let Some(fault) = self.plan.blame(&row) {
                let span = || self.whole();
                tell(&mut findings, Severity::Warning, span, "vertex", number, &fault);
            }
        }
        self.findings.append(findings);
        Ok(Some(walk.offset()))
    }

    /// Reads or skips rows with lists behind those that were read before, those of `list` as faces; where
    /// they end, or `None` after an error.
    fn walk_faces(
        &mut self,
        element: &Element,
        list: Option<FaceList>,
        (offset, read): (u64, Read),
        contents: &mut Contents,
    ) -> io::Result<Option<u64>> {
        if self.findings.any_error() {
            return Ok(None);
        }
        let Contents { faces, extras, .. } = contents;
        let plan = self.extras.clone().filter(|_| element.name == "face");
        let mut own = ExtrasRow::default();
        let mut walk = Walk::new(self, offset + read.bytes);
        let mut findings = read.findings;
        let (mut numbers, mut scratch) = (Vec::new(), Vec::new());
        let most = self.limits.bytes / 8;
        for number in read.rows..element.count {
            for (i, property) in element.properties.iter().enumerate() {
                let used = plan.as_ref().and_then(|plan| plan.of(i));
                let whole = match (property.list, list) {
                    (None, _) => {
                        let number = walk.number(property.kind)?;
                        if let (Some(used), Some(number)) = (used, number) {
                            own.set(used, number);
                        }
                        number.is_some()
                    }
                    (Some(count), Some(list)) if list.property == i => {
                        walk.list(count, property.kind, most, &mut numbers, |n| n as i64)?
                    }
                    (Some(count), _) if used == Some(Use::Uvs) => {
                        walk.list(count, property.kind, most, &mut own.uvs, |n| n as f32)?
                    }
                    (Some(count), _) => walk.skip_list(count, property.kind)?,
                };
                if !whole {
                    self.tell_truncated(element, number);
                    return Ok(None);
                }
            }
            let Some(FaceList { kind, .. }) = list else { continue };
            let before = faces.indices.len();
            if let Err(fault) = faces.add(kind, &numbers, self.vertex_count, &mut scratch) {
                let span = || self.whole();
                tell(&mut findings, self.plan.damage(), span, "face", number, &fault);
            } else if let Some(plan) = &plan {
                extras.add(plan, &own, numbers.len(), [before, faces.indices.len()]);
            }
            // Asked now and then: a row adds little.
            let bytes = faces.bytes() + extras.bytes();
            if number % 1024 == 0 && !self.has_room(faces.indices.len() as u64, bytes) {
                return Ok(None);
            }
        }
        self.findings.append(findings);
        let room = self.has_room(faces.indices.len() as u64, faces.bytes() + extras.bytes());
        Ok(room.then_some(walk.offset()))
    }

    /// So many bytes from there on, all of which are there.
    pub(super) fn block<'b>(
        &self,
        buffer: &'b mut Vec<u8>,
        offset: u64,
        size: usize,
    ) -> io::Result<&'b [u8]> {
        buffer.resize(size, 0);
        if self.blob.read_full(buffer, offset)? < size {
            return Err(io::Error::new(
                io::ErrorKind::UnexpectedEof,
                "it became shorter meanwhile",
            ));
        }
        Ok(buffer)
    }
}

/// Faces of one length.
struct Layout {
    /// Bytes of a row, where in it the count stands, and where the numbers.
    stride: usize,
    count: Range<usize>,
    numbers: Range<usize>,
    count_kind: Type,
    kind: Type,
    corners: usize,
    big: bool,
}

impl Layout {
    /// The layout of the first face; `None` if others cannot be expected to have it too.
    fn of_first(
        body: &Body<'_>,
        element: &Element,
        list: FaceList,
        offset: u64,
    ) -> io::Result<Option<Self>> {
        let lists = element.properties.iter().filter(|p| p.list.is_some()).count();
        let property = &element.properties[list.property];
        let (Some(count_kind), 1, Kind::Face) = (property.list, lists, list.kind) else {
            return Ok(None);
        };
        let size = |range: Range<usize>| -> usize {
            element.properties[range].iter().map(|p| p.kind.size()).sum()
        };
        let before = size(0..list.property);
        let behind = size(list.property + 1..element.properties.len());
        let count = before..before + count_kind.size();
        let mut first = vec![0; count.end];
        if element.count == 0 || body.blob.read_full(&mut first, offset)? < first.len() {
            return Ok(None);
        }
        let big = body.header.encoding == Encoding::Big;
        let corners = load(&first[count.clone()], count_kind, big);
        if !(3.0..=64.0).contains(&corners) {
            return Ok(None);
        }
        let corners = corners as usize;
        let numbers = count.end..count.end + corners * property.kind.size();
        let stride = numbers.end + behind;
        Ok(Some(Self { stride, count, numbers, count_kind, kind: property.kind, corners, big }))
    }

    /// Converts rows to fans; `None` if one has another number of corners.
    fn convert(
        &self,
        bytes: &[u8],
        first: u64,
        triangles: &mut [[u32; 3]],
        body: &Body<'_>,
    ) -> Option<Findings> {
        let last = body.vertex_count.saturating_sub(1);
        let (corners, mut sound) = (self.corners as f64, body.vertex_count > 0);
        let rows =
            bytes.chunks_exact(self.stride).zip(triangles.chunks_exact_mut(self.corners - 2));
        for (row, fan) in rows {
            if load(&row[self.count.clone()], self.count_kind, self.big) != corners {
                return None;
            }
            let numbers = &row[self.numbers.clone()];
            if self.kind.size() == 4 && !self.big && self.corners == 3 {
                // Nearly all files. A negative number is a very large one.
                let (quads, _) = numbers.as_chunks::<4>();
                let triangle = [quads[0], quads[1], quads[2]].map(u32::from_le_bytes);
                sound &= triangle.iter().all(|i| u64::from(*i) <= last);
                fan[0] = triangle;
                continue;
            }
            let number = |i: usize| {
                let size = self.kind.size();
                load(&numbers[i * size..(i + 1) * size], self.kind, self.big)
            };
            sound &= (0..self.corners).all(|i| (0.0..=last as f64).contains(&number(i)));
            for (i, triangle) in fan.iter_mut().enumerate() {
                *triangle = [0, i + 1, i + 2].map(|i| number(i) as u32);
            }
        }
        let mut findings = Findings::default();
        if !sound {
            for (i, row) in bytes.chunks_exact(self.stride).enumerate() {
                let numbers = row[self.numbers.clone()].chunks_exact(self.kind.size());
                let mut numbers = numbers.map(|n| load(n, self.kind, self.big) as i64);
                let bad = numbers.find(|n| *n < 0 || *n as u64 >= body.vertex_count);
                if let Some(bad) = bad {
                    let number = first + i as u64;
                    let fault = out_of_range(bad, body.vertex_count);
                    let span = || body.whole();
                    tell(&mut findings, body.plan.damage(), span, "face", number, &fault);
                }
            }
        }
        Some(findings)
    }
}

/// How rows without lists are made.
struct Make {
    stride: usize,
    /// Where each property stands in a row.
    places: Vec<Range<usize>>,
    kinds: Vec<Type>,
    big: bool,
}

impl Make {
    fn new(element: &Element, stride: usize, big: bool) -> Self {
        let mut end = 0;
        let mut place = |kind: &Type| {
            end += kind.size();
            end - kind.size()..end
        };
        let kinds: Vec<_> = element.properties.iter().map(|p| p.kind).collect();
        Self { stride, places: kinds.iter().map(&mut place).collect(), kinds, big }
    }

    /// What of a row is used.
    fn row(&self, bytes: &[u8], columns: &[Option<usize>; WIDTH]) -> Row {
        let value = |c: usize| load(&bytes[self.places[c].clone()], self.kinds[c], self.big);
        columns.map(|column| column.map_or(0.0, value))
    }
}

/// Rows as they stand in the file.
struct Rows<'a> {
    bytes: &'a [u8],
    make: &'a Make,
}

impl Columns for Rows<'_> {
    fn fill<T>(&self, column: usize, rows: &mut [T], mut set: impl FnMut(&mut T, f64)) {
        let Make { stride, ref places, ref kinds, big } = *self.make;
        let at = places[column].start;
        macro_rules! each {
            ($type:ty) => {
                for (row, out) in self.bytes.chunks_exact(stride).zip(rows) {
                    if let Some(bytes) = row[at..].first_chunk() {
                        let value = if big {
                            <$type>::from_be_bytes(*bytes)
                        } else {
                            <$type>::from_le_bytes(*bytes)
                        };
                        set(out, f64::from(value));
                    }
                }
            };
        }
        match kinds[column] {
            Type::I8 => each!(i8),
            Type::U8 => each!(u8),
            Type::I16 => each!(i16),
            Type::U16 => each!(u16),
            Type::I32 => each!(i32),
            Type::U32 => each!(u32),
            Type::F32 => each!(f32),
            Type::F64 => each!(f64),
        }
    }
}
