//! Wavefront OBJ: polygons, with normals, texture coordinates, vertex colours and materials.
//!
//! A file becomes one mesh, and a cloud of points where it has point elements, or no faces and lines.
//! What `o` and `g` say is not kept: names are for editors. Lines and free-form surfaces are not
//! drawn, which is a warning.
//!
//! | statement | read as |
//! |---|---|
//! | `v x y z` | a position; what stands far from the origin is kept relative to [`Mesh::origin`](crate::Mesh::origin) |
//! | `v x y z w` | the same: polygons do not use the weight |
//! | `v x y z r g b` | a position with a colour, which is sRGB; beside such, a position without one is grey; if all are whole numbers up to 255 and one is at least 2, they are bytes. Not drawn under a `map_Kd`, with a warning |
//! | `vt u v`, `vn x y z` | a texture coordinate, a normal; `vt` may lack v, and more is ignored |
//! | `f a b c …` | a polygon of corners `v`, `v/vt`, `v//vn`, `v/vt/vn`; negative indices count back from the last; concave polygons are cut by clipping ears |
//! | `s number`, `s off` | in a file without normals: faces of one group are smooth among themselves, those of none are flat; without any `s`, smooth where faces meet under 60° |
//! | `p v1 v2 …` | points, drawn as those of PLY files are |
//! | `usemtl name` | the material of the faces that follow; before the first, the default material |
//! | `mtllib names` | MTL files beside the OBJ file; see the `mtl` module |
//!
//! A position, normal or colour that is NaN, and a normal or texture coordinate out of range, are
//! left out and counted; a position out of range refuses the file, unless it is read leniently.
//!
//! Any statement may go on behind a `\` at its line's end. UTF-16 is read where a byte-order mark
//! says so. An index may count forward to a vertex that comes later.
//!
//! Own reader: `tobj` holds the whole file in memory, reads it on one thread, and tells no line.

mod assemble;
mod block;
pub(crate) mod export;
mod libraries;
mod write;

use std::io;
use std::sync::Arc;

use self::assemble::{Assembly, start_of};
use self::block::{Block, Context};
use self::libraries::Libraries;
use super::input::Input;
use super::origin::{origin_of, sample};
use super::text::{Cursor, Lines, Rows, open_text, whole};
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::source::trouble;

#[cfg(test)]
mod tests;

/// Reads an OBJ file and the MTL files it names; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    let Input { path, source, limits, .. } = *input;
    let file: Arc<str> = path.into();
    let read = || -> io::Result<_> {
        let blob = open_text(source, path, limits)?;
        let is_position = |cursor: &mut Cursor<'_>| cursor.word() == b"v";
        let origin = origin_of(sample(blob.as_ref(), true, is_position)?);
        let context = Context { file: Arc::clone(&file), origin, marks: false };
        let mut assembly = Assembly::default();
        let lines =
            Lines { blob: blob.as_ref(), start: 0, line: 1, joined: true, rows: Rows::Uncounted };
        lines.each(
            |piece| (start_of(&piece), Block::parse(piece, &context)),
            |(start, block)| assembly.add(start, block, &file, limits),
        )?;
        let mut told = Vec::new();
        let names = std::mem::take(&mut assembly.libraries);
        let mut libraries = Libraries::read(names, input, &mut assembly.findings, &mut told);
        let (model, findings) = assembly.finish(blob.as_ref(), &context, &mut libraries, input);
        libraries.tell(&mut told);
        Ok((model, findings, told))
    };
    match read() {
        Ok((model, findings, mut told)) => {
            findings.tell(&file, out);
            let sound = !told.iter().any(Diagnostic::is_error);
            out.append(&mut told);
            model.filter(|_| sound)
        }
        Err(error) => {
            out.push(Diagnostic::error(
                format!("cannot be read: {}", trouble(&error)),
                whole(&file),
            ));
            None
        }
    }
}
