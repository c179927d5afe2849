//! What `Scene::check` says of scenes made in memory, and that nothing breaks on broken ones.

mod broken;

use broken::{any_scene, mesh};
use glam::{DAffine3, DVec3, Vec3};
use phong_scene::{
    Camera, CameraKind, Diagnostic, ExportOptions, Format, Framing, Group, GroupId, Image, Light,
    Material, MaterialId, Mesh, NO_INDEX, Object, Points, Rgb, Scene, Shape, SoundArrays,
};
use proptest::prelude::*;

fn said(scene: &Scene) -> Vec<String> {
    scene.check().iter().filter(|d| d.is_error()).map(ToString::to_string).collect()
}

#[track_caller]
fn assert_only(scene: &Scene, error: &str) {
    assert_eq!(said(scene), [format!("error: {error}")]);
}

fn lit(objects: Vec<Object>) -> Scene {
    Scene { lights: vec![Light::default()], objects, ..Scene::default() }
}

fn triangle() -> Mesh {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].into();
    Mesh { positions, indices: [[0, 1, 2]].into(), ..Mesh::default() }
}

#[track_caller]
fn assert_mesh(change: impl FnOnce(&mut Mesh), error: &str) {
    let mut mesh = triangle();
    change(&mut mesh);
    assert_only(&lit(vec![mesh.into()]), &format!("objects[0] `mesh`: {error}"));
}

#[test]
fn a_scene_of_defaults_with_an_object_and_a_light_has_nothing_wrong() {
    assert_eq!(lit(vec![Object::default(), triangle().into()]).check(), []);
}

#[test]
fn a_camera_that_cannot_look_is_told() {
    let camera = |camera| Scene { camera, ..lit(vec![Object::default()]) };
    let default = Camera::default();
    let same = Camera { look_at: default.eye, ..default.clone() };
    assert_only(
        &camera(same),
        "camera: `look_at` is where the eye is (the camera looks from `eye` to `look_at`; they must differ)",
    );
    let parallel = Camera { up: DVec3::Z, ..default.clone() };
    assert!(said(&camera(parallel))[0].contains("`up` is parallel to the view"));
    let wide = Camera { kind: CameraKind::Perspective { fov: 180.0 }, ..default.clone() };
    assert_only(&camera(wide), "camera: `fov` must be a number above 0 and below 180; this is 180");
    let nan = Camera { eye: DVec3::NAN, ..default };
    assert_only(&camera(nan), "camera: `eye` is NaN, not a number");
}

#[test]
fn a_picture_of_no_pixels_or_no_samples_is_told() {
    let image = |image| Scene { image, ..lit(vec![Object::default()]) };
    let none = Image { size: [0, 8], ..Image::default() };
    assert_only(&image(none), "image: `size` is from 1 to 1048576 pixels; this is 0");
    let none = Image { samples: 0, ..Image::default() };
    assert_only(&image(none), "image: `samples` is from 1 to 1000000; this is 0");
}

#[test]
fn arrays_that_do_not_fit_are_told_with_the_number_and_the_value() {
    assert_mesh(
        |m| m.indices = [[0, 1, 2], [0, 7, 2], [3, 1, 0]].into(),
        "`indices` 1 holds the index 7, but there are 3, and 1 more",
    );
    assert_mesh(|m| m.positions[1].y = f32::NAN, "`positions` 1 is NaN, not a number");
    assert_mesh(
        |m| m.normals = [Vec3::Z].into(),
        "`normals` holds 1 for 3 positions; without `normal_indices` it is one each",
    );
    assert_mesh(
        |m| (m.normals, m.normal_indices) = ([Vec3::Z].into(), [[0, NO_INDEX, 5]].into()),
        "`normal_indices` 0 holds the index 5, but there are 1",
    );
    assert_mesh(
        |m| m.normals = [Vec3::Z, Vec3::ZERO, Vec3::Z].into(),
        "`indices` 0 uses the normal 1, which is [0, 0, 0] and has no direction",
    );
    assert_mesh(|m| m.colors = [Rgb::WHITE].into(), "`colors` holds 1 for 3 positions");
    assert_mesh(
        |m| m.face_materials = [3].into(),
        "`face_materials` 0 is 3, but there are 1 materials",
    );
    assert_mesh(|m| m.indices.clear(), "`indices` is empty");
    let points = Points { spheres: [[0.0, 0.0, 0.0, 0.0]].into(), ..Points::default() };
    assert_only(
        &lit(vec![points.into()]),
        "objects[0] `points`: `spheres` 0 has the radius 0; it must be above 0",
    );
}

#[test]
fn a_material_that_there_is_not_and_a_placement_that_flattens_are_told() {
    let object = Object { material: MaterialId(9), ..Object::default() };
    assert_only(
        &lit(vec![object]),
        "objects[0] `object`: `material` is 9, but the scene holds 1 materials",
    );
    let transform = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert_only(
        &lit(vec![Object { transform, ..Object::default() }]),
        "objects[0] `object`: `matrix` is singular: it leaves nothing of the shape",
    );
}

#[test]
fn groups_that_hold_themselves_or_later_ones_are_told_and_deep_ones_do_not_overflow() {
    let place = |group: u32| Object::from(Shape::Instance(GroupId(group)));
    let group = |objects| Group { name: "g".to_owned(), objects };
    let mut scene = lit(vec![place(0)]);
    scene.groups = vec![group(vec![place(0)])];
    assert_only(&scene, "groups[0].objects[0] `instance`: the group holds itself");
    scene.groups = vec![group(vec![place(1)]), group(vec![place(0)])];
    assert_only(
        &scene,
        "groups[0].objects[0] `instance`: the group 1 (`g`) comes later: a group holds earlier ones",
    );
    scene.groups = vec![group(vec![Object::default()])];
    scene.groups.extend((0..100_000).map(|i| group(vec![place(i)])));
    scene.objects = vec![place(100_000)];
    assert!(said(&scene)[0].ends_with("groups go deeper than 256"), "{:?}", said(&scene));
    scene.objects = vec![place(100_001)];
    let last = said(&scene).pop();
    assert!(last.is_some_and(|l| l.ends_with("there is no group 100001: the scene holds 100001")));
}

#[test]
fn what_is_farther_than_numbers_go_is_told() {
    let transform = DAffine3::from_scale(DVec3::splat(1e10));
    let far = Shape::Sphere { center: DVec3::splat(1e10), radius: 1.0 };
    let scene = lit(vec![Object { transform, ..far.into() }]);
    assert!(said(&scene)[0].contains("units from the origin; scenes go up to 1e18"));
}

#[test]
fn what_is_smaller_than_numbers_tell_apart_is_told() {
    let of = |radius: f64| {
        let mut scene = lit(vec![Shape::Sphere { center: DVec3::ZERO, radius }.into()]);
        (scene.camera.eye, scene.camera.look_at) = (DVec3::Z * 5.0 * radius, DVec3::ZERO);
        scene
    };
    assert_eq!(of(1e-16).check(), []);
    let [warning] = &of(1e-20).check()[..] else { panic!("one warning") };
    let told = "warning: nothing is larger than 3.5e-20 units: below 1e-17 pictures are wrong";
    assert!(warning.to_string().starts_with(told), "{warning}");
}

#[test]
fn what_was_found_sound_is_not_read_again_and_what_changes_about_it_is_told() {
    let mut mesh = triangle();
    mesh.face_materials = [1].into();
    let scene = Scene {
        materials: vec![Material::default(); 2],
        ..lit(vec![mesh.clone().into(), triangle().into()])
    };
    let mut known = SoundArrays::default();
    let mut said = |scene: &Scene| -> Vec<String> {
        let again = scene.check_objects_again(&mut known);
        assert_eq!(again, scene.check_objects());
        again.iter().map(ToString::to_string).collect()
    };
    assert_eq!(said(&scene), [""; 0]);
    assert_eq!(said(&scene), [""; 0]);
    let fewer = Scene { materials: vec![Material::default()], ..scene.clone() };
    assert!(said(&fewer)[0].contains("`face_materials` 0 is 1, but there are 1 materials"));
    let mut far = scene.clone();
    let farthest = DVec3::splat(9e17);
    far.objects[1].transform = DAffine3 { translation: farthest, ..DAffine3::from_scale(farthest) };
    assert!(said(&far)[0].contains("units from the origin"), "{:?}", said(&far));
    let mut broken = scene.clone();
    let Shape::Mesh(mesh) = &mut broken.objects[1].shape else { panic!("a mesh") };
    mesh.positions[0].x = f32::NAN;
    assert!(said(&broken)[0].contains("`positions` 0 is NaN"));
    assert_eq!(said(&scene), [""; 0]);
}

#[test]
fn many_errors_are_counted() {
    let bad = Object { material: MaterialId(9), ..Object::default() };
    let said = lit(vec![bad; 5000]).check();
    assert_eq!(said.len(), 1001);
    assert_eq!(said[1000].message, "and 4000 more, beyond the first 1000, which are told");
}

proptest! {
    #[test]
    fn no_scene_however_broken_makes_anything_panic(scene in any_scene()) {
        let sound = !scene.check().iter().any(Diagnostic::is_error);
        let _ = scene.bounds();
        let mut framed = scene.clone();
        let _ = framed.frame(&Framing::default());
        for format in Format::writable() {
            let options = ExportOptions { format, ..ExportOptions::default() };
            match scene.clone().export(&options, "a") {
                Ok(export) => {
                    prop_assert!(sound);
                    for file in export.files {
                        file.write(&mut std::io::sink())?;
                    }
                }
                Err(error) => prop_assert!(sound || error.is_error()),
            }
        }
    }

    #[test]
    fn no_mesh_however_broken_makes_anything_panic(mut mesh in mesh()) {
        let _ = mesh.write_ply(phong_scene::PlyEncoding::Ascii, &mut std::io::sink());
        let _ = mesh.write_obj(&[], &mut std::io::sink());
        let _ = (mesh.bounds(), mesh.bytes());
        mesh.smooth(f64::NAN);
        mesh.smooth(60.0);
    }
}

#[test]
fn what_a_shifted_picture_shows_is_not_outside_of_it() {
    let at = |y: f64| {
        let ball = Shape::Sphere { center: DVec3::new(0.0, y, 0.0), radius: 0.1 };
        let mut scene = lit(vec![ball.into(), Object::default()]);
        scene.camera.eye = DVec3::new(0.0, 0.0, 10.0);
        scene.camera.look_at = DVec3::ZERO;
        scene.camera.up = DVec3::Y;
        scene.camera.kind = CameraKind::Perspective { fov: 20.0 };
        scene.camera.shift.y = 0.4;
        scene.check().iter().any(|said| said.message.contains("outside the picture"))
    };
    // The half height at the balls is 1.763: the picture goes from -0.35 to 3.17.
    assert!(!at(3.0), "above");
    assert!(at(-1.0), "below");
}

#[test]
fn the_colour_of_no_number_and_the_axis_of_a_map_are_judged_whatever_its_range() {
    let kind = phong_scene::TextureKind::Map {
        of: "height".to_owned(),
        axis: Some(DVec3::ZERO),
        range: phong_scene::MapRange::Auto,
        stops: vec![(0.0, Rgb::BLACK)],
        nan: Rgb::new(-1.0, 0.0, 0.0),
        unit: None,
    };
    let mut scene = lit(vec![Object::default()]);
    scene.textures = vec![phong_scene::Texture { kind, ..Default::default() }];
    let said = said(&scene).join("\n");
    assert!(said.contains("`nan`") && said.contains("`axis`"), "{said}");
}

#[test]
fn fields_that_change_are_judged_anew() {
    let mut mesh = triangle();
    let field = |values: &[f32]| phong_scene::Field {
        name: "t".into(),
        values: values.iter().copied().collect(),
    };
    mesh.fields = vec![field(&[1.0, 2.0, 3.0])];
    let scene = lit(vec![mesh.clone().into()]);
    let mut known = SoundArrays::default();
    assert!(scene.check_objects_again(&mut known).is_empty());
    assert!(scene.check_objects_again(&mut known).is_empty());
    mesh.fields = vec![field(&[1.0])];
    let broken = lit(vec![mesh.into()]);
    assert!(!broken.check_objects_again(&mut known).is_empty());
}

#[test]
fn a_fifth_property_is_told_of_at_its_texture_and_what_is_not_used_is_not_counted() {
    use phong_scene::{Texture, TextureId, TextureKind, TextureRef};
    let texture = |name: &str| {
        let kind = TextureKind::Map {
            of: name.to_owned(),
            axis: None,
            range: phong_scene::MapRange::Between([0.0, 1.0]),
            stops: vec![(0.0, Rgb::BLACK)],
            nan: Rgb::BLACK,
            unit: None,
        };
        Texture { name: name.to_owned(), kind, ..Texture::default() }
    };
    let names = ["p", "q", "r", "s", "t"];
    let scene = |used: &[u32]| {
        let mut objects = Vec::new();
        let mut materials = Vec::new();
        for (number, texture) in used.iter().enumerate() {
            let mut mesh = triangle();
            let field =
                |name: &&str| phong_scene::Field { name: (*name).into(), values: [0.5; 3].into() };
            mesh.fields = names.iter().map(field).collect();
            objects.push(Object { material: MaterialId(number as u32), ..Object::from(mesh) });
            let by = TextureRef::new(TextureId(*texture));
            materials.push(Material { color: by.into(), ..Material::default() });
        }
        Scene { materials, textures: names.map(texture).to_vec(), ..lit(objects) }
    };
    assert!(!scene(&[4]).check().iter().any(Diagnostic::is_error));
    let said = said(&scene(&[0, 1, 2, 3, 4]));
    assert!(
        said.iter().any(|s| s.contains("the texture \"t\" shows the property \"t\", but")),
        "{said:?}"
    );
}
