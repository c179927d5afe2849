//! Faces of which more is read than their corners, as long as all their lists are as long as those of the first:
//! blocks of rows, by all threads.

use std::io;
use std::ops::Range;

use rayon::prelude::*;

use super::body::{Body, Contents, FaceList};
use super::extras::{Extras, ExtrasPlan, ExtrasRow, Use};
use super::header::{Element, Encoding, Type};
use super::vertices::tell;
use super::walk::{BLOCK, load};
use crate::format::faces::{Faces, Kind};
use crate::format::text::Findings;

/// The longest list that a row of one length may have.
const LONGEST: f64 = 64.0;

/// Rows that were read.
#[derive(Debug, Default)]
pub(super) struct Read {
    /// How many.
    pub(super) rows: u64,
    /// Bytes that they take.
    pub(super) bytes: u64,
    /// What is to be said of them.
    pub(super) findings: Findings,
}

impl Body<'_> {
    /// Reads the faces of an element up to the first block with a row that is not as long as the first of
    /// all. An error about limits is in the body's findings.
    pub(super) fn regular_faces(
        &mut self,
        element: &Element,
        list: FaceList,
        offset: u64,
        contents: &mut Contents,
    ) -> io::Result<Read> {
        let mut read = Read::default();
        let plan = self.extras.clone().filter(|_| element.name == "face");
        let Some(rows) = Rows::of_first(self, element, list, plan.as_ref(), offset)? else {
            return Ok(read);
        };
        let stride = rows.stride as u64;
        let there = self.blob.len().saturating_sub(offset) / stride;
        let (count, step) = (element.count.min(there), (BLOCK as u64 / stride).max(1));
        let wave = 4 * rayon::current_num_threads() as u64 * step;
        let Contents { faces, extras, .. } = contents;
        while read.rows < count {
            let end = (read.rows + wave).min(count);
            let starts: Vec<u64> = (read.rows..end).step_by(step as usize).collect();
            let pieces = starts
                .into_par_iter()
                .map_init(Vec::new, |buffer, first| {
                    let size = (end - first).min(step) * stride;
                    let bytes = self.block(buffer, offset + first * stride, size as usize)?;
                    Ok(rows.piece(bytes, first, plan.as_ref(), self))
                })
                .collect::<io::Result<Vec<_>>>()?;
            for piece in pieces {
                let Some(Piece { rows, faces: own, extras: more, findings }) = piece else {
                    read.bytes = read.rows * stride;
                    return Ok(read);
                };
                extras.append(faces.indices.len(), more);
                faces.append(own);
                read.findings.append(findings);
                read.rows += rows;
            }
            if !self.has_room(faces.indices.len() as u64, faces.bytes() + extras.bytes()) {
                break;
            }
        }
        read.bytes = read.rows * stride;
        Ok(read)
    }
}

/// What some rows hold.
struct Piece {
    rows: u64,
    faces: Faces,
    extras: Extras,
    findings: Findings,
}

/// How rows of one length are made.
#[derive(Debug)]
struct Rows {
    stride: usize,
    fields: Vec<Field>,
    big: bool,
}

/// A property in a row.
#[derive(Debug)]
struct Field {
    /// Where the length of a list stands, of which type, and how long the list of every row is.
    count: Option<(Range<usize>, Type, f64)>,
    /// Where its numbers stand.
    numbers: Range<usize>,
    kind: Type,
    purpose: Purpose,
}

/// What a property is for.
#[derive(Clone, Copy, Debug)]
enum Purpose {
    Corners,
    Extra(Use),
    Nothing,
}

impl Rows {
    /// How the first row is made; `None` if others cannot be expected to be like it.
    fn of_first(
        body: &Body<'_>,
        element: &Element,
        list: FaceList,
        plan: Option<&ExtrasPlan>,
        offset: u64,
    ) -> io::Result<Option<Self>> {
        let lists = element.properties.iter().filter(|p| p.list.is_some()).count();
        // Of rows of one list and nothing else the corners are read, which is done elsewhere.
        if list.kind != Kind::Face || lists == 1 && plan.is_none() {
            return Ok(None);
        }
        let mut first = vec![0; BLOCK];
        let filled = body.blob.read_full(&mut first, offset)?;
        let big = body.header.encoding == Encoding::Big;
        let (mut at, mut fields) = (0, Vec::with_capacity(element.properties.len()));
        for (number, property) in element.properties.iter().enumerate() {
            let size = property.kind.size();
            let (count, length) = match property.list {
                None => (None, 1),
                Some(kind) => {
                    let place = at..at + kind.size();
                    if place.end > filled {
                        return Ok(None);
                    }
                    let count = load(&first[place.clone()], kind, big);
                    if !(0.0..=LONGEST).contains(&count) || count.fract() != 0.0 {
                        return Ok(None);
                    }
                    at = place.end;
                    (Some((place, kind, count)), count as usize)
                }
            };
            let numbers = at..at + length * size;
            at = numbers.end;
            let purpose = match plan.and_then(|plan| plan.of(number)) {
                _ if list.property == number => Purpose::Corners,
                Some(used) if (used == Use::Uvs) == count.is_some() => Purpose::Extra(used),
                _ => Purpose::Nothing,
            };
            fields.push(Field { count, numbers, kind: property.kind, purpose });
        }
        Ok((at <= filled && at > 0).then_some(Self { stride: at, fields, big }))
    }

    /// What rows hold of which the first has this number; `None` if one is not like the first of all.
    fn piece(
        &self,
        bytes: &[u8],
        first: u64,
        plan: Option<&ExtrasPlan>,
        body: &Body<'_>,
    ) -> Option<Piece> {
        let (mut faces, mut extras) = (Faces::default(), Extras::default());
        let (mut own, mut findings) = (ExtrasRow::default(), Findings::default());
        let (mut corners, mut scratch) = (Vec::new(), Vec::new());
        for (number, row) in (first..).zip(bytes.chunks_exact(self.stride)) {
            for Field { count, numbers, kind, purpose } in &self.fields {
                if let Some((place, kind, expected)) = count
                    && load(&row[place.clone()], *kind, self.big) != *expected
                {
                    return None;
                }
                let numbers = row[numbers.clone()].chunks_exact(kind.size());
                let mut numbers = numbers.map(|bytes| load(bytes, *kind, self.big));
                match *purpose {
                    Purpose::Nothing => {}
                    Purpose::Corners => {
                        corners.clear();
                        corners.extend(numbers.map(|n| n as i64));
                    }
                    Purpose::Extra(Use::Uvs) => {
                        own.uvs.clear();
                        own.uvs.extend(numbers.map(|n| n as f32));
                    }
                    Purpose::Extra(used) => {
                        if let Some(n) = numbers.next() {
                            own.set(used, n);
                        }
                    }
                }
            }
            let before = faces.indices.len();
            if let Err(fault) = faces.add(Kind::Face, &corners, body.vertex_count, &mut scratch) {
                let span = || body.whole();
                tell(&mut findings, body.plan.damage(), span, "face", number, &fault);
            } else if let Some(plan) = plan {
                extras.add(plan, &own, corners.len(), [before, faces.indices.len()]);
            }
        }
        let rows = (bytes.len() / self.stride) as u64;
        Some(Piece { rows, faces, extras, findings })
    }
}
