//! The picture's settings, the camera and the lights.

use glam::DVec3;

use super::fault::Faults;
use super::value::values;
use crate::ambient_occlusion::AmbientOcclusion;
use crate::camera::Camera;
use crate::clip::{Clip, ClipKind};
use crate::color::Rgb;
use crate::fog::{Fog, FogKind};
use crate::furniture::{Axes, Furniture, FurnitureStyle, Legend, PointLabel, ScaleBar, Title};
use crate::light::{Light, LightKind};
use crate::limits::LARGEST;
use crate::outline::Outline;
use crate::scene::Image;
use crate::sky::{Sky, SkyKind};
use crate::texture::{Texture, TextureKind};
use crate::tone::Tone;
use crate::wording::{closest, quoted};

/// Below this sine of the angle to the view, a millionth of a degree, "up" is decided by rounding.
const PARALLEL: f64 = 1e-8;

pub(super) fn image(image: &Image, faults: &mut Faults) {
    values(image, None, faults);
}

pub(super) fn ambient(color: Rgb, faults: &mut Faults) {
    faults.color("color", color, LARGEST);
}

pub(super) fn occlusion(occlusion: &AmbientOcclusion, faults: &mut Faults) {
    values(occlusion, None, faults);
}

pub(super) fn outline(outline: &Outline, faults: &mut Faults) {
    values(outline, None, faults);
}

pub(super) fn furniture_style(style: &FurnitureStyle, faults: &mut Faults) {
    values(style, None, faults);
}

/// Judges a title.
pub(crate) fn title(title: &Title, faults: &mut Faults) {
    values(title, None, faults);
    text("text", &title.text, faults);
}

/// Judges a scale bar.
pub(crate) fn scale_bar(bar: &ScaleBar, faults: &mut Faults) {
    values(bar, None, faults);
    text("unit", &bar.unit, faults);
}

pub(super) fn axes(axes: &Axes, faults: &mut Faults) {
    values(axes, None, faults);
}

/// Judges a legend by itself.
pub(crate) fn legend(legend: &Legend, faults: &mut Faults) {
    values(legend, None, faults);
    text("text", &legend.text, faults);
    text("unit", &legend.unit, faults);
    if let (Some(from), Some(to)) = (legend.from, legend.to)
        && from == to
        && faults.spare(&["from", "to"])
    {
        faults.say("to", format!("`to` must be another number than `from`, which is {from}"));
    }
}

/// Judges what a legend takes from a texture of the scene's.
pub(crate) fn legend_texture(legend: &Legend, textures: &[Texture], faults: &mut Faults) {
    let has_range = |texture: &Texture| {
        matches!(texture.kind, TextureKind::Gradient { .. } | TextureKind::Map { .. })
    };
    if legend.texture.is_empty() {
        if legend.map.is_none() && !textures.iter().any(has_range) {
            let message =
                "a legend needs colours, and no texture has some from one number to another";
            let help = "give it a `map`, like \"viridis\", with `from` and `to`";
            faults.say("map", message).help = Some(help.to_owned());
        }
        return;
    }
    let name = quoted(&legend.texture);
    let Some(texture) = textures.iter().find(|texture| texture.name == legend.texture) else {
        let near = closest(&legend.texture, textures.iter().map(|texture| &*texture.name));
        let fault = faults.say("texture", format!("there is no texture {name}"));
        fault.help = near.map(|near| format!("did you mean {near:?}?"));
        return;
    };
    if !has_range(texture) && legend.map.is_none() {
        let message = format!("the texture {name} has no colours from one number to another");
        faults.say("texture", message).help =
            Some("a legend shows those of a `gradient` or a `map`".to_owned());
    }
}

/// Judges a label.
pub(crate) fn label(label: &PointLabel, faults: &mut Faults) {
    values(label, None, faults);
    text("text", &label.text, faults);
}

/// Judges how long a text is.
fn text(name: &'static str, text: &str, faults: &mut Faults) {
    let (most, count) = (Furniture::LONGEST_TEXT, text.chars().count());
    if count > most {
        faults.say(name, format!("`{name}` has at most {most} characters; this has {count}"));
    }
}

/// Judges tone.
pub(crate) fn tone(tone: &Tone, faults: &mut Faults) {
    values(tone, None, faults);
    let Some(neutral) = tone.neutral.filter(|_| faults.spare(&["neutral"])) else { return };
    if tone.white_balance.is_some() {
        let help = "both say which colour is to look grey: leave one out";
        faults.say("neutral", "`neutral` stands beside `white_balance`").help =
            Some(help.to_owned());
    } else if neutral.is_black() {
        faults.say("neutral", "`neutral` is black, which is no colour of a light");
    }
}

/// Judges a sky.
pub(crate) fn sky(sky: &Sky, faults: &mut Faults) {
    values(sky, None, faults);
    if let SkyKind::SunAndSky { sun, .. } = sky.kind
        && faults.spare(&["sun", "up"])
        && sun.dot(sky.up) < 0.0
    {
        let help = "it is a sky by day; `sun` points from the scene to the sun";
        faults.say("sun", "the sun is below the horizon").help = Some(help.to_owned());
    }
}

/// Judges fog.
pub(crate) fn fog(fog: &Fog, faults: &mut Faults) {
    values(fog, None, faults);
    if let FogKind::Linear { start, end } = fog.kind
        && faults.spare(&["start", "end"])
        && end <= start
    {
        let message = format!("`end` must be above `start`, which is {start}; this is {end}");
        faults.say("end", message);
    }
}

/// Judges a clip by itself.
pub(crate) fn clip(clip: &Clip, faults: &mut Faults) {
    values(clip, None, faults);
    let ClipKind::Box { min, max, .. } = clip.kind else { return };
    if faults.spare(&["min", "max"])
        && let Some(axis) = (0..3).find(|&axis| max[axis] <= min[axis])
    {
        let name = ["x", "y", "z"][axis];
        let message = format!(
            "`max` must be above `min` along each axis; along {name} it is {}, and `min` is {}",
            max[axis], min[axis]
        );
        faults.say("max", message);
    }
}

/// Judges a camera.
pub(crate) fn camera(camera: &Camera, faults: &mut Faults) {
    values(camera, None, faults);
    if faults.spare(&["eye", "look_at", "up"]) {
        view(camera.eye, camera.look_at, camera.up, faults);
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
    values(light, None, faults);
    if let LightKind::Rectangle { direction, up: Some(up), .. } = light.kind
        && faults.spare(&["direction", "up"])
        && LightKind::upright(direction, Some(up)).is_none()
    {
        let help = "`up` says which way its height is: it must point elsewhere than `direction`";
        faults.say("up", "`up` is parallel to `direction`").help = Some(help.to_owned());
    }
    let LightKind::Spot { position, target, cone, edge, .. } = light.kind else { return };
    if faults.spare(&["position", "target"]) && (target - position).try_normalize().is_none() {
        let help = "the light shines from `position` to `target`; they must differ";
        faults.say("target", "`target` is where the light is").help = Some(help.to_owned());
    }
    if cone == 0.0 && edge == 0.0 {
        faults.all.retain(|fault| fault.field != "edge");
        faults.say("cone", "a cone of 0 without an `edge` holds no light");
    } else if faults.spare(&["cone", "edge"]) && edge < cone {
        let message = format!("`edge` is below `cone`, which is {cone}");
        let help = "full light within `cone`, none beyond `edge`";
        faults.say("edge", message).help = Some(help.to_owned());
    }
}
