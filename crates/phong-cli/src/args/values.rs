//! Values of options, from text.

use std::fmt::Display;
use std::str::FromStr;

use clap::builder::{OsStringValueParser, TypedValueParser};
use phong::aov::Aov;
use phong_scene::{
    Background, ColorError, Exposure, Format, FrameRange, Rgb, Tone, ToneCurve, closest,
};

use super::White;

/// Three numbers.
pub(crate) type Vec3Arg = [f64; 3];

/// Width and height in pixels, each ≥ 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PictureSize(pub(crate) [u32; 2]);

/// Pixels from (x0, y0) up to but without (x1, y1), not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Crop {
    pub(crate) x0: u32,
    pub(crate) y0: u32,
    pub(crate) x1: u32,
    pub(crate) y1: u32,
}

/// Share `index` (from 0) of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ShareOf {
    pub(crate) index: u32,
    pub(crate) count: u32,
}

/// The largest side of a picture: what EXR and PNG readers commonly take.
const MAX_SIDE: u32 = phong_scene::Image::LARGEST;

/// The largest magnitude of any number, as in scene text: its square still fits an f32.
const LARGEST: f64 = 1e18;

/// `960x540`.
pub(crate) fn size(text: &str) -> Result<PictureSize, String> {
    let sides = text
        .split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some([w.trim().parse::<u32>().ok()?, h.trim().parse::<u32>().ok()?]));
    match sides {
        Some([w, h]) if (1..=MAX_SIDE).contains(&w) && (1..=MAX_SIDE).contains(&h) => {
            Ok(PictureSize([w, h]))
        }
        Some(_) => Err(format!("each side must be from 1 to {MAX_SIDE} pixels")),
        None => Err(format!("write width and height in pixels, like 960x540, up to {MAX_SIDE}")),
    }
}

/// `10,20,110,120`.
pub(crate) fn crop(text: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Crop { x0, y0, x1, y1 }),
        Some([_, _, _, _]) => {
            Err("X1 must be more than X0 and Y1 more than Y0: X1 and Y1 lie outside".to_owned())
        }
        _ => Err("write four whole numbers, X0,Y0,X1,Y1, like 10,20,110,120".to_owned()),
    }
}

/// `0/4`.
pub(crate) fn share(text: &str) -> Result<ShareOf, String> {
    let parts = text
        .split_once('/')
        .and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
    match parts {
        Some((index, count)) if index < count => Ok(ShareOf { index, count }),
        Some((_, 0)) => Err("a picture has at least one share, 0/1".to_owned()),
        Some((_, count)) => Err(format!("I counts from 0: the last of {count} is {}", count - 1)),
        None => Err("write I/N, like 0/4 for the first of four".to_owned()),
    }
}

/// `1,2.5,-3`.
pub(crate) fn vector(text: &str) -> Result<Vec3Arg, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(finite).collect();
    numbers
        .and_then(|n| Vec3Arg::try_from(n).ok())
        .ok_or_else(|| "write three numbers, X,Y,Z, like 0,1.5,-4, none beyond 1e18".to_owned())
}

/// `z`, `-y`, or a direction.
pub(crate) fn up(text: &str) -> Result<Vec3Arg, String> {
    let (sign, axis) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    match axis {
        "x" | "X" => Ok([sign, 0.0, 0.0]),
        "y" | "Y" => Ok([0.0, sign, 0.0]),
        "z" | "Z" => Ok([0.0, 0.0, sign]),
        _ => match vector(text) {
            Ok([0.0, 0.0, 0.0]) => Err("up cannot be 0,0,0".to_owned()),
            Ok(direction) => Ok(direction),
            Err(_) => Err("write x, y, z, -x, -y, -z, or three numbers X,Y,Z".to_owned()),
        },
    }
}

/// Degrees in (0, 360]; how many of them a camera can see depends on its kind.
pub(crate) fn fov(text: &str) -> Result<f64, String> {
    finite(text).filter(|&degrees| degrees > 0.0 && degrees <= 360.0).ok_or_else(|| {
        "write degrees, more than 0 and less than 180 (360 for a fisheye)".to_owned()
    })
}

/// Stops within what f32 can hold, or `auto`.
pub(crate) fn exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    let stops = finite(text).filter(|stops| stops.abs() <= Tone::MOST_STOPS).ok_or_else(|| {
        "write auto, or a number of stops from -100 to 100, like 1 or -0.5".to_owned()
    })?;
    Ok(Exposure::Stops(stops))
}

/// A tone curve by its name, Reinhard's with its white if that is said.
pub(crate) fn curve(text: &str) -> Result<ToneCurve, String> {
    let (name, white) = text.split_once(':').map_or((text, None), |(name, w)| (name, Some(w)));
    match (name, white) {
        ("clamp", None) => Ok(ToneCurve::Clamp),
        ("filmic", None) => Ok(ToneCurve::Filmic),
        ("reinhard", white) => finite(white.unwrap_or("4"))
            .filter(|white| *white > 0.0 && *white <= LARGEST)
            .map(|white| ToneCurve::Reinhard { white })
            .ok_or_else(|| "reinhard:WHITE takes a luminance above 0, like reinhard:4".to_owned()),
        _ => Err("write clamp, reinhard, reinhard:WHITE or filmic".to_owned()),
    }
}

/// A colour temperature in kelvin, or a colour.
pub(crate) fn white_balance(text: &str) -> Result<White, String> {
    let [low, high] = Tone::TEMPERATURES;
    if let Some(kelvin) = finite(text) {
        let kelvin = Some(kelvin).filter(|kelvin| (low..=high).contains(kelvin));
        let wrong = || format!("write kelvin from {low} to {high}, or a colour");
        return kelvin.map(White::Kelvin).ok_or_else(wrong);
    }
    let color =
        color(text).map_err(|why| format!("kelvin from {low} to {high}, or a colour: {why}"))?;
    if color.is_black() {
        return Err("black is no colour of a light".to_owned());
    }
    Ok(White::Color(color))
}

/// The distance of two eyes.
pub(crate) fn eye_distance(text: &str) -> Result<f64, String> {
    finite(text)
        .filter(|distance| *distance > 0.0 && *distance <= LARGEST)
        .ok_or_else(|| "write a number of scene units above 0".to_owned())
}

/// A plain number of bytes, or one with `k`, `M`, `G` or `T`.
pub(crate) fn bytes(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let number: f64 = text[..end].parse().map_err(|_| "write bytes, like 500M or 2G".to_owned())?;
    let shift = match text[end..].trim() {
        "" | "B" | "b" => 0,
        "k" | "K" | "kB" | "KB" | "KiB" => 10,
        "M" | "m" | "MB" | "MiB" => 20,
        "G" | "g" | "GB" | "GiB" => 30,
        "T" | "t" | "TB" | "TiB" => 40,
        unit => return Err(format!("`{unit}` is no unit: k, M, G or T (powers of 1024)")),
    };
    Ok((number * (1_u64 << shift) as f64) as u64)
}

/// `#rrggbb`, a CSS name, or linear values: `r,g,b` or one grey.
pub(crate) fn color(text: &str) -> Result<Rgb, String> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let light = |v: &f64| (0.0..=LARGEST).contains(v);
    match parts.as_deref() {
        Some(&[v]) if light(&v) => Ok(Rgb::grey(v as f32)),
        Some(&[r, g, b]) if [r, g, b].iter().all(light) => {
            Ok(Rgb::new(r as f32, g as f32, b as f32))
        }
        Some(_) => Err("write one number or three, r,g,b, none below 0 or beyond 1e18".to_owned()),
        None => text.parse().map_err(|error: ColorError| error.to_string()),
    }
}

/// A colour, or `transparent`.
pub(crate) fn background(text: &str) -> Result<Background, String> {
    if text == "transparent" {
        return Ok(Background::Transparent);
    }
    color(text).map(Background::Color)
}

/// A whole number from `least` to `most`.
pub(crate) fn whole<T>(least: T, most: T) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: FromStr + PartialOrd + Display + Copy,
{
    move |text| {
        let number = text.trim().parse().ok().filter(|number| (least..=most).contains(number));
        number.ok_or_else(|| format!("write a whole number from {least} to {most}"))
    }
}

/// `0:100:10`, from, up to and step, any of them left out; or one number.
pub(crate) fn frames(text: &str) -> Result<FrameRange, String> {
    let form = "write A:B:S, frames from A (from 0) up to but without B in steps of S, like 0:100:10, \
                50: or ::5; or the number of one";
    let or = |part: Option<&&str>, default: Option<u64>| match part.map(|part| part.trim()) {
        None | Some("") => Ok(default),
        Some(number) => number.parse().map(Some).map_err(|_| form.to_owned()),
    };
    let parts: Vec<&str> = text.split(':').collect();
    let (start, end, step) = match parts[..] {
        [one] if !one.trim().is_empty() => {
            let start = or(Some(&one), None)?;
            (start, start.and_then(|start| start.checked_add(1)), None)
        }
        [_, _] | [_, _, _] => {
            (or(parts.first(), None)?, or(parts.get(1), None)?, or(parts.get(2), None)?)
        }
        _ => return Err(form.to_owned()),
    };
    let (start, step) = (start.unwrap_or(0), step.unwrap_or(1));
    if step == 0 {
        return Err("S, the step from frame to frame, must be at least 1".to_owned());
    }
    if end.is_some_and(|end| end <= start) {
        return Err("B must be more than A: frame B is not drawn any more".to_owned());
    }
    Ok(FrameRange { start, end, step })
}

/// The name of an arbitrary output variable.
pub(crate) fn aov(text: &str) -> Result<Aov, String> {
    let names = Aov::ALL.map(Aov::name);
    Aov::from_name(text.trim()).ok_or_else(|| one_of(text, &names))
}

/// A format's ending, with or without its dot. One that is known but not read is the reader's to
/// refuse.
pub(crate) fn format(text: &str) -> Result<Format, String> {
    known_format(text, &Format::readable())
}

/// The same, where it is one to write.
pub(crate) fn written_format(text: &str) -> Result<Format, String> {
    known_format(text, &Format::writable())
}

fn known_format(text: &str, usual: &[Format]) -> Result<Format, String> {
    let text = text.trim_start_matches('.');
    let names: Vec<&str> = usual.iter().map(|format| format.ending()).collect();
    Format::of_ending(text).ok_or_else(|| one_of(text, &names))
}

/// A path, whatever bytes its name is of.
pub(crate) fn path() -> impl TypedValueParser<Value = String> {
    OsStringValueParser::new().map(|path| phong_scene::path_text(&path))
}

/// What INPUT may be.
pub(crate) fn input_help() -> String {
    let models: Vec<_> = Format::readable().into_iter().filter(|format| format.is_bare()).collect();
    let models = dotted(&models).join(" ");
    format!("A .toml scene or a bare model ({models}); - reads standard input, with --format")
}

/// What the studio opens.
pub(crate) fn studio_help() -> String {
    input_help().split(';').next().unwrap_or_default().to_owned() + " [default: a scene of its own]"
}

/// What `--format` may be.
pub(crate) fn format_help() -> String {
    format!("What INPUT is, whatever its name says: {}", alternatives(&Format::readable()))
}

/// What `--to` may be.
pub(crate) fn written_help() -> String {
    format!("What OUT is, whatever its name says: {}", alternatives(&Format::writable()))
}

/// What OUT may be, where a scene is written.
pub(crate) fn output_help() -> String {
    let endings: Vec<_> = dotted(&Format::writable());
    format!("The file to write ({}); - is standard output, with --to", endings.join(" "))
}

/// `.toml, .obj or .ply`: the formats that are written.
pub(crate) fn written_endings() -> String {
    either(&dotted(&Format::writable()))
}

fn dotted(formats: &[Format]) -> Vec<String> {
    formats.iter().map(|format| format!(".{}", format.ending())).collect()
}

/// `toml, obj or ply`.
fn alternatives(formats: &[Format]) -> String {
    let names: Vec<_> = formats.iter().map(|format| format.ending().to_owned()).collect();
    either(&names)
}

/// `a, b or c`.
fn either(names: &[String]) -> String {
    names
        .split_last()
        .map_or_else(String::new, |(last, rest)| format!("{} or {last}", rest.join(", ")))
}

/// What is said of a word that is none of those known.
fn one_of(text: &str, names: &[&str]) -> String {
    match closest(text, names.iter().copied()) {
        Some(name) => format!("did you mean `{name}`? There are {}", names.join(", ")),
        None => format!("write one of {}", names.join(", ")),
    }
}

fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|v: &f64| v.abs() <= LARGEST)
}

/// A look by its name.
pub(crate) fn look(text: &str) -> Result<phong_scene::NamedLook, String> {
    use phong_scene::{NamedLook, closest};
    NamedLook::from_name(text).ok_or_else(|| {
        let names = NamedLook::ALL.map(NamedLook::name);
        match closest(text, names) {
            Some(near) => format!("there is no such look; did you mean {near}?"),
            None => format!("there is no such look; there are {}", names.join(", ")),
        }
    })
}

/// Pixels an inch.
pub(super) fn dpi(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    number
        .filter(|dpi| (1.0..=100_000.0).contains(dpi))
        .ok_or_else(|| "it must be a number from 1 to 100000".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_needs_two_sides_of_at_least_one_pixel() {
        assert_eq!(size("960x540"), Ok(PictureSize([960, 540])));
        for wrong in ["960", "0x5", "5x0", "-1x5", "axb", "1x2x3", "5000000x1", ""] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_crop_is_half_open_and_not_empty() {
        assert_eq!(crop("1,2,3,4"), Ok(Crop { x0: 1, y0: 2, x1: 3, y1: 4 }));
        for wrong in ["1,2,1,4", "1,2,3,2", "1,2,3", "1,2,3,4,5", "a,b,c,d", "-1,0,1,1"] {
            assert!(crop(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn shares_count_from_nought() {
        assert_eq!(share("0/1"), Ok(ShareOf { index: 0, count: 1 }));
        assert!(share("4/4").unwrap_err().contains("last of 4 is 3"));
        assert!(share("0/0").is_err());
        assert!(share("1").is_err());
    }

    #[test]
    fn frames_count_from_nought_and_end_before_the_second_number() {
        let range = |start, end, step| Ok(FrameRange { start, end, step });
        assert_eq!(frames("2:10:3"), range(2, Some(10), 3));
        assert_eq!(frames(":5"), range(0, Some(5), 1));
        assert_eq!(frames("7:"), range(7, None, 1));
        assert_eq!(frames("::4"), range(0, None, 4));
        assert_eq!(frames("3"), range(3, Some(4), 1));
        for wrong in ["", "a", "1:1", "3:2", "0:5:0", "1:2:3:4", "-1:2", "1.5"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn bytes_take_units_of_1024() {
        assert_eq!(bytes("17"), Ok(17));
        assert_eq!(bytes("1.5k"), Ok(1536));
        assert_eq!(bytes("2G"), Ok(2 << 30));
        for wrong in ["", "k", "2X", "-1", "1e3"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn up_is_an_axis_or_a_direction() {
        assert_eq!(up("-z"), Ok([0.0, 0.0, -1.0]));
        assert_eq!(up("1,2,-3"), Ok([1.0, 2.0, -3.0]));
        assert!(up("0,0,0").is_err());
        assert!(up("w").is_err());
    }

    #[test]
    fn a_whole_number_is_told_its_range() {
        let samples = whole(1_u32, 9);
        assert_eq!((samples("1"), samples("9")), (Ok(1), Ok(9)));
        for wrong in ["0", "10", "-1", "1.5", "", "4294967297", "x"] {
            assert_eq!(samples(wrong).unwrap_err(), "write a whole number from 1 to 9");
        }
    }

    #[test]
    fn a_misspelt_name_is_told_the_nearest() {
        assert!(aov("depht").unwrap_err().starts_with("did you mean `depth`?"));
        assert!(aov("beauty").unwrap_err().starts_with("write one of depth, "));
        assert!(format("tmol").unwrap_err().starts_with("did you mean `toml`?"));
    }

    #[test]
    fn numbers_must_be_finite() {
        assert!(vector("1,nan,2").is_err());
        assert!(vector("inf,0,2").is_err() && vector("1e19,0,0").is_err());
        for wrong in ["1e39", "nan", "0,-1,0", "inf,0,0", "1,2"] {
            assert!(color(wrong).unwrap_err().contains("beyond 1e18"), "{wrong}");
        }
        assert!(fov("361").is_err() && fov("0").is_err());
        assert!(exposure("1000").is_err());
    }
}
