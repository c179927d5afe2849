//! `[[light]]`.

use super::notes::Notes;
use super::table::Values;
use crate::light::{Light, LightKind};

/// The light that is the `number`th of the scene; what is wrong with it has been said.
pub(super) fn light(v: &Values, number: usize, notes: &mut Notes) -> Option<Light> {
    let attenuation = || v.vector("attenuation").map(|a| a.to_array());
    let kind = match v.word("kind")? {
        "distant" => {
            LightKind::Distant { direction: v.vector("direction")?, angle: v.number("angle")? }
        }
        "spot" => spot(v, attenuation()?, notes)?,
        _ => LightKind::Point {
            position: v.vector("position")?,
            attenuation: attenuation()?,
            radius: v.number("radius")?,
        },
    };
    let color = v.color("color")?;
    Some(Light {
        name: v.text("name").unwrap_or_else(|| format!("light {number}")),
        kind,
        color,
        specular_color: v.color("specular_color").unwrap_or(color),
        shadows: v.flag("shadows")?,
        place: notes.place(v.spot),
    })
}

fn spot(v: &Values, attenuation: [f64; 3], notes: &mut Notes) -> Option<LightKind> {
    let (position, target) = (v.vector("position")?, v.vector("target")?);
    if (target - position).try_normalize().is_none() {
        let help = "the light shines from `position` to `target`; they must differ";
        notes.error(v.spot_of("target"), "`target` is where the light is").help =
            Some(help.to_owned());
        return None;
    }
    let cone = v.number("cone")?;
    let edge = v.number("edge").unwrap_or(cone);
    if edge < cone {
        let message = format!("`edge` is below `cone`, which is {cone}");
        let help = "full light within `cone`, none beyond `edge`";
        notes.error(v.spot_of("edge"), message).help = Some(help.to_owned());
        return None;
    }
    if edge == 0.0 {
        notes.error(v.spot_of("cone"), "a cone of 0 without an `edge` holds no light");
        return None;
    }
    let radius = v.number("radius")?;
    Some(LightKind::Spot { position, target, cone, edge, attenuation, radius })
}
