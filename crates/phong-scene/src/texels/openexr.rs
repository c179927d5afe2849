//! `OpenEXR`: the first layer of colours, in full resolution.

use std::io::Cursor;

use exr::block::reader::Reader;
use exr::image::read::image::ReadLayers;
use exr::image::read::layers::ReadChannels;
use exr::image::read::read;

use super::allowed::allow;
use super::{TexelValues, Texels};
use crate::limits::Limits;

/// The pixels, or a clause that says what is wrong. Of channels that are neither red, green, blue, luminance nor
/// opacity the first is taken as grey.
pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Texels, String> {
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
    let size = [layer.size.width(), layer.size.height()].map(|side| side as u32);
    let channels = &layer.channel_data.list;
    let named = |name: &str| {
        channels.iter().find(|channel| channel.name.to_string().eq_ignore_ascii_case(name))
    };
    let color = match [named("R"), named("G"), named("B")] {
        [Some(r), Some(g), Some(b)] => vec![r, g, b],
        _ => vec![named("Y").or(channels.first()).ok_or("it is an EXR without channels")?],
    };
    let planes: Vec<Vec<f32>> = color
        .into_iter()
        .chain(named("A"))
        .map(|channel| channel.sample_data.values_as_f32().collect())
        .collect();
    let pixels = size[0] as usize * size[1] as usize;
    if planes.iter().any(|plane| plane.len() != pixels) {
        return Err("it is an EXR whose channels are of different sizes".to_owned());
    }
    let values = (0..pixels).flat_map(|i| planes.iter().map(move |plane| plane[i])).collect();
    Texels::new(size, planes.len(), TexelValues::Floats(values)).map_err(|error| error.to_string())
}
