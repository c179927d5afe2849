//! Arrows at atoms, for vectors that stand in three columns: velocities, forces, moments.

use glam::Vec3;

use super::wrong::Wrong;
use super::{Molecule, Values};
use crate::color::Rgb;
use crate::mesh::{Caps, Cylinders};

/// The longest arrow, by how far neighbours are apart, unless a scale is given.
const LONGEST: f32 = 2.5;

/// The radius of shafts, as a share of the longest arrow.
const SHAFT: f32 = 0.03;

/// The radius of heads, by that of shafts.
const HEAD: f32 = 2.2;

/// The length of heads, by their radius; a short arrow's head is at most this share of it.
const HEAD_LENGTH: f32 = 2.4;
const HEAD_SHARE: f32 = 0.6;

/// The radius of the tip, by that of the head: none may be 0.
const TIP: f32 = 1e-3;

/// Which vectors are drawn, and how.
#[derive(Clone, Debug)]
pub(crate) struct Arrows {
    /// The columns of their coordinates.
    pub(crate) columns: [String; 3],
    /// Scene units a unit of the vectors; `None`: so that the longest is as long as suits.
    pub(crate) scale: Option<f32>,
    /// The radius of their shafts; `None`: a share of the longest.
    pub(crate) radius: Option<f32>,
}

impl Molecule {
    /// An arrow from the middle of each atom, with the colour of the atom; and how many atoms have none, as
    /// their vector is 0 or no number.
    ///
    /// # Errors
    /// A column is not there, or holds words; or no atom has a vector.
    pub(super) fn arrows(
        &self,
        arrows: &Arrows,
        colors: &[Rgb],
    ) -> Result<(Cylinders, usize), Wrong> {
        let numbers = |name: &String| match &self.known(name)?.values {
            Values::Numbers(numbers) => Ok(numbers),
            Values::Words(_) => {
                let message = format!("the column `{name}` holds words, not parts of vectors");
                Err(Wrong { message, help: None })
            }
        };
        let [x, y, z] = &arrows.columns;
        let (x, y, z) = (numbers(x)?, numbers(y)?, numbers(z)?);
        let vector = |i: usize| Vec3::new(x[i], y[i], z[i]);
        let length = |i: usize| {
            let length = vector(i).as_dvec3().length() as f32;
            if length.is_finite() { length } else { 0.0 }
        };
        let longest = (0..self.len()).map(length).fold(0.0, f32::max);
        if longest <= 0.0 {
            let message = "no atom has a vector: all are 0, or no numbers".to_owned();
            return Err(Wrong { message, help: None });
        }
        let scale = arrows.scale.unwrap_or_else(|| LONGEST * self.spacing() / longest);
        let radius = arrows.radius.unwrap_or(SHAFT * scale * longest);
        let (mut segments, mut halves) = (Vec::new(), Vec::new());
        for i in 0..self.len() {
            let along = vector(i) * scale;
            let whole = length(i) * scale;
            let from = self.at(i as u32);
            let to = from + along;
            let head = (HEAD_LENGTH * HEAD * radius).min(HEAD_SHARE * whole);
            let neck = to - along * (head / whole);
            let far = |place: Vec3| place.abs().max_element() > crate::limits::LARGEST as f32;
            // What is too short to be told from its own beginning is no arrow either.
            if whole <= 0.0 || !whole.is_finite() || far(to) || neck == from || neck == to {
                continue;
            }
            // Heads of short arrows are as slender as those of others.
            let wide = head / HEAD_LENGTH;
            let shaft = radius.min(wide / HEAD);
            let end = |place: Vec3, radius: f32| [place.x, place.y, place.z, radius];
            segments.push([end(from, shaft), end(neck, shaft)]);
            segments.push([end(neck, wide), end(to, wide * TIP)]);
            if let Some(color) = colors.get(i) {
                halves.extend([[*color; 2]; 2]);
            }
        }
        if segments.is_empty() {
            let message = "no vector is long enough to be drawn, or all are too long".to_owned();
            return Err(Wrong { message, help: None });
        }
        let without = self.len() - segments.len() / 2;
        let cylinders = Cylinders {
            origin: self.origin,
            segments: segments.into(),
            colors: halves.into(),
            caps: Caps::Flat,
            ..Cylinders::default()
        };
        Ok((cylinders, without))
    }

    /// How far neighbours are apart.
    fn spacing(&self) -> f32 {
        2.0 * crate::mesh::radius_that_touches(&self.spheres)
    }
}
