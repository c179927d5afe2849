//! Model files that are named more than once: each is read once, and its arrays are shared.

use std::collections::BTreeMap;

use crate::format::input::Wanted;
use crate::fragment::Fragment;
use crate::mesh::{Mesh, Shared};

/// A lexically normal path, what was wanted and how many fields were, and the bits of the radius of what
/// brings none.
type Asked = (String, (Wanted, usize), Option<u32>);

/// What was read of model files, and what was made of it.
#[derive(Debug, Default)]
pub(super) struct Models {
    fragments: BTreeMap<Asked, Fragment>,
    /// Meshes that were made smooth, with their normals.
    smooth: Vec<(Mesh, u64)>,
}

impl Models {
    /// What the file at `path` holds, if it was read before.
    pub(super) fn find(
        &self,
        path: &str,
        wanted: (Wanted, usize),
        radius: Option<f32>,
    ) -> Option<Fragment> {
        self.fragments.get(&(path.to_owned(), wanted, radius.map(f32::to_bits))).cloned()
    }

    /// Remembers what was read.
    pub(super) fn keep(
        &mut self,
        path: String,
        wanted: (Wanted, usize),
        radius: Option<f32>,
        fragment: &Fragment,
    ) {
        self.fragments.insert((path, wanted, radius.map(f32::to_bits)), fragment.clone());
    }

    /// Gives a mesh normals in place of its own, as [`Mesh::smooth`] does; once for each mesh.
    pub(super) fn smooth(&mut self, mesh: &mut Mesh, degrees: f64) {
        let same = |(other, bits): &&(Mesh, u64)| {
            Shared::is_same(&other.positions, &mesh.positions)
                && Shared::is_same(&other.indices, &mesh.indices)
                && *bits == degrees.to_bits()
        };
        if let Some((other, _)) = self.smooth.iter().find(same) {
            mesh.normals = other.normals.clone();
            mesh.normal_indices = other.normal_indices.clone();
            return;
        }
        mesh.smooth(degrees);
        self.smooth.push((mesh.clone(), degrees.to_bits()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Limits;
    use crate::shape::Shape;
    use crate::source::Memory;

    #[test]
    fn meshes_of_one_file_share_what_is_the_same_about_them() {
        let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                   property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
                   end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                    [materials.red]\n[[mesh]]\nfile = \"a.ply\"\n\
                    [[mesh]]\nfile = \"./a.ply\"\nmaterial = \"red\"\n\
                    [[mesh]]\nfile = \"a.ply\"\nsmooth = false\n";
        let files = Memory::new().with("a.ply", ply.as_bytes()).with("s.toml", text.as_bytes());
        let scene = crate::format::read("s.toml", None, &files, &Limits::default()).scene.unwrap();
        let mesh = |i: usize| match &scene.objects[i].shape {
            Shape::Mesh(mesh) => mesh,
            other => panic!("{other:?}"),
        };
        for i in [1, 2] {
            assert!(Shared::is_same(&mesh(0).positions, &mesh(i).positions));
            assert!(Shared::is_same(&mesh(0).indices, &mesh(i).indices));
        }
        assert!(Shared::is_same(&mesh(0).normals, &mesh(1).normals));
        assert_eq!((mesh(0).normals.len(), mesh(2).normals.len()), (3, 0));
    }
}
