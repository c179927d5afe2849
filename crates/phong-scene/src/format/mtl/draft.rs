//! A material as its statements say it, and what it becomes.

use crate::color::Rgb;
use crate::diagnostic::Span;
use crate::format::text::Findings;
use crate::material::{Dialect, Material, Model};

/// What the statements behind one `newmtl` say.
#[derive(Debug)]
pub(super) struct Draft {
    name: String,
    span: Span,
    pub(super) ambient: Option<Rgb>,
    pub(super) diffuse: Option<Rgb>,
    pub(super) specular: Option<Rgb>,
    pub(super) filter: Option<Rgb>,
    pub(super) exponent: Option<f32>,
    pub(super) index: Option<f32>,
    pub(super) dissolve: Option<f32>,
    pub(super) transparency: Option<f32>,
    pub(super) illum: Option<(u8, Span)>,
}

impl Draft {
    pub(super) fn new(name: String, span: Span) -> Self {
        Self {
            name,
            span,
            ambient: None,
            diffuse: None,
            specular: None,
            filter: None,
            exponent: None,
            index: None,
            dissolve: None,
            transparency: None,
            illum: None,
        }
    }

    /// The material, as the module's tables say.
    pub(super) fn finish(self, findings: &mut Findings) -> Material {
        let k_s = self.specular.unwrap_or(Rgb::BLACK);
        let highlight = !k_s.is_black();
        let illum = self.illum.as_ref().map_or(if highlight { 2 } else { 1 }, |(n, _)| *n);
        let exponent = self.in_range("Ns", self.exponent.unwrap_or(32.0), 0.0, f32::MAX, findings);
        let ior = self.index_of_refraction(findings);
        let opacity = self.opacity(findings);
        self.warn_of_model(illum, highlight, findings);

        let filter = self.filter.unwrap_or(Rgb::WHITE);
        let mirrors = matches!(illum, 3..=7);
        let refracts = matches!(illum, 6 | 7);
        let transmission = if refracts {
            (Rgb::WHITE - k_s).map(|c| c.max(0.0)) * filter
        } else {
            (1.0 - opacity) * filter
        };
        Material {
            name: self.name,
            model: if highlight { Model::BlinnPhong } else { Model::Lambert },
            color: self.diffuse.unwrap_or(Rgb::grey(0.8)),
            ambient_color: self.ambient,
            specular_color: Some(if highlight { k_s } else { Rgb::WHITE }),
            k_a: opacity * if self.ambient.is_some() { 1.0 } else { 0.1 },
            k_d: opacity,
            k_s: if highlight { opacity } else { 0.0 },
            shininess: exponent,
            reflection: if mirrors { k_s } else { Rgb::BLACK },
            transmission,
            ior: if refracts || illum == 5 { ior } else { 1.0 },
            fresnel: matches!(illum, 5 | 7),
            dialect: Dialect::Mtl,
            place: self.span.place,
            ..Material::default()
        }
    }

    /// `d`, or 1 − `Tr`; 1 where neither is said.
    fn opacity(&self, findings: &mut Findings) -> f32 {
        let opacity = match (self.dissolve, self.transparency) {
            (None, None) => 1.0,
            (Some(d), None) => d,
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

    fn index_of_refraction(&self, findings: &mut Findings) -> f32 {
        match self.index {
            // Written by programs that have none to give.
            Some(index) if index <= 0.0 => {
                self.warn("indices of refraction", findings, || {
                    format!("`Ni` must be above 0: {index} is read as 1.5")
                });
                1.5
            }
            index => index.unwrap_or(1.5),
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

    fn in_range(
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
