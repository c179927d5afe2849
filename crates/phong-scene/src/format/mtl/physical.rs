//! The physically based extension: how rough a surface is and how metallic, as glTF understands both.

use super::draft::Draft;
use super::maps::{Drawn, Images, Maps, Physical};
use super::texture::{Map, MapOf};
use crate::color::Rgb;
use crate::format::facets::{
    F0, ambient, imaged, microfacets, mirrored, mixed, numbers, of_exponent, parted, reflectance,
    width,
};
use crate::format::text::Findings;
use crate::material::{Material, Model, PLAIN};
use crate::texture::{Channel, TextureRef};

impl Draft {
    /// `None`: the extension is not used. Zeros are what programs write that have nothing to say.
    pub(super) fn physical(&self, findings: &mut Findings) -> Option<Physical> {
        let is_said = |number: Option<f32>| number.is_some_and(|number| number > 0.0);
        let is_drawn = |of| self.maps.iter().any(|(map, _)| map.of == of);
        let images = [MapOf::Roughness, MapOf::Metallic];
        if !is_said(self.roughness) && !is_said(self.metallic) && !images.into_iter().any(is_drawn)
        {
            return None;
        }
        let mut share = |what, value: f32| self.in_range(what, value, 0.0, 1.0, findings).into();
        Some(Physical {
            base: self.diffuse.unwrap_or(PLAIN),
            metallic: share("Pm", self.metallic.unwrap_or(0.0)),
            roughness: match self.roughness {
                Some(roughness) => share("Pr", roughness),
                None => of_exponent(self.exponent.unwrap_or(32.0).max(0.0)).into(),
            },
            // 1 and below is what programs write that have none to give.
            dielectric: self.index.filter(|&n| n > 1.0).map_or(F0, |n| reflectance(n.into())),
        })
    }
}

impl Physical {
    /// Makes facets of a material's highlight and of its diffuse colour, of all of which `shown` is there.
    pub(super) fn put(&self, material: &mut Material, maps: &Maps, shown: f32) {
        let metal = maps.metal.unwrap_or(self.metallic);
        let facets = microfacets(self.base, [metal, self.roughness], self.dielectric);
        let facets = Material::from(facets);
        // The dialect of MTL knows no facets, and its switches are those of the default one.
        (material.dialect, material.model) = (facets.dialect, facets.model);
        material.color = facets.color;
        (material.specular_color, material.k_s) = (facets.specular_color, shown.into());
        if material.ambient_color.is_none() {
            material.k_a = (shown * ambient(metal as f32)).into();
            material.ambient_color = maps.diffuse.map(Into::into).or(facets.ambient_color);
        }
        match (maps.parts, maps.diffuse) {
            (Some([scattered, specular]), _) => imaged(material, scattered, Some(specular)),
            (None, Some(base)) => {
                let other = (1.0 - metal) as f32;
                let (scale, offset) = (base.scale * other, base.offset * other);
                let is_metal = metal > 0.0;
                imaged(material, TextureRef { scale, offset, ..base }, is_metal.then_some(base));
                if is_metal {
                    material.k_s = (shown * mirrored(metal, self.dielectric)).into();
                }
            }
            (None, None) => {}
        }
        if let (Some(by), Model::Microfacet { roughness, .. }) =
            (maps.roughness, &mut material.model)
        {
            *roughness = by.into();
        }
    }
}

impl Maps {
    /// Takes the images of roughness and of metal.
    pub(super) fn take_physical(
        &mut self,
        (name, physical): (&str, &Physical),
        all: &[Drawn<'_>],
        images: &mut Images<'_>,
        findings: &mut Findings,
    ) {
        let of = |of: MapOf| all.iter().find(|drawn| drawn.map.of == of);
        if let Some(rough) = of(MapOf::Roughness) {
            let alpha = |pixel| width(rough.map.number(pixel));
            let size = (rough.texels.size(), 2);
            match images.made(size, || numbers(&rough.texels, alpha)) {
                Ok(texels) => {
                    let name = format!("{name} map_Pr");
                    let texture = rough.texture(name, texels, Rgb::WHITE, images);
                    self.roughness = Some(TextureRef::new(texture));
                }
                Err(why) => rough.tell(findings, &format!("is left out: {why}")),
            }
        }
        let Some(metal) = of(MapOf::Metallic) else { return };
        let [least, most] = metal.texels.bounds(false).map(|bound| metal.map.number(bound));
        self.metal = Some(metal.map.number(metal.texels.mean(false)));
        if least == most {
            return;
        }
        let base = of(MapOf::Diffuse);
        if base.is_some_and(|base| !base.map.lies_plainly_as(metal.map)) {
            metal.tell(findings, "lies otherwise than that of the colour: its mean counts");
            return;
        }
        let larger = base.unwrap_or(metal);
        let size = larger.texels.size();
        let tint = if physical.base.is_black() { Rgb::WHITE } else { physical.base };
        let mut part = |number: usize, word: &str| {
            let value = |[r, g, b, _]: [f32; 4], other: [f32; 4]| {
                let base = base.map_or(physical.base, |_| Rgb::new(r, g, b) * tint);
                parted(base, metal.map.number(other), physical.dielectric)[number]
            };
            let made = images.made((size, 12), || mixed(&larger.texels, &metal.texels, value))?;
            let texture = larger.texture(format!("{name} {word}"), made, Rgb::WHITE, images);
            Ok(TextureRef::new(texture))
        };
        let parts =
            part(0, "scattered").and_then(|scattered| Ok([scattered, part(1, "mirrored")?]));
        match parts {
            Ok(parts) => self.parts = Some(parts),
            Err::<_, String>(why) => metal.tell(findings, &format!("counts by its mean: {why}")),
        }
    }
}

impl Drawn<'_> {
    fn tell(&self, findings: &mut Findings, what: &str) {
        let tell = || format!("the image `{}` {what}", self.map.name);
        findings.warning("images that are not wholly drawn", || self.span.clone(), tell);
    }
}

impl Map {
    /// The share, from 0 to 1, that a pixel of it says.
    fn number(&self, [r, g, b, opacity]: [f32; 4]) -> f64 {
        let value = match self.channel.unwrap_or(Channel::Red) {
            Channel::Alpha => opacity,
            channel => channel.of(Rgb::new(r, g, b)),
        };
        (f64::from(value) * self.gain + self.base).clamp(0.0, 1.0)
    }

    /// Whether it is of colours as they are, and lies as an image of metal.
    fn lies_plainly_as(&self, metal: &Self) -> bool {
        let place = |map: &Self| (map.offset, map.scale, map.clamp);
        let is_plain = self.channel.is_none() && (self.gain, self.base) == (1.0, 0.0);
        is_plain && place(self) == place(metal)
    }
}
