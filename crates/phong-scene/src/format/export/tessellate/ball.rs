//! Spheres: an icosahedron, of which every face is cut into n² and drawn out to the sphere.

use std::collections::BTreeMap;

use glam::DVec3;

use super::count::{Size, whole};
use super::turned::Turned;
use crate::color::Rgb;

/// The middle of no triangle is farther from the unit sphere than this over n².
const SAG: f64 = 0.293;

/// The corners of an icosahedron are those with `1 : φ : 0` for coordinates.
const PHI: f64 = 1.618_033_988_749_895;

const CORNERS: [[f64; 3]; 12] = [
    [-1.0, PHI, 0.0],
    [1.0, PHI, 0.0],
    [-1.0, -PHI, 0.0],
    [1.0, -PHI, 0.0],
    [0.0, -1.0, PHI],
    [0.0, 1.0, PHI],
    [0.0, -1.0, -PHI],
    [0.0, 1.0, -PHI],
    [PHI, 0.0, -1.0],
    [PHI, 0.0, 1.0],
    [-PHI, 0.0, -1.0],
    [-PHI, 0.0, 1.0],
];

/// Its faces, counter-clockwise seen from outside.
const FACES: [[u8; 3]; 20] = [
    [0, 11, 5],
    [0, 5, 1],
    [0, 1, 7],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [5, 11, 4],
    [11, 10, 2],
    [10, 7, 6],
    [7, 1, 8],
    [3, 9, 4],
    [3, 4, 2],
    [3, 2, 6],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [2, 4, 11],
    [6, 2, 10],
    [8, 6, 7],
    [9, 8, 1],
];

/// Into how many parts each edge is cut.
fn parts(radius: f64, within: f64) -> u32 {
    whole((SAG * radius / within).sqrt()).max(1)
}

/// What becomes of a sphere.
pub(super) fn size(radius: f64, within: f64) -> Size {
    let square = u64::from(parts(radius, within)).pow(2);
    Size { vertices: 10 * square + 2, triangles: 20 * square }
}

/// Unit spheres, by the parts of their edges.
#[derive(Debug, Default)]
pub(super) struct Balls {
    made: BTreeMap<u32, Ball>,
}

impl Balls {
    /// Adds a sphere.
    pub(super) fn add(
        &mut self,
        center: DVec3,
        radius: f64,
        within: f64,
        color: Option<Rgb>,
        out: &mut Turned,
    ) {
        let parts = parts(radius, within);
        let ball = self.made.entry(parts).or_insert_with(|| Ball::of(parts));
        let place = |unit: &DVec3| ((center + radius * *unit).as_vec3(), unit.as_vec3());
        out.closed(ball.units.iter().map(place), &ball.triangles, color);
    }
}

/// A unit sphere.
#[derive(Debug)]
struct Ball {
    units: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Ball {
    fn of(parts: u32) -> Self {
        let corners = CORNERS.map(|corner| DVec3::from(corner).normalize_or(DVec3::Y));
        let mut units = Vec::new();
        let mut known: BTreeMap<[(u8, u32); 3], u32> = BTreeMap::new();
        let mut triangles = Vec::new();
        for face in FACES {
            // Neighbouring faces say the same of a corner on their common edge.
            let mut corner = |shares: [u32; 3]| {
                let mut key = [0, 1, 2].map(|i| (face[i], shares[i]));
                key.iter_mut().filter(|(_, share)| *share == 0).for_each(|none| *none = (0, 0));
                key.sort_unstable();
                *known.entry(key).or_insert_with(|| {
                    let sum: DVec3 = key
                        .iter()
                        .map(|(i, share)| f64::from(*share) * corners[usize::from(*i)])
                        .sum();
                    units.push(sum.normalize_or(DVec3::Y));
                    units.len() as u32 - 1
                })
            };
            for row in 0..parts {
                for column in 0..parts - row {
                    let mut at = |i: u32, j: u32| {
                        corner([parts - row - column - i - j, column + i, row + j])
                    };
                    let [a, b, c] = [at(0, 0), at(1, 0), at(0, 1)];
                    triangles.push([a, b, c]);
                    if column + 1 < parts - row {
                        triangles.push([b, at(1, 1), c]);
                    }
                }
            }
        }
        Self { units, triangles }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn no_triangle_is_farther_from_the_sphere_than_the_count_is_made_for() {
        for parts in 1..=24 {
            let ball = Ball::of(parts);
            let square = (parts * parts) as usize;
            assert_eq!((ball.units.len(), ball.triangles.len()), (10 * square + 2, 20 * square));
            let nearest = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|i| ball.units[i as usize]);
                (b - a).cross(c - a).normalize_or(DVec3::ZERO).dot(a)
            };
            let least = ball.triangles.iter().map(nearest).fold(1.0, f64::min);
            assert!(least > 0.0, "every triangle shows its outer side");
            let sag = (1.0 - least) * f64::from(parts * parts);
            assert!(sag <= SAG, "{parts}: {sag}");
        }
        let [radius, within] = [2.0, 0.01];
        let n = f64::from(parts(radius, within));
        assert!(radius * SAG / (n * n) <= within);
        assert!(radius * SAG / ((n - 1.0) * (n - 1.0)) > within, "no more than are needed");
    }

    #[test]
    fn unit_vectors_keep_their_length() {
        let mut out = Turned::default();
        Balls::default().add(DVec3::X, 2.0, 0.5, None, &mut out);
        let mesh = out.mesh(DVec3::ZERO);
        for (p, n) in mesh.positions.iter().zip(mesh.normals.iter()) {
            assert!((*p - (Vec3::X + 2.0 * *n)).length() < 1e-6);
        }
    }
}
