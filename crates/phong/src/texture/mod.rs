//! Textures, ready to be looked up at points of surfaces: one kind a file.

mod bands;
mod cells;
mod checker;
mod cone;
mod gradient;
mod image;
mod lattice;
mod map;
mod noise;
mod ramp;
mod spread;
mod veins;
mod wrap;

use fearless_simd::Simd;
use glam::{DAffine3, DVec2, DVec3};
use phong_scene::{Channel, Field, GradientBy, Rgb, TextureKind, TextureSpace, TextureUse};

use crate::math::lanes::Lanes3;
pub use cone::Cone;
pub(crate) use cone::footprint;
pub use image::ImageLookUp;
pub use map::MapContext;
pub(crate) use map::properties_of;

use bands::{Grid, Stripes};
use cells::Cells;
use checker::Checker;
use gradient::Gradient;
use image::ImageTexture;
use map::Map;
use noise::{Noise, Octaves};
use ramp::Ramp;
use veins::Veins;

/// The most look-ups side by side along the longer side of a footprint: what is still longer is blurred.
const MOST_TAPS: f64 = 8.0;

/// A texture that can be looked up.
#[derive(Clone, Debug)]
pub struct Texture {
    space: TextureSpace,
    /// From the space it lies in to where it is described.
    from_space: DAffine3,
    /// Whether these are the same.
    is_in_place: bool,
    pattern: Pattern,
}

#[derive(Clone, Debug)]
enum Pattern {
    Checker(Checker),
    Gradient(Gradient),
    Image(Box<ImageTexture>),
    Map(Box<Map>),
    Grid(Grid),
    Stripes(Stripes),
    /// With its cells, waves or points a unit.
    Fading(f64, Box<Fading>),
}

/// What becomes its mean where a sample of the picture is wide.
#[derive(Clone, Debug)]
enum Fading {
    Noise(Noise),
    Veins(Veins),
    Cells(Cells),
}

/// A point of a surface, as textures see it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TexturePoint {
    /// In the object's own space, before its transform.
    pub object: DVec3,
    /// In the world.
    pub world: DVec3,
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// Unit tangent of the surface, along which u grows; 0 where nothing asked for it.
    pub tangent: [f32; 3],
    /// Unit shading normal, outwards; 0 where no map shows normals.
    pub normal: [f32; 3],
    /// What points of the surface have besides their place, in the order that the view has them; NaN: none.
    pub properties: [f32; Field::MOST],
    /// The sides of the piece of surface that one look-up stands for; all 0: a point.
    pub footprint: Footprint,
}

/// The sides of a parallelogram about a point of a surface, in each of the spaces that textures lie in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// In the object's own space.
    pub object: [DVec3; 2],
    /// In the world.
    pub world: [DVec3; 2],
    /// How the texture coordinates change along them.
    pub uv: [DVec2; 2],
}

impl Texture {
    /// The texture as it was written.
    pub fn new(texture: &phong_scene::Texture, context: MapContext<'_>) -> Self {
        let from_space = texture.transform.inverse();
        Self {
            space: texture.space,
            from_space,
            is_in_place: from_space == DAffine3::IDENTITY,
            pattern: Pattern::new(texture, context),
        }
    }

    /// The space that it lies in.
    pub(crate) fn space(&self) -> TextureSpace {
        self.space
    }

    /// Its value at a point of a surface. Linear.
    pub fn value(&self, at: &TexturePoint, asked: TextureUse) -> Rgb {
        if let (Pattern::Image(image), true) = (&self.pattern, self.is_image_on_uv()) {
            let uv = DVec2::new(at.uv[0].into(), at.uv[1].into());
            return of_image(image.value(uv, at.footprint.uv, asked.is_color), asked);
        }
        let p = self.from_space.transform_point3(self.place(at));
        let value = match &self.pattern {
            Pattern::Checker(checker) => checker.value(p),
            Pattern::Gradient(gradient) => gradient.value(p),
            Pattern::Image(image) => {
                let sides = self.sides(at).map(DVec3::truncate);
                return of_image(image.value(p.truncate(), sides, asked.is_color), asked);
            }
            Pattern::Map(map) => map.value(at, p),
            Pattern::Grid(grid) => grid.value(p, self.sides(at)),
            Pattern::Stripes(stripes) => stripes.value(p, self.sides(at)),
            Pattern::Fading(scale, pattern) => {
                pattern.mean(p * *scale, self.sides(at).map(|side| side * *scale))
            }
        };
        if asked.channel == Some(Channel::Alpha) { Rgb::WHITE } else { value }
    }

    /// Whether it is an image that lies just as texture coordinates say.
    pub(crate) fn is_image_on_uv(&self) -> bool {
        let is_image = matches!(self.pattern, Pattern::Image(_));
        is_image && self.is_in_place && self.space == TextureSpace::Uv
    }

    /// [`Texture::value`] of such an image at some of eight texture coordinates, a bit each in `lanes`, in footprints
    /// of these sides: red, green and blue of each. Unspecified in other lanes.
    #[inline(always)]
    pub(crate) fn image_values<S: Simd>(
        &self,
        simd: S,
        lanes: u32,
        uv: &[[f64; 8]; 2],
        sides: &[[[f64; 8]; 2]; 2],
        asked: TextureUse,
    ) -> Lanes3 {
        let Pattern::Image(image) = &self.pattern else { return Lanes3::default() };
        let [r, g, b, opacity] = image.values(simd, lanes, uv, sides, asked.is_color);
        if asked.channel == Some(Channel::Alpha) { [opacity; 3] } else { [r, g, b] }
    }

    /// How its image is looked up at a point of a surface; `None`: it is none.
    pub fn image_look_up(&self, at: &TexturePoint) -> Option<ImageLookUp> {
        match &self.pattern {
            Pattern::Image(image) => Some(image.look_up(self.sides(at).map(DVec3::truncate))),
            _ => None,
        }
    }

    /// Whether its values depend on how much of a surface a look-up stands for.
    pub(crate) fn has_footprint(&self) -> bool {
        !matches!(self.pattern, Pattern::Checker(_) | Pattern::Gradient(_) | Pattern::Map(_))
    }

    /// The number that its colour stands for at a point of a surface, NaN where there is none; `None`: it is no
    /// map.
    pub fn number(&self, at: &TexturePoint) -> Option<f64> {
        match &self.pattern {
            Pattern::Map(map) => {
                Some(map.number(at, self.from_space.transform_point3(self.place(at))))
            }
            _ => None,
        }
    }

    /// Whether its values depend on the normal.
    pub(crate) fn has_normals(&self) -> bool {
        matches!(&self.pattern, Pattern::Map(map) if map.has_normals())
    }

    /// The sides of the footprint where the texture is described.
    fn sides(&self, at: &TexturePoint) -> [DVec3; 2] {
        let sides = match self.space {
            TextureSpace::Object => at.footprint.object,
            TextureSpace::World => at.footprint.world,
            TextureSpace::Uv => at.footprint.uv.map(|side| side.extend(0.0)),
        };
        sides.map(|side| self.from_space.transform_vector3(side))
    }

    /// The coordinates of a point in the space that it lies in: of texture coordinates u, v and 0.
    pub fn place(&self, at: &TexturePoint) -> DVec3 {
        match self.space {
            TextureSpace::Object => at.object,
            TextureSpace::World => at.world,
            TextureSpace::Uv => DVec3::new(at.uv[0].into(), at.uv[1].into(), 0.0),
        }
    }
}

/// What is asked of a value of an image.
#[inline]
fn of_image([r, g, b, opacity]: [f32; 4], asked: TextureUse) -> Rgb {
    if asked.channel == Some(Channel::Alpha) { Rgb::grey(opacity) } else { Rgb::new(r, g, b) }
}

impl Pattern {
    fn new(texture: &phong_scene::Texture, context: MapContext<'_>) -> Self {
        let fading = |scale: f64, pattern: Fading| Self::Fading(scale, Box::new(pattern));
        match &texture.kind {
            TextureKind::Checker { colors, scale } => {
                Self::Checker(Checker { colors: *colors, scale: *scale })
            }
            TextureKind::Gradient { by, axis, from, to, stops } => {
                Self::Gradient(Gradient::new((*by, *axis), *from, *to, stops))
            }
            TextureKind::Image { texels, wrap, wrap_v, border, tint, filter, encoding, .. } => {
                let beside = ([*wrap, wrap_v.unwrap_or(*wrap)], *border);
                let image = ImageTexture::new(texels, beside, *tint, (*filter, *encoding));
                Self::Image(Box::new(image))
            }
            TextureKind::Map { of, axis, range, stops, nan, unit: _ } => {
                let map = Map::new((of, *axis), *range, (stops, *nan), context);
                Self::Map(Box::new(map))
            }
            TextureKind::Grid { colors, scale, width, axes } => Self::Grid(Grid {
                colors: *colors,
                scale: *scale,
                share: (width * scale).min(1.0),
                axes: axes.of(texture.space),
            }),
            TextureKind::Stripes { colors, scale, by, axis } => Self::Stripes(Stripes {
                colors: *colors,
                scale: *scale,
                axis: (*by == GradientBy::Axis).then(|| axis.normalize_or(DVec3::X)),
            }),
            TextureKind::Noise { stops, scale, octaves, lacunarity, gain, seed } => {
                let octaves = Octaves::new(*octaves, *lacunarity, *gain, *seed);
                fading(*scale, Fading::Noise(Noise { ramp: Ramp::new(stops), octaves }))
            }
            kind @ (TextureKind::Marble {
                stops,
                scale,
                axis,
                turbulence,
                octaves,
                lacunarity,
                gain,
                seed,
            }
            | TextureKind::Wood {
                stops,
                scale,
                axis,
                turbulence,
                octaves,
                lacunarity,
                gain,
                seed,
            }) => {
                let has_rings = matches!(kind, TextureKind::Wood { .. });
                let octaves = Octaves::new(*octaves, *lacunarity, *gain, *seed);
                let ramp = Ramp::new(stops);
                let veins = Veins::new(has_rings, *axis, *turbulence, octaves, ramp);
                fading(*scale, Fading::Veins(veins))
            }
            TextureKind::Cells { stops, scale, by, seed } => {
                fading(*scale, Fading::Cells(Cells::new(Ramp::new(stops), *by, *seed)))
            }
        }
    }
}

impl Fading {
    /// The mean over a parallelogram about `p` with these sides: of places along the longer one, each as wide
    /// as the shorter.
    fn mean(&self, p: DVec3, sides: [DVec3; 2]) -> Rgb {
        let [a, b] = sides.map(DVec3::length);
        let (along, long, short) = if a > b { (sides[0], a, b) } else { (sides[1], b, a) };
        let width = short.max(long / MOST_TAPS);
        // What is narrow is seen as it is, and of what is wide nothing is left to be seen apart.
        if !(0.25..1e6).contains(&long) || width >= 1.0 {
            return self.at(p, long);
        }
        let taps = (long / width).ceil().clamp(1.0, MOST_TAPS) as u32;
        let place = |tap: u32| p + along * ((f64::from(tap) + 0.5) / f64::from(taps) - 0.5);
        let sum = (0..taps).map(|tap| self.at(place(tap), width)).sum::<Rgb>();
        sum / taps as f32
    }

    fn at(&self, p: DVec3, width: f64) -> Rgb {
        match self {
            Self::Noise(noise) => noise.value(p, width),
            Self::Veins(veins) => veins.value(p, width),
            Self::Cells(cells) => cells.value(p, width),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use phong_scene::TextureId;

    use super::*;

    const USE: TextureUse = TextureUse { texture: TextureId(0), channel: None, is_color: true };

    #[test]
    fn a_texture_lies_where_it_was_moved_to_in_the_space_it_says() {
        let [a, b] = [Rgb::WHITE, Rgb::BLACK];
        let at = TexturePoint {
            object: DVec3::new(0.5, 0.5, 0.5),
            world: DVec3::new(1.5, 0.5, 0.5),
            uv: [0.5, 1.5],
            ..TexturePoint::default()
        };
        let camera = phong_scene::Scene::default().camera;
        let context = MapContext { camera: &camera, properties: &[] };
        for (space, want) in
            [(TextureSpace::Object, a), (TextureSpace::World, b), (TextureSpace::Uv, b)]
        {
            let written = phong_scene::Texture { space, ..phong_scene::Texture::default() };
            assert_eq!(Texture::new(&written, context).value(&at, USE), want, "{space:?}");
            let moved = phong_scene::Texture {
                transform: DAffine3::from_translation(DVec3::new(1.0, 0.0, 0.0)),
                ..written
            };
            assert_ne!(
                Texture::new(&moved, context).value(&at, USE),
                want,
                "{space:?}, a square further"
            );
        }
    }
}
