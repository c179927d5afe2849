//! One number for all that a scene's pixels depend on.

use std::fmt::{self, Write as _};

use crc32fast::Hasher;
use phong_scene::{
    Clip, Cylinders, Field, Group, Material, Mesh, Object, Place, Points, Scene, Shape, SkyKind,
    TexelValues, Texels, Texture, TextureKind,
};

/// A checksum of everything in a scene but its picture settings and the places it was written at:
/// the same scene has the same one on every machine, whatever its files are called.
pub fn fingerprint(scene: &Scene) -> u32 {
    // Taken apart without `..`: what a scene gains must be thought of here.
    let Scene {
        image: _,
        camera,
        ambient,
        ambient_occlusion,
        fog,
        // They are no part of the film.
        outline: _,
        furniture: _,
        tone: _,
        sky,
        clips,
        lights,
        materials,
        textures,
        objects,
        groups,
    } = scene;
    let mut sum = Sum(Hasher::new());
    sum.debug(&(camera, ambient));
    if let Some(sky) = sky {
        let mut sky = sky.clone();
        if let SkyKind::Image { file, place, .. } = &mut sky.kind {
            (*file, *place) = Default::default();
        }
        sum.debug(&sky);
        if let SkyKind::Image { texels, .. } = &sky.kind {
            sum.texels(texels);
        }
    }
    if let Some(fog) = fog {
        sum.debug(fog);
    }
    if let Some(occlusion) = ambient_occlusion {
        sum.debug(occlusion);
    }
    for clip in clips {
        sum.debug(&Clip { place: Place::default(), ..clip.clone() });
        if !clip.objects.is_empty() {
            let names = objects.iter().map(|object| &object.name);
            sum.debug(&names.collect::<Vec<_>>());
        }
    }
    for light in lights {
        let mut light = light.clone();
        light.place = Place::default();
        sum.debug(&light);
    }
    for material in materials {
        sum.debug(&Material { place: Place::default(), ..material.clone() });
    }
    for texture in textures {
        let mut texture = Texture { place: Place::default(), ..texture.clone() };
        if let TextureKind::Image { file, .. } = &mut texture.kind {
            file.clear();
        }
        sum.debug(&texture);
        if let TextureKind::Image { texels, .. } = &texture.kind {
            sum.texels(texels);
        }
    }
    sum.objects(objects);
    for Group { name, objects } in groups {
        sum.debug(name);
        sum.objects(objects);
    }
    sum.0.finalize()
}

/// Values that are copied side by side before they are summed.
const PIECE: usize = 4096;

struct Sum(Hasher);

impl fmt::Write for Sum {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

impl Sum {
    /// Numbers print with all their digits, so this is exact; it is for what is small.
    fn debug(&mut self, value: &impl fmt::Debug) {
        // Nothing in `write_str` fails.
        let _ = write!(self, "{value:?};");
    }

    fn objects(&mut self, objects: &[Object]) {
        self.debug(&objects.len());
        for Object { name: _, shape, material, transform, place: _ } in objects {
            self.debug(&(material, transform));
            match shape {
                Shape::Mesh(mesh) => self.mesh(mesh),
                Shape::Points(points) => self.points(points),
                Shape::Cylinders(cylinders) => self.cylinders(cylinders),
                small => self.debug(small),
            }
        }
    }

    fn mesh(&mut self, mesh: &Mesh) {
        let Mesh {
            origin,
            positions,
            indices,
            normals,
            normal_indices,
            uvs,
            uv_indices,
            colors,
            face_materials,
            fields,
        } = mesh;
        self.debug(origin);
        self.words(positions, |v| v.to_array().map(f32::to_bits));
        self.words(indices, |corners| *corners);
        self.words(normals, |v| v.to_array().map(f32::to_bits));
        self.words(normal_indices, |corners| *corners);
        self.words(uvs, |uv| uv.to_array().map(f32::to_bits));
        self.words(uv_indices, |corners| *corners);
        self.words(colors, |c| c.to_array().map(f32::to_bits));
        self.words(face_materials, |material| [*material]);
        self.fields(fields);
    }

    fn fields(&mut self, fields: &[Field]) {
        for Field { name, values } in fields {
            self.debug(name);
            self.words(values, |value| [value.to_bits()]);
        }
    }

    fn points(&mut self, points: &Points) {
        let Points { origin, spheres, colors, fields, .. } = points;
        self.fields(fields);
        self.debug(origin);
        self.words(spheres, |sphere| sphere.map(f32::to_bits));
        self.words(colors, |c| c.to_array().map(f32::to_bits));
    }

    fn cylinders(&mut self, cylinders: &Cylinders) {
        let Cylinders { origin, segments, colors, caps, fields, .. } = cylinders;
        self.fields(fields);
        self.debug(&(origin, caps));
        self.words(segments.as_flattened(), |end| end.map(f32::to_bits));
        self.words(colors.as_flattened(), |c| c.to_array().map(f32::to_bits));
    }

    /// The numbers of an image; its size and kind are part of what [`Texels`] prints.
    fn texels(&mut self, texels: &Texels) {
        match texels.values() {
            TexelValues::Bytes(values) => {
                self.0.update(values);
                self.0.update(&(values.len() as u64).to_le_bytes());
            }
            TexelValues::Shorts(values) => self.words(values, |&value| [u32::from(value)]),
            TexelValues::Floats(values) => self.words(values, |value| [value.to_bits()]),
        }
    }

    /// Bulk numbers, then how many there were, so that neighbouring arrays cannot trade places.
    fn words<T, const N: usize>(&mut self, values: &[T], words_of: impl Fn(&T) -> [u32; N]) {
        let mut words = Vec::with_capacity(PIECE.min(values.len()));
        for piece in values.chunks(PIECE) {
            words.clear();
            words.extend(piece.iter().map(|value| words_of(value).map(u32::to_le)));
            self.0.update(bytemuck::cast_slice(words.as_flattened()));
        }
        let count = (N * values.len()) as u64;
        self.0.update(&count.to_le_bytes());
    }
}
