//! What textures are: the kinds, and the words of each.

use std::sync::Arc;

use glam::DVec3;

use super::{Channel, MapRange, Texture, TextureSpace};
use crate::color::Rgb;
use crate::texels::Texels;
use crate::wording::{Word as _, words};

/// What a texture is.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureKind {
    /// Cubes of two colours in turn; on a plane, squares.
    Checker {
        /// Where ⌊x⌋ + ⌊y⌋ + ⌊z⌋ is even, and where it is odd. Linear.
        colors: [Rgb; 2],
        /// Squares a unit, > 0.
        scale: f64,
    },
    /// Colours that run into one another along an axis, or from a point outwards.
    Gradient {
        /// Which of the two. Default along the axis.
        by: GradientBy,
        /// Along which; any length but 0.
        axis: DVec3,
        /// The distance along the axis at which t is 0.
        from: f64,
        /// The distance at which t is 1; another one.
        to: f64,
        /// `t` in [0, 1], never falling, and the linear colour there; at least one.
        stops: Vec<(f32, Rgb)>,
    },
    /// An image: its left edge at 0 and its right edge at 1 of the first coordinate, its lower edge at 0 and
    /// its upper edge at 1 of the second.
    Image {
        /// The file that it is of, as it was written; empty: it is of none.
        file: String,
        /// Its pixels.
        texels: Arc<Texels>,
        /// What is beside it.
        wrap: Wrap,
        /// What is above and below it; `None`: the same.
        wrap_v: Option<Wrap>,
        /// The colour beside it, where [`Wrap::Border`] says so. Linear; its opacity is 0.
        border: Rgb,
        /// What its colours are multiplied by. Linear.
        tint: Rgb,
        /// What is between its pixels, and what stands for many of them.
        filter: TexelFilter,
        /// What its numbers mean.
        encoding: Encoding,
    },
    /// Colours of numbers.
    Map {
        /// Which: what [`MapSource::of`](super::MapSource::of) takes.
        of: String,
        /// Along which heights are, and to which normals are held, any length but 0; `None`: the camera's
        /// `up`.
        axis: Option<DVec3>,
        /// Between which the colours run.
        range: MapRange,
        /// `t` in [0, 1], never falling, and the linear colour there; at least one.
        stops: Vec<(f32, Rgb)>,
        /// The colour of what has no number. Linear.
        nan: Rgb,
        /// The unit of the numbers, for legends; `None`: it is not said.
        unit: Option<String>,
    },
    /// Lines along planes in which one coordinate is a whole number of cells.
    Grid {
        /// That of the lines, and that of what is between them. Linear.
        colors: [Rgb; 2],
        /// Cells a unit, > 0.
        scale: f64,
        /// How wide lines are, in units, > 0; a cell's width and more: there is nothing between.
        width: f64,
        /// Along which axes cells are counted.
        axes: GridAxes,
    },
    /// Two colours in turn, along an axis or from a point outwards.
    Stripes {
        /// That where the count of stripes is even, and that where it is odd. Linear.
        colors: [Rgb; 2],
        /// Stripes a unit, > 0.
        scale: f64,
        /// Which of the two. Default along the axis.
        by: GradientBy,
        /// Along which; any length but 0.
        axis: DVec3,
    },
    /// Gradient noise: smooth, and without a direction.
    Noise {
        /// `t` in [0, 1], never falling, and the linear colour there; at least one.
        stops: Vec<(f32, Rgb)>,
        /// Cells a unit of the first octave, > 0.
        scale: f64,
        /// How many noises are added up, 1 to [`TextureKind::MOST_OCTAVES`].
        octaves: u32,
        /// How many times as fine each is as the one before, 1 to 8.
        lacunarity: f64,
        /// How many times as strong, 0 to 1.
        gain: f64,
        /// Which of many such noises.
        seed: u32,
    },
    /// Veins: waves along an axis that noise bends.
    Marble {
        /// As those of noise.
        stops: Vec<(f32, Rgb)>,
        /// Veins a unit, > 0; as many cells of the noise.
        scale: f64,
        /// Across the veins; any length but 0.
        axis: DVec3,
        /// How many veins the noise moves them at most, about; 0 or more.
        turbulence: f64,
        /// As that of noise.
        octaves: u32,
        /// As that of noise.
        lacunarity: f64,
        /// As that of noise.
        gain: f64,
        /// As that of noise.
        seed: u32,
    },
    /// Rings about an axis, which noise bends: each rises slowly, and falls at once.
    Wood {
        /// As those of noise.
        stops: Vec<(f32, Rgb)>,
        /// Rings a unit, > 0; as many cells of the noise.
        scale: f64,
        /// About which the rings lie; any length but 0.
        axis: DVec3,
        /// How many rings the noise moves them at most, about; 0 or more.
        turbulence: f64,
        /// As that of noise.
        octaves: u32,
        /// As that of noise.
        lacunarity: f64,
        /// As that of noise.
        gain: f64,
        /// As that of noise.
        seed: u32,
    },
    /// Cells about points that are strewn, one into each cube of a lattice.
    Cells {
        /// As those of noise.
        stops: Vec<(f32, Rgb)>,
        /// Points a unit, > 0.
        scale: f64,
        /// What t is of a place.
        by: CellsBy,
        /// Which of many such textures.
        seed: u32,
    },
}

impl TextureKind {
    /// The most noises that are added up.
    pub const MOST_OCTAVES: u32 = 16;
}

impl TextureKind {
    /// An image of this name, repeated, in its own colours.
    pub(crate) fn image(name: &str, pixels: Arc<Texels>) -> Self {
        let mut kind = Self::of_word("image").unwrap_or_default();
        if let Self::Image { file, texels, .. } = &mut kind {
            (*file, *texels) = (name.to_owned(), pixels);
        }
        kind
    }
}

impl Default for TextureKind {
    /// Black and white cubes, one unit large.
    fn default() -> Self {
        Self::Checker { colors: [Rgb::WHITE, Rgb::BLACK], scale: 1.0 }
    }
}

/// What is beside an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, and then as it is again.
    Mirror,
    /// Its edge.
    Clamp,
    /// One colour.
    Border,
}

words!(Wrap { "repeat" = Repeat, "mirror" = Mirror, "clamp" = Clamp, "border" = Border });

/// What is between the pixels of an image, and what stands for many of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TexelFilter {
    /// Linear between pixels; where one sample of the picture covers many, their mean.
    #[default]
    Auto,
    /// The pixel there.
    Nearest,
    /// Linear between pixels, however many a sample covers.
    Linear,
}

words!(TexelFilter { "auto" = Auto, "nearest" = Nearest, "linear" = Linear });

/// What the numbers of an image mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// sRGB where it gives a colour and its numbers are bytes or of 16 bits, else linear.
    #[default]
    Auto,
    /// Codes of sRGB.
    Srgb,
    /// The values themselves.
    Linear,
}

words!(Encoding { "auto" = Auto, "srgb" = Srgb, "linear" = Linear });

/// What a gradient runs by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GradientBy {
    /// The distance along its axis.
    #[default]
    Axis,
    /// The distance from the place where the texture is.
    Radius,
}

words!(GradientBy { "axis" = Axis, "radius" = Radius });

/// Along which axes the cells of a grid are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GridAxes {
    /// Those of a floor, x and z; of texture coordinates, u and v.
    #[default]
    Auto,
    /// Along x alone, and so on.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// Along x and y.
    Xy,
    /// Along x and z.
    Xz,
    /// Along y and z.
    Yz,
    /// Along all three.
    Xyz,
}

words!(GridAxes {
    "auto" = Auto,
    "x" = X,
    "y" = Y,
    "z" = Z,
    "xy" = Xy,
    "xz" = Xz,
    "yz" = Yz,
    "xyz" = Xyz,
});

impl GridAxes {
    /// Whether cells are counted along x, y and z of a texture that lies in this space.
    #[must_use]
    pub fn of(self, space: TextureSpace) -> [bool; 3] {
        match self {
            Self::Auto if space == TextureSpace::Uv => [true, true, false],
            Self::Auto | Self::Xz => [true, false, true],
            Self::X => [true, false, false],
            Self::Y => [false, true, false],
            Self::Z => [false, false, true],
            Self::Xy => [true, true, false],
            Self::Yz => [false, true, true],
            Self::Xyz => [true; 3],
        }
    }
}

/// What t of a texture of cells is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CellsBy {
    /// The distance to the nearest point, in cubes of the lattice; 1 and more is 1.
    #[default]
    Distance,
    /// How much farther away the next one is: 0 where two cells meet.
    Border,
    /// A number of each cell's own.
    Cell,
}

words!(CellsBy { "distance" = Distance, "border" = Border, "cell" = Cell });

words!(TextureKind {
    "checker" = Checker { colors: [Rgb::WHITE, Rgb::BLACK], scale: 1.0 },
    "gradient" = Gradient {
        by: GradientBy::Axis,
        axis: DVec3::Y,
        from: 0.0,
        to: 1.0,
        stops: black_to_white(),
    },
    "image" = Image {
        file: String::new(),
        texels: Arc::new(Texels::white()),
        wrap: Wrap::Repeat,
        wrap_v: None,
        border: Rgb::BLACK,
        tint: Rgb::WHITE,
        filter: TexelFilter::Auto,
        encoding: Encoding::Auto,
    },
    "map" = Map {
        of: "height".to_owned(),
        axis: None,
        range: MapRange::Auto,
        stops: black_to_white(),
        nan: Rgb::grey(0.5),
        unit: None,
    },
    "grid" = Grid {
        colors: [Rgb::BLACK, Rgb::WHITE],
        scale: 1.0,
        width: 0.05,
        axes: GridAxes::Auto,
    },
    "stripes" = Stripes {
        colors: [Rgb::WHITE, Rgb::BLACK],
        scale: 1.0,
        by: GradientBy::Axis,
        axis: DVec3::X,
    },
    "noise" = Noise {
        stops: black_to_white(),
        scale: 1.0,
        octaves: 4,
        lacunarity: 2.0,
        gain: 0.5,
        seed: 0,
    },
    "marble" = Marble {
        stops: black_to_white(),
        scale: 1.0,
        axis: DVec3::X,
        turbulence: 1.0,
        octaves: 4,
        lacunarity: 2.0,
        gain: 0.5,
        seed: 0,
    },
    "wood" = Wood {
        stops: black_to_white(),
        scale: 1.0,
        axis: DVec3::Y,
        turbulence: 0.2,
        octaves: 2,
        lacunarity: 2.0,
        gain: 0.5,
        seed: 0,
    },
    "cells" = Cells { stops: black_to_white(), scale: 1.0, by: CellsBy::Distance, seed: 0 },
});

fn black_to_white() -> Vec<(f32, Rgb)> {
    vec![(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)]
}

impl Texture {
    /// The pixels, of an image.
    pub(crate) fn texels(&self) -> Option<&Texels> {
        match &self.kind {
            TextureKind::Image { texels, .. } => Some(texels),
            _ => None,
        }
    }

    /// The values between which all of its values lie, of this channel: for [`Channel::Alpha`] greys.
    pub fn values(&self, channel: Option<Channel>) -> Vec<Rgb> {
        match &self.kind {
            TextureKind::Image { texels, wrap, wrap_v, border, tint, encoding, .. } => {
                let value = |[r, g, b, alpha]: [f32; 4]| match channel {
                    Some(Channel::Alpha) => Rgb::grey(alpha),
                    _ => *tint * Rgb::new(r, g, b),
                };
                let mut values = texels.bounds(*encoding == Encoding::Srgb).map(value).to_vec();
                if *wrap == Wrap::Border || *wrap_v == Some(Wrap::Border) {
                    let beside = border.to_array();
                    values.push(value([beside[0], beside[1], beside[2], 0.0]));
                }
                values
            }
            _ if channel == Some(Channel::Alpha) => vec![Rgb::WHITE],
            TextureKind::Checker { colors, .. }
            | TextureKind::Grid { colors, .. }
            | TextureKind::Stripes { colors, .. } => colors.to_vec(),
            TextureKind::Map { stops, nan, .. } => {
                stops.iter().map(|&(_, color)| color).chain([*nan]).collect()
            }
            TextureKind::Gradient { stops, .. }
            | TextureKind::Noise { stops, .. }
            | TextureKind::Marble { stops, .. }
            | TextureKind::Wood { stops, .. }
            | TextureKind::Cells { stops, .. } => stops.iter().map(|&(_, color)| color).collect(),
        }
    }
}
