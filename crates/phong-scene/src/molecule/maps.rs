//! Colours of numbers, and of things that only differ.

use crate::color::Rgb;
use crate::wording::words;

words!(ColorMap {
    "viridis" = Viridis,
    "blue-white-red" = BlueWhiteRed,
    "grey" = Grey,
});

/// Colours along a range of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColorMap {
    /// Dark blue over green to yellow, evenly perceived (matplotlib's, by van der Walt and Smith).
    Viridis,
    /// Blue over white to red.
    BlueWhiteRed,
    /// Black to white.
    Grey,
}

/// Viridis at nine even steps.
const VIRIDIS: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x27, 0xad, 0x81],
    [0x5d, 0xc8, 0x63],
    [0xaa, 0xdc, 0x32],
    [0xfd, 0xe7, 0x25],
];

/// Blue, white and red.
const BLUE_WHITE_RED: [[u8; 3]; 3] = [[0x2b, 0x4f, 0xc4], [0xf2, 0xf2, 0xf2], [0xc4, 0x2b, 0x2f]];

/// Colours that also those tell apart who see few: Okabe and Ito's, without black.
const PALETTE: [[u8; 3]; 8] = [
    [0x56, 0xb4, 0xe9],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xf0, 0xe4, 0x42],
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x99, 0x99, 0x99],
];

/// The colour of what has no value.
pub(super) const NO_VALUE: [u8; 3] = [0x80, 0x80, 0x80];

impl ColorMap {
    /// The colour at a share of the range, from 0 to 1; what is beyond has that of the end.
    pub(super) fn at(self, share: f32) -> Rgb {
        let stops: &[[u8; 3]] = match self {
            Self::Viridis => &VIRIDIS,
            Self::BlueWhiteRed => &BLUE_WHITE_RED,
            Self::Grey => &[[0; 3], [255; 3]],
        };
        let place = share.clamp(0.0, 1.0) * (stops.len() - 1) as f32;
        let first = (place as usize).min(stops.len() - 2);
        let rest = place - first as f32;
        let channel = |i: usize| {
            let [a, b] = [stops[first][i], stops[first + 1][i]].map(f32::from);
            (a + (b - a) * rest + 0.5) as u8
        };
        Rgb::from_srgb8([0, 1, 2].map(channel))
    }
}

/// A colour for the thing of this number; beyond the eighth they are lighter or darker.
pub(super) fn of_number(number: u32) -> Rgb {
    let color = PALETTE[number as usize % PALETTE.len()];
    let round = number as usize / PALETTE.len() % 3;
    Rgb::from_srgb8(color.map(|c| match round {
        0 => c,
        1 => c / 2,
        _ => 128 + c / 2,
    }))
}
