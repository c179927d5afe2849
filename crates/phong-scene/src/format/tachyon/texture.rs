//! Textures: what surfaces are like.

use crate::color::Rgb;
use crate::format::text::{Parsed, Words};
use crate::material::{ConstantMaterial, Dialect, Model, Tint};

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
    /// Whether it says more than is drawn: a pattern, an image, an outline.
    pub(super) more: bool,
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
        more: false,
    };

    /// What stands behind `TEXTURE`, or behind the name of a `TEXDEF`.
    pub(super) fn read(words: &mut Words<'_>) -> Parsed<Self> {
        let mut texture = Self::finish(words)?;
        words.key("COLOR")?;
        texture.color = words.three()?;
        words.key("TEXFUNC")?;
        let function = words.whole()?;
        if function == 0 || function > 9 {
            return Ok(texture);
        }
        texture.more = true;
        if function >= 7 {
            words.some("the name of an image")?;
        }
        for key in ["CENTER", "ROTATE", "SCALE"] {
            words.keyed(key)?;
        }
        if function == 9 {
            words.keyed("UAXIS")?;
            words.keyed("VAXIS")?;
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
            words.some("a mode")?;
            texture.more = true;
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
    pub(super) fn key(&self) -> [u32; 8] {
        let Self { ambient, diffuse, specular, opacity, phong, exponent, metal, more, .. } = *self;
        let [a, d, s, o, p, n] =
            [ambient, diffuse, specular, opacity, phong, exponent].map(f32::to_bits);
        [a, d, s, o, p, n, u32::from(metal), u32::from(more)]
    }

    /// Its numbers and its colour as bits.
    pub(super) fn key_with_color(&self) -> ([u32; 8], [u32; 3]) {
        (self.key(), self.color.map(f32::to_bits))
    }

    /// Its colour, as far as it is one.
    pub(super) fn rgb(&self) -> Rgb {
        rgb(self.color)
    }

    /// The material. `mixed`: what is seen through it is not added to it but takes its place.
    pub(super) fn material(&self, name: String, mixed: bool, open: f32) -> ConstantMaterial {
        let sound = |number: f32| if number > 0.0 { number.min(1e6) } else { 0.0 };
        let opacity = sound(self.opacity).min(1.0);
        let share = if mixed { opacity } else { 1.0 };
        let (dialect, tint) = if self.metal {
            (Dialect::TachyonMetal, Tint::Object)
        } else {
            (Dialect::Tachyon, Tint::Light)
        };
        ConstantMaterial {
            name,
            model: Model::BlinnPhong,
            color: self.rgb(),
            specular_color: (!self.metal).then_some(Rgb::WHITE),
            k_a: share * (sound(self.ambient) + open * sound(self.diffuse)),
            k_d: share * sound(self.diffuse),
            k_s: share * sound(self.phong),
            shininess: sound(self.exponent),
            reflection: Rgb::grey(share * sound(self.specular)),
            transmission: Rgb::grey(1.0 - opacity),
            ior: 1.0,
            fresnel: false,
            dialect,
            tint,
            ..ConstantMaterial::default()
        }
    }
}

/// A colour of three numbers: what is negative or no number is 0.
pub(super) fn rgb(color: [f32; 3]) -> Rgb {
    let [r, g, b] = color.map(|c| if c > 0.0 { c.min(1e6) } else { 0.0 });
    Rgb::new(r, g, b)
}
