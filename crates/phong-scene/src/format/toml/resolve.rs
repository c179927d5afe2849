//! Names looked up: the parts of the files become a scene.

use super::reader::{Draft, DraftShape, Reader};
use crate::wording::{closest, quoted};
use crate::{Diagnostic, Group, GroupId, Material, MaterialId, Object, Scene, Shape};

impl Reader<'_> {
    /// The scene, unless there was an error, and everything there is to say.
    pub(super) fn resolve(mut self) -> (Option<Scene>, Vec<Diagnostic>) {
        let mut materials: Vec<Material> = std::mem::take(&mut self.materials.items)
            .into_iter()
            .map(|(_, _, material)| material.unwrap_or_default())
            .collect();
        let default = MaterialId(materials.len() as u32);
        materials.push(Material::default());
        let mut first_of_model = Vec::new();
        for model in std::mem::take(&mut self.models) {
            first_of_model.push(materials.len() as u32);
            materials.extend(model);
        }
        let drafts = std::mem::take(&mut self.drafts);
        let objects = self.objects(drafts, default, &first_of_model);
        let mut groups = Vec::new();
        for i in 0..self.groups.items.len() {
            let name = self.groups.items[i].0.clone();
            let drafts = self.groups.items[i].2.take().unwrap_or_default();
            groups.push(Group { name, objects: self.objects(drafts, default, &first_of_model) });
        }
        let camera = self.camera.take();
        let scene = match camera {
            Some(camera) if !self.notes.has_errors() => Some(Scene {
                image: self.image,
                camera,
                ambient: self.ambient,
                lights: self.lights,
                materials,
                objects,
                groups,
            }),
            _ => None,
        };
        (scene, self.notes.into_diagnostics())
    }

    fn objects(&mut self, drafts: Vec<Draft>, default: MaterialId, first: &[u32]) -> Vec<Object> {
        drafts.into_iter().filter_map(|draft| self.object(draft, default, first)).collect()
    }

    fn object(&mut self, draft: Draft, default: MaterialId, first: &[u32]) -> Option<Object> {
        let Draft { name, shape, material, transform, place } = draft;
        let material = match material {
            None => default,
            Some((wanted, spot)) => {
                if let Some(number) = self.materials.find(&wanted) {
                    MaterialId(number)
                } else {
                    let near = closest(&wanted, self.materials.names());
                    let message = format!("there is no material {}", quoted(&wanted));
                    let help = near.map(|near| format!("did you mean {}?", quoted(near)));
                    self.notes.error(spot, message).help = help;
                    return None;
                }
            }
        };
        let shape = match shape {
            DraftShape::Shape(shape) => shape,
            DraftShape::Model(mut mesh, model) => {
                for face in &mut mesh.face_materials {
                    *face += first[model];
                }
                Shape::Mesh(mesh)
            }
            DraftShape::Instance(wanted, spot) => {
                if let Some(number) = self.groups.find(&wanted) {
                    Shape::Instance(GroupId(number))
                } else {
                    let near = closest(&wanted, self.groups.names());
                    let message = format!("there is no group {}", quoted(&wanted));
                    let help = near.map(|near| format!("did you mean {}?", quoted(near)));
                    self.notes.error(spot, message).help = help;
                    return None;
                }
            }
        };
        Some(Object { name, shape, material, transform, place })
    }
}
