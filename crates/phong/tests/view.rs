//! One geometry with several looks.

mod clip;

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};
use phong::film::{Film, LayerKind};
use phong::geometry::{Geometry, GeometryError, GeometryOptions};
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::TermSet;
use phong::view::{View, ViewError};
use phong_scene::{Group, GroupId, Limits, Memory, Mesh, Object, Rgb, Scene, Shape, read};

const SCENE: &str = r##"version = 1
[image]
size = [24, 18]
samples = 2
[camera]
eye = [1, 2, 7]
look_at = [0, 0.5, 0]
[[light]]
kind = "point"
position = [3, 4, 5]
[materials.red]
color = "#d04030"
reflection = 0.2
[materials.wood]
color = "#a08050"
viewer = "distant"
[[plane]]
point = [0, -0.5, 0]
normal = [0, 1, 0]
material = "wood"
[[sphere]]
center = [0, 0.5, 0]
radius = 1
material = "red"
"##;

fn scene() -> Scene {
    let files = Memory::new().with("scene.toml", SCENE.as_bytes());
    let reading = read("scene.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn film(view: &View, scene: &Scene) -> Film {
    let options = RenderOptions::of(&scene.image).expect("checked").with_terms(TermSet::ALL);
    render(view, &options, &|_| {}, &Cancel::new()).film
}

fn bits(film: &Film) -> Vec<Vec<u32>> {
    film.layers.iter().map(|layer| layer.values.iter().map(|v| v.to_bits()).collect()).collect()
}

#[test]
fn a_changed_look_has_the_bits_of_a_scene_written_so() {
    let scene = scene();
    let geometry = Arc::new(Geometry::new(&scene, GeometryOptions::default()).unwrap());
    let changes: [fn(&mut Scene); 4] = [
        |scene| scene.camera.eye.x = -3.0,
        |scene| scene.lights.push(scene.lights[0].clone()),
        |scene| scene.materials[0].color = Rgb::new(0.1, 0.7, 0.2).into(),
        |scene| scene.ambient = Rgb::grey(0.25),
    ];
    let mut films = vec![bits(&film(&View::of(&scene).unwrap(), &scene))];
    for change in changes {
        let mut changed = scene.clone();
        change(&mut changed);
        let built_anew = bits(&film(&View::of(&changed).unwrap(), &changed));
        let view = View::new(Arc::clone(&geometry), Look::new(&changed)).unwrap();
        assert!(bits(&film(&view, &changed)) == built_anew, "other bits");
        assert!(!films.contains(&built_anew), "the change shows");
        films.push(built_anew);
    }
}

#[test]
fn a_look_that_lacks_a_material_is_refused() {
    let scene = scene();
    let geometry = Geometry::new(&scene, GeometryOptions::default()).unwrap();
    assert_eq!(geometry.materials(), 2);
    let look = Look { materials: scene.materials[..1].to_vec(), ..Look::new(&scene) };
    let error = View::new(Arc::new(geometry), look).unwrap_err();
    assert_eq!(error, ViewError::NoMaterial { number: 1, count: 1 });
}

#[test]
fn a_scene_of_nothing_needs_no_material() {
    let mut scene = scene();
    scene.objects.clear();
    scene.materials.clear();
    let view = View::of(&scene).unwrap();
    assert!(film(&view, &scene).layer(LayerKind::Alpha).unwrap().values.iter().all(|v| *v == 1.0));
}

/// The scene with a mesh in a group, placed twice, and once beside it.
fn with_meshes() -> Scene {
    let mut scene = scene();
    let mut ball = Mesh {
        positions: (0..60)
            .map(|i| {
                let at = |step: f32| (i as f32 * step).fract() - 0.5;
                Vec3::new(at(0.819), at(0.671), at(0.549))
            })
            .collect(),
        indices: (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Mesh::default()
    };
    ball.smooth(60.0);
    scene.groups.push(Group { objects: vec![ball.clone().into()], ..Group::default() });
    let moved = |x: f64| DAffine3::from_translation(DVec3::new(x, 1.0, 1.0));
    for x in [-1.5, 1.5] {
        let instance = Object::from(Shape::Instance(GroupId(0)));
        scene.objects.push(Object { transform: moved(x), ..instance });
    }
    scene.objects.push(Object { transform: moved(0.0), ..ball.into() });
    scene
}

#[test]
fn a_mesh_has_one_tree_however_often_it_is_placed() {
    let scene = with_meshes();
    let geometry = Geometry::new(&scene, GeometryOptions::default()).unwrap();
    assert_eq!((geometry.objects().len(), geometry.trees()), (5, 1));
}

#[test]
fn an_updated_geometry_has_the_bits_of_one_built_anew() {
    let scene = with_meshes();
    let geometry = Geometry::new(&scene, GeometryOptions::default()).unwrap();
    let changes: [fn(&mut Scene); 5] = [
        |scene| scene.objects[2].transform.translation.y += 0.5,
        |scene| scene.objects[1].transform.translation.x -= 0.25,
        |scene| drop(scene.objects.pop()),
        |scene| scene.objects.push(scene.objects[2].clone()),
        |scene| {
            let Shape::Mesh(mesh) = &mut scene.objects[4].shape else { panic!("a mesh") };
            mesh.positions[0].y += 1.0;
        },
    ];
    for change in changes {
        let mut changed = scene.clone();
        change(&mut changed);
        let updated = Arc::new(geometry.update(&changed).unwrap());
        let view = View::new(updated, Look::new(&changed)).unwrap();
        let built_anew = View::of(&changed).unwrap();
        assert!(bits(&film(&view, &changed)) == bits(&film(&built_anew, &changed)), "other bits");
        assert_eq!(view.objects(), built_anew.objects());
    }
}

#[test]
fn arrays_that_are_shared_count_once_towards_the_memory_limit() {
    let mut scene = with_meshes();
    let needed = |scene: &Scene| {
        let options = GeometryOptions { max_bytes: Some(0), ..GeometryOptions::default() };
        match Geometry::new(scene, options) {
            Err(GeometryError::Memory { needed, .. }) => needed,
            other => panic!("{other:?}"),
        }
    };
    let few = needed(&scene);
    let instance = scene.objects[2].clone();
    scene.objects.extend(std::iter::repeat_n(instance, 1000));
    let each = (needed(&scene) - few) / 1000;
    assert!((200..1500).contains(&each), "{each} bytes for each instance");
}

#[test]
fn what_turns_the_normals_of_a_mesh_counts_towards_the_memory_limit() {
    let mut scene = with_meshes();
    let Shape::Mesh(mesh) = &mut scene.objects[4].shape else { panic!("a mesh") };
    mesh.uvs = mesh.positions.iter().map(|p| p.truncate()).collect();
    let triangles = mesh.indices.len() as u64;
    let needed = |scene: &Scene| {
        let options = GeometryOptions { max_bytes: Some(0), ..GeometryOptions::default() };
        match Geometry::new(scene, options) {
            Err(GeometryError::Memory { needed, .. }) => needed,
            other => panic!("{other:?}"),
        }
    };
    let plain = needed(&scene);
    scene.textures.push(phong_scene::Texture::default());
    let material = scene.objects[4].material.0 as usize;
    let texture = phong_scene::TextureRef::new(phong_scene::TextureId(0));
    scene.materials[material].bump = Some(texture);
    let more = needed(&scene) - plain;
    assert!((48 * triangles..1000 * triangles).contains(&more), "{more} bytes");
    // The same arrays again cost no more than any instance.
    let copy = scene.objects[4].clone();
    scene.objects.push(copy);
    assert!(needed(&scene) - plain - more < 1500);
}
