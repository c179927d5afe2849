//! Textures: what surfaces are like.

use glam::{DAffine3, DVec3, Vec3};

use crate::color::Rgb;
use crate::format::text::{Parsed, Words};
use crate::material::{ConstantMaterial, Dialect, Material, Model, OpacityMode, ShadowRule, Tint};
use crate::texture::{Texture as Pattern, TextureId, TextureKind, TextureRef, TextureSpace};

/// The colours of `TEXFUNC 1`, which no file says: those of its even cubes, and of its odd ones.
const CHECKER: [Rgb; 2] = [Rgb::new(0.0, 0.2, 1.0), Rgb::new(1.0, 0.2, 0.0)];

/// How many of its cubes are in a row of one unit.
const CUBES: f64 = 3.0;

/// All of a texture but its colour, as bits.
pub(super) type Key = ([u32; 6], [bool; 3], Option<[u32; 3]>);

/// What a texture says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Texture {
    pub(super) ambient: f32,
    pub(super) diffuse: f32,
    /// The weight of the mirror ray.
    pub(super) specular: f32,
    pub(super) opacity: f32,
    pub(super) phong: f32,
    pub(super) exponent: f32,
    pub(super) metal: bool,
    pub(super) color: [f32; 3],
    /// Whether its opacity depends on the angle that it is seen at (`TRANSMODE R3D`).
    pub(super) angle: bool,
    /// The middle of a cube of its checker.
    pub(super) checker: Option<[f32; 3]>,
    /// Whether it says more than is drawn: another pattern, an image, an outline.
    pub(super) more: bool,
}

/// How all surfaces of a scene are drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawing {
    /// What is seen through a surface is not added to it but takes its place.
    pub(super) mixed: bool,
    /// What ambient occlusion's light is.
    pub(super) open: f32,
}

impl Texture {
    /// Where a name says nothing: what Tachyon takes, but grey, so that it is not taken for white paint.
    pub(super) const DEFAULT: Self = Self {
        ambient: 0.1,
        diffuse: 0.9,
        specular: 0.0,
        opacity: 1.0,
        phong: 0.0,
        exponent: 100.0,
        metal: false,
        color: [0.8; 3],
        angle: false,
        checker: None,
        more: false,
    };

    /// What stands behind `TEXTURE`, or behind the name of a `TEXDEF`.
    pub(super) fn read(words: &mut Words<'_>) -> Parsed<Self> {
        let mut texture = Self::finish(words)?;
        words.key("COLOR")?;
        texture.color = words.three()?;
        words.key("TEXFUNC")?;
        let function = words.whole()?;
        if function == 0 || function > 10 {
            return Ok(texture);
        }
        if function >= 7 {
            words.some("the name of an image")?;
        }
        let middle = words.keyed("CENTER")?;
        words.keyed("ROTATE")?;
        words.keyed("SCALE")?;
        if function == 1 && middle.is_finite() {
            // The checker is neither turned nor scaled, and its colours are its own.
            (texture.checker, texture.color) = (Some(middle.to_array()), [1.0; 3]);
        } else {
            texture.more = true;
        }
        if function >= 9 {
            words.keyed("UAXIS")?;
            words.keyed("VAXIS")?;
        }
        if function == 10 {
            words.keyed("WAXIS")?;
        }
        Ok(texture)
    }

    /// The same without a colour, which its vertices have.
    pub(super) fn of_vertices(words: &mut Words<'_>) -> Parsed<Self> {
        let texture = Self::finish(words)?;
        words.key("VCST")?;
        Ok(texture)
    }

    /// The texture of vertices of which each has a colour.
    pub(super) fn of_array(words: &mut Words<'_>) -> Parsed<Self> {
        let mut ahead = words.clone();
        match Self::of_vertices(&mut ahead) {
            Ok(texture) => {
                *words = ahead;
                Ok(texture)
            }
            Err(_) => Self::read(words),
        }
    }

    fn finish(words: &mut Words<'_>) -> Parsed<Self> {
        let mut texture = Self {
            ambient: words.keyed_number("AMBIENT")?,
            diffuse: words.keyed_number("DIFFUSE")?,
            specular: words.keyed_number("SPECULAR")?,
            opacity: words.keyed_number("OPACITY")?,
            ..Self::DEFAULT
        };
        if words.has("TRANSMODE") {
            texture.angle = words.some("a mode")?.eq_ignore_ascii_case(b"r3d");
        }
        if words.has("OUTLINE") {
            texture.more |= words.number()? > 0.0;
            words.keyed_number("OUTLINE_WIDTH")?;
        }
        if words.has("PHONG") {
            texture.metal = words.some("`PLASTIC` or `METAL`")?.eq_ignore_ascii_case(b"metal");
            texture.phong = words.number()?;
            texture.exponent = words.keyed_number("PHONG_SIZE")?;
        }
        Ok(texture)
    }

    /// Its numbers as bits, without the colour: what is of one material but for its colour is alike.
    pub(super) fn key(&self) -> Key {
        let Self { ambient, diffuse, specular, opacity, phong, exponent, .. } = *self;
        let Self { metal, more, angle, checker, .. } = *self;
        let numbers = [ambient, diffuse, specular, opacity, phong, exponent].map(f32::to_bits);
        (numbers, [metal, more, angle], checker.map(|middle| middle.map(f32::to_bits)))
    }

    /// Its numbers and its colour as bits.
    pub(super) fn key_with_color(&self) -> (Key, [u32; 3]) {
        (self.key(), self.color.map(f32::to_bits))
    }

    /// Its colour, as far as it is one.
    pub(super) fn rgb(&self) -> Rgb {
        rgb(self.color)
    }

    /// The material; its pattern becomes the last of all.
    pub(super) fn material(
        &self,
        name: String,
        drawing: Drawing,
        patterns: &mut Vec<Pattern>,
    ) -> Material {
        let sound = |number: f32| if number > 0.0 { number.min(1e6) } else { 0.0 };
        let opacity = sound(self.opacity).min(1.0);
        let (dialect, tint) = if self.metal {
            (Dialect::TachyonMetal, Tint::Object)
        } else {
            (Dialect::Tachyon, Tint::Light)
        };
        let mut material = ConstantMaterial {
            name,
            model: Model::BlinnPhong,
            color: self.rgb(),
            specular_color: (!self.metal).then_some(Rgb::WHITE),
            k_a: sound(self.ambient) + drawing.open * sound(self.diffuse),
            k_d: sound(self.diffuse),
            k_s: sound(self.phong),
            shininess: sound(self.exponent),
            reflection: Rgb::grey(sound(self.specular)),
            ior: 1.0,
            fresnel: false,
            dialect,
            tint,
            ..ConstantMaterial::default()
        };
        if drawing.mixed {
            material.opacity = opacity;
            if self.angle && opacity < 1.0 {
                material.opacity_mode = OpacityMode::Angle;
            }
        } else if opacity < 1.0 {
            material.transmission = Rgb::grey(1.0 - opacity);
            material.shadow = Some(ShadowRule::Filtered);
        }
        let mut material = Material::from(material);
        if let Some(middle) = self.checker {
            // The format's cubes have a middle at this place, ours a corner.
            let corner = Vec3::from(middle).as_dvec3() - DVec3::splat(0.5 / CUBES);
            material.color = TextureRef::new(TextureId(patterns.len() as u32)).into();
            patterns.push(Pattern {
                name: format!("checker {}", patterns.len() + 1),
                kind: TextureKind::Checker { colors: CHECKER, scale: CUBES },
                space: TextureSpace::World,
                transform: DAffine3::from_translation(corner),
                ..Pattern::default()
            });
        }
        material
    }
}

/// A colour of three numbers: what is negative or no number is 0.
pub(super) fn rgb(color: [f32; 3]) -> Rgb {
    let [r, g, b] = color.map(|c| if c > 0.0 { c.min(1e6) } else { 0.0 });
    Rgb::new(r, g, b)
}
