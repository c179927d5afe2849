//! One piece of an OBJ file, parsed without knowing what stands before it.
//!
//! Indices that count from the file's beginning are final. Those that count backwards are kept
//! relative to the first vertex of the block, with a note of where they are, until the number of
//! vertices before the block is known.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use crate::color::{Rgb, srgb_decode};
use crate::diagnostic::Span;
use crate::format::text::{Cursor, Decimal, Findings, Piece, blame, name_of, take_digits};
use crate::mesh::{FLAT, NO_INDEX};

/// An index that no file can use: out of range, said where it is resolved.
pub(super) const BAD_INDEX: u32 = NO_INDEX - 1;

/// A vertex without a colour in a file that gives colours.
pub(super) const NO_COLOR: Rgb = Rgb::grey(f32::NAN);

/// In a corner: there is no such index.
const NONE: i64 = i64::MAX;

/// Added to a corner's index that counts from the block's first vertex.
const RELATIVE: i64 = 1 << 40;

/// What every block of a file is parsed with.
#[derive(Clone, Debug)]
pub(super) struct Context {
    /// The file, for what there is to say.
    pub(super) file: Arc<str>,
    /// Subtracted from every position.
    pub(super) origin: DVec3,
    /// Whether to note where every face stands.
    pub(super) marks: bool,
}

/// What one piece of the file holds.
#[derive(Debug, Default)]
pub(super) struct Block {
    pub(super) positions: Vec<Vec3>,
    /// Empty, or one a position; channels above 1 are still to be decoded.
    pub(super) colors: Vec<Rgb>,
    /// How many positions have a colour.
    pub(super) colored: u64,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// Of positions, texture coordinates and normals.
    pub(super) indices: [Indices; 3],
    /// First triangle and number of corners of every polygon of more than three.
    pub(super) polygons: Vec<[u32; 2]>,
    /// From which triangle on which material is used.
    pub(super) materials: Vec<(u32, String, Span)>,
    /// From which triangle on which smoothing group the faces are of; 0: none, they are flat.
    pub(super) smoothing: Vec<(u32, u32)>,
    /// The positions of point elements, as corners are read.
    pub(super) points: Vec<i64>,
    /// Whether there are lines.
    pub(super) has_lines: bool,
    /// What stands behind `mtllib`.
    pub(super) libraries: Vec<(String, Span)>,
    pub(super) findings: Findings,
    /// Where every face stands, if asked for.
    pub(super) marks: Vec<Mark>,
    /// Corners of the face that is being read.
    corners: Vec<[i64; 3]>,
}

/// Three indices a triangle.
#[derive(Debug, Default)]
pub(super) struct Indices {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Places in the flattened triangles whose index counts from the block's first vertex.
    pub(super) relative: Vec<u32>,
}

impl Indices {
    /// Appends a triangle behind `count` others, none of which may have had an index of this kind.
    #[inline]
    fn push(&mut self, count: usize, triangle: [u32; 3]) {
        if self.triangles.len() < count {
            self.triangles.resize(count, [NO_INDEX; 3]);
        }
        self.triangles.push(triangle);
    }
}

/// Where a face stands, and what stands before it in its block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    /// Its first triangle.
    pub(super) triangle: u32,
    /// Bytes into the block.
    pub(super) at: usize,
    /// Line number.
    pub(super) line: u64,
    /// Positions, texture coordinates and normals before it.
    pub(super) counts: [usize; 3],
}

impl Block {
    /// Parses a piece.
    pub(super) fn parse(piece: Piece<'_>, context: &Context) -> Self {
        let mut block = Self::default();
        let mut cursor = Cursor::new(piece, true);
        while !cursor.is_done() {
            block.statement(&mut cursor, context);
            cursor.next_line();
        }
        block
    }

    #[inline]
    fn statement(&mut self, cursor: &mut Cursor<'_>, context: &Context) {
        if !cursor.more() {
            return;
        }
        match cursor.rest() {
            [b'v', b' ' | b'\t', ..] => {
                cursor.skip(1);
                self.vertex(cursor, context);
            }
            [b'f', b' ' | b'\t', ..] => {
                if context.marks {
                    let triangle = self.indices[0].triangles.len() as u32;
                    let (at, line, counts) = (cursor.at(), cursor.line, self.counts());
                    self.marks.push(Mark { triangle, at, line, counts });
                }
                cursor.skip(1);
                self.face(cursor, context);
            }
            [b'v', b'n', b' ' | b'\t', ..] => {
                cursor.skip(2);
                let n = self.numbers(cursor, context, 3, "a normal");
                self.normals.push(Vec3::from(n));
            }
            [b'v', b't', b' ' | b'\t', ..] => {
                cursor.skip(2);
                let [u, v, _] = self.numbers(cursor, context, 1, "a texture coordinate");
                self.uvs.push(Vec2::new(u, v));
            }
            _ => self.rare_statement(cursor, context),
        }
    }

    /// Positions, texture coordinates and normals so far.
    fn counts(&self) -> [usize; 3] {
        [self.positions.len(), self.uvs.len(), self.normals.len()]
    }

    /// `v x y z [w]` or `v x y z r g b`.
    #[inline]
    fn vertex(&mut self, cursor: &mut Cursor<'_>, context: &Context) {
        let mut position = [0.0; 3];
        for (axis, value) in position.iter_mut().enumerate() {
            *value = match cursor.float(context.origin[axis]) {
                Some(number) => number,
                None if self.no_number(cursor, context, "position") => f32::NAN,
                None => {
                    self.bad_number(cursor, context, axis, "a position", 3);
                    break;
                }
            };
        }
        if cursor.more() {
            self.vertex_extras(cursor, context);
        } else if !self.colors.is_empty() {
            self.colors.push(NO_COLOR);
        }
        self.positions.push(Vec3::from(position));
    }

    /// What follows a position: a weight, which polygons do not use, or a colour.
    fn vertex_extras(&mut self, cursor: &mut Cursor<'_>, context: &Context) {
        let mut extras = [0.0_f64; 3];
        let mut count = 0;
        while cursor.more() {
            let start = cursor.clone();
            let value = match cursor.decimal().map(Decimal::to_f64) {
                Some(value) if cursor.ends_word(cursor.at()) && (value as f32).is_finite() => value,
                _ => {
                    *cursor = start;
                    if !self.no_number(cursor, context, "colour") {
                        self.bad_number(cursor, context, count, "what follows a position", 0);
                        break;
                    }
                    f64::NAN
                }
            };
            if let Some(extra) = extras.get_mut(count) {
                *extra = value;
            }
            count += 1;
        }
        if count >= 3 {
            if self.colors.is_empty() {
                self.colors = vec![NO_COLOR; self.positions.len()];
            }
            self.colors.push(Rgb::from(extras.map(decoded)));
            self.colored += 1;
        } else if !self.colors.is_empty() {
            self.colors.push(NO_COLOR);
        }
    }

    /// Up to three numbers, of which `least` must be there; a line end may stand for the others.
    #[inline]
    fn numbers(
        &mut self,
        cursor: &mut Cursor<'_>,
        context: &Context,
        least: usize,
        what: &'static str,
    ) -> [f32; 3] {
        let mut numbers = [0.0; 3];
        for (i, value) in numbers.iter_mut().enumerate() {
            match cursor.float(0.0) {
                Some(number) => *value = number,
                None if i >= least && !cursor.more() => break,
                None if self.no_number(cursor, context, what) => *value = f32::NAN,
                None => {
                    self.bad_number(cursor, context, i, what, least);
                    break;
                }
            }
        }
        numbers
    }

    /// Takes a word that says NaN or infinity, of which its `kind` does without; whether it does.
    #[cold]
    fn no_number(&mut self, cursor: &mut Cursor<'_>, context: &Context, kind: &str) -> bool {
        let here = cursor.clone();
        if !cursor.take_no_number() {
            return false;
        }
        let kind = kind.trim_start_matches("a ");
        self.findings.warning(
            "numbers that are NaN or infinite",
            || here.here(&context.file),
            || format!("`{}` is no number: the {kind} is left out", here.quote()),
        );
        true
    }

    /// Says why there is no number; the rest of the line goes unread.
    #[cold]
    fn bad_number(
        &mut self,
        cursor: &mut Cursor<'_>,
        context: &Context,
        read: usize,
        what: &str,
        least: usize,
    ) {
        let here = cursor.clone();
        if cursor.more() {
            let quoted = cursor.quote();
            let reason = match cursor.decimal() {
                Some(_) => "is too large".to_owned(),
                None => blame(cursor.rest()).to_string(),
            };
            self.findings.error(
                "numbers that cannot be read",
                || here.here(&context.file),
                || format!("`{quoted}` {reason}"),
            );
        } else {
            self.findings.error(
                "lines with too few numbers",
                || here.here(&context.file),
                || format!("{what} has {read} of {least} numbers"),
            );
        }
        cursor.finish_line();
    }

    /// `f v/vt/vn …`
    #[inline]
    fn face(&mut self, cursor: &mut Cursor<'_>, context: &Context) {
        if self.plain_triangle(cursor) {
            return;
        }
        let counts = self.counts();
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        while cursor.more() {
            let Some(corner) = corner(cursor, counts) else {
                self.bad_corner(cursor, context);
                self.corners = corners;
                return;
            };
            corners.push(corner);
        }
        match corners.as_slice() {
            &[a, b, c] => self.triangle([a, b, c]),
            [first, rest @ ..] if rest.len() > 2 => {
                let start = self.indices[0].triangles.len() as u32;
                self.polygons.push([start, corners.len() as u32]);
                for pair in rest.windows(2) {
                    self.triangle([*first, pair[0], pair[1]]);
                }
            }
            _ => self.findings.warning(
                "faces of fewer than three corners, which are left out",
                || cursor.here(&context.file),
                || format!("a face of {} corners, of at least 3, is left out", corners.len()),
            ),
        }
        self.corners = corners;
    }

    /// Takes a triangle whose indices all count from the file's beginning, as most do; leaves any
    /// other face to be read at leisure.
    #[inline]
    fn plain_triangle(&mut self, cursor: &mut Cursor<'_>) -> bool {
        let mut ahead = cursor.clone();
        let mut triangle = [[NO_INDEX; 3]; 3];
        for corner in 0..3 {
            if !ahead.more() {
                return false;
            }
            let text = ahead.rest();
            let mut at = 0;
            for (kind, indices) in triangle.iter_mut().enumerate() {
                let (mut value, mut digits) = (0, 0);
                at = take_digits(text, at, &mut value, &mut digits);
                // The first index must be there.
                if digits > 9 || (value == 0 && (digits > 0 || kind == 0)) {
                    return false;
                }
                // Where there is none, 0 − 1 is what says so.
                indices[corner] = (value as u32).wrapping_sub(1);
                if kind == 2 || text.get(at) != Some(&b'/') {
                    break;
                }
                at += 1;
            }
            ahead.skip(at);
            if !ahead.ends_word(ahead.at()) {
                return false;
            }
        }
        if ahead.more() {
            return false;
        }
        *cursor = ahead;
        let count = self.indices[0].triangles.len();
        for (indices, triangle) in self.indices.iter_mut().zip(triangle) {
            if triangle != [NO_INDEX; 3] || !indices.triangles.is_empty() {
                indices.push(count, triangle);
            }
        }
        true
    }

    #[inline]
    fn triangle(&mut self, corners: [[i64; 3]; 3]) {
        let count = self.indices[0].triangles.len();
        for (kind, indices) in self.indices.iter_mut().enumerate() {
            let wanted = corners.map(|corner| corner[kind]);
            if wanted == [NONE; 3] && indices.triangles.is_empty() {
                // Most files leave a kind out altogether; it costs nothing until one does not.
                continue;
            }
            let triangle = [0, 1, 2].map(|i| {
                let index = wanted[i];
                match index {
                    NONE => NO_INDEX,
                    RELATIVE_LEAST.. => {
                        indices.relative.push((3 * count + i) as u32);
                        (index - RELATIVE) as i32 as u32
                    }
                    _ => index.min(i64::from(BAD_INDEX)) as u32,
                }
            });
            indices.push(count, triangle);
        }
    }

    #[cold]
    fn bad_corner(&mut self, cursor: &mut Cursor<'_>, context: &Context) {
        let here = cursor.clone();
        let quoted = cursor.quote();
        let zero = quoted.split('/').any(|index| index.parse::<i64>() == Ok(0));
        self.findings.error(
            "corners that cannot be read",
            || here.here(&context.file),
            || {
                if zero {
                    format!("`{quoted}` has the index 0, but indices begin at 1")
                } else {
                    format!("`{quoted}` is not a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`")
                }
            },
        );
        cursor.finish_line();
    }

    /// `s off`, `s 0`, `s 3`: what is neither is a name, and as good as any number.
    fn smoothing(&mut self, cursor: &mut Cursor<'_>) {
        cursor.more();
        let word = cursor.word();
        let group = match str::from_utf8(word).ok().and_then(|word| word.parse().ok()) {
            Some(number) => number,
            None if word.is_empty() || word.eq_ignore_ascii_case(b"off") => FLAT,
            None => 1,
        };
        self.smoothing.push((self.indices[0].triangles.len() as u32, group));
    }

    /// `p v1 v2 …`
    fn point_element(&mut self, cursor: &mut Cursor<'_>, context: &Context) {
        let counts = self.counts();
        while cursor.more() {
            match corner(cursor, counts) {
                Some([position, ..]) => self.points.push(position),
                None => return self.bad_corner(cursor, context),
            }
        }
    }

    fn rare_statement(&mut self, cursor: &mut Cursor<'_>, context: &Context) {
        let here = cursor.clone();
        let at = || here.here(&context.file);
        match cursor.word() {
            b"usemtl" => {
                cursor.more();
                let start = cursor.clone();
                let name = name_of(cursor.rest_of_line());
                let triangle = self.indices[0].triangles.len() as u32;
                self.materials.push((triangle, name, start.here(&context.file)));
            }
            b"mtllib" => {
                let names = name_of(cursor.rest_of_line());
                self.libraries.push((names, at()));
            }
            // Names, levels of detail and display attributes do not change a shape.
            b"g" | b"o" | b"mg" | b"lod" | b"bevel" | b"c_interp" | b"d_interp" | b"usemap"
            | b"maplib" | b"shadow_obj" | b"trace_obj" => {}
            b"s" => self.smoothing(cursor),
            b"l" => {
                self.has_lines = true;
                let tell = || "lines are not drawn".to_owned();
                self.findings.warning("lines, which are not drawn", at, tell);
            }
            b"p" => self.point_element(cursor, context),
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf"
            | b"parm" | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"ctech"
            | b"stech" | b"bzp" | b"bsp" | b"cdc" | b"cdp" | b"res" => {
                self.findings.warning("statements of free-form curves and surfaces", at, || {
                    "free-form curves and surfaces are not drawn".to_owned()
                });
            }
            // Statements without anything behind them, and all that is not OBJ.
            b"v" | b"vn" | b"vt" => {
                self.bad_number(cursor, context, 0, "a vertex", 3);
            }
            b"f" => self.face(cursor, context),
            _ => {
                let quoted = here.quote();
                self.findings.warning("statements that are not known", at, || {
                    format!("the statement `{quoted}` is not known")
                });
            }
        }
    }
}

/// A channel of sRGB as a linear value if it is at most 1. What is above is left as it is: whether
/// it is a byte is only known when all of the file is read.
fn decoded(channel: f64) -> f32 {
    (if channel <= 1.0 { srgb_decode(channel.max(0.0)) } else { channel }) as f32
}

/// What a corner's index means where `before` vertices stand before its block.
pub(super) fn absolute(index: i64, before: usize) -> u32 {
    let index = if index >= RELATIVE_LEAST { before as i64 + index - RELATIVE } else { index };
    u32::try_from(index).unwrap_or(BAD_INDEX).min(BAD_INDEX)
}

/// Indices that count from the block's first vertex are at least this.
const RELATIVE_LEAST: i64 = RELATIVE - (1 << 32);

/// `v`, `v/vt`, `v//vn` or `v/vt/vn`; `None` with the cursor where it was if it is none of these
/// or an index is 0.
#[inline]
fn corner(cursor: &mut Cursor<'_>, counts: [usize; 3]) -> Option<[i64; 3]> {
    let text = cursor.rest();
    let (position, mut at) = index(text, 0, counts[0])?;
    let mut corner = [position, NONE, NONE];
    if text.get(at) == Some(&b'/') {
        at += 1;
        if let Some((uv, end)) = index(text, at, counts[1]) {
            (corner[1], at) = (uv, end);
        }
        if text.get(at) == Some(&b'/') {
            at += 1;
            if let Some((normal, end)) = index(text, at, counts[2]) {
                (corner[2], at) = (normal, end);
            }
        }
    }
    cursor.ends_word(cursor.at() + at).then(|| {
        cursor.skip(at);
        corner
    })
}

/// An index from `at` on, of which `count` came before it in the block, and where it ends;
/// `None` if it is 0 or not there.
#[inline]
fn index(text: &[u8], at: usize, count: usize) -> Option<(i64, usize)> {
    let backwards = text.get(at) == Some(&b'-');
    let mut end = at + usize::from(backwards || text.get(at) == Some(&b'+'));
    let (mut value, mut digits) = (0, 0);
    end = take_digits(text, end, &mut value, &mut digits);
    let value =
        if digits < 19 { value.min(u64::from(NO_INDEX)) as i64 } else { i64::from(NO_INDEX) };
    match value {
        0 => None,
        // More than can be kept relative to a block: no file has as many.
        _ if backwards && value > i64::from(i32::MAX) => Some((i64::from(BAD_INDEX), end)),
        _ if backwards => Some((RELATIVE + count as i64 - value, end)),
        _ => Some((value - 1, end)),
    }
}
