//! Rows: a vertex or a face a line, parsed in parallel piece by piece.

use std::io;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::Contents;
use super::header::Header;
use crate::format::faces::Kind;
use crate::format::origin::origin_of;
use crate::format::text::{Cursor, Decimal, Findings, Lines, Piece, Rows, blame, whole};
use crate::format::triangles::has_room;
use crate::limits::Limits;
use crate::source::Blob;

/// Bytes from the beginning of the rows that are looked through for the origin, and positions.
const SAMPLE: usize = 256 << 10;
const SAMPLES: u64 = 4096;

/// Most numbers behind the place of a vertex, or behind the corners of a face, that are looked at.
const MOST: usize = 16;

/// The rows of a file.
pub(super) struct Body<'a> {
    pub(super) blob: &'a dyn Blob,
    pub(super) file: &'a Arc<str>,
    pub(super) header: &'a Header,
    pub(super) limits: &'a Limits,
}

/// What one piece holds.
#[derive(Debug, Default)]
struct Block {
    contents: Contents,
    findings: Findings,
    /// How many rows end with it.
    rows: u64,
}

/// What is used again for every row.
#[derive(Debug, Default)]
struct Scratch {
    numbers: Vec<f32>,
    corners: Vec<i64>,
    fan: Vec<u32>,
}

impl Body<'_> {
    /// Reads all rows.
    pub(super) fn read(&self, findings: &mut Findings) -> io::Result<Contents> {
        let Self { blob, file, header, limits } = *self;
        let mut all = Contents { origin: origin_of(self.sample()?), ..Contents::default() };
        let origin = all.origin;
        let mut rows = 0;
        let (start, line) = (header.body, header.line);
        let lines = Lines { blob, start, line, joined: false, rows: Rows::WithoutComments };
        lines.each(
            |piece| self.parse(piece, origin),
            |block| {
                rows = block.rows;
                findings.append(block.findings);
                all.append(block.contents);
                let (triangles, vertices) = (all.faces.indices.len(), all.positions.len());
                let (triangles, vertices) = (triangles as u64, vertices as u64);
                has_room(triangles, vertices, all.bytes(), limits, file, findings)
            },
        )?;
        let Header { vertices, faces, .. } = *header;
        let wanted = vertices.saturating_add(faces);
        if rows < wanted && !findings.any_error() {
            let message = || {
                if rows < vertices {
                    format!("the file ends after {rows} of {vertices} vertices")
                } else {
                    format!("the file ends after {} of {faces} faces", rows - vertices)
                }
            };
            findings.damage(limits.lenient, "truncated files", || whole(file), message);
        }
        if rows > wanted {
            let message = || format!("{} lines behind the last face are ignored", rows - wanted);
            findings.warning("lines behind the end", || whole(file), message);
        }
        Ok(all)
    }

    /// The first positions.
    fn sample(&self) -> io::Result<Vec<DVec3>> {
        let mut text = vec![0; SAMPLE.min(self.blob.len() as usize)];
        let read = self.blob.read_full(&mut text, self.header.body)?;
        let mut cursor =
            Cursor::new(Piece { text: &text[..read], offset: 0, line: 1, rows: 0 }, false);
        let mut samples = Vec::new();
        while !cursor.is_done() && (samples.len() as u64) < self.header.vertices.min(SAMPLES) {
            let mut number =
                || if cursor.more() { cursor.decimal().map(Decimal::to_f64) } else { None };
            let place = (number(), number(), number());
            cursor.next_line();
            // The last line may be cut.
            if let (false, (Some(x), Some(y), Some(z))) = (cursor.is_done(), place) {
                samples.push(DVec3::new(x, y, z));
            }
        }
        Ok(samples)
    }

    fn parse(&self, piece: Piece<'_>, origin: DVec3) -> Block {
        let Header { vertices, faces, .. } = *self.header;
        let mut block = Block { rows: piece.rows, ..Block::default() };
        let mut cursor = Cursor::new(piece, false);
        let mut scratch = Scratch::default();
        while !cursor.is_done() {
            if cursor.more() {
                let row = block.rows;
                block.rows += 1;
                if row < vertices {
                    self.vertex(&mut cursor, row, origin, &mut block, &mut scratch);
                } else if row - vertices < faces {
                    self.face(&mut cursor, row - vertices, &mut block, &mut scratch);
                }
            }
            cursor.next_line();
        }
        block
    }

    fn vertex(
        &self,
        cursor: &mut Cursor<'_>,
        row: u64,
        origin: DVec3,
        block: &mut Block,
        Scratch { numbers, .. }: &mut Scratch,
    ) {
        let Block { contents, findings, .. } = block;
        let has = self.header.has;
        let mut place = Vec3::NAN;
        for axis in 0..3 {
            let start = cursor.clone();
            if let Some(value) = cursor.float(origin[axis]) {
                place[axis] = value;
                continue;
            }
            let name = ["x", "y", "z"][axis];
            if cursor.take_no_number() {
                findings.warning("vertices of which something is left out", || start.here(self.file), || {
                    let without = if self.header.faces > 0 { "its faces are" } else { "it is" };
                    format!("vertex {row} (counted from 0): its `{name}` is no number; {without} left out")
                });
                continue;
            }
            let message = || {
                let fault = match (cursor.clone().more(), cursor.clone().decimal()) {
                    (false, _) => format!("the line ends before `{name}`"),
                    (true, Some(_)) => format!("`{}` is too large", cursor.quote()),
                    (true, None) => format!("`{}` {}", cursor.quote(), blame(cursor.rest())),
                };
                format!("vertex {row} (counted from 0): {fault}")
            };
            findings.error("vertices that cannot be read", || cursor.here(self.file), message);
            break;
        }
        contents.positions.push(place);
        numbers.clear();
        while numbers.len() < MOST && cursor.more() {
            match cursor.float(0.0) {
                Some(value) => numbers.push(value),
                None if cursor.take_no_number() => numbers.push(f32::NAN),
                None => break,
            }
        }
        let mut rest = &numbers[..];
        // In this order: normal, colour, texture coordinates.
        if has.normal {
            let (normal, behind) = rest.split_at(rest.len().min(3));
            rest = behind;
            contents.normals.push(match *normal {
                [x, y, z] => Vec3::new(x, y, z),
                _ => Vec3::ZERO,
            });
        }
        if has.uv {
            let (behind, uv) = rest.split_at(rest.len().saturating_sub(2));
            rest = behind;
            contents.uvs.push(match *uv {
                [u, v] => Vec2::new(u, v),
                _ => Vec2::ZERO,
            });
        }
        if has.color && matches!(rest.len(), 3 | 4) {
            let number = contents.positions.len();
            contents.colors.set(number - 1, number, rest);
            rest = &[];
        }
        contents.odd += u64::from(!rest.is_empty() || cursor.more());
    }

    fn face(
        &self,
        cursor: &mut Cursor<'_>,
        row: u64,
        block: &mut Block,
        Scratch { numbers, corners, fan }: &mut Scratch,
    ) {
        let Block { contents, findings, .. } = block;
        let start = cursor.clone();
        corners.clear();
        let mut integer = || {
            let before = cursor.clone();
            let value =
                if cursor.more() { cursor.decimal().and_then(Decimal::to_integer) } else { None };
            if value.is_none() {
                *cursor = before;
            }
            value
        };
        let count = integer();
        let whole = count.is_some_and(|count| {
            (0..count).all(|_| integer().map(|corner| corners.push(corner)).is_some())
        });
        if !whole {
            let message = || {
                let fault = if cursor.more() {
                    format!("`{}` is no integer", cursor.quote())
                } else {
                    format!("the line ends after {} of its corners", corners.len())
                };
                format!("face {row} (counted from 0): {fault}")
            };
            findings.error("faces that cannot be read", || start.here(self.file), message);
            return;
        }
        let first = contents.faces.indices.len();
        let added = contents.faces.add(Kind::Face, corners, self.header.vertices, fan);
        if let Err(fault) = added {
            let plural = "faces that use a vertex out of range";
            let lenient = self.limits.lenient;
            let end = if lenient { "; it is left out" } else { "" };
            let message = || format!("face {row} (counted from 0): {fault}{end}");
            findings.damage(lenient, plural, || start.here(self.file), message);
            return;
        }
        numbers.clear();
        while numbers.len() < MOST && cursor.more() {
            match cursor.float(0.0) {
                Some(value) => numbers.push(value),
                None => break,
            }
        }
        match numbers.len() {
            0 if !cursor.more() => {}
            1 => contents.palette += 1,
            3 | 4 => contents.face_colors.set(first, contents.faces.indices.len(), numbers),
            _ => contents.odd += 1,
        }
    }
}

impl Contents {
    /// Adds those of a later piece.
    fn append(&mut self, mut later: Self) {
        self.colors.append(self.positions.len(), later.colors);
        self.face_colors.append(self.faces.indices.len(), later.face_colors);
        self.positions.append(&mut later.positions);
        self.normals.append(&mut later.normals);
        self.uvs.append(&mut later.uvs);
        self.faces.append(later.faces);
        self.palette += later.palette;
        self.odd += later.odd;
    }

    /// Bytes that all of it takes in memory.
    fn bytes(&self) -> u64 {
        let vectors = 12 * (self.positions.len() + self.normals.len()) + 8 * self.uvs.len();
        vectors as u64 + self.faces.bytes() + self.colors.bytes() + self.face_colors.bytes()
    }
}
