//! OFF, the Object File Format of Geomview: polygons as text.
//!
//! | in the file | read as |
//! |---|---|
//! | the first word: `OFF` with any of `ST`, `C`, `N` before it | what a vertex has: texture coordinates, a colour, a normal. Without any word, `OFF`, with a warning |
//! | two counts, of vertices and faces; a third, of edges, is not used | how many lines follow; fewer are an error unless read leniently, more a warning |
//! | `x y z`, normal, colour, texture coordinates | a vertex; places far from the origin are kept relative to [`Mesh::origin`](crate::Mesh::origin) |
//! | `n i j k …` and perhaps a colour | a polygon; concave ones are cut by clipping ears |
//! | colours of three or four numbers | if all are whole numbers up to 255 and one is at least 2, bytes, which are sRGB; else linear. An alpha below 1 is a warning |
//! | colours of faces | used where vertices have none: corners of different colours become different vertices. Those of one number are of a palette that the file does not hold: not used, with a warning |
//! | a polygon over several lines | is read, with a warning |
//! | `#` | a comment, up to the line's end |
//!
//! A file without faces is a cloud of points, drawn as those of PLY files are. A vertex that is NaN is
//! left out with its faces; a face that uses a vertex out of range is an error, unless read leniently.
//! Binary files, and those of other dimensions than three (`4OFF`, `nOFF`), are refused by name.
//!
//! Own reader: no crate that reads it has comments, colours and limits.

mod body;
mod colors;
mod header;
mod loose;

use std::io;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use self::body::Body;
use self::colors::Colors;
use self::header::Header;
use super::faces::Faces;
use super::input::Input;
use super::text::{Findings, open_text, whole};
use super::triangles::{any_left, cut, tell_small, tidy};
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::mesh::{Mesh, Points, collapse_faces};
use crate::shape::Shape;
use crate::source::{Memory, Source, trouble};

pub(crate) use self::header::is_off;

/// Reads an OFF file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    let file: Arc<str> = input.path.into();
    let mut findings = Findings::default();
    let shape = shape_of(&file, input, &mut findings);
    let sound = !findings.any_error();
    findings.tell(&file, out);
    match shape {
        Ok(shape) => shape.filter(|_| sound).map(|shape| Fragment::of(shape, Vec::new())),
        Err(error) => {
            let message = format!("cannot be read: {}", trouble(&error));
            out.push(Diagnostic::error(message, whole(&file)));
            None
        }
    }
}

/// What the rows of a file hold.
#[derive(Debug, Default)]
struct Contents {
    origin: DVec3,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Colors,
    faces: Faces,
    /// One a triangle, or fewer.
    face_colors: Colors,
    /// Colours of faces that are numbers of a palette.
    palette: u64,
    /// Lines with more numbers, or other, than the file's first word says.
    odd: u64,
}

/// The mesh or the points of the file.
fn shape_of(
    file: &Arc<str>,
    input: &Input<'_>,
    findings: &mut Findings,
) -> io::Result<Option<Shape>> {
    let Input { source, limits, radius, .. } = *input;
    let blob = open_text(source, file, limits)?;
    let blob = blob.as_ref();
    let Some(header) = Header::read(blob, file, findings)? else { return Ok(None) };
    if !limits.lenient && !header.has_rows(blob, findings) {
        return Ok(None);
    }
    let body = Body { blob, file, header: &header, limits };
    let mut said = Findings::default();
    let mut contents = body.read(&mut said)?;
    if said.any_error()
        && let Some(rows) = loose::rejoined(blob, header.body, header.vertices, limits.text_bytes)?
    {
        let source = Memory::new().with(file.as_ref(), rows);
        let blob = source.open(file)?;
        let mut header = header.clone();
        header.body = 0;
        let mut again = Findings::default();
        let joined = Body { blob: &*blob, file, header: &header, limits }.read(&mut again)?;
        if !again.any_error() {
            let message = || "faces are written over several lines".to_owned();
            again.warning("faces over several lines", || whole(file), message);
            (contents, said) = (joined, again);
        }
    }
    findings.append(said);
    if findings.any_error() {
        return Ok(None);
    }
    tell(&contents, file, findings);
    if header.faces == 0 {
        let points = points(contents, radius, file, findings);
        return Ok(points.map(Shape::from));
    }
    Ok(mesh(contents, file, findings).map(Shape::from))
}

/// Says what of the rows is not used.
fn tell(contents: &Contents, file: &Arc<str>, findings: &mut Findings) {
    let mut warn = |plural, count: u64, message: String| {
        if count > 0 {
            findings.warning(plural, || whole(file), || message);
        }
    };
    let Contents { odd, palette, .. } = *contents;
    let message = format!(
        "lines with numbers that the file's first word does not speak of: {odd}; they are not used"
    );
    warn("lines with more numbers", odd, message);
    let message =
        format!("colours of faces from a palette that the file does not hold: {palette}; not used");
    warn("colours from a palette", palette, message);
}

fn points(
    contents: Contents,
    radius: Option<f32>,
    file: &Arc<str>,
    findings: &mut Findings,
) -> Option<Points> {
    let Contents { origin, positions, colors, .. } = contents;
    let count = positions.len();
    let mut colors = colors.finish(count, "vertices", file, findings);
    let mut placed = positions.iter().map(|p| p.is_finite());
    colors.retain(|_| placed.next().unwrap_or(true));
    let sphere = |p: &Vec3| [p.x, p.y, p.z, radius.unwrap_or(0.0)];
    let spheres: Vec<_> = positions.iter().filter(|p| p.is_finite()).map(sphere).collect();
    if spheres.is_empty() {
        let message = match count {
            0 => "there is nothing to draw: the file has no vertex",
            _ => "there is nothing to draw: no vertex is left",
        };
        findings.error("empty models", || whole(file), || message.to_owned());
        return None;
    }
    let (spheres, colors) = (spheres.into(), colors.into());
    let mut points = Points { origin, spheres, colors, ..Points::default() };
    if radius.is_none() {
        points.guess_radius();
    }
    Some(points)
}

fn mesh(contents: Contents, file: &Arc<str>, findings: &mut Findings) -> Option<Mesh> {
    let Contents { origin, positions, normals, mut uvs, colors, faces, face_colors, .. } = contents;
    let Faces { indices, mut polygons, dropped } = faces;
    uvs.iter_mut().filter(|uv| !uv.is_finite()).for_each(|uv| *uv = Vec2::ZERO);
    let count = positions.len();
    let mut mesh = Mesh {
        origin,
        positions: positions.into(),
        indices: indices.into(),
        normals: normals.into(),
        uvs: uvs.into(),
        colors: colors.finish(count, "vertices", file, findings).into(),
        ..Mesh::default()
    };
    let unplaced = mesh.take_unplaced();
    // Indices out of range are faces that were left out leniently: there is none.
    let is_unplaced = |i: u32| {
        let is = |unplaced: &Vec<bool>| unplaced.get(i as usize).is_none_or(|is| *is);
        unplaced.as_ref().map_or(i as usize >= count, is)
    };
    let [gone, triangles] = collapse_faces(&mut mesh.indices, &mut polygons, is_unplaced);
    if gone > 0 {
        let message = || format!("faces of which a vertex is left out: {gone}; they are left out");
        findings.warning("faces without their vertices", || whole(file), message);
    }
    cut(&mut mesh, &polygons, findings, file);
    tell_small(dropped, findings, file);
    if !face_colors.is_empty() {
        if mesh.colors.is_empty() {
            let colors = face_colors.finish(mesh.indices.len(), "faces", file, findings);
            mesh.color_faces(&colors);
        } else {
            let message = || "colours of faces are not used where vertices have some".to_owned();
            findings.warning("colours of faces", || whole(file), message);
        }
    }
    tidy(&mut mesh, triangles, findings, file);
    any_left(&mesh, findings, file).then_some(mesh)
}
