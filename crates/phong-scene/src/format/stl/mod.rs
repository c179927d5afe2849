//! STL, stereolithography: triangles without any order, binary or ASCII.
//!
//! A file becomes one mesh. Corners at equal coordinates become one vertex, so that what meets is
//! smooth where it is under 60°, as in files of other formats.
//!
//! | in the file | read as |
//! |---|---|
//! | the beginning | binary, if the number of facets at byte 80 fits the file's length, or if it is not text that begins with `solid` |
//! | a facet's corners | a triangle; four corners and more, which some programs write as text, a polygon |
//! | a facet's normal | not used: the order of the corners says which side is which. Normals that point the other way are counted in a warning |
//! | attribute bytes of a binary facet | not used; those that are not 0, which are the colours of some programs, are counted in a warning |
//! | several `solid`s | one mesh |
//! | statements of other names | a warning |
//!
//! A facet with a corner that is NaN or beyond 1e18 is left out and counted. Binary files that have
//! room for fewer facets than they say, and text that ends within a `solid`, are cut short: errors,
//! unless read leniently. A count of 0 before facets is what some programs leave there: they are read,
//! with a warning. Bytes behind the last facet are a warning.
//!
//! Own reader: `stl_io` reads on one thread, tells no line, and trusts the first five bytes.

mod ascii;
mod binary;
pub(crate) mod export;
mod write;

use std::io;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::input::Input;
use super::text::{Findings, as_text, decode, head_of, whole};
use super::triangles::{any_left, cut, tell_small, tidy};
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::limits::LARGEST;
use crate::mesh::Mesh;
use crate::source::{Blob, trouble};

/// Bytes before the facets of a binary file: 80 for anyone, 4 for their number.
const HEAD: u64 = 84;

/// Bytes of a facet of a binary file.
const FACET: usize = 50;

/// Bytes from the beginning that are looked at to tell text from numbers.
const LOOK: usize = 1 << 10;

/// Whether a file that begins so is surely STL; of binary ones that cannot be known.
pub(crate) fn is_stl(head: &[u8]) -> bool {
    let has = |words: &[u8]| head.windows(words.len()).any(|w| w.eq_ignore_ascii_case(words));
    is_text(head) && (has(b"facet") || has(b"endsolid"))
}

/// Whether a file that begins so can be an STL file as text.
fn is_text(head: &[u8]) -> bool {
    let head = &head[..head.len().min(LOOK)];
    let word = head.trim_ascii_start();
    let solid = word.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let ends = word.get(5).is_none_or(u8::is_ascii_whitespace);
    let control = |byte: &u8| *byte < b' ' && !byte.is_ascii_whitespace() && *byte != 0x0b;
    solid && ends && !head.iter().any(control)
}

/// Reads an STL file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    let file: Arc<str> = input.path.into();
    let mut findings = Findings::default();
    let mesh = mesh_of(&file, input, &mut findings);
    let sound = !findings.any_error();
    findings.tell(&file, out);
    match mesh {
        Ok(mesh) => mesh.filter(|_| sound).map(|mesh| Fragment::of(mesh, Vec::new())),
        Err(error) => {
            let message = format!("cannot be read: {}", trouble(&error));
            out.push(Diagnostic::error(message, whole(&file)));
            None
        }
    }
}

/// The facets of the file, in its order.
#[derive(Debug, Default)]
struct Facets {
    origin: DVec3,
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    /// First triangle and number of corners of every facet of more than three.
    polygons: Vec<[u32; 2]>,
    counts: Counts,
}

/// How many facets there is something to say of.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    /// All of them.
    facets: u64,
    /// Their normal points away from the side from which their corners run counter-clockwise.
    contrary: u64,
    /// They have attribute bytes.
    attributes: u64,
    /// They have fewer than three corners.
    small: u64,
}

impl Counts {
    fn add(&mut self, other: Self) {
        self.facets += other.facets;
        self.contrary += other.contrary;
        self.attributes += other.attributes;
        self.small += other.small;
    }
}

/// The mesh of the file.
fn mesh_of(
    file: &Arc<str>,
    input: &Input<'_>,
    findings: &mut Findings,
) -> io::Result<Option<Mesh>> {
    let Input { source, limits, .. } = *input;
    let blob = source.open(file)?;
    let facets = if !binary::fits(blob.as_ref())? && begins_as_text(blob.as_ref())? {
        ascii::read(as_text(blob, limits)?.as_ref(), file, limits, findings)?
    } else {
        binary::read(blob.as_ref(), file, limits, findings)?
    };
    if findings.any_error() {
        return Ok(None);
    }
    Ok(finish(facets, file, findings))
}

/// The facets as a mesh, with what there is to say about them.
fn finish(facets: Facets, file: &Arc<str>, findings: &mut Findings) -> Option<Mesh> {
    let Facets { origin, positions, indices, polygons, counts } = facets;
    let Counts { facets, contrary, attributes, small } = counts;
    let mut warn = |plural, count: u64, message: String| {
        if count > 0 {
            findings.warning(plural, || whole(file), || message);
        }
    };
    let message = format!(
        "facets whose normal points against the order of their corners: {contrary}; the order counts"
    );
    warn("contrary normals", contrary, message);
    let message = format!(
        "facets with attribute bytes, which are the colours of some programs: {attributes}; they are \
         not used"
    );
    warn("attribute bytes", attributes, message);
    let mut mesh =
        Mesh { origin, positions: positions.into(), indices: indices.into(), ..Mesh::default() };
    cut(&mut mesh, &polygons, findings, file);
    tell_small(small, findings, file);
    if facets == 0 {
        let message = || "there is nothing to draw: the file has no facet".to_owned();
        findings.error("empty models", || whole(file), message);
        return None;
    }
    tidy(&mut mesh, 0, findings, file);
    any_left(&mesh, findings, file).then_some(mesh)
}

/// Whether all corners are numbers that a scene can hold.
#[inline]
fn are_held(corners: &[Vec3]) -> bool {
    corners.iter().all(|p| p.abs().max_element() <= LARGEST as f32 && !p.is_nan())
}

/// What is wrong with corners that cannot be drawn.
fn blame(corners: &[Vec3]) -> String {
    let wrong = |c: &f32| c.is_nan() || c.abs() > LARGEST as f32;
    let all = corners.iter().flat_map(|p| p.to_array().into_iter().zip(["x", "y", "z"]));
    let found = all.into_iter().find(|(c, _)| wrong(c));
    let (value, axis) = found.unwrap_or((f32::NAN, "x"));
    let what = if value.is_nan() { "NaN" } else { "infinite or too large" };
    format!("the `{axis}` of a corner is {what}")
}

/// Whether a normal points clearly away from the side from which the corners run counter-clockwise.
#[inline]
fn is_contrary(normal: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    // Squares of products of f32 as large as they may be fit an f64, but not an f32.
    let area = (b - a).as_dvec3().cross((c - a).as_dvec3());
    let n = normal.as_dvec3();
    let dot = area.dot(n);
    dot < 0.0 && dot * dot > 0.25 * area.length_squared() * n.length_squared()
}

fn begins_as_text(blob: &dyn Blob) -> io::Result<bool> {
    Ok(is_text(&decode(head_of(blob, LOOK)?)))
}

/// The number at a place; `None`: the file ends before.
fn number_at(blob: &dyn Blob, offset: u64) -> io::Result<Option<u32>> {
    let mut bytes = [0; 4];
    let read = blob.read_full(&mut bytes, offset)?;
    Ok((read == 4).then(|| u32::from_le_bytes(bytes)))
}
