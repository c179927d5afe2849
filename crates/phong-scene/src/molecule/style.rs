//! How atoms are drawn.

use super::maps::ColorMap;
use super::{Arrows, Images, Selection};
use crate::diagnostic::Span;
use crate::wording::words;

words!(Style {
    "spacefill" = Spacefill,
    "ball-and-stick" = BallAndStick,
    "sticks" = Sticks,
    "tube" = Tube,
});

/// What atoms and bonds become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// Spheres of the atoms' van der Waals radii.
    Spacefill,
    /// Small spheres, and cylinders for bonds.
    BallAndStick,
    /// Bonds alone.
    Sticks,
    /// Tubes along the backbones of proteins and nucleic acids; balls and sticks for what else there is.
    Tube,
}

/// What of a molecule is drawn, and how.
#[derive(Clone, Debug)]
pub(crate) struct Drawing {
    /// What atoms become; `None`: sticks and balls if there are few atoms and bonds between them.
    pub(crate) style: Option<Style>,
    /// What is drawn; `None`: all but water, if there is anything else.
    pub(crate) select: Option<Selection>,
    /// The column that colours are by; `None`: the file's own colours, else elements, else types.
    pub(crate) color_by: Option<String>,
    /// The colours of numbers; `None`: one that fits the column.
    pub(crate) color_map: Option<ColorMap>,
    /// The numbers that the ends of the map stand for; `None`: the least and the largest there are.
    pub(crate) color_range: Option<[f64; 2]>,
    /// The column that radii are by.
    pub(crate) radius_by: Option<String>,
    /// The radius of all; `None`: the file's own, else those of the elements.
    pub(crate) radius: Option<f32>,
    /// What all radii are multiplied by.
    pub(crate) radius_scale: f32,
    /// The radius of bonds and of tubes; `None`: as the style has it.
    pub(crate) bond_radius: Option<f32>,
    /// The trajectory whose places are drawn in place of the file's own.
    pub(crate) trajectory: Option<String>,
    /// The vectors that are drawn as arrows.
    pub(crate) vectors: Option<Arrows>,
    /// Which images of the cell are drawn.
    pub(crate) images: Images,
    /// Whether the cell is drawn.
    pub(crate) cell: bool,
    /// Where the keys were written, for what is wrong with them.
    pub(crate) spans: Spans,
}

/// Where keys of a drawing were written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spans {
    pub(crate) select: Option<Span>,
    pub(crate) color_by: Option<Span>,
    pub(crate) radius_by: Option<Span>,
    pub(crate) trajectory: Option<Span>,
    pub(crate) style: Option<Span>,
    pub(crate) vectors: Option<Span>,
    pub(crate) images: Option<Span>,
    pub(crate) cell: Option<Span>,
}

impl Default for Drawing {
    fn default() -> Self {
        Self {
            style: None,
            select: None,
            color_by: None,
            color_map: None,
            color_range: None,
            radius_by: None,
            radius: None,
            radius_scale: 1.0,
            bond_radius: None,
            trajectory: None,
            vectors: None,
            images: Images::ONE,
            cell: false,
            spans: Spans::default(),
        }
    }
}

impl Drawing {
    /// Whether a column of this name is asked for.
    pub(crate) fn uses(&self, column: &str) -> bool {
        let by = |name: &Option<String>| name.as_deref() == Some(column);
        by(&self.color_by)
            || by(&self.radius_by)
            || self
                .vectors
                .as_ref()
                .is_some_and(|vectors| vectors.columns.iter().any(|c| c == column))
            || self.select.as_ref().is_some_and(|select| select.uses(column))
    }
}
