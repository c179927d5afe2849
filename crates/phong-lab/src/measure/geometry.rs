//! What a geometry holds, counted.

use phong::geometry::Geometry;
use phong_bvh::{Primitives, Stats};

/// What a geometry holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Holdings {
    /// Triangles of meshes, instances unfolded.
    pub triangles: u64,
    /// Spheres, those of clouds included.
    pub spheres: u64,
    /// Cylinders of bundles.
    pub cylinders: u64,
    /// Everything else: planes and solids.
    pub other: u64,
    /// Inner nodes of the trees.
    pub nodes: u64,
    /// Bytes of the trees and of what stands in their leaves.
    pub bytes: u64,
}

impl Holdings {
    /// That of a geometry.
    pub fn of(geometry: &Geometry) -> Self {
        let world = geometry.world();
        let Stats { nodes, bytes, .. } = world.stats();
        let mut all = Self { nodes, bytes, ..Self::default() };
        for part in 0..world.parts() as u32 {
            let primitives = world.primitives(part);
            let of_kind = match primitives {
                Primitives::Triangles { .. } => &mut all.triangles,
                Primitives::Spheres(_) => &mut all.spheres,
                Primitives::Cylinders { .. } => &mut all.cylinders,
                Primitives::Plane(_) | Primitives::Solid(_) => &mut all.other,
            };
            *of_kind += primitives.len() as u64;
        }
        all
    }

    /// Primitives of every kind.
    pub fn primitives(&self) -> u64 {
        self.triangles + self.spheres + self.cylinders + self.other
    }

    /// Bytes for each primitive; of an empty geometry its bytes.
    pub fn bytes_per_primitive(&self) -> f64 {
        self.bytes as f64 / self.primitives().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use phong::geometry::GeometryOptions;
    use phong_scene::{Limits, Memory, read};

    use super::*;

    #[test]
    fn what_a_scene_holds_is_counted_by_kind() {
        let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                    [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
                    [[sphere]]\ncenter = [3, 0, 0]\nradius = 1\n\
                    [[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n";
        let files = Memory::new().with("a.toml", text.as_bytes());
        let scene = read("a.toml", None, &files, &Limits::default()).scene.unwrap();
        let held = Holdings::of(&Geometry::new(&scene, GeometryOptions::default()).unwrap());
        assert_eq!((held.triangles, held.spheres, held.other), (0, 2, 1));
        assert_eq!(held.primitives(), 3);
        assert!(held.bytes > 0 && held.bytes_per_primitive() > 0.0);
    }
}
