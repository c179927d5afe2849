//! Blocks put together in the order of the file.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec2;
use rayon::prelude::*;

use super::block::{BAD_INDEX, Block, Context, Indices, Mark, NO_COLOR, absolute};
use super::libraries::Libraries;
use crate::color::{Rgb, are_bytes, srgb_decode};
use crate::diagnostic::Span;
use crate::format::input::Input;
use crate::format::text::{Cursor, Findings, Piece, TOLD, whole};
use crate::format::triangles::{cut, tidy};
use crate::fragment::Fragment;
use crate::limits::Limits;
use crate::material::{Material, VertexColors};
use crate::mesh::{FLAT, Mesh, NO_INDEX, Points, Shared, collapse_faces};
use crate::scene::Object;
use crate::shape::Shape;
use crate::source::Blob;

/// What the three indices of a corner refer to.
const KINDS: [&str; 3] = ["position", "texture coordinate", "normal"];

/// A file of which all blocks so far are put together.
#[derive(Debug, Default)]
pub(super) struct Assembly {
    mesh: Mesh,
    colored: u64,
    polygons: Vec<[u32; 2]>,
    /// From which triangle on which of `names` is used.
    runs: Vec<(u32, u32)>,
    names: Vec<(String, Span)>,
    numbers: BTreeMap<String, u32>,
    /// From which triangle on which smoothing group the faces are of.
    smoothing: Vec<(u32, u32)>,
    /// The positions of point elements.
    points: Vec<u32>,
    has_lines: bool,
    blocks: Vec<Start>,
    /// Whether a limit was met, and the rest of the file not read.
    stopped: bool,
    /// How many triangles were made nothing of, which is said elsewhere.
    lost: u64,
    pub(super) libraries: Vec<(String, Span)>,
    pub(super) findings: Findings,
}

/// Where a block begins.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Start {
    /// Bytes into the file.
    pub(super) offset: u64,
    /// Its length in bytes.
    pub(super) length: usize,
    /// The number of its first line.
    pub(super) line: u64,
    triangle: u32,
    counts: [usize; 3],
}

impl Assembly {
    /// Adds the next block; whether there is room for more.
    pub(super) fn add(
        &mut self,
        start: Start,
        block: Block,
        file: &Arc<str>,
        limits: &Limits,
    ) -> bool {
        let mesh = &mut self.mesh;
        let counts = [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()];
        let triangles = mesh.indices.len();
        self.findings.append(block.findings);
        let total = (triangles + block.indices[0].triangles.len()) as u64;
        let vertices = (counts[0] + block.positions.len())
            .max(counts[1] + block.uvs.len())
            .max(counts[2] + block.normals.len()) as u64;
        let new = Mesh {
            positions: block.positions.into(),
            colors: block.colors.into(),
            uvs: block.uvs.into(),
            normals: block.normals.into(),
            ..Mesh::default()
        };
        let indices: usize = block.indices.iter().map(|i| i.triangles.len()).sum();
        let bytes = mesh.bytes() + new.bytes() + 12 * indices as u64;
        if bytes > limits.bytes || vertices > limits.vertices || total > limits.triangles {
            self.findings.error(
                "limits exceeded",
                || whole(file),
                || {
                    if bytes > limits.bytes {
                        format!("the model takes more than {} bytes of memory", limits.bytes)
                    } else if total > limits.triangles {
                        format!("the model has more than {} triangles", limits.triangles)
                    } else {
                        format!("the model has more than {} vertices", limits.vertices)
                    }
                },
            );
            self.stopped = true;
            return false;
        }

        self.blocks.push(Start { triangle: triangles as u32, counts, ..start });
        if !new.colors.is_empty() {
            mesh.colors.resize(counts[0], NO_COLOR);
            mesh.colors.extend(&new.colors);
        } else if !mesh.colors.is_empty() {
            mesh.colors.resize(counts[0] + new.positions.len(), NO_COLOR);
        }
        self.colored += block.colored;
        mesh.positions.extend(&new.positions);
        mesh.uvs.extend(&new.uvs);
        mesh.normals.extend(&new.normals);
        let [positions, uvs, normals] = block.indices;
        append(&mut mesh.indices, positions, counts[0], [triangles, total as usize]);
        append(&mut mesh.uv_indices, uvs, counts[1], [triangles, total as usize]);
        append(&mut mesh.normal_indices, normals, counts[2], [triangles, total as usize]);
        let first = triangles as u32;
        self.polygons.extend(block.polygons.into_iter().map(|[start, n]| [start + first, n]));
        for (start, name, span) in block.materials {
            let number = *self.numbers.entry(name.clone()).or_insert_with(|| {
                self.names.push((name, span));
                self.names.len() as u32 - 1
            });
            self.runs.push((first + start, number));
        }
        self.smoothing.extend(block.smoothing.into_iter().map(|(start, g)| (first + start, g)));
        self.points.extend(block.points.into_iter().map(|i| absolute(i, counts[0])));
        self.has_lines |= block.has_lines;
        self.libraries.extend(block.libraries);
        true
    }

    /// Checks every index, cuts the polygons, and gives every triangle its material.
    pub(super) fn finish(
        mut self,
        blob: &dyn Blob,
        context: &Context,
        libraries: &mut Libraries<'_>,
        input: &Input<'_>,
    ) -> (Option<Fragment>, Findings) {
        let at_file = || whole(&context.file);
        if !self.stopped {
            self.check_indices(blob, context, input.limits.lenient);
            self.check_points(context);
        }
        if self.mesh.indices.is_empty() && self.points.is_empty() && !self.has_lines {
            // As a file of PLY without faces.
            self.points = (0..self.mesh.positions.len() as u32).collect();
        }
        if self.mesh.indices.is_empty() && self.points.is_empty() && !self.findings.any_error() {
            let count = self.mesh.positions.len();
            self.findings.error("empty models", at_file, || {
                if self.has_lines {
                    format!(
                        "there is nothing to draw: lines (`l`) alone among {count} vertices, which \
                         are not drawn"
                    )
                } else {
                    format!("there is nothing to draw: no face and no point among {count} vertices")
                }
            });
        }
        if self.findings.any_error() {
            return (None, self.findings);
        }
        self.mesh.origin = context.origin;
        self.mend_colors(context);
        let mut materials = self.assign_materials(libraries);
        if !self.mesh.colors.is_empty() {
            self.prefer_images(&mut materials, context);
        }
        let unplaced = self.mesh.take_unplaced();
        let points = self.take_points(unplaced.as_deref(), input.radius, context);
        let mesh = self.triangulate(unplaced.as_deref(), context);
        let shapes = mesh.map(Shape::from).into_iter().chain(points.map(Shape::from));
        let nameless = |shape| Object { name: String::new(), ..Object::from(shape) };
        let objects = shapes.map(nameless).collect();
        let mut fragment = Fragment { objects, ..Fragment::default() };
        fragment.materials.extend(materials);
        fragment.textures = libraries.textures();
        if fragment.objects.is_empty() {
            self.findings.error("empty models", at_file, || {
                "there is nothing to draw: no face is left".to_owned()
            });
        }
        let sound = !self.findings.any_error();
        (sound.then_some(fragment), self.findings)
    }

    /// The faces as triangles, with their normals; `None`: none are left.
    fn triangulate(&mut self, unplaced: Option<&[bool]>, context: &Context) -> Option<Mesh> {
        let at_file = || whole(&context.file);
        let mut mesh = std::mem::take(&mut self.mesh);
        let findings = &mut self.findings;
        let mut gone = self.lost;
        if let Some(unplaced) = unplaced {
            let is_unplaced = |i: u32| unplaced.get(i as usize).copied().unwrap_or(false);
            let [faces, triangles] =
                collapse_faces(&mut mesh.indices, &mut self.polygons, is_unplaced);
            let count = unplaced.iter().filter(|unplaced| **unplaced).count();
            findings.warning("faces without their positions", at_file, || {
                format!(
                    "faces that use the {count} positions that are no numbers: {faces}; they are \
                     left out"
                )
            });
            gone += triangles;
        }
        cut(&mut mesh, &self.polygons, findings, &context.file);
        if mesh.normals.is_empty() && !self.smoothing.is_empty() {
            let ends = self.smoothing.iter().map(|(start, _)| *start).chain([u32::MAX]);
            let mut groups = vec![FLAT; mesh.indices.len()];
            for ((start, group), end) in self.smoothing.iter().zip(ends.skip(1)) {
                let range = *start as usize..(end as usize).min(groups.len());
                if let Some(faces) = groups.get_mut(range) {
                    faces.fill(*group);
                }
            }
            mesh.smooth_groups(&groups);
        }
        tidy(&mut mesh, gone, findings, &context.file);
        let positions = mesh.positions.len();
        if mesh.normals.len() == positions && mesh.normal_indices == mesh.indices {
            mesh.normal_indices = Shared::default();
        }
        if mesh.uvs.len() == positions && mesh.uv_indices == mesh.indices {
            mesh.uv_indices = Shared::default();
        }
        mesh.uvs.iter_mut().filter(|uv| !uv.is_finite()).for_each(|uv| *uv = Vec2::ZERO);
        if mesh.indices.is_empty() {
            return None;
        }
        Some(mesh)
    }

    /// The spheres of the point elements; `None`: there are none.
    fn take_points(
        &self,
        unplaced: Option<&[bool]>,
        radius: Option<f32>,
        context: &Context,
    ) -> Option<Points> {
        let placed = |i: &&u32| !unplaced.is_some_and(|unplaced| unplaced[**i as usize]);
        let kept: Vec<u32> = self.points.iter().filter(placed).copied().collect();
        let mut points = Points { origin: context.origin, ..Points::default() };
        points.spheres = kept
            .iter()
            .map(|&i| self.mesh.positions[i as usize])
            .map(|p| [p.x, p.y, p.z, radius.unwrap_or(0.0)])
            .collect();
        if !self.mesh.colors.is_empty() {
            points.colors = kept.iter().map(|&i| self.mesh.colors[i as usize]).collect();
        }
        if points.spheres.is_empty() {
            return None;
        }
        if radius.is_none() {
            points.guess_radius();
            if let ([sphere], false) = (&mut points.spheres[..], self.mesh.indices.is_empty()) {
                // A single point beside a mesh is small beside it.
                sphere[3] = (0.01 * self.mesh.bounds().size().max_element()) as f32;
                points.guessed = Some(sphere[3]);
            }
        }
        Some(points)
    }

    /// Says if point elements use positions that there are not.
    fn check_points(&mut self, context: &Context) {
        let count = self.mesh.positions.len();
        let bad = self.points.iter().filter(|i| **i as usize >= count).count();
        if bad > 0 {
            self.findings.error(
                "points out of range",
                || whole(&context.file),
                || format!("points that use a position out of range: {bad}"),
            );
        }
    }

    /// Decodes the colours, which are sRGB, and gives grey to vertices that have none.
    fn mend_colors(&mut self, context: &Context) {
        let colors = &mut self.mesh.colors;
        if colors.is_empty() {
            return;
        }
        let findings = &mut self.findings;
        let at_file = || whole(&context.file);
        let is_color = |color: &Rgb| color.to_array().iter().all(|c| c.is_finite());
        let without = colors.par_iter().filter(|color| !is_color(color)).count() as u64;
        let unsaid = without.saturating_sub(colors.len() as u64 - self.colored);
        if without > unsaid {
            findings.warning("vertices without colour", at_file, || {
                let count = without - unsaid;
                format!(
                    "vertices without a colour beside some that have one: {count}; they are grey"
                )
            });
        }
        if unsaid > 0 {
            findings.warning("colours that are no numbers", at_file, || {
                format!("colours that are NaN or infinite: {unsaid}; they are grey")
            });
        }
        let colored = || colors.iter().filter(|color| is_color(color)).copied();
        let bytes = are_bytes(colored());
        let above = colored().filter(|color| color.max_channel() > 1.0).count();
        if bytes {
            findings.warning("colours read as bytes", at_file, || {
                "all colours are whole numbers up to 255, some above 1: they are read as bytes"
                    .to_owned()
            });
        } else if above > 0 {
            findings.warning("colours above 1", at_file, || {
                format!("colours above 1: {above}; they are brighter than white")
            });
        }
        // Up to 1 they are linear already; of bytes those are 0 and 1, which are the same decoded.
        let linear = |c: f32| match c {
            _ if bytes => srgb_decode(f64::from(c) / 255.0) as f32,
            c if c > 1.0 => srgb_decode(f64::from(c)) as f32,
            c => c,
        };
        colors.par_iter_mut().with_min_len(1 << 12).for_each(|color| {
            *color = if is_color(color) { color.map(linear) } else { Material::default().color };
        });
    }

    /// Finds indices out of range, and forgets what no face uses.
    ///
    /// A corner's normal or texture coordinate that there is not is left out; a position is an
    /// error, or, if `lenient`, its face is left out.
    fn check_indices(&mut self, blob: &dyn Blob, context: &Context, lenient: bool) {
        let mesh = &mut self.mesh;
        let counts = [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()];
        let mut bad = Vec::new();
        for (kind, indices) in [&mut mesh.indices, &mut mesh.uv_indices, &mut mesh.normal_indices]
            .into_iter()
            .enumerate()
        {
            if kind > 0 && counts[kind] == 0 && !indices.is_empty() {
                let what = KINDS[kind];
                self.findings.warning(
                    "kinds of index without anything to refer to",
                    || whole(&context.file),
                    || format!("faces refer to {what}s, of which the file has none"),
                );
                *indices = Shared::default();
            }
            let optional = kind > 0;
            let outside =
                |&index: &u32| index as usize >= counts[kind] && !(optional && index == NO_INDEX);
            let wrong = indices.par_iter().with_min_len(1 << 12).filter(|t| t.iter().any(outside));
            let count = wrong.clone().count();
            if count > 0 && optional {
                let what = KINDS[kind];
                self.findings.warning(
                    "kinds of index out of range",
                    || whole(&context.file),
                    || format!("triangles that use a {what} out of range: {count}; it is left out"),
                );
                let corners = indices.iter_mut().flatten();
                corners.filter(|index| outside(index)).for_each(|index| *index = NO_INDEX);
            } else if count > 0 && lenient {
                let positions = counts[0];
                let [faces, triangles] =
                    collapse_faces(indices, &mut self.polygons, |i| i as usize >= positions);
                self.lost += triangles;
                self.findings.warning(
                    "faces out of range",
                    || whole(&context.file),
                    || {
                        format!(
                            "faces that use a position out of range: {faces}; they are left out"
                        )
                    },
                );
            } else if count > 0 {
                // Only a file that is refused pays for walking all its triangles once more.
                let all = indices.iter().enumerate().filter(|(_, t)| t.iter().any(&outside));
                bad.extend(all.map(|(triangle, _)| triangle as u32));
            }
        }
        if mesh.uv_indices.is_empty() {
            mesh.uvs = Shared::default();
        }
        if mesh.normal_indices.is_empty() {
            mesh.normals = Shared::default();
        }
        bad.sort_unstable();
        bad.dedup();
        self.tell_bad_indices(&bad, counts, blob, context);
    }

    /// Reads the blocks of the first bad triangles again to tell where they stand; the others are
    /// only counted.
    fn tell_bad_indices(
        &mut self,
        bad: &[u32],
        counts: [usize; 3],
        blob: &dyn Blob,
        context: &Context,
    ) {
        let context = Context { marks: true, ..context.clone() };
        let mut open: Option<(usize, Vec<u8>, Vec<Mark>)> = None;
        for (i, &triangle) in bad.iter().enumerate() {
            let mut found = (whole(&context.file), "an index is out of range".to_owned());
            let number = self.blocks.partition_point(|b| b.triangle <= triangle) - 1;
            let start = self.blocks[number];
            if i < TOLD && open.as_ref().is_none_or(|(n, ..)| *n != number) {
                let mut text = vec![0; start.length];
                let read = blob.read_full(&mut text, start.offset).unwrap_or(0);
                text.truncate(read);
                let piece = Piece { text: &text, offset: start.offset, line: start.line, rows: 0 };
                let marks = Block::parse(piece, &context).marks;
                open = Some((number, text, marks));
            }
            if let Some((_, text, marks)) = open.as_ref().filter(|_| i < TOLD) {
                let behind = marks.partition_point(|m| m.triangle <= triangle - start.triangle);
                if let Some(mark) = marks[..behind].last() {
                    let piece = Piece { text, offset: 0, line: start.line, rows: 0 };
                    let cursor = Cursor::resumed(piece, true, mark.at, mark.line);
                    let before = std::array::from_fn(|k| start.counts[k] + mark.counts[k]);
                    let (at, message) = find_bad_corner(cursor, before, counts);
                    found = (at.here(&context.file), message);
                }
            }
            let (span, message) = found;
            self.findings.error("triangles with an index out of range", || span, || message);
        }
    }

    /// Gives every triangle its material: those of the file in the order of their first use, from
    /// number 1 on; 0 for faces before any `usemtl`.
    fn assign_materials(&mut self, libraries: &mut Libraries<'_>) -> Vec<Material> {
        let count = self.mesh.indices.len();
        let mut runs = std::mem::take(&mut self.runs);
        runs.retain(|(start, _)| (*start as usize) < count);
        if runs.is_empty() {
            return Vec::new();
        }
        let mut materials = Vec::new();
        let mut placed = vec![None; self.names.len()];
        let mut faces = vec![0; count];
        let ends = runs.iter().map(|(start, _)| *start as usize).chain([count]);
        for ((start, name), end) in runs.iter().copied().zip(ends.skip(1)) {
            if start as usize == end {
                continue;
            }
            let number = *placed[name as usize].get_or_insert_with(|| {
                materials.push(self.material(name, libraries));
                materials.len() as u32
            });
            faces[start as usize..end].fill(number);
        }
        self.mesh.face_materials = faces.into();
        materials
    }

    /// Where an image gives the colour, those of the vertices are not drawn: scans have both, and both say the same.
    fn prefer_images(&mut self, materials: &mut [Material], context: &Context) {
        let colors = &self.mesh.colors;
        let is_imaged = |material: &&mut Material| material.color.texture().is_some();
        let mut count = 0;
        for material in materials.iter_mut().filter(is_imaged) {
            material.vertex_colors = VertexColors::Ignore;
            count += 1;
        }
        if count > 0 && colors.windows(2).any(|pair| pair[0] != pair[1]) {
            let tell = || "colours of vertices are not drawn where there is a texture".to_owned();
            self.findings.warning("colours under a texture", || whole(&context.file), tell);
        }
    }

    fn material(&mut self, name: u32, libraries: &mut Libraries<'_>) -> Material {
        let Some((name, span)) = self.names.get(name as usize) else { return Material::default() };
        if let Some(material) = libraries.material(name) {
            return material;
        }
        let place = span.place.clone();
        self.findings.warning(
            "materials that no file defines",
            || span.clone(),
            || format!("no file defines the material `{name}`: it is grey"),
        );
        Material { name: name.clone(), place, ..Material::default() }
    }
}

/// Appends a block's triangles of one kind, `[before, after]` being the number of triangles, all
/// kinds alike: where one of the two has nothing of this kind, its corners have no index.
fn append(to: &mut Vec<[u32; 3]>, mut from: Indices, count: usize, [before, after]: [usize; 2]) {
    if to.is_empty() && from.triangles.is_empty() {
        return;
    }
    for flat in from.relative {
        let index = &mut from.triangles[flat as usize / 3][flat as usize % 3];
        let absolute = count as i64 + i64::from(*index as i32);
        *index = if absolute < 0 { BAD_INDEX } else { absolute as u32 };
    }
    to.resize(before, [NO_INDEX; 3]);
    to.append(&mut from.triangles);
    to.resize(after, [NO_INDEX; 3]);
}

/// The corner of a face that is out of range, and what to say about it. `before` is what stands
/// before the face, `counts` what stands in the whole file.
fn find_bad_corner(
    mut cursor: Cursor<'_>,
    before: [usize; 3],
    counts: [usize; 3],
) -> (Cursor<'_>, String) {
    cursor.word();
    while cursor.more() {
        let here = cursor.clone();
        let word = String::from_utf8_lossy(cursor.word()).into_owned();
        for (kind, index) in word.split('/').take(3).enumerate() {
            // Digits without end are as good as the largest number.
            let Some(back) = index.chars().next().map(|sign| sign == '-') else { continue };
            let value = index.parse::<i64>().map_or(u64::MAX, i64::unsigned_abs);
            let count = if back { before[kind] } else { counts[kind] } as u64;
            if value > count && (counts[kind] > 0 || kind == 0) {
                let (what, whence) = (KINDS[kind], if back { "before it" } else { "in the file" });
                let there = if count == 1 { "is 1".to_owned() } else { format!("are {count}") };
                let message = format!("the face uses {what} {index}, but there {there} {whence}");
                return (here, message);
            }
        }
    }
    (cursor, "the face has an index out of range".to_owned())
}

/// The start of a block that the lines' walker cut off.
pub(super) fn start_of(piece: &Piece<'_>) -> Start {
    Start { offset: piece.offset, length: piece.text.len(), line: piece.line, ..Start::default() }
}
