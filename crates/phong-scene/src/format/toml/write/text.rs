//! Values as they are written: the shortest text that reads back to the same bits.

use std::fmt::Write as _;

use glam::{DVec2, DVec3};

use crate::change::toml_string;
use crate::color::{Rgb, srgb_encode};
use crate::keys::{BACKGROUND, Kind, Value, short};
use crate::scene::Background;
use crate::texture::TextureRef;
use crate::wording::Word;

/// A value as text; its kind tells how short it may be. `textures` are the names of the scene's.
pub(super) fn value(value: &Value, kind: Kind, textures: &[String]) -> String {
    match value {
        Value::Flag(flag) => flag.to_string(),
        Value::Integer(n) => n.to_string(),
        Value::Number(n) => number(*n),
        Value::Vector(v) if matches!(kind, Kind::Scale) && *v == DVec3::splat(v.x) => number(v.x),
        Value::Vector(v) => numbers(&v.to_array()),
        Value::Vectors(vs) => list(vs.iter().map(|v| numbers(&v.to_array()))),
        Value::Pair(pair) => numbers(&pair.to_array()),
        Value::Uvs(uvs) => list(uvs.iter().map(|uv: &DVec2| numbers(&uv.to_array()))),
        Value::Rotations(rotations) => list(rotations.iter().map(|r| numbers(&r.to_array()))),
        Value::Matrix(m) => {
            let (x, y, z, w) =
                (m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation);
            let row = |i: usize| numbers(&[x[i], y[i], z[i], w[i]]);
            list([row(0), row(1), row(2), numbers(&[0.0, 0.0, 0.0, 1.0])])
        }
        Value::Size([width, height]) => format!("[{width}, {height}]"),
        Value::Color(color) | Value::Background(Background::Color(color)) => self::color(*color),
        Value::Background(Background::Transparent) => toml_string("transparent"),
        Value::Background(Background::Gradient { top, bottom }) => {
            let ends = BACKGROUND.keys().zip([top, bottom]);
            let ends = ends.map(|(key, end)| format!("{} = {}", key.name, color(*end)));
            format!("{{ {} }}", ends.collect::<Vec<_>>().join(", "))
        }
        Value::Word(word) => toml_string(word),
        Value::Text(text) => toml_string(text),
        Value::Colors(colors) => list(colors.iter().map(|&c| color(c))),
        Value::Stops(stops) => {
            list(stops.iter().map(|&(t, c)| format!("[{}, {}]", number(short(t)), color(c))))
        }
        Value::Textured(by) => textured(by, textures),
        Value::Texts(texts) => list(texts.iter().map(|(text, _)| toml_string(text))),
        Value::Numbers(all) => numbers(all),
    }
}

/// What a texture stands for: the keys that are not as by default.
fn textured(by: &TextureRef, textures: &[String]) -> String {
    let TextureRef { texture, scale, offset, channel } = by;
    let name = textures.get(texture.0 as usize).map_or("", String::as_str);
    let mut text = format!("{{ texture = {}", toml_string(name));
    // Writing to a string does not fail.
    if *scale != 1.0 {
        let _ = write!(text, ", scale = {}", number(short(*scale)));
    }
    if *offset != 0.0 {
        let _ = write!(text, ", offset = {}", number(short(*offset)));
    }
    if let Some(channel) = channel {
        let _ = write!(text, ", channel = {}", toml_string(channel.word()));
    }
    text + " }"
}

/// The shortest decimal of a number, with an exponent where zeros would be many.
pub(super) fn number(n: f64) -> String {
    let debug = format!("{n:?}");
    match debug.strip_suffix(".0") {
        // As a whole number it would lose its sign.
        Some(whole) if whole != "-0" => whole.to_owned(),
        _ => debug,
    }
}

fn numbers(values: &[f64]) -> String {
    list(values.iter().map(|n| number(*n)))
}

fn list(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(", "))
}

/// A colour: as it would be picked, `"#rrggbb"`, where that is it exactly and its linear values
/// are no short numbers.
fn color(color: Rgb) -> String {
    let bytes = color.to_array().map(|c| (srgb_encode(f64::from(c)) * 255.0).round() as u8);
    let linear = match color.to_array().map(short) {
        [r, g, b] if r == g && g == b => number(r),
        channels => numbers(&channels),
    };
    if linear.len() <= "[0.25, 0.25, 0.25]".len() || Rgb::from_srgb8(bytes) != color {
        return linear;
    }
    let [r, g, b] = bytes;
    format!("\"#{r:02x}{g:02x}{b:02x}\"")
}

/// A part of a header: bare where that may be, else in quotes.
pub(super) fn name(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.to_owned() } else { toml_string(name) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_short_as_they_may_be() {
        let cases =
            [(1.0, "1"), (-0.0, "-0.0"), (0.1, "0.1"), (1e18, "1e18"), (-2.5e-9, "-2.5e-9")];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!(number(short(0.1_f32)), "0.1");
        assert_eq!(number(short(f32::MAX)), "3.4028235e38");
    }

    #[test]
    fn a_colour_is_written_as_picked_where_that_is_exact_and_shorter() {
        let picked = Rgb::from_srgb8([0xc8, 0x40, 0x2f]);
        assert_eq!(color(picked), "\"#c8402f\"");
        let off = Rgb { r: picked.r.next_up(), ..picked };
        assert!(color(off).starts_with("[0.577580"), "{}", color(off));
        assert_eq!(color(Rgb::new(1.0, 0.5, 0.0)), "[1, 0.5, 0]");
        assert_eq!(color(Rgb::grey(2.0)), "2");
    }

    #[test]
    fn names_that_are_not_bare_stand_in_quotes() {
        assert_eq!(name("red-2"), "red-2");
        assert_eq!(name(""), "\"\"");
        assert_eq!(name("a \"b\"\\\u{7f}"), "\"a \\\"b\\\"\\\\\\u007F\"");
    }
}
