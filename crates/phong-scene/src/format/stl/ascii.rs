//! Files as text: statements, parsed in parallel piece by piece, and put together in order.
//!
//! Where the lines break counts for nothing, but a statement stands on one line with its numbers.

use std::io;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::{Facets, are_held, is_contrary};
use crate::format::origin::{origin_of, sample};
use crate::format::text::{Cursor, Findings, Lines, Piece, Rows, blame, whole};
use crate::format::triangles::has_room;
use crate::limits::{LARGEST, Limits};
use crate::mesh::{Hash, Weld};
use crate::source::Blob;

/// What stands for a corner that is no number.
const NO_CORNER: Vec3 = Vec3::NAN;

/// What one piece of the file holds.
#[derive(Debug, Default)]
struct Block {
    corners: Vec<Vec3>,
    /// Where among the corners facets begin, with their normals; 0: none that can be used.
    facets: Vec<(u32, Vec3)>,
    /// The last statement that says where the file stands.
    last: Option<Last>,
    findings: Findings,
}

/// Where a file may end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Last {
    /// Behind a solid.
    Outside,
    /// Between two facets of a solid.
    Between,
    /// Within a facet.
    Within,
}

/// Reads the facets of all solids.
pub(super) fn read(
    blob: &dyn Blob,
    file: &Arc<str>,
    limits: &Limits,
    findings: &mut Findings,
) -> io::Result<Facets> {
    let is_vertex = |cursor: &mut Cursor<'_>| cursor.word().eq_ignore_ascii_case(b"vertex");
    let origin = origin_of(sample(blob, false, is_vertex)?);
    let lines = Lines { blob, start: 0, line: 1, joined: false, rows: Rows::Uncounted };
    let mut assembly = Assembly {
        facets: Facets { origin, ..Facets::default() },
        weld: Weld::with_room(1 << 10, Hash::new()),
        open: None,
        corners: Vec::new(),
        last: Last::Outside,
    };
    lines.each(
        |piece| Block::parse(piece, origin, file),
        |mut block| {
            findings.append(std::mem::take(&mut block.findings));
            assembly.add(&block);
            let Assembly { facets, weld, .. } = &assembly;
            let (triangles, vertices) = (facets.indices.len(), weld.positions().len());
            let bytes = 12 * facets.indices.capacity() as u64 + weld.bytes();
            has_room(triangles as u64, vertices as u64, bytes, limits, file, findings)
        },
    )?;
    if assembly.last == Last::Within && assembly.corners.len() < 3 {
        // It is said with the end of the file.
        assembly.open = None;
    }
    assembly.close();
    if !findings.any_error() && assembly.last != Last::Outside {
        let count = assembly.facets.counts.facets;
        findings.damage(
            limits.lenient,
            "truncated files",
            || whole(file),
            || format!("the file ends within a solid, after {count} facets: `endsolid` is missing"),
        );
    }
    let Assembly { mut facets, weld, .. } = assembly;
    facets.positions = weld.into_positions();
    Ok(facets)
}

impl Block {
    fn parse(piece: Piece<'_>, origin: DVec3, file: &Arc<str>) -> Self {
        let mut block = Self::default();
        let mut cursor = Cursor::new(piece, false);
        while !cursor.is_done() {
            while cursor.more() {
                block.statement(&mut cursor, origin, file);
            }
            cursor.next_line();
        }
        block
    }

    /// Reads a word and what belongs to it.
    fn statement(&mut self, cursor: &mut Cursor<'_>, origin: DVec3, file: &Arc<str>) {
        let start = cursor.clone();
        let mut lower = [0; 8];
        let word = cursor.word();
        // No statement is longer.
        let known = if word.len() > lower.len() { b"" } else { word };
        lower[..known.len()].copy_from_slice(known);
        lower.make_ascii_lowercase();
        match &lower[..known.len()] {
            b"vertex" => self.vertex(cursor, origin, file),
            b"facet" => {
                self.last = Some(Last::Within);
                self.facets.push((self.corners.len() as u32, Vec3::ZERO));
            }
            b"normal" => {
                let mut normal = Vec3::ZERO;
                for axis in 0..3 {
                    normal[axis] = match cursor.float(0.0) {
                        Some(value) => value,
                        None if cursor.take_no_number() => f32::NAN,
                        None => break,
                    };
                }
                if let Some((_, of_facet)) = self.facets.last_mut().filter(|_| normal.is_finite()) {
                    *of_facet = normal;
                }
            }
            b"endfacet" => self.last = Some(Last::Between),
            b"solid" => {
                self.last = Some(Last::Between);
                name(cursor);
            }
            b"endsolid" => {
                self.last = Some(Last::Outside);
                name(cursor);
            }
            b"outer" | b"loop" | b"endloop" => {}
            _ => {
                self.findings.warning(
                    "statements that STL does not have",
                    || start.here(file),
                    || format!("STL has no statement `{}`; the line is not used", start.quote()),
                );
                cursor.finish_line();
            }
        }
    }

    fn vertex(&mut self, cursor: &mut Cursor<'_>, origin: DVec3, file: &Arc<str>) {
        let mut corner = Vec3::ZERO;
        for axis in 0..3 {
            let place = cursor.more().then(|| cursor.clone());
            if let Some(value) = cursor.float(origin[axis]).filter(|c| c.abs() <= LARGEST as f32) {
                corner[axis] = value;
                continue;
            }
            let Some(place) = place else {
                corner = NO_CORNER;
                if cursor.is_done() {
                    // Only the last piece ends without a line's end: the file is cut short.
                    break;
                }
                let what = ["x", "y", "z"][axis];
                self.findings.error(
                    "vertices that cannot be read",
                    || cursor.here(file),
                    || format!("the line ends before the `{what}` of the vertex"),
                );
                break;
            };
            let number = place.clone().decimal().is_some();
            if !number && !cursor.take_no_number() {
                self.findings.error(
                    "vertices that cannot be read",
                    || place.here(file),
                    || format!("`{}` {}", place.quote(), blame(place.rest())),
                );
                cursor.finish_line();
                corner = NO_CORNER;
                break;
            }
            if number && cursor.at() == place.at() {
                cursor.word();
            }
            let what = if number { "is too large" } else { "is no number" };
            self.findings.warning(
                "facets that are left out",
                || place.here(file),
                || format!("`{}` {what}: the facet is left out", place.quote()),
            );
            corner = NO_CORNER;
        }
        self.corners.push(corner);
    }
}

/// Goes over the name of a solid, up to the end of the line or what the solid holds.
fn name(cursor: &mut Cursor<'_>) {
    loop {
        let before = cursor.clone();
        let word = cursor.word();
        let ends = |known: &[u8]| word.eq_ignore_ascii_case(known);
        if word.is_empty() {
            return;
        }
        if ends(b"facet") || ends(b"endsolid") || ends(b"solid") {
            *cursor = before;
            return;
        }
    }
}

/// The facets of all pieces so far.
struct Assembly {
    facets: Facets,
    weld: Weld,
    /// The normal of the facet that is not closed yet; `None`: there is none.
    open: Option<Vec3>,
    /// Its corners.
    corners: Vec<Vec3>,
    last: Last,
}

impl Assembly {
    fn add(&mut self, block: &Block) {
        let first = block.facets.first().map_or(block.corners.len(), |(at, _)| *at as usize);
        self.extend(&block.corners[..first]);
        let ends = block.facets.iter().skip(1).map(|(at, _)| *at as usize);
        let ends = ends.chain([block.corners.len()]);
        for ((start, normal), end) in block.facets.iter().zip(ends) {
            self.close();
            self.open = Some(*normal);
            self.extend(&block.corners[*start as usize..end]);
        }
        if let Some(last) = block.last {
            self.last = last;
        }
    }

    /// Adds corners to the facet that is open; corners before any facet begin one.
    fn extend(&mut self, corners: &[Vec3]) {
        if !corners.is_empty() {
            self.open.get_or_insert(Vec3::ZERO);
            self.corners.extend_from_slice(corners);
        }
    }

    /// Makes triangles of the facet that is open.
    fn close(&mut self) {
        let Some(normal) = self.open.take() else { return };
        let Self { facets, corners, weld, .. } = self;
        facets.counts.facets += 1;
        let start = facets.indices.len() as u32;
        match corners[..] {
            [] | [_] | [_, _] => facets.counts.small += 1,
            // What is left out has been said.
            _ if !are_held(corners) => {}
            [a, b, c, ..] => {
                facets.counts.contrary += u64::from(is_contrary(normal, [a, b, c]));
                let count = corners.len();
                let first = weld.number(a);
                let mut before = weld.number(b);
                for corner in &corners[2..] {
                    let number = weld.number(*corner);
                    facets.indices.push([first, before, number]);
                    before = number;
                }
                if count > 3 {
                    facets.polygons.push([start, count as u32]);
                }
            }
        }
        corners.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_facet_may_begin_in_one_piece_and_end_in_the_next() {
        let text = b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
                     endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\n\
                     vertex 0 1 0\nendloop\nendfacet\nendsolid\n";
        let file: Arc<str> = "a".into();
        let ends = text.iter().enumerate().filter(|(_, b)| **b == b'\n').map(|(i, _)| i + 1);
        for end in ends {
            let mut assembly = Assembly {
                facets: Facets::default(),
                weld: Weld::with_room(0, Hash::new()),
                open: None,
                corners: Vec::new(),
                last: Last::Within,
            };
            for text in [&text[..end], &text[end..]] {
                let piece = Piece { text, offset: 0, line: 1, rows: 0 };
                assembly.add(&Block::parse(piece, DVec3::ZERO, &file));
            }
            assembly.close();
            assert_eq!(assembly.facets.indices, [[0, 1, 2], [1, 3, 2]], "{end}");
            assert_eq!(assembly.last, Last::Outside);
        }
    }
}
