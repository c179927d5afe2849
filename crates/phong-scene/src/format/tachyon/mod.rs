//! Tachyon scenes (`.dat`), as Tachyon draws them; VMD, OVITO and Sage write them.
//!
//! Words count in any case, and where lines break counts for nothing. Tachyon's space is left-handed:
//! every z is negated as it is read, which gives the very picture that Tachyon gives.
//!
//! | in the file | read as |
//! |---|---|
//! | `RESOLUTION`, `ANTIALIASING n`, `RAYDEPTH n` | the size; n + 1 samples a pixel; n − 1 bounces |
//! | `CAMERA`: perspective, with depth of field, orthographic, fisheye | `fov` = 2 atan(½ / zoom); a lens; a height of 1 / zoom; an equidistant fisheye, which is not quite Tachyon's |
//! | `FRUSTUM` | its height; where it is not symmetric, a warning |
//! | `BACKGROUND`, `BACKGROUND_GRADIENT` | a colour; a gradient between the colours that it has at the picture's upper and lower edge |
//! | `LIGHT`, `DIRECTIONAL_LIGHT`, `SPOTLIGHT`, `ATTENUATION` | point, distant and spot lights. The visible sphere of a light is not drawn |
//! | `SPHERE` | spheres in bulk, with their colours |
//! | `FCYLINDER`; `POLYCYLINDER` | cylinders without caps in bulk; capsules |
//! | `TRI`, `STRI`, `VCSTRI`, `VERTEXARRAY` with `TRIMESH` and `TRISTRIP` | meshes: flat, with normals, with colours |
//! | `PLANE`, `BOX`, `RING` | a plane, a box, a disc or a flat ring of 96 parts |
//! | `CYLINDER` | a cylinder of 2000 times its distance from the camera in length |
//! | a texture: `AMBIENT DIFFUSE PHONG PHONG_SIZE` | `k_a k_d k_s shininess` of Blinn–Phong; `METAL` tints the highlight by the object alone |
//! | `SPECULAR`; `OPACITY` | the weight of the mirror ray; 1 − it is the weight of the ray that goes straight on, and what of light goes through |
//! | `TEXDEF`, `TEXALIAS` | names, of which the first definition counts. An unknown one is grey, with a warning |
//! | `TEXFUNC 1` | cubes of orange and blue, three a unit, with the middle of a blue one at `CENTER`: as there, neither the colour nor `ROTATE` and `SCALE` count |
//! | `TEXFUNC` 2 to 9, `OUTLINE` | their constant colour: a warning |
//! | `SHADER_MODE`: `MEDIUM` and less; `TRANS_VMD` | no shadows; what is seen through is not added to but mixed with the surface: `opacity` |
//! | `TRANSMODE R3D` | with `TRANS_VMD` opacity that grows to the rim (`opacity_mode`); shadows then do so too; else a warning |
//! | ambient occlusion | `k_a` grows by `DIFFUSE` times its colour; the file's own ambient light is hidden with it |
//! | `FOG`; `FOG_VMD` | linear fog, exponential fog and its square, which begin at the eye; by the distance along the axis |
//! | `START_CLIPGROUP` | planes that cut what is in the group, without caps; the first 32 planes of all |
//! | `SCALARVOL`, `SCAPE`, `TPOLYFILE`, `MGFFILE` | nothing: a warning that counts them |
//! | `INCLUDE` | the other file's statements, at this place |
//!
//! Tachyon samples a pixel at its corner, half a pixel from where ours is. Its `-shade_phong` is a
//! matter of the command line, and is not in the file.
//!
//! A sphere of no radius, or a corner that is no number, is left out and counted. A statement that
//! cannot be read is an error with its line, unless the file is read leniently: then it is left out.

mod block;
mod camera;
mod clip;
pub(crate) mod export;
mod scene;
mod shapes;
mod sky;
mod statement;
mod texture;
mod things;
mod vectors;

use std::io;
use std::sync::Arc;

use self::block::Block;
use self::scene::Assembly;
use super::input::{Input, Models};
use super::text::{Findings, Lines, Rows, Words, head_of, open_text, whole};
use crate::diagnostic::Diagnostic;
use crate::scene::Reading;
use crate::source::trouble;

/// Whether a file that begins so is surely a Tachyon scene.
pub(crate) fn is_tachyon(head: &[u8]) -> bool {
    Words::of(head, 1).word().eq_ignore_ascii_case(b"begin_scene")
}

/// Reads a Tachyon scene.
pub(crate) fn read(input: &Input<'_>, _: &'static Models) -> Reading {
    let mut diagnostics = Vec::new();
    if let Some(change) = input.changes.first() {
        let span = whole(&input.path.into());
        let message = format!("a Tachyon scene has no key {} to change", change.path());
        let help = "`phong convert` makes a .toml of it, whose keys can be changed";
        diagnostics.push(Diagnostic::error(message, span).with_help(help));
        return Reading { scene: None, bare: false, diagnostics };
    }
    let mut assembly = Assembly::new(*input);
    statements(input.path, &mut assembly);
    diagnostics.append(&mut assembly.told);
    let scene = assembly.finish(&input.path.into(), &mut diagnostics);
    if let Some(scene) = &scene {
        diagnostics.extend(scene.check());
    }
    let sound = !diagnostics.iter().any(Diagnostic::is_error);
    Reading { scene: scene.filter(|_| sound), bare: false, diagnostics }
}

/// Reads the statements of one file, and those of the files that it includes at their places.
fn statements(path: &str, assembly: &mut Assembly<'_>) {
    let file: Arc<str> = path.into();
    let mut findings = Findings::default();
    let read = text(&file, assembly, &mut findings);
    findings.tell(&file, &mut assembly.told);
    if let Err(error) = read {
        let message = format!("cannot be read: {}", trouble(&error));
        assembly.told.push(Diagnostic::error(message, whole(&file)));
    }
}

/// Reads the text of one file piece by piece. What stands across the ends of pieces is read with the
/// next one that begins a statement.
fn text(file: &Arc<str>, assembly: &mut Assembly<'_>, findings: &mut Findings) -> io::Result<()> {
    let Input { source, limits, .. } = assembly.input;
    let blob = open_text(source, file, limits)?;
    let head = head_of(blob.as_ref(), 1 << 12)?;
    let mut first = Words::of(&head, 1);
    if assembly.depth == 0 && !first.clone().word().eq_ignore_ascii_case(b"begin_scene") {
        first.is_there();
        let message = || match first.quote() {
            word if word.is_empty() => "there is nothing to draw: the file is empty".to_owned(),
            word => format!("the file is no Tachyon scene: it begins with `{word}`"),
        };
        findings.error("other files", || first.here(file), message);
        return Ok(());
    }
    let lines =
        Lines { blob: blob.as_ref(), start: 0, line: 1, joined: false, rows: Rows::Uncounted };
    let mut open: Option<(Vec<u8>, u64)> = None;
    lines.each(
        |piece| Block::parse(&piece, file, limits.lenient),
        |mut block| {
            let (bytes, _) = open.get_or_insert_with(|| (Vec::new(), block.line));
            bytes.extend_from_slice(&block.head);
            if let Some(things) = block.things.take() {
                if let Some((bytes, line)) = open.take() {
                    let all = Block::rest(&bytes, line, file, limits.lenient);
                    findings.append(all.findings);
                    assembly.add(all.things.unwrap_or_default(), file, findings);
                }
                findings.append(std::mem::take(&mut block.findings));
                assembly.add(things, file, findings);
                open = Some((std::mem::take(&mut block.tail), block.tail_line));
            }
            let waiting = open.as_ref().map_or(0, |(bytes, _)| bytes.len() as u64);
            assembly.has_room(waiting, file, findings)
        },
    )?;
    if let Some((bytes, line)) = open {
        let all = Block::rest(&bytes, line, file, limits.lenient);
        findings.append(all.findings);
        assembly.add(all.things.unwrap_or_default(), file, findings);
        assembly.has_room(0, file, findings);
    }
    Ok(())
}
