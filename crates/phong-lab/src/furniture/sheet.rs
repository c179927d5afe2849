//! What lies over a picture: outlines filled with colours, in groups that are painted one after another.

use phong_scene::{Rgb, srgb_encode};

use crate::draw::{Ink, Path, Point, Stroke};

/// Something painted; places are in pixels of the full picture, y down.
#[derive(Clone, Debug)]
pub(super) enum Paint {
    Fill(Path, Ink),
    Line(Path, Stroke),
    /// A bar of colours from its lower end to its upper, along whole pixels: its upper left corner, its
    /// size, and the linear colours from 0 to 1.
    Ramp {
        at: Point,
        size: Point,
        stops: Vec<(f32, Rgb)>,
    },
}

/// Things painted as one, with an edge around all of them.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// What it says, for those who cannot see it.
    pub(super) says: String,
    pub(super) paints: Vec<Paint>,
    /// Colour and width of the edge; `None`: there is none.
    pub(super) halo: Option<(Ink, f64)>,
}

impl Paint {
    /// Its upper left and its lower right corner, the width of its lines included; `None`: it is nowhere.
    fn bounds(&self) -> Option<[Point; 2]> {
        let (path, wide) = match self {
            Self::Fill(path, _) => (path, 0.0),
            Self::Line(path, stroke) => (path, 0.5 * stroke.width),
            Self::Ramp { at, size, .. } => return Some([*at, *at + *size]),
        };
        let mut points = path.points();
        let first = points.next()?;
        let [low, high] =
            points.fold([first; 2], |[low, high], point| [low.min(point), high.max(point)]);
        Some([low - Point::splat(wide), high + Point::splat(wide)])
    }

    /// The same elsewhere.
    pub(super) fn moved(&self, by: Point) -> Self {
        match self {
            Self::Fill(path, ink) => Self::Fill(path.moved(by), *ink),
            Self::Line(path, stroke) => Self::Line(path.moved(by), *stroke),
            Self::Ramp { at, size, stops } => {
                Self::Ramp { at: *at + by, size: *size, stops: stops.clone() }
            }
        }
    }
}

impl Group {
    /// Its upper left and its lower right corner, its edge included; `None`: there is nothing in it.
    pub(super) fn bounds(&self) -> Option<[Point; 2]> {
        let all = self.paints.iter().filter_map(Paint::bounds);
        let [low, high] = all.reduce(|[low, high], [from, to]| [low.min(from), high.max(to)])?;
        let halo = Point::splat(self.halo.map_or(0.0, |(_, width)| width));
        Some([low - halo, high + halo])
    }
}

/// A linear colour as ink; what is brighter than white is white.
pub(super) fn ink(color: Rgb) -> Ink {
    let level = |c: f32| (srgb_encode(f64::from(c).clamp(0.0, 1.0)) * 255.0 + 0.5) as u8;
    let [r, g, b] = color.to_array().map(level);
    Ink::rgb(r, g, b)
}
