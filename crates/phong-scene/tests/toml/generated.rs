//! Scenes of every sort, made up, written and read back.

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3};
use phong_scene::{
    AmbientOcclusion, AmbientRule, Anchor, Axes, Background, BarLength, Camera, CameraKind, Cap,
    Caps, CellsBy, Channel, Clip, ClipKind, ConstantMaterial as Material, Cylinders, Dialect,
    Distribution, Exposure, FilterKind, Fog, FogDistance, FogKind, Fresnel, Furniture,
    FurnitureStyle, GradientBy, GridAxes, Group, GroupId, Hidden, Image, Keep, Legend, Light,
    LightKind, MapRange, MaterialId, Mesh, Model, NO_INDEX, NormalFormat, Object,
    OcclusionDistance, OpacityMode, Outline, Place, PointLabel, Points, Rgb, ScaleBar, Scene,
    ShadowRule, Shadowing, Shape, Sky, SkyKind, Texture, TextureId, TextureKind, TextureRef,
    TextureSpace, Tint, Title, Tone, ToneCurve, VertexColors, Viewer, WardForm,
};
use proptest::prelude::*;

use crate::choices::Make;
use crate::roundtrip::assert_comes_back;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_scene_comes_back(seed in any::<u64>()) {
        assert_comes_back(&Make(seed).scene(), "a generated scene");
    }
}

impl Make {
    /// Far from others by its third coordinate only if asked to be.
    fn point(&mut self) -> DVec3 {
        let size = self.one(&[1.0, 1.0, 100.0, 1e-7]);
        let mut axis = || (self.number() - 0.5) * size;
        DVec3::new(axis(), axis(), axis())
    }

    fn color(&mut self) -> Rgb {
        match self.below(4) {
            0 => Rgb::grey(self.float()),
            1 => Rgb::from_srgb8([self.bits() as u8, 7, self.bits() as u8]),
            2 => Rgb::new(1.0, 0.0, self.float()),
            _ => Rgb::new(self.float(), self.float(), 3.0 * self.float()),
        }
    }

    fn name(&mut self) -> String {
        self.one(&["a", "b-2", "two words", "Größe", "\"q\"\\", "#", "tab\tand\nline"]).to_owned()
    }

    fn scene(&mut self) -> Scene {
        let textures: Vec<_> = (0..self.below(4)).map(|i| self.texture(i)).collect();
        let materials: Vec<_> = (0..=self.below(5))
            .map(|i| {
                let material = self.material(i).into();
                self.textured(material, textures.len())
            })
            .collect();
        let mut groups: Vec<Group> = Vec::new();
        for i in 0..self.below(3) {
            let objects = self.objects(materials.len(), i);
            groups.push(Group { name: format!("{} {i}", self.name()), objects });
        }
        let objects = self.objects(materials.len(), groups.len());
        let lights = (0..self.below(4)).map(|i| self.light(i + 1)).collect();
        let clips = (0..self.below(3))
            .map(|_| {
                let (point, normal, size) = (self.point(), DVec3::X, DVec3::splat(self.number()));
                let keep = self.one(&[Keep::Outside, Keep::Inside]);
                let kinds = [
                    ClipKind::Plane { point, normal },
                    ClipKind::Box { min: point, max: point + size, keep },
                ];
                let caps = [Cap::Own, Cap::Open, Cap::Of(MaterialId(0))];
                Clip { kind: self.one(&kinds), cap: self.one(&caps), ..Clip::default() }
            })
            .collect();
        let (image, camera, ambient) = (self.image(), self.camera(), self.color());
        let distance = self.one(&[OcclusionDistance::Auto, OcclusionDistance::Units(2.5)]);
        let ambient_occlusion = self.flag().then_some(AmbientOcclusion { samples: 9, distance });
        let kind = self.one(&[
            FogKind::Linear { start: 0.0, end: 2.5 },
            FogKind::Linear { start: 1.0, end: 2.5 },
            FogKind::Exponential { density: 0.1 },
            FogKind::Squared { density: 0.3 },
        ]);
        let distance = self.one(&[FogDistance::Radial, FogDistance::Planar]);
        let (color, strength) = (self.flag().then(|| self.color()), self.one(&[1.0, 0.5]));
        let (sun, ground) =
            (DVec3::new(1.0, 0.5, self.number()), self.flag().then(|| self.color()));
        let kind_of_sky = match self.below(3) {
            0 => SkyKind::Constant,
            1 => SkyKind::Gradient { zenith: Rgb::grey(0.5), horizon: Rgb::WHITE, ground },
            _ => SkyKind::SunAndSky { sun, turbidity: 2.5, ground },
        };
        let (color_of_sky, up) = (self.color(), self.one(&[DVec3::Y, DVec3::X]));
        let of_sky = Sky { kind: kind_of_sky, up, color: color_of_sky, samples: 9 };
        let sky = self.flag().then_some(of_sky);
        let fog = self.flag().then_some(Fog { kind, color, distance, strength });
        let curve =
            self.one(&[ToneCurve::Clamp, ToneCurve::Reinhard { white: 2.5 }, ToneCurve::Filmic]);
        let exposure = self.one(&[Exposure::Auto, Exposure::Stops(-1.5), Exposure::default()]);
        let (white_balance, neutral) =
            self.one(&[(None, None), (Some(3200.0), None), (None, Some(Rgb::new(1.0, 0.5, 0.25)))]);
        let tone = Tone { exposure, white_balance, neutral, curve };
        Scene {
            image,
            camera,
            ambient,
            ambient_occlusion,
            sky,
            fog,
            outline: self.flag().then_some(Outline {
                width: 0.5,
                crease: 30.0,
                ..Outline::default()
            }),
            furniture: self.furniture(),
            tone: self.flag().then_some(tone),
            clips,
            lights,
            materials,
            textures,
            objects,
            groups,
        }
    }

    fn furniture(&mut self) -> Furniture {
        let place = self.one(&[Anchor::Top, Anchor::BottomRight]);
        let label = PointLabel {
            text: "a \"b\"\nc".to_owned(),
            at: DVec3::new(1.0, 2.0, self.number()),
            hidden: self.one(&[Hidden::Behind, Hidden::Never]),
            offset: DVec2::new(self.number(), 0.0),
            ..PointLabel::default()
        };
        let unit = self.one(&["", "Å"]).to_owned();
        let length = self.one(&[BarLength::Auto, BarLength::Units(2.5)]);
        let map = Some(vec![(0.0, self.color()), (0.5, Rgb::WHITE)]);
        let from = self.flag().then_some(-1.5);
        Furniture {
            style: FurnitureStyle {
                size: self.one(&[9.0, 7.5]),
                color: self.flag().then(|| self.color()),
                ..FurnitureStyle::default()
            },
            title: self.flag().then(|| Title { text: "Ti tle".to_owned(), place }),
            scale_bar: self.flag().then(|| ScaleBar {
                length,
                unit: unit.clone(),
                factor: 0.1,
                place,
            }),
            axes: self.flag().then_some(Axes { length: 24.0, place }),
            legend: self.flag().then(|| Legend { map, from, unit, ..Legend::default() }),
            labels: if self.flag() { vec![label.clone(), label] } else { Vec::new() },
        }
    }

    fn image(&mut self) -> Image {
        use FilterKind::{Box, Gaussian, Mitchell, Tent};
        Image {
            size: [1 + self.below(5000) as u32, 540],
            samples: self.one(&[16, 1, 1_000_000]),
            background: match self.below(3) {
                0 => Background::Color(self.color()),
                1 => Background::Transparent,
                _ => Background::Gradient { top: self.color(), bottom: self.color() },
            },
            filter: self.one(&[Box, Tent, Gaussian, Mitchell]),
            seed: self.one(&[0, 1, u64::MAX]),
            min_weight: self.one(&[1e-4, 0.0, 0.25, 1.0]),
            depth: self.one(&[8, 0, 100]),
            terminator: self.one(&[true, false]),
            dpi: self.one(&[None, Some(300.0)]),
            cel: self.one(&[None, Some(3)]),
        }
    }

    fn camera(&mut self) -> Camera {
        let lens = self.flag();
        let kind = match self.below(4) {
            0 => CameraKind::Perspective { fov: 179.0 * self.number() / 1.01 },
            1 => CameraKind::Orthographic { height: self.number() },
            2 if !lens => CameraKind::Fisheye { fov: 356.0 * self.number() },
            _ if !lens => CameraKind::Panorama,
            _ => CameraKind::Perspective { fov: 40.0 },
        };
        Camera {
            kind,
            eye: self.point() + DVec3::Z * 1e3,
            look_at: self.point(),
            up: DVec3::new(self.number(), 5.0, 0.0),
            aperture: if lens { self.number() } else { 0.0 },
            focus: (lens && self.flag()).then(|| self.number()),
            shift: if lens { DVec2::new(self.number(), 0.0) } else { DVec2::ZERO },
        }
    }

    fn light(&mut self, number: usize) -> Light {
        let attenuation = self.one(&[[1.0, 0.0, 0.0], [0.5, 0.25, 1e-9]]);
        let position = self.point();
        let radius = self.one(&[0.0, 0.125]);
        let direction = DVec3::new(self.number(), -1.0, 0.0);
        let kind = match self.below(6) {
            3 => LightKind::Rectangle {
                position,
                direction,
                up: self.flag().then(|| DVec3::new(0.0, 0.5, self.number())),
                width: 1.0 + self.number().abs(),
                height: 0.25,
                attenuation,
            },
            4 => LightKind::Disc { position, direction, radius: 0.5, attenuation },
            5 => LightKind::Sphere { position, radius: 0.125, attenuation },
            0 => LightKind::Point { position, attenuation, radius },
            1 => LightKind::Distant {
                direction: DVec3::new(self.number(), -1.0, 0.0),
                angle: self.one(&[0.0, 0.53]),
            },
            _ => LightKind::Spot {
                position,
                target: position + DVec3::new(0.0, self.number(), 1.0),
                cone: 45.0 * self.number() / 1.01,
                edge: self.one(&[45.0, 90.0]),
                attenuation,
                radius,
            },
        };
        let color = self.color();
        let is_distant = kind.position().is_none();
        let has_surface = kind.has_surface();
        Light {
            name: if self.flag() { format!("light {number}") } else { self.name() },
            kind,
            color,
            specular_color: if self.flag() { color } else { self.color() },
            shadows: self.flag(),
            range: (!is_distant && self.flag()).then_some(7.5),
            visible: !has_surface || self.flag(),
            object: String::new(),
            place: Place::default(),
        }
    }

    fn model(&mut self) -> Model<f32, Rgb> {
        use Shadowing::{Correlated, Implicit, Separable, VCavity};
        match self.below(7) {
            0 => Model::Lambert,
            1 => Model::Phong,
            2 => Model::BlinnPhong,
            3 => Model::BlinnFast,
            4 => Model::Microfacet {
                distribution: self.one(&[
                    Distribution::Blinn,
                    Distribution::Beckmann,
                    Distribution::Ggx,
                ]),
                roughness: self.float(),
                shadowing: self.one(&[Separable, Correlated, VCavity, Implicit]),
                fresnel: match self.below(5) {
                    0 => Fresnel::None,
                    1 => Fresnel::Schlick { f0: Rgb::grey(0.04) },
                    2 => Fresnel::Schlick { f0: Rgb::new(0.5, 0.25, 0.9 * self.float()) },
                    3 => Fresnel::Conductor {
                        eta: Rgb::new(self.float(), 0.5, 2.0),
                        k: self.color(),
                    },
                    _ => Fresnel::Dielectric { eta: self.float() },
                },
            },
            5 => Model::OrenNayar {
                sigma: (90.0 * self.number() / 1.01).to_radians() as f32,
                full: self.flag(),
            },
            _ => {
                let roughness_x = self.float();
                let roughness_y = if self.flag() { roughness_x } else { self.float() };
                Model::Ward {
                    roughness_x,
                    roughness_y,
                    form: self.one(&[WardForm::Ward, WardForm::Gmd]),
                }
            }
        }
    }

    fn texture(&mut self, number: usize) -> Texture {
        let stops: Vec<_> = [0.0, 0.25, 0.25, 0.3, 1.0].map(|t| (t, self.color())).into();
        let axis = DVec3::new(self.number(), -2.0, 0.0);
        let (colors, scale, seed) =
            ([self.color(), self.color()], self.number(), self.below(9) as u32);
        let (octaves, lacunarity, gain) = (1 + seed, 1.0 + self.number(), self.number() / 1.01);
        let turbulence = self.number();
        let by = self.one(&[GradientBy::Axis, GradientBy::Radius]);
        let kind = match self.below(9) {
            0 => TextureKind::Checker { colors, scale },
            1 => TextureKind::Grid { colors, scale, width: turbulence, axes: GridAxes::Xy },
            2 => TextureKind::Stripes { colors, scale, by, axis },
            3 => TextureKind::Noise { stops, scale, octaves, lacunarity, gain, seed },
            4 => TextureKind::Marble {
                stops,
                scale,
                axis,
                turbulence,
                octaves,
                lacunarity,
                gain,
                seed,
            },
            5 => TextureKind::Wood {
                stops,
                scale,
                axis,
                turbulence,
                octaves,
                lacunarity,
                gain,
                seed,
            },
            6 => {
                let by = self.one(&[CellsBy::Distance, CellsBy::Border, CellsBy::Cell]);
                TextureKind::Cells { stops, scale, by, seed }
            }
            7 => TextureKind::Map {
                of: "x".to_owned(),
                axis: self.flag().then_some(axis),
                range: MapRange::Between([-scale, turbulence]),
                stops,
                nan: self.color(),
                unit: self.flag().then(|| "K".to_owned()),
            },
            _ => {
                let from = self.number();
                TextureKind::Gradient { by, axis, from, to: from - self.number(), stops }
            }
        };
        Texture {
            name: format!("{} {number}", self.name()),
            kind,
            space: self.one(&[TextureSpace::Object, TextureSpace::World, TextureSpace::Uv]),
            transform: match self.below(4) {
                0 => DAffine3::from_translation(self.point()),
                1 => DAffine3::from_scale(DVec3::new(self.number(), -2.0, 1.0)),
                2 => DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z)),
                _ => DAffine3::IDENTITY,
            },
            place: Place::default(),
        }
    }

    /// The material with textures for some of its parameters, if there are any textures.
    fn textured(
        &mut self,
        material: phong_scene::Material,
        textures: usize,
    ) -> phong_scene::Material {
        let mut material = material;
        for what in 0..8 {
            if textures == 0 || self.flag() {
                continue;
            }
            let by = TextureRef {
                texture: TextureId(self.below(textures) as u32),
                scale: self.one(&[1.0, 0.5, 0.1]),
                offset: self.one(&[0.0, 0.25]),
                channel: self.one(&[None, Some(Channel::Red), Some(Channel::Blue)]),
            };
            match what {
                0 => material.color = by.into(),
                1 => material.k_a = by.into(),
                2 => material.reflection = by.into(),
                3 => material.emission_color = Some(by.into()),
                4 => material.k_e = by.into(),
                5 => material.normal = Some(by),
                6 => material.bump = Some(by),
                _ => material.ambient_color = Some(by.into()),
            }
        }
        material
    }

    fn material(&mut self, number: usize) -> Material {
        let model = self.model();
        let lobe = matches!(model, Model::Phong | Model::BlinnPhong | Model::BlinnFast);
        let glossy = !matches!(model, Model::Lambert | Model::OrenNayar { .. });
        // A material of three.js is read as facets, of which every test above holds some.
        let written = phong_scene::Material::from(Material { model, ..Material::default() }).model;
        let suits = |d: &Dialect| *d != Dialect::ThreeJs && d.allows(&written);
        let dialects: Vec<_> = Dialect::ALL.into_iter().filter(suits).collect();
        let dialect = self.one(&dialects);
        let preset = dialect.switches();
        let transmission = if self.flag() { Rgb::BLACK } else { self.color() };
        let mut shininess = Material::default().shininess;
        if let Model::Microfacet { distribution: Distribution::Blinn, roughness, .. } = model {
            shininess = roughness;
        } else if lobe {
            shininess = self.one(&[32.0, 0.0, 1e6, 12.345]);
        }
        Material {
            name: if number == 0 { "default".into() } else { format!("{} {number}", self.name()) },
            model,
            color: self.color(),
            vertex_colors: self.one(&[
                VertexColors::Replace,
                VertexColors::Multiply,
                VertexColors::Ignore,
            ]),
            ambient_color: if self.flag() { None } else { Some(self.color()) },
            specular_color: match self.below(3) {
                0 if glossy => None,
                1 if glossy => Some(self.color()),
                _ => Some(Rgb::WHITE),
            },
            k_a: self.float(),
            k_d: self.one(&[0.7, 0.1, 1.0]),
            k_s: if glossy { self.float() } else { 0.0 },
            k_e: self.one(&[0.0, 0.0, 1.0, 12.345]),
            emission_color: if self.flag() { None } else { Some(self.color()) },
            shininess,
            reflection: if self.flag() { Rgb::BLACK } else { self.color() },
            transmission,
            opacity: self.one(&[1.0, 1.0, 0.25]),
            opacity_mode: self.one(&[OpacityMode::Plain, OpacityMode::Angle, OpacityMode::Mask]),
            cutoff: self.one(&[0.5, 0.25]),
            normal: None,
            normal_format: self.one(&[NormalFormat::OpenGl, NormalFormat::DirectX]),
            bump: None,
            surfaces: self.one(&[None, Some(1), Some(12)]),
            shadow: self.one(&[None, Some(ShadowRule::Full), Some(ShadowRule::Filtered)]),
            ior: self.one(&[1.5, 1.0, 0.666_666_7]),
            priority: self.one(&[0, 0, 7]),
            fresnel: self.flag(),
            dialect,
            times_cosine: if lobe { self.flag() } else { preset.times_cosine },
            normalize: if lobe { self.flag() } else { preset.normalize },
            tint: if lobe {
                self.one(&[Tint::Light, Tint::Object, Tint::Metallic])
            } else {
                preset.tint
            },
            ambient_rule: self.one(&[AmbientRule::Once, AmbientRule::PerLight, AmbientRule::Both]),
            viewer: if lobe { self.one(&[Viewer::Local, Viewer::Distant]) } else { preset.viewer },
            place: Place::default(),
        }
    }

    fn objects(&mut self, materials: usize, groups: usize) -> Vec<Object> {
        (0..self.below(6)).map(|_| self.object(materials, groups)).collect()
    }

    fn object(&mut self, materials: usize, groups: usize) -> Object {
        let transform = match self.below(5) {
            0 => DAffine3::from_translation(self.point()),
            1 => DAffine3::from_scale(DVec3::new(self.number(), -2.0, 1.0)),
            2 => DAffine3 {
                matrix3: DMat3::from_cols(
                    DVec3::new(self.number(), 0.0, 0.1),
                    DVec3::new(0.25, 2.0, -0.0),
                    DVec3::new(0.0, self.number(), -3.0),
                ),
                translation: self.point(),
            },
            _ => DAffine3::IDENTITY,
        };
        Object {
            name: self.name(),
            shape: self.shape(groups),
            material: MaterialId(self.below(materials) as u32),
            transform,
            place: Place::default(),
        }
    }

    fn shape(&mut self, groups: usize) -> Shape {
        let center = self.point();
        let up = DVec3::new(0.25, self.number(), 0.0);
        let (radius, capped) = (self.number(), self.flag());
        match self.below(12) {
            0 => Shape::Sphere { center, radius },
            1 => Shape::Plane { point: center, normal: up },
            2 => Shape::Triangle {
                points: [center, center + DVec3::X, center + up],
                normals: self.flag().then_some([up, DVec3::X, DVec3::Z]),
                uv: self.flag().then_some([DVec2::ZERO, DVec2::new(0.1, -7.5), DVec2::Y]),
            },
            3 => Shape::Disc { center, normal: up, radius },
            4 => Shape::Box { min: center, max: center + DVec3::ONE },
            5 => Shape::Cylinder { from: center, to: center + up, radius, capped },
            6 => Shape::Cone {
                from: center,
                to: center + up,
                radius,
                radius_to: self.one(&[0.0, 2.5]),
                capped,
            },
            7 => Shape::Torus { center, axis: up, radius, tube: 0.5 * radius },
            8 => Shape::Mesh(Box::new(self.mesh())),
            9 => Shape::Points(Box::new(self.points())),
            10 => self.cylinders().into(),
            _ if groups > 0 => Shape::Instance(GroupId(self.below(groups) as u32)),
            _ => Shape::Sphere { center, radius: 1.0 },
        }
    }

    fn origin(&mut self) -> DVec3 {
        self.one(&[DVec3::ZERO, DVec3::ZERO, DVec3::new(4_000_032.0, 0.0, -64.0)])
    }

    fn mesh(&mut self) -> Mesh {
        let count = 4 + self.below(9);
        let triangles = 1 + self.below(12);
        let mut three = |n: usize| {
            let first = self.below(n);
            [first, first + 1, first + 2].map(|i| (i % n) as u32)
        };
        let mut mesh = Mesh {
            indices: (0..triangles).map(|_| three(count)).collect(),
            normal_indices: (0..triangles).map(|_| three(3)).collect(),
            uv_indices: (0..triangles).map(|_| three(4)).collect(),
            ..Mesh::default()
        };
        mesh.origin = self.origin();
        mesh.positions = (0..count).map(|_| self.point().as_vec3()).collect();
        match self.below(3) {
            0 => mesh.normal_indices.clear(),
            1 => {
                mesh.normals = (0..count).map(|i| Vec3::new(i as f32, 1.0, 0.0)).collect();
                mesh.normal_indices.clear();
            }
            _ => {
                mesh.normals = [Vec3::X, Vec3::new(0.1, 0.2, 0.3), -Vec3::Y].into();
                mesh.normal_indices[0][1] = NO_INDEX;
            }
        }
        if self.flag() {
            mesh.uvs = (0..4).map(|i| Vec2::new(i as f32, 0.1)).collect();
        } else {
            mesh.uv_indices.clear();
        }
        if self.flag() {
            mesh.colors = (0..count).map(|_| self.color()).collect();
        }
        mesh
    }

    fn points(&mut self) -> Points {
        let count = 1 + self.below(9);
        let mut points = Points { origin: self.origin(), ..Points::default() };
        for _ in 0..count {
            let [x, y, z] = self.point().as_vec3().to_array();
            points.spheres.push([x, y, z, self.float()]);
        }
        if self.flag() {
            points.colors = (0..count).map(|_| self.color()).collect();
        }
        points
    }

    fn cylinders(&mut self) -> Cylinders {
        let count = 1 + self.below(9);
        let caps = self.one(&[Caps::Round, Caps::Flat, Caps::Open]);
        let mut cylinders = Cylinders { origin: self.origin(), caps, ..Cylinders::default() };
        let one_radius = self.flag();
        for i in 0..count {
            let [x, y, z] = self.point().as_vec3().to_array();
            let (radius, other) = (self.float(), self.float());
            // Some share an end.
            let from = [x, y, z, radius];
            let from =
                cylinders.segments.last().filter(|_| i % 3 == 1).map_or(from, |last| last[0]);
            let radius_to = if one_radius { from[3] } else { other };
            cylinders.segments.push([from, [from[0] + 1.0, from[1], from[2] - 0.5, radius_to]]);
        }
        if self.flag() {
            cylinders.colors = (0..count).map(|_| [self.color(), self.color()]).collect();
        }
        cylinders
    }
}
