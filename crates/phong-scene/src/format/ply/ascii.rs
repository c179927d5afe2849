//! ASCII bodies: a row a line, parsed in parallel piece by piece.

use std::io;
use std::sync::Arc;

use glam::DVec3;

use super::body::{Body, Contents, FaceList, ORIGIN_SAMPLES};
use super::edges::EdgePlan;
use super::extras::{ExtrasPlan, ExtrasRow, Use};
use super::header::Element;
use super::names::{FIELD, Row, WIDTH};
use super::vertices::{Plan, tell};
use crate::diagnostic::{Severity, Span};
use crate::format::origin::origin_of;
use crate::format::text::{Cursor, Decimal, Findings, Lines, Piece, Rows, blame};

/// Bytes from the beginning of the body that are looked through for the origin.
const SAMPLE: usize = 256 << 10;

/// What one piece of the body holds.
#[derive(Debug, Default)]
struct Block {
    contents: Contents,
    findings: Findings,
    /// How many rows end with it.
    rows: u64,
}

/// How the rows of the elements follow one another.
struct Layout<'a> {
    file: &'a Arc<str>,
    plan: &'a Plan,
    vertex_count: u64,
    /// Each element with its first row, and what makes it faces.
    elements: Vec<(u64, &'a Element, Option<FaceList>)>,
    /// For every property of a vertex its place in a [`Row`].
    places: Vec<Option<usize>>,
    edges: Option<&'a EdgePlan>,
    extras: Option<&'a ExtrasPlan>,
}

/// What is used again for every face.
#[derive(Default)]
struct Scratch {
    numbers: Vec<i64>,
    fan: Vec<u32>,
    extras: ExtrasRow,
}

impl Body<'_> {
    /// Reads the elements one behind the other.
    pub(super) fn read_ascii(&mut self, contents: &mut Contents) -> io::Result<()> {
        let header = self.header;
        let mut first = 0;
        let mut elements = Vec::new();
        for element in &header.elements {
            elements.push((first, element, self.face_list(element)));
            // What has no properties has no lines.
            first += if element.properties.is_empty() { 0 } else { element.count };
        }
        let all = first;
        let start = header.body;
        let lines =
            Lines { blob: self.blob, start, line: header.line, joined: false, rows: Rows::All };
        self.plan.origin = origin_of(self.sample(&elements)?);

        let (plan, edges, extras) = (self.plan.clone(), self.edges.clone(), self.extras.clone());
        let vertex = header.elements.iter().find(|e| e.name == "vertex");
        let place = |property| plan.columns.iter().position(|c| *c == Some(property));
        let places = (0..vertex.map_or(0, |e| e.properties.len())).map(place).collect();
        let (file, vertex_count) = (self.file, self.vertex_count);
        let (edges, extras) = (edges.as_ref(), extras.as_ref());
        let layout = Layout { file, plan: &plan, vertex_count, elements, places, edges, extras };
        let mut rows = 0;
        lines.each(
            |piece| layout.parse(piece),
            |block| {
                rows = block.rows;
                self.findings.append(block.findings);
                contents.append(block.contents);
                self.has_room(contents.faces.indices.len() as u64, contents.face_bytes())
            },
        )?;
        if let Some((first, element, _)) = layout
            .elements
            .iter()
            .find(|(first, e, _)| rows < first + e.count && !e.properties.is_empty())
            && !self.findings.any_error()
        {
            self.tell_truncated(element, rows.saturating_sub(*first));
        }
        if rows > all {
            self.warn("lines behind the end", || {
                format!("{} lines behind the last element are ignored", rows - all)
            });
        }
        Ok(())
    }

    /// The first positions, if vertices come first.
    fn sample(&self, elements: &[(u64, &Element, Option<FaceList>)]) -> io::Result<Vec<DVec3>> {
        let Some((_, element, _)) = elements.first().filter(|(_, e, _)| e.name == "vertex") else {
            return Ok(Vec::new());
        };
        let mut text = vec![0; SAMPLE.min(self.blob.len() as usize)];
        let read = self.blob.read_full(&mut text, self.header.body)?;
        let piece = Piece { text: &text[..read], offset: 0, line: 1, rows: 0 };
        let mut cursor = Cursor::new(piece, false);
        let mut samples = Vec::new();
        while !cursor.is_done() && (samples.len() as u64) < element.count.min(ORIGIN_SAMPLES) {
            let mut numbers = Vec::new();
            while numbers.len() < element.properties.len() && cursor.more() {
                let Some(decimal) = cursor.decimal() else { break };
                numbers.push(decimal.to_f64());
            }
            cursor.next_line();
            let get = |axis: usize| self.plan.columns[axis].and_then(|c| numbers.get(c).copied());
            // The last line may be cut.
            if let (false, Some(x), Some(y), Some(z)) = (cursor.is_done(), get(0), get(1), get(2)) {
                samples.push(DVec3::new(x, y, z));
            }
        }
        Ok(samples)
    }
}

impl Layout<'_> {
    fn parse(&self, piece: Piece<'_>) -> Block {
        let mut block = Block::default();
        let mut cursor = Cursor::new(piece, false);
        let mut row = piece.rows;
        let mut scratch = Scratch::default();
        while !cursor.is_done() {
            if cursor.is_blank() {
                cursor.next_line();
                continue;
            }
            let behind = self.elements.partition_point(|(first, ..)| *first <= row);
            let found =
                self.elements[..behind].iter().rev().find(|(_, e, _)| !e.properties.is_empty());
            if let Some((first, element, list)) =
                found.filter(|(first, e, _)| row < first + e.count)
            {
                let number = row - first;
                if element.name == "vertex" {
                    self.vertex(&mut cursor, element, number, &mut block);
                } else if let Some(plan) = self.edges.filter(|_| element.name == "edge") {
                    self.edge(&mut cursor, element, plan, number, &mut block);
                } else if let Some(list) = list {
                    self.face(&mut cursor, element, *list, number, &mut block, &mut scratch);
                } else {
                    cursor.finish_line();
                }
                if cursor.more() {
                    block.findings.warning(
                        "lines with more numbers than properties",
                        || cursor.here(self.file),
                        || format!("{} {number} has more numbers than properties", element.name),
                    );
                }
            }
            row += 1;
            cursor.next_line();
        }
        block.rows = row;
        block
    }

    fn vertex(&self, cursor: &mut Cursor<'_>, element: &Element, number: u64, block: &mut Block) {
        let start = cursor.clone();
        let mut row: Row = [0.0; WIDTH];
        for (i, property) in element.properties.iter().enumerate() {
            let place = self.places[i];
            let read = match (property.list, place) {
                // Blender 2.77 gives vertices the list of faces that are not there.
                (Some(_), _) if !cursor.more() => {
                    block.findings.warning(
                        "lines without their list",
                        || start.here(self.file),
                        || format!("vertex {number} lacks its list `{}`", property.name),
                    );
                    Some(())
                }
                (Some(_), _) => skip_list(cursor),
                // Integers are colours, or positions that f32 may not hold.
                (None, Some(place)) if place > 2 && property.kind.is_float() => {
                    cursor.float(0.0).map(|value| row[place] = f64::from(value))
                }
                (None, Some(place)) if place < 3 && self.plan.origin[place] == 0.0 => {
                    cursor.float(0.0).map(|value| row[place] = f64::from(value))
                }
                (None, Some(place)) => double(cursor).map(|value| row[place] = value),
                // Whatever it says: MeshLab writes NaN for a quality it does not know.
                (None, None) => skip(cursor),
            };
            if read.is_none() {
                if let (None, Some(place)) = (property.list, place)
                    && cursor.take_no_number()
                {
                    row[place] = f64::NAN;
                    continue;
                }
                let (span, fault) = self.blame(cursor, i, element);
                tell(&mut block.findings, Severity::Error, || span, "vertex", number, &fault);
                cursor.finish_line();
                // The others keep their numbers.
                block.contents.vertices.push(self.plan, &[0.0; WIDTH]);
                return;
            }
        }
        for field in FIELD..WIDTH {
            // What a map shows may be a colour as well, say.
            if let Some(place) = self.plan.columns[field].and_then(|property| self.places[property])
            {
                row[field] = row[place];
            }
        }
        if let Some(fault) = self.plan.blame(&row) {
            let span = || start.here(self.file);
            tell(&mut block.findings, Severity::Warning, span, "vertex", number, &fault);
        }
        block.contents.vertices.push(self.plan, &row);
    }

    fn edge(
        &self,
        cursor: &mut Cursor<'_>,
        element: &Element,
        plan: &EdgePlan,
        number: u64,
        block: &mut Block,
    ) {
        let start = cursor.clone();
        let mut row: Row = [0.0; WIDTH];
        for (i, property) in element.properties.iter().enumerate() {
            let read = if property.list.is_some() {
                skip_list(cursor)
            } else if plan.columns.contains(&Some(i)) {
                // One radius may be that of both ends.
                double(cursor).map(|value| {
                    let places = row.iter_mut().zip(&plan.columns);
                    places.filter(|(_, c)| **c == Some(i)).for_each(|(place, _)| *place = value);
                })
            } else {
                skip(cursor)
            };
            if read.is_none() {
                let (span, fault) = self.blame(cursor, i, element);
                tell(&mut block.findings, Severity::Error, || span, "edge", number, &fault);
                cursor.finish_line();
                return;
            }
        }
        if let Err(fault) = block.contents.edges.add(plan, &row) {
            let span = || start.here(self.file);
            let severity = self.plan.damage();
            tell(&mut block.findings, severity, span, "edge", number, &fault);
        }
    }

    fn face(
        &self,
        cursor: &mut Cursor<'_>,
        element: &Element,
        list: FaceList,
        number: u64,
        block: &mut Block,
        Scratch { numbers, fan, extras: row }: &mut Scratch,
    ) {
        let start = cursor.clone();
        let extras = self.extras.filter(|_| element.name == "face");
        for (i, property) in element.properties.iter().enumerate() {
            let used = extras.and_then(|extras| extras.of(i));
            let read = match (property.list.is_some(), used) {
                _ if i == list.property => read_list(cursor, numbers),
                (true, Some(Use::Uvs)) => read_floats(cursor, &mut row.uvs),
                (true, _) => skip_list(cursor),
                (false, Some(used)) => double(cursor)
                    .or_else(|| cursor.take_no_number().then_some(f64::NAN))
                    .map(|number| row.set(used, number)),
                (false, None) => skip(cursor),
            };
            if read.is_none() {
                let (span, fault) = self.blame(cursor, i, element);
                tell(&mut block.findings, Severity::Error, || span, "face", number, &fault);
                cursor.finish_line();
                return;
            }
        }
        let faces = &mut block.contents.faces;
        let before = faces.indices.len();
        if let Err(fault) = faces.add(list.kind, numbers, self.vertex_count, fan) {
            let span = || start.here(self.file);
            let severity = self.plan.damage();
            tell(&mut block.findings, severity, span, "face", number, &fault);
        } else if let Some(plan) = extras {
            let triangles = [before, faces.indices.len()];
            block.contents.extras.add(plan, row, numbers.len(), triangles);
        }
    }

    /// Why a property could not be read from where the cursor stands.
    fn blame(&self, cursor: &mut Cursor<'_>, property: usize, element: &Element) -> (Span, String) {
        let something = cursor.more();
        let name = &element.properties[property].name;
        let fault = if !something {
            format!("the line ends before `{name}`")
        } else if cursor.clone().decimal().is_some() {
            let integer = element.properties[property].list.is_some();
            let what = if integer { "is no integer" } else { "is too large" };
            format!("`{}` {what}", cursor.quote())
        } else {
            format!("`{}` {}", cursor.quote(), blame(cursor.rest()))
        };
        (cursor.here(self.file), fault)
    }
}

/// A finite number, else the cursor stays.
fn double(cursor: &mut Cursor<'_>) -> Option<f64> {
    if !cursor.more() {
        return None;
    }
    let start = cursor.clone();
    let value = cursor.decimal()?.to_f64();
    if !value.is_finite() {
        *cursor = start;
        return None;
    }
    Some(value)
}

fn integer(cursor: &mut Cursor<'_>) -> Option<i64> {
    if !cursor.more() {
        return None;
    }
    let start = cursor.clone();
    let value = cursor.decimal().and_then(Decimal::to_integer);
    if value.is_none() {
        *cursor = start;
    }
    value
}

fn read_list(cursor: &mut Cursor<'_>, numbers: &mut Vec<i64>) -> Option<()> {
    numbers.clear();
    for _ in 0..integer(cursor)? {
        numbers.push(integer(cursor)?);
    }
    Some(())
}

/// Numbers, of which some may be none.
fn read_floats(cursor: &mut Cursor<'_>, numbers: &mut Vec<f32>) -> Option<()> {
    numbers.clear();
    for _ in 0..integer(cursor)? {
        let number = cursor.float(0.0).or_else(|| cursor.take_no_number().then_some(f32::NAN));
        numbers.push(number?);
    }
    Some(())
}

fn skip_list(cursor: &mut Cursor<'_>) -> Option<()> {
    for _ in 0..integer(cursor)? {
        skip(cursor)?;
    }
    Some(())
}

/// Goes over a word, if there is one.
fn skip(cursor: &mut Cursor<'_>) -> Option<()> {
    (!cursor.word().is_empty()).then_some(())
}
