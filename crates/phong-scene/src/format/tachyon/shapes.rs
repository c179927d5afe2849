//! Things of which there are many: those of one texture, but for its colour, are one shape.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::texture::{Texture, rgb};
use super::things::{Array, Triangle};
use crate::color::Rgb;
use crate::limits::LARGEST;
use crate::mesh::{Caps, Cylinders, Mesh, NO_INDEX, Points};
use crate::shape::Shape;

/// The parts of a flat ring.
const PARTS: u32 = 96;

/// The ends of a cylinder, and its colour.
type Segment = ([[f32; 4]; 2], Rgb);

/// All things of one texture, but for its colour.
#[derive(Debug)]
pub(super) struct Bulk {
    pub(super) texture: Texture,
    /// The number of the clip group that they are in.
    pub(super) clip: Option<usize>,
    pub(super) spheres: Vec<[f32; 4]>,
    pub(super) sphere_colors: Vec<Rgb>,
    /// Without ends, and with round ones.
    segments: [Vec<Segment>; 2],
    mesh: Soup,
}

/// Triangles that share no corner, and those of arrays.
#[derive(Debug, Default)]
struct Soup {
    positions: Vec<Vec3>,
    colors: Vec<Rgb>,
    normals: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    normal_indices: Vec<[u32; 3]>,
}

impl Bulk {
    /// Nothing yet of this texture, in this clip group.
    pub(super) fn of(texture: Texture, clip: Option<usize>) -> Self {
        Self {
            texture,
            clip,
            spheres: Vec::new(),
            sphere_colors: Vec::new(),
            segments: [Vec::new(), Vec::new()],
            mesh: Soup::default(),
        }
    }

    pub(super) fn triangles(&self) -> u64 {
        self.mesh.indices.len() as u64
    }

    pub(super) fn vertices(&self) -> u64 {
        self.mesh.positions.len().max(self.spheres.len()) as u64
    }

    /// Bytes that they take in memory.
    pub(super) fn bytes(&self) -> u64 {
        let segments: usize = self.segments.iter().map(Vec::len).sum();
        let mesh = &self.mesh;
        let vectors = mesh.positions.len() + mesh.colors.len() + mesh.normals.len();
        let triples = mesh.indices.len() + mesh.normal_indices.len();
        (28 * self.spheres.len() + 44 * segments + 12 * (vectors + triples)) as u64
    }

    /// The cylinders with these ends.
    pub(super) fn cylinders(&mut self, caps: Caps) -> &mut Vec<Segment> {
        &mut self.segments[usize::from(caps == Caps::Round)]
    }

    /// Adds a triangle, of this colour if its corners have none.
    pub(super) fn triangle(&mut self, triangle: &Triangle, color: Rgb) {
        let Triangle { corners, normals, colors, .. } = triangle;
        let mesh = &mut self.mesh;
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners.map(Vec3::from));
        mesh.colors.extend(colors.map_or([color; 3], |colors| colors.map(rgb)));
        mesh.indices.push([first, first + 1, first + 2]);
        let normal = mesh.normals.len() as u32;
        mesh.normal_indices.push(match normals {
            Some(normals) => {
                mesh.normals.extend(normals.map(Vec3::from));
                [normal, normal + 1, normal + 2]
            }
            None => [NO_INDEX; 3],
        });
    }

    /// Adds the triangles of an array; how many are left out.
    pub(super) fn array(&mut self, array: Array, color: Rgb) -> u64 {
        let Array { mut positions, mut normals, colors, indices, .. } = array;
        let held = |p: &Vec3| p.abs().max_element() <= LARGEST as f32;
        let bad: Vec<bool> = positions.iter().map(|p| !held(p)).collect();
        positions.iter_mut().filter(|p| !held(p)).for_each(|p| *p = Vec3::ZERO);
        normals.iter_mut().filter(|n| !held(n)).for_each(|n| *n = Vec3::ZERO);
        let mesh = &mut self.mesh;
        let (first, normal) = (mesh.positions.len() as u32, mesh.normals.len() as u32);
        let before = indices.len();
        let kept = indices.into_iter().filter(|corners| !corners.iter().any(|i| bad[*i as usize]));
        let mut drawn = 0;
        for corners in kept {
            mesh.indices.push(corners.map(|i| first.saturating_add(i)));
            let of_normal = |i: u32| normal.saturating_add(i);
            let none = normals.is_empty();
            mesh.normal_indices.push(if none { [NO_INDEX; 3] } else { corners.map(of_normal) });
            drawn += 1;
        }
        let missing = positions.len() - colors.len().min(positions.len());
        mesh.colors.extend(colors.into_iter().take(positions.len()).map(rgb));
        mesh.colors.extend(std::iter::repeat_n(color, missing));
        mesh.positions.append(&mut positions);
        mesh.normals.append(&mut normals);
        (before - drawn) as u64
    }

    /// The shapes, each with its texture.
    pub(super) fn shapes(self) -> Vec<(Shape, Texture)> {
        let Self { texture, spheres, sphere_colors, segments, mesh, .. } = self;
        let mut shapes = Vec::new();
        if !spheres.is_empty() {
            let (own, colors) = colors(&texture, sphere_colors);
            let (spheres, colors) = (spheres.into(), colors.into());
            shapes.push((Points { spheres, colors, ..Points::default() }.into(), own));
        }
        for (segments, caps) in segments.into_iter().zip([Caps::Open, Caps::Round]) {
            if segments.is_empty() {
                continue;
            }
            let (segments, all): (Vec<_>, Vec<_>) = segments.into_iter().unzip();
            let (own, colors) = colors(&texture, all);
            let colors = colors.into_iter().map(|color| [color; 2]).collect();
            let segments = segments.into();
            shapes.push((Cylinders { segments, colors, caps, ..Cylinders::default() }.into(), own));
        }
        if !mesh.indices.is_empty() {
            let Soup { positions, colors: all, mut normals, indices, normal_indices } = mesh;
            let (own, colors) = colors(&texture, all);
            if normals.is_empty() {
                // A normal that no corner uses says that all are flat.
                normals.push(Vec3::Z);
            }
            let mut mesh = Mesh {
                positions: positions.into(),
                indices: indices.into(),
                normals: normals.into(),
                normal_indices: normal_indices.into(),
                colors: colors.into(),
                ..Mesh::default()
            };
            mesh.drop_collapsed();
            mesh.mend_normals();
            if !mesh.indices.is_empty() {
                shapes.push((mesh.into(), own));
            }
        }
        shapes
    }
}

/// The texture with its colour if all things have the same, else the colours.
fn colors(texture: &Texture, colors: Vec<Rgb>) -> (Texture, Vec<Rgb>) {
    let same = colors.first().copied().filter(|first| colors.iter().all(|color| color == first));
    match same {
        Some(color) => (Texture { color: color.to_array(), ..*texture }, Vec::new()),
        None => (*texture, colors),
    }
}

/// A flat ring of triangles.
pub(super) fn ring(center: DVec3, normal: DVec3, inner: f64, outer: f64) -> Mesh {
    let normal = normal.normalize_or(DVec3::Y);
    let (along, across) = normal.any_orthonormal_pair();
    let place = |part: u32, radius: f64| {
        let angle = TAU * f64::from(part) / f64::from(PARTS);
        (radius * (libm::cos(angle) * along + libm::sin(angle) * across)).as_vec3()
    };
    let quad = |part: u32| {
        let [a, b] = [2 * part, 2 * ((part + 1) % PARTS)];
        [[a, a + 1, b + 1], [a, b + 1, b]]
    };
    Mesh {
        origin: center,
        positions: (0..PARTS).flat_map(|i| [place(i, inner), place(i, outer)]).collect(),
        indices: (0..PARTS).flat_map(quad).collect(),
        normals: [normal.as_vec3()].into(),
        normal_indices: vec![[0; 3]; 2 * PARTS as usize].into(),
        ..Mesh::default()
    }
}
