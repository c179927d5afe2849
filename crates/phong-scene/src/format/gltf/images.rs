//! Images of materials, as textures: from buffers, from texts and from files beside the document.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine2, DAffine3, DMat3, DVec2, DVec3};

use super::buffer::Buffers;
use super::json::{At, Fault, Result};
use super::uri::load;
use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::format::text::{Findings, whole};
use crate::limits::Limits;
use crate::source::{Source, trouble};
use crate::texels::{self, Texels, TexelsError};
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
    /// What was made of them for materials, by what it was made of.
    made: BTreeMap<Made, std::result::Result<Arc<Texels>, String>>,
    /// The means of those that were asked for.
    means: BTreeMap<usize, [f32; 4]>,
    /// The sets of texture coordinates of the images that the material at hand names, and where it does.
    sets: Vec<(u64, String)>,
    /// The textures, in the order in which materials asked for them.
    pub(super) textures: Vec<Texture>,
}

/// What an image is made of, so that materials that make the same share it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Made {
    /// What for.
    pub(super) what: &'static str,
    /// The numbers of the images that it is made of.
    pub(super) images: Vec<usize>,
    /// The bits of the factors of the material.
    pub(super) factors: Vec<u64>,
}

/// An image as a material names it, before it is known what for.
#[derive(Clone, Debug)]
pub(super) struct Named {
    /// The number of the image in the file.
    pub(super) image: usize,
    pub(super) texels: Arc<Texels>,
    wrap: Wrap,
    /// Along the second axis, where that is another.
    wrap_v: Option<Wrap>,
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
        Self {
            root,
            path,
            source,
            limits,
            read: BTreeMap::new(),
            made: BTreeMap::new(),
            means: BTreeMap::new(),
            sets: Vec::new(),
            textures: Vec::new(),
        }
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
        match self.find(&at, (buffers, file), findings) {
            Ok(named) => {
                self.sets.push((set_of(&at), at.pointer));
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

    /// The set of texture coordinates in which the images lie that were named since this was last asked: that of
    /// the first. Others are told.
    pub(super) fn set(&mut self, file: &Arc<str>, findings: &mut Findings) -> u64 {
        let named = std::mem::take(&mut self.sets);
        let first = named.first().map_or(0, |(set, _)| *set);
        for (set, pointer) in named.iter().filter(|(set, _)| *set != first) {
            findings.warning(
                "texture coordinates of another set",
                || whole(file),
                || {
                    format!(
                        "{pointer}: its set {set} is not that of the material's first image; set {first} stands in"
                    )
                },
            );
        }
        first
    }

    fn find(
        &mut self,
        at: &At<'_>,
        from: (&Buffers, &Arc<str>),
        findings: &mut Findings,
    ) -> Result<Named> {
        let index = at.need("index")?;
        let texture =
            self.root.item("textures", index.index()?).map_err(|f| index.fault(f.message))?;
        let (mut wrap, mut wrap_v, mut filter) = (Wrap::Repeat, None, TexelFilter::Auto);
        if let Some(number) = texture.get("sampler") {
            let sampler = self.root.item("samplers", number.index()?);
            let sampler = sampler.map_err(|f| number.fault(f.message))?;
            let along = |key: &str| -> Result<Wrap> {
                Ok(match sampler.whole_or_zero(key)? {
                    33071 => Wrap::Clamp,
                    33648 => Wrap::Mirror,
                    _ => Wrap::Repeat,
                })
            };
            wrap = along("wrapS")?;
            wrap_v = Some(along("wrapT")?).filter(|other| *other != wrap);
            if sampler.whole_or_zero("magFilter")? == 9728 {
                filter = TexelFilter::Nearest;
            }
        }
        let number = texture.need("source")?;
        let read = if let Some(known) = self.read.get(&number.index()?) {
            known.clone()
        } else {
            let read = self.load(&number, from, findings);
            self.read.insert(number.index()?, read.clone());
            read
        };
        let texels = read?;
        let (image, transform) = (number.index()?, placed(at)?);
        Ok(Named { image, texels, wrap, wrap_v, filter, transform })
    }

    fn load(
        &self,
        number: &At<'_>,
        (buffers, file): (&Buffers, &Arc<str>),
        findings: &mut Findings,
    ) -> Result<Arc<Texels>> {
        let image = self.root.item("images", number.index()?);
        let image = image.map_err(|f| number.fault(f.message))?;
        let limits = self.left();
        let mut warn = |message: String| {
            let tell = || format!("{}: {message}", image.pointer);
            findings.warning("images that are not wholly drawn", || whole(file), tell);
        };
        let decoded = match (image.get("bufferView"), image.get("uri")) {
            (Some(view), _) => {
                texels::parse(&buffers.bytes(&self.root, &view)?, &limits, &mut warn)
            }
            (None, Some(uri)) => {
                let most = self.limits.bytes.min(1 << 32);
                let bytes = load(&uri, self.path, self.source, most, false)?;
                let bytes = bytes.part(0, bytes.len() as usize);
                let bytes = bytes.map_err(|error| trouble(&error));
                bytes.and_then(|bytes| texels::parse(&bytes, &limits, &mut warn))
            }
            (None, None) => Err("it has neither `bufferView` nor `uri`".to_owned()),
        };
        decoded.map(Arc::new).map_err(|message| image.fault(message))
    }

    /// The limits of the next image: all together stay within those of the file.
    fn left(&self) -> Limits {
        let read = self.read.values().flatten();
        let made = self.made.values().flatten();
        Texels::left(self.limits, read.chain(made).map(AsRef::as_ref))
    }

    /// The mean of an image's linear values.
    pub(super) fn mean(&mut self, named: &Named) -> [f32; 4] {
        *self.means.entry(named.image).or_insert_with(|| named.texels.mean(false))
    }

    /// An image made for materials, each once; or a clause that says why it cannot be. `size` is that of the
    /// image and `bytes` what a pixel of it takes.
    pub(super) fn made(
        &mut self,
        of: Made,
        (size, bytes): ([u32; 2], u64),
        make: impl FnOnce() -> std::result::Result<Texels, TexelsError>,
    ) -> std::result::Result<Arc<Texels>, String> {
        if let Some(made) = self.made.get(&of) {
            return made.clone();
        }
        let made = texels::allow(size, bytes, &self.left())
            .and_then(|()| make().map(Arc::new).map_err(|error| error.to_string()));
        self.made.insert(of, made.clone());
        made
    }

    /// An image as a texture of the material, for this member.
    pub(super) fn texture(
        &mut self,
        named: &Named,
        tint: Rgb,
        (material, key): (&str, &str),
        place: &Place,
    ) -> TextureRef {
        let Named { texels, wrap, wrap_v, filter, transform, .. } = named;
        let id = TextureId(self.textures.len() as u32);
        self.textures.push(Texture {
            name: format!("{material} {key}"),
            kind: TextureKind::Image {
                file: String::new(),
                texels: Arc::clone(texels),
                wrap: *wrap,
                wrap_v: *wrap_v,
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
    pub(super) fn with(&self, texels: Arc<Texels>) -> Self {
        Self { texels, ..self.clone() }
    }

    /// Whether another image lies just as this one.
    pub(super) fn lies_as(&self, other: &Self) -> bool {
        (self.wrap, self.wrap_v) == (other.wrap, other.wrap_v) && self.transform == other.transform
    }
}

/// The set of texture coordinates that an image lies in: `KHR_texture_transform` may say another.
fn set_of(at: &At<'_>) -> u64 {
    let other = at.extension("KHR_texture_transform").and_then(|said| said.get("texCoord"));
    other.or_else(|| at.get("texCoord")).and_then(|set| set.whole().ok()).unwrap_or(0)
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
