//! One palette and one type scale for all figures.
//!
//! A vector keeps its colour in every figure, and the colours are those of Okabe and Ito, which
//! stay apart for colour-blind eyes; each is darkened until it reads on white.

use super::mark::Ink;

/// The canvas, in units: 16 to 9, like a slide.
pub(super) const WIDTH: f64 = 960.0;
/// Its height, unless a figure asks for more.
pub(super) const HEIGHT: f64 = 540.0;

/// The background.
pub(super) const PAPER: Ink = Ink::rgb(0xff, 0xff, 0xff);
/// Words and axes.
pub(super) const TEXT: Ink = Ink::rgb(0x1f, 0x24, 0x2b);
/// Words that can wait.
pub(super) const MUTED: Ink = Ink::rgb(0x5c, 0x65, 0x70);
/// Guides and frames.
pub(super) const GUIDE: Ink = Ink::rgb(0xa9, 0xb1, 0xba);
/// Grid lines.
pub(super) const GRID: Ink = Ink::rgb(0xe6, 0xe9, 0xed);
/// The inside of a body.
pub(super) const BODY: Ink = Ink::rgb(0xee, 0xf1, 0xf4);
/// The outline of a body.
pub(super) const SURFACE: Ink = Ink::rgb(0x6b, 0x76, 0x82);

/// The normal *n*.
pub(super) const NORMAL: Ink = Ink::rgb(0x00, 0x66, 0xa8);
/// The light vector *l*.
pub(super) const LIGHT: Ink = Ink::rgb(0xc9, 0x7b, 0x00);
/// The reflected vector *r*.
pub(super) const MIRROR: Ink = Ink::rgb(0xc8, 0x4a, 0x00);
/// The eye vector *e*.
pub(super) const EYE: Ink = Ink::rgb(0x00, 0x83, 0x60);
/// The halfway vector *h*.
pub(super) const HALF: Ink = Ink::rgb(0x9b, 0x3d, 0x83);

/// A figure's title.
pub(super) const TITLE: f64 = 24.0;
/// An equation, and the name of a vector.
pub(super) const LETTER: f64 = 22.0;
/// The heading of a panel.
pub(super) const HEADING: f64 = 17.0;
/// A note beside a thing, and the name of an axis.
pub(super) const NOTE: f64 = 15.0;
/// A number at a tick.
pub(super) const TICK: f64 = 13.0;

/// A vector's shaft.
pub(super) const VECTOR: f64 = 3.0;
/// A curve of a plot.
pub(super) const CURVE: f64 = 2.4;
/// An axis, an outline.
pub(super) const LINE: f64 = 1.4;
/// A guide, a tick.
pub(super) const THIN: f64 = 1.0;

/// Six colours that stay apart, for six curves in one plot; Okabe and Ito's, darkened for white.
pub(super) const FAMILY: [Ink; 6] = [
    Ink::rgb(0x1f, 0x24, 0x2b),
    Ink::rgb(0x9b, 0x3d, 0x83),
    Ink::rgb(0x00, 0x66, 0xa8),
    Ink::rgb(0x00, 0x83, 0x60),
    Ink::rgb(0xc9, 0x7b, 0x00),
    Ink::rgb(0xc8, 0x4a, 0x00),
];

/// What stands for an ink on dark paper: the palette's own pale twin, or the ink itself.
pub(super) fn on_dark(ink: Ink) -> Ink {
    let twins = [
        (PAPER, Ink::rgb(0x15, 0x18, 0x1c)),
        (TEXT, Ink::rgb(0xe4, 0xe8, 0xec)),
        (MUTED, Ink::rgb(0x9a, 0xa5, 0xb1)),
        (GUIDE, Ink::rgb(0x5a, 0x63, 0x6d)),
        (GRID, Ink::rgb(0x2a, 0x30, 0x38)),
        (BODY, Ink::rgb(0x26, 0x2c, 0x33)),
        (SURFACE, Ink::rgb(0x8f, 0x9a, 0xa5)),
        (NORMAL, Ink::rgb(0x5c, 0xb3, 0xf0)),
        (LIGHT, Ink::rgb(0xf2, 0xb1, 0x34)),
        (MIRROR, Ink::rgb(0xff, 0x8a, 0x4c)),
        (EYE, Ink::rgb(0x3f, 0xd1, 0xa4)),
        (HALF, Ink::rgb(0xe0, 0x8f, 0xcb)),
    ];
    let twin = twins.iter().find(|(light, _)| light.srgb == ink.srgb);
    twin.map_or(ink, |(_, dark)| dark.fade(ink.opacity))
}

/// `count` shades of one blue, light to dark: members of a family of curves.
pub(super) fn shades(count: usize) -> Vec<Ink> {
    let (light, dark) = ([0x8f, 0xc1, 0xe3], [0x0b, 0x2f, 0x57]);
    let last = count.saturating_sub(1).max(1) as f64;
    let shade = |i: usize| {
        let t = i as f64 / last;
        let mix = |a: u8, b: u8| ((1.0 - t) * f64::from(a) + t * f64::from(b) + 0.5) as u8;
        Ink::rgb(mix(light[0], dark[0]), mix(light[1], dark[1]), mix(light[2], dark[2]))
    };
    (0..count).map(shade).collect()
}
