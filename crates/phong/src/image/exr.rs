//! OpenEXR: every layer of a film as floats, in one part, ZIP-compressed by 16 rows.

use std::collections::HashMap;
use std::io::{Cursor, Read, Seek, Write};

use exr::block::lines::LineRefMut;
use exr::image::write::samples::{SamplesWriter, WritableSamples};
use exr::math::RoundingMode;
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Chromaticities, LevelMode, SampleType};
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Text, Vec2,
    WritableImage, f16,
};

use super::WriteError;
use super::picture::{Picture, Plane, ReadError, Transfer, count, within};
use crate::aov::Aov;
use crate::film::{Film, LayerKind};
use crate::finish::Finished;

/// Rec. 709: the primaries of sRGB, with white D65.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// One channel, as the film has it: nothing is copied but the row that is being written.
#[derive(Clone, Copy, Debug)]
struct Samples<'a> {
    values: &'a [f32],
    /// Values a pixel, and which of them.
    stride: usize,
    channel: usize,
    width: usize,
}

impl WritableSamples<'_> for Samples<'_> {
    type Writer = Self;

    fn sample_type(&self) -> SampleType {
        SampleType::F32
    }

    fn infer_level_modes(&self) -> (LevelMode, RoundingMode) {
        (LevelMode::Singular, RoundingMode::Down)
    }

    fn create_samples_writer(&self, _: &Header) -> Self {
        *self
    }
}

impl SamplesWriter for Samples<'_> {
    fn extract_line(&self, line: LineRefMut<'_>) {
        let at = line.location.position;
        let first = at.y() * self.width + at.x();
        let value = |i: usize| self.values[(first + i) * self.stride + self.channel];
        // The line is memory and as long as it says: writing to it cannot fail.
        let _ = line.write_samples(value);
    }
}

/// Writes all layers: `R G B A`, `finished.R` where anything is drawn onto the picture, `diffuse.R`, `normal.X`, `uv.U`, `depth`, … Premultiplied.
pub(super) fn write(
    picture: &Finished<'_>,
    out: &mut (impl Write + Seek),
) -> Result<(), WriteError> {
    let film = picture.film();
    let width = film.width() as usize;
    let channel = |name: String, values, stride, channel| {
        let samples = Samples { values, stride, channel, width };
        AnyChannel::new(Text::new_or_panic(name), samples)
    };
    let opaque;
    let mut list = exr::prelude::SmallVec::new();
    for layer in &film.layers {
        let names = channel_names(layer.kind).into_iter().enumerate();
        let n = layer.kind.channels();
        list.extend(names.map(|(c, name)| channel(name, &layer.values, n, c)));
    }
    if let Some([picture, alpha]) = picture.drawn() {
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            list.push(channel(format!("finished.{name}"), picture, 3, c));
        }
        list.push(channel("finished.A".to_owned(), alpha, 1, 0));
    }
    if film.layer(LayerKind::Alpha).is_none() {
        opaque = vec![1.0; width * film.height() as usize];
        list.push(channel("A".to_owned(), &opaque, 1, 0));
    }
    let [software, scene, whole] = picture.origin().map(|said| said.map(|(_, text)| text));
    let software_name = software.map(Text::new_or_panic);
    let mut attributes = LayerAttributes { software_name, ..LayerAttributes::default() };
    let own = sampled(film).chain(scene.map(|sum| ("scene", sum)));
    let own: Vec<_> = own.chain(whole.map(|sum| ("picture", sum))).collect();
    attributes.other = in_order(&own);
    let layer = Layer::new(
        (width, film.height() as usize),
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list),
    );
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(REC_709);
    // The compressor makes a pool of its own: one thread where one was asked for, else all cores.
    let writer = image.write();
    let writer = if rayon::current_num_threads() == 1 { writer.non_parallel() } else { writer };
    writer.to_buffered(out).map_err(|error| match error {
        exr::error::Error::Io(error) => WriteError::Io(error),
        other => WriteError::Unsuitable(format!("OpenEXR: {other}")),
    })
}

/// The text of an attribute of the first layer; `None`: there is none, or the file cannot be read.
pub(super) fn said(file: &mut (impl Read + Seek), name: &str) -> Option<String> {
    let meta = MetaData::read_from_buffered(file, false).ok()?;
    match meta.headers.first()?.own_attributes.other.get(&Text::new_or_none(name)?)? {
        AttributeValue::Text(said) => Some(said.to_string()),
        _ => None,
    }
}

/// Attributes as the crate takes them. It writes them in the order of its hash map, which is another
/// one for each map: one is taken that has the names in order, so that the same picture has the same
/// bytes.
fn in_order(attributes: &[(&str, String)]) -> HashMap<Text, AttributeValue> {
    loop {
        let pairs = attributes.iter().map(|(name, said)| {
            let said = AttributeValue::Text(Text::new_or_panic(said.as_str()));
            (Text::new_or_panic(*name), said)
        });
        let map: HashMap<_, _> = pairs.collect();
        if map.keys().map(Text::to_string).is_sorted() {
            return map;
        }
    }
}

/// Which layers are the mean of a pixel's samples, and which are of the ray through its centre alone:
/// the attributes `averaged` and `pixelCenter`, names between commas.
fn sampled(film: &Film) -> impl Iterator<Item = (&'static str, String)> {
    let names = |averaged: bool| -> Vec<_> {
        let kinds = film.layers.iter().map(|layer| layer.kind);
        kinds.filter(|kind| kind.is_averaged() == averaged).map(LayerKind::name).collect()
    };
    [("averaged", names(true)), ("pixelCenter", names(false))]
        .into_iter()
        .filter(|(_, names)| !names.is_empty())
        .map(|(name, names)| (name, names.join(",")))
}

fn channel_names(kind: LayerKind) -> Vec<String> {
    let of = |axes: &[&str]| axes.iter().map(|axis| format!("{}.{axis}", kind.name())).collect();
    match kind {
        LayerKind::Picture => ["R", "G", "B"].map(str::to_owned).to_vec(),
        LayerKind::Alpha => vec!["A".to_owned()],
        LayerKind::Term(_)
        | LayerKind::Light(_)
        | LayerKind::Unlit
        | LayerKind::Aov(Aov::Albedo) => of(&["R", "G", "B"]),
        LayerKind::Aov(Aov::Normal | Aov::Position) => of(&["X", "Y", "Z"]),
        LayerKind::Aov(Aov::Uv) => of(&["U", "V"]),
        LayerKind::Aov(_) => vec![kind.name().into_owned()],
    }
}

/// Reads all channels of the first part, at full resolution.
pub(super) fn read(bytes: &[u8], max_bytes: u64) -> Result<Picture, ReadError> {
    use exr::prelude::{ReadChannels, ReadLayers};
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
    let within = |at: usize, corner: i32, size: usize| {
        let inside = at as i64 - i64::from(corner);
        usize::try_from(inside).ok().filter(|&inside| inside < size)
    };
    let mut all = vec![0.0; shown.area()];
    for (i, value) in all.iter_mut().enumerate() {
        let x = within(i % shown.0, corner.0, size.0);
        let y = within(i / shown.0, corner.1, size.1);
        if let (Some(x), Some(y)) = (x, y) {
            *value = values[y * size.0 + x];
        }
    }
    all
}
