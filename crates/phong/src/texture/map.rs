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

/// The properties of points that are drawn, where these numbers of materials are used.
pub(crate) fn properties_of(
    materials: &[phong_scene::Material],
    textures: &[phong_scene::Texture],
    numbers: impl Iterator<Item = u32>,
) -> Vec<String> {
    // Most scenes have none, and need not look through the materials of their triangles.
    if phong_scene::properties_shown(materials, |_| true, textures).is_empty() {
        return Vec::new();
    }
    let mut used = vec![false; materials.len()];
    for number in numbers {
        if let Some(used) = used.get_mut(number as usize) {
            *used = true;
        }
    }
    let shown = phong_scene::properties_shown(materials, |i| used[i], textures);
    shown.into_iter().take(Field::MOST).map(|(name, _)| name.to_owned()).collect()
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
