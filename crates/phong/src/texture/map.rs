//! Colours of numbers.

use glam::DVec3;
use phong_scene::{Camera, Field, MapRange, MapSource, Rgb};

use super::TexturePoint;
use super::ramp::Ramp;

/// A map of numbers that can be looked up.
#[derive(Clone, Debug)]
pub(super) struct Map {
    source: Source,
    /// The number of the first colour, and of the last.
    range: [f64; 2],
    ramp: Ramp,
    /// The colour of what has no number.
    nan: Rgb,
}

/// Where the numbers come from.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// How far along, from the place where the texture is.
    Along(DVec3),
    Radius,
    /// How far along, from the eye in the world.
    Depth {
        eye: DVec3,
        forward: DVec3,
    },
    /// The cosine to the normal.
    Normal(DVec3),
    /// The place of the property among those of a [`TexturePoint`]; `None`: there are too many.
    Property(Option<usize>),
}

/// What maps need to know beside themselves.
#[derive(Clone, Copy, Debug)]
pub struct MapContext<'a> {
    /// Where the picture is taken from.
    pub camera: &'a Camera,
    /// The names of the properties that a [`TexturePoint`] has, in their order there.
    pub properties: &'a [String],
}

impl Map {
    pub(super) fn new(
        (of, axis): (&str, Option<DVec3>),
        range: MapRange,
        (stops, nan): (&[(f32, Rgb)], Rgb),
        context: MapContext<'_>,
    ) -> Self {
        let MapContext { camera, properties } = context;
        let up = axis.unwrap_or(camera.up).normalize_or(DVec3::Y);
        let source = match MapSource::of(of) {
            MapSource::Height => Source::Along(up),
            MapSource::X => Source::Along(DVec3::X),
            MapSource::Y => Source::Along(DVec3::Y),
            MapSource::Z => Source::Along(DVec3::Z),
            MapSource::Radius => Source::Radius,
            MapSource::Depth => {
                let forward = (camera.look_at - camera.eye).normalize_or(DVec3::NEG_Z);
                Source::Depth { eye: camera.eye, forward }
            }
            MapSource::Normal => Source::Normal(up),
            MapSource::Property(name) => {
                Source::Property(properties.iter().position(|known| known == name))
            }
        };
        let range = match range {
            MapRange::Between(range) => range,
            // Whoever knows what it is on has found numbers.
            MapRange::Auto => [0.0, 1.0],
        };
        Self { source, range, ramp: Ramp::new(stops), nan }
    }

    /// The number at a point of a surface, which is `p` where the texture is described; NaN: there is none.
    pub(super) fn number(&self, at: &TexturePoint, p: DVec3) -> f64 {
        match self.source {
            Source::Along(axis) => axis.dot(p),
            Source::Radius => p.length(),
            Source::Depth { eye, forward } => forward.dot(at.world - eye),
            Source::Normal(axis) => axis.dot(DVec3::from(at.normal.map(f64::from))),
            Source::Property(place) => {
                place.and_then(|place| at.properties.get(place)).map_or(f64::NAN, |v| (*v).into())
            }
        }
    }

    pub(super) fn value(&self, at: &TexturePoint, p: DVec3) -> Rgb {
        let number = self.number(at, p);
        if !number.is_finite() {
            return self.nan;
        }
        let [low, high] = self.range;
        // Where all numbers are the same they are the middle.
        let t = if low == high { 0.5 } else { ((number - low) / (high - low)).clamp(0.0, 1.0) };
        self.ramp.at(t as f32)
    }

    /// Whether it shows normals.
    pub(super) fn has_normals(&self) -> bool {
        matches!(self.source, Source::Normal(_))
    }
}

/// The properties that textures show, each once, in the order of the textures.
pub(crate) fn properties_of(textures: &[phong_scene::Texture]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for texture in textures {
        if let phong_scene::TextureKind::Map { of, .. } = &texture.kind
            && let Some(name) = MapSource::of(of).property()
            && !names.iter().any(|known| known == name)
            && names.len() < Field::MOST
        {
            names.push(name.to_owned());
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(of: &str, range: [f64; 2]) -> Map {
        let stops = [(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)];
        let camera = phong_scene::Scene::default().camera;
        let context = MapContext { camera: &camera, properties: &["T".to_owned()] };
        Map::new((of, None), MapRange::Between(range), (&stops, Rgb::new(1.0, 0.0, 0.0)), context)
    }

    #[test]
    fn numbers_become_colours_between_the_ends_of_the_range() {
        let at = TexturePoint {
            normal: [0.0, 0.6, 0.8],
            properties: [30.0, f32::NAN, 0.0, 0.0],
            ..TexturePoint::default()
        };
        let p = DVec3::new(3.0, 4.0, 0.0);
        for (of, range, want) in [
            ("x", [2.0, 4.0], 0.5),
            ("height", [0.0, 16.0], 0.25),
            ("radius", [10.0, 0.0], 0.5),
            ("normal", [-1.0, 1.0], 0.8),
            ("T", [20.0, 40.0], 0.5),
            ("T", [40.0, 50.0], 0.0),
            ("T", [30.0, 30.0], 0.5),
        ] {
            let value = map(of, range).value(&at, p).g;
            assert!((value - want).abs() < 1e-6, "{of} in {range:?}: {value}");
        }
    }

    #[test]
    fn what_has_no_number_has_the_colour_of_that() {
        let at = TexturePoint { properties: [f32::NAN; 4], ..TexturePoint::default() };
        for of in ["T", "another"] {
            let value = map(of, [0.0, 1.0]).value(&at, DVec3::ZERO);
            assert_eq!(value, Rgb::new(1.0, 0.0, 0.0), "{of}");
        }
    }
}
