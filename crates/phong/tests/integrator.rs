//! The road of a ray, on scenes small enough to work out by hand.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use glam::{DAffine3, DVec3, Vec3};
use phong::aov::Aov;
use phong::film::{Film, LayerKind};
use phong::geometry::{Geometry, GeometryError, GeometryOptions};
use phong::reflectance::fresnel;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{TermSet, Terms};
use phong::view::{View, ViewError};
use phong_bvh::Ray;
use phong_scene::{
    AmbientRule, Background, Camera, CameraKind, ConstantMaterial, FilterKind, Group, GroupId,
    Image, Light, LightKind, Material, MaterialId, Mesh, Model, Object, Place, Points, Rgb, Scene,
    Shape, Tint, WardForm,
};

/// One pixel looking down −z from (0, 0, 10) at whatever is added.
fn scene() -> Scene {
    Scene {
        image: Image { size: [1, 1], samples: 1, ..Image::default() },
        camera: Camera {
            kind: CameraKind::Orthographic { height: 1e-3 },
            eye: DVec3::new(0.0, 0.0, 10.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: glam::DVec2::ZERO,
        },
        lights: Vec::new(),
        materials: vec![Material::default()],
        objects: Vec::new(),
        ..Scene::default()
    }
}

fn sun(direction: [f64; 3]) -> Light {
    let direction = DVec3::from_array(direction);
    Light {
        name: "sun".to_owned(),
        kind: LightKind::Distant { direction, angle: 0.0 },
        ..Light::default()
    }
}

fn object(shape: Shape) -> Object {
    Object {
        name: "thing".to_owned(),
        shape,
        material: MaterialId(0),
        transform: DAffine3::IDENTITY,
        place: Place::default(),
    }
}

fn sphere(center: [f64; 3], radius: f64) -> Object {
    object(Shape::Sphere { center: DVec3::from_array(center), radius })
}

fn plane(point: [f64; 3], normal: [f64; 3]) -> Object {
    let [point, normal] = [point, normal].map(DVec3::from_array);
    object(Shape::Plane { point, normal })
}

fn film_with(scene: &Scene, change: impl FnOnce(RenderOptions) -> RenderOptions) -> Film {
    let options = change(RenderOptions::of(&scene.image).unwrap().with_terms(TermSet::ALL));
    let compiled = View::of(scene).unwrap();
    render(&compiled, &options, &|_| {}, &Cancel::new()).film
}

/// The terms of the only pixel.
fn terms(scene: &Scene) -> Terms {
    let film = film_with(scene, |options| options);
    let terms = Terms::from_fn(|term| {
        let v = film.at(LayerKind::Term(term), 0, 0).unwrap();
        Rgb::new(v[0], v[1], v[2])
    });
    let picture = film.at(LayerKind::Picture, 0, 0).unwrap();
    assert_eq!(picture, terms.total().to_array(), "the terms sum to the picture");
    terms
}

fn close(a: Rgb, b: f32) {
    assert!((a - Rgb::grey(b)).to_array().iter().all(|d| d.abs() < 1e-6), "{a:?}, not {b}");
}

#[test]
fn a_sphere_lit_from_the_eye_shows_the_whole_sum() {
    let mut scene = scene();
    scene.objects.push(sphere([0.0; 3], 1.0));
    scene.lights.push(sun([0.0, 0.0, -1.0]));
    let terms = terms(&scene);
    close(terms.ambient, 0.1 * 0.8);
    close(terms.diffuse, 0.7 * 0.8);
    close(terms.specular, 0.3);
    assert_eq!(terms.background, Rgb::BLACK);
}

#[test]
fn lights_add_up_and_their_colour_tints_both_terms() {
    let mut scene = scene();
    scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
    scene.lights.push(sun([0.0, 0.0, -1.0]));
    scene.lights.push(Light {
        color: Rgb::new(0.5, 0.0, 0.0),
        specular_color: Rgb::new(0.0, 1.0, 0.0),
        ..sun([0.0, 0.0, -2.0])
    });
    let terms = terms(&scene);
    assert!((terms.diffuse.r - 0.7 * 0.8 * 1.5).abs() < 1e-6);
    assert!((terms.diffuse.g - 0.7 * 0.8).abs() < 1e-6);
    assert!((terms.specular.g - 0.6).abs() < 1e-6);
    assert!((terms.specular.r - 0.3).abs() < 1e-6);
}

#[test]
fn what_stands_in_the_way_of_a_light_takes_it_away() {
    let shadowed = |change: fn(&mut Scene)| {
        let mut scene = scene();
        scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
        scene.objects.push(sphere([3.0, 0.0, 3.0], 0.5));
        scene.lights.push(sun([-1.0, 0.0, -1.0]));
        change(&mut scene);
        terms(&scene)
    };
    assert_eq!(shadowed(|_| {}).diffuse, Rgb::BLACK);
    close(shadowed(|_| {}).ambient, 0.08);
    let lit = 0.7 * 0.8 * 0.5_f32.sqrt();
    close(shadowed(|scene| scene.lights[0].shadows = false).diffuse, lit);
    close(shadowed(|scene| scene.objects.truncate(1)).diffuse, lit);
}

#[test]
fn a_thing_behind_a_point_light_casts_no_shadow() {
    let mut scene = scene();
    scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
    scene.objects.push(sphere([6.0, 0.0, 6.0], 0.5));
    let position = DVec3::new(3.0, 0.0, 3.0);
    let kind = LightKind::Point { position, attenuation: [0.0, 0.0, 1.0], radius: 0.0 };
    scene.lights.push(Light { kind, ..sun([0.0, 0.0, -1.0]) });
    close(terms(&scene).diffuse, 0.7 * 0.8 * 0.5_f32.sqrt() / 18.0);
}

#[test]
fn shading_is_two_sided_and_a_light_behind_gives_nothing() {
    let lit = |normal, direction| {
        let mut scene = scene();
        scene.objects.push(plane([0.0; 3], normal));
        scene.lights.push(sun(direction));
        terms(&scene).diffuse
    };
    close(lit([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), 0.56);
    close(lit([0.0, 0.0, -1.0], [0.0, 0.0, -1.0]), 0.56);
    assert_eq!(lit([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]), Rgb::BLACK);
}

#[test]
fn a_light_below_the_geometric_horizon_gives_nothing_whatever_the_shading_normal() {
    let mut scene = scene();
    // A wall seen at a slant whose shading normals face the light behind it.
    let corner = |x: f64, y: f64| DVec3::new(x, y, -x);
    scene.objects.push(object(Shape::Triangle {
        points: [corner(-2.0, -2.0), corner(2.0, -2.0), corner(0.0, 3.0)],
        normals: Some([DVec3::new(-0.9, 0.0, 1.0); 3]),
        uv: None,
    }));
    scene.lights.push(sun([1.0, 0.0, 0.2]));
    assert_eq!(terms(&scene).diffuse, Rgb::BLACK);
}

#[test]
fn a_mirror_brings_what_it_sees_times_its_weight() {
    let mut scene = scene();
    scene.image.background = Background::Color(Rgb::new(0.25, 0.5, 1.0));
    scene.materials[0].reflection = Rgb::grey(0.5).into();
    scene.objects.push(plane([0.0; 3], [1.0, 0.0, 1.0]));
    let terms = terms(&scene);
    assert_eq!(terms.reflection, Rgb::new(0.125, 0.25, 0.5));
    scene.image.depth = 0;
    assert_eq!(self::terms(&scene).reflection, Rgb::BLACK, "beyond the depth a ray brings black");
}

#[test]
fn two_facing_mirrors_end_at_the_depth() {
    let mut scene = scene();
    scene.image.depth = 3;
    scene.ambient = Rgb::WHITE;
    scene.materials[0] = ConstantMaterial {
        k_a: 1.0,
        color: Rgb::WHITE,
        reflection: Rgb::grey(0.5),
        ..ConstantMaterial::default()
    }
    .into();
    scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
    scene.objects.push(plane([0.0, 0.0, 11.0], [0.0, 0.0, 1.0]));
    let terms = terms(&scene);
    assert_eq!(terms.total(), Rgb::grey(1.0 + 0.5 + 0.25 + 0.125));
}

fn glass(change: fn(&mut Material)) -> Scene {
    let mut scene = scene();
    scene.image.background = Background::Color(Rgb::WHITE);
    scene.materials[0] = ConstantMaterial {
        k_a: 0.0,
        k_d: 0.0,
        k_s: 0.0,
        reflection: Rgb::WHITE,
        transmission: Rgb::WHITE,
        fresnel: true,
        ..ConstantMaterial::default()
    }
    .into();
    change(&mut scene.materials[0]);
    scene
}

#[test]
fn glass_shares_light_by_the_exact_fresnel_reflectance() {
    let mut scene = glass(|_| {});
    scene.image.depth = 1;
    scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
    let terms = terms(&scene);
    let f = fresnel::dielectric(1.0, 1.5);
    assert!((f - 0.04).abs() < 1e-7);
    close(terms.reflection, f);
    close(terms.transmission, 1.0 - f);
}

#[test]
fn a_ball_of_glass_without_fresnel_lets_all_light_through() {
    let mut scene = glass(|m| {
        m.fresnel = false;
        m.reflection = Rgb::BLACK.into();
        m.ior = 1.0.into();
    });
    scene.objects.push(sphere([0.3, 0.2, 0.0], 1.0));
    assert_eq!(terms(&scene).transmission, Rgb::WHITE);
}

#[test]
fn beyond_the_critical_angle_all_light_is_mirrored() {
    // From inside (the plane's normal points away from the eye), at 45° > asin(1/1.5) = 41.8°.
    for fresnel in [true, false] {
        let mut scene = glass(|_| {});
        scene.materials[0].fresnel = fresnel;
        scene.materials[0].reflection = Rgb::grey(if fresnel { 1.0 } else { 0.25 }).into();
        scene.materials[0].transmission = Rgb::grey(if fresnel { 1.0 } else { 0.75 }).into();
        scene.objects.push(plane([0.0; 3], [-1.0, 0.0, -1.0]));
        let terms = terms(&scene);
        assert_eq!(terms.transmission, Rgb::BLACK);
        close(terms.reflection, 1.0);
    }
}

#[test]
fn ambient_per_light_goes_with_the_light_but_not_its_shadow() {
    let mut scene = scene();
    scene.materials[0].ambient_rule = AmbientRule::PerLight;
    scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
    scene.lights.push(Light { color: Rgb::grey(0.5), ..sun([0.0, 0.0, 1.0]) });
    scene.lights.push(Light { color: Rgb::grey(0.25), ..sun([0.0, 0.0, -1.0]) });
    close(terms(&scene).ambient, 0.1 * 0.8 * 0.75);
    scene.lights.clear();
    assert_eq!(terms(&scene).ambient, Rgb::BLACK);
}

#[test]
fn an_object_tint_takes_the_object_colour_and_not_the_light() {
    let mut scene = scene();
    scene.materials[0].tint = Tint::Object;
    scene.materials[0].color = Rgb::new(1.0, 0.5, 0.0).into();
    scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
    scene.lights.push(Light { specular_color: Rgb::grey(0.1), ..sun([0.0, 0.0, -1.0]) });
    let specular = terms(&scene).specular;
    assert!((specular.r - 0.3).abs() < 1e-6 && (specular.g - 0.15).abs() < 1e-6);
}

fn mesh(origin: DVec3) -> Mesh {
    Mesh {
        origin,
        positions: [
            Vec3::new(-2.0, -2.0, 0.0),
            Vec3::new(2.0, -2.0, 0.0),
            Vec3::new(0.0, 3.0, 0.0),
        ]
        .into(),
        indices: [[0, 1, 2]].into(),
        colors: [Rgb::new(1.0, 0.0, 0.0); 3].into(),
        ..Mesh::default()
    }
}

#[test]
fn vertex_and_point_colours_replace_the_material_colour() {
    let mut scene = scene();
    scene.lights.push(sun([0.0, 0.0, -1.0]));
    scene.objects.push(object(Shape::Mesh(Box::new(mesh(DVec3::ZERO)))));
    let red = terms(&scene).diffuse;
    assert!((red.r - 0.7).abs() < 1e-6 && red.g == 0.0);
    scene.objects[0] = object(Shape::Points(Box::new(Points {
        spheres: [[5.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]].into(),
        colors: [Rgb::BLACK, Rgb::new(0.0, 1.0, 0.0)].into(),
        ..Points::default()
    })));
    let green = terms(&scene).diffuse;
    assert!((green.g - 0.7).abs() < 1e-6 && green.r == 0.0);
}

#[test]
fn data_far_from_the_origin_keep_their_detail() {
    let far = DVec3::new(3e7, -2e7, 5e7);
    let mut here = scene();
    here.objects.push(object(Shape::Mesh(Box::new(mesh(DVec3::ZERO)))));
    here.objects.push(sphere([0.25, 0.0, 0.5], 0.01));
    here.lights.push(sun([0.3, 0.2, -1.0]));
    here.image.size = [24, 24];
    here.camera.kind = CameraKind::Orthographic { height: 3.0 };
    let mut there = here.clone();
    there.camera.eye += far;
    there.camera.look_at += far;
    there.objects[0] = object(Shape::Mesh(Box::new(mesh(far))));
    there.objects[1] = sphere((DVec3::new(0.25, 0.0, 0.5) + far).to_array(), 0.01);
    let [here, there] = [here, there].map(|scene| film_with(&scene, |options| options));
    let picture = |film: &Film| film.layer(LayerKind::Picture).unwrap().values.clone();
    let worst = picture(&here)
        .iter()
        .zip(&*picture(&there))
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    assert!(worst < 1e-4, "differs by {worst}");
}

#[test]
fn a_mirrored_closed_mesh_keeps_its_outside_outside() {
    // Glass decides by the geometric normal: entering bends the ray towards the normal.
    let inside = |mirror: bool| {
        let mut scene = glass(|_| {});
        scene.image.depth = 1;
        let mut thing = object(Shape::Mesh(Box::new(mesh(DVec3::ZERO))));
        if mirror {
            thing.transform = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        }
        scene.objects.push(thing);
        scene.camera.eye = DVec3::new(10.0, 0.0, 1.0);
        terms(&scene).transmission
    };
    // At a grazing 84° from inside nothing would be transmitted at all.
    assert!(inside(false).r > 0.1);
    close(inside(true), inside(false).r);
}

#[test]
fn the_grain_of_a_brushed_sphere_turns_with_it() {
    let tangent = |turned: bool| {
        let mut scene = scene();
        scene.materials[0].model =
            Model::Ward { roughness_x: 0.5.into(), roughness_y: 0.1.into(), form: WardForm::Gmd };
        let mut ball = sphere([0.0; 3], 1.0);
        if turned {
            ball.transform = DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2);
        }
        scene.objects.push(ball);
        let scene = View::of(&scene).unwrap();
        let ray = Ray::new(Vec3::new(0.0, 0.6, 5.0), Vec3::NEG_Z);
        let hit = scene.world().intersect(&ray);
        scene.coordinates(&ray, &hit).tangent
    };
    // Around the pole z; around the pole x, to which the turn takes z.
    assert!((tangent(false) - Vec3::NEG_X).length() < 1e-6, "{}", tangent(false));
    assert!((tangent(true) - Vec3::new(0.0, -0.8, 0.6)).length() < 1e-6, "{}", tangent(true));
}

#[test]
fn instances_place_their_group_each_time() {
    let mut scene = scene();
    scene.image.size = [3, 1];
    scene.camera.kind = CameraKind::Orthographic { height: 1.0 };
    scene.groups.push(Group { name: "ball".to_owned(), objects: vec![sphere([0.0; 3], 0.4)] });
    for x in [-1.0, 1.0] {
        let transform = DAffine3::from_translation(DVec3::X * x);
        scene.objects.push(Object { transform, ..object(Shape::Instance(GroupId(0))) });
    }
    let film = film_with(&scene, |options| options.with_aovs(&[Aov::Object, Aov::Depth]));
    let object = |x| film.at(LayerKind::Aov(Aov::Object), x, 0).unwrap()[0];
    assert_eq!([object(0), object(1), object(2)], [1.0, 0.0, 2.0]);
    let depth = |x| film.at(LayerKind::Aov(Aov::Depth), x, 0).unwrap()[0];
    assert!((depth(0) - 9.6).abs() < 1e-5);
    assert_eq!(depth(1), f32::INFINITY);
}

#[test]
fn alpha_is_the_share_of_samples_that_met_something() {
    let mut scene = scene();
    scene.image = Image {
        size: [1, 1],
        samples: 64,
        background: Background::Transparent,
        filter: FilterKind::Box,
        ..Image::default()
    };
    scene.camera.kind = CameraKind::Orthographic { height: 2.0 };
    let half = Shape::Box { min: DVec3::new(-5.0, -5.0, -1.0), max: DVec3::new(0.0, 5.0, 0.0) };
    scene.objects.push(object(half));
    scene.materials[0].k_a = 1.0.into();
    let film = film_with(&scene, |options| options);
    assert_eq!(film.at(LayerKind::Alpha, 0, 0).unwrap(), [0.5]);
    close(Rgb::grey(film.at(LayerKind::Picture, 0, 0).unwrap()[0]), 0.4);
}

#[test]
fn a_background_runs_from_top_to_bottom_of_the_picture() {
    let mut scene = scene();
    scene.image.size = [1, 4];
    scene.image.background = Background::Gradient { top: Rgb::WHITE, bottom: Rgb::BLACK };
    let film = film_with(&scene, |options| options);
    for y in 0..4 {
        let v = film.at(LayerKind::Picture, 0, y).unwrap()[0];
        assert!((v - (1.0 - (y as f32 + 0.5) / 4.0)).abs() < 1e-6);
    }
}

#[test]
fn a_scene_over_the_memory_limit_is_refused_before_it_is_built() {
    let mut scene = scene();
    let spheres = vec![[0.0, 0.0, 0.0, 1.0]; 1000].into();
    scene.objects.push(object(Shape::Points(Box::new(Points { spheres, ..Points::default() }))));
    let options = GeometryOptions { max_bytes: Some(10_000), ..GeometryOptions::default() };
    let error = Geometry::new(&scene, options).unwrap_err();
    assert!(matches!(error, GeometryError::Memory { needed: 16_000.., limit: 10_000 }));
}

#[test]
fn a_scene_too_large_for_its_numbers_is_refused() {
    let mut scene = scene();
    scene.objects.push(sphere([1e300, 0.0, 0.0], 1e299));
    let error = View::of(&scene).unwrap_err();
    assert!(matches!(error, ViewError::Geometry(GeometryError::Scene(_))));
}

/// A floor under the plane of the picture, of 24 × 24 pixels, 6 units across.
fn floor_seen_from_above(lights: Vec<Light>) -> Scene {
    let mut scene = scene();
    scene.image = Image { size: [24, 24], samples: 4, ..Image::default() };
    scene.camera.kind = CameraKind::Orthographic { height: 6.0 };
    scene.objects.push(plane([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    scene.objects.push(sphere([0.5, 0.0, 0.4], 0.4));
    scene.lights = lights;
    scene
}

#[test]
fn lights_are_left_out_where_they_end_and_no_bit_changes() {
    let lamp = |i: i32| {
        let position = DVec3::new(f64::from(i % 4) * 1.5 - 2.0, f64::from(i / 4) - 1.5, 1.0);
        let (attenuation, radius) = ([1.0, 0.0, 0.0], 0.1 * f64::from(i % 2));
        let direction = DVec3::new(1.0, 0.3, -0.2);
        let kind = match i % 3 {
            0 => LightKind::Point { position, attenuation, radius },
            1 => LightKind::Spot {
                position,
                target: position + DVec3::new(0.3, 0.1, -1.0),
                cone: 20.0,
                edge: 40.0,
                attenuation,
                radius,
            },
            _ => LightKind::Disc { position, direction, radius: 0.3, attenuation },
        };
        Light { kind, range: (i % 5 != 0).then_some(1.6), ..Light::default() }
    };
    let scene = floor_seen_from_above((0..16).map(lamp).collect());
    let view = View::of(&scene).unwrap();
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    for pixel in [[0, 0], [3, 20], [11, 11], [12, 5], [20, 9], [23, 23], [8, 16]] {
        // Who is told of each light has none left out.
        let told = phong::explain::explain(&view, &options, pixel).unwrap().linear;
        let [x, y] = pixel;
        assert_eq!(film.at(LayerKind::Picture, x, y).unwrap(), told.to_array(), "{pixel:?}");
    }
}

#[test]
fn nothing_of_a_light_is_beyond_its_range() {
    let position = DVec3::new(0.0, 0.0, 1.0);
    let kind = LightKind::Point { position, attenuation: [1.0, 0.0, 0.0], radius: 0.0 };
    for (range, lit) in [(9.0, true), (1.001, true), (0.999, false)] {
        let mut scene = scene();
        scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
        scene.lights.push(Light { kind, range: Some(range), ..Light::default() });
        assert_eq!(terms(&scene).diffuse.r > 0.0, lit, "{range}");
    }
}

#[test]
fn a_tiny_light_with_a_surface_gives_what_a_point_light_gives() {
    let (position, attenuation) = (DVec3::new(0.3, 0.2, 1.5), [0.5, 0.2, 0.1]);
    let direction = DVec3::new(0.1, 0.0, -1.0);
    let size = 1e-4;
    let of = |kind: LightKind| {
        let light = Light { kind, visible: false, ..Light::default() };
        film_with(&floor_seen_from_above(vec![light]), |options| options)
    };
    let point = of(LightKind::Point { position, attenuation, radius: 0.0 });
    for kind in [
        LightKind::Rectangle {
            position,
            direction,
            up: None,
            width: size,
            height: size,
            attenuation,
        },
        LightKind::Disc { position, direction, radius: size, attenuation },
        LightKind::Sphere { position, radius: size, attenuation },
    ] {
        let film = of(kind);
        let values = |film: &Film| film.layer(LayerKind::Picture).unwrap().values.to_vec();
        let differ = |(a, b): (f32, f32)| (a - b).abs() > 2e-4;
        let pairs = values(&point).into_iter().zip(values(&film));
        // At the rim of the shadow a sample may see a part of it.
        let count = pairs.filter(|pair| differ(*pair)).count();
        assert!(count <= 6, "{count} values differ for {kind:?}");
    }
}

#[test]
fn the_surface_of_a_light_is_an_emission_and_no_object() {
    let mut scene = scene();
    scene.objects.push(plane([0.0; 3], [0.0, 0.0, 1.0]));
    let attenuation = [1.0, 0.0, 0.0];
    let (position, direction) = (DVec3::new(0.0, 0.0, 2.0), DVec3::Z);
    let kind = LightKind::Disc { position, direction, radius: 0.5, attenuation };
    scene.lights.push(Light { kind, color: Rgb::new(3.0, 2.0, 1.0), ..Light::default() });
    let seen = terms(&scene);
    assert_eq!(seen, Terms { emission: Rgb::new(3.0, 2.0, 1.0), ..Terms::default() });
    let film = film_with(&scene, |options| options.with_aovs(&[Aov::Depth, Aov::Object]));
    assert_eq!(film.at(LayerKind::Aov(Aov::Depth), 0, 0).unwrap(), [8.0]);
    assert_eq!(film.at(LayerKind::Aov(Aov::Object), 0, 0).unwrap(), [0.0]);
    // It is in nobody's way, and from behind it is not there.
    let kind = LightKind::Disc { position, direction: -direction, radius: 0.5, attenuation };
    scene.lights[0] = Light { kind, ..Light::default() };
    close(terms(&scene).diffuse, 0.7 * 0.8);
}
