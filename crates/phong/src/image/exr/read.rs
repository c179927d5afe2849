//! OpenEXR files of any kind, read by the crate `exr`.

use std::io::{Cursor, Read, Seek};

use exr::meta::MetaData;
use exr::meta::attribute::AttributeValue;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, Text, Vec2, f16};

use crate::image::picture::{Picture, Plane, ReadError, Transfer, count, within};

/// The text of an attribute of the first layer; `None`: there is none, or the file cannot be read.
pub(in crate::image) fn said(file: &mut (impl Read + Seek), name: &str) -> Option<String> {
    let meta = MetaData::read_from_buffered(file, false).ok()?;
    match meta.headers.first()?.own_attributes.other.get(&Text::new_or_none(name)?)? {
        AttributeValue::Text(said) => Some(said.to_string()),
        _ => None,
    }
}

/// Reads all channels of the first part, at full resolution.
pub(in crate::image) fn read(bytes: &[u8], max_bytes: u64) -> Result<Picture, ReadError> {
    let broken = |error: exr::error::Error| ReadError::Broken(format!("OpenEXR: {error}"));
    // The header alone first: what it declares is bounded before anything is allocated.
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(broken)?;
    for header in &meta.headers {
        let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let channels = header.channels.list.len().max(1) as u64;
        count(side(header.layer_size.0), side(header.layer_size.1), channels)?;
        let shown = header.shared_attributes.display_window.size;
        count(side(shown.0), side(shown.1), channels)?;
        for size in [header.layer_size, shown] {
            within([side(size.0), side(size.1)], 4 * channels, max_bytes)?;
        }
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(broken)?;
    let layer = image.layer_data;
    let planes = layer.channel_data.list.into_iter().map(|channel| Plane {
        name: channel.name.to_string(),
        values: match channel.sample_data {
            FlatSamples::F32(values) => values,
            FlatSamples::F16(values) => values.into_iter().map(f16::to_f32).collect(),
            FlatSamples::U32(values) => values.into_iter().map(|v| v as f32).collect(),
        },
    });
    let Vec2(width, height) = layer.size;
    let mut planes: Vec<_> = planes.collect();
    if planes.iter().any(|plane| plane.values.len() != width * height) {
        return Err(ReadError::Broken("OpenEXR: subsampled channels are not read".to_owned()));
    }
    // The picture is the display window; what the file holds may be more of it, or less.
    let window = image.attributes.display_window;
    let corner = layer.attributes.layer_position - window.position;
    let shown = window.size;
    if corner != Vec2(0, 0) || shown != layer.size {
        for plane in &mut planes {
            plane.values = placed(&plane.values, layer.size, corner, shown);
        }
    }
    let Vec2(width, height) = shown;
    Ok(Picture {
        size: [width as u32, height as u32],
        planes,
        transfer: Transfer::Linear,
        levels: None,
        lossy: None,
    })
}

/// The pixels of a picture of size `shown` of which `values` of `size` begin at `corner`; 0 where
/// there are none.
fn placed(values: &[f32], size: Vec2<usize>, corner: Vec2<i32>, shown: Vec2<usize>) -> Vec<f32> {
    // What is in both, along one side: where it begins in the picture and in the file, and its length.
    let both = |corner: i32, size: usize, shown: usize| {
        let corner = i64::from(corner);
        let (from, to) = (corner.max(0), (corner + size as i64).min(shown as i64));
        (from as usize, (from - corner) as usize, (to - from).max(0) as usize)
    };
    let (x, file_x, width) = both(corner.0, size.0, shown.0);
    let (y, file_y, height) = both(corner.1, size.1, shown.1);
    let mut all = vec![0.0; shown.area()];
    if width > 0 {
        for row in 0..height {
            let from = &values[(file_y + row) * size.0 + file_x..][..width];
            all[(y + row) * shown.0 + x..][..width].copy_from_slice(from);
        }
    }
    all
}
