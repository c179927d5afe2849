//! Names looked up: what the files say becomes a scene.

use std::collections::BTreeSet;

use super::draft::{Draft, DraftShape, Looks, Named, say_unknown_name};
use super::groups;
use super::notes::Notes;
use super::reader::Reader;
use super::text::Spot;
use crate::check::settings::legend_texture;
use crate::clip::{Cap, Clip};
use crate::diagnostic::Diagnostic;
use crate::material::{Material, MaterialId};
use crate::scene::{Group, Object, Scene};
use crate::shape::{GroupId, Shape};
use crate::texture::{Texture, TextureId};
use crate::wording::quoted;

impl Reader<'_> {
    /// The scene, unless there was an error, and everything there is to say.
    pub(super) fn resolve(self) -> (Option<Scene>, Vec<Diagnostic>) {
        let Self { mut notes, materials: mut named, fragments, groups: mut texts, drafts, .. } =
            self;
        let mut textures: Vec<Texture> =
            self.textures.items.iter().map(|(.., t)| t.clone().unwrap_or_default()).collect();
        let textures_used = self.texture_names.look_up(&self.textures, &mut notes);
        for (.., material) in &mut named.items {
            let names = &self.texture_names;
            let settle = |m: Material| names.settle(&m, &self.textures, &textures, &mut notes);
            *material = material.take().map(settle);
        }
        let named_by_shapes: Vec<_> = self
            .material_names
            .iter()
            .map(|(name, spot)| material(&named, name, *spot, &mut notes))
            .collect();
        let order = groups::order(&texts, &drafts, self.limits, &mut notes);
        let mut group_ids = vec![None; texts.items.len()];
        for (id, &group) in order.iter().enumerate() {
            group_ids[group] = Some(GroupId(id as u32));
        }

        let in_groups = texts.items.iter().flat_map(|(.., drafts)| drafts.iter().flatten());
        let default_needed = drafts.iter().chain(in_groups).any(takes_the_default);
        let (materials, default, first_of_fragment) =
            materials(&named, fragments, default_needed, &mut textures);
        let mut resolver = Resolver {
            named: named_by_shapes,
            default,
            first_of_fragment,
            group_used: vec![false; texts.items.len()],
            group_ids,
        };
        let objects = resolver.objects(&texts, drafts);
        let mut groups = Vec::with_capacity(order.len());
        for group in order {
            let drafts = texts.items[group].2.take().unwrap_or_default();
            let objects = resolver.objects(&texts, drafts);
            groups.push(Group { name: texts.items[group].0.clone(), objects });
        }

        let capped = |(clip, cap): (Clip, Option<usize>)| match cap.map(|name| resolver.named[name])
        {
            Some(Some(material)) => Clip { cap: Cap::Of(material), ..clip },
            _ => clip,
        };
        let clips = self.clips.into_iter().map(capped).collect();
        if let (Some(legend), false) = (&self.furniture.legend, notes.has_errors()) {
            let spot = self.legend_spot;
            notes.judge(|_| spot, |faults| legend_texture(legend, &textures, faults));
        }
        let sound = !notes.has_errors();
        let mut scene = self.camera.filter(|_| sound).map(|camera| Scene {
            image: self.image,
            camera,
            ambient: self.ambient,
            ambient_occlusion: self.ambient_occlusion,
            fog: self.fog,
            outline: self.outline,
            furniture: self.furniture,
            tone: self.tone,
            sky: self.sky,
            clips,
            lights: self.lights,
            materials,
            textures,
            objects,
            groups,
        });
        if let Some(scene) = &mut scene {
            let default = default_needed.then_some(default);
            let used: BTreeSet<_> = resolver.named.into_iter().flatten().chain(default).collect();
            let used = |number: usize| used.contains(&MaterialId(number as u32));
            say_unused(
                &named,
                used,
                |name| format!("no shape is of the material {name}"),
                &mut notes,
            );
            say_unused(
                &self.textures,
                |number| textures_used.contains(&(number as u32)),
                |name| format!("no material uses the texture {name}"),
                &mut notes,
            );
            let used = |number: usize| resolver.group_used[number];
            say_unused(
                &texts,
                used,
                |name| format!("no instance places the group {name}"),
                &mut notes,
            );
            scene.textures = scene.textures_ranged_of_any_camera();
            for diagnostic in scene.check() {
                notes.say_located(diagnostic);
            }
        }
        let scene = scene.filter(|_| !notes.has_errors());
        (scene, notes.into_diagnostics())
    }
}

/// The scene's materials: those of the text, the default one if needed, those of fragments.
/// Also which is the default one, and the first of each fragment, whose textures follow `textures`.
fn materials(
    named: &Named<Material>,
    fragments: Vec<Looks>,
    default_needed: bool,
    textures: &mut Vec<Texture>,
) -> (Vec<Material>, MaterialId, Vec<u32>) {
    let mut materials: Vec<_> =
        named.items.iter().map(|(.., material)| material.clone().unwrap_or_default()).collect();
    // Who defines a material of this name says what shapes without one are made of.
    let own = named.find("default");
    let default = own.unwrap_or(materials.len() as u32);
    if default_needed && own.is_none() {
        materials.push(Material::default());
    }
    let mut first_of_fragment = Vec::with_capacity(fragments.len());
    for Looks { materials: own, textures: own_textures } in fragments {
        first_of_fragment.push(materials.len() as u32);
        let first = textures.len() as u32;
        let new = |TextureId(own): TextureId| TextureId(own.saturating_add(first));
        materials.extend(own.iter().map(|material| material.renumber_textures(new)));
        textures.extend(own_textures);
    }
    (materials, MaterialId(default), first_of_fragment)
}

fn takes_the_default(draft: &Draft) -> bool {
    let takes = match &draft.shape {
        DraftShape::Shape(_) => true,
        DraftShape::Part(Shape::Mesh(mesh), material, _) if mesh.face_materials.is_empty() => {
            *material == MaterialId(0)
        }
        DraftShape::Part(Shape::Mesh(mesh), ..) => mesh.face_materials.contains(&0),
        DraftShape::Part(_, material, _) => *material == MaterialId(0),
        DraftShape::Instance(..) => false,
    };
    takes && draft.material.is_none()
}

/// The number of the material of this name, which is named there; says if there is none.
fn material(
    named: &Named<Material>,
    name: &str,
    spot: Spot,
    notes: &mut Notes,
) -> Option<MaterialId> {
    let number = named.find(name);
    if number.is_none() {
        say_unknown_name(notes, "material", name, named.names(), spot);
    }
    number.map(MaterialId)
}

/// Says what nobody uses. Included files may be libraries, so there it is no news.
fn say_unused<T>(
    named: &Named<T>,
    used: impl Fn(usize) -> bool,
    message: impl Fn(String) -> String,
    notes: &mut Notes,
) {
    for (number, (name, spot, _)) in named.items.iter().enumerate() {
        if spot.file == 0 && !used(number) {
            notes.warning(*spot, message(quoted(name)));
        }
    }
}

struct Resolver {
    /// The materials that shapes name, in the order of [`Reader::material_names`].
    named: Vec<Option<MaterialId>>,
    default: MaterialId,
    first_of_fragment: Vec<u32>,
    /// The scene's number of each group of the text; `None`: something is wrong with the order.
    group_ids: Vec<Option<GroupId>>,
    /// Which of them some instance names.
    group_used: Vec<bool>,
}

impl Resolver {
    fn objects<T>(&mut self, groups: &Named<T>, drafts: Vec<Draft>) -> Vec<Object> {
        drafts.into_iter().filter_map(|draft| self.object(groups, draft)).collect()
    }

    /// The object; `None`: something is wrong with a name, which has been said.
    fn object<T>(&mut self, groups: &Named<T>, draft: Draft) -> Option<Object> {
        let Draft { name, shape, material, transform, place } = draft;
        let own = match material {
            Some(material) => Some(self.named[material]?),
            None => None,
        };
        let material = own.unwrap_or(self.default);
        let (shape, material) = match shape {
            DraftShape::Shape(shape) => (shape, material),
            DraftShape::Part(shape, number, fragment) => {
                let mut object = Object { shape, material: number, ..Object::default() };
                if let Some(material) = own {
                    object.make_of(material);
                } else {
                    let first = self.first_of_fragment[fragment];
                    object.renumber_materials(self.default, first);
                }
                (object.shape, object.material)
            }
            DraftShape::Instance(group, _) => {
                let group = groups.find(&group)? as usize;
                self.group_used[group] = true;
                (Shape::Instance(self.group_ids[group]?), material)
            }
        };
        Some(Object { name, shape, material, transform, place })
    }
}

#[cfg(test)]
mod tests {
    use crate::format::input::{Input, Models, Named};
    use crate::fragment::Fragment;
    use crate::limits::Limits;
    use crate::material::{Material, MaterialId};
    use crate::scene::Object;
    use crate::source::Memory;
    use crate::texture::{Texture, TextureId, TextureRef};

    /// A ball of a material whose colour is the file's second texture.
    #[expect(clippy::unnecessary_wraps, reason = "a reader may find nothing")]
    fn textured(_: &Input<'_>, _: &mut Vec<crate::diagnostic::Diagnostic>) -> Option<Fragment> {
        let texture = |name: &str| Texture { name: name.to_owned(), ..Texture::default() };
        let color = TextureRef::new(TextureId(1)).into();
        let material = Material { name: "own".to_owned(), color, ..Material::default() };
        Some(Fragment {
            materials: vec![Material::default(), material],
            textures: vec![texture("first"), texture("second")],
            objects: vec![Object { material: MaterialId(1), ..Object::default() }],
            ..Fragment::default()
        })
    }

    static MODELS: Models = Models { find: |_, _| Named::Model(textured), help: String::new };

    #[test]
    fn textures_of_included_models_follow_those_of_the_text() {
        let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                    [textures.tiles]\nkind = \"checker\"\ncolors = [0, 1]\n\
                    [materials.floor]\ncolor = { texture = \"tiles\" }\n\
                    [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"floor\"\n\
                    [[include]]\nfile = \"a.model\"\n[[include]]\nfile = \"b.model\"\n";
        let files = Memory::new().with("a.toml", text.as_bytes());
        let files = files.with("a.model", vec![]).with("b.model", vec![]);
        let limits = Limits::default();
        let read = super::super::read(&Input::new("a.toml", &files, &limits), &MODELS);
        let scene = read.scene.unwrap_or_else(|| panic!("{:#?}", read.diagnostics));
        let names: Vec<_> = scene.textures.iter().map(|texture| texture.name.as_str()).collect();
        assert_eq!(names, ["tiles", "first", "second", "first", "second"]);
        let own = |object: usize| {
            let material = scene.objects[object].material;
            scene.materials[material.0 as usize].color.texture().map(|by| by.texture)
        };
        assert_eq!([0, 1, 2].map(own), [0, 2, 4].map(|number| Some(TextureId(number))));
    }
}
