//! Spheres and cylinders of atoms and bonds.

use glam::{DVec3, Vec3};

use super::bonds::by_radii;
use super::color::by_column;
use super::style::{Drawing, Style};
use super::wrong::Wrong;
use super::{Cell, Images, Molecule, Selection, Topology, names};
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Span};
use crate::elements::van_der_waals_radius;
use crate::limits::Limits;
use crate::mesh::{Caps, Cylinders, Points};
use crate::shape::Shape;

/// The radius of atoms of unknown elements among known ones, in Å.
const UNKNOWN: f32 = 1.7;

/// Balls, as a share of the van der Waals radii.
const BALL: f32 = 0.25;

/// Radii of bonds in Å: between balls, and alone.
const BETWEEN_BALLS: f32 = 0.13;
const ALONE: f32 = 0.22;

/// Radius of tubes in Å.
const TUBE: f32 = 0.5;

/// Radii that are guessed, as a share of those at which neighbours touch, where atoms have arrows.
const BESIDE_ARROWS: f32 = 0.5;

/// Atoms of which balls and sticks can be told apart in a picture.
const FEW: usize = 400;

/// The cell's lines, as a share of the distance between its faces.
const LINE: f64 = 1.0 / 150.0;

/// A capsule and two colours.
const BYTES_OF_A_PIECE: u64 = 56;

/// A molecule as shapes.
#[derive(Debug, Default)]
pub(crate) struct Drawn {
    /// The shapes with what they are called.
    pub(crate) shapes: Vec<(&'static str, Shape)>,
    /// What was left out on purpose.
    pub(crate) notes: Vec<String>,
}

impl Molecule {
    /// Makes shapes of it.
    ///
    /// # Errors
    /// What is wrong with the drawing, that nothing is left to be drawn, or that it would be more than the limits
    /// allow; `file` is the file as a whole. Bonds by covalent radii are those of `topology`, if there is one.
    pub(crate) fn draw(
        mut self,
        drawing: &Drawing,
        file: &Span,
        topology: Option<&Topology>,
        limits: &Limits,
    ) -> Result<Drawn, Box<Diagnostic>> {
        let error = |wrong: Wrong, span: &Option<Span>| {
            let error =
                Diagnostic::error(wrong.message, span.clone().unwrap_or_else(|| file.clone()));
            Box::new(match wrong.help {
                Some(help) => error.with_help(help),
                None => error,
            })
        };
        let mut drawn = Drawn::default();
        if let Some(selection) = &drawing.select {
            let keep = selection.of(&self).map_err(|(at, wrong)| {
                error(
                    wrong,
                    &drawing
                        .spans
                        .select
                        .as_ref()
                        .map(|span| Selection::narrow(selection.text(), span, at)),
                )
            })?;
            if !keep.contains(&true) {
                let message = "no atom of the file is selected".to_owned();
                return Err(error(Wrong { message, help: None }, &drawing.spans.select));
            }
            self.retain(&keep);
        } else {
            let water = self.water();
            let count = water.iter().filter(|water| **water).count();
            if count > 0 && count < self.len() {
                let keep: Vec<bool> = water.iter().map(|water| !water).collect();
                self.retain(&keep);
                drawn.notes.push(format!("water is not drawn: {count} atoms"));
            }
            let sites = self.sites_of_water();
            let count = sites.iter().filter(|site| **site).count();
            if count > 0 && count < self.len() {
                let keep: Vec<bool> = sites.iter().map(|site| !site).collect();
                self.retain(&keep);
                drawn
                    .notes
                    .push(format!("sites of water that are no atoms are not drawn: {count}"));
            }
        }
        let no_cell = |span: &Option<Span>| {
            let message = "the file says nothing of a cell".to_owned();
            error(Wrong { message, help: None }, span)
        };
        let cell = self.cell.filter(|_| drawing.cell);
        if drawing.cell && cell.is_none() {
            return Err(no_cell(&drawing.spans.cell));
        }
        if cell.is_some() {
            let edges = Cell::edges(drawing.images.cells);
            if edges > limits.vertices || edges.saturating_mul(BYTES_OF_A_PIECE) > limits.bytes {
                let message = format!(
                    "the cells have {edges} edges, which is more than {} or than {} bytes, the limits",
                    limits.vertices, limits.bytes
                );
                return Err(error(Wrong { message, help: None }, &drawing.spans.images));
            }
        }
        if drawing.images != Images::ONE {
            let of = &drawing.spans.images;
            let cell = self.cell.ok_or_else(|| no_cell(of))?;
            let beyond =
                self.add_images(&cell, drawing.images, limits).map_err(|wrong| error(wrong, of))?;
            if beyond > 0 {
                drawn.notes.push(format!("bonds beyond the images are not drawn: {beyond}"));
            }
        }
        let mut colors =
            self.colors_by(drawing).map_err(|wrong| error(wrong, &drawing.spans.color_by))?;
        if let Some(arrows) = &drawing.vectors {
            let (arrows, without) = self
                .arrows(arrows, &colors)
                .map_err(|wrong| error(wrong, &drawing.spans.vectors))?;
            if without > 0 {
                let message = "atoms without an arrow, as their vector is 0 or no number";
                drawn.notes.push(format!("{message}: {without}"));
            }
            drawn.shapes.push(("vectors", arrows.into()));
        }
        if drawing.style == Some(Style::Tube) {
            let tubes = self
                .take_tubes(drawing, &mut colors, limits)
                .map_err(|wrong| error(wrong, &drawing.spans.style))?;
            drawn.shapes.push(("tube", tubes.into()));
        }
        let bonds = match drawing.style {
            Some(Style::Spacefill) => Vec::new(),
            None if self.len() > FEW => Vec::new(),
            _ => {
                let selection = drawing.select.as_ref().map_or("", Selection::text);
                let found = || by_radii(&self.spheres, &self.elements);
                let found = || match topology {
                    Some(topology) => {
                        topology.bonds([&file.place.file, selection], &self.elements, found)
                    }
                    None => found(),
                };
                self.all_bonds(found, &mut drawn.notes)
            }
        };
        let style = match drawing.style {
            Some(Style::Tube) => Style::BallAndStick,
            Some(style) => style,
            None if 2 * bonds.len() >= self.len() && self.len() > 1 => Style::BallAndStick,
            None => Style::Spacefill,
        };
        let wants_bonds = matches!(drawing.style, Some(Style::BallAndStick | Style::Sticks));
        if wants_bonds && bonds.is_empty() {
            drawn.notes.push("the atoms have no bonds".to_owned());
        }
        let guessed = self
            .set_radii(drawing, style)
            .map_err(|wrong| error(wrong, &drawing.spans.radius_by))?;

        // A tube's radius is its own.
        let width = drawing.bond_radius.filter(|_| drawing.style != Some(Style::Tube));
        let stick = width.unwrap_or(match style {
            Style::Sticks => ALONE,
            Style::BallAndStick | Style::Spacefill | Style::Tube => BETWEEN_BALLS,
        });
        let sticks = self.cylinders(&bonds, &colors, stick, style);
        let mut keep = vec![true; self.len()];
        if style == Style::Sticks {
            bonds.iter().flatten().for_each(|atom| keep[*atom as usize] = false);
        }
        let kept = |i: usize| keep[i];
        let spheres: Vec<[f32; 4]> = if keep.contains(&false) {
            (0..self.len()).filter(|i| kept(*i)).map(|i| self.spheres[i]).collect()
        } else {
            std::mem::take(&mut self.spheres)
        };
        let colors: Vec<Rgb> = if colors.is_empty() || !keep.contains(&false) {
            colors
        } else {
            (0..colors.len()).filter(|i| kept(*i)).map(|i| colors[i]).collect()
        };
        if !spheres.is_empty() {
            let mut points = Points {
                origin: self.origin,
                spheres: spheres.into(),
                colors: colors.into(),
                ..Points::default()
            };
            if guessed {
                points.guess_radius();
                // Spheres that touch would hide the arrows.
                let scale = if drawing.vectors.is_some() { BESIDE_ARROWS } else { 1.0 };
                let scale = scale * drawing.radius_scale;
                if let Some(radius) = points.guessed.filter(|_| scale != 1.0) {
                    points.set_radius(Some(radius * scale));
                    points.guessed = None;
                }
            }
            drawn.shapes.push(("atoms", points.into()));
        }
        if let Some(sticks) = sticks {
            drawn.shapes.push(("bonds", sticks.into()));
        }
        if let Some(cell) = cell {
            let radius = (cell.thickness() * LINE) as f32;
            let end = |place: DVec3| {
                let [x, y, z] = (place - self.origin).as_vec3().to_array();
                [x, y, z, radius]
            };
            let edges = cell.outline(drawing.images.cells);
            let segments: Vec<_> = edges.into_iter().map(|edge| edge.map(end)).collect();
            let colors = vec![[Rgb::from_srgb8([0x30; 3]); 2]; segments.len()];
            let lines = Cylinders {
                origin: self.origin,
                segments: segments.into(),
                colors: colors.into(),
                caps: Caps::Round,
                ..Cylinders::default()
            };
            drawn.shapes.push(("cell", lines.into()));
        }
        Ok(drawn)
    }

    /// Makes tubes of the residues that are chained together, and keeps the other atoms with their colours.
    fn take_tubes(
        &mut self,
        drawing: &Drawing,
        colors: &mut Vec<Rgb>,
        limits: &Limits,
    ) -> Result<Cylinders, Wrong> {
        let backbones = self.backbones();
        let bytes = backbones.pieces() * BYTES_OF_A_PIECE;
        let message = match backbones.pieces() {
            0 => "no chain of residues is found: a tube goes through the CA atoms of a protein or the P atoms \
                  of a nucleic acid"
                .to_owned(),
            _ if bytes > limits.bytes => {
                format!("the tubes take more than the limit of {} bytes", limits.bytes)
            }
            _ => String::new(),
        };
        if !message.is_empty() {
            let help = "the other styles draw atoms of any kind".to_owned();
            return Err(Wrong { message, help: Some(help) });
        }
        let by = drawing.color_by.as_deref();
        let blend = by.is_some_and(|name| self.numbers(name).is_some());
        let of_chains = match self.column(names::CHAIN) {
            // All its atoms are carbon or phosphorus.
            Some(chains) if by.is_none() && self.colors.is_empty() => by_column(chains, drawing),
            _ => Vec::new(),
        };
        let of_tube = if of_chains.is_empty() { &*colors } else { &of_chains };
        let radius = drawing.bond_radius.unwrap_or(TUBE);
        let tubes = self.tubes(&backbones, of_tube, blend, radius);
        let rest: Vec<bool> = backbones.within.iter().map(|within| !within).collect();
        self.retain(&rest);
        if !colors.is_empty() {
            super::filter(colors, &rest);
        }
        Ok(tubes)
    }

    /// Which atoms are of water.
    fn water(&self) -> Vec<bool> {
        let Some(residues) = self.words(names::RESIDUE) else { return Vec::new() };
        let of: Vec<bool> =
            residues.names.iter().map(|name| super::residue::is_water(name)).collect();
        if !of.contains(&true) {
            return Vec::new();
        }
        residues.numbers.iter().map(|number| of[*number as usize]).collect()
    }

    /// Which of the atoms are sites of a model of water, and no atoms.
    fn sites_of_water(&self) -> Vec<bool> {
        let (Some(names), water) = (self.words(names::NAME), self.water()) else {
            return Vec::new();
        };
        let of: Vec<bool> = names.names.iter().map(|name| super::residue::is_site(name)).collect();
        if !of.contains(&true) {
            return Vec::new();
        }
        let sites = names.numbers.iter().map(|number| of[*number as usize]);
        sites.zip(water).map(|(site, water)| site && water).collect()
    }

    /// The file's own bonds, and those `found` by covalent radii unless the file has all.
    fn all_bonds(
        &self,
        found: impl FnOnce() -> Vec<[u32; 2]>,
        notes: &mut Vec<String>,
    ) -> Vec<[u32; 2]> {
        let mut bonds: Vec<[u32; 2]> = self
            .bonds
            .iter()
            .filter(|[a, b]| a != b)
            .map(|[a, b]| [*a.min(b), *a.max(b)])
            .collect();
        if !self.all_bonds && self.knows_elements() {
            bonds.extend(found());
        }
        bonds.sort_unstable();
        bonds.dedup();
        let at = |atom: u32| Vec3::from_slice(&self.spheres[atom as usize][..3]);
        // Bonds go to the nearest image, which is in the next cell if that is more than half a cell away.
        if let Some(cell) = self.cell {
            let half = (0.5 * cell.thickness()) as f32;
            let before = bonds.len();
            bonds.retain(|[a, b]| at(*a).distance(at(*b)) <= half);
            let gone = before - bonds.len();
            if gone > 0 {
                notes.push(format!("bonds to the next cell are not drawn: {gone}"));
            }
        }
        bonds.retain(|[a, b]| at(*a) != at(*b));
        bonds
    }

    /// Gives every atom the radius that it is drawn with; whether it is still to be guessed.
    fn set_radii(&mut self, drawing: &Drawing, style: Style) -> Result<bool, Wrong> {
        let scale = drawing.radius_scale;
        let share = if style == Style::Spacefill { scale } else { BALL * scale };
        if let Some(name) = &drawing.radius_by {
            let column = self.known(name)?.values.clone();
            let super::Values::Numbers(radii) = column else {
                let message = format!("the column `{name}` holds words, not radii");
                return Err(Wrong { message, help: None });
            };
            for (sphere, radius) in self.spheres.iter_mut().zip(&radii) {
                sphere[3] = radius * scale;
            }
            let wrong = |radius: &f32| !(radius.is_finite() && *radius > 0.0);
            let keep: Vec<bool> = radii.iter().map(|radius| !wrong(radius)).collect();
            if keep.contains(&false) {
                let count = keep.iter().filter(|keep| !**keep).count();
                let message =
                    format!("radii must be above 0: in the column `{name}` {count} are not");
                return Err(Wrong { message, help: None });
            }
            return Ok(false);
        }
        if let Some(radius) = drawing.radius {
            self.spheres.iter_mut().for_each(|sphere| sphere[3] = radius * scale);
            return Ok(false);
        }
        let own = self.spheres.iter().any(|sphere| sphere[3] > 0.0);
        if !own && !self.knows_elements() {
            return Ok(true);
        }
        let radii: Vec<f32> =
            (0..=u8::MAX).map(|e| van_der_waals_radius(e).unwrap_or(UNKNOWN)).collect();
        let largest = self.spheres.iter().map(|sphere| sphere[3]).fold(0.0, f32::max);
        for (i, sphere) in self.spheres.iter_mut().enumerate() {
            if sphere[3] > 0.0 {
                sphere[3] *= scale;
            } else {
                let element = self.elements.get(i).copied();
                sphere[3] = element.map_or(largest, |element| radii[usize::from(element)]) * share;
            }
        }
        Ok(false)
    }

    /// The bonds as cylinders, each half of the colour of its atom.
    fn cylinders(
        &self,
        bonds: &[[u32; 2]],
        colors: &[Rgb],
        radius: f32,
        style: Style,
    ) -> Option<Cylinders> {
        if style == Style::Spacefill || bonds.is_empty() {
            return None;
        }
        let end = |atom: u32| {
            let [x, y, z, _] = self.spheres[atom as usize];
            [x, y, z, radius]
        };
        let color = |atom: u32| colors.get(atom as usize).copied();
        let halves = |[a, b]: &[u32; 2]| Some([color(*a)?, color(*b)?]);
        Some(Cylinders {
            origin: self.origin,
            segments: bonds.iter().map(|bond| bond.map(end)).collect(),
            colors: bonds.iter().filter_map(halves).collect(),
            caps: if style == Style::Sticks { Caps::Round } else { Caps::Open },
            ..Cylinders::default()
        })
    }
}
