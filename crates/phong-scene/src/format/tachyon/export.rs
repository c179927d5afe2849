//! A scene as a Tachyon file: every z is negated, as it is when such files are read.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, Write};

use glam::{DAffine3, DVec2, DVec3};

use super::camera::LENS;
use crate::camera::CameraKind;
use crate::color::Rgb;
use crate::diagnostic::Diagnostic;
use crate::fog::{FogDistance, FogKind};
use crate::format::export::flat::{listed, say_fields, say_unfolded, warning};
use crate::format::export::merge::{Size, each_placed};
use crate::format::export::{Account, File, Writing};
use crate::light::LightKind;
use crate::material::{ConstantMaterial, Distribution, Model, Tint};
use crate::mesh::{Caps, Mesh};
use crate::scene::{Background, Object, Scene};
use crate::shape::Shape;
use crate::transform::{cofactor, even_scale};

/// The scene as one Tachyon file.
pub(crate) fn write_tachyon(
    scene: Scene,
    options: &Writing,
    name: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    Size::of(&scene).check(options.max_bytes)?;
    say_unfolded(&scene, account);
    say_fields(&scene, account);
    let head = head(&scene, account);
    let surfaces = surfaces(&scene, account);
    leave_out(&scene, account);
    Ok(vec![File::new(name, move |to| {
        to.write_all(head.as_bytes())?;
        let mut result = Ok(());
        each_placed(&scene.objects, &scene.groups, DAffine3::IDENTITY, "", &mut |object, at, _| {
            if result.is_ok() {
                result = write_object(object, at, &surfaces, to);
            }
        });
        result?;
        to.write_all(b"END_SCENE\n")
    })])
}

/// A place or direction with z negated.
fn vector(v: DVec3) -> String {
    format!("{} {} {}", v.x as f32, v.y as f32, -v.z as f32)
}

fn color(Rgb { r, g, b }: Rgb) -> String {
    format!("{r} {g} {b}")
}

fn mean(Rgb { r, g, b }: Rgb) -> f32 {
    (r + g + b) / 3.0
}

/// What stands before the shapes: the size of the picture, camera, background and lights.
fn head(scene: &Scene, account: &mut Account) -> String {
    // Writing to a string does not fail.
    let mut text = String::new();
    let [width, height] = scene.image.size;
    let _ = writeln!(text, "BEGIN_SCENE\nRESOLUTION {width} {height}\nCAMERA");
    let camera = &scene.camera;
    let view = (camera.look_at - camera.eye).normalize_or(DVec3::NEG_Z);
    let tan = |fov: f64| libm::tan(0.5 * fov.to_radians());
    let focus = camera.focus.unwrap_or_else(|| camera.eye.distance(camera.look_at));
    let lens = camera.aperture > 0.0;
    let (projection, zoom) = match camera.kind {
        CameraKind::Perspective { fov } if lens => ("PERSPECTIVE_DOF", 0.5 / tan(fov)),
        CameraKind::Perspective { fov } => ("PERSPECTIVE", 0.5 / tan(fov)),
        CameraKind::Orthographic { height } => ("ORTHOGRAPHIC", 1.0 / height),
        CameraKind::Fisheye { fov } => {
            account.map("the fisheye is Tachyon's, which is not quite equidistant".to_owned());
            ("FISHEYE", 1.0 / fov.to_radians())
        }
        CameraKind::Panorama => {
            let message = "Tachyon holds no panorama; the view is in perspective".to_owned();
            account.drop(Diagnostic::warning(message, None));
            ("PERSPECTIVE", 0.5)
        }
    };
    if camera.shift != DVec2::ZERO {
        let message = "Tachyon's pictures are not shifted in their plane".to_owned();
        account.drop(Diagnostic::warning(message, None));
    }
    let _ = writeln!(text, "PROJECTION {projection}");
    if lens && projection == "PERSPECTIVE_DOF" {
        let aperture = camera.aperture * zoom / (LENS * focus);
        let _ = writeln!(text, "FOCALLENGTH {focus}\nAPERTURE {aperture}");
    }
    let _ = writeln!(text, "ZOOM {zoom}\nASPECTRATIO 1");
    let (more, depth) = (scene.image.samples - 1, scene.image.depth.saturating_add(1));
    let _ = writeln!(text, "ANTIALIASING {more}\nRAYDEPTH {depth}");
    let _ = writeln!(text, "CENTER {}\nVIEWDIR {}", vector(camera.eye), vector(view));
    let up = camera.up.normalize_or(DVec3::Y);
    let _ = writeln!(text, "UPDIR {}\nEND_CAMERA", vector(up));
    match scene.image.background {
        Background::Color(back) => {
            let _ = writeln!(text, "BACKGROUND {}", color(back));
        }
        Background::Gradient { top, bottom } => {
            let up = vector(up);
            let _ = writeln!(
                text,
                "BACKGROUND_GRADIENT SKY_ORTHO_PLANE UPDIR {up} TOPVAL 1 BOTTOMVAL -1 TOPCOLOR {} BOTTOMCOLOR {}",
                color(top),
                color(bottom)
            );
        }
        Background::Transparent => {
            let message = "Tachyon holds no transparent background; it is black".to_owned();
            account.drop(Diagnostic::warning(message, None));
        }
    }
    if let Some(fog) = &scene.fog {
        let back = match scene.image.background {
            Background::Color(back) => back,
            Background::Gradient { top, bottom } => (top + bottom) * 0.5,
            Background::Transparent => Rgb::BLACK,
        };
        let back = color(fog.color.unwrap_or(back));
        let (kind, start, end, density) = match fog.kind {
            FogKind::Linear { start, end } => ("LINEAR", start, end, 1.0),
            FogKind::Exponential { density } => ("EXP", 0.0, 1.0, density),
            FogKind::Squared { density } => ("EXP2", 0.0, 1.0, density),
        };
        let _ = writeln!(text, "FOG {kind} START {start} END {end} DENSITY {density} COLOR {back}");
        if fog.distance != FogDistance::Radial || fog.strength < 1.0 {
            let message = "Tachyon's fog goes by the distance from the eye, and up to the whole";
            account.drop(Diagnostic::warning(message.to_owned(), None));
        }
    }
    if scene.sky.is_some() {
        let message = "Tachyon holds no sky: `[sky]` is not written";
        account.drop(Diagnostic::warning(message.to_owned(), None));
    }
    if !scene.furniture.is_empty() {
        let message = "Tachyon holds no title, scale bar, axes, legend or labels";
        account.drop(Diagnostic::warning(message, None));
    }
    if scene.outline.is_some() {
        let message = "Tachyon's outlines are of materials: `[outline]` is not written";
        account.drop(Diagnostic::warning(message.to_owned(), None));
    }
    if scene.image.cel.is_some() {
        let message = "Tachyon holds no steps of luminance: `cel` is not written";
        account.drop(Diagnostic::warning(message.to_owned(), None));
    }
    if scene.tone.is_some() {
        let message = "Tachyon holds no exposure, white balance or curve: `[tone]` is not written";
        account.drop(Diagnostic::warning(message.to_owned(), None));
    }
    if !scene.clips.is_empty() {
        let message = "Tachyon's clips are not written: what `[[clip]]` cuts away is there";
        account.drop(Diagnostic::warning(message.to_owned(), None));
    }
    if scene.ambient_occlusion.is_some() {
        let message =
            "ambient occlusion is not written: the ambient light is, without it".to_owned();
        account.drop(Diagnostic::warning(message, None));
    }
    lights(scene, &mut text, account);
    text
}

fn lights(scene: &Scene, text: &mut String, account: &mut Account) {
    let far = |attenuation: [f64; 3]| match attenuation {
        [c, l, q] if [c, l, q] == [1.0, 0.0, 0.0] => String::new(),
        [c, l, q] => format!(" ATTENUATION CONSTANT {c} LINEAR {l} QUADRATIC {q}"),
    };
    for light in &scene.lights {
        let shine = color(light.color);
        let _ = match light.kind {
            LightKind::Mesh { .. } => {
                let message = format!("{}: Tachyon holds no mesh that shines", light.name);
                account.drop(Diagnostic::warning(message, None));
                continue;
            }
            LightKind::Distant { direction, .. } => {
                let way = vector(direction.normalize_or(DVec3::NEG_Z));
                writeln!(text, "DIRECTIONAL_LIGHT DIRECTION {way} COLOR {shine}")
            }
            LightKind::Point { position, attenuation, .. }
            | LightKind::Sphere { position, attenuation, .. } => {
                let (at, far) = (vector(position), far(attenuation));
                writeln!(text, "LIGHT CENTER {at} RAD 0.001{far} COLOR {shine}")
            }
            LightKind::Spot { position, target, cone, edge, attenuation, .. } => {
                let way = vector((target - position).normalize_or(DVec3::NEG_Y));
                let (at, far) = (vector(position), far(attenuation));
                writeln!(
                    text,
                    "SPOTLIGHT CENTER {at} RAD 0.001 DIRECTION {way} FALLOFF_START {cone} FALLOFF_END {edge}{far} COLOR {shine}"
                )
            }
            LightKind::Rectangle { position, direction, attenuation, .. }
            | LightKind::Disc { position, direction, attenuation, .. } => {
                let way = vector(direction.normalize_or(DVec3::NEG_Y));
                let (at, far) = (vector(position), far(attenuation));
                writeln!(
                    text,
                    "SPOTLIGHT CENTER {at} RAD 0.001 DIRECTION {way} FALLOFF_START 89.9 FALLOFF_END 90{far} COLOR {shine}"
                )
            }
        };
        let lost = [
            (light.kind.extent() > 0.0, "a soft light's extent"),
            (light.kind.has_surface() && light.visible, "a light that is seen"),
            (light.range.is_some(), "where a light ends (`range`)"),
            (!light.shadows, "a light without shadows"),
            (light.specular_color != light.color, "another colour for highlights"),
        ];
        for (_, lost) in lost.into_iter().filter(|(is_lost, _)| *is_lost) {
            let message = format!("{}: Tachyon does not hold {lost}", light.name);
            account.drop(warning(message, &light.place));
        }
    }
    account.carry("light", scene.lights.len());
}

/// A material as Tachyon's words: what stands before the colour, and the colour.
struct Surface {
    words: String,
    color: Rgb,
}

impl Surface {
    fn of(&self, own: Option<Rgb>) -> String {
        format!("TEXTURE {} COLOR {} TEXFUNC 0", self.words, color(own.unwrap_or(self.color)))
    }
}

fn surfaces(scene: &Scene, account: &mut Account) -> Vec<Surface> {
    let mut phong = false;
    let mut surfaces = Vec::new();
    for material in &scene.materials {
        for (key, _) in material.textured() {
            let message = format!(
                "material `{}`: the texture of `{key}`, for which 0.5 stands",
                material.name
            );
            account.drop(warning(message, &material.place));
        }
        let m = material.at(|_| Rgb::grey(0.5));
        let exponent = exponent(&m, account);
        phong |= m.model == Model::Phong && m.k_s > 0.0;
        let metal = m.tint == Tint::Object || m.specular_color.is_none();
        let kind = if metal { "METAL" } else { "PLASTIC" };
        let tint = if metal { 1.0 } else { mean(m.specular_color.unwrap_or(Rgb::WHITE)) };
        let ambient = m.k_a * mean(scene.ambient);
        let opacity = (1.0 - mean(m.transmission)).clamp(0.0, 1.0);
        let mirror = mean(m.reflection);
        let highlight = if exponent.is_some() { m.k_s * tint } else { 0.0 };
        let words = format!(
            "AMBIENT {ambient} DIFFUSE {} SPECULAR {mirror} OPACITY {opacity} PHONG {kind} {highlight} PHONG_SIZE {}",
            m.k_d,
            exponent.unwrap_or(100.0)
        );
        surfaces.push(Surface { words, color: m.color });
        if m.k_e > 0.0 {
            let message = format!("material `{}`: Tachyon holds no light of its own", m.name);
            account.drop(warning(message, &m.place));
        }
        if opacity < 1.0 && m.ior != 1.0 {
            let how = format!("material `{}`: rays go straight on, and are not refracted", m.name);
            account.map(how);
        }
    }
    if phong {
        account.map(
            "the lobe (R·E)^n is Tachyon's with `-shade_phong`; without, it is (N·H)^n".to_owned(),
        );
    }
    surfaces
}

/// The exponent of the highlight; `None`: there is none.
fn exponent(m: &ConstantMaterial, account: &mut Account) -> Option<f32> {
    let of = |square: f32| (2.0 / square - 2.0).max(0.0);
    let exponent = match m.model {
        Model::Phong | Model::BlinnPhong | Model::BlinnFast => return Some(m.shininess),
        Model::Microfacet { distribution: Distribution::Blinn, roughness, .. } => roughness,
        Model::Microfacet { roughness, .. } => of(roughness * roughness),
        Model::Ward { roughness_x, roughness_y, .. } => of(roughness_x * roughness_y),
        Model::Lambert | Model::OrenNayar { .. } => return None,
    };
    if m.k_s > 0.0 {
        account.map(format!("material `{}`: (N·H)^n with n = 2/α² − 2 = {exponent}", m.name));
    }
    Some(exponent)
}

/// Says which shapes are not there.
fn leave_out(scene: &Scene, account: &mut Account) {
    let mut lost: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    each_placed(&scene.objects, &scene.groups, DAffine3::IDENTITY, "", &mut |object, at, name| {
        let even = even_scale(at.matrix3).is_some();
        let what = match &object.shape {
            Shape::Sphere { .. } | Shape::Points(_) if !even => "ellipsoids",
            Shape::Cylinder { .. } | Shape::Cylinders(_) | Shape::Disc { .. } if !even => {
                "cylinders and discs that are scaled unevenly"
            }
            Shape::Cone { .. } => "cones",
            Shape::Torus { .. } => "tori",
            shape => {
                let count = match shape {
                    Shape::Points(points) => points.spheres.len(),
                    Shape::Mesh(mesh) => mesh.indices.len(),
                    Shape::Cylinders(cylinders) => cylinders.segments.len(),
                    _ => 1,
                };
                let kind = match shape {
                    Shape::Points(_) => "sphere",
                    Shape::Mesh(_) => "triangle",
                    shape => shape.kind(),
                };
                account.carry(kind, count);
                return;
            }
        };
        lost.entry(what).or_default().push(name);
    });
    for (what, names) in lost {
        let names = listed(names.iter().map(String::as_str), names.len());
        let message = format!("Tachyon holds no {what}: {names}");
        account.drop(Diagnostic::warning(message, None));
    }
    let uneven = scene.all_objects().map(|object| match &object.shape {
        Shape::Cylinders(all) => all.segments.iter().filter(|[a, b]| a[3] != b[3]).count(),
        _ => 0,
    });
    let uneven: usize = uneven.sum();
    if uneven > 0 {
        let message = format!(
            "Tachyon's cylinders have one radius: {uneven} of two are written with their mean"
        );
        account.drop(Diagnostic::warning(message, None));
    }
}

fn write_object(
    object: &Object,
    at: DAffine3,
    surfaces: &[Surface],
    to: &mut dyn Write,
) -> io::Result<()> {
    let plain = Surface { words: String::new(), color: Rgb::WHITE };
    let of = |number: u32| surfaces.get(number as usize).unwrap_or(&plain);
    let surface = of(object.material.0);
    let texture = surface.of(None);
    let place = |p: DVec3| vector(at.transform_point3(p));
    let turned = |n: DVec3| vector((cofactor(at.matrix3) * n).normalize_or(DVec3::Y));
    let scale = even_scale(at.matrix3);
    let wide = |[x, y, z, radius]: [f32; 4]| {
        (DVec3::new(x.into(), y.into(), z.into()), f64::from(radius) * scale.unwrap_or(1.0))
    };
    match &object.shape {
        Shape::Sphere { center, radius } if scale.is_some() => {
            let radius = radius * scale.unwrap_or(1.0);
            writeln!(to, "SPHERE CENTER {} RAD {} {texture}", place(*center), radius as f32)
        }
        Shape::Points(points) if scale.is_some() => {
            for (i, sphere) in points.spheres.iter().enumerate() {
                let (center, radius) = wide(*sphere);
                let texture = surface.of(points.colors.get(i).copied());
                let center = place(points.origin + center);
                writeln!(to, "SPHERE CENTER {center} RAD {} {texture}", radius as f32)?;
            }
            Ok(())
        }
        Shape::Cylinders(cylinders) if scale.is_some() => {
            for (i, ends) in cylinders.segments.iter().enumerate() {
                let [(a, radius), (b, other)] = ends.map(wide);
                let own = cylinders.colors.get(i);
                let [a, b] = [a, b].map(|p| cylinders.origin + p);
                let middle = 0.5 * (a + b);
                let radius = (0.5 * (radius + other)) as f32;
                // A half of each colour, if the ends differ.
                let halves = match own {
                    Some([first, last]) if first != last => {
                        vec![(a, middle, Some(*first)), (middle, b, Some(*last))]
                    }
                    Some([first, _]) => vec![(a, b, Some(*first))],
                    None => vec![(a, b, None)],
                };
                for (from, end, own) in halves {
                    let (from, end, texture) = (place(from), place(end), surface.of(own));
                    writeln!(to, "FCYLINDER BASE {from} APEX {end} RAD {radius} {texture}")?;
                }
                for (end, own) in [(a, own.map(|c| c[0])), (b, own.map(|c| c[1]))] {
                    let texture = surface.of(own);
                    match cylinders.caps {
                        Caps::Round => {
                            writeln!(to, "SPHERE CENTER {} RAD {radius} {texture}", place(end))?;
                        }
                        Caps::Flat => writeln!(
                            to,
                            "RING CENTER {} NORMAL {} INNER 0 OUTER {radius} {texture}",
                            place(end),
                            turned(b - a)
                        )?,
                        Caps::Open => {}
                    }
                }
            }
            Ok(())
        }
        Shape::Plane { point, normal } => {
            writeln!(to, "PLANE CENTER {} NORMAL {} {texture}", place(*point), turned(*normal))
        }
        Shape::Disc { center, normal, radius } if scale.is_some() => {
            let (center, normal) = (place(*center), turned(*normal));
            let radius = (radius * scale.unwrap_or(1.0)) as f32;
            writeln!(to, "RING CENTER {center} NORMAL {normal} INNER 0 OUTER {radius} {texture}")
        }
        Shape::Cylinder { from, to: end, radius, capped } if scale.is_some() => {
            let radius = (radius * scale.unwrap_or(1.0)) as f32;
            let (base, apex) = (place(*from), place(*end));
            writeln!(to, "FCYLINDER BASE {base} APEX {apex} RAD {radius} {texture}")?;
            let normal = turned(*end - *from);
            for end in [base, apex].iter().filter(|_| *capped) {
                writeln!(to, "RING CENTER {end} NORMAL {normal} INNER 0 OUTER {radius} {texture}")?;
            }
            Ok(())
        }
        Shape::Box { min, max } => {
            let corner = |i: usize| {
                let pick =
                    |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
                place(DVec3::new(
                    pick(0, min.x, max.x),
                    pick(1, min.y, max.y),
                    pick(2, min.z, max.z),
                ))
            };
            for [a, b, c, d] in
                [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
            {
                for [a, b, c] in [[a, b, c], [a, c, d]] {
                    let [a, b, c] = [a, b, c].map(corner);
                    writeln!(to, "TRI V0 {a} V1 {b} V2 {c} {texture}")?;
                }
            }
            Ok(())
        }
        Shape::Triangle { points, normals, .. } => {
            let [a, b, c] = points.map(place);
            match normals {
                Some(normals) => {
                    let [n0, n1, n2] = normals.map(turned);
                    writeln!(to, "STRI V0 {a} V1 {b} V2 {c} N0 {n0} N1 {n1} N2 {n2} {texture}")
                }
                None => writeln!(to, "TRI V0 {a} V1 {b} V2 {c} {texture}"),
            }
        }
        Shape::Mesh(mesh) => write_mesh(mesh, at, &of, surface, to),
        _ => Ok(()),
    }
}

fn write_mesh<'s>(
    mesh: &Mesh,
    at: DAffine3,
    of: &dyn Fn(u32) -> &'s Surface,
    own: &Surface,
    to: &mut dyn Write,
) -> io::Result<()> {
    let turn = cofactor(at.matrix3);
    for (face, corners) in mesh.indices.iter().enumerate() {
        let surface = mesh.face_materials.get(face).map_or(own, |number| of(*number));
        let place = |i: u32| {
            let own = mesh.positions.get(i as usize).copied().unwrap_or_default();
            at.transform_point3(mesh.origin + own.as_dvec3())
        };
        let places = corners.map(place);
        let [a, b, c] = places.map(vector);
        let numbers =
            if mesh.normal_indices.is_empty() { corners } else { &mesh.normal_indices[face] };
        let normal = |i: u32| mesh.normals.get(i as usize).map(|n| turn * n.as_dvec3());
        let normals = numbers.map(normal);
        let colored = corners.map(|i| mesh.colors.get(i as usize).copied());
        if normals.iter().all(Option::is_none) && colored.iter().all(Option::is_none) {
            writeln!(to, "TRI V0 {a} V1 {b} V2 {c} {}", surface.of(None))?;
            continue;
        }
        let flat = (places[1] - places[0]).cross(places[2] - places[0]);
        let unit = |n: Option<DVec3>| vector(n.unwrap_or(flat).normalize_or(DVec3::Y));
        let [n0, n1, n2] = normals.map(unit);
        let normals = format!("N0 {n0} N1 {n1} N2 {n2}");
        if let [Some(c0), Some(c1), Some(c2)] = colored {
            let [c0, c1, c2] = [c0, c1, c2].map(color);
            let words = &surface.words;
            writeln!(
                to,
                "VCSTRI V0 {a} V1 {b} V2 {c} {normals} C0 {c0} C1 {c1} C2 {c2} {words} VCST"
            )?;
        } else {
            writeln!(to, "STRI V0 {a} V1 {b} V2 {c} {normals} {}", surface.of(None))?;
        }
    }
    Ok(())
}
