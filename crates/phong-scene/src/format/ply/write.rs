//! Meshes, points and cylinders as PLY.

use std::collections::HashMap;
use std::io::{self, Write};

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use crate::color::{Rgb, srgb_encode};
use crate::format::export::PlyEncoding;
use crate::mesh::{Cylinders, Field, Mesh, NO_INDEX, Points};

impl Mesh {
    /// Writes the mesh as PLY: positions (as doubles if it has an origin), normals, texture
    /// coordinates, colours (as sRGB bytes if all are such, else as linear floats), triangles.
    ///
    /// PLY knows one normal and one texture coordinate a vertex: a position that has several is
    /// written several times. A corner without a normal gets (0, 0, 0), which reads back as
    /// none. Materials are not written: PLY has none.
    ///
    /// # Errors
    /// Whatever `to` says.
    ///
    /// ```
    /// use glam::Vec3;
    /// use phong_scene::{Mesh, PlyEncoding};
    /// let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].into();
    /// let triangle = Mesh { positions, indices: [[0, 1, 2]].into(), ..Mesh::default() };
    /// let mut file = Vec::new();
    /// triangle.write_ply(PlyEncoding::Ascii, &mut file)?;
    /// assert!(file.ends_with(b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn write_ply(&self, encoding: PlyEncoding, to: &mut dyn Write) -> io::Result<()> {
        if !self.has_sound_indices() {
            let message = "an index of the mesh is out of range";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        let (vertices, triangles) = self.single_vertices();
        let mut text = header(encoding, vertices.len(), self.origin);
        let [normals, uvs] = [self.normals.len(), self.uvs.len()].map(|n| n > 0);
        for (wanted, names) in [(normals, &["nx", "ny", "nz"][..]), (uvs, &["s", "t"])] {
            text.extend(names.iter().filter(|_| wanted).map(|name| property(name)));
        }
        let bytes = color_properties(&self.colors, &mut text);
        let fields = field_properties(&self.fields, &mut text);
        text.extend(["element face ", &triangles.len().to_string(), "\n"]);
        text += "property list uchar uint vertex_indices\nend_header\n";
        let mut out = Out { encoding, bytes, row: Vec::new(), to };
        out.to.write_all(text.as_bytes())?;
        for [position, normal, uv] in vertices {
            let at = position as usize;
            out.position(self.positions[at], self.origin);
            if normals {
                let n = self.normals.get(normal as usize).copied().unwrap_or(Vec3::ZERO);
                out.floats(&n.to_array());
            }
            if uvs {
                let uv = self.uvs.get(uv as usize).copied().unwrap_or(Vec2::ZERO);
                out.floats(&uv.to_array());
            }
            out.color(self.colors.get(at));
            out.fields(&fields, at);
            out.end_row()?;
        }
        for triangle in triangles {
            out.triangle(triangle);
            out.end_row()?;
        }
        out.finish()
    }

    /// Every combination of position, normal and texture coordinate that a corner has, in the
    /// order of first use (all positions, if there is one a position), and triangles of them.
    fn single_vertices(&self) -> (Vec<[u32; 3]>, Vec<[u32; 3]>) {
        if self.normal_indices.is_empty() && self.uv_indices.is_empty() {
            let vertices = (0..self.positions.len() as u32).map(|i| [i; 3]).collect();
            return (vertices, self.indices.to_vec());
        }
        let mut numbers = HashMap::new();
        let mut vertices = Vec::new();
        let normals = self.normal_indices.iter().chain(&self.indices);
        let uvs = self.uv_indices.iter().chain(&self.indices);
        let triangles = self.indices.iter().zip(normals).zip(uvs).map(|((p, n), t)| {
            [0, 1, 2].map(|corner| {
                let none = |count: usize, i: u32| if count == 0 { NO_INDEX } else { i };
                let (n, t) = (none(self.normals.len(), n[corner]), none(self.uvs.len(), t[corner]));
                *numbers.entry([p[corner], n, t]).or_insert_with_key(|vertex| {
                    vertices.push(*vertex);
                    vertices.len() as u32 - 1
                })
            })
        });
        let triangles = triangles.collect();
        (vertices, triangles)
    }
}

impl Points {
    /// Writes the points as PLY: centres (as doubles if they have an origin), radii, and colours (as
    /// sRGB bytes if all are such, else as linear floats).
    ///
    /// # Errors
    /// Whatever `to` says.
    pub fn write_ply(&self, encoding: PlyEncoding, to: &mut dyn Write) -> io::Result<()> {
        let mut text = header(encoding, self.spheres.len(), self.origin) + &property("radius");
        let bytes = color_properties(&self.colors, &mut text);
        let fields = field_properties(&self.fields, &mut text);
        let mut out = Out { encoding, bytes, row: Vec::new(), to };
        out.to.write_all((text + "end_header\n").as_bytes())?;
        for (i, &[x, y, z, radius]) in self.spheres.iter().enumerate() {
            out.position(Vec3::new(x, y, z), self.origin);
            out.floats(&[radius]);
            out.color(self.colors.get(i));
            out.fields(&fields, i);
            out.end_row()?;
        }
        out.finish()
    }
}

impl Cylinders {
    /// Writes the cylinders as PLY: ends as vertices (as doubles if they have an origin) with colours (as
    /// sRGB bytes if all are such, else as linear floats), and edges with their radii. What the ends look like is not written: PLY has
    /// no word for it.
    ///
    /// # Errors
    /// Whatever `to` says.
    pub fn write_ply(&self, encoding: PlyEncoding, to: &mut dyn Write) -> io::Result<()> {
        // An end for each place, colour and number, in the order of first use.
        let mut numbers = HashMap::new();
        let mut ends = Vec::new();
        let mut number = |i: usize, end: usize| {
            let [x, y, z, _] = self.segments[i][end];
            let color = self.colors.get(i).map(|colors| colors[end]);
            let bits = |color: Rgb| color.to_array().map(f32::to_bits);
            let own = |field: &Field| field.values.get(2 * i + end).map(|v| v.to_bits());
            let of_fields: Vec<_> = self.fields.iter().map(own).collect();
            let key = ([x, y, z].map(f32::to_bits), color.map(bits), of_fields);
            *numbers.entry(key).or_insert_with(|| {
                ends.push((Vec3::new(x, y, z), color, 2 * i + end));
                ends.len() as u32 - 1
            })
        };
        let count = self.segments.len();
        let edges: Vec<[u32; 2]> = (0..count).map(|i| [number(i, 0), number(i, 1)]).collect();
        let one = self.segments.iter().all(|[from, to]| from[3] == to[3]);
        let radii: &[&str] = if one { &["radius"] } else { &["radius1", "radius2"] };
        let mut text = header(encoding, ends.len(), self.origin);
        let bytes = color_properties(self.colors.as_flattened(), &mut text);
        let fields = field_properties(&self.fields, &mut text);
        text.extend(["element edge ", &count.to_string(), "\n"]);
        text += "property uint vertex1\nproperty uint vertex2\n";
        text.extend(radii.iter().map(|name| property(name)));
        let mut out = Out { encoding, bytes, row: Vec::new(), to };
        out.to.write_all((text + "end_header\n").as_bytes())?;
        for (place, color, end) in &ends {
            out.position(*place, self.origin);
            out.color(color.as_ref());
            out.fields(&fields, *end);
            out.end_row()?;
        }
        for ([from, to], edge) in self.segments.iter().zip(edges) {
            for index in edge {
                out.number(&index.to_le_bytes(), index);
            }
            out.floats(&[from[3], to[3]][..radii.len()]);
            out.end_row()?;
        }
        out.finish()
    }
}

const RGB: [&str; 3] = ["red", "green", "blue"];

fn header(encoding: PlyEncoding, vertices: usize, origin: DVec3) -> String {
    let format = match encoding {
        PlyEncoding::Binary => "binary_little_endian",
        PlyEncoding::Ascii => "ascii",
    };
    let kind = if origin == DVec3::ZERO { "float" } else { "double" };
    format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\n\
         property {kind} x\nproperty {kind} y\nproperty {kind} z\n"
    )
}

fn property(name: &str) -> String {
    format!("property float {name}\n")
}

/// Adds the properties of colours, if there are some; whether they are sRGB bytes.
fn color_properties(colors: &[Rgb], text: &mut String) -> bool {
    let bytes = colors.par_iter().with_min_len(1 << 12).all(|color| bytes_of(*color).is_some());
    let kind = if bytes { "uchar" } else { "float" };
    for name in RGB.iter().filter(|_| !colors.is_empty()) {
        text.extend(["property ", kind, " ", name, "\n"]);
    }
    bytes
}

/// Adds the properties of fields, but for those that the file has anyway.
fn field_properties<'a>(fields: &'a [Field], text: &mut String) -> Vec<&'a Field> {
    let known = |name: &str| text.lines().any(|line| line.split(' ').next_back() == Some(name));
    let is_new = |field: &&Field| !known(&field.name) && field.name.chars().all(is_of_word);
    let new: Vec<_> = fields.iter().filter(is_new).collect();
    text.extend(new.iter().map(|field| property(&field.name)));
    new
}

/// Whether a name with this letter is one word of a header.
fn is_of_word(letter: char) -> bool {
    !letter.is_whitespace() && !letter.is_control()
}

/// The sRGB bytes that decode to this very colour; `None`: there are none.
fn bytes_of(color: Rgb) -> Option<[u8; 3]> {
    let bytes = color.to_array().map(|c| (srgb_encode(f64::from(c)) * 255.0).round() as u8);
    (Rgb::from_srgb8(bytes) == color).then_some(bytes)
}

/// Rows in either encoding.
struct Out<'a> {
    encoding: PlyEncoding,
    /// Whether colours are bytes.
    bytes: bool,
    row: Vec<u8>,
    to: &'a mut dyn Write,
}

impl Out<'_> {
    fn position(&mut self, p: Vec3, origin: DVec3) {
        if origin == DVec3::ZERO {
            self.floats(&p.to_array());
            return;
        }
        for value in (origin + p.as_dvec3()).to_array() {
            self.number(&value.to_le_bytes(), value);
        }
    }

    fn floats(&mut self, values: &[f32]) {
        for value in values {
            self.number(&value.to_le_bytes(), value);
        }
    }

    fn color(&mut self, color: Option<&Rgb>) {
        let Some(color) = color else { return };
        match bytes_of(*color).filter(|_| self.bytes) {
            Some(bytes) => bytes.into_iter().for_each(|byte| self.number(&[byte], byte)),
            None => self.floats(&color.to_array()),
        }
    }

    fn fields(&mut self, fields: &[&Field], at: usize) {
        for field in fields {
            self.floats(&[field.values.get(at).copied().unwrap_or(f32::NAN)]);
        }
    }

    fn triangle(&mut self, triangle: [u32; 3]) {
        self.number(&[3], 3);
        for index in triangle {
            self.number(&index.to_le_bytes(), index);
        }
    }

    fn number(&mut self, bytes: &[u8], value: impl std::fmt::Display) {
        match self.encoding {
            PlyEncoding::Binary => self.row.extend_from_slice(bytes),
            PlyEncoding::Ascii => {
                // Writing to a vector does not fail. The shortest digits read back to the bit.
                let _ = write!(self.row, "{value} ");
            }
        }
    }

    fn end_row(&mut self) -> io::Result<()> {
        if self.encoding == PlyEncoding::Ascii {
            self.row.pop();
            self.row.push(b'\n');
        }
        if self.row.len() >= 1 << 16 {
            self.to.write_all(&self.row)?;
            self.row.clear();
        }
        Ok(())
    }

    fn finish(self) -> io::Result<()> {
        self.to.write_all(&self.row)?;
        self.to.flush()
    }
}
