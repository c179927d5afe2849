//! What a figure needs beside its picture: a title, a scale bar, axes, a legend, and labels. They are
//! drawn when the picture is done.
//!
//! ```toml
//! [furniture]
//! size = 8
//!
//! [title]
//! text = "Lysozyme, 1.5 Å"
//!
//! [scale_bar]
//! unit = "nm"
//! factor = 0.1                    # the scene is in Å
//!
//! [axes]
//! place = "bottom-right"
//!
//! [legend]
//! map = "viridis"
//! from = 0
//! to = 40
//! text = "B factor"
//! unit = "Å²"
//!
//! [[label]]
//! text = "active site"
//! at = [0.0, 1.2, 0.3]
//! offset = [12, 8]
//! ```
//!
//! `[furniture]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `size` | a number above 0 up to 1000 | `9` | Height of letters, points; a title's are half as high again. |
//! | `color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | black or white, whichever stands out from the background | Colour of letters and lines. |
//! | `halo` | a number from 0 to 100 | `1` | Width of an edge around letters and lines, points, white around dark ones and black around bright ones; 0: there is none. |
//! | `margin` | a number from 0 to 10000 | `9` | Distance from the edges of the picture, points. |
//!
//! `[title]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `text` | text | required | Its words. |
//! | `place` | `top-left`, `top`, `top-right`, `left`, `right`, `bottom-left`, `bottom` or `bottom-right` | `"top"` | Where on the picture it stands; what stands there already is nearer to the edge. |
//!
//! `[scale_bar]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `length` | a number above 0, or "auto" | `"auto"` | Its length, in its unit. `"auto"` is the longest of 1, 2 or 5 times a power of ten that is no more than a quarter of the picture's width. |
//! | `unit` | text | none | What is written behind the number. |
//! | `factor` | a number above 0 | `1` | How many of the unit a scene unit is: 0.1 where a scene is in Å, and the bar is to be in nm. |
//! | `place` | `top-left`, `top`, `top-right`, `left`, `right`, `bottom-left`, `bottom` or `bottom-right` | `"bottom-left"` | Where on the picture it stands; what stands there already is nearer to the edge. |
//!
//! `[axes]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `length` | a number above 0 up to 1000 | `24` | Length of an arrow that lies in the picture, points. |
//! | `place` | `top-left`, `top`, `top-right`, `left`, `right`, `bottom-left`, `bottom` or `bottom-right` | `"bottom-right"` | Where on the picture it stands; what stands there already is nearer to the edge. |
//!
//! `[legend]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `texture` | the name of a texture, in quotes | the first with a range that a material uses | The texture whose colours and whose range they are: of kind `map` or `gradient`. |
//! | `map` | a list of `[t, colour]`, t from 0 to 1 and never falling, or a colour map: `viridis`, `cividis`, `plasma`, `inferno`, `magma`, `turbo` or `coolwarm` | the texture's | The colours from 0 to 1. |
//! | `from` | a number | the texture's, else 0 | What the first colour stands for. |
//! | `to` | a number | the texture's, else 1 | What the last colour stands for; another number than `from`. |
//! | `text` | text | what the texture is of | What is measured. |
//! | `unit` | text | the texture's | In which unit. |
//! | `ticks` | a whole number from 2 to 20 | `5` | About how many numbers stand beside it; they are round ones. |
//! | `place` | `top-left`, `top`, `top-right`, `left`, `right`, `bottom-left`, `bottom` or `bottom-right` | `"right"` | Where on the picture it stands; what stands there already is nearer to the edge. |
//!
//! `[[label]]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `text` | text | required | The words. |
//! | `at` | three numbers, `[x, y, z]` | required | The point. |
//! | `hidden` | `behind` or `never` | `"behind"` | Whether they are hidden where something stands before the point, or never. |
//! | `radius` | a number 0 or above | `0` | How far before the point something may stand without hiding it, in scene units: the radius of the ball whose middle the point is. |
//! | `offset` | two numbers, `[x, y]` | `[0, 0]` | How far from the point they begin, points, to the right and up; to the left (below 0) they end there, and at 0 they are over its middle. |

use glam::{DVec2, DVec3};

use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::limits::Range;
use crate::wording::words;

/// What a figure needs beside its picture, drawn when the picture is done: none of it is a term of the sum.
/// The default is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Furniture {
    /// What all of it has in common.
    pub style: FurnitureStyle,
    /// A title; `None`: there is none.
    pub title: Option<Title>,
    /// A bar that shows a length; `None`: there is none.
    pub scale_bar: Option<ScaleBar>,
    /// Which ways x, y and z point; `None`: that is not shown.
    pub axes: Option<Axes>,
    /// What the colours of a map stand for; `None`: that is not shown.
    pub legend: Option<Legend>,
    /// Words at points of the scene, at most [`Furniture::MOST_LABELS`].
    pub labels: Vec<PointLabel>,
}

impl Furniture {
    /// The most labels of a scene.
    pub const MOST_LABELS: usize = 1000;

    /// The longest text of any of it, in characters.
    pub const LONGEST_TEXT: usize = 200;

    /// Whether there is nothing to be drawn.
    pub fn is_empty(&self) -> bool {
        let Self { style: _, title, scale_bar, axes, legend, labels } = self;
        title.is_none()
            && scale_bar.is_none()
            && axes.is_none()
            && legend.is_none()
            && labels.is_empty()
    }

    /// Whether any of it is hidden by what stands before it.
    pub fn needs_depth(&self) -> bool {
        self.labels.iter().any(|label| label.hidden == Hidden::Behind)
    }
}

/// What all furniture of a figure has in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FurnitureStyle {
    /// Height of letters, points, > 0; a title's are half as high again. Default 9.
    pub size: f64,
    /// Colour of letters and lines, linear; `None`: black or white, whichever stands out from the
    /// background.
    pub color: Option<Rgb>,
    /// Width of the edge around letters and lines, points, in black on white or white on black; 0: there
    /// is none. Default 1.
    pub halo: f64,
    /// Distance from the picture's edges, points, ≥ 0. Default 9.
    pub margin: f64,
}

impl FurnitureStyle {
    /// Heights of letters, points.
    pub(crate) const SIZE: Range = Range::above(0.0, 1000.0);
    /// Widths of edges, points.
    pub(crate) const HALO: Range = Range::closed(0.0, 100.0);
    /// Lengths on the figure, points.
    pub(crate) const LENGTH: Range = Range::closed(0.0, 10_000.0);
}

impl Default for FurnitureStyle {
    fn default() -> Self {
        Self { size: 9.0, color: None, halo: 1.0, margin: 9.0 }
    }
}

/// Where on the picture something stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The upper left corner.
    TopLeft,
    /// The middle of the upper edge.
    Top,
    /// The upper right corner.
    TopRight,
    /// The middle of the left edge.
    Left,
    /// The middle of the right edge.
    Right,
    /// The lower left corner.
    BottomLeft,
    /// The middle of the lower edge.
    Bottom,
    /// The lower right corner.
    BottomRight,
}

impl Anchor {
    /// How many places there are.
    pub const COUNT: usize = 8;

    /// Its number among them, from 0.
    pub const fn number(self) -> usize {
        self as usize
    }
}

words!(Anchor {
    "top-left" = TopLeft,
    "top" = Top,
    "top-right" = TopRight,
    "left" = Left,
    "right" = Right,
    "bottom-left" = BottomLeft,
    "bottom" = Bottom,
    "bottom-right" = BottomRight,
});

/// A title.
#[derive(Clone, Debug, PartialEq)]
pub struct Title {
    /// Its words.
    pub text: String,
    /// Where it stands. Default at the top.
    pub place: Anchor,
}

impl Default for Title {
    fn default() -> Self {
        Self { text: String::new(), place: Anchor::Top }
    }
}

/// A bar that shows a length of the scene, at the distance of what the camera is focused on.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleBar {
    /// How long it is.
    pub length: BarLength,
    /// The unit that is written behind the number; empty: none is.
    pub unit: String,
    /// How many of the unit a scene unit is, > 0. Default 1.
    pub factor: f64,
    /// Where it stands. Default the lower left corner.
    pub place: Anchor,
}

impl Default for ScaleBar {
    fn default() -> Self {
        Self {
            length: BarLength::Auto,
            unit: String::new(),
            factor: 1.0,
            place: Anchor::BottomLeft,
        }
    }
}

/// How long a scale bar is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BarLength {
    /// 1, 2 or 5 times a power of ten: the longest that is no more than a quarter of the picture's width.
    Auto,
    /// So many of its units, > 0.
    Units(f64),
}

/// Three arrows that show which ways x, y and z point, from the lower end to the upper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// Length of an arrow that lies in the picture, points, > 0. Default 24.
    pub length: f64,
    /// Where they stand. Default the lower right corner.
    pub place: Anchor,
}

impl Default for Axes {
    fn default() -> Self {
        Self { length: 24.0, place: Anchor::BottomRight }
    }
}

/// What the colours of a map stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// The name of the texture whose colours they are, and whose range; empty: the first with a range that a
    /// material uses.
    pub texture: String,
    /// The colours from 0 to 1, never falling, linear; `None`: the texture's.
    pub map: Option<Vec<(f32, Rgb)>>,
    /// What the first colour stands for; `None`: as the texture has it, or 0.
    pub from: Option<f64>,
    /// What the last colour stands for; `None`: as the texture has it, or 1.
    pub to: Option<f64>,
    /// What is measured; empty: that is not said.
    pub text: String,
    /// In which unit; empty: that is not said.
    pub unit: String,
    /// About how many numbers stand beside it, 2 to 20. Default 5.
    pub ticks: u32,
    /// Where it stands. Default at the right.
    pub place: Anchor,
}

impl Legend {
    /// The most numbers beside a legend.
    pub(crate) const MOST_TICKS: u64 = 20;
}

impl Default for Legend {
    fn default() -> Self {
        Self {
            texture: String::new(),
            map: None,
            from: None,
            to: None,
            text: String::new(),
            unit: String::new(),
            ticks: 5,
            place: Anchor::Right,
        }
    }
}

/// Words at a point of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLabel {
    /// The words.
    pub text: String,
    /// The point.
    pub at: DVec3,
    /// What hides them. Default what stands before the point.
    pub hidden: Hidden,
    /// How far before the point something may stand without hiding it, scene units, ≥ 0: the radius of
    /// the ball whose middle the point is. Default 0.
    pub radius: f64,
    /// How far from the point they stand, points: right and up. At 0 their middle is at the point.
    pub offset: DVec2,
    /// Where it was written.
    pub place: Place,
}

impl Default for PointLabel {
    fn default() -> Self {
        Self {
            text: String::new(),
            at: DVec3::ZERO,
            hidden: Hidden::Behind,
            radius: 0.0,
            offset: DVec2::ZERO,
            place: Place::default(),
        }
    }
}

/// What hides a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hidden {
    /// Whatever stands before its point.
    Behind,
    /// Nothing does.
    Never,
}

words!(Hidden { "behind" = Behind, "never" = Never });
