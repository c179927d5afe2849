//! `[[light]]`.

use super::notes::Notes;
use super::table::Values;
use crate::check::settings as judge;
use crate::light::{Light, LightKind};

/// The light that is the `number`th of the scene; what is wrong with it has been said.
pub(super) fn light(v: &Values, number: usize, notes: &mut Notes) -> Option<Light> {
    let attenuation = || v.vector("attenuation").map(|a| a.to_array());
    let kind = match v.word("kind")? {
        "distant" => {
            LightKind::Distant { direction: v.vector("direction")?, angle: v.number("angle")? }
        }
        "spot" => spot(v, attenuation()?)?,
        _ => LightKind::Point {
            position: v.vector("position")?,
            attenuation: attenuation()?,
            radius: v.number("radius")?,
        },
    };
    let color = v.color("color")?;
    let light = Light {
        name: v.text("name").unwrap_or_else(|| format!("light {number}")),
        kind,
        color,
        specular_color: v.color("specular_color").unwrap_or(color),
        shadows: v.flag("shadows")?,
        place: notes.place(v.spot),
    };
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::light(&light, faults));
    sound.then_some(light)
}

fn spot(v: &Values, attenuation: [f64; 3]) -> Option<LightKind> {
    let (position, target) = (v.vector("position")?, v.vector("target")?);
    let cone = v.number("cone")?;
    let edge = v.number("edge").unwrap_or(cone);
    let radius = v.number("radius")?;
    Some(LightKind::Spot { position, target, cone, edge, attenuation, radius })
}
