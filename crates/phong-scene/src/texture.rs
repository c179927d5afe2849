//! Textures: values that vary over a surface.
//!
//! ```toml
//! [textures.tiles]
//! kind = "checker"
//! colors = ["#e8e4da", 0.1]
//! scale = 2
//!
//! [textures.dusk]
//! kind = "gradient"
//! to = 3
//! stops = [[0, "darkorange"], [0.4, "indigo"], [1, 0]]
//!
//! [textures.map]
//! kind = "image"
//! file = "map.png"
//!
//! [materials.floor]
//! color = { texture = "tiles" }
//! k_s = { texture = "tiles", scale = 0.5 }
//! ```
//!
//! A material's colour or number that is a table takes its values from a texture. Where the text
//! says `space = "object"`, a texture is carved out of the object's own space and moves with it;
//! in `"world"` it stands still; in `"uv"` it lies on the surface, with u and v for x and y.
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `kind` | `checker`, `gradient`, `image`, `map`, `grid`, `stripes`, `noise`, `marble`, `wood` or `cells` | required | What it is. |
//! | `colors` (checker) | two colours, `[A, B]` | required | A where ⌊x⌋ + ⌊y⌋ + ⌊z⌋ is even, B where it is odd; a coordinate less than 1e-4 below a border counts as above it. |
//! | `scale` (checker) | a number above 0 | `1` | Squares a unit. |
//! | `colors` (grid) | two colours, `[A, B]` | black lines on white | That of the lines, and that of what is between them. |
//! | `colors` (stripes) | two colours, `[A, B]` | white and black | A where the stripes are counted even from 0, B where odd; what is less than 1e-4 of a stripe below a border counts as above it. |
//! | `scale` (grid, stripes, noise, marble, wood, cells) | a number above 0 | `1` | How many cells, stripes, veins, rings or points a unit there are. |
//! | `width` (grid) | a number above 0 | `0.05` | How wide the lines are, in units; their middles are where a coordinate is a whole number of cells. |
//! | `axes` (grid) | `auto`, `x`, `y`, `z`, `xy`, `xz`, `yz` or `xyz` | `"auto"` | Along which axes cells are counted; `auto`: x and z, as on a floor, and in `uv` both. |
//! | `by` (stripes) | `axis` or `radius` | `"axis"` | What stripes are counted by: the distance along `axis`, or that from the place where the texture is. |
//! | `by` (cells) | `distance`, `border` or `cell` | `"distance"` | What t is: the distance to the nearest point in cells, how much farther away the next one is (0 where two cells meet), or a number of each cell's own. |
//! | `axis` (stripes, marble) | three numbers, `[x, y, z]`, not all 0 | `[1, 0, 0]` | Across stripes and veins; any length. |
//! | `axis` (wood) | three numbers, `[x, y, z]`, not all 0 | `[0, 1, 0]` | About which the rings lie; any length. |
//! | `turbulence` (marble) | a number from 0 to 100 | `1` | How many veins they are moved by noise, about. |
//! | `turbulence` (wood) | a number from 0 to 100 | `0.2` | How many rings they are moved by noise, about. |
//! | `octaves` (noise, marble) | a whole number from 1 to 16 | `4` | How many noises are added up, each finer and weaker than the one before. |
//! | `octaves` (wood) | a whole number from 1 to 16 | `2` | How many noises are added up, each finer and weaker than the one before. |
//! | `lacunarity` (noise, marble, wood) | a number from 1 to 8 | `2` | How many times as fine each noise is as the one before. |
//! | `gain` (noise, marble, wood) | a number from 0 to 1 | `0.5` | How many times as strong. |
//! | `stops` (noise, marble, wood, cells) | a list of `[t, colour]`, t from 0 to 1 and never falling, or a colour map: `viridis`, `cividis`, `plasma`, `inferno`, `magma`, `turbo` or `coolwarm` | black to white | As a gradient's: the colours that t runs through from 0 to 1. |
//! | `of` (map) | text | required | Which number is shown: `height` (along `axis`), `radius` (from the place where the texture is), `x`, `y`, `z`, `depth` (in front of the camera), `normal` (the cosine to `axis`), or the name of a property that the vertices of a PLY file have. |
//! | `range` (map) | two numbers, `[low, high]`, or "auto" | `"auto"` | The numbers of the first colour and of the last; `auto`: the least and the largest of what the map is on. |
//! | `stops` (map) | a list of `[t, colour]`, t from 0 to 1 and never falling, or a colour map: `viridis`, `cividis`, `plasma`, `inferno`, `magma`, `turbo` or `coolwarm` | required | The colours, a colour map by name or a list as a gradient's; beyond the range they stay. |
//! | `nan` (map) | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `0.5` | The colour of what has no number. |
//! | `axis` (map) | three numbers, `[x, y, z]`, not all 0 | the camera's `up` | Along which heights are, and to which normals are held; any length. |
//! | `unit` (map) | text | none | The unit of the numbers, for legends. |
//! | `seed` (noise, marble, wood, cells) | a whole number from 0 to 4294967295 | `0` | Which of many textures that are alike. |
//! | `by` (gradient) | `axis` or `radius` | `"axis"` | What it runs by: the distance along `axis`, or that from the place where the texture is. |
//! | `axis` (gradient) | three numbers, `[x, y, z]`, not all 0 | `[0, 1, 0]` | Along which it runs; any length. |
//! | `from` (gradient) | a number | `0` | Where t is 0: a distance. |
//! | `to` (gradient) | a number | `1` | Where t is 1. |
//! | `stops` (gradient) | a list of `[t, colour]`, t from 0 to 1 and never falling, or a colour map: `viridis`, `cividis`, `plasma`, `inferno`, `magma`, `turbo` or `coolwarm` | required | Its colours; between two stops they run linearly, beyond the last they stay. A colour map has 33 of them. |
//! | `scale` (gradient, image, map) | a number or `[x, y, z]`, none 0 | 1 | First of its place: a factor, or one along each axis. |
//! | `file` (image) | the path of a file, in quotes | required | The image: PNG, JPEG, Radiance HDR or OpenEXR. Its left edge lies at 0 of the first coordinate and its right edge at 1, its lower edge at 0 of the second and its upper edge at 1. |
//! | `wrap` (image) | `repeat`, `mirror`, `clamp` or `border` | `"repeat"` | What is beside it: the image again, the image mirrored, its edge, or `border`. |
//! | `wrap_v` (image) | `repeat`, `mirror`, `clamp` or `border` | as `wrap` | What is above and below it. |
//! | `border` (image) | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `0` | The colour beside it with `wrap = "border"`; its opacity is 0. |
//! | `tint` (image) | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `1` | What its colours are multiplied by. |
//! | `filter` (image) | `auto`, `nearest` or `linear` | `"auto"` | `nearest`: the pixel there; `linear`: between pixels; `auto`: that, and the mean of all that a sample of the picture covers. |
//! | `encoding` (image) | `auto`, `srgb` or `linear` | `"auto"` | What its numbers mean; `auto`: colours of bytes and 16-bit numbers are sRGB, all else is linear. |
//! | `space` (checker, gradient, grid, stripes, noise, marble, wood, cells) | `object`, `world` or `uv` | `"object"` | The space it lies in. |
//! | `space` (image) | `object`, `world` or `uv` | `"uv"` | The space it lies in; `object` and `world`: along z. |
//! | `space` (map) | `object`, `world` or `uv` | `"world"` | The space that heights, radii and coordinates are in. |
//! | `rotate` | `[ax, ay, az, degrees]`, or a list of them | none | Turns it: right-handed about an axis; or a list of them, in order. |
//! | `translate` | three numbers, `[x, y, z]` | `[0, 0, 0]` | Then: shifts it. |
//! | `matrix` | four rows of four numbers | those above | Instead of all that place it: four rows of four, for column vectors. |
//!
//! Instead of a material's number or colour, where the table of materials says so:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `texture` | the name of a texture, in quotes | required | Where the values come from. |
//! | `scale` | a number | `1` | What they are multiplied by. |
//! | `offset` | a number | `0` | What is added then; what comes below 0 is 0. |
//! | `channel` | `r`, `g`, `b`, `a` or `luminance` | all three; of a number `r` | The channel that is taken; `luminance`: 0.2126 r + 0.7152 g + 0.0722 b, of a colour in linear light, of a number as the image holds them. |

mod kind;
mod map;

use std::fmt;

use glam::DAffine3;

pub use kind::{CellsBy, Encoding, GradientBy, GridAxes, TexelFilter, TextureKind, Wrap};
pub use map::{MapRange, MapSource};

use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::wording::words;

/// Index into [`Scene::textures`](crate::Scene::textures).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// A number or colour of a material: the same everywhere, or varying over the surface.
///
/// ```
/// use phong_scene::{Param, Rgb, TextureId, TextureRef};
/// let red: Param<Rgb> = Rgb::new(1.0, 0.0, 0.0).into();
/// assert_eq!(red.constant(), Some(Rgb::new(1.0, 0.0, 0.0)));
/// let tiles: Param<Rgb> = TextureRef::new(TextureId(0)).into();
/// assert_eq!(tiles.constant(), None);
/// assert_eq!(tiles.at(|_| Rgb::WHITE), Rgb::WHITE);
/// ```
#[derive(Clone, Copy, PartialEq)]
pub enum Param<T> {
    /// This value everywhere.
    Constant(T),
    /// The values of a texture.
    Textured(TextureRef),
}

/// Where a parameter's values come from, and what is done to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// The texture.
    pub texture: TextureId,
    /// What its values are multiplied by. Default 1.
    pub scale: f32,
    /// What is added then. Default 0.
    pub offset: f32,
    /// The channel that is taken; `None`: all three, and of a number red. Default `None`.
    pub channel: Option<Channel>,
}

/// A channel of a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// Opacity: 1 of textures that have none.
    Alpha,
    /// All three by the weights of Rec. 709: of a colour in linear light, of a number as an image holds them.
    Luminance,
}

/// What a parameter asks a texture for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureUse {
    /// The texture.
    pub texture: TextureId,
    /// The channel that is taken; for [`Channel::Alpha`] the answer is a grey that says the opacity.
    pub channel: Option<Channel>,
    /// Whether a colour is wanted, of which images hold sRGB codes; else a number, which they hold as it is.
    pub is_color: bool,
}

/// A value that a texture can give: a number or a colour.
pub trait Textured: Copy {
    /// Whether it is a colour.
    const IS_COLOR: bool;

    /// What the parameter is where the texture has this value. Nothing is ever below 0.
    fn of(value: Rgb, by: &TextureRef) -> Self;
}

/// A texture, every default filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name in the text.
    pub name: String,
    /// What it is.
    pub kind: TextureKind,
    /// The space that it lies in.
    pub space: TextureSpace,
    /// From where it is described to where it lies in that space; invertible and finite.
    pub transform: DAffine3,
    /// Where it was written.
    pub place: Place,
}

impl Default for Texture {
    /// Black and white cubes, one unit large.
    fn default() -> Self {
        Self {
            name: "texture".to_owned(),
            kind: TextureKind::default(),
            space: TextureSpace::default(),
            transform: DAffine3::IDENTITY,
            place: Place::default(),
        }
    }
}

/// The space that a texture lies in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureSpace {
    /// That of the object, before its transform; within an instance, before that of the instance.
    #[default]
    Object,
    /// That of the scene.
    World,
    /// That of the surface: u, v and 0.
    Uv,
}

impl<T: fmt::Debug> fmt::Debug for Param<T> {
    /// A constant shows as its value.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => value.fmt(f),
            Self::Textured(by) => by.fmt(f),
        }
    }
}

impl<T> From<T> for Param<T> {
    fn from(value: T) -> Self {
        Self::Constant(value)
    }
}

impl From<TextureRef> for Param<f32> {
    fn from(by: TextureRef) -> Self {
        Self::Textured(by)
    }
}

impl From<TextureRef> for Param<Rgb> {
    fn from(by: TextureRef) -> Self {
        Self::Textured(by)
    }
}

impl<T: Textured> Param<T> {
    /// The value that it has everywhere; `None` where it varies.
    pub fn constant(self) -> Option<T> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Textured(_) => None,
        }
    }

    /// What it takes its values from; `None` where they are all the same.
    pub fn texture(self) -> Option<TextureRef> {
        match self {
            Self::Constant(_) => None,
            Self::Textured(by) => Some(by),
        }
    }

    /// The value at a place where textures have the values that `look_up` says.
    #[inline]
    pub fn at(self, look_up: impl FnOnce(TextureUse) -> Rgb) -> T {
        match self {
            Self::Constant(value) => value,
            Self::Textured(by) => {
                let TextureRef { texture, channel, .. } = by;
                T::of(look_up(TextureUse { texture, channel, is_color: T::IS_COLOR }), &by)
            }
        }
    }
}

impl Param<Rgb> {
    /// Whether it is black everywhere; a texture is taken not to be.
    pub fn is_black(self) -> bool {
        self.constant().is_some_and(Rgb::is_black)
    }
}

impl TextureRef {
    /// A texture's values as they are.
    pub const fn new(texture: TextureId) -> Self {
        Self { texture, scale: 1.0, offset: 0.0, channel: None }
    }

    fn apply(&self, value: f32) -> f32 {
        (value * self.scale + self.offset).max(0.0)
    }
}

impl Textured for f32 {
    const IS_COLOR: bool = false;

    fn of(value: Rgb, by: &TextureRef) -> Self {
        by.apply(by.channel.unwrap_or(Channel::Red).of(value))
    }
}

impl Textured for Rgb {
    const IS_COLOR: bool = true;

    fn of(value: Rgb, by: &TextureRef) -> Self {
        by.channel.map_or(value, |channel| Self::grey(channel.of(value))).map(|v| by.apply(v))
    }
}

words!(Channel { "r" = Red, "g" = Green, "b" = Blue, "a" = Alpha, "luminance" = Luminance });

words!(TextureSpace { "object" = Object, "world" = World, "uv" = Uv });

impl Channel {
    /// What it is of a value.
    pub(crate) fn of(self, Rgb { r, g, b }: Rgb) -> f32 {
        match self {
            // Whoever is asked for an opacity gives it as a grey.
            Self::Red | Self::Alpha => r,
            Self::Green => g,
            Self::Blue => b,
            // The weights add up to 1: written so, a grey is itself to the bit.
            Self::Luminance => g + 0.2126 * (r - g) + 0.0722 * (b - g),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_scaled_then_shifted_and_never_below_0() {
        let by = TextureRef { scale: 2.0, offset: -0.5, ..TextureRef::new(TextureId(0)) };
        let value = Rgb::new(0.5, 0.125, 1.0);
        assert_eq!(Param::<Rgb>::from(by).at(|_| value), Rgb::new(0.5, 0.0, 1.5));
        assert_eq!(Param::<f32>::from(by).at(|_| value), 0.5);
        let blue = TextureRef { channel: Some(Channel::Blue), ..by };
        assert_eq!(Param::<Rgb>::from(blue).at(|_| value), Rgb::grey(1.5));
        assert_eq!(Param::<f32>::from(blue).at(|_| value), 1.5);
        let grey =
            TextureRef { channel: Some(Channel::Luminance), ..TextureRef::new(TextureId(0)) };
        let luminance = 0.125 + 0.2126 * 0.375 + 0.0722 * 0.875;
        assert_eq!(Param::<f32>::from(grey).at(|_| value), luminance);
        assert_eq!(Param::<Rgb>::from(grey).at(|_| value), Rgb::grey(luminance));
    }
}
