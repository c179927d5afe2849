//! Tone as lines of a part's settings: its exposure, and what else of it is asked for.

use phong_scene::{Exposure, Rgb, Tone, ToneCurve};

/// What the line of the exposure says.
pub(super) fn exposure(tone: &Tone) -> String {
    match tone.exposure {
        Exposure::Auto => "auto".to_owned(),
        Exposure::Stops(stops) => stops.to_string(),
    }
}

/// A tone of which no more is known than what the line of the exposure says; `None`: it is senseless.
pub(super) fn exposed(text: &str) -> Option<Tone> {
    let exposure = match text {
        "auto" => Exposure::Auto,
        stops => Exposure::Stops(stops.parse().ok().filter(|stops: &f64| stops.is_finite())?),
    };
    Some(Tone { exposure, ..Tone::default() })
}

/// What else is asked for.
pub(super) fn more(tone: &Tone) -> impl Iterator<Item = (&'static str, String)> {
    let neutral = tone.neutral.map(|Rgb { r, g, b }| ("neutral", format!("{r} {g} {b}")));
    let curve = match tone.curve {
        ToneCurve::Clamp => None,
        ToneCurve::Reinhard { white } => Some(("curve", format!("reinhard {white}"))),
        ToneCurve::Filmic => Some(("curve", "filmic".to_owned())),
    };
    let kelvin = tone.white_balance.map(|kelvin| ("white_balance", kelvin.to_string()));
    kelvin.into_iter().chain(neutral).chain(curve)
}

/// Reads one of those lines; `Some(false)`: it says something else; `None`: it is senseless.
pub(super) fn read(tone: &mut Tone, name: &str, value: &str) -> Option<bool> {
    match name {
        "white_balance" => {
            let [low, high] = Tone::TEMPERATURES;
            let kelvin = value.parse().ok().filter(|kelvin| (low..=high).contains(kelvin))?;
            tone.white_balance = Some(kelvin);
        }
        "neutral" => {
            let channels: Option<Vec<f32>> = value.split(' ').map(|v| v.parse().ok()).collect();
            let color = Rgb::from(<[f32; 3]>::try_from(channels?).ok()?);
            let sound = color.to_array().iter().all(|v| v.is_finite() && *v >= 0.0);
            tone.neutral = Some(color).filter(|color| sound && !color.is_black());
            tone.neutral?;
        }
        "curve" => {
            tone.curve = match value.strip_prefix("reinhard ") {
                Some(white) => {
                    let white = white.parse().ok();
                    let white = white.filter(|white: &f64| *white > 0.0 && white.is_finite())?;
                    ToneCurve::Reinhard { white }
                }
                None if value == "filmic" => ToneCurve::Filmic,
                None => return None,
            };
        }
        _ => return Some(false),
    }
    Some(true)
}
