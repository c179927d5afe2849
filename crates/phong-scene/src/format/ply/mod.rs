//! PLY, the Stanford polygon format: meshes, clouds of points, and edges as cylinders.
//!
//! Read are ASCII and binary bodies of either byte order, properties of any type in any order, and
//! elements in any order; what is not named here is skipped.
//!
//! | element, property | becomes |
//! |---|---|
//! | `vertex` `x y z` | positions; those of `double`, of large integers and of ASCII files far from the origin are kept relative to [`Mesh::origin`](crate::Mesh::origin) |
//! | `nx ny nz` | normals of a mesh |
//! | `red green blue` (or `r g b`, `diffuse_red` …) | colours: integers are sRGB (0–255, `ushort` 0–65535) and decoded, floats are linear; an `alpha` below 1 is a warning |
//! | `s t` or `u v` | texture coordinates |
//! | `radius` | the radius of a point's sphere |
//! | any other that a texture of kind `map` shows | a number of each point, in `fields` |
//! | `face` `vertex_indices` (or `vertex_index`) | polygons; concave ones are cut by clipping ears |
//! | `texcoord` of a face, a list of two numbers for each corner | texture coordinates, in place of those of vertices |
//! | `texnumber` of a face | which of the images that comments name (`comment TextureFile NAME`) it shows, from 0 on; without, the first |
//! | `red green blue` of a face | its colour, where vertices have none: corners of different colours become different vertices |
//! | `tristrips` `vertex_indices` | strips of triangles, ended by −1 |
//! | `edge` `vertex1 vertex2` | cylinders, where they are asked for or have a radius and there are no faces |
//! | `radius`, or `radius1 radius2` | the radii of an edge's cylinder |
//! | `red green blue` of an edge | its colour; without, each half has that of its vertex |
//!
//! A file without faces is a cloud of points, each drawn as a sphere: of its own `radius`, else of
//! the radius that the scene gives, else of half the median distance between a point and its
//! nearest neighbour, so that neighbours just touch.
//!
//! Images are found beside the file if they are not where it says, and repeat; `<this>` is the file's own
//! name without its ending. They take the place of colours. What cannot be read is a warning, and grey.
//!
//! A vertex without a place or radius is left out with the faces that use it, one without a colour
//! is grey, one without a normal has the geometric one: each is counted in a warning.
//!
//! A count beyond the file's length is refused before anything is allocated, and a body that ends
//! early is an error that says how much of it was there. Gaussian splats, which have no surface
//! to shade, are refused.
//!
//! Own reader: `ply-rs-bw` builds a map from names to values for every vertex.

mod ascii;
mod binary;
mod body;
mod cylinders;
mod edges;
pub(crate) mod export;
mod extras;
mod header;
mod names;
mod regular;
mod textures;
mod vertices;
mod walk;
mod write;

#[cfg(test)]
mod tests;

use std::io;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use self::body::{Body, Contents, face_kind};
use self::edges::{EdgePlan, have_radius};
use self::extras::Extras;
use self::header::{Encoding, Header};
use self::names::RADIUS;
use self::textures::Skins;
use self::vertices::{Plan, Vertices};
use super::faces::Faces;
use super::input::{Input, Wanted};
use super::text::{Findings, whole};
use super::triangles::{any_left, cut, tell_small, tidy};
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::material::{MaterialId, PLAIN};
use crate::mesh::{Shared, collapse_faces};
use crate::shape::Shape;
use crate::source::trouble;

/// Whether a file that begins so is surely PLY.
pub(crate) fn is_ply(head: &[u8]) -> bool {
    head.starts_with(b"ply\n") || head.starts_with(b"ply\r")
}

/// Reads a PLY file; `None` if a diagnostic is an error. A file without faces is a cloud of
/// points, drawn as spheres.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    let file: Arc<str> = input.path.into();
    let mut findings = Findings::default();
    let part = shape_of(&file, input, &mut findings);
    let sound = !findings.any_error();
    findings.tell(&file, out);
    match part {
        Ok(part) => part.filter(|_| sound),
        Err(error) => {
            out.push(Diagnostic::error(
                format!("cannot be read: {}", trouble(&error)),
                whole(&file),
            ));
            None
        }
    }
}

/// The mesh, the points or the cylinders of the file, with its materials.
fn shape_of(
    file: &Arc<str>,
    input: &Input<'_>,
    findings: &mut Findings,
) -> io::Result<Option<Fragment>> {
    let Input { source, limits, radius, wanted, .. } = *input;
    let blob = source.open(file)?;
    let blob = blob.as_ref();
    let Some(header) = Header::read(blob, file, findings)? else { return Ok(None) };
    let Some(vertex) = header.elements.iter().find(|e| e.name == "vertex") else {
        findings.error(
            "files without vertices",
            || whole(file),
            || "there is nothing to draw: the file has no element `vertex`".to_owned(),
        );
        return Ok(None);
    };
    let faces = header.elements.iter().any(|e| face_kind(e).is_some() && e.count > 0);
    let edges = header.elements.iter().find(|e| e.name == "edge" && e.count > 0);
    let edges = match wanted {
        Wanted::Segments if edges.is_none() => {
            findings.error(
                "files without edges",
                || whole(file),
                || "there is nothing to draw: the file has no element `edge`".to_owned(),
            );
            return Ok(None);
        }
        Wanted::Segments => edges,
        Wanted::Points => None,
        // Edges may also be there for wires: a radius says that they are more.
        Wanted::Anything => edges.filter(|edge| !faces && have_radius(edge)),
    };
    let spheres = edges.is_some() || !faces;
    let Some(mut plan) = Plan::new(vertex, spheres, input, findings) else { return Ok(None) };
    let vertex_count = vertex.count;
    let edges = match edges {
        Some(edge) => {
            let Some(edges) = EdgePlan::new(edge, vertex_count, radius, findings) else {
                return Ok(None);
            };
            if !edges.uses_vertex_radii() {
                plan.columns[RADIUS] = None;
            }
            Some(edges)
        }
        None => None,
    };
    let findings_so_far = std::mem::take(findings);
    let mut body = Body {
        blob,
        file,
        header: &header,
        limits,
        plan,
        edges,
        extras: None,
        skins: Skins::default(),
        vertex_count,
        findings: findings_so_far,
    };
    body.dress(input);
    body.check_faces();
    if !limits.lenient {
        body.check_counts();
    }
    let mut contents = Contents::default();
    if !body.findings.any_error() && body.has_room_for_edges() {
        match header.encoding {
            Encoding::Ascii => body.read_ascii(&mut contents)?,
            Encoding::Little | Encoding::Big => body.read_binary(&mut contents)?,
        }
    }
    let part = if body.findings.any_error() { None } else { body.finish(contents) };
    let part = part.map(|shape| body.dressed(shape));
    *findings = body.findings;
    Ok(part)
}

impl Body<'_> {
    /// Refuses counts that the file is too short for, before anything is allocated.
    fn check_counts(&mut self) {
        let header = self.header;
        // A last line may lack its end.
        let mut there = self.blob.len().saturating_sub(header.body).saturating_add(1);
        for element in &header.elements {
            let least = element.least(header.encoding);
            if element.count.saturating_mul(least) > there {
                let (name, count) = (&element.name, element.count);
                let at_most = there.checked_div(least).unwrap_or(0);
                self.findings.error("counts beyond the file", || element.span.clone(), || {
                    format!("the file has room for {at_most} of {count} rows of the element `{name}`: it is cut short or its header is wrong")
                });
                return;
            }
            there -= element.count * least;
        }
    }

    fn finish(&mut self, contents: Contents) -> Option<Shape> {
        let Contents { vertices, faces, extras, edges } = contents;
        if self.plan.transparent.load(Ordering::Relaxed) {
            self.warn("alphas", || {
                "vertices are less than opaque (`alpha`), which is not drawn".to_owned()
            });
        }
        if let Some(plan) = self.edges.clone() {
            return self.cylinders(&plan, vertices, &edges).map(Shape::from);
        }
        if self.plan.spheres {
            return self.finish_points(vertices);
        }
        self.finish_mesh(vertices, faces, extras)
    }

    fn finish_points(&mut self, vertices: Vertices) -> Option<Shape> {
        let mut points = vertices.into_points(&self.plan);
        if points.spheres.is_empty() {
            let span = self.whole();
            let message = match self.vertex_count {
                0 => "there is nothing to draw: the file has no vertex",
                _ => "there is nothing to draw: no vertex is left",
            };
            self.findings.error("empty models", || span, || message.to_owned());
            return None;
        }
        if self.plan.columns[RADIUS].is_none() && self.plan.radius == 0.0 {
            points.guess_radius();
        }
        Some(points.into())
    }

    fn finish_mesh(
        &mut self,
        vertices: Vertices,
        faces: Faces,
        mut extras: Extras,
    ) -> Option<Shape> {
        let mut mesh = vertices.into_mesh(&self.plan);
        let mut polygons = faces.polygons;
        mesh.indices = faces.indices.into();
        extras.place(&mut mesh);
        let images = self.skins.materials.len();
        if images > 1 {
            mesh.face_materials = extras.materials(mesh.indices.len(), images).into();
        }
        self.tell_extras(&extras);
        // What is out of range has been said, as has what is no number.
        let unplaced = mesh.take_unplaced();
        let count = mesh.positions.len();
        let is_bad = |i: u32| {
            let i = i as usize;
            i >= count || unplaced.as_ref().is_some_and(|unplaced| unplaced[i])
        };
        let [gone, triangles] = collapse_faces(&mut mesh.indices, &mut polygons, is_bad);
        if gone > 0 {
            self.warn("faces without their vertices", || {
                format!("faces of which a vertex is left out: {gone}; they are left out")
            });
        }
        cut(&mut mesh, &polygons, &mut self.findings, self.file);
        if self.skins.any() && !mesh.colors.is_empty() {
            if mesh.colors.windows(2).any(|pair| pair[0] != pair[1]) {
                self.warn("colours under a texture", || {
                    "colours of vertices are not drawn where there is a texture".to_owned()
                });
            }
            mesh.colors = Shared::default();
        }
        if !extras.colors.is_empty() {
            extras.colors.resize(mesh.indices.len(), PLAIN);
            mesh.color_faces(&extras.colors);
        }
        tell_small(faces.dropped, &mut self.findings, self.file);
        tidy(&mut mesh, triangles, &mut self.findings, self.file);
        if !any_left(&mesh, &mut self.findings, self.file) {
            return None;
        }
        Some(mesh.into())
    }

    /// Says what of faces is not as it should be.
    fn tell_extras(&mut self, extras: &Extras) {
        let Extras { unfitting, wrong, transparent, .. } = *extras;
        if unfitting > 0 {
            self.warn("texture coordinates that do not fit", || {
                format!("faces whose texture coordinates are not two for each corner: {unfitting}; they are left out")
            });
        }
        if wrong > 0 {
            self.warn("colours that are none", || {
                format!("faces whose colours are none: {wrong}; they are grey")
            });
        }
        if transparent {
            self.warn("alphas of faces", || {
                "faces are less than opaque (`alpha`), which is not drawn".to_owned()
            });
        }
    }

    /// The shape with the materials that it is made of.
    fn dressed(&mut self, shape: Shape) -> Fragment {
        let Skins { materials, textures } = std::mem::take(&mut self.skins);
        let one = matches!(&shape, Shape::Mesh(mesh) if mesh.face_materials.is_empty());
        let first = MaterialId(u32::from(one && !materials.is_empty()));
        let mut fragment = Fragment::of(shape, materials);
        fragment.textures = textures;
        for object in &mut fragment.objects {
            object.material = first;
        }
        fragment
    }
}
