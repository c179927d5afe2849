//! Tangents are those of the original, as the crate `bevy_mikktspace` has it, bit for bit.

use bevy_mikktspace::{Ops, TangentSpace};
use phong_scene::NO_INDEX;

use super::*;

/// A mesh as the original asks for it.
struct Asked<'a>(Corners<'a>, Vec<[[f32; 4]; 3]>);

struct SameEverywhere;

impl Ops for SameEverywhere {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        crate::math::acos(x)
    }
}

impl bevy_mikktspace::Geometry<SameEverywhere> for Asked<'_> {
    fn num_faces(&self) -> usize {
        self.0.indices.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.0.positions_of(face)[corner]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.0.attributes(3 * face as u32 + corner as u32).0.to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.0.uvs_of(face)[corner].to_array()
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, corner: usize) {
        self.1[face][corner] = tangent.map_or([0.0; 4], |tangent| tangent.tangent_encoded());
    }
}

/// Numbers that follow one another without a pattern.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: u32) -> u32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % u64::from(end)) as u32
    }

    /// In [−1, 1].
    fn next(&mut self) -> f32 {
        self.below(1 << 20) as f32 / (1 << 19) as f32 - 1.0
    }
}

fn agrees(what: &str, positions: &[Vec3], indices: &[[u32; 3]], mesh: &MeshAttributes) {
    let units = mesh.normals.iter().map(|n| n.try_normalize().unwrap_or(Vec3::ZERO)).collect();
    let mut asked =
        Asked(Corners { positions, indices, mesh, units }, vec![[[0.0; 4]; 3]; indices.len()]);
    let made = bevy_mikktspace::generate_tangents(&mut asked);
    made.expect("it has no way to fail");
    let ours = super::made(positions, indices, mesh);
    let ours: Vec<_> = (0..indices.len()).map(|face| ours.get(face).unwrap()).collect();
    let bits = |tangents: [[f32; 4]; 3]| tangents.map(|t| t.map(f32::to_bits));
    let differ = (0..indices.len()).filter(|&face| bits(ours[face]) != bits(asked.1[face]));
    let differ: Vec<_> = differ.collect();
    assert!(
        differ.is_empty(),
        "{what}: {} of {} differ, first {:?}: {:?}, not {:?}",
        differ.len(),
        indices.len(),
        differ[0],
        ours[differ[0]],
        asked.1[differ[0]]
    );
}

/// A waved sheet of `n` × `n` squares, in the order of its rows or in none.
fn sheet(
    n: u32,
    numbers: &mut Numbers,
    in_order: bool,
) -> (Vec<Vec3>, Vec<[u32; 3]>, MeshAttributes) {
    let at = |i: u32| ((i % (n + 1)) as f32 / n as f32, (i / (n + 1)) as f32 / n as f32);
    let count = (n + 1) * (n + 1);
    let height = |x: f32, y: f32| 0.2 * crate::math::sin(7.0 * x) * crate::math::cos(5.0 * y);
    let place = |i: u32| {
        let (x, y) = at(i);
        Vec3::new(x, height(x, y), y)
    };
    let normal = |i: u32| {
        let (x, y) = at(i);
        let step = 1e-2;
        let slope = [height(x + step, y) - height(x, y), height(x, y + step) - height(x, y)];
        Vec3::new(-slope[0] / step, 1.0, -slope[1] / step)
    };
    let mut indices = Vec::new();
    for y in 0..n {
        for x in 0..n {
            let a = y * (n + 1) + x;
            indices.push([a, a + n + 1, a + 1]);
            indices.push([a + 1, a + n + 1, a + n + 2]);
        }
    }
    if !in_order {
        for i in (1..indices.len()).rev() {
            indices.swap(i, numbers.below(i as u32 + 1) as usize);
            let turn = numbers.below(3) as usize;
            indices[i].rotate_left(turn);
        }
    }
    let uvs = (0..count).map(|i| Vec2::new(3.0 * at(i).0, 2.0 * at(i).1));
    let mesh = MeshAttributes {
        normals: (0..count).map(normal).collect::<Vec<_>>().into(),
        uvs: uvs.collect::<Vec<_>>().into(),
        ..MeshAttributes::default()
    };
    ((0..count).map(place).collect(), indices, mesh)
}

#[test]
fn sheets_have_the_tangents_of_the_original() {
    let mut numbers = Numbers(1);
    for n in [1, 2, 3, 5, 9, 16, 40] {
        for in_order in [true, false] {
            let (positions, indices, mesh) = sheet(n, &mut numbers, in_order);
            agrees(&format!("{n}, {in_order}"), &positions, &indices, &mesh);
        }
    }
}

#[test]
fn sheets_whose_coordinates_are_folded_torn_and_flat_have_them_too() {
    let mut numbers = Numbers(2);
    for round in 0..60 {
        let (mut positions, mut indices, mut mesh) =
            sheet(3 + round % 9, &mut numbers, round % 2 == 0);
        let mut uvs = mesh.uvs.to_vec();
        let count = positions.len() as u32;
        for _ in 0..numbers.below(12) {
            let i = numbers.below(count) as usize;
            match numbers.below(4) {
                // Mirrored, turned about, without an area, or in the place of another.
                0 => uvs[i].x = -uvs[i].x,
                1 => uvs[i] = Vec2::new(numbers.next(), numbers.next()),
                2 => uvs[i] = uvs[(i + 1) % count as usize],
                _ => positions[i] = positions[(i + 1) % count as usize],
            }
        }
        if round % 3 == 0 {
            // Corners of their own, though they are equal.
            let same: Vec<u32> = indices.as_flattened().to_vec();
            positions = same.iter().map(|&i| positions[i as usize]).collect();
            uvs = same.iter().map(|&i| uvs[i as usize]).collect();
            let normals: Vec<Vec3> = same.iter().map(|&i| mesh.normals[i as usize]).collect();
            mesh.normals = normals.into();
            indices = (0..indices.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        }
        if round % 4 == 1 {
            // Three triangles at an edge.
            for _ in 0..5 {
                let [a, b, _] = indices[numbers.below(indices.len() as u32) as usize];
                indices.push([b, a, numbers.below(positions.len() as u32)]);
            }
        }
        if round % 5 == 2 {
            mesh.normals = Vec::new().into();
        }
        mesh.uvs = uvs.into();
        agrees(&format!("round {round}"), &positions, &indices, &mesh);
    }
}

#[test]
fn heaps_of_triangles_have_them_too() {
    let mut numbers = Numbers(3);
    for round in 0..300 {
        let points = 4 + numbers.below(12);
        let coarse = round % 2 == 0;
        let number = |numbers: &mut Numbers| {
            let x = numbers.next();
            // Coarse ones are often equal, and 0 with either sign.
            if coarse { (2.0 * x).trunc() / 2.0 } else { x }
        };
        let three = |numbers: &mut Numbers| -> Vec3 {
            Vec3::new(number(numbers), number(numbers), number(numbers))
        };
        let positions: Vec<Vec3> = (0..points).map(|_| three(&mut numbers)).collect();
        let normals: Vec<Vec3> = (0..points).map(|_| three(&mut numbers)).collect();
        let uvs: Vec<Vec2> = (0..points).map(|_| three(&mut numbers).truncate()).collect();
        let count = 1 + numbers.below(40);
        let mut triangles = |missing: bool| -> Vec<[u32; 3]> {
            (0..count)
                .map(|_| {
                    let none = missing && numbers.below(9) == 0;
                    [0, 1, 2].map(|_| if none { NO_INDEX } else { numbers.below(points) })
                })
                .collect()
        };
        let indices = triangles(false);
        let own = |own: bool, other: Vec<[u32; 3]>| if own { other } else { Vec::new() };
        let mesh = MeshAttributes {
            normals: normals.into(),
            normal_indices: own(round % 3 == 0, triangles(true)).into(),
            uvs: uvs.into(),
            uv_indices: own(round % 5 == 0, triangles(true)).into(),
            ..MeshAttributes::default()
        };
        agrees(&format!("round {round}"), &positions, &indices, &mesh);
    }
}

#[test]
fn a_fan_of_many_triangles_has_them_too() {
    let count = 3000_u32;
    let on_rim = |i: u32| {
        let angle = i as f32 / count as f32 * std::f32::consts::TAU;
        Vec3::new(crate::math::cos(angle), 0.3, crate::math::sin(angle))
    };
    let positions: Vec<Vec3> = std::iter::once(Vec3::Y).chain((0..count).map(on_rim)).collect();
    let indices: Vec<[u32; 3]> = (0..count).map(|i| [0, 1 + (i + 1) % count, 1 + i]).collect();
    let mesh = MeshAttributes {
        normals: positions.clone().into(),
        uvs: positions.iter().map(|p| Vec2::new(p.x, p.z)).collect::<Vec<_>>().into(),
        ..MeshAttributes::default()
    };
    agrees("fan", &positions, &indices, &mesh);
}
