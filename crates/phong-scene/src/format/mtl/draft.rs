//! A material as its statements say it, and what it becomes.

use super::maps::{Maps, Physical, Said};
use super::texture::{Map, MapOf};
use crate::color::Rgb;
use crate::diagnostic::Span;
use crate::format::text::Findings;
use crate::limits::LARGEST;
use crate::material::{ConstantMaterial, Dialect, Material, Model, PLAIN};

/// What the statements behind one `newmtl` say.
#[derive(Debug)]
pub(super) struct Draft {
    pub(super) name: String,
    /// Where `newmtl` stands.
    pub(super) span: Span,
    pub(super) ambient: Option<Rgb>,
    pub(super) diffuse: Option<Rgb>,
    pub(super) specular: Option<Rgb>,
    pub(super) emission: Option<Rgb>,
    pub(super) filter: Option<Rgb>,
    pub(super) exponent: Option<f32>,
    pub(super) index: Option<f32>,
    pub(super) dissolve: Option<f32>,
    pub(super) transparency: Option<f32>,
    pub(super) illum: Option<(u8, Span)>,
    pub(super) roughness: Option<f32>,
    pub(super) metallic: Option<f32>,
    /// The images that it names, and where.
    pub(super) maps: Vec<(Map, Span)>,
    /// What was found in its statements.
    pub(super) findings: Findings,
}

impl Draft {
    pub(super) fn new(name: String, span: Span) -> Self {
        Self {
            name,
            span,
            ambient: None,
            diffuse: None,
            specular: None,
            emission: None,
            filter: None,
            exponent: None,
            index: None,
            dissolve: None,
            transparency: None,
            illum: None,
            roughness: None,
            metallic: None,
            maps: Vec::new(),
            findings: Findings::default(),
        }
    }

    /// What its images are beside.
    pub(super) fn said(&self) -> Said<'_> {
        let Self { name, maps, ambient, diffuse, specular, emission, .. } = self;
        // `Tr 1` without `d` is what programs write of opaque materials.
        let transparency = self.transparency.filter(|tr| *tr != 1.0);
        Said {
            name,
            maps,
            ambient: *ambient,
            diffuse: *diffuse,
            specular: *specular,
            emission: *emission,
            exponent: self.exponent,
            dissolve: self.dissolve.or(transparency.map(|tr| 1.0 - tr)),
            // What is out of range is told where the material is made.
            physical: self.physical(&mut Findings::default()),
        }
    }

    /// The colours that its statements give.
    pub(super) fn colors(&self) -> impl Iterator<Item = Rgb> {
        let Self { ambient, diffuse, specular, emission, filter, .. } = self;
        [*ambient, *diffuse, *specular, *emission, *filter].into_iter().flatten()
    }

    /// Whether it scatters more light than falls on it. Other colours may be larger than 1: lamps have
    /// an ambient colour of 20.
    pub(super) fn is_brighter_than_white(&self) -> bool {
        self.diffuse.is_some_and(|color| color.max_channel() > 1.0)
    }

    /// Takes colours as counted up to 255.
    pub(super) fn divide_colors(&mut self) {
        let Self { ambient, diffuse, specular, emission, filter, .. } = self;
        for color in [ambient, diffuse, specular, emission, filter] {
            *color = color.map(|color| color / 255.0);
        }
    }

    /// The material, as the module's tables say.
    pub(super) fn finish(&self, maps: &Maps, findings: &mut Findings) -> Material {
        self.warn_of_bright_colors(findings);
        let k_s = match self.specular {
            Some(color) if !color.is_black() => color,
            _ if maps.specular.is_some() => Rgb::WHITE,
            _ => Rgb::BLACK,
        };
        let physical = self.physical(findings);
        let is_plain = physical.is_none();
        let highlight = is_plain && !k_s.is_black() && !self.has_no_highlight(findings);
        let illum = self.illum.as_ref().map_or(if highlight { 2 } else { 1 }, |(n, _)| *n);
        let most = LARGEST as f32;
        let exponent = self.in_range("Ns", self.exponent.unwrap_or(32.0), 0.0, most, findings);
        let ior = self.index_of_refraction(findings);
        // An image mixes the surface with what is behind it by itself.
        let opacity = self.opacity(findings);
        let opacity = if maps.dissolve.is_some() { 1.0 } else { opacity };
        self.warn_of_model(illum, highlight, findings);

        let filter = self.filter.unwrap_or(Rgb::WHITE);
        let mirrors = is_plain && matches!(illum, 3..=7);
        let refracts = matches!(illum, 6 | 7);
        let transmission = if refracts {
            // Not of the white that stands for an image.
            (Rgb::WHITE - self.specular.unwrap_or(Rgb::BLACK)).map(|c| c.max(0.0)) * filter
        } else {
            (1.0 - opacity) * filter
        };
        let diffuse = match self.diffuse {
            // The image would say it; black or white would hide that there is one.
            Some(color) if (color.is_black() || color == Rgb::WHITE) && maps.lost => None,
            color => color,
        };
        // White is what programs write that have no ambient colour to give.
        let ambient = self.ambient.filter(|&color| color != Rgb::WHITE);
        let emission = self.emission.filter(|color| !color.is_black());
        let constant = ConstantMaterial {
            name: self.name.clone(),
            model: if highlight { Model::BlinnPhong } else { Model::Lambert },
            color: diffuse.unwrap_or(PLAIN),
            ambient_color: ambient,
            specular_color: Some(if highlight { k_s } else { Rgb::WHITE }),
            k_a: opacity * if self.ambient.is_some() { 1.0 } else { 0.1 },
            k_d: opacity,
            k_s: if highlight { opacity } else { 0.0 },
            k_e: if emission.is_some() || maps.emission.is_some() { opacity } else { 0.0 },
            emission_color: emission,
            shininess: exponent,
            reflection: if mirrors { k_s } else { Rgb::BLACK },
            transmission,
            ior: if refracts || illum == 5 { ior } else { 1.0 },
            fresnel: matches!(illum, 5 | 7),
            dialect: Dialect::Mtl,
            place: self.span.place.clone(),
            ..ConstantMaterial::default()
        };
        let mut material = Material::from(constant);
        if let Some(by) = maps.diffuse {
            material.color = by.into();
        }
        match (ambient, maps.ambient) {
            (Some(_), Some(by)) => material.ambient_color = Some(by.into()),
            (None, Some(_)) => self.warn_of_ambient_image(findings),
            _ => {}
        }
        if let (true, Some(by)) = (highlight, maps.specular) {
            material.specular_color = Some(by.into());
        }
        if let (true, Some(by)) = (mirrors, maps.specular) {
            material.reflection = by.into();
        }
        if let Some(by) = maps.emission {
            material.emission_color = Some(by.into());
        }
        if let Some(by) = maps.exponent {
            material.shininess = by.into();
        }
        if let Some(by) = maps.dissolve {
            material.opacity = by.into();
        }
        if let Some(physical) = physical {
            let base = diffuse.unwrap_or(PLAIN);
            Physical { base, ..physical }.put(&mut material, maps, opacity);
        }
        (material.normal, material.bump) = (maps.normal, maps.bump);
        material
    }

    /// `d`, or 1 − `Tr`; 1 where neither is said.
    fn opacity(&self, findings: &mut Findings) -> f32 {
        let opacity = match (self.dissolve, self.transparency) {
            (None, None) => 1.0,
            (Some(d), None) => d,
            (None, Some(1.0)) => {
                self.warn("`Tr 1` without `d`", findings, || {
                    "`Tr 1` would be invisible; it is read as opaque, since programs write it so"
                        .to_owned()
                });
                1.0
            }
            (None, Some(tr)) => 1.0 - tr,
            (Some(d), Some(tr)) => {
                if (1.0 - tr - d).abs() > 0.01 {
                    self.warn("opacities that disagree", findings, || {
                        format!("`d {d}` and `Tr {tr}` disagree: `d` counts")
                    });
                }
                d
            }
        };
        let opacity = self.in_range("d", opacity, 0.0, 1.0, findings);
        if opacity == 0.0 {
            self.warn("invisible materials", findings, || {
                "the material is wholly transparent (some programs write `Tr` for `d`)".to_owned()
            });
        }
        opacity
    }

    /// Whether the exponent says that there is no highlight, as programs write it.
    fn has_no_highlight(&self, findings: &mut Findings) -> bool {
        let Some(exponent) = self.exponent.filter(|&exponent| exponent <= 0.0) else {
            return false;
        };
        self.warn("exponents that are not above 0", findings, || {
            format!("`Ns {exponent}` leaves no highlight: `Ks` is not drawn")
        });
        true
    }

    fn warn_of_bright_colors(&self, findings: &mut Findings) {
        let names = ["Ka", "Kd", "Ks", "Tf"];
        let colors = [self.ambient, self.diffuse, self.specular, self.filter];
        for (name, color) in names.into_iter().zip(colors) {
            let Some(color) = color.filter(|color| color.max_channel() > 1.0) else { continue };
            self.warn("colours above 1", findings, || {
                let [r, g, b] = color.to_array();
                format!("`{name} {r} {g} {b}` is above 1: it gives back more light than there is")
            });
        }
    }

    /// Says that the image of the ambient colour is not drawn, unless it is that of the diffuse one, which counts.
    fn warn_of_ambient_image(&self, findings: &mut Findings) {
        let of = |wanted| self.maps.iter().find(|(map, _)| map.of == wanted);
        let Some((ambient, span)) = of(MapOf::Ambient) else { return };
        let is_drawn = of(MapOf::Diffuse)
            .is_some_and(|(diffuse, _)| *ambient == Map { of: MapOf::Ambient, ..diffuse.clone() });
        if !is_drawn {
            findings.warning(
                "images of ambient colours",
                || span.clone(),
                || {
                    let Map { name, .. } = ambient;
                    format!("`map_Ka` of `{name}` is drawn only beside a `Ka` that is not white")
                },
            );
        }
    }

    fn index_of_refraction(&self, findings: &mut Findings) -> f32 {
        match self.index {
            // Written by programs that have none to give.
            Some(index) if index <= 0.0 => {
                self.warn("indices of refraction", findings, || {
                    format!("`Ni` must be above 0: {index} is read as 1.5")
                });
                1.5
            }
            index => {
                let most = Material::IOR.max as f32;
                self.in_range("Ni", index.unwrap_or(1.5), 0.0, most, findings)
            }
        }
    }

    fn warn_of_model(&self, illum: u8, highlight: bool, findings: &mut Findings) {
        let message = match illum {
            0 => "`illum 0` (unlit) is not there: the material is lit as with `illum 1`",
            1 if highlight => "`illum 1` has no highlight, but `Ks` is set: the highlight is kept",
            10 => {
                "`illum 10` (shadows alone) is not there: the material is drawn as with `illum 2`"
            }
            _ => return,
        };
        let span = self.illum.as_ref().map_or(&self.span, |(_, span)| span);
        findings.warning("illumination models", || span.clone(), || message.to_owned());
    }

    pub(super) fn in_range(
        &self,
        what: &str,
        value: f32,
        low: f32,
        high: f32,
        findings: &mut Findings,
    ) -> f32 {
        let clamped = value.clamp(low, high);
        if clamped != value {
            self.warn("values out of range", findings, || {
                let bound = if value < low { "below" } else { "above" };
                format!("`{what}` must not be {bound} {clamped}: {value} is read as {clamped}")
            });
        }
        clamped
    }

    fn warn(&self, plural: &'static str, findings: &mut Findings, tell: impl FnOnce() -> String) {
        findings.warning(
            plural,
            || self.span.clone(),
            || format!("{} (material `{}`)", tell(), self.name),
        );
    }
}
