//! What the readers of atoms share: rows of words, and what becomes of the atoms.

mod fixed;
mod row;

pub(crate) use fixed::{Fixed, fixed_lines};
pub(crate) use row::{Layout, Slot, Table, is_integer};

use std::io;
use std::sync::Arc;

use glam::DVec3;

use super::input::{Input, Wanted};
use super::origin::origin_of;
use super::text::{Findings, whole};
use super::trajectory;
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::limits::{LARGEST, Limits};
use crate::molecule::{Alternates, Drawing, Molecule, Style, names};
use crate::scene::Object;
use crate::source::trouble;
use crate::wording;

/// Atoms from the beginning that say where the molecule is.
const SAMPLED: usize = 4096;

/// Reads atoms and draws them as `input` says; `None` if a diagnostic is an error.
pub(crate) fn read_atoms(
    input: &Input<'_>,
    out: &mut Vec<Diagnostic>,
    read: impl FnOnce(&Arc<str>, &Drawing, &mut Findings) -> io::Result<Option<Molecule>>,
) -> Option<Fragment> {
    let file: Arc<str> = input.path.into();
    let drawing = match (input.drawing, input.wanted) {
        (Some(drawing), _) => drawing.clone(),
        // Points are spheres, whatever bonds there are.
        (None, Wanted::Points) => {
            let style = Some(Style::Spacefill);
            Drawing { style, radius: input.radius, ..Drawing::default() }
        }
        (None, _) => Drawing::default(),
    };
    let mut findings = Findings::default();
    let molecule = match read(&file, &drawing, &mut findings) {
        Ok(molecule) => molecule,
        Err(error) => {
            let message = format!("cannot be read: {}", trouble(&error));
            out.push(Diagnostic::error(message, whole(&file)));
            None
        }
    };
    let molecule = match (molecule, &drawing.trajectory) {
        (Some(molecule), Some(path)) if !findings.any_error() => {
            match follow(molecule, path, &drawing, input) {
                Ok((molecule, said)) => {
                    out.extend(said);
                    Some(molecule)
                }
                Err(error) => {
                    findings.tell(&file, out);
                    out.push(*error);
                    return None;
                }
            }
        }
        (molecule, _) => molecule,
    };
    let molecule = molecule.and_then(|molecule| sound(molecule, &file, &mut findings));
    let failed = findings.any_error();
    let mut drawn = None;
    if let Some(molecule) = molecule.filter(|_| !failed) {
        match molecule.draw(&drawing, &whole(&file), input.topology, input.limits) {
            Ok(found) => {
                for note in &found.notes {
                    findings.note("notes", || whole(&file), || note.clone());
                }
                drawn = Some(found);
            }
            Err(error) => {
                findings.tell(&file, out);
                out.push(*error);
                return None;
            }
        }
    }
    findings.tell(&file, out);
    let shapes = drawn?.shapes;
    let object = |(name, shape): (&str, _)| Object { name: name.to_owned(), ..Object::from(shape) };
    Some(Fragment { objects: shapes.into_iter().map(object).collect(), ..Fragment::default() })
}

/// Puts the atoms where a frame of their trajectory has them; and what there is to say of it.
fn follow(
    mut molecule: Molecule,
    path: &str,
    drawing: &Drawing,
    input: &Input<'_>,
) -> Result<(Molecule, Option<Diagnostic>), Box<Diagnostic>> {
    let at: Arc<str> = path.into();
    let error = |message: String| {
        let span = drawing.spans.trajectory.clone().unwrap_or_else(|| whole(&at));
        let named = format!("the trajectory {}: {message}", wording::path(path));
        Box::new(Diagnostic::error(named, span))
    };
    let read = || {
        let blob = input.source.open(path)?;
        // Of the frames of a film, the source has one at a time, behind the first if atoms are fixed.
        trajectory::read(&*blob, input.topology.is_some(), molecule.len() as u64)
    };
    let frame = read().map_err(|fault| match fault {
        trajectory::Fault::Io(fault) => error(format!("it cannot be read: {}", trouble(&fault))),
        trajectory::Fault::Broken(message) => error(message),
    })?;
    let held = |place: &DVec3| place.is_finite() && place.abs().max_element() <= LARGEST;
    let lost = frame.places.iter().filter(|place| !held(place)).count();
    molecule.place_all(&frame.places);
    for (sphere, place) in molecule.spheres.iter_mut().zip(&frame.places) {
        if !held(place) {
            sphere[0] = f32::NAN;
        }
    }
    molecule.cell = frame.cell.filter(|cell| !cell.stands_for_none()).or(molecule.cell);
    let one = input.topology.is_none();
    let said = if lost > 0 {
        let message =
            format!("places of the trajectory that are none: {lost}; the atoms are left out");
        Some(Diagnostic::warning(message, whole(&at)))
    } else if one && frame.said != 0 && frame.said != frame.count {
        let (said, count) = (frame.said, frame.count);
        let message = format!("the trajectory says that it has {said} frames, but it has {count}");
        Some(Diagnostic::warning(message, whole(&at)))
    } else if let Some(broken) = frame.broken {
        let message = format!("the trajectory is sound for {} frames; then, {broken}", frame.count);
        Some(Diagnostic::warning(message, whole(&at)))
    } else if one && frame.count > 1 {
        let message = "the first frame of the trajectory is drawn; others follow it";
        Some(Diagnostic::note(message, whole(&at)))
    } else {
        None
    };
    Ok((molecule, said))
}

/// Leaves out what has no place; `None` if nothing is left, which is said.
fn sound(mut molecule: Molecule, file: &Arc<str>, findings: &mut Findings) -> Option<Molecule> {
    let held = |sphere: &[f32; 4]| sphere.iter().all(|c| c.is_finite());
    if !molecule.spheres.iter().all(held) {
        let keep: Vec<bool> = molecule.spheres.iter().map(held).collect();
        molecule.retain(&keep);
    }
    if molecule.len() == 0 && !findings.any_error() {
        let message = || "there is nothing to draw: the file holds no atom".to_owned();
        findings.error("empty models", || whole(file), message);
    }
    (molecule.len() > 0).then_some(molecule)
}

/// Whether so many atoms are within the limits; says so if they are not.
pub(crate) fn has_room(
    molecule: &Molecule,
    limits: &Limits,
    file: &Arc<str>,
    findings: &mut Findings,
) -> bool {
    let (atoms, bytes) = (molecule.len() as u64, molecule.bytes());
    let message = if atoms > limits.vertices {
        format!("the file has more atoms than the limit of {}", limits.vertices)
    } else if bytes > limits.bytes {
        format!("its {atoms} atoms take more than the limit of {} bytes", limits.bytes)
    } else {
        return true;
    };
    findings.error("limits", || whole(file), || message);
    false
}

/// Says that fewer atoms are there than the file says.
pub(crate) fn tell_truncated(
    there: u64,
    said: u64,
    limits: &Limits,
    file: &Arc<str>,
    findings: &mut Findings,
) {
    let message =
        || format!("the file has {there} of {said} atoms: it is cut short or its count is wrong");
    if limits.lenient {
        findings.warning("truncated files", || whole(file), message);
    } else {
        findings.error("truncated files", || whole(file), message);
    }
}

impl Molecule {
    /// Puts the atoms there, about an origin of their own.
    pub(crate) fn place_all(&mut self, places: &[DVec3]) {
        self.origin = origin_of(places.iter().copied().take(SAMPLED));
        let origin = self.origin;
        for (sphere, place) in self.spheres.iter_mut().zip(places) {
            let place = (*place - origin).as_vec3();
            (sphere[0], sphere[1], sphere[2]) = (place.x, place.y, place.z);
        }
    }
}

/// Leaves out the alternate locations that are not drawn.
pub(crate) fn leave_out_alternates(
    molecule: &mut Molecule,
    alternates: &Alternates,
    file: &Arc<str>,
    findings: &mut Findings,
) {
    if !alternates.any() {
        return;
    }
    let kept = alternates.kept(molecule.numbers(names::OCCUPANCY).unwrap_or_default());
    let gone = kept.iter().filter(|kept| !**kept).count();
    molecule.retain(&kept);
    if gone > 0 {
        let message = || {
            format!(
                "of alternate locations those of the highest occupancy are drawn; {gone} atoms are not"
            )
        };
        findings.note("alternates", || whole(file), message);
    }
}
