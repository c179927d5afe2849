//! Textures, ready to be looked up at points of surfaces: one kind a file.

mod checker;
mod cone;
mod gradient;
mod image;

use glam::{DAffine3, DVec2, DVec3};
use phong_scene::{Channel, Rgb, TextureKind, TextureSpace, TextureUse};

pub use cone::{Cone, footprint};
pub use image::ImageLookUp;

use checker::Checker;
use gradient::Gradient;
use image::ImageTexture;

/// A texture that can be looked up.
#[derive(Clone, Debug)]
pub struct Texture {
    space: TextureSpace,
    /// From the space it lies in to where it is described.
    from_space: DAffine3,
    pattern: Pattern,
}

#[derive(Clone, Debug)]
enum Pattern {
    Checker(Checker),
    Gradient(Gradient),
    Image(Box<ImageTexture>),
}

/// A point of a surface, as textures see it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TexturePoint {
    /// In the object's own space, before its transform.
    pub object: DVec3,
    /// In the world.
    pub world: DVec3,
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// Unit tangent of the surface, along which u grows; 0 where nothing asked for it.
    pub tangent: [f32; 3],
    /// The sides of the piece of surface that one look-up stands for; all 0: a point.
    pub footprint: Footprint,
}

/// The sides of a parallelogram about a point of a surface, in each of the spaces that textures lie in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// In the object's own space.
    pub object: [DVec3; 2],
    /// In the world.
    pub world: [DVec3; 2],
    /// How the texture coordinates change along them.
    pub uv: [DVec2; 2],
}

impl Texture {
    /// The texture as it was written.
    pub fn new(texture: &phong_scene::Texture) -> Self {
        Self {
            space: texture.space,
            from_space: texture.transform.inverse(),
            pattern: match &texture.kind {
                TextureKind::Checker { colors, scale } => {
                    Pattern::Checker(Checker { colors: *colors, scale: *scale })
                }
                TextureKind::Gradient { by, axis, from, to, stops } => {
                    Pattern::Gradient(Gradient::new((*by, *axis), *from, *to, stops))
                }
                TextureKind::Image { texels, wrap, border, tint, filter, encoding, .. } => {
                    let beside = (*wrap, *border);
                    let image = ImageTexture::new(texels, beside, *tint, (*filter, *encoding));
                    Pattern::Image(Box::new(image))
                }
            },
        }
    }

    /// Its value at a point of a surface. Linear.
    pub fn value(&self, at: &TexturePoint, asked: TextureUse) -> Rgb {
        let p = self.from_space.transform_point3(self.place(at));
        let value = match &self.pattern {
            Pattern::Checker(checker) => checker.value(p),
            Pattern::Gradient(gradient) => gradient.value(p),
            Pattern::Image(image) => {
                let [r, g, b, opacity] = image.value(p.truncate(), self.sides(at), asked.is_color);
                if asked.channel == Some(Channel::Alpha) {
                    return Rgb::grey(opacity);
                }
                return Rgb::new(r, g, b);
            }
        };
        if asked.channel == Some(Channel::Alpha) { Rgb::WHITE } else { value }
    }

    /// How its image is looked up at a point of a surface; `None`: it is none.
    pub fn image_look_up(&self, at: &TexturePoint) -> Option<ImageLookUp> {
        match &self.pattern {
            Pattern::Image(image) => Some(image.look_up(self.sides(at))),
            _ => None,
        }
    }

    /// Whether its values depend on how much of a surface a look-up stands for.
    pub(crate) fn has_footprint(&self) -> bool {
        matches!(self.pattern, Pattern::Image(_))
    }

    /// The sides of the footprint where an image is described.
    fn sides(&self, at: &TexturePoint) -> [DVec2; 2] {
        let sides = match self.space {
            TextureSpace::Object => at.footprint.object,
            TextureSpace::World => at.footprint.world,
            TextureSpace::Uv => at.footprint.uv.map(|side| side.extend(0.0)),
        };
        sides.map(|side| self.from_space.transform_vector3(side).truncate())
    }

    /// The coordinates of a point in the space that it lies in: of texture coordinates u, v and 0.
    pub fn place(&self, at: &TexturePoint) -> DVec3 {
        match self.space {
            TextureSpace::Object => at.object,
            TextureSpace::World => at.world,
            TextureSpace::Uv => DVec3::new(at.uv[0].into(), at.uv[1].into(), 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use phong_scene::TextureId;

    use super::*;

    const USE: TextureUse = TextureUse { texture: TextureId(0), channel: None, is_color: true };

    #[test]
    fn a_texture_lies_where_it_was_moved_to_in_the_space_it_says() {
        let [a, b] = [Rgb::WHITE, Rgb::BLACK];
        let at = TexturePoint {
            object: DVec3::new(0.5, 0.5, 0.5),
            world: DVec3::new(1.5, 0.5, 0.5),
            uv: [0.5, 1.5],
            ..TexturePoint::default()
        };
        for (space, want) in
            [(TextureSpace::Object, a), (TextureSpace::World, b), (TextureSpace::Uv, b)]
        {
            let written = phong_scene::Texture { space, ..phong_scene::Texture::default() };
            assert_eq!(Texture::new(&written).value(&at, USE), want, "{space:?}");
            let moved = phong_scene::Texture {
                transform: DAffine3::from_translation(DVec3::new(1.0, 0.0, 0.0)),
                ..written
            };
            assert_ne!(Texture::new(&moved).value(&at, USE), want, "{space:?}, a square further");
        }
    }
}
