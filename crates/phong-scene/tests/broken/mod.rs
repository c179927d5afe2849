//! Scenes of which some are broken: wrong numbers, indices, lengths, groups.

use glam::{DAffine3, DVec3, Vec2, Vec3};
use phong_scene::{
    AmbientOcclusion, Background, BarLength, Camera, CameraKind, Cap, Clip, ClipKind,
    ConstantMaterial, Exposure, Field, Fog, FogKind, Fresnel, Furniture, FurnitureStyle,
    GradientBy, Group, GroupId, Image, Light, LightKind, MapRange, Material, MaterialId, Mesh,
    Model, NO_INDEX, Object, OcclusionDistance, Outline, PointLabel, Points, Rgb, ScaleBar, Scene,
    Shape, SkyKind, Texture, TextureId, TextureKind, TextureRef, Tone,
};
use proptest::prelude::*;

/// Numbers of which some are no numbers, or too large.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        600 => -10.0..10.0,
        1 => prop::sample::select(vec![
            0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e18, -1e300, 1e-300, f64::MAX,
        ]),
    ]
}

/// Lengths and weights, of which most are above 0.
fn length() -> impl Strategy<Value = f64> {
    prop_oneof![150 => 0.1..4.0, 1 => number()]
}

fn single() -> impl Strategy<Value = f32> {
    prop_oneof![300 => 0.0..1.0_f32, 1 => number().prop_map(|n| n as f32)]
}

fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(number()).prop_map(DVec3::from)
}

fn color() -> impl Strategy<Value = Rgb> {
    prop::array::uniform3(single()).prop_map(Rgb::from)
}

fn index() -> impl Strategy<Value = u32> {
    prop_oneof![60 => 0..2_u32, 1 => Just(NO_INDEX), 1 => any::<u32>()]
}

fn list<S: Strategy>(of: S) -> impl Strategy<Value = Vec<S::Value>>
where
    S::Value: Clone,
{
    prop::collection::vec(of, 0..5)
}

/// A mesh of which all arrays fit, or any at all.
fn mesh_or_so() -> impl Strategy<Value = Mesh> {
    let corner = prop::array::uniform3(0.0..1.0_f32).prop_map(Vec3::from);
    let sound = (prop::collection::vec(corner, 4), any::<[bool; 3]>()).prop_map(
        |(positions, [normals, colors, materials])| {
            let mesh = Mesh {
                indices: [[0, 1, 2], [3, 2, 1]].into(),
                normals: if normals { vec![Vec3::X; 4] } else { Vec::new() }.into(),
                colors: if colors { vec![Rgb::WHITE; 4] } else { Vec::new() }.into(),
                face_materials: if materials { vec![0, 1] } else { Vec::new() }.into(),
                ..Mesh::default()
            };
            Mesh { positions: positions.into(), ..mesh }
        },
    );
    prop_oneof![6 => sound, 1 => mesh()]
}

pub(crate) fn mesh() -> impl Strategy<Value = Mesh> {
    let corners = || list(prop::array::uniform3(index()));
    let single3 = || prop::array::uniform3(single()).prop_map(Vec3::from);
    (
        (vector(), list(single3()), corners(), list(single3()), corners()),
        (
            list(prop::array::uniform2(single()).prop_map(Vec2::from)),
            corners(),
            list(color()),
            list(index()),
        ),
    )
        .prop_map(|((origin, positions, indices, normals, normal_indices), rest)| {
            let (uvs, uv_indices, colors, face_materials) = rest;
            Mesh {
                origin,
                positions: positions.into(),
                indices: indices.into(),
                normals: normals.into(),
                normal_indices: normal_indices.into(),
                uvs: uvs.into(),
                uv_indices: uv_indices.into(),
                colors: colors.into(),
                face_materials: face_materials.into(),
                fields: Vec::new(),
            }
        })
}

fn shape() -> impl Strategy<Value = Shape> {
    let points = (vector(), list(prop::array::uniform4(single())), list(color())).prop_map(
        |(origin, mut spheres, mut colors)| {
            // Colours that do not fit are rarer than those that do, and so are empty clouds.
            if colors.len() != 4 {
                spheres.push([0.0, 0.0, 0.0, 0.5]);
                colors.clear();
            }
            let (spheres, colors) = (spheres.into(), colors.into());
            // Not one each, most of the time.
            let fields = vec![Field { name: "T".into(), values: [0.5; 4].into() }];
            Points { origin, spheres, colors, guessed: None, fields }.into()
        },
    );
    let capped = any::<bool>;
    prop_oneof![
        (vector(), length()).prop_map(|(center, radius)| Shape::Sphere { center, radius }),
        (vector(), vector()).prop_map(|(point, normal)| Shape::Plane { point, normal }),
        prop::array::uniform3(vector()).prop_map(|points| Shape::Triangle {
            points,
            normals: None,
            uv: None
        }),
        (vector(), vector(), length()).prop_map(|(center, normal, radius)| Shape::Disc {
            center,
            normal,
            radius
        }),
        (vector(), prop::array::uniform3(length()))
            .prop_map(|(min, size)| Shape::Box { min, max: min + DVec3::from(size) }),
        (vector(), vector(), length(), capped())
            .prop_map(|(from, to, radius, capped)| Shape::Cylinder { from, to, radius, capped }),
        (vector(), vector(), length(), length(), capped()).prop_map(
            |(from, to, radius, radius_to, capped)| Shape::Cone {
                from,
                to,
                radius,
                radius_to,
                capped
            }
        ),
        (vector(), vector(), length(), length()).prop_map(|(center, axis, radius, tube)| {
            Shape::Torus { center, axis, radius: tube + radius, tube }
        }),
        mesh_or_so().prop_map(Shape::from),
        points,
        index().prop_map(|group| Shape::Instance(GroupId(group))),
    ]
}

fn objects() -> impl Strategy<Value = Vec<Object>> {
    let transform = prop_oneof![
        4 => Just(DAffine3::IDENTITY),
        1 => prop::array::uniform4(vector())
            .prop_map(|[x, y, z, t]| DAffine3 { matrix3: glam::DMat3::from_cols(x, y, z), translation: t }),
    ];
    prop::collection::vec(
        (shape(), index(), transform).prop_map(|(shape, material, transform)| Object {
            material: MaterialId(material % 7),
            transform,
            ..shape.into()
        }),
        0..4,
    )
}

prop_compose! {
    fn light()(
        color in color(), position in vector(), target in vector(), cone in length(),
        edge in length(), attenuation in prop::array::uniform3(length()), radius in length(),
        kind in 0..6, range in prop::option::of(length()),
    ) -> Light {
        let kind = match kind {
            0 => LightKind::Point { position, attenuation, radius },
            1 => LightKind::Distant { direction: target, angle: cone },
            2 => LightKind::Disc { position, direction: target, radius, attenuation },
            3 => LightKind::Sphere { position, radius, attenuation },
            4 => LightKind::Rectangle {
                position,
                direction: target,
                up: Some(position),
                width: cone,
                height: edge,
                attenuation,
            },
            _ => {
                LightKind::Spot { position, target, cone, edge: cone + edge, attenuation, radius }
            }
        };
        Light { color, kind, range, ..Light::default() }
    }
}

prop_compose! {
    fn material()(
        color in color(), ambient_color in prop::option::of(color()), k in prop::array::uniform4(single()),
        ior in single(), reflection in color(), sigma in single(), kind in 0..4, f0 in color(),
    ) -> ConstantMaterial {
        let [k_a, k_d, k_s, shininess] = k;
        let model = match kind {
            0 => Model::Phong,
            1 => Model::OrenNayar { sigma, full: true },
            2 => Model::Ward { roughness_x: sigma, roughness_y: ior, form: phong_scene::WardForm::Gmd },
            _ => Model::Microfacet {
                distribution: phong_scene::Distribution::Ggx,
                roughness: sigma,
                shadowing: phong_scene::Shadowing::Correlated,
                fresnel: Fresnel::Schlick { f0 },
            },
        };
        ConstantMaterial {
            color, ambient_color, k_a, k_d, k_s, shininess, ior, reflection, model,
            transmission: f0,
            opacity: k_s,
            ..ConstantMaterial::default()
        }
    }
}

prop_compose! {
    fn texture()(
        a in color(), b in color(), scale in single(), axis in vector(), length in length(), kind in 0..40,
    ) -> Texture {
        let kind = match kind {
            0..15 => TextureKind::Checker { colors: [a, b], scale: scale.into() },
            15..17 => TextureKind::Noise {
                stops: vec![(scale, a)], scale: length, octaves: 3, lacunarity: length, gain: length, seed: 1,
            },
            17 => TextureKind::Map {
                of: "T".to_owned(), axis: Some(axis), range: MapRange::Between([0.0, length]),
                stops: vec![(0.0, a), (1.0, b)], nan: a, unit: None,
            },
            18..20 => TextureKind::Marble {
                stops: vec![(0.0, a), (1.0, b)], scale: length, axis, turbulence: length, octaves: 1,
                lacunarity: 2.0, gain: 0.5, seed: 1,
            },
            20..39 => TextureKind::Gradient { by: GradientBy::Radius, axis, from: 0.0, to: length, stops: vec![(0.0, a), (scale, b)] },
            _ => TextureKind::Gradient { by: GradientBy::Axis, axis, from: 1.0, to: length, stops: Vec::new() },
        };
        Texture { kind, ..Texture::default() }
    }
}

prop_compose! {
    /// Some have a texture for their colour or their highlight, not all of which there are.
    fn any_material()(
        constant in material(), texture in index(), what in 0..8, scale in single(),
    ) -> Material {
        let mut material = Material::from(constant);
        let by = TextureRef { scale, ..TextureRef::new(TextureId(texture)) };
        match what {
            0 => material.color = by.into(),
            1 => material.k_s = by.into(),
            2 => material.shininess = by.into(),
            _ => {}
        }
        material
    }
}

prop_compose! {
    pub(crate) fn any_scene()(
        size in prop::array::uniform2(prop_oneof![80 => 1..9_u32, 1 => Just(0)]),
        samples in prop_oneof![80 => 1..3_u32, 1 => Just(0)],
        depth in 0..9_u32,
        camera in (vector(), vector(), vector(), length(), length()),
        ambient in color(), top in color(), lights in list(light()),
        materials in prop::collection::vec(any_material(), 2..5),
        textures in prop::collection::vec(texture(), 2..4),
        objects in objects(), groups in prop::collection::vec(objects(), 0..4),
    ) -> Scene {
        let (eye, look_at, up, fov, aperture) = camera;
        let kind = CameraKind::Perspective { fov: 10.0 * fov };
        let background = Background::Gradient { top, bottom: ambient };
        let groups = groups.into_iter().map(|objects| Group { name: "g".into(), objects }).collect();
        Scene {
            image: Image { size, samples, depth, background, ..Image::default() },
            camera: Camera { kind, eye, look_at, up, aperture, ..Camera::default() },
            ambient_occlusion: Some(AmbientOcclusion { samples: depth, distance: OcclusionDistance::Units(fov) }),
            sky: Some(phong_scene::Sky {
                kind: SkyKind::SunAndSky { sun: up, turbidity: 2.0 + fov, ground: None },
                up,
                ..phong_scene::Sky::default()
            }),
            fog: Some(Fog {
                kind: FogKind::Linear { start: 0.0, end: fov },
                color: Some(top),
                ..Fog::default()
            }),
            outline: Some(Outline { width: fov, ..Outline::default() }),
            furniture: Furniture {
                style: FurnitureStyle { size: fov, halo: aperture, ..FurnitureStyle::default() },
                scale_bar: Some(ScaleBar { length: BarLength::Units(fov), ..ScaleBar::default() }),
                labels: vec![PointLabel { text: "a".into(), at: eye, radius: aperture, ..PointLabel::default() }],
                ..Furniture::default()
            },
            tone: Some(Tone { exposure: Exposure::Stops(fov), neutral: Some(top), ..Tone::default() }),
            clips: vec![Clip {
                kind: ClipKind::Plane { point: eye, normal: up },
                // Now and then a material that is not there.
                cap: Cap::Of(MaterialId(if depth < 8 { depth % 2 } else { depth })),
                ..Clip::default()
            }],
            ambient, lights, materials, textures, objects, groups,
        }
    }
}
