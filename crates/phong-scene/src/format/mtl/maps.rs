//! The images that a material names, as textures.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::texture::{Map, MapOf};
use crate::color::Rgb;
use crate::diagnostic::Span;
use crate::format::text::Findings;
use crate::limits::Limits;
use crate::source::{Source, byte_letter};
use crate::texels::{self, Texels, TexelsError};
use crate::texture::{
    Channel, Encoding, TexelFilter, Texture, TextureId, TextureKind, TextureRef, TextureSpace, Wrap,
};

/// How high a bump of 1 is, in the object's own units: the format says nothing of it.
const BUMP: f64 = 0.01;

/// The textures of materials, and the images that were read for them.
pub(crate) struct Images<'a> {
    source: &'a dyn Source,
    limits: &'a Limits,
    read: BTreeMap<String, Result<Arc<Texels>, String>>,
    /// What was made of them for materials.
    made: Vec<Arc<Texels>>,
    /// The textures, in the order in which materials asked for them.
    pub(crate) textures: Vec<Texture>,
}

impl<'a> Images<'a> {
    /// No textures yet.
    pub(crate) fn new(source: &'a dyn Source, limits: &'a Limits) -> Self {
        Self { source, limits, read: BTreeMap::new(), made: Vec::new(), textures: Vec::new() }
    }

    /// A texture of the colours of the image of that name, which stands there in the file at `file`; else why
    /// there is none.
    pub(crate) fn color(
        &mut self,
        name: &str,
        file: &str,
        span: &Span,
        findings: &mut Findings,
    ) -> Result<TextureId, String> {
        let texels = load(name, file, self, (span, findings))?;
        Ok(self.push(Texture {
            name: name.to_owned(),
            kind: TextureKind::image(name, texels),
            space: TextureSpace::Uv,
            place: span.place.clone(),
            ..Texture::default()
        }))
    }

    fn push(&mut self, texture: Texture) -> TextureId {
        let id = TextureId(self.textures.len() as u32);
        self.textures.push(texture);
        id
    }

    /// The limits of the next image: all together stay within those of the file.
    fn left(&self) -> Limits {
        let read = self.read.values().flatten();
        Texels::left(self.limits, read.chain(&self.made).map(AsRef::as_ref))
    }

    /// An image made of another one, of that size and so many bytes a pixel; or a clause that says why it cannot be.
    pub(super) fn made(
        &mut self,
        (size, bytes): ([u32; 2], u64),
        make: impl FnOnce() -> Result<Texels, TexelsError>,
    ) -> Result<Arc<Texels>, String> {
        texels::allow(size, bytes, &self.left())?;
        let made = Arc::new(make().map_err(|error| error.to_string())?);
        self.made.push(Arc::clone(&made));
        Ok(made)
    }
}

/// What the statements of a material say that images are beside.
pub(super) struct Said<'a> {
    pub(super) name: &'a str,
    pub(super) maps: &'a [(Map, Span)],
    pub(super) ambient: Option<Rgb>,
    pub(super) diffuse: Option<Rgb>,
    pub(super) specular: Option<Rgb>,
    pub(super) emission: Option<Rgb>,
    pub(super) exponent: Option<f32>,
    pub(super) dissolve: Option<f32>,
    /// What it says that uses the physically based extension.
    pub(super) physical: Option<Physical>,
}

/// What a material says that uses the physically based extension.
#[derive(Clone, Copy, Debug)]
pub(super) struct Physical {
    /// `Kd`.
    pub(super) base: Rgb,
    /// `Pm`, from 0 to 1.
    pub(super) metallic: f64,
    /// `Pr`, from 0 to 1.
    pub(super) roughness: f64,
    /// What it mirrors at normal incidence where it is no metal.
    pub(super) dielectric: Rgb,
}

impl Said<'_> {
    /// Beside what an image of that kind is not drawn; `None`: it is drawn.
    fn not_drawn(&self, of: MapOf) -> Option<&'static str> {
        let is_there = |of| self.maps.iter().any(|(map, _)| map.of == of);
        match of {
            MapOf::Specular | MapOf::Exponent if self.physical.is_some() => {
                Some("beside `Pr` and `Pm`")
            }
            MapOf::Displacement if is_there(MapOf::Bump) => Some("beside `bump`"),
            MapOf::Displacement if is_there(MapOf::Normal) => Some("beside `norm`"),
            _ => None,
        }
    }
}

/// What the images say that could be read.
#[derive(Debug, Default)]
pub(super) struct Maps {
    pub(super) ambient: Option<TextureRef>,
    pub(super) diffuse: Option<TextureRef>,
    pub(super) specular: Option<TextureRef>,
    pub(super) emission: Option<TextureRef>,
    pub(super) exponent: Option<TextureRef>,
    pub(super) dissolve: Option<TextureRef>,
    pub(super) bump: Option<TextureRef>,
    pub(super) normal: Option<TextureRef>,
    pub(super) roughness: Option<TextureRef>,
    /// How metallic it is everywhere or in the mean, where an image says so.
    pub(super) metal: Option<f64>,
    /// Where that varies: what it scatters and what it mirrors.
    pub(super) parts: Option<[TextureRef; 2]>,
    /// Whether the image that says the diffuse colour could not be read.
    pub(super) lost: bool,
}

/// An image that a statement names, and that could be read.
pub(super) struct Drawn<'a> {
    pub(super) map: &'a Map,
    pub(super) span: &'a Span,
    pub(super) texels: Arc<Texels>,
}

impl Maps {
    /// Reads the images of a material, and says which of them cannot be read.
    pub(super) fn read(
        said: &Said<'_>,
        file: &str,
        images: &mut Images<'_>,
        findings: &mut Findings,
    ) -> Self {
        let mut maps = Self::default();
        let mut all = Vec::new();
        for (map, span) in said.maps {
            if let Some(why) = said.not_drawn(map.of) {
                let tell = || format!("`{}` of `{}` is not drawn {why}", map.of.word(), map.name);
                findings.warning("textures", || span.clone(), tell);
                continue;
            }
            let texels = match load(&map.name, file, images, (span, findings)) {
                Ok(texels) => texels,
                Err(message) => {
                    maps.lost |= map.of == MapOf::Diffuse;
                    findings.warning(
                        "images that cannot be read",
                        || span.clone(),
                        || format!("the image `{}` cannot be read: {message}", map.name),
                    );
                    continue;
                }
            };
            let drawn = Drawn { map, span, texels };
            drawn.tell_of_options(findings);
            if map.of == MapOf::Displacement {
                let tell =
                    || format!("`disp` of `{}` is drawn as `bump`: nothing is moved", map.name);
                findings.warning("displacements", || span.clone(), tell);
            }
            maps.take(said, &drawn, images);
            all.push(drawn);
        }
        if let Some(physical) = &said.physical {
            maps.take_physical((said.name, physical), &all, images, findings);
        }
        maps
    }

    fn take(&mut self, said: &Said<'_>, drawn: &Drawn<'_>, images: &mut Images<'_>) {
        let Drawn { map, texels, .. } = drawn;
        // Black is what programs write beside an image that says it all.
        let tint = |color: Option<Rgb>| color.filter(|c| !c.is_black()).unwrap_or(Rgb::WHITE);
        let is_normal = map.of == MapOf::Normal || map.of == MapOf::Bump && is_blue(texels);
        let has_opacity = texels.channels().is_multiple_of(2);
        let tint = match map.of {
            MapOf::Ambient => tint(said.ambient),
            MapOf::Diffuse => tint(said.diffuse),
            MapOf::Specular => tint(said.specular),
            MapOf::Emission => tint(said.emission),
            MapOf::Roughness | MapOf::Metallic | MapOf::Reflection | MapOf::Other => return,
            _ => Rgb::WHITE,
        };
        let of = if is_normal { MapOf::Normal } else { map.of };
        let name = format!("{} {}", said.name, of.word());
        let texture = drawn.texture(name, Arc::clone(texels), tint, images);
        let by = TextureRef {
            texture,
            scale: map.gain as f32,
            offset: map.base as f32,
            channel: map.channel,
        };
        let number = |scale: f64, channel| TextureRef {
            scale: (map.gain * scale) as f32,
            offset: (map.base * scale) as f32,
            channel: map.channel.or(channel),
            ..by
        };
        match of {
            MapOf::Ambient => self.ambient = Some(by),
            MapOf::Diffuse => self.diffuse = Some(by),
            MapOf::Specular => self.specular = Some(by),
            MapOf::Emission => self.emission = Some(by),
            MapOf::Exponent => {
                self.exponent = Some(number(said.exponent.unwrap_or(32.0).max(0.0).into(), None));
            }
            MapOf::Dissolve => {
                let shown = said.dissolve.unwrap_or(1.0).clamp(0.0, 1.0);
                self.dissolve = Some(number(shown.into(), has_opacity.then_some(Channel::Alpha)));
            }
            MapOf::Normal => {
                self.normal = Some(TextureRef { scale: map.bump as f32, offset: 0.0, ..by });
            }
            _ => self.bump = Some(number(map.bump * BUMP, None)),
        }
    }
}

impl Drawn<'_> {
    /// These pixels as a texture that lies as the image does.
    pub(super) fn texture(
        &self,
        name: String,
        texels: Arc<Texels>,
        tint: Rgb,
        images: &mut Images<'_>,
    ) -> TextureId {
        let Self { map, span, .. } = self;
        images.push(Texture {
            name,
            kind: TextureKind::Image {
                file: map.name.clone(),
                texels,
                wrap: if map.clamp { Wrap::Clamp } else { Wrap::Repeat },
                wrap_v: None,
                border: Rgb::BLACK,
                tint,
                filter: TexelFilter::Auto,
                encoding: Encoding::Auto,
            },
            space: TextureSpace::Uv,
            transform: placed(map).unwrap_or_default(),
            place: span.place.clone(),
        })
    }

    fn tell_of_options(&self, findings: &mut Findings) {
        let Self { map, span, .. } = self;
        let mut ignored = map.ignored.clone();
        if placed(map).is_none() {
            let [u, v, _] = map.scale;
            ignored.push(format!("-s {u} {v}"));
        }
        for option in ignored {
            let tell = || format!("`{option}` of the image `{}` is not drawn", map.name);
            findings.warning("options of images", || (*span).clone(), tell);
        }
    }
}

/// Where an image lies for `-s` and `-o`, which are of texture coordinates; `None`: it lies nowhere, as it has no
/// extent.
fn placed(map: &Map) -> Option<DAffine3> {
    let ([u, v, _], [x, y, _]) = (map.scale, map.offset);
    let from = DAffine3 {
        matrix3: glam::DMat3::from_diagonal(DVec3::new(u, v, 1.0)),
        translation: DVec3::new(x, y, 0.0),
    };
    if from == DAffine3::IDENTITY {
        return Some(from);
    }
    let is_there = u != 0.0 && v != 0.0;
    is_there.then(|| from.inverse()).filter(DAffine3::is_finite)
}

/// Whether an image is one of normals, which many programs write as `map_Bump`: blue, with red and green about
/// the middle.
fn is_blue(texels: &Texels) -> bool {
    if texels.channels() < 3 {
        return false;
    }
    let [r, g, b, _] = texels.mean(false);
    b > 0.7 && (0.4..0.6).contains(&r) && (0.4..0.6).contains(&g)
}

/// The image of that name beside the file at `file`.
fn load(
    name: &str,
    file: &str,
    images: &mut Images<'_>,
    (span, findings): (&Span, &mut Findings),
) -> Result<Arc<Texels>, String> {
    if name.is_empty() {
        return Err("it is not named".to_owned());
    }
    let path = locate(name, file, images.source).ok_or("there is no such file")?;
    if let Some(read) = images.read.get(&path) {
        return read.clone();
    }
    let limits = images.left();
    let mut warn = |message: String| {
        let tell = || format!("the image `{name}`: {message}");
        findings.warning("images that are not wholly drawn", || span.clone(), tell);
    };
    let read = texels::load(&path, images.source, &limits, &mut warn);
    images.read.insert(path, read.clone());
    read
}

/// Where a file of that name is; `None`: nowhere.
pub(crate) fn locate(name: &str, path: &str, source: &dyn Source) -> Option<String> {
    let folder = path.rfind('/').map_or("", |end| &path[..=end]);
    let name = name.trim_matches('"').replace('\\', "/");
    let drive = name.as_bytes().get(1) == Some(&b':');
    let written =
        if name.starts_with('/') || drive { name.clone() } else { format!("{folder}{name}") };
    let bare = name.rsplit('/').next().unwrap_or(&name);
    let beside = format!("{folder}{bare}");
    // Where the file's name is in another encoding than the text, its bytes are the letters'.
    let bytes = |path: &String| -> String {
        let letter = |c: char| match u8::try_from(c) {
            Ok(byte) if !c.is_ascii() => byte_letter(byte),
            _ => c,
        };
        path.chars().map(letter).collect()
    };
    let named = [bytes(&written), bytes(&beside)];
    let all = [written, beside].into_iter().chain(named);
    all.into_iter().find(|at| !name.is_empty() && source.open(at).is_ok())
}
