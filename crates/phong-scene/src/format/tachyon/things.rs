//! What statements say, as data.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::camera::Frame;
use super::sky::{Gradient, Haze};
use super::texture::{Key, Texture};
use crate::format::text::{Parsed, Words};

/// How many names are looked through one by one: neighbours are mostly of a few textures.
const FEW: usize = 8;

/// A statement of which there are few.
#[derive(Debug)]
pub(super) enum Statement {
    /// The next texture that things name.
    Use(Named),
    Define(Vec<u8>, Texture),
    /// A new name, and what it stands for.
    Alias(Vec<u8>, Vec<u8>),
    Light(Lamp),
    Plane {
        point: DVec3,
        normal: DVec3,
        texture: u32,
    },
    Box {
        min: DVec3,
        max: DVec3,
        texture: u32,
    },
    Ring {
        center: DVec3,
        normal: DVec3,
        inner: f64,
        outer: f64,
        texture: u32,
    },
    /// One without ends.
    Cylinder {
        center: DVec3,
        axis: DVec3,
        radius: f64,
        texture: u32,
    },
    Chain {
        points: Vec<Vec3>,
        radius: f32,
        texture: u32,
    },
    Mesh(Array),
    Resolution([u64; 2]),
    Camera(Frame),
    Background([f32; 3]),
    Gradient(Gradient),
    Fog(Haze),
    Mode(Mode),
    Include(Vec<u8>),
    /// What follows is cut along planes: the normal points to what is cut away, with its largest `p · n`.
    BeginClip(Vec<(Vec3, f32)>),
    EndClip,
    /// What is not drawn, in the plural.
    Ignored(&'static str),
}

/// A light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp {
    /// `None`: it is far away.
    pub(super) position: Option<DVec3>,
    pub(super) direction: Option<DVec3>,
    /// Where a cone's light begins to fall off, and where it ends, degrees.
    pub(super) falloff: Option<[f64; 2]>,
    pub(super) attenuation: [f64; 3],
    pub(super) color: [f32; 3],
}

/// Many triangles.
#[derive(Debug, Default)]
pub(super) struct Array {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) colors: Vec<[f32; 3]>,
    pub(super) indices: Vec<[u32; 3]>,
    pub(super) texture: u32,
    /// How many triangles name a vertex that is not there.
    pub(super) outside: u64,
}

/// How all is shaded.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mode {
    pub(super) no_shadows: bool,
    pub(super) mixed: bool,
    /// Whether fog goes by the distance along the camera's axis.
    pub(super) planar: bool,
    /// The colour of ambient occlusion.
    pub(super) open: Option<[f32; 3]>,
    /// The rays of ambient occlusion.
    pub(super) samples: u64,
    /// What all lights are multiplied by.
    pub(super) rescale: Option<f32>,
}

/// The textures that things name, by a word or by what it would stand for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Named {
    Name(Vec<u8>),
    Own(Texture),
}

/// What statements say, those of many kinds apart.
#[derive(Debug, Default)]
pub(super) struct Things {
    /// Middle and radius, and the number of a texture.
    pub(super) spheres: Vec<([f32; 4], u32)>,
    /// Both ends, and the number of a texture.
    pub(super) cylinders: Vec<([[f32; 4]; 2], u32)>,
    pub(super) triangles: Vec<Triangle>,
    /// All others, in order, with the line.
    pub(super) statements: Vec<(u64, Statement)>,
    /// How many things of many kinds were left out because a number is none that can be drawn.
    pub(super) left_out: u64,
    /// How many textures have been named.
    count: u32,
    names: HashMap<Vec<u8>, u32>,
    own: HashMap<(Key, [u32; 3]), u32>,
    /// The last few of the names that were looked up, which are found sooner than among all.
    few: Vec<(Vec<u8>, u32)>,
    /// Which of them was looked up first.
    oldest: usize,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [[f32; 3]; 3],
    pub(super) normals: Option<[[f32; 3]; 3]>,
    /// The colours of its corners, if they have some.
    pub(super) colors: Option<[[f32; 3]; 3]>,
    pub(super) texture: u32,
}

impl Things {
    /// The number of the texture that stands here.
    pub(super) fn texture(&mut self, words: &mut Words<'_>) -> Parsed<u32> {
        let word = words.some("a texture")?;
        if word.eq_ignore_ascii_case(b"texture") {
            let texture = Texture::read(words)?;
            return Ok(self.own(texture));
        }
        Ok(self.named(word, words.line()))
    }

    /// The number of the texture of this name, which stands on this line.
    pub(super) fn named(&mut self, word: &[u8], line: u64) -> u32 {
        if let Some((_, number)) = self.few.iter().find(|(name, _)| name == word) {
            return *number;
        }
        let number = if let Some(number) = self.names.get(word) {
            *number
        } else {
            let number = self.name(Named::Name(word.to_vec()), line);
            self.names.insert(word.to_vec(), number);
            number
        };
        if self.few.len() < FEW {
            self.few.push((word.to_vec(), number));
        } else {
            let (name, of) = &mut self.few[self.oldest % FEW];
            name.clear();
            name.extend_from_slice(word);
            *of = number;
            self.oldest += 1;
        }
        number
    }

    /// The number of a texture that has no name.
    pub(super) fn own(&mut self, texture: Texture) -> u32 {
        if let Some(number) = self.own.get(&texture.key_with_color()) {
            return *number;
        }
        let number = self.name(Named::Own(texture), 0);
        self.own.insert(texture.key_with_color(), number);
        number
    }

    fn name(&mut self, named: Named, line: u64) -> u32 {
        self.statements.push((line, Statement::Use(named)));
        self.count += 1;
        self.count - 1
    }

    /// What follows is another group's: the textures that it names are not those from before.
    pub(super) fn begin_group(&mut self) {
        self.names.clear();
        self.own.clear();
        self.few.clear();
    }

    /// Whatever stands behind this word may mean another texture from now on.
    pub(super) fn define(&mut self, name: &[u8]) {
        self.names.remove(name);
        self.few.clear();
    }
}
