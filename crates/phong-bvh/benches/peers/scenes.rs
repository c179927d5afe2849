//! What is traced: two scanned meshes and eight made by rule, the same on every machine.

use std::{fs, io, path::Path};

use glam::Vec3;
use phong_bvh::{Caps, Cylinder, Primitives, Sphere};

/// The names of all scenes.
pub(crate) const NAMES: [&str; 10] = [
    "bunny", "dragon", "terrain", "sticks", "spheres", "clusters", "bonds", "rods", "chains",
    "beads",
];

/// A scene by name; the meshes are read from `folder`.
pub(crate) fn load(name: &str, folder: &Path) -> io::Result<Primitives> {
    Ok(match name {
        "bunny" | "dragon" => mesh(&folder.join(format!("{name}.mesh")))?,
        "terrain" => terrain(1025),
        "sticks" => sticks(30_000),
        "spheres" => uniform(1_000_000),
        "clusters" => clustered(1_000_000),
        "bonds" => bonds(1_000_000, Caps::Round),
        "rods" => bonds(1_000_000, Caps::Flat),
        "chains" => chains(1_000, 1_000).0,
        "beads" => chains(1_000, 1_000).1,
        _ => panic!("there is no scene {name}"),
    })
}

/// Random numbers: Steele, Lea and Flood's `SplitMix64`.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1_u32 << 24) as f32
    }

    /// In [−1, 1)³.
    pub(crate) fn cube(&mut self) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|_| 2.0 * self.unit() - 1.0))
    }

    /// Uniform on the unit sphere, by rejection.
    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.cube();
            let square = v.length_squared();
            if (1e-4..=1.0).contains(&square) {
                return v / square.sqrt();
            }
        }
    }
}

/// The file `setup.sh` writes: counts, positions, corners; little-endian.
fn mesh(path: &Path) -> io::Result<Primitives> {
    let bytes = fs::read(path)?;
    let (words, rest) = bytes.as_chunks::<4>();
    let count = |i: usize| words.get(i).map_or(0, |&word| u32::from_le_bytes(word) as usize);
    let (vertices, triangles) = (count(0), count(1));
    if !rest.is_empty() || words.len() != 2 + 3 * (vertices + triangles) {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "not a mesh file, or cut short"));
    }
    let (positions, indices) = words[2..].as_chunks::<3>().0.split_at(vertices);
    let positions = positions.iter().map(|p| Vec3::from(p.map(f32::from_le_bytes)));
    let indices = indices.iter().map(|t| t.map(u32::from_le_bytes));
    Ok(Primitives::triangles(positions.collect::<Vec<_>>(), indices.collect::<Vec<_>>()))
}

/// A square of `side`² heights, ten octaves of value noise: 2 (side − 1)² triangles.
pub(crate) fn terrain(side: u32) -> Primitives {
    let mut height = vec![0.0_f32; (side * side) as usize];
    for octave in 1..=10_u32 {
        let cells = 1_u32 << octave;
        let mut random = Random(u64::from(octave));
        let lattice: Vec<f32> = (0..(cells + 2) * (cells + 2)).map(|_| random.unit()).collect();
        let at = |x: u32, y: u32| lattice[(y * (cells + 2) + x) as usize];
        for j in 0..side {
            for i in 0..side {
                let scaled = |k: u32| (k * cells) as f32 / (side - 1) as f32;
                let (x, y) = (scaled(i), scaled(j));
                let (x0, y0) = (x as u32, y as u32);
                let ease = |t: f32| t * t * (3.0 - 2.0 * t);
                let (u, v) = (ease(x - x0 as f32), ease(y - y0 as f32));
                let low = at(x0, y0) + u * (at(x0 + 1, y0) - at(x0, y0));
                let high = at(x0, y0 + 1) + u * (at(x0 + 1, y0 + 1) - at(x0, y0 + 1));
                height[(j * side + i) as usize] += 0.5 * (low + v * (high - low)) / cells as f32;
            }
        }
    }
    let position = |k: u32| {
        let (i, j) = (k % side, k / side);
        let flat = |k: u32| 2.0 * k as f32 / (side - 1) as f32 - 1.0;
        Vec3::new(flat(i), flat(j), height[k as usize])
    };
    let cell = |k: u32| {
        let corner = k / (side - 1) * side + k % (side - 1);
        [[corner, corner + 1, corner + side], [corner + side, corner + 1, corner + side + 1]]
    };
    let indices = (0..(side - 1) * (side - 1)).flat_map(cell);
    Primitives::triangles(
        (0..side * side).map(position).collect::<Vec<_>>(),
        indices.collect::<Vec<_>>(),
    )
}

/// Square sticks, 250 times as long as they are thick, every way up: 12 triangles each.
fn sticks(count: u32) -> Primitives {
    const FACES: [[u32; 3]; 12] = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let mut random = Random(3);
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for stick in 0..count {
        let middle = random.cube();
        let along = random.direction();
        let [x, y] = along.any_orthonormal_pair().into();
        for corner in 0..8 {
            let sign = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let across = 4e-4 * (sign(0) * x + sign(1) * y);
            positions.push(middle + across + 0.1 * sign(2) * along);
        }
        indices.extend(FACES.map(|face| face.map(|corner| 8 * stick + corner)));
    }
    Primitives::triangles(positions, indices)
}

/// Small spheres all over a cube.
pub(crate) fn uniform(count: u32) -> Primitives {
    let mut random = Random(1);
    let mut sphere = |_| Sphere { center: random.cube(), radius: 0.004 * (0.5 + random.unit()) };
    Primitives::spheres((0..count).map(&mut sphere).collect::<Vec<_>>())
}

/// Spheres of very different sizes, crowded around a few hundred places.
fn clustered(count: u32) -> Primitives {
    let mut random = Random(2);
    let places: Vec<(Vec3, f32)> =
        (0..300).map(|_| (random.cube(), 0.02 + 0.1 * random.unit())).collect();
    let sphere = |_| {
        let (place, spread) = places[random.bits() as usize % places.len()];
        // The cube of the distance: crowded in the middle. The power of the radius: few large ones.
        let distance = random.unit();
        let center = place + spread * distance * distance * random.direction();
        let size = random.unit();
        let size = size * size;
        Sphere { center, radius: spread * (0.002 + 0.04 * size * size * size) }
    };
    Primitives::spheres((0..count).map(sphere).collect::<Vec<_>>())
}

/// Capsules all over a cube, every way up, and about eight radii long between the middles of their
/// ends, as bonds are. Half as thick as the spheres of [`uniform`], they hide about as much.
fn bonds(count: u32, caps: Caps) -> Primitives {
    let mut random = Random(1);
    let bond = |_| {
        let (middle, radius) = (random.cube(), 0.002 * (0.5 + random.unit()));
        let half = 0.008 * random.direction();
        Cylinder { from: middle - half, radius, to: middle + half, radius_to: radius }
    };
    Primitives::cylinders((0..count).map(bond).collect::<Vec<_>>(), caps)
}

/// Molecules as sticks, and the same as balls: chains of atoms, each bond at the tetrahedral angle to the one
/// before. Sticks are as thick as drawings have them, an eighth of their length; the balls, one a bond, hide
/// as much: π R² is half of π times radius times length, what a stick hides on average.
fn chains(count: u32, length: u32) -> (Primitives, Primitives) {
    const LONG: f32 = 0.016;
    const RADIUS: f32 = LONG / 8.0;
    let mut random = Random(4);
    let (mut sticks, mut balls) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let (mut from, mut along) = (random.cube(), random.direction());
        for _ in 0..length {
            let across = along.cross(random.direction()).normalize_or(Vec3::X);
            along = (along / 3.0 + 0.942_809 * across).normalize_or(Vec3::X);
            // Chains stay in the cube.
            along = Vec3::select(from.abs().cmpgt(Vec3::ONE), -along.abs() * from.signum(), along);
            let to = from + LONG * along;
            sticks.push(Cylinder { from, radius: RADIUS, to, radius_to: RADIUS });
            balls.push(Sphere { center: from, radius: (0.5 * RADIUS * LONG).sqrt() });
            from = to;
        }
    }
    (Primitives::cylinders(sticks, Caps::Round), Primitives::spheres(balls))
}
