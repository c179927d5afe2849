//! NFF, the Neutral File Format of Haines' Standard Procedural Databases: this very model.
//!
//! | in the file | read as |
//! |---|---|
//! | `v` with `from at up angle resolution` | the camera, `angle` being its height, and the size of the picture |
//! | `hither` | not used |
//! | `b r g b` | the background |
//! | `l x y z`, of n lights | point lights of √n / n each, as the format's convention has it |
//! | `l x y z r g b` | of this colour |
//! | `f r g b Kd Ks Shine T index` | `k_d k_s shininess` of Phong; mirror rays of weight `Ks`, refracted ones of weight `T`. The format has no ambient light |
//! | `s` | spheres |
//! | `c` | a cone or cylinder without caps |
//! | `p n`; `pp n` | a polygon, which need not be convex; with normals |
//! | `#` | a comment, up to the line's end |
//!
//! A file without a view is framed as a bare model is, and one without lights lit as one. Words that the format does not have, and the images
//! that some programs name behind an `f`, are counted in warnings.
//!
//! What has no extent, or a number that is none, is left out and counted. A statement that cannot be
//! read is an error with its line; so is Sense8's format of the same name, which is told by its first word.

mod scene;

use std::sync::Arc;

use glam::{DVec3, Vec3};

use self::scene::{Assembly, Look};
use super::input::{Input, Models};
use super::text::{Fault, Findings, Parsed, Words, read_text, whole};
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Place};
use crate::limits::LARGEST;
use crate::scene::Reading;
use crate::source::trouble;

/// Whether a file that begins so is surely NFF.
pub(crate) fn is_nff(head: &[u8]) -> bool {
    let mut words = Words::of(head, 1);
    words.word() == b"v" && words.word() == b"from"
}

/// Reads an NFF scene.
pub(crate) fn read(input: &Input<'_>, _: &'static Models) -> Reading {
    let file: Arc<str> = input.path.into();
    let mut diagnostics = Vec::new();
    let mut findings = Findings::default();
    let mut bare = false;
    let scene = match read_text(input.source, &file, input.limits) {
        Err(error) => {
            let message = || format!("cannot be read: {}", trouble(&error));
            findings.error("files that cannot be read", || whole(&file), message);
            None
        }
        Ok(text) => {
            let mut assembly = Assembly::default();
            statements(&text, &file, input.limits.lenient, &mut assembly, &mut findings);
            assembly.tell_unknown(&mut findings);
            let room = assembly.has_room(input.limits, &file, &mut findings);
            bare = assembly.is_bare();
            (room && !findings.any_error()).then(|| assembly.finish(&file, &mut findings))
        }
    };
    if let Some(change) = input.changes.first() {
        let message = || format!("an NFF scene has no key {} to change", change.path());
        findings.error("keys that are not there", || whole(&file), message);
    }
    findings.tell(&file, &mut diagnostics);
    if let Some(scene) = &scene {
        diagnostics.extend(scene.check());
    }
    let sound = !diagnostics.iter().any(Diagnostic::is_error);
    Reading { scene: scene.filter(|_| sound), bare, diagnostics }
}

fn statements(
    text: &[u8],
    file: &Arc<str>,
    lenient: bool,
    assembly: &mut Assembly,
    findings: &mut Findings,
) {
    let mut words = Words::of(text, 1);
    if !words.is_there() {
        let message = || "there is nothing to draw: the file is empty".to_owned();
        findings.error("empty files", || whole(file), message);
    }
    if words.clone().word().eq_ignore_ascii_case(b"nff") {
        let message =
            || "this is Sense8's NFF, which shares but the name; it is not read".to_owned();
        findings.error("other files", || words.here(file), message);
        return;
    }
    while words.is_there() {
        let start = words.clone();
        let line = words.line().min(u32::MAX.into()) as u32;
        let place = Place { file: Arc::clone(file), line, column: 1 };
        let Err(fault) = statement(&mut words, assembly, place) else { continue };
        let name = start.quote();
        let message = || match fault {
            Fault::Wrong(said) if said.contains("a statement") => said,
            Fault::Wrong(said) => format!("in `{name}`: {said}"),
            Fault::End => format!("the file ends within `{name}`"),
        };
        findings.damage(lenient, "statements that cannot be read", || start.here(file), message);
        loop {
            words.next_line();
            let mut ahead = words.clone();
            let names: [&[u8]; 8] = [b"v", b"b", b"l", b"f", b"s", b"c", b"p", b"pp"];
            if !ahead.is_there() || names.contains(&ahead.word()) {
                break;
            }
        }
    }
}

/// Reads one statement.
fn statement(words: &mut Words<'_>, assembly: &mut Assembly, place: Place) -> Parsed<()> {
    match words.word() {
        b"v" => view(words, assembly)?,
        b"b" => assembly.background = color(words.three()?),
        b"l" => {
            let position = double(words.three()?);
            let mut ahead = words.clone();
            let own = ahead.three().ok();
            if own.is_some() {
                *words = ahead;
            }
            assembly.lamps.push((position, own.map(color), place));
        }
        b"f" => {
            let base = color(words.three()?);
            // Some programs write less, others the name of an image behind it.
            let line = words.line();
            let mut numbers = [1.0, 0.0, 1.0, 0.0, 1.0];
            for number in &mut numbers {
                let mut ahead = words.clone();
                match ahead.number() {
                    Ok(value) if ahead.line() == line => (*number, *words) = (value, ahead),
                    _ => break,
                }
            }
            if words.is_there() && words.line() == line {
                assembly.images += 1;
                words.next_line();
            }
            let [diffuse, specular, shine, through, ior] = numbers;
            assembly.look(Look { base, diffuse, specular, shine, through, ior }, place);
        }
        b"s" => {
            let [x, y, z] = words.three()?;
            assembly.sphere([x, y, z, words.number()?]);
        }
        b"c" => {
            let mut end = || -> Parsed<[f32; 4]> {
                let [x, y, z] = words.three()?;
                Ok([x, y, z, words.number()?])
            };
            assembly.cone([end()?, end()?], place);
        }
        word @ (b"p" | b"pp") => {
            let with_normals = word == b"pp";
            let count = words.whole()?;
            let (mut corners, mut normals) = (Vec::new(), Vec::new());
            for _ in 0..count {
                corners.push(Vec3::from(words.three()?));
                if with_normals {
                    normals.push(Vec3::from(words.three()?));
                }
            }
            assembly.polygon(&corners, &normals);
        }
        _ => {
            assembly.unknown.get_or_insert((0, place)).0 += 1;
            words.next_line();
        }
    }
    Ok(())
}

fn view(words: &mut Words<'_>, assembly: &mut Assembly) -> Parsed<()> {
    let view = &mut assembly.view;
    loop {
        let mut ahead = words.clone();
        match ahead.word() {
            b"from" => view.from = double(ahead.three()?),
            b"at" => view.at = double(ahead.three()?),
            b"up" => view.up = double(ahead.three()?),
            b"angle" => view.angle = ahead.number()?.into(),
            b"hither" => drop(ahead.number()?),
            b"resolution" => view.size = Some([ahead.whole()?, ahead.whole()?]),
            _ => {
                assembly.viewed = true;
                return Ok(());
            }
        }
        *words = ahead;
    }
}

fn double(vector: [f32; 3]) -> DVec3 {
    let sound = |c: f32| if c.abs() <= LARGEST as f32 { f64::from(c) } else { 0.0 };
    DVec3::from(vector.map(sound))
}

/// A colour of three numbers: what is negative or no number is 0.
fn color(color: [f32; 3]) -> Rgb {
    let [r, g, b] = color.map(|c| if c > 0.0 { c.min(1e6) } else { 0.0 });
    Rgb::new(r, g, b)
}
