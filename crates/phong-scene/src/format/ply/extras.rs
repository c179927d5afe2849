//! What faces have of their own: texture coordinates of their corners, images, and colours.

use glam::Vec2;

use super::header::{Element, Type};
use super::vertices::Transfer;
use crate::color::Rgb;
use crate::material::PLAIN;
use crate::mesh::{Mesh, NO_INDEX};

/// What a property of faces is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    /// Two numbers for each corner.
    Uvs,
    /// The number of an image.
    Image,
    /// Red, green, blue or alpha.
    Color(usize),
}

/// Which properties of faces are used, for what.
#[derive(Clone, Debug)]
pub(super) struct ExtrasPlan {
    /// One for each property.
    uses: Vec<Option<Use>>,
    transfer: Transfer,
    /// What alpha is where nothing shows through.
    opaque: f64,
}

impl ExtrasPlan {
    /// Finds out what the properties are; `None`: none of them is used. Colours are where they are
    /// wanted.
    pub(super) fn new(element: &Element, colors: bool) -> Option<Self> {
        let mut uses = vec![None; element.properties.len()];
        if let Some(uvs) =
            element.properties.iter().position(|p| p.name == "texcoord" && p.list.is_some())
        {
            uses[uvs] = Some(Use::Uvs);
            if let Some(image) = element.find("texnumber") {
                uses[image] = Some(Use::Image);
            }
        }
        let named = |names: [&str; 2]| names.iter().find_map(|name| element.find(name));
        let channels = [
            named(["red", "diffuse_red"]),
            named(["green", "diffuse_green"]),
            named(["blue", "diffuse_blue"]),
        ];
        let alpha = named(["alpha", "diffuse_alpha"]);
        let kind = |property: usize| element.properties[property].kind;
        if colors && !channels.contains(&None) {
            for (number, property) in channels.into_iter().chain([alpha]).enumerate() {
                if let Some(property) = property {
                    uses[property] = Some(Use::Color(number));
                }
            }
        }
        let opaque = match alpha.map(kind) {
            Some(kind) if kind.is_float() => 1.0,
            Some(Type::U16) => 65535.0,
            _ => 255.0,
        };
        let transfer = Transfer::of(channels.map(|property| property.map(kind)));
        uses.iter().any(Option::is_some).then_some(Self { uses, transfer, opaque })
    }

    /// What a property is used for, if it is.
    pub(super) fn of(&self, property: usize) -> Option<Use> {
        self.uses.get(property).copied().flatten()
    }

    /// Whether any is used so.
    pub(super) fn has(&self, wanted: Use) -> bool {
        self.uses.contains(&Some(wanted))
    }
}

/// What one face has.
#[derive(Clone, Debug, Default)]
pub(super) struct ExtrasRow {
    pub(super) uvs: Vec<f32>,
    image: f64,
    color: [f64; 4],
}

impl ExtrasRow {
    /// Takes a number that is used so.
    pub(super) fn set(&mut self, used: Use, number: f64) {
        match used {
            Use::Uvs => {}
            Use::Image => self.image = number,
            Use::Color(channel) => self.color[channel] = number,
        }
    }
}

/// What the triangles that were read so far have; each array is empty, or ends with the last
/// triangle that has something.
#[derive(Debug, Default)]
pub(super) struct Extras {
    uvs: Vec<Vec2>,
    corners: Vec<[u32; 3]>,
    /// One more than the number of the image; 0: none.
    images: Vec<u32>,
    pub(super) colors: Vec<Rgb>,
    /// Faces whose texture coordinates are not two for each corner.
    pub(super) unfitting: u64,
    /// Faces whose colours are none.
    pub(super) wrong: u64,
    /// Whether a face is less than opaque.
    pub(super) transparent: bool,
}

impl Extras {
    /// Adds what a face of so many corners has, which became the triangles from the number `before` up
    /// to `after`.
    pub(super) fn add(
        &mut self,
        plan: &ExtrasPlan,
        row: &ExtrasRow,
        corners: usize,
        [before, after]: [usize; 2],
    ) {
        if plan.has(Use::Uvs) {
            self.corners.resize(before, [NO_INDEX; 3]);
            let (pairs, rest) = row.uvs.as_chunks::<2>();
            let first = u32::try_from(self.uvs.len()).unwrap_or(NO_INDEX);
            let room = first.checked_add(pairs.len() as u32).is_some_and(|end| end < NO_INDEX);
            if pairs.len() == corners && rest.is_empty() && room {
                let uv = |&[u, v]: &[f32; 2]| Vec2::new(u, v);
                self.uvs.extend(pairs.iter().map(uv));
                let fan = 0..(after - before) as u32;
                self.corners.extend(fan.map(|i| [first, first + i + 1, first + i + 2]));
            } else if !row.uvs.is_empty() {
                self.unfitting += 1;
            }
            self.corners.resize(after, [NO_INDEX; 3]);
        }
        if plan.has(Use::Image) {
            self.images.resize(before, 0);
            let number = row.image + 1.0;
            let held = number >= 1.0 && number <= f64::from(u32::MAX);
            self.images.resize(after, if held { number as u32 } else { 0 });
        }
        if plan.has(Use::Color(0)) {
            self.colors.resize(before, PLAIN);
            let color = plan.transfer.linear(&row.color[..3]);
            self.wrong += u64::from(color.is_none());
            self.colors.resize(after, color.unwrap_or(PLAIN));
            self.transparent |= plan.has(Use::Color(3)) && row.color[3] != plan.opaque;
        }
    }

    /// Adds those of later triangles, before which there are so many.
    pub(super) fn append(&mut self, before: usize, mut later: Self) {
        self.unfitting += later.unfitting;
        self.wrong += later.wrong;
        self.transparent |= later.transparent;
        let first = u32::try_from(self.uvs.len()).unwrap_or(NO_INDEX);
        if !later.corners.is_empty() {
            self.corners.resize(before, [NO_INDEX; 3]);
            for corner in later.corners.as_flattened_mut() {
                // Beyond what can be numbered there is none.
                *corner = corner.saturating_add(first);
            }
            self.corners.append(&mut later.corners);
            self.uvs.append(&mut later.uvs);
        }
        if !later.images.is_empty() {
            self.images.resize(before, 0);
            self.images.append(&mut later.images);
        }
        if !later.colors.is_empty() {
            self.colors.resize(before, PLAIN);
            self.colors.append(&mut later.colors);
        }
    }

    /// Bytes that they take in memory.
    pub(super) fn bytes(&self) -> u64 {
        let Self { uvs, corners, images, colors, .. } = self;
        (8 * uvs.len() + 12 * corners.len() + 4 * images.len() + 12 * colors.len()) as u64
    }

    /// Gives the mesh the texture coordinates: corners of one vertex that follow one another with the same
    /// share them.
    pub(super) fn place(&mut self, mesh: &mut Mesh) {
        let (stored, mut corners) =
            (std::mem::take(&mut self.uvs), std::mem::take(&mut self.corners));
        if stored.is_empty() {
            return;
        }
        corners.resize(mesh.indices.len(), [NO_INDEX; 3]);
        let mut last = vec![NO_INDEX; mesh.positions.len()];
        let mut uvs: Vec<Vec2> = Vec::new();
        for (triangle, corners) in mesh.indices.iter().zip(&mut corners) {
            for (vertex, corner) in triangle.iter().zip(corners) {
                let Some(uv) = stored.get(*corner as usize) else { continue };
                let uv = if uv.is_finite() { *uv } else { Vec2::ZERO };
                let mut own = NO_INDEX;
                let known = last.get_mut(*vertex as usize).unwrap_or(&mut own);
                if uvs.get(*known as usize).is_none_or(|known| *known != uv) {
                    *known = uvs.len() as u32;
                    uvs.push(uv);
                }
                *corner = *known;
            }
        }
        mesh.uvs = uvs.into();
        mesh.uv_indices = corners.into();
    }

    /// The number of each triangle's material, if there are so many images, one each from number 1 on.
    pub(super) fn materials(&mut self, triangles: usize, images: usize) -> Vec<u32> {
        let mut numbers = std::mem::take(&mut self.images);
        if !numbers.is_empty() {
            numbers.resize(triangles, 0);
            numbers.iter_mut().filter(|n| **n as usize > images).for_each(|number| *number = 0);
        }
        numbers
    }
}
