//! What a reader makes of a file: a piece of a scene, with or without camera and lights.
//!
//! A bare model is framed as it is, `[[mesh]]` and `[[points]]` take its objects, and `[[include]]`
//! takes all of it.

use crate::camera::Camera;
use crate::light::Light;
use crate::material::{Material, MaterialId};
use crate::mesh::Shared;
use crate::scene::{Group, Object};
use crate::shape::Shape;
use crate::texture::Texture;

/// A piece of a scene, complete in itself: its numbers of materials, textures and groups are its own.
#[derive(Clone, Debug)]
pub struct Fragment {
    /// The materials. Number 0 is of what names none; who takes the fragment may replace it.
    pub materials: Vec<Material>,
    /// The textures that its materials name.
    pub textures: Vec<Texture>,
    /// The objects, in the order of the file, called as the file calls them; empty: nothing.
    pub objects: Vec<Object>,
    /// What instances place. A group may hold instances of earlier groups.
    pub groups: Vec<Group>,
    /// The lights; empty: the file says nothing of light.
    pub lights: Vec<Light>,
    /// The camera; `None`: the file says nothing of one.
    pub camera: Option<Camera>,
}

impl Default for Fragment {
    /// Nothing but material 0.
    fn default() -> Self {
        Self {
            materials: vec![Material::default()],
            textures: Vec::new(),
            objects: Vec::new(),
            groups: Vec::new(),
            lights: Vec::new(),
            camera: None,
        }
    }
}

impl Fragment {
    /// One shape, made of materials that follow number 0.
    pub(crate) fn of(shape: impl Into<Shape>, materials: Vec<Material>) -> Self {
        let object = Object { name: String::new(), ..Object::from(shape) };
        let mut fragment = Self { objects: vec![object], ..Self::default() };
        fragment.materials.extend(materials);
        fragment
    }
}

impl Object {
    /// Makes all of it of one material.
    pub(crate) fn make_of(&mut self, material: MaterialId) {
        self.material = material;
        if let Shape::Mesh(mesh) = &mut self.shape {
            mesh.face_materials = Shared::default();
        }
    }

    /// Numbers its materials anew: 0 becomes `none`, the others follow from `first` on.
    pub(crate) fn renumber_materials(&mut self, none: MaterialId, first: u32) {
        let new = |number: u32| match number.checked_sub(1) {
            None => none.0,
            Some(own) => first.saturating_add(own),
        };
        self.material = MaterialId(new(self.material.0));
        if let Shape::Mesh(mesh) = &mut self.shape {
            mesh.face_materials.iter_mut().for_each(|number| *number = new(*number));
            // The object's own is of no face, and need not be a material of the scene.
            self.material = mesh.face_materials.first().map_or(self.material, |&m| MaterialId(m));
        }
    }
}

/// What is said of a mesh in which no triangle has an area.
pub(crate) fn flat(triangles: usize) -> String {
    match triangles {
        1 => "nothing can be seen: its one triangle has no area".to_owned(),
        n => format!("nothing can be seen: none of its {n} triangles has an area"),
    }
}
