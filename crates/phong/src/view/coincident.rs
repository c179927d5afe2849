//! Which objects may have surfaces in one place where that matters: where one of two is of glass, or their
//! priorities differ. A ray that meets any of these has to look for what else is there.
//!
//! It is enough that none is forgotten; to name too many costs time alone. Two surfaces are in one place
//! all over only if both are flat and of one plane, or curved in the same way about the same middle.

use glam::{DMat3, DVec3};
use phong_bvh::{Canonical, Primitives, Solid};
use phong_scene::cofactor;

use crate::geometry::Geometry;
use crate::material::Material;

/// How far apart surfaces may be to count as being in one place here, in sizes of what they are parts of.
const NEAR: f64 = 1e-5;

/// With so many flat faces about as far from the middle of all, no pair is looked at: all may coincide.
const MOST_NEIGHBOURS: usize = 256;

/// What of a view's objects needs more than the closest hit.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coincidences {
    /// The objects that may have surfaces in one place with others, or with themselves.
    objects: Vec<bool>,
    /// The objects that enclose what they are made of.
    closed: Vec<bool>,
    /// Whether glasses of different priorities are in the scene: a ray has to know what it is in.
    pub(crate) nested: bool,
}

impl Coincidences {
    /// Those of a scene; `None`: rays need the closest hit alone.
    pub(super) fn of(geometry: &Geometry, materials: &[Material]) -> Option<Self> {
        if !materials.iter().map(Rank::of).any(|rank| rank.glass || rank.priority > 0) {
            return None;
        }
        let glasses = materials.iter().map(Rank::of).filter(|rank| rank.glass);
        let mut priorities = glasses.map(|rank| rank.priority);
        let first = priorities.next();
        let nested = priorities.any(|priority| Some(priority) != first);
        let count = geometry.objects().len();
        let mut found = Self { objects: vec![false; count], closed: vec![true; count], nested };
        let (mut flats, mut curves, mut meshes) = (Vec::new(), Vec::new(), Vec::new());
        for part in 0..geometry.world().parts() as u32 {
            let (batch, primitives) = (geometry.batch(part), geometry.world().primitives(part));
            // A large mesh's triangles are solids, and judged as such.
            if batch.is_bulk() && !matches!(primitives, Primitives::Solid(_)) {
                if !matches!(primitives, Primitives::Triangles { .. }) {
                    continue;
                }
                // A mesh may coincide with itself: two boxes in one file.
                let ranks =
                    batch.materials_used().map(|number| Rank::of(&materials[number as usize]));
                let own = Ranks::of(ranks);
                found.objects[batch.object(0) as usize] |= own.any_matters();
                meshes.push((batch.object(0) as usize, own));
                continue;
            }
            for local in 0..primitives.len() as u32 {
                let object = batch.object(local) as usize;
                let shape = Shape::of(primitives, local as usize);
                found.closed[object] = shape.closed;
                let rank = Rank::of(&materials[batch.material(local) as usize]);
                flats.extend(shape.flats.into_iter().map(|flat| (flat, object, rank)));
                curves.extend(shape.curve.map(|curve| (curve, object, rank)));
            }
        }
        // What is flat may lie in a face of any mesh, and any mesh in another.
        let flat = Ranks::of(flats.iter().map(|(_, _, rank)| *rank));
        let of_meshes = meshes.iter().fold(Ranks::default(), |all, (_, own)| all.with(*own));
        for (_, object, rank) in &flats {
            found.objects[*object] |= of_meshes.matters(Ranks::of([*rank]));
        }
        for (object, own) in &meshes {
            found.objects[*object] |= own.matters(flat);
            found.objects[*object] |= meshes.len() > 1 && own.matters(of_meshes);
        }
        found.mark(&mut flats, |flat: &Flat| flat.offset, Flat::coincides);
        found.mark(&mut curves, |curve: &Curve| curve.key, Curve::coincides);
        (found.nested || found.objects.contains(&true)).then_some(found)
    }

    /// Whether an object may have a surface in one place with another.
    #[inline]
    pub(crate) fn may_coincide(&self, object: u32) -> bool {
        self.objects[object as usize]
    }

    /// Whether an object encloses what it is made of: not a disc or an open tube.
    #[inline]
    pub(crate) fn is_closed(&self, object: u32) -> bool {
        self.closed[object as usize]
    }

    /// Marks what coincides among things that can do so only if their `key`s are about the same.
    fn mark<T>(
        &mut self,
        things: &mut [(T, usize, Rank)],
        key: impl Fn(&T) -> f64,
        coincides: impl Fn(&T, &T) -> bool,
    ) {
        things.sort_by(|(a, ..), (b, ..)| key(a).total_cmp(&key(b)));
        let largest = things.iter().map(|(thing, ..)| key(thing).abs()).fold(1.0, f64::max);
        for (i, (a, object, rank)) in things.iter().enumerate() {
            let near = |(b, ..): &&(T, usize, Rank)| key(b) - key(a) <= 4.0 * NEAR * largest;
            for (k, (b, other, rank_of_other)) in
                things[i + 1..].iter().take_while(near).enumerate()
            {
                let many = k >= MOST_NEIGHBOURS;
                if object != other && rank.matters(*rank_of_other) && (many || coincides(a, b)) {
                    self.objects[*object] = true;
                    self.objects[*other] = true;
                }
                if many {
                    break;
                }
            }
        }
    }
}

/// What decides which of two surfaces is met first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rank {
    glass: bool,
    priority: u32,
}

/// The ranks of several surfaces.
#[derive(Clone, Copy, Debug, Default)]
struct Ranks {
    glass: bool,
    /// The lowest and the highest priority; `None`: there are none.
    priorities: Option<(u32, u32)>,
}

impl Ranks {
    fn of(ranks: impl IntoIterator<Item = Rank>) -> Self {
        ranks.into_iter().fold(Self::default(), |all, Rank { glass, priority }| {
            all.with(Self { glass, priorities: Some((priority, priority)) })
        })
    }

    fn with(self, other: Self) -> Self {
        let priorities = match (self.priorities, other.priorities) {
            (Some((a, b)), Some((c, d))) => Some((a.min(c), b.max(d))),
            (some, None) | (None, some) => some,
        };
        Self { glass: self.glass || other.glass, priorities }
    }

    /// Whether it matters that any two of them coincide.
    fn any_matters(self) -> bool {
        self.glass || self.priorities.is_some_and(|(low, high)| low < high)
    }

    /// Whether it matters that any of them coincides with any of the others.
    fn matters(self, other: Self) -> bool {
        self.priorities.is_some() && other.priorities.is_some() && self.with(other).any_matters()
    }
}

impl Rank {
    fn of(material: &Material) -> Self {
        Self { glass: !material.transmission.is_black(), priority: material.priority }
    }

    /// Whether it matters that two coincide.
    fn matters(self, other: Self) -> bool {
        self.glass || other.glass || self.priority != other.priority
    }
}

/// The plane of a flat face, about the middle of the geometry.
struct Flat {
    normal: DVec3,
    /// Distance of the plane from there.
    offset: f64,
    /// The middle of the face.
    middle: DVec3,
    /// How far it reaches from there along each axis.
    reach: DVec3,
    /// The size of coordinates there.
    size: f64,
}

impl Flat {
    fn new(normal: DVec3, middle: DVec3, reach: DVec3) -> Option<Self> {
        let normal = normal.try_normalize()?;
        // Of the two normals of a plane the one whose first number that is not about 0 is positive.
        let first = normal.to_array().into_iter().find(|x| x.abs() > 1e-3)?;
        let normal = if first < 0.0 { -normal } else { normal };
        let (offset, size) = (normal.dot(middle), 1.0 + middle.abs().max_element());
        Some(Self { normal, offset, middle, reach, size })
    }

    fn coincides(&self, other: &Self) -> bool {
        let near = NEAR * self.size.max(other.size);
        (self.offset - other.offset).abs() <= near
            && self.normal.dot(other.normal).abs() > 1.0 - NEAR
            && (self.middle - other.middle)
                .abs()
                .cmple(self.reach + other.reach + DVec3::splat(near))
                .all()
    }
}

/// A curved surface.
struct Curve {
    /// The middle, or a point of the axis.
    middle: DVec3,
    /// The axis; `None`: a sphere.
    axis: Option<DVec3>,
    /// The radius of a sphere, and the size of anything else.
    size: f64,
    /// About the same for two that coincide.
    key: f64,
}

impl Curve {
    fn coincides(&self, other: &Self) -> bool {
        let between = other.middle - self.middle;
        let reach = self.size.max(other.size) + self.middle.abs().max_element();
        match (self.axis, other.axis) {
            (None, None) => {
                between.length() <= NEAR * reach && (self.size - other.size).abs() <= NEAR * reach
            }
            (Some(a), Some(b)) => {
                a.dot(b).abs() > 1.0 - NEAR
                    && between.reject_from_normalized(a).length() <= NEAR * reach
            }
            _ => false,
        }
    }
}

/// What of a primitive may coincide with others.
struct Shape {
    flats: Vec<Flat>,
    curve: Option<Curve>,
    closed: bool,
}

impl Shape {
    fn of(primitives: &Primitives, local: usize) -> Self {
        let flat = |normal, middle, reach| Self {
            flats: Flat::new(normal, middle, reach).into_iter().collect(),
            curve: None,
            closed: false,
        };
        match primitives {
            Primitives::Spheres(spheres) => {
                let sphere = spheres.get(local);
                let (middle, size) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
                let curve = Some(Curve { middle, axis: None, size, key: size });
                Self { flats: Vec::new(), curve, closed: true }
            }
            Primitives::Plane(plane) => {
                Self { closed: true, ..flat(plane.normal, plane.point, DVec3::INFINITY) }
            }
            Primitives::Triangles { positions, indices } => {
                let [a, b, c] = indices[local].map(|i| positions[i as usize].as_dvec3());
                let reach = (b - a).abs().max((c - a).abs());
                flat((b - a).cross(c - a), a, reach)
            }
            Primitives::Solid(solid) => Self::of_solid(solid),
            Primitives::Cylinders { .. } => Self { flats: Vec::new(), curve: None, closed: true },
        }
    }

    fn of_solid(Solid { shape, to_world }: &Solid) -> Self {
        let (middle, matrix) = (to_world.translation, to_world.matrix3);
        let normals: DMat3 = cofactor(matrix);
        let size = matrix.x_axis.length().max(matrix.y_axis.length()).max(matrix.z_axis.length());
        let axis = matrix.z_axis.normalize_or(DVec3::Z);
        let across = matrix.x_axis.abs() + matrix.y_axis.abs();
        // All that have an axis are compared: there are few of them in a scene.
        let curve = |axis| Some(Curve { middle, axis, size, key: 0.0 });
        let caps = |closed: bool| {
            let ends = [middle, middle + matrix.z_axis];
            let caps = ends.into_iter().filter_map(|end| Flat::new(normals.z_axis, end, across));
            Self { flats: caps.filter(|_| closed).collect(), curve: curve(Some(axis)), closed }
        };
        match *shape {
            Canonical::Disc | Canonical::Triangle => Self {
                flats: Flat::new(normals.z_axis, middle, across).into_iter().collect(),
                curve: None,
                closed: false,
            },
            Canonical::Box => {
                let face = |side: f64, axis: usize| {
                    let across: DVec3 =
                        (0..3).filter(|&k| k != axis).map(|k| matrix.col(k).abs()).sum();
                    Flat::new(normals.col(axis), middle + side * matrix.col(axis), across)
                };
                let flats = [-1.0, 1.0].into_iter();
                let flats = flats.flat_map(|side| (0..3).filter_map(move |axis| face(side, axis)));
                Self { flats: flats.collect(), curve: None, closed: true }
            }
            Canonical::Cylinder { capped } | Canonical::Cone { capped, .. } => caps(capped),
            // Whatever has no flat face is taken to be curved.
            ref curved => {
                let closed = curved.is_closed();
                Self { flats: Vec::new(), curve: curve(Some(axis)), closed }
            }
        }
    }
}
