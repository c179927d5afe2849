//! Handles: points of the scene that are taken hold of in the picture, and where one is dragged to.

use phong::camera::Camera;
use phong::glam::{DMat2, DMat3, DVec2, DVec3};
use phong::scene::{LightKind, Object, Scene, Shape};
use serde_json::{Map, Value, json};

use super::writing::count;
use crate::protocol::Handle;

/// The most objects that have a handle; of a scene with more none has one.
const MOST_OBJECTS: usize = 64;

/// Handles of distant lights stand so far from the point looked at, in distances of the eye from it.
const FAR: f64 = 0.5;

/// A point that can be dragged.
#[derive(Clone, Debug)]
pub(super) struct Spot {
    /// The first of its keys.
    pub(super) path: String,
    pub(super) name: String,
    kind: &'static str,
    /// Where it is in the world.
    at: DVec3,
    /// The keys that follow it, and what they are now.
    keys: Vec<(String, DVec3)>,
    /// From a way in the world to that of the keys.
    own: DMat3,
}

/// Everything that can be dragged; `middles` are those of the objects. Of a scene that includes
/// others, objects and lights have no handles: a key of theirs may stand in another file.
pub(super) fn spots(scene: &Scene, text: Option<&str>, middles: &[DVec3]) -> Vec<Spot> {
    let mut all = Vec::new();
    let camera = &scene.camera;
    let look_at = Spot::new("camera", "camera.look_at".to_owned(), "look_at", camera.look_at);
    all.push(look_at);
    let Some(text) = text.filter(|text| count(text, "include") == 0) else { return all };
    let away = FAR * (camera.eye - camera.look_at).length();
    let written = count(text, "light") == scene.lights.len();
    for (i, light) in scene.lights.iter().enumerate().filter(|_| written) {
        let key = |key: &str| format!("light.{}.{key}", i + 1);
        match light.kind {
            LightKind::Point { position, .. }
            | LightKind::Rectangle { position, .. }
            | LightKind::Disc { position, .. }
            | LightKind::Sphere { position, .. } => {
                all.push(Spot::new("light", key("position"), &light.name, position));
            }
            LightKind::Spot { position, target, .. } => {
                all.push(Spot::new("light", key("position"), &light.name, position));
                let name = format!("{}: target", light.name);
                all.push(Spot::new("target", key("target"), &name, target));
            }
            // Its object has a handle.
            LightKind::Mesh { .. } => {}
            LightKind::Distant { direction, .. } => {
                let way = direction.normalize_or(DVec3::NEG_Y) * away;
                all.push(Spot {
                    path: key("direction"),
                    name: light.name.clone(),
                    kind: "light",
                    at: camera.look_at - way,
                    keys: vec![(key("direction"), way)],
                    own: -DMat3::IDENTITY,
                });
            }
        }
    }
    if scene.objects.len() <= MOST_OBJECTS {
        let mut numbers: Vec<(&str, usize)> = Vec::new();
        for (object, &middle) in scene.objects.iter().zip(middles) {
            let kind = object.shape.kind();
            let number = 1 + numbers.iter().find(|(other, _)| *other == kind).map_or(0, |n| n.1);
            numbers.retain(|(other, _)| *other != kind);
            numbers.push((kind, number));
            all.extend(Spot::of_object(object, kind, number, middle));
        }
        // Files may bring objects as well; then the numbers are not those of the text.
        let all_written = |kind: &str| {
            let objects = numbers.iter().find(|(other, _)| *other == kind);
            objects.is_none_or(|&(_, number)| number == count(text, kind))
        };
        let kind = |spot: &Spot| spot.path.split('.').next().unwrap_or_default().to_owned();
        all.retain(|spot| spot.kind != "object" || all_written(&kind(spot)));
    }
    all
}

/// The middles of objects, those of meshes and clouds in the middle of their boxes.
pub(super) fn middles(scene: &Scene) -> Vec<DVec3> {
    if scene.objects.len() > MOST_OBJECTS {
        return Vec::new();
    }
    let middle = |object: &Object| match object.shape {
        Shape::Sphere { center, .. } | Shape::Disc { center, .. } | Shape::Torus { center, .. } => {
            object.transform.transform_point3(center)
        }
        Shape::Plane { point, .. } => object.transform.transform_point3(point),
        _ => {
            let (objects, groups) = (vec![object.clone()], scene.groups.clone());
            Scene { objects, groups, ..Scene::default() }.bounds().center()
        }
    };
    scene.objects.iter().map(middle).collect()
}

impl Spot {
    /// A point that one key says.
    fn new(kind: &'static str, path: String, name: &str, at: DVec3) -> Self {
        let keys = vec![(path.clone(), at)];
        Self { path, name: name.to_owned(), kind, at, keys, own: DMat3::IDENTITY }
    }

    fn of_object(object: &Object, kind: &str, number: usize, middle: DVec3) -> Option<Self> {
        let key = |key: &str| format!("{kind}.{number}.{key}");
        let (keys, own) = match object.shape {
            Shape::Sphere { center, .. }
            | Shape::Disc { center, .. }
            | Shape::Torus { center, .. } => {
                (vec![(key("center"), center)], object.transform.matrix3.inverse())
            }
            Shape::Box { min, max } => {
                (vec![(key("min"), min), (key("max"), max)], object.transform.matrix3.inverse())
            }
            Shape::Cylinder { from, to, .. } | Shape::Cone { from, to, .. } => {
                (vec![(key("from"), from), (key("to"), to)], object.transform.matrix3.inverse())
            }
            Shape::Plane { .. } => return None,
            // The shift comes last, so it is a way in the world.
            _ => (vec![(key("translate"), object.transform.translation)], DMat3::IDENTITY),
        };
        let path = keys.first()?.0.clone();
        let is_sound = own.is_finite() && middle.is_finite();
        is_sound.then(|| Self {
            path,
            name: object.name.clone(),
            kind: "object",
            at: middle,
            keys,
            own,
        })
    }

    /// As the page is told of it; `None`: it is not seen in this picture.
    pub(super) fn seen(&self, camera: &Camera, size: [u32; 2]) -> Option<Handle> {
        let at = camera.place(self.at, size)?.to_array();
        let (path, name) = (self.path.clone(), self.name.clone());
        let inside = at.iter().zip(size).all(|(&x, side)| (0.0..=f64::from(side)).contains(&x));
        inside.then_some(Handle { path, kind: self.kind, name, at })
    }
}

/// A handle that somebody holds.
#[derive(Clone, Debug)]
pub(super) struct Grab {
    spot: Spot,
    /// Where it was taken hold of, pixels.
    from: [f64; 2],
    camera: Camera,
    size: [u32; 2],
}

impl Grab {
    pub(super) fn new(spot: Spot, from: [f64; 2], camera: Camera, size: [u32; 2]) -> Self {
        Self { spot, from, camera, size }
    }

    /// Whether this is the handle of that key, taken hold of there.
    pub(super) fn is(&self, path: &str, from: [f64; 2]) -> bool {
        self.spot.path == path && self.from == from
    }

    /// The keys that follow it.
    pub(super) fn keys(&self) -> Vec<String> {
        self.spot.keys.iter().map(|(path, _)| path.clone()).collect()
    }

    /// What its keys are when it is dragged to a place in the picture: in the plane through it that
    /// faces the camera.
    pub(super) fn dragged(&self, to: [f64; 2]) -> Result<Map<String, Value>, String> {
        let unseen = || "this handle is not seen in the picture".to_owned();
        let at = self.spot.at;
        let [up, back] =
            [self.camera.up(), self.camera.backward().to_vec()].map(phong::glam::Vec3::as_dvec3);
        let right = up.cross(back).normalize_or(DVec3::X);
        let place = |point: DVec3| self.camera.place(point, self.size).ok_or_else(unseen);
        let step = 1e-3 * (1e-6 + (at - self.camera_eye()).length());
        let here = place(at)?;
        let [x, y] = [place(at + step * right)? - here, place(at + step * up)? - here];
        let pixels = DMat2::from_cols(x, y);
        let way = DVec2::from_array(to) - DVec2::from_array(self.from);
        let steps = pixels.inverse() * way;
        if pixels.determinant() == 0.0 || !steps.is_finite() {
            return Err(unseen());
        }
        let way = step * (steps.x * right + steps.y * up);
        // Numbers are as fine as a tenth of a pixel, and no finer.
        let own = self.spot.own * way;
        let fine = 0.1 * step / x.length() * self.spot.own.col(0).length();
        let keys = self.spot.keys.iter().map(|(path, value)| {
            let moved = DVec3::from_array([0, 1, 2].map(|i| {
                if own[i].abs() < 0.1 * fine { value[i] } else { rounded(value[i] + own[i], fine) }
            }));
            (path.clone(), json!(moved.to_array()))
        });
        Ok(keys.collect())
    }

    fn camera_eye(&self) -> DVec3 {
        let middle = DVec2::new(f64::from(self.size[0]), f64::from(self.size[1])) / 2.0;
        self.camera.ray(middle, self.size, [0.5; 2]).map_or(self.spot.at, |ray| ray.origin)
    }
}

/// A number with no more digits behind the point than this fineness asks for.
fn rounded(value: f64, fine: f64) -> f64 {
    let (mut digits, mut step) = (0, 1.0);
    while step > fine && digits < 12 {
        (digits, step) = (digits + 1, step / 10.0);
    }
    let value: f64 = format!("{value:.digits$}").parse().unwrap_or(value);
    value + 0.0 // never −0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_rounded_to_what_can_be_seen() {
        assert_eq!(rounded(1.234_567, 0.01), 1.23);
        assert_eq!(rounded(-0.001, 0.01).to_string(), "0");
        assert_eq!(rounded(1234.567, 5.0), 1235.0);
        assert!(rounded(f64::NAN, 0.1).is_nan());
    }
}
