//! What textures are: the kinds, and the words of each.

use std::sync::Arc;

use glam::DVec3;

use super::{Channel, Texture};
use crate::color::Rgb;
use crate::texels::Texels;
use crate::wording::words;

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
        /// The colour beside it, where [`Wrap::Border`] says so. Linear; its opacity is 0.
        border: Rgb,
        /// What its colours are multiplied by. Linear.
        tint: Rgb,
        /// What is between its pixels, and what stands for many of them.
        filter: TexelFilter,
        /// What its numbers mean.
        encoding: Encoding,
    },
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

words!(TextureKind {
    "checker" = Checker { colors: [Rgb::WHITE, Rgb::BLACK], scale: 1.0 },
    "gradient" = Gradient {
        by: GradientBy::Axis,
        axis: DVec3::Y,
        from: 0.0,
        to: 1.0,
        stops: vec![(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)],
    },
    "image" = Image {
        file: String::new(),
        texels: Arc::new(Texels::white()),
        wrap: Wrap::Repeat,
        border: Rgb::BLACK,
        tint: Rgb::WHITE,
        filter: TexelFilter::Auto,
        encoding: Encoding::Auto,
    },
});

impl Texture {
    /// The values between which all of its values lie, of this channel: for [`Channel::Alpha`] greys.
    pub fn values(&self, channel: Option<Channel>) -> Vec<Rgb> {
        match &self.kind {
            TextureKind::Image { texels, wrap, border, tint, encoding, .. } => {
                let value = |[r, g, b, alpha]: [f32; 4]| match channel {
                    Some(Channel::Alpha) => Rgb::grey(alpha),
                    _ => *tint * Rgb::new(r, g, b),
                };
                let mut values = texels.bounds(*encoding == Encoding::Srgb).map(value).to_vec();
                if *wrap == Wrap::Border {
                    let beside = border.to_array();
                    values.push(value([beside[0], beside[1], beside[2], 0.0]));
                }
                values
            }
            _ if channel == Some(Channel::Alpha) => vec![Rgb::WHITE],
            TextureKind::Checker { colors, .. } => colors.to_vec(),
            TextureKind::Gradient { stops, .. } => stops.iter().map(|&(_, color)| color).collect(),
        }
    }
}
