//! The images that comments name, as materials.

use super::header::Header;
use crate::format::input::Input;
use crate::format::mtl::Images;
use crate::format::text::Findings;
use crate::material::Material;
use crate::texture::{Texture, TextureRef};

/// What stands for the name of the file itself, without its ending, as `MeshLab` has it.
const THIS: &str = "<this>";

/// A material for each image, and what they show.
#[derive(Debug, Default)]
pub(super) struct Skins {
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Texture>,
}

impl Skins {
    /// Reads the images that a header names; what cannot be read is told, and grey.
    pub(super) fn read(header: &Header, input: &Input<'_>, findings: &mut Findings) -> Self {
        let mut images = Images::new(input.source, input.limits);
        let mut materials = Vec::new();
        for (name, span) in &header.textures {
            let bare = input.path.rsplit(['/', '\\']).next().unwrap_or(input.path);
            let stem = bare.rsplit_once('.').map_or(bare, |(stem, _)| stem);
            let name = name.replace(THIS, stem);
            let mut material =
                Material { name: name.clone(), place: span.place.clone(), ..Material::default() };
            match images.color(&name, input.path, span, findings) {
                Ok(texture) => material.color = TextureRef::new(texture).into(),
                Err(message) => findings.warning(
                    "images that cannot be read",
                    || span.clone(),
                    || format!("the image `{name}` cannot be read: {message}"),
                ),
            }
            materials.push(material);
        }
        Self { materials, textures: images.textures }
    }

    /// Whether an image is there.
    pub(super) fn any(&self) -> bool {
        !self.textures.is_empty()
    }
}
