//! `OpenEXR`: the first layer of colours, in full resolution.

use std::io::Cursor;

use exr::block::reader::Reader;
use exr::image::read::image::ReadLayers;
use exr::image::read::layers::ReadChannels;
use exr::image::read::read;
use exr::meta::header::{Header, LayerAttributes};

use super::allowed::allow;
use super::{TexelValues, Texels};
use crate::limits::Limits;
use crate::wording::{list, quoted};

/// The pixels, or a clause that says what is wrong; `warn` is told what else the file has.
pub(super) fn decode(
    bytes: &[u8],
    limits: &Limits,
    warn: &mut dyn FnMut(String),
) -> Result<Texels, String> {
    let broken = |error: exr::error::Error| format!("it is a broken EXR: {error}");
    let headers = Reader::read_from_buffered(Cursor::new(bytes), false).map_err(broken)?;
    for header in headers.headers() {
        let size = [header.layer_size.width(), header.layer_size.height()].map(|side| side as u32);
        allow(size, 4 * header.channels.list.len() as u64, limits)?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(broken)?;
    let layer = image.layer_data;
    tell_of_parts(headers.headers(), &layer.attributes, warn);
    let size = [layer.size.width(), layer.size.height()].map(|side| side as u32);
    let channels = &layer.channel_data.list;
    if channels.is_empty() {
        return Err("it is an EXR without channels".to_owned());
    }
    let names: Vec<_> = channels.iter().map(|channel| channel.name.to_string()).collect();
    let planes: Vec<Vec<f32>> = drawn(&names, warn)
        .into_iter()
        .map(|number| channels[number].sample_data.values_as_f32().collect())
        .collect();
    let pixels = size[0] as usize * size[1] as usize;
    if planes.iter().any(|plane| plane.len() != pixels) {
        return Err("it is an EXR whose channels are of different sizes".to_owned());
    }
    let values = (0..pixels).flat_map(|i| planes.iter().map(move |plane| plane[i])).collect();
    Texels::new(size, planes.len(), TexelValues::Floats(values)).map_err(|error| error.to_string())
}

/// Says which parts of a file of several are not drawn: all but one. No two are called the same.
fn tell_of_parts(parts: &[Header], taken: &LayerAttributes, warn: &mut dyn FnMut(String)) {
    let name = |of: &LayerAttributes| of.layer_name.as_ref().map(ToString::to_string);
    let others = parts.iter().map(|part| &part.own_attributes).filter(|of| name(of) != name(taken));
    let others: Vec<_> = others.filter_map(name).collect();
    if !others.is_empty() {
        let (taken, others) =
            (name(taken).unwrap_or_default(), list(others.iter().map(|name| &**name), "and"));
        warn(format!("of its parts {} is taken, not {others}", quoted(&taken)));
    }
}

/// The numbers of the channels that are drawn: red, green and blue without a layer or of the first layer that has
/// them, else luminance or the first channel as grey; then the opacity beside them.
fn drawn(names: &[String], warn: &mut dyn FnMut(String)) -> Vec<usize> {
    let find = |layer: &str, channel: &str| {
        names.iter().position(|name| {
            let (of, what) = split(name);
            of == layer && what.eq_ignore_ascii_case(channel)
        })
    };
    let colors = |layer: &str| Some([find(layer, "R")?, find(layer, "G")?, find(layer, "B")?]);
    let mut layers: Vec<&str> = Vec::new();
    for (layer, _) in names.iter().map(|name| split(name)) {
        if !layers.contains(&layer) && colors(layer).is_some() {
            layers.push(layer);
        }
    }
    let layer = if layers.contains(&"") { "" } else { layers.first().copied().unwrap_or("") };
    let opacity = find(layer, "A");
    let Some(colors) = colors(layer) else {
        let grey = find("", "Y").unwrap_or(0);
        let others = (0..names.len()).filter(|&i| i != grey && Some(i) != opacity);
        let others: Vec<_> = others.map(|i| &*names[i]).collect();
        if !others.is_empty() {
            let (taken, others) = (quoted(&names[grey]), list(others, "and"));
            warn(format!("it has no R, G and B: {taken} is taken as grey, not {others}"));
        }
        return [grey].into_iter().chain(opacity.filter(|&i| i != grey)).collect();
    };
    if layers.len() > 1 && !layer.is_empty() {
        let others = list(layers[1..].iter().copied(), "and");
        warn(format!("of its layers {} is taken, not {others}", quoted(layer)));
    }
    colors.into_iter().chain(opacity).collect()
}

/// The layer that a channel is of, which may be none, and its name in there.
fn split(name: &str) -> (&str, &str) {
    name.rsplit_once('.').unwrap_or(("", name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_layer_of_colours_is_drawn_and_others_are_told() {
        for (names, want, told) in [
            (&["A", "B", "G", "R"][..], &[3, 2, 1, 0][..], ""),
            (&["beauty.B", "beauty.G", "beauty.R"], &[2, 1, 0], ""),
            (
                &["V.Combined.A", "V.Combined.B", "V.Combined.G", "V.Combined.R", "V.Depth.Z"],
                &[3, 2, 1, 0],
                "",
            ),
            (&["B", "G", "R", "a.B", "a.G", "a.R"], &[2, 1, 0], ""),
            (
                &["a.B", "a.G", "a.R", "b.B", "b.G", "b.R", "c.B"],
                &[2, 1, 0],
                "of its layers \"a\" is taken, not `b`",
            ),
            (&["Z"], &[0], ""),
            (&["A", "Y"], &[1, 0], ""),
            (&["A"], &[0], ""),
            (&["N.X", "N.Y", "N.Z"], &[0], "\"N.X\" is taken as grey, not `N.Y` and `N.Z`"),
        ] {
            let names: Vec<_> = names.iter().map(|&name| name.to_owned()).collect();
            let mut all = String::new();
            assert_eq!(drawn(&names, &mut |message| all += &message), want, "{names:?}");
            assert!(all.contains(told) && all.is_empty() == told.is_empty(), "{names:?}: {all}");
        }
    }
}
