//! The picture's settings, the camera and the lights.

use glam::DVec3;

use super::fault::Faults;
use crate::camera::{Camera, CameraKind};
use crate::color::Rgb;
use crate::light::{Light, LightKind};
use crate::limits::{LARGEST, Range};
use crate::scene::{Background, Image};

/// Below this sine of the angle to the view, a millionth of a degree, "up" is decided by rounding.
const PARALLEL: f64 = 1e-8;

pub(super) fn image(image: &Image, faults: &mut Faults) {
    for side in image.size {
        if !(1..=Image::LARGEST).contains(&side) {
            let most = Image::LARGEST;
            faults.say("size", format!("`size` is from 1 to {most} pixels; this is {side}"));
        }
    }
    let most = Image::MOST_SAMPLES;
    if !(1..=most).contains(&image.samples) {
        let message = format!("`samples` is from 1 to {most}; this is {}", image.samples);
        faults.say("samples", message);
    }
    if image.depth > Image::DEEPEST {
        let message = format!("`depth` is from 0 to {}; this is {}", Image::DEEPEST, image.depth);
        faults.say("depth", message);
    }
    faults.number("min_weight", image.min_weight.into(), &Image::MIN_WEIGHT);
    match image.background {
        Background::Color(color) => {
            faults.color("background", color, LARGEST);
        }
        Background::Gradient { top, bottom } => {
            faults.color("top", top, LARGEST);
            faults.color("bottom", bottom, LARGEST);
        }
        Background::Transparent => {}
    }
}

pub(super) fn ambient(color: Rgb, faults: &mut Faults) {
    faults.color("color", color, LARGEST);
}

/// Judges a camera.
pub(crate) fn camera(camera: &Camera, faults: &mut Faults) {
    let Camera { kind, eye, look_at, up, aperture, focus } = *camera;
    let placed = faults.vector("eye", eye) & faults.vector("look_at", look_at);
    if faults.direction("up", up) && placed {
        view(eye, look_at, up, faults);
    }
    match kind {
        CameraKind::Perspective { fov } => {
            faults.number("fov", fov, &CameraKind::PERSPECTIVE);
        }
        CameraKind::Fisheye { fov } => {
            faults.number("fov", fov, &CameraKind::FISHEYE);
        }
        CameraKind::Orthographic { height } => {
            faults.number("height", height, &Range::POSITIVE);
        }
        CameraKind::Panorama => {}
    }
    faults.number("aperture", aperture, &Range::NOT_NEGATIVE);
    if let Some(focus) = focus {
        faults.number("focus", focus, &Range::POSITIVE);
    }
}

/// Whether the camera looks somewhere, with an up across the view.
fn view(eye: DVec3, look_at: DVec3, up: DVec3, faults: &mut Faults) {
    let Some(forward) = (look_at - eye).try_normalize() else {
        let help = "the camera looks from `eye` to `look_at`; they must differ";
        faults.say("look_at", "`look_at` is where the eye is").help = Some(help.to_owned());
        return;
    };
    let sideways = up.try_normalize().map_or(0.0, |up| forward.cross(up).length());
    if sideways < PARALLEL {
        let other = if forward.z.abs() > 0.9 { "0, 1, 0" } else { "0, 0, 1" };
        let help = format!("`up` must point elsewhere than the camera looks; try `up = [{other}]`");
        faults.say("up", "`up` is parallel to the view").help = Some(help);
    }
}

/// Judges a light.
pub(crate) fn light(light: &Light, faults: &mut Faults) {
    faults.color("color", light.color, LARGEST);
    faults.color("specular_color", light.specular_color, LARGEST);
    match light.kind {
        LightKind::Distant { direction, angle } => {
            faults.direction("direction", direction);
            faults.number("angle", angle, &LightKind::ANGLE);
        }
        LightKind::Point { position, attenuation, radius } => {
            faults.vector("position", position);
            falloff(attenuation, radius, faults);
        }
        LightKind::Spot { position, target, cone, edge, attenuation, radius } => {
            let placed = faults.vector("position", position) & faults.vector("target", target);
            if placed && (target - position).try_normalize().is_none() {
                let help = "the light shines from `position` to `target`; they must differ";
                faults.say("target", "`target` is where the light is").help = Some(help.to_owned());
            }
            if faults.number("cone", cone, &LightKind::CONE) {
                angles(cone, edge, faults);
            }
            falloff(attenuation, radius, faults);
        }
    }
}

fn angles(cone: f64, edge: f64, faults: &mut Faults) {
    if edge < cone {
        let message = format!("`edge` is below `cone`, which is {cone}");
        let help = "full light within `cone`, none beyond `edge`";
        faults.say("edge", message).help = Some(help.to_owned());
    } else if edge == 0.0 {
        faults.say("cone", "a cone of 0 without an `edge` holds no light");
    } else {
        faults.number("edge", edge, &LightKind::EDGE);
    }
}

fn falloff(attenuation: [f64; 3], radius: f64, faults: &mut Faults) {
    let factors = DVec3::from(attenuation);
    if faults.vector("attenuation", factors) {
        if factors.min_element() < 0.0 {
            let message = "`attenuation` is negative; `[c, l, q]` are 0 or above";
            faults.say("attenuation", message);
        } else if factors == DVec3::ZERO {
            faults.say("attenuation", "`attenuation` is [0, 0, 0], a division by 0");
        }
    }
    faults.number("radius", radius, &Range::NOT_NEGATIVE);
}
