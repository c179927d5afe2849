//! Images of materials, as textures: from buffers, from texts and from files beside the document.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine2, DAffine3, DMat3, DVec2, DVec3};

use super::buffer::{self, Buffers};
use super::json::{At, Fault, Result};
use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::format::text::{Findings, whole};
use crate::limits::Limits;
use crate::source::Source;
use crate::texels::{self, TexelValues, Texels};
use crate::texture::{
    Encoding, TexelFilter, Texture, TextureId, TextureKind, TextureRef, TextureSpace, Wrap,
};

/// The textures of materials, and the images that were read for them.
pub(super) struct Images<'a> {
    pub(super) root: At<'a>,
    pub(super) path: &'a str,
    pub(super) source: &'a dyn Source,
    pub(super) limits: &'a Limits,
    read: BTreeMap<usize, std::result::Result<Arc<Texels>, Fault>>,
    /// The textures, in the order in which materials asked for them.
    pub(super) textures: Vec<Texture>,
}

/// An image as a material names it, before it is known what for.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub(super) texels: Arc<Texels>,
    wrap: Wrap,
    filter: TexelFilter,
    transform: DAffine3,
}

impl<'a> Images<'a> {
    pub(super) fn new(
        root: At<'a>,
        path: &'a str,
        source: &'a dyn Source,
        limits: &'a Limits,
    ) -> Self {
        Self { root, path, source, limits, read: BTreeMap::new(), textures: Vec::new() }
    }

    /// The image that a material's member names; `None`: there is no such member, or what is wrong with it has
    /// been told.
    pub(super) fn named(
        &mut self,
        of: &At<'_>,
        key: &str,
        (buffers, file): (&Buffers, &Arc<str>),
        findings: &mut Findings,
    ) -> Option<Named> {
        let at = of.get(key)?;
        match self.find(&at, buffers) {
            Ok(named) => {
                let set = at.whole_or_zero("texCoord").unwrap_or(0);
                if set > 0 {
                    findings.warning(
                        "texture coordinates of another set",
                        || whole(file),
                        || format!("{}: set {set} is not read; set 0 stands in", at.pointer),
                    );
                }
                Some(named)
            }
            Err(Fault { pointer, message }) => {
                findings.warning(
                    "images that cannot be read",
                    || whole(file),
                    || format!("{pointer}: {message}; `{key}` is left out"),
                );
                None
            }
        }
    }

    fn find(&mut self, at: &At<'_>, buffers: &Buffers) -> Result<Named> {
        let index = at.need("index")?;
        let texture =
            self.root.item("textures", index.index()?).map_err(|f| index.fault(f.message))?;
        let (mut wrap, mut filter) = (Wrap::Repeat, TexelFilter::Auto);
        if let Some(number) = texture.get("sampler") {
            let sampler = self.root.item("samplers", number.index()?);
            let sampler = sampler.map_err(|f| number.fault(f.message))?;
            // Of the two axes the first: an image is beside itself as the format's samplers mostly say.
            wrap = match sampler.whole_or_zero("wrapS")? {
                33071 => Wrap::Clamp,
                33648 => Wrap::Mirror,
                _ => Wrap::Repeat,
            };
            if sampler.whole_or_zero("magFilter")? == 9728 {
                filter = TexelFilter::Nearest;
            }
        }
        let number = texture.need("source")?;
        let read = if let Some(known) = self.read.get(&number.index()?) {
            known.clone()
        } else {
            let read = self.load(&number, buffers);
            self.read.insert(number.index()?, read.clone());
            read
        };
        let texels = read?;
        Ok(Named { texels, wrap, filter, transform: placed(at)? })
    }

    fn load(&self, number: &At<'_>, buffers: &Buffers) -> Result<Arc<Texels>> {
        let image = self.root.item("images", number.index()?);
        let image = image.map_err(|f| number.fault(f.message))?;
        let decoded = match (image.get("bufferView"), image.get("uri")) {
            (Some(view), _) => texels::parse(buffers.bytes(&self.root, &view)?, self.limits),
            (None, Some(uri)) => {
                let most = self.limits.bytes.min(1 << 32);
                let bytes = buffer::load(&uri, self.path, self.source, most)?;
                texels::parse(&bytes, self.limits)
            }
            (None, None) => Err("it has neither `bufferView` nor `uri`".to_owned()),
        };
        decoded.map(Arc::new).map_err(|message| image.fault(message))
    }

    /// An image as a texture of the material, for this member.
    pub(super) fn texture(
        &mut self,
        named: &Named,
        tint: Rgb,
        (material, key): (&str, &str),
        place: &Place,
    ) -> TextureRef {
        let Named { texels, wrap, filter, transform } = named;
        let id = TextureId(self.textures.len() as u32);
        self.textures.push(Texture {
            name: format!("{material} {key}"),
            kind: TextureKind::Image {
                file: String::new(),
                texels: Arc::clone(texels),
                wrap: *wrap,
                border: Rgb::BLACK,
                tint,
                filter: *filter,
                encoding: Encoding::Auto,
            },
            space: TextureSpace::Uv,
            transform: *transform,
            place: place.clone(),
        });
        TextureRef::new(id)
    }
}

impl Named {
    /// The same with other pixels.
    pub(super) fn with(&self, texels: Texels) -> Self {
        Self { texels: Arc::new(texels), ..self.clone() }
    }

    /// Whether another image lies just as this one.
    pub(super) fn lies_as(&self, other: &Self) -> bool {
        self.wrap == other.wrap && self.transform == other.transform
    }
}

/// A channel of an image made anew, as 16-bit numbers: of green what `value` says.
pub(super) fn green(texels: &Texels, value: impl Fn(f32) -> f64) -> Option<Texels> {
    let [width, height] = texels.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let short = |at| (value(texels.get(at, false)[1]).clamp(0.0, 1.0) * 65535.0 + 0.5) as u16;
    Texels::new([width, height], 1, TexelValues::Shorts(pixels.map(short).collect())).ok()
}

/// The colours of an image, each made anew by what another image has there, as floats.
pub(super) fn mixed(
    base: &Texels,
    other: &Texels,
    value: impl Fn([f32; 4], [f32; 4]) -> Rgb,
) -> Option<Texels> {
    let [width, height] = base.size();
    let [w, h] = other.size();
    let there =
        |i: u32, count: u32, of: u32| (u64::from(i) * u64::from(of) / u64::from(count)) as u32;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let color = |[x, y]: [u32; 2]| {
        let beside = other.get([there(x, width, w), there(y, height, h)], false);
        value(base.get([x, y], true), beside).to_array()
    };
    Texels::new([width, height], 3, TexelValues::Floats(pixels.flat_map(color).collect())).ok()
}

/// Where an image lies: `KHR_texture_transform` is of coordinates whose second one grows down the image, and is
/// turned over as those of meshes are.
fn placed(at: &At<'_>) -> Result<DAffine3> {
    let Some(said) = at.extension("KHR_texture_transform") else { return Ok(DAffine3::IDENTITY) };
    let offset = DVec2::from(said.numbers_or("offset", [0.0; 2])?);
    let scale = DVec2::from(said.numbers_or("scale", [1.0; 2])?);
    let angle = said.number_or("rotation", 0.0)?;
    let over = DAffine2 {
        matrix2: glam::DMat2::from_diagonal(DVec2::new(1.0, -1.0)),
        translation: DVec2::Y,
    };
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let turn = glam::DMat2::from_cols(DVec2::new(cos, -sin), DVec2::new(sin, cos));
    let own = DAffine2 { matrix2: turn * glam::DMat2::from_diagonal(scale), translation: offset };
    let placed = (over * own * over).inverse();
    if !placed.is_finite() {
        return Ok(DAffine3::IDENTITY);
    }
    let [x, y] = [placed.matrix2.x_axis, placed.matrix2.y_axis].map(|axis| axis.extend(0.0));
    Ok(DAffine3 {
        matrix3: DMat3::from_cols(x, y, DVec3::Z),
        translation: placed.translation.extend(0.0),
    })
}
