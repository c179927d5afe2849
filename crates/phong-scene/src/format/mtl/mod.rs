//! Wavefront MTL: the materials of OBJ files.
//!
//! Read by the specification of 1995 (Alias|Wavefront, version 4.2). The model is Blinn and
//! Phong's `(N·H)^Ns` in [`Dialect::Mtl`](crate::Dialect::Mtl): `Ka Ia + Σ (Kd (N·L) + Ks (N·H)^Ns) I`.
//! Colours are linear; g and b default to r. Above 1 they are a warning; if all of the file's are
//! whole numbers up to 255 and one is at least 2, they are bytes.
//!
//! | statement | becomes |
//! |---|---|
//! | `Kd` | `color`, with `k_d` 1; without it, or where it is black beside a `map_Kd`, 0.8 |
//! | `Ka` | `ambient_color`, with `k_a` 1; white is the filler of programs that have none and is taken times Kd, as other readers do; without it `k_a` is 0.1 of the diffuse colour |
//! | `Ks`, `Ns` | `specular_color`, with `k_s` 1 if it is not black; `shininess`, 32 without it; an exponent of 0 or below means no highlight |
//! | `Ke` | `emission_color`, with `k_e` 1 if it is not black: it is seen, and sheds no light |
//! | `d`, `Tr` | `Tr` is not in the specification: 1 − d, unless `d` stands beside it; `Tr 1` alone is opaque, since programs write it so |
//! | `Ni` | `ior` |
//! | `Tf` | the filter of `transmission`; white without it |
//! | `illum` | see below; without it 2 where there is a highlight, else 1 |
//!
//! | `illum` | becomes |
//! |---|---|
//! | 0 | as 1, with a warning: unlit colour is not there |
//! | 1 | Lambert; a `Ks` keeps its highlight, with a warning (the specification's own example has one) |
//! | 2, 8 | the model above |
//! | 3 | and `reflection` = Ks, times `map_Ks` |
//! | 4 | as 3; what `d` lets through is seen as below |
//! | 5 | as 3 with `fresnel`: the mirror ray is weighted by the exact dielectric reflectance of `Ni` |
//! | 6 | as 3, and `transmission` = (1 − Ks) Tf, refracted by `Ni`, without `fresnel` |
//! | 7 | as 6 with `fresnel` |
//! | 9 | as 2; what `d` lets through is seen as below |
//! | 10 | as 2, with a warning: a matte that shows shadows alone is not there |
//!
//! **`d` below 1** mixes the surface with what is behind it: all local terms are weighted by d,
//! and, unless `illum` 6 or 7 refract, `transmission` = (1 − d) Tf goes straight on (`ior` 1).
//!
//! **`Pr`, `Pm`** of the physically based extension, where one is above 0 or has an image, make the surface that of
//! glTF: GGX with α = `Pr`², Smith, Schlick, over `Kd`, of which `Pm` is metal. F₀ is that of an `Ni` above 1, else
//! 0.04. Without `Pr` α² is 2/(`Ns` + 2). `Ks`, `Ns` and the mirrors of `illum` are then not drawn; nor a white `Ka`,
//! in place of which ambient light has a weight of 0.1, of metals 0.4.
//!
//! **Images** are found beside the MTL file if they are not where it says, and repeat unless `-clamp on`; `-s` and `-o`
//! are of texture coordinates, `-mm` of values. What cannot be read is a warning, and grey.
//!
//! | statement | becomes |
//! |---|---|
//! | `map_Kd`, `map_Ks`, `map_Ke` | a texture of `color`, of `specular_color`, of `emission_color`: times `Kd`, `Ks`, `Ke`, unless they are black |
//! | `map_Ka` | of `ambient_color`, if `Ka` is said and not white; else a warning, unless it is that of `map_Kd` |
//! | `map_Ns` | of `shininess`, times `Ns` |
//! | `map_d` | of `opacity`, times `d` or 1 − `Tr`: by the image's own opacity, or else its red, unless `-imfchan` (`l`: the luminance) |
//! | `map_Pr`, `map_Pm` | of α, and of what is scattered and mirrored, in place of `Pr` and `Pm`: an image beside which `map_Kd` lies differently, or is not as it is (`-mm`, `-imfchan`), counts by its mean, with a warning |
//! | `norm`; `bump`, `map_Bump` | `normal`, times `-bm`; `bump`, of which 1 is a hundredth of a unit; an image of normals is one by either name |
//! | `disp` | `bump`, where there is neither that nor `norm`, with a warning: surfaces stay where they are |
//!
//! Other textures (of `refl` the warning says what comes near: an image as the scene's sky), the options `-t`,
//! `-boost`, `-cc` and `-imfchan z`, `-halo`, spectral and XYZ colours, and of the physically based extension sheen,
//! coats and anisotropy (`Ps`, `Pc`, `aniso`) are not drawn; each is a warning that names it.

mod draft;
mod maps;
mod physical;
mod texture;
mod write;

use std::collections::BTreeMap;
use std::sync::Arc;

pub(crate) use maps::{Images, locate};
pub(crate) use write::{Difference, write as write_material};

use self::draft::Draft;
use self::maps::Maps;
use self::texture::MapOf;
use super::text::{Cursor, Decimal, Findings, Piece, blame, name_of, read_text, whole};
use crate::color::{Rgb, are_bytes};
use crate::diagnostic::Diagnostic;
use crate::limits::{LARGEST, Limits};
use crate::material::Material;
use crate::source::{Source, trouble};

/// An MTL file, whose materials are made, and told of, as they are asked for: nothing is said of
/// those that nothing uses.
#[derive(Debug)]
pub(crate) struct Library {
    file: Arc<str>,
    drafts: Vec<Draft>,
    /// The drafts of each name, of which the first counts.
    numbers: BTreeMap<String, Vec<usize>>,
    /// Whether its colours are bytes.
    bytes: bool,
    findings: Findings,
}

impl Library {
    /// Reads an MTL file; `None` if it cannot be read, which has been said.
    pub(crate) fn read(
        path: &str,
        source: &dyn Source,
        limits: &Limits,
        out: &mut Vec<Diagnostic>,
    ) -> Option<Self> {
        let file: Arc<str> = path.into();
        let text = match read_text(source, path, limits) {
            Ok(text) => text,
            Err(error) => {
                let message = format!("cannot be read: {}", trouble(&error));
                out.push(Diagnostic::warning(message, whole(&file)));
                return None;
            }
        };
        let mut reader = Reader { file: &file, drafts: Vec::new(), findings: Findings::default() };
        let piece = Piece { text: &text, offset: 0, line: 1, rows: 0 };
        let mut cursor = Cursor::new(piece, false);
        while !cursor.is_done() {
            if cursor.more() {
                reader.statement(&mut cursor);
            }
            cursor.next_line();
        }
        let Reader { drafts, findings, .. } = reader;
        let mut numbers: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (number, draft) in drafts.iter().enumerate() {
            numbers.entry(draft.name.clone()).or_default().push(number);
        }
        let bytes = drafts.iter().any(Draft::is_brighter_than_white)
            && are_bytes(drafts.iter().flat_map(Draft::colors));
        Some(Self { file, drafts, numbers, bytes, findings })
    }

    /// The names of its materials.
    pub(crate) fn names(&self) -> impl Iterator<Item = &String> {
        self.numbers.keys()
    }

    /// The material of this name; `None`: the file defines none.
    pub(crate) fn material(&mut self, name: &str, images: &mut Images<'_>) -> Option<Material> {
        let (&number, again) = self.numbers.get(name)?.split_first()?;
        if self.bytes {
            self.findings.warning(
                "colours read as bytes",
                || whole(&self.file),
                || {
                    "all colours are whole numbers up to 255, some above 1: they are read as bytes"
                        .to_owned()
                },
            );
            // Said once is enough.
            self.bytes = false;
            self.drafts.iter_mut().for_each(Draft::divide_colors);
        }
        let line = self.drafts[number].span.place.line;
        for &again in again {
            self.findings.warning(
                "materials defined before",
                || self.drafts[again].span.clone(),
                || format!("the material `{name}` is defined on line {line}, which counts"),
            );
        }
        let draft = &mut self.drafts[number];
        self.findings.append(std::mem::take(&mut draft.findings));
        let draft = &self.drafts[number];
        let maps = Maps::read(&draft.said(), &self.file, images, &mut self.findings);
        Some(draft.finish(&maps, &mut self.findings))
    }

    /// Everything there is to say about what was asked for.
    pub(crate) fn tell(self, out: &mut Vec<Diagnostic>) {
        self.findings.tell(&self.file, out);
    }
}

struct Reader<'a> {
    file: &'a Arc<str>,
    drafts: Vec<Draft>,
    /// What was found before the first material.
    findings: Findings,
}

impl Reader<'_> {
    fn statement(&mut self, cursor: &mut Cursor<'_>) {
        let here = cursor.clone();
        let keyword = cursor.word();
        if keyword == b"newmtl" {
            let name = name_of(cursor.rest_of_line());
            self.drafts.push(Draft::new(name, here.here(self.file)));
            return;
        }
        if self.drafts.is_empty() {
            self.warn(&here, "statements before any `newmtl`", |word| {
                format!("`{word}` stands before any `newmtl`")
            });
            return;
        }
        match keyword {
            b"Ka" => self.color(cursor, |draft| &mut draft.ambient),
            b"Kd" => self.color(cursor, |draft| &mut draft.diffuse),
            b"Ks" => self.color(cursor, |draft| &mut draft.specular),
            b"Tf" => self.color(cursor, |draft| &mut draft.filter),
            b"Ke" => self.color(cursor, |draft| &mut draft.emission),
            b"Ns" => self.number(cursor, |draft, value| draft.exponent = Some(value)),
            b"Ni" => self.number(cursor, |draft, value| draft.index = Some(value)),
            b"Tr" => self.number(cursor, |draft, value| draft.transparency = Some(value)),
            b"d" => {
                if cursor.more() && cursor.rest().starts_with(b"-halo") {
                    cursor.word();
                    self.warn(&here, "halos", |_| {
                        "`-halo` is not drawn: the material dissolves evenly".to_owned()
                    });
                }
                self.number(cursor, |draft, value| draft.dissolve = Some(value));
            }
            b"illum" => self.illum(cursor),
            b"Pr" => self.number(cursor, |draft, value| draft.roughness = Some(value)),
            b"Pm" => self.number(cursor, |draft, value| draft.metallic = Some(value)),
            // How rough a coat is, and where facets are turned: nothing without `Pc` and `aniso`.
            b"sharpness" | b"Pcr" | b"anisor" => {}
            b"Ps" | b"Pc" | b"aniso" => {
                let mut value = None;
                self.color_into(cursor, &mut value);
                if value.is_some_and(|c| c.r != 0.0) {
                    self.warn(&here, "statements of the physically based extension", |word| {
                        format!("`{word}` is of the physically based extension and not used")
                    });
                }
            }
            _ => match texture::statement(keyword, cursor.rest_of_line()) {
                Some(map) if matches!(map.of, MapOf::Other | MapOf::Reflection) => {
                    self.warn(&here, "textures", |word| {
                        let end = match map.of {
                            MapOf::Reflection => "; a scene that names this model as a `[[mesh]]` can show it as `[sky] kind = \"image\"`",
                            _ => "",
                        };
                        format!("`{word}` of `{}` is not drawn{end}", map.name)
                    });
                }
                Some(map) => {
                    let span = here.here(self.file);
                    if let Some(draft) = self.drafts.last_mut() {
                        draft.maps.retain(|(other, _)| other.of != map.of);
                        draft.maps.push((map, span));
                    }
                }
                None => self.warn(&here, "statements that are not known", |word| {
                    format!("the statement `{word}` is not known")
                }),
            },
        }
    }

    fn color(&mut self, cursor: &mut Cursor<'_>, place: impl Fn(&mut Draft) -> &mut Option<Rgb>) {
        let mut color = None;
        self.color_into(cursor, &mut color);
        if let (Some(draft), Some(color)) = (self.drafts.last_mut(), color) {
            *place(draft) = Some(color);
        }
    }

    /// One to three numbers, of which those that are not there are like the first; or a way to say
    /// a colour that is not read.
    fn color_into(&mut self, cursor: &mut Cursor<'_>, color: &mut Option<Rgb>) {
        cursor.more();
        if cursor.rest().starts_with(b"spectral") || cursor.rest().starts_with(b"xyz") {
            self.warn(cursor, "spectral and XYZ colours", |word| {
                format!("`{word}` colours are not read: the default stands in for it")
            });
            return;
        }
        let mut channels = [0.0; 3];
        let mut count = 0;
        while count == 0 || count < 3 && cursor.more() {
            let here = cursor.clone();
            let Some(mut value) = self.read_number(cursor) else { return };
            if value < 0.0 {
                self.warn(&here, "negative colours", |word| {
                    format!("a colour must not be negative: `{word}` is read as 0")
                });
                value = 0.0;
            }
            channels[count] = value.min(LARGEST as f32);
            count += 1;
        }
        let first = channels[0];
        channels[count..].fill(first);
        *color = Some(Rgb::from(channels));
    }

    fn number(&mut self, cursor: &mut Cursor<'_>, place: impl Fn(&mut Draft, f32)) {
        if let Some(value) = self.read_number(cursor)
            && let Some(draft) = self.drafts.last_mut()
        {
            place(draft, value);
        }
    }

    /// A finite number, or an error that says why there is none.
    fn read_number(&mut self, cursor: &mut Cursor<'_>) -> Option<f32> {
        let something = cursor.more();
        let here = cursor.clone();
        let value = cursor.decimal().map(Decimal::to_f32);
        if value.is_some_and(f32::is_finite) {
            return value;
        }
        let file = self.file;
        self.found().error(
            "numbers that cannot be read",
            || here.here(file),
            || match value {
                _ if !something => "a number is missing".to_owned(),
                Some(_) => format!("`{}` is too large", here.quote()),
                None => format!("`{}` {}", here.quote(), blame(here.rest())),
            },
        );
        None
    }

    fn illum(&mut self, cursor: &mut Cursor<'_>) {
        cursor.more();
        let here = cursor.clone();
        match cursor.decimal().and_then(Decimal::to_integer).and_then(|n| u8::try_from(n).ok()) {
            Some(number @ 0..=10) => {
                if let Some(draft) = self.drafts.last_mut() {
                    draft.illum = Some((number, here.here(self.file)));
                }
            }
            _ => self.warn(&here, "illumination models that are not known", |word| match &*word {
                "" => "`illum` has no number".to_owned(),
                _ => format!("there is no illumination model `{word}`: 0 to 10 are defined"),
            }),
        }
    }

    fn warn(&mut self, at: &Cursor<'_>, plural: &'static str, tell: impl FnOnce(String) -> String) {
        let file = self.file;
        self.found().warning(plural, || at.here(file), || tell(at.quote()));
    }

    /// Where what is found here belongs: to the material, if it stands behind a `newmtl`.
    fn found(&mut self) -> &mut Findings {
        match self.drafts.last_mut() {
            Some(draft) => &mut draft.findings,
            None => &mut self.findings,
        }
    }
}
