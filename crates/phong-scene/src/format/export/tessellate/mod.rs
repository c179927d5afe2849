//! Triangles in place of round shapes and boxes, within a tolerance.
//!
//! Every corner lies on the shape, and no point of a triangle is farther from it than the tolerance. Where
//! a shape is closed, its triangles are too: neighbours share corners at the very same place.

mod ball;
mod count;
mod profile;
mod turned;

use std::collections::BTreeMap;

use glam::{DMat3, DVec3, Vec3};

use self::ball::Balls;
use self::count::Size;
use self::profile::Profile;
use self::turned::Turned;
use super::Account;
use super::flat::{listed, warning};
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Span};
use crate::format::origin::origin_of;
use crate::mesh::{Caps, Cylinders, Mesh};
use crate::scene::{Object, Scene};
use crate::shape::Shape;
use crate::texture::TextureSpace;
use crate::transform::even_scale;

/// The share of a shape's extent that single precision surely holds.
const DIGITS: f64 = 2e-7;

/// Puts triangles in the place of every shape that has an extent, and says so. Planes stay.
///
/// # Errors
/// If the tolerance is not above 0, or the triangles take more than `most` bytes of memory.
pub(crate) fn tessellate(
    scene: &mut Scene,
    tolerance: f64,
    most: u64,
    account: &mut Account,
) -> Result<(), Box<Diagnostic>> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        let message = format!("a tolerance is a number above 0, and not {tolerance}");
        return Err(Box::new(Diagnostic::error(message, None)));
    }
    let scales = group_scales(scene);
    let mut size = Size::default();
    let mut told: BTreeMap<&'static str, [u64; 2]> = BTreeMap::new();
    for (objects, scale) in each_list(scene, &scales) {
        for object in objects {
            let within = tolerance / (scale * reach(object.transform.matrix3));
            let Some((count, own)) = size_of(object, within) else { continue };
            let extent = extent(&object.shape);
            if within < DIGITS * extent {
                let message = format!(
                    "a tolerance of {tolerance} is finer than numbers of single precision hold of {}: \
                     {} at least",
                    object.name,
                    tolerance * DIGITS * extent / within
                );
                let span = Span { place: object.place.clone(), ..Span::default() };
                return Err(Box::new(Diagnostic::error(message, span)));
            }
            size = size.and(own);
            let [before, after] = told.entry(object.shape.kind()).or_default();
            *before += count;
            *after = after.saturating_add(own.triangles);
        }
    }
    if size.bytes() > most || size.vertices.max(size.triangles) >= u64::from(u32::MAX) {
        let Size { triangles, vertices } = size;
        let message = format!(
            "within {tolerance} there would be {triangles} triangles of {vertices} corners, which take {} \
             bytes of memory; {most} are allowed",
            size.bytes()
        );
        let help = "a larger tolerance needs fewer: a tenth as many if it is ten times as large";
        return Err(Box::new(Diagnostic::error(message, None).with_help(help)));
    }
    say_uv(scene, account);
    for (kind, [before, after]) in told {
        account.map(format!(
            "{} {after} triangles, nowhere farther than {tolerance} from the surface",
            become_of(kind, before)
        ));
    }
    let mut balls = Balls::default();
    let mut replace = |objects: &mut Vec<Object>, scale: f64| {
        for object in objects {
            let within = tolerance / (scale * reach(object.transform.matrix3));
            if let Some(mesh) = mesh(&object.shape, within, &mut balls) {
                object.shape = mesh.into();
            }
        }
    };
    replace(&mut scene.objects, 1.0);
    for (group, scale) in scene.groups.iter_mut().zip(scales) {
        replace(&mut group.objects, scale);
    }
    Ok(())
}

/// The objects of the scene and of its groups, each list with the largest scale that it is placed by.
fn each_list<'s>(
    scene: &'s Scene,
    scales: &'s [f64],
) -> impl Iterator<Item = (&'s Vec<Object>, &'s f64)> {
    let groups = scene.groups.iter().map(|group| &group.objects).zip(scales);
    std::iter::once((&scene.objects, &1.0)).chain(groups)
}

/// The largest scale that each group is placed by, by all ways that lead to it.
fn group_scales(scene: &Scene) -> Vec<f64> {
    let mut scales = vec![0.0_f64; scene.groups.len()];
    let place = |objects: &[Object], scale: f64, scales: &mut Vec<f64>| {
        for object in objects {
            if let Shape::Instance(group) = object.shape
                && let Some(largest) = scales.get_mut(group.0 as usize)
            {
                *largest = largest.max(scale * reach(object.transform.matrix3));
            }
        }
    };
    place(&scene.objects, 1.0, &mut scales);
    // A group holds instances of earlier ones only.
    for (i, group) in scene.groups.iter().enumerate().rev() {
        let scale = scales[i];
        place(&group.objects, scale, &mut scales);
    }
    // A group that nothing places is written as it is.
    scales.into_iter().map(|scale| if scale > 0.0 { scale } else { 1.0 }).collect()
}

/// The most that a placement stretches anything, or somewhat more.
fn reach(matrix: DMat3) -> f64 {
    even_scale(matrix).unwrap_or_else(|| {
        let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
        axes.iter().map(|axis| axis.length_squared()).sum::<f64>().sqrt()
    })
}

/// How many shapes the object is, and what becomes of them; `None`: nothing does.
fn size_of(object: &Object, within: f64) -> Option<(u64, Size)> {
    match &object.shape {
        Shape::Points(points) => {
            let sizes = points.spheres.iter().map(|sphere| ball::size(sphere[3].into(), within));
            Some((points.spheres.len() as u64, sizes.fold(Size::default(), Size::and)))
        }
        Shape::Cylinders(all) => {
            let size = |i: usize| segment(all, i, within).size();
            let sizes = (0..all.segments.len()).map(size);
            Some((all.segments.len() as u64, sizes.fold(Size::default(), Size::and)))
        }
        Shape::Sphere { radius, .. } => Some((1, ball::size(*radius, within))),
        Shape::Box { .. } => Some((1, Size { vertices: 8, triangles: 12 })),
        shape => profile_of(shape, within).map(|(profile, ..)| (1, profile.size())),
    }
}

/// How far the shape's corners are at most from the origin of their numbers, or a little more.
fn extent(shape: &Shape) -> f64 {
    let of = |all: &[[f32; 4]]| {
        let most = all.as_flattened().iter().fold(0.0_f32, |most, n| most.max(n.abs()));
        2.0 * f64::from(most)
    };
    match *shape {
        Shape::Points(ref points) => of(&points.spheres),
        Shape::Cylinders(ref cylinders) => of(cylinders.segments.as_flattened()),
        Shape::Sphere { radius, .. } | Shape::Disc { radius, .. } => radius,
        Shape::Cylinder { from, to, radius, .. } => from.distance(to).max(radius),
        Shape::Cone { from, to, radius, radius_to, .. } => {
            from.distance(to).max(radius).max(radius_to)
        }
        Shape::Torus { radius, tube, .. } => radius + tube,
        _ => 0.0,
    }
}

/// The shape as triangles; `None`: it stays as it is.
fn mesh(shape: &Shape, within: f64, balls: &mut Balls) -> Option<Mesh> {
    match shape {
        Shape::Sphere { center, radius } => {
            let mut out = Turned::default();
            balls.add(DVec3::ZERO, *radius, within, None, &mut out);
            Some(out.mesh(*center))
        }
        Shape::Points(points) => {
            let mut out = Turned::default();
            for (i, &[x, y, z, radius]) in points.spheres.iter().enumerate() {
                let center = Vec3::new(x, y, z).as_dvec3();
                balls.add(center, radius.into(), within, points.colors.get(i).copied(), &mut out);
            }
            Some(out.mesh(points.origin))
        }
        Shape::Cylinders(cylinders) => {
            let mut out = Turned::default();
            for (i, ends) in cylinders.segments.iter().enumerate() {
                let [from, to] = ends.map(|[x, y, z, _]| Vec3::new(x, y, z).as_dvec3());
                out.turn(&segment(cylinders, i, within), from, to - from);
            }
            Some(out.mesh(cylinders.origin))
        }
        Shape::Box { min, max } => Some(cuboid(*min, *max)),
        shape => {
            let (profile, origin, axis) = profile_of(shape, within)?;
            let mut out = Turned::default();
            out.turn(&profile, DVec3::ZERO, axis);
            Some(out.mesh(origin))
        }
    }
}

/// What a solid is the turned shape of: where it begins, and along which axis.
fn profile_of(shape: &Shape, within: f64) -> Option<(Profile, DVec3, DVec3)> {
    Some(match *shape {
        Shape::Disc { center, normal, radius } => (Profile::disc(radius, within), center, normal),
        Shape::Cylinder { from, to, radius, capped } => {
            let length = from.distance(to);
            let ends = if capped { Caps::Flat } else { Caps::Open };
            (Profile::straight([radius; 2], length, ends, None, within), from, to - from)
        }
        Shape::Cone { from, to, radius, radius_to, capped } => {
            let length = from.distance(to);
            let ends = if capped { Caps::Flat } else { Caps::Open };
            let radii = [radius, radius_to];
            (Profile::straight(radii, length, ends, None, within), from, to - from)
        }
        Shape::Torus { center, axis, radius, tube } => {
            (Profile::torus(radius, tube, within), center, axis)
        }
        _ => return None,
    })
}

/// The profile of one of many cylinders.
fn segment(all: &Cylinders, i: usize, within: f64) -> Profile {
    let [a, b] = all.segments[i];
    let end = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z).as_dvec3();
    let (radii, length) = ([f64::from(a[3]), b[3].into()], end(a).distance(end(b)));
    let colors: Option<[Rgb; 2]> = all.colors.get(i).copied();
    match all.caps {
        Caps::Round => Profile::capsule(radii, length, colors, within),
        caps => Profile::straight(radii, length, caps, colors, within),
    }
}

/// The twelve triangles of a box.
fn cuboid(min: DVec3, max: DVec3) -> Mesh {
    let origin = origin_of([min, max]);
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
        (DVec3::new(pick(0), pick(1), pick(2)) - origin).as_vec3()
    };
    let mut mesh = Mesh { origin, positions: (0..8).map(corner).collect(), ..Mesh::default() };
    let mut indices = Vec::new();
    let mut normals = Vec::new();
    let mut normal_indices = Vec::new();
    // Counter-clockwise seen from outside: of the low and the high face across each axis.
    let faces =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    for (number, [a, b, c, d]) in (0..).zip(faces) {
        let side = if number % 2 == 0 { -1.0 } else { 1.0 };
        normals.push(Vec3::AXES[number as usize / 2] * side);
        indices.extend([[a, b, c], [a, c, d]]);
        normal_indices.extend([[number; 3]; 2]);
    }
    (mesh.indices, mesh.normals) = (indices.into(), normals.into());
    mesh.normal_indices = normal_indices.into();
    mesh
}

/// Says whose texture coordinates are lost: triangles get none.
fn say_uv(scene: &Scene, account: &mut Account) {
    let on_surface = |object: &&Object| {
        let material = scene.materials.get(object.material.0 as usize);
        let solid = size_of(object, f64::INFINITY).is_some();
        solid
            && material.is_some_and(|material| {
                material.textured().iter().any(|(_, by)| {
                    let texture = scene.textures.get(by.texture.0 as usize);
                    texture.is_some_and(|texture| texture.space == TextureSpace::Uv)
                })
            })
    };
    let lost: Vec<&Object> = scene.all_objects().filter(on_surface).collect();
    if let [first, ..] = &lost[..] {
        let names = listed(lost.iter().map(|object| object.name.as_str()), lost.len());
        let message = format!("triangles get no texture coordinates: {names}");
        account.drop(warning(message, &first.place));
    }
}

/// `1 torus becomes`, `3 boxes become`.
fn become_of(kind: &str, count: u64) -> String {
    let (one, many) = match kind {
        "points" => ("sphere", "spheres"),
        "cylinders" => ("cylinder", "cylinders"),
        "sphere" => ("single sphere", "single spheres"),
        "cylinder" => ("single cylinder", "single cylinders"),
        "box" => ("box", "boxes"),
        "torus" => ("torus", "tori"),
        "disc" => ("disc", "discs"),
        _ => ("cone", "cones"),
    };
    if count == 1 { format!("1 {one} becomes") } else { format!("{count} {many} become") }
}
