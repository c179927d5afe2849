//! Meshes as OBJ.

use std::io::{self, BufWriter, Write};

use glam::DVec3;

use crate::color::{srgb_decode, srgb_encode};
use crate::material::Material;
use crate::mesh::{Mesh, NO_INDEX};

impl Mesh {
    /// Writes the mesh as OBJ text that reads back to the same bits: positions with their colours,
    /// texture coordinates, normals, and triangles, with `usemtl` where `materials` (which
    /// `face_materials` indexes) change. The materials themselves are for an MTL file.
    ///
    /// # Errors
    /// Whatever `to` says.
    ///
    /// ```
    /// use glam::Vec3;
    /// use phong_scene::Mesh;
    /// let positions = [Vec3::ZERO, Vec3::X, 0.1 * Vec3::Y].into();
    /// let triangle = Mesh { positions, indices: [[0, 1, 2]].into(), ..Mesh::default() };
    /// let mut file = Vec::new();
    /// triangle.write_obj(&[], &mut file)?;
    /// assert_eq!(file, b"v 0 0 0\nv 1 0 0\nv 0 0.1 0\nf 1 2 3\n");
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn write_obj(&self, materials: &[Material], to: &mut dyn Write) -> io::Result<()> {
        self.write_obj_objects(materials, &[], to)
    }

    /// The same with the names of objects, each before the triangle whose number stands with it.
    pub(crate) fn write_obj_objects(
        &self,
        materials: &[Material],
        objects: &[(usize, String)],
        to: &mut dyn Write,
    ) -> io::Result<()> {
        if !self.has_sound_indices() {
            let message = "an index of the mesh is out of range";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        let to = &mut BufWriter::with_capacity(1 << 16, to);
        for (i, p) in self.positions.iter().enumerate() {
            if self.origin == DVec3::ZERO {
                write!(to, "v {} {} {}", p.x, p.y, p.z)?;
            } else {
                let p = self.origin + p.as_dvec3();
                write!(to, "v {} {} {}", p.x, p.y, p.z)?;
            }
            match self.colors.get(i) {
                Some(c) => {
                    let [r, g, b] = c.to_array().map(encoded);
                    writeln!(to, " {r} {g} {b}")?;
                }
                None => writeln!(to)?,
            }
        }
        for uv in &self.uvs {
            writeln!(to, "vt {} {}", uv.x, uv.y)?;
        }
        for n in &self.normals {
            writeln!(to, "vn {} {} {}", n.x, n.y, n.z)?;
        }
        let uvs = Corners::new(self.uvs.len(), &self.uv_indices, &self.indices);
        let normals = Corners::new(self.normals.len(), &self.normal_indices, &self.indices);
        let mut material = None;
        let mut objects = objects.iter().peekable();
        for (face, corners) in self.indices.iter().enumerate() {
            while let Some((_, name)) = objects.next_if(|(first, _)| *first <= face) {
                writeln!(to, "o {name}")?;
            }
            let used = self.face_materials.get(face);
            if material != used {
                material = used;
                if let Some(material) = used.and_then(|m| materials.get(*m as usize)) {
                    writeln!(to, "usemtl {}", material.name)?;
                }
            }
            write!(to, "f")?;
            for (corner, position) in corners.iter().enumerate() {
                let position = u64::from(*position) + 1;
                match (uvs.number(face, corner), normals.number(face, corner)) {
                    (None, None) => write!(to, " {position}")?,
                    (Some(uv), None) => write!(to, " {position}/{uv}")?,
                    (None, Some(normal)) => write!(to, " {position}//{normal}")?,
                    (Some(uv), Some(normal)) => write!(to, " {position}/{uv}/{normal}")?,
                }
            }
            writeln!(to)?;
        }
        to.flush()
    }
}

/// A linear channel as sRGB, in so many digits that it is decoded to the same bits.
fn encoded(channel: f32) -> String {
    let exact = srgb_encode(f64::from(channel));
    let same = |text: &String| {
        let back = text.parse().map(srgb_decode).map(|c| c as f32);
        back.is_ok_and(|back| back.to_bits() == channel.to_bits())
    };
    let short = std::iter::once((exact as f32).to_string());
    let longer = (9..18).map(|digits| format!("{exact:.digits$}"));
    short.chain(longer).find(same).unwrap_or_else(|| exact.to_string())
}

/// The texture coordinates or normals of corners.
struct Corners<'a>(Option<&'a [[u32; 3]]>);

impl<'a> Corners<'a> {
    fn new(count: usize, own: &'a [[u32; 3]], positions: &'a [[u32; 3]]) -> Self {
        Self((count > 0).then_some(if own.is_empty() { positions } else { own }))
    }

    /// Counted from 1.
    fn number(&self, face: usize, corner: usize) -> Option<u64> {
        let index = self.0?.get(face)?[corner];
        (index != NO_INDEX).then_some(u64::from(index) + 1)
    }
}
