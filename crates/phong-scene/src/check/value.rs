//! Values by themselves: what the row of a key says of them.

use glam::DVec3;

use super::fault::Faults;
use crate::color::Rgb;
use crate::keys::{Key, Keyed, Kind, Value};
use crate::limits::LARGEST;
use crate::scene::{Background, Image};
use crate::texture::{Texture, TextureRef, Textured};
use crate::wording::quoted;

/// Judges the value of every key that keeps it in a field of `of`. What it takes from textures is
/// held against the values of `textures`, the scene's; `None`: they are not known yet, and that is
/// left out.
pub(super) fn values<T: Keyed>(of: &T, textures: Option<&[Texture]>, faults: &mut Faults) {
    for key in of.table().keys() {
        match key.get(of) {
            Some(Value::Textured(by)) => textured(key, &by, textures, faults),
            Some(value) => single(key, &value, faults),
            None => {}
        }
    }
}

fn single(key: &Key, value: &Value, faults: &mut Faults) {
    let name = key.name;
    match (value, key.kind) {
        (Value::Number(n), Kind::Number(range) | Kind::NumberOr(range, _)) => {
            faults.number(name, *n, &range);
        }
        (Value::Integer(n), Kind::Integer(min, max)) if !(min..=max).contains(n) => {
            faults.say(name, format!("`{name}` is from {min} to {max}; this is {n}"));
        }
        (Value::Vector(v), Kind::Direction) => {
            faults.direction(name, *v);
        }
        (Value::Vector(v), Kind::Attenuation) if v.min_element() < 0.0 => {
            faults.say(name, format!("`{name}` is negative; `[c, l, q]` are 0 or above"));
        }
        (Value::Vector(v), Kind::Attenuation) if *v == DVec3::ZERO => {
            faults.say(name, format!("`{name}` is [0, 0, 0], a division by 0"));
        }
        (Value::Vector(v), _) => {
            faults.vector(name, *v);
        }
        (Value::Vectors(vs), kind) => {
            for v in vs {
                match kind {
                    Kind::Directions => faults.direction(name, *v),
                    _ => faults.vector(name, *v),
                };
            }
        }
        (Value::Pair(pair), _) => {
            faults.vector(name, pair.extend(0.0));
        }
        (Value::Uvs(uvs), _) => {
            for uv in uvs {
                faults.vector(name, uv.extend(0.0));
            }
        }
        (Value::Size(sides), _) => {
            let most = Image::LARGEST;
            for side in sides.iter().filter(|side| !(1..=most).contains(*side)) {
                faults.say(name, format!("`{name}` is from 1 to {most} pixels; this is {side}"));
            }
        }
        (Value::Color(color), kind) => {
            faults.color(name, *color, most(kind));
        }
        (Value::Colors(colors), _) => {
            for color in colors {
                faults.color(name, *color, LARGEST);
            }
        }
        (Value::Background(Background::Gradient { top, bottom }), _) => {
            faults.color("top", *top, LARGEST);
            faults.color("bottom", *bottom, LARGEST);
        }
        (Value::Stops(all), _) => stops(name, all, faults),
        _ => {}
    }
}

/// The most that a channel of a colour is.
fn most(kind: Kind) -> f64 {
    if matches!(kind, Kind::Reflectance) { 1.0 } else { LARGEST }
}

fn stops(name: &'static str, stops: &[(f32, Rgb)], faults: &mut Faults) {
    if stops.is_empty() {
        faults.say(name, format!("`{name}` is empty; a gradient has at least one stop"));
    }
    let mut before = 0.0;
    for &(t, color) in stops {
        faults.color(name, color, LARGEST);
        if !(0.0..=1.0).contains(&t) {
            faults.say(name, format!("`{name}` have t from 0 to 1; this is {t}"));
        } else if t < before {
            faults.say(name, format!("`{name}` must not fall: {t} comes after {before}"));
        } else {
            before = t;
        }
    }
}

/// What a parameter becomes by a texture.
fn textured(key: &Key, by: &TextureRef, textures: Option<&[Texture]>, faults: &mut Faults) {
    let name = key.name;
    let scaled = faults.finite(name, by.scale.into());
    if !scaled || !faults.finite(name, by.offset.into()) {
        return;
    }
    let Some(textures) = textures else { return };
    let Some(texture) = textures.get(by.texture.0 as usize) else {
        let (number, count) = (by.texture.0, textures.len());
        faults.say(name, format!("`{name}` names texture {number}, and there are {count}"));
        return;
    };
    let wrong = |value: Rgb| {
        if let Kind::Number(range) = key.kind {
            let value = f32::of(value, by);
            let held = range.holds(value.into());
            return (!held).then(|| format!("a number {}; it becomes {value}", range.words()));
        }
        let value = Rgb::of(value, by).max_channel();
        let most = most(key.kind);
        let held = f64::from(value) <= most;
        (!held).then(|| match most {
            1.0 => format!("at most 1; it becomes {value}"),
            _ => format!("at most {most:e}; it becomes {value:e}"),
        })
    };
    if let Some(wrong) = texture.values(by.channel).into_iter().find_map(wrong) {
        let texture = quoted(&texture.name);
        faults.say(name, format!("with the texture {texture}, `{name}` must be {wrong}")).help =
            Some("`scale` and `offset` beside `texture` bring its values into range".to_owned());
    }
}
