//! Which colour an atom has.

use rayon::prelude::*;

use super::maps::{ColorMap, NO_VALUE, of_number};
use super::style::Drawing;
use super::wrong::Wrong;
use super::{Column, Molecule, Values, names};
use crate::color::Rgb;
use crate::elements::color_of;

impl Molecule {
    /// The colours of all atoms; empty: that of the material.
    pub(super) fn colors_by(&self, drawing: &Drawing) -> Result<Vec<Rgb>, Wrong> {
        match drawing.color_by.as_deref() {
            None if !self.colors.is_empty() => Ok(self.colors.clone()),
            None if self.knows_elements() => Ok(self.by_element()),
            None => match self.column(names::TYPE) {
                Some(column) => Ok(by_column(column, drawing)),
                None => Ok(Vec::new()),
            },
            Some("element") if self.elements.is_empty() => Err(Wrong {
                message: "the file does not say which elements its atoms are of".to_owned(),
                help: self.known_columns(),
            }),
            Some("element") => Ok(self.by_element()),
            Some(name) => Ok(by_column(self.known(name)?, drawing)),
        }
    }

    /// Whether at least half of the atoms are of known elements.
    pub(super) fn knows_elements(&self) -> bool {
        let known = self.elements.iter().filter(|element| **element > 0).count();
        known > 0 && 2 * known >= self.len()
    }

    fn by_element(&self) -> Vec<Rgb> {
        let colors: Vec<Rgb> = (0..=u8::MAX).map(|e| Rgb::from_srgb8(color_of(e))).collect();
        self.elements.par_iter().map(|element| colors[usize::from(*element)]).collect()
    }
}

/// A colour for each value of a column.
pub(super) fn by_column(column: &Column, drawing: &Drawing) -> Vec<Rgb> {
    match &column.values {
        Values::Words(words) => {
            // Types are numbered by many programs: then the first colour is that of 1.
            let number = |name: &String| name.parse::<u32>().ok().filter(|n| *n > 0);
            let all: Option<Vec<u32>> = words.names.iter().map(number).collect();
            let numbers = all.map_or_else(
                || (0..words.names.len() as u32).collect(),
                |all| all.into_iter().map(|n| n - 1).collect::<Vec<u32>>(),
            );
            let colors: Vec<Rgb> = numbers.into_iter().map(of_number).collect();
            words.numbers.par_iter().map(|number| colors[*number as usize]).collect()
        }
        Values::Numbers(numbers) => {
            let signed = column.name == names::CHARGE;
            let map = if signed { ColorMap::BlueWhiteRed } else { ColorMap::Viridis };
            let map = drawing.color_map.unwrap_or(map);
            let [low, high] = drawing.color_range.map_or_else(
                || range_of(numbers, map == ColorMap::BlueWhiteRed && signed),
                |range| range.map(|end| end as f32),
            );
            let color = |value: &f32| {
                if value.is_nan() {
                    Rgb::from_srgb8(NO_VALUE)
                } else if high > low {
                    map.at((value - low) / (high - low))
                } else {
                    map.at(0.5)
                }
            };
            numbers.par_iter().map(color).collect()
        }
    }
}

/// The least and the largest number; as far from 0 both, if `even`.
fn range_of(numbers: &[f32], even: bool) -> [f32; 2] {
    let finite = numbers.iter().filter(|n| n.is_finite());
    let [low, high] = finite
        .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], n| [low.min(*n), high.max(*n)]);
    let most = low.abs().max(high.abs());
    if even && most.is_finite() { [-most, most] } else { [low, high] }
}
