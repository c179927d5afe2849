//! `[image]`, `[camera]`, `[[clip]]` and `[[light]]`.

use super::notes::Notes;
use super::table::Values;
use super::texture::Images;
use crate::camera::{Camera, CameraKind};
use crate::check::settings as judge;
use crate::clip::{Cap, Clip};
use crate::fog::Fog;
use crate::furniture::{Axes, Furniture, FurnitureStyle, Legend, PointLabel, ScaleBar, Title};
use crate::light::{Light, LightKind};
use crate::scene::Image;
use crate::sky::{Sky, SkyKind};
use crate::tone::Tone;

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
pub(super) fn sky(v: &Values, images: &mut Images<'_>, notes: &mut Notes) -> Option<Sky> {
    let mut sky = Sky::default();
    v.fill(&mut sky)?;
    if let SkyKind::Image { file, place, texels, .. } = &mut sky.kind {
        *place = notes.place(v.spot);
        *texels = images.load(file, v.spot_of("file"), notes)?;
    }
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

/// The tables of what a figure needs beside its picture, labels aside.
pub(super) const FURNITURE: [&str; 5] = ["furniture", "title", "scale_bar", "axes", "legend"];

/// One of them; what is wrong with it has been said.
pub(super) fn furniture(name: &str, v: &Values, to: &mut Furniture, notes: &mut Notes) {
    match name {
        "title" => {
            let mut title = Title::default();
            let filled = v.fill(&mut title).is_some();
            let sound = notes.judge(|key| v.spot_of(key), |faults| judge::title(&title, faults));
            to.title = (filled && sound).then_some(title);
        }
        "scale_bar" => {
            let mut bar = ScaleBar::default();
            let filled = v.fill(&mut bar).is_some();
            let sound = notes.judge(|key| v.spot_of(key), |faults| judge::scale_bar(&bar, faults));
            to.scale_bar = (filled && sound).then_some(bar);
        }
        "axes" => {
            let mut axes = Axes::default();
            to.axes = v.fill(&mut axes).map(|()| axes);
        }
        "legend" => {
            let mut legend = Legend::default();
            let filled = v.fill(&mut legend).is_some();
            let sound = notes.judge(|key| v.spot_of(key), |faults| judge::legend(&legend, faults));
            to.legend = (filled && sound).then_some(legend);
        }
        _ => {
            let mut style = FurnitureStyle::default();
            if v.fill(&mut style).is_some() {
                to.style = style;
            }
        }
    }
}

/// A label; what is wrong with it has been said.
pub(super) fn label(v: &Values, notes: &mut Notes) -> Option<PointLabel> {
    let mut label = PointLabel { place: notes.place(v.spot), ..PointLabel::default() };
    v.fill(&mut label)?;
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::label(&label, faults));
    sound.then_some(label)
}

/// `[tone]`; what is wrong with it has been said.
pub(super) fn tone(v: &Values, notes: &mut Notes) -> Option<Tone> {
    let mut tone = Tone::default();
    v.fill(&mut tone)?;
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::tone(&tone, faults));
    sound.then_some(tone)
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
