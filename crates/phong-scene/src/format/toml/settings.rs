//! `[image]`, `[camera]`, `[[clip]]` and `[[light]]`.

use super::notes::Notes;
use super::table::Values;
use crate::camera::{Camera, CameraKind};
use crate::check::settings as judge;
use crate::clip::{Cap, Clip};
use crate::fog::Fog;
use crate::light::{Light, LightKind};
use crate::scene::Image;
use crate::sky::Sky;

/// Below this many degrees a field of view is more likely one in radians, which end at π.
const RADIANS: f64 = 3.0;

/// `[image]`; what is wrong with it has been said.
pub(super) fn image(v: &Values) -> Option<Image> {
    let mut image = Image::default();
    v.fill(&mut image)?;
    Some(image)
}

/// `[camera]`; says if it looks nowhere.
pub(super) fn camera(v: &Values, notes: &mut Notes) -> Option<Camera> {
    let mut camera = Camera::default();
    v.fill(&mut camera)?;
    if let CameraKind::Perspective { fov } | CameraKind::Fisheye { fov } = camera.kind
        && fov < RADIANS
        && v.has("fov")
    {
        let message = format!("a `fov` of {fov} degrees is very narrow: are these radians?");
        let degrees = (10.0 * fov.to_degrees()).round() / 10.0;
        let help = format!("`fov` is in degrees; {fov} radians are {degrees} of them");
        notes.warning(v.spot_of("fov"), message).help = Some(help);
    }
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::camera(&camera, faults));
    sound.then_some(camera)
}

/// `[sky]`; what is wrong with it has been said.
pub(super) fn sky(v: &Values, notes: &mut Notes) -> Option<Sky> {
    let mut sky = Sky::default();
    v.fill(&mut sky)?;
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::sky(&sky, faults));
    sound.then_some(sky)
}

/// `[fog]`; what is wrong with it has been said.
pub(super) fn fog(v: &Values, notes: &mut Notes) -> Option<Fog> {
    let mut fog = Fog::default();
    v.fill(&mut fog)?;
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::fog(&fog, faults));
    sound.then_some(fog)
}

/// A clip, whose cap is of no other material yet; what is wrong with it has been said.
pub(super) fn clip(v: &Values, notes: &mut Notes) -> Option<Clip> {
    let mut clip = Clip { place: notes.place(v.spot), ..Clip::default() };
    v.fill(&mut clip)?;
    if v.flag("cap") == Some(false) {
        clip.cap = Cap::Open;
    }
    let names = v.texts("objects").unwrap_or_default();
    clip.objects = names.into_iter().map(|(name, _)| name).collect();
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::clip(&clip, faults));
    sound.then_some(clip)
}

/// The light that is the `number`th of the scene; what is wrong with it has been said.
pub(super) fn light(v: &Values, number: usize, notes: &mut Notes) -> Option<Light> {
    let (name, place) = (format!("light {number}"), notes.place(v.spot));
    let mut light = Light { name, place, ..Light::default() };
    v.fill(&mut light)?;
    if !v.has("specular_color") {
        light.specular_color = light.color;
    }
    if let LightKind::Spot { cone, edge, .. } = &mut light.kind
        && !v.has("edge")
    {
        *edge = *cone;
    }
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::light(&light, faults));
    sound.then_some(light)
}
