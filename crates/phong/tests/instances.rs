//! An instance has the bits of its objects written out with the same transform: for every shape, and
//! any transform that can be undone.

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3};
use phong::aov::Aov;
use phong::film::Film;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::TermSet;
use phong::view::View;
use phong_scene::{
    Camera, CameraKind, ConstantMaterial, Group, GroupId, Image, Light, LightKind, Material,
    MaterialId, Mesh, Model, NO_INDEX, Object, Points, Rgb, Scene, Shape, WardForm,
};
use proptest::prelude::*;

/// How many shapes [`shape`] makes.
const SHAPES: usize = 10;

/// A shape of unit size, more or less; its numbers come from `k` in [0, 1).
fn shape(number: usize, k: f64) -> Shape {
    let center = DVec3::new(k - 0.5, 0.3 * k, 0.2);
    let (radius, axis) = (0.3 + 0.4 * k, DVec3::new(k, 1.0, 0.5 - k));
    match number {
        0 => Shape::Sphere { center, radius },
        1 => Shape::Plane { point: center - DVec3::Y, normal: DVec3::new(0.2 * k, 1.0, -0.1) },
        2 => Shape::Triangle {
            points: [DVec3::NEG_X, DVec3::X, DVec3::Y + center],
            normals: (k < 0.5).then_some([DVec3::Z, DVec3::new(0.3, 0.1, 1.0), DVec3::Z]),
            uv: (k > 0.3).then_some([DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::ONE]),
        },
        3 => Shape::Disc { center, normal: axis, radius },
        4 => Shape::Box { min: center - radius, max: center + 0.5 * axis.abs() + 0.1 },
        5 => Shape::Cylinder { from: center, to: center + axis, radius, capped: k < 0.5 },
        6 => Shape::Cone {
            from: center,
            to: center + axis,
            radius,
            radius_to: 0.2 * k,
            capped: k > 0.5,
        },
        7 => Shape::Torus { center, axis, radius, tube: 0.4 * radius },
        8 => mesh(center, k).into(),
        _ => points(center, k).into(),
    }
}

/// A bumpy square with normals for some of its corners, colours and texture coordinates.
fn mesh(origin: DVec3, k: f64) -> Mesh {
    const N: u32 = 6;
    let at = |i: u32| {
        let (x, y) = (f64::from(i % N) / f64::from(N - 1), f64::from(i / N) / f64::from(N - 1));
        Vec3::new(x as f32 - 0.5, y as f32 - 0.5, (k * (9.0 * x - 5.0 * y * y)).fract() as f32)
    };
    let corner = |i: u32| (i / (N - 1)) * N + i % (N - 1);
    let squares = (0..(N - 1) * (N - 1)).map(corner);
    let indices = squares.flat_map(|i| [[i, i + 1, i + N], [i + 1, i + N + 1, i + N]]).collect();
    let mut mesh = Mesh {
        origin,
        positions: (0..N * N).map(at).collect(),
        indices,
        uvs: (0..N * N).map(|i| Vec2::new(i as f32, (i * i % 7) as f32)).collect(),
        ..Mesh::default()
    };
    if k > 0.2 {
        mesh.smooth(180.0);
        mesh.normal_indices = mesh.indices.clone();
        mesh.normal_indices[3] = [NO_INDEX; 3];
    }
    if k > 0.6 {
        mesh.colors = (0..N * N).map(|i| Rgb::new((i % 3) as f32 / 2.0, 0.5, 0.25)).collect();
        mesh.face_materials = (0..mesh.indices.len() as u32).map(|face| face % 3).collect();
    }
    mesh
}

fn points(origin: DVec3, k: f64) -> Points {
    let sphere = |i: u32| {
        let at = |step: f64| (f64::from(i) * step + k).fract() as f32 - 0.5;
        [at(0.819), at(0.671), at(0.549), 0.05 + 0.02 * (i % 4) as f32]
    };
    let colors = if k < 0.5 { 12 } else { 0 };
    Points {
        origin,
        spheres: (0..12).map(sphere).collect(),
        colors: (0..colors).map(|i| Rgb::new(0.25, i as f32 / 12.0, 0.5)).collect(),
        ..Points::default()
    }
}

/// A scene of these objects, in materials that ask for all that a surface can tell.
fn scene(objects: Vec<Object>, groups: Vec<Group>) -> Scene {
    let brushed = Model::Ward { roughness_x: 0.4, roughness_y: 0.1, form: WardForm::Gmd };
    let light = |kind| Light { kind, ..Light::default() };
    let attenuation = [1.0, 0.0, 0.0];
    Scene {
        image: Image { size: [16, 12], samples: 1, depth: 2, ..Image::default() },
        camera: Camera {
            kind: CameraKind::Perspective { fov: 40.0 },
            eye: DVec3::new(0.3, 0.8, 6.0),
            look_at: DVec3::ZERO,
            ..Camera::default()
        },
        lights: vec![
            light(LightKind::Distant { direction: DVec3::new(-1.0, -2.0, -2.0), angle: 0.0 }),
            light(LightKind::Point {
                position: DVec3::new(3.0, 1.0, 4.0),
                attenuation,
                radius: 0.0,
            }),
        ],
        materials: vec![
            Material { reflection: Rgb::grey(0.2).into(), ..Material::default() },
            ConstantMaterial { model: brushed, ..ConstantMaterial::default() }.into(),
            Material { transmission: Rgb::grey(0.6).into(), fresnel: true, ..Material::default() },
        ],
        objects,
        groups,
        ..Scene::default()
    }
}

fn film(scene: &Scene) -> Film {
    let view = View::of(scene).expect("a view");
    let aovs = [Aov::Depth, Aov::Normal, Aov::Position, Aov::Uv, Aov::Object, Aov::Material];
    let options = RenderOptions::of(&scene.image).expect("checked");
    let options = options.with_terms(TermSet::ALL).with_aovs(&aovs);
    render(&view, &options, &|_| {}, &Cancel::new()).film
}

/// The same object with arrays of its own.
fn copied(object: &Object, transform: DAffine3) -> Object {
    let mut object = Object { transform, ..object.clone() };
    match &mut object.shape {
        Shape::Mesh(mesh) => {
            mesh.positions = mesh.positions.to_vec().into();
            mesh.indices = mesh.indices.to_vec().into();
        }
        Shape::Points(points) => points.spheres = points.spheres.to_vec().into(),
        _ => {}
    }
    object
}

fn transform() -> impl Strategy<Value = DAffine3> {
    let number = || -1.0..1.0_f64;
    (prop::array::uniform9(number()), prop::array::uniform3(-0.8..0.8_f64), 0..4_u32).prop_map(
        |(m, translation, kind)| {
            let matrix = DMat3::from_cols_array(&m);
            let matrix3 = match kind {
                0 => DMat3::IDENTITY,
                // A rotation or a mirror image, times one scale.
                1 => {
                    let x = matrix.x_axis.normalize_or(DVec3::X);
                    let z = x.cross(matrix.y_axis).normalize_or(x.any_orthonormal_vector());
                    DMat3::from_cols(x, z.cross(x), z * m[8].signum()) * (0.5 + m[7].abs())
                }
                2 => DMat3::from_diagonal(DVec3::new(1.5, -0.5, 0.8)),
                _ => matrix,
            };
            // Flat ones are no transforms.
            let flat = matrix3.determinant().abs() < 0.05;
            let matrix3 = if flat { DMat3::from_diagonal(DVec3::NEG_ONE) } else { matrix3 };
            DAffine3 { matrix3, translation: translation.into() }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn an_instance_has_the_bits_of_its_objects_written_out(
        parts in prop::collection::vec((0..SHAPES, 0.0..1.0_f64, transform(), 0..3_u32), 1..5),
        placed in prop::collection::vec((transform(), any::<bool>()), 1..4),
        nested in transform(),
    ) {
        let parts: Vec<Object> = parts
            .into_iter()
            .map(|(number, k, transform, material)| Object {
                transform,
                material: MaterialId(material),
                ..Object::from(shape(number, k))
            })
            .collect();
        // Group 1 is group 0, placed.
        let inner = Object { transform: nested, ..Object::from(Shape::Instance(GroupId(0))) };
        let group = |objects| Group { objects, ..Group::default() };
        let groups = vec![group(parts.clone()), group(vec![inner])];
        let mut instances = Vec::new();
        let mut written = Vec::new();
        for (transform, deep) in placed {
            let id = GroupId(u32::from(deep));
            instances.push(Object { transform, ..Object::from(Shape::Instance(id)) });
            let transform = if deep { transform * nested } else { transform };
            written.extend(parts.iter().map(|part| copied(part, transform * part.transform)));
        }
        let (a, b) = (film(&scene(instances, groups)), film(&scene(written, Vec::new())));
        for (p, q) in a.layers.iter().zip(&b.layers) {
            let differ = p.values.iter().zip(q.values.iter()).filter(|(a, b)| a.to_bits() != b.to_bits());
            prop_assert_eq!(differ.count(), 0, "values of `{}` differ", p.kind.name());
        }
    }
}
