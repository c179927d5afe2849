//! The parameters of a material one by one, whatever they are.

use std::cell::{RefCell, RefMut};

use super::{Distribution, Fresnel, Material, Model};
use crate::texture::{Param, TextureId, TextureRef, TextureUse};

impl Material {
    /// The parameters that take their values from textures, by their keys in the text.
    pub fn textured(&self) -> Vec<(&'static str, TextureRef)> {
        let textured = RefCell::new(Vec::new());
        let note = |key, by: Option<TextureRef>| {
            let mut noted: RefMut<'_, Vec<(&'static str, TextureRef)>> = textured.borrow_mut();
            // The exponent of Blinn's facets is their roughness too.
            if !noted.iter().any(|&(other, _)| other == key) {
                noted.extend(by.map(|by| (key, by)));
            }
        };
        let _: Material<(), ()> =
            self.map(|key, n| note(key, n.texture()), |key, c| note(key, c.texture()));
        note("normal", self.normal);
        note("bump", self.bump);
        textured.into_inner()
    }

    /// What each parameter that takes its values from a texture asks it for, by its key in the text.
    pub fn texture_uses(&self) -> Vec<(&'static str, TextureUse)> {
        let colors = RefCell::new(Vec::new());
        let note = |key, by: Option<TextureRef>| {
            let mut colors: RefMut<'_, Vec<&'static str>> = colors.borrow_mut();
            colors.extend(by.map(|_| key));
        };
        let _: Material<(), ()> = self.map(|_, _| (), |key, c| note(key, c.texture()));
        let colors = colors.into_inner();
        let asked = |(key, by): (&'static str, TextureRef)| {
            let TextureRef { texture, channel, .. } = by;
            (key, TextureUse { texture, channel, is_color: colors.contains(&key) })
        };
        self.textured().into_iter().map(asked).collect()
    }

    /// The same with its textures numbered anew.
    #[must_use]
    pub fn renumber_textures(&self, new: impl Fn(TextureId) -> TextureId) -> Self {
        fn renumber<T>(parameter: Param<T>, new: &impl Fn(TextureId) -> TextureId) -> Param<T> {
            match parameter {
                Param::Constant(_) => parameter,
                Param::Textured(by) => {
                    Param::Textured(TextureRef { texture: new(by.texture), ..by })
                }
            }
        }
        let again = |by: TextureRef| TextureRef { texture: new(by.texture), ..by };
        Self {
            normal: self.normal.map(again),
            bump: self.bump.map(again),
            ..self.map(|_, number| renumber(number, &new), |_, color| renumber(color, &new))
        }
    }
}

impl<N: Copy, C: Copy> Material<N, C> {
    /// The same with other numbers and colours: of each its key in the text is told.
    pub(super) fn map<M, D>(
        &self,
        number: impl Fn(&'static str, N) -> M,
        color: impl Fn(&'static str, C) -> D,
    ) -> Material<M, D> {
        Material {
            name: self.name.clone(),
            model: match self.model {
                Model::Lambert => Model::Lambert,
                Model::Phong => Model::Phong,
                Model::BlinnPhong => Model::BlinnPhong,
                Model::BlinnFast => Model::BlinnFast,
                Model::Microfacet { distribution, roughness, shadowing, fresnel } => {
                    // Blinn's distribution goes by the exponent.
                    let key = match distribution {
                        Distribution::Blinn => "shininess",
                        Distribution::Beckmann | Distribution::Ggx => "roughness",
                    };
                    let roughness = number(key, roughness);
                    let fresnel = match fresnel {
                        Fresnel::None => Fresnel::None,
                        Fresnel::Schlick { f0 } => Fresnel::Schlick { f0: color("f0", f0) },
                        Fresnel::Conductor { eta, k } => {
                            Fresnel::Conductor { eta: color("eta", eta), k: color("k", k) }
                        }
                        Fresnel::Dielectric { eta } => {
                            Fresnel::Dielectric { eta: number("eta", eta) }
                        }
                    };
                    Model::Microfacet { distribution, roughness, shadowing, fresnel }
                }
                Model::OrenNayar { sigma, full } => {
                    Model::OrenNayar { sigma: number("sigma", sigma), full }
                }
                Model::Ward { roughness_x, roughness_y, form } => Model::Ward {
                    roughness_x: number("roughness_x", roughness_x),
                    roughness_y: number("roughness_y", roughness_y),
                    form,
                },
            },
            color: color("color", self.color),
            vertex_colors: self.vertex_colors,
            ambient_color: self.ambient_color.map(|c| color("ambient_color", c)),
            specular_color: self.specular_color.map(|c| color("specular_color", c)),
            k_a: number("k_a", self.k_a),
            k_d: number("k_d", self.k_d),
            k_s: number("k_s", self.k_s),
            k_e: number("k_e", self.k_e),
            emission_color: self.emission_color.map(|c| color("emission_color", c)),
            shininess: number("shininess", self.shininess),
            reflection: color("reflection", self.reflection),
            transmission: color("transmission", self.transmission),
            opacity: number("opacity", self.opacity),
            opacity_mode: self.opacity_mode,
            cutoff: self.cutoff,
            normal: self.normal,
            normal_format: self.normal_format,
            bump: self.bump,
            surfaces: self.surfaces,
            shadow: self.shadow,
            ior: number("ior", self.ior),
            priority: self.priority,
            fresnel: self.fresnel,
            dialect: self.dialect,
            times_cosine: self.times_cosine,
            normalize: self.normalize,
            tint: self.tint,
            ambient_rule: self.ambient_rule,
            viewer: self.viewer,
            place: self.place.clone(),
        }
    }
}
