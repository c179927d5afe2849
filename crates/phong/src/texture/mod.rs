//! Textures, ready to be looked up at points of surfaces: one kind a file.

mod checker;
mod gradient;

use glam::{DAffine3, DVec3};
use phong_scene::{Rgb, TextureKind, TextureSpace};

use checker::Checker;
use gradient::Gradient;

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
    /// How wide the surface is that one look-up stands for, in units of the world; 0: a point. No
    /// texture asks for more so far.
    pub footprint: f32,
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
            },
        }
    }

    /// Its value at a point of a surface. Linear.
    pub fn value(&self, at: &TexturePoint) -> Rgb {
        let p = self.from_space.transform_point3(self.place(at));
        match &self.pattern {
            Pattern::Checker(checker) => checker.value(p),
            Pattern::Gradient(gradient) => gradient.value(p),
        }
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

    use super::*;

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
            assert_eq!(Texture::new(&written).value(&at), want, "{space:?}");
            let moved = phong_scene::Texture {
                transform: DAffine3::from_translation(DVec3::new(1.0, 0.0, 0.0)),
                ..written
            };
            assert_ne!(Texture::new(&moved).value(&at), want, "{space:?}, a square further");
        }
    }
}
