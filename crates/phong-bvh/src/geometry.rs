//! What rays can meet. All numbers are finite; the caller has checked them.
//!
//! Triangles, spheres and cylinders of one radius are met in f32: beyond coordinates of 10¹⁸, or below sizes of 10⁻¹⁸, their
//! squares overflow or vanish, and hits are missed or made up; nothing worse happens.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

/// Primitives of one kind. Their arrays are shared: copies of a batch are copies of a reference.
///
/// ```
/// use glam::Vec3;
/// use phong_bvh::Primitives;
///
/// let triangle = Primitives::triangles(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]);
/// assert_eq!(triangle.clone().len(), 1);
/// ```
#[derive(Clone, Debug)]
pub enum Primitives {
    /// Indexed triangles; every index is in range. Degenerate ones are never hit.
    Triangles {
        /// Corners.
        positions: Arc<Vec<Vec3>>,
        /// Three corners a triangle, counter-clockwise seen from the side of the geometric normal.
        indices: Arc<Vec<[u32; 3]>>,
    },
    /// Spheres.
    Spheres(Spheres),
    /// Cylinders whose ends are all alike.
    Cylinders {
        /// Where they are.
        cylinders: Arc<Vec<Cylinder>>,
        /// What their ends look like.
        caps: Caps,
    },
    /// One infinite plane: one primitive.
    Plane(Plane),
    /// One curved or flat solid under any invertible transform: one primitive.
    Solid(Solid),
}

impl Primitives {
    /// Indexed triangles, from arrays that are shared already or become so.
    pub fn triangles(
        positions: impl Into<Arc<Vec<Vec3>>>,
        indices: impl Into<Arc<Vec<[u32; 3]>>>,
    ) -> Self {
        Self::Triangles { positions: positions.into(), indices: indices.into() }
    }

    /// Spheres, from an array that is shared already or becomes so.
    pub fn spheres(spheres: impl Into<Spheres>) -> Self {
        Self::Spheres(spheres.into())
    }

    /// Cylinders, from an array that is shared already or becomes so.
    pub fn cylinders(cylinders: impl Into<Arc<Vec<Cylinder>>>, caps: Caps) -> Self {
        Self::Cylinders { cylinders: cylinders.into(), caps }
    }

    /// How many primitives the batch holds.
    pub fn len(&self) -> usize {
        match self {
            Self::Triangles { indices, .. } => indices.len(),
            Self::Spheres(spheres) => spheres.len(),
            Self::Cylinders { cylinders, .. } => cylinders.len(),
            Self::Plane(_) | Self::Solid(_) => 1,
        }
    }

    /// Bytes of the numbers that say where they are.
    pub fn bytes(&self) -> u64 {
        let bytes = match self {
            Self::Triangles { positions, indices } => {
                size_of_val(&positions[..]) + size_of_val(&indices[..])
            }
            Self::Spheres(spheres) => size_of_val(spheres.as_slice()),
            Self::Cylinders { cylinders, .. } => size_of_val(&cylinders[..]),
            Self::Plane(plane) => size_of_val(plane),
            Self::Solid(solid) => size_of_val(solid),
        };
        bytes as u64
    }

    /// Whether the batch holds no primitive.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// All points at `radius` from `center`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Sphere {
    /// The middle.
    pub center: Vec3,
    /// Distance of the surface from the middle; > 0.
    pub radius: f32,
}

/// Spheres in an array that is shared: x, y and z of the middle and the radius of each.
#[derive(Clone, Debug)]
pub struct Spheres(Arc<Vec<[f32; 4]>>);

impl Spheres {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// One of them.
    ///
    /// # Panics
    /// If there are not so many.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Sphere {
        self.0[index].into()
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = Sphere> + ExactSizeIterator {
        self.0.iter().map(|&numbers| numbers.into())
    }

    /// The array itself.
    #[inline(always)]
    pub fn as_slice(&self) -> &[[f32; 4]] {
        &self.0
    }

    /// Adds one at the end. An array that others share is copied first.
    pub fn push(&mut self, sphere: Sphere) {
        Arc::make_mut(&mut self.0).push(sphere.into());
    }
}

impl From<Arc<Vec<[f32; 4]>>> for Spheres {
    fn from(spheres: Arc<Vec<[f32; 4]>>) -> Self {
        Self(spheres)
    }
}

impl From<Vec<Sphere>> for Spheres {
    fn from(spheres: Vec<Sphere>) -> Self {
        // In place: the numbers lie in the same order.
        Self(Arc::new(spheres.into_iter().map(Into::into).collect()))
    }
}

impl From<[f32; 4]> for Sphere {
    #[inline(always)]
    fn from([x, y, z, radius]: [f32; 4]) -> Self {
        Self { center: Vec3::new(x, y, z), radius }
    }
}

impl From<Sphere> for [f32; 4] {
    #[inline(always)]
    fn from(Sphere { center, radius }: Sphere) -> Self {
        center.extend(radius).to_array()
    }
}

/// A cylinder between two points; with two different radii a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Cylinder {
    /// The first end, on the axis.
    pub from: Vec3,
    /// The radius there; > 0.
    pub radius: f32,
    /// The second end. With round ends it may be the same as the first: that is a sphere. Else a
    /// cylinder without length is never hit.
    pub to: Vec3,
    /// The radius there; > 0.
    pub radius_to: f32,
}

/// What the ends of a cylinder look like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Caps {
    /// The surface is that of a sphere swept along the axis, whose radius goes linearly from one to
    /// the other. With one radius that is a capsule.
    #[default]
    Round,
    /// Discs close the ends.
    Flat,
    /// The ends are open, and the side is seen from within too.
    Open,
}

/// An infinite plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point on it.
    pub point: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
}

/// A canonical shape under an invertible affine transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// The shape in its own space.
    pub shape: Canonical,
    /// From its own space to the world.
    pub to_world: DAffine3,
}

/// Shapes in their own space; transforms make every other one of the kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Canonical {
    /// The unit sphere around the origin: an ellipsoid under an uneven transform.
    Sphere,
    /// The unit disc in z = 0, geometric normal +z.
    Disc,
    /// The triangle (0, 0), (1, 0), (0, 1) in z = 0, geometric normal +z. A hit has the weights of its
    /// second and third corner.
    Triangle,
    /// [−1, 1]³.
    Box,
    /// x² + y² = 1 for 0 ≤ z ≤ 1.
    Cylinder {
        /// Whether discs close the ends.
        capped: bool,
    },
    /// A frustum of radius `radius` at z = 0 and `radius_to` at z = 1; both ≥ 0, not both 0.
    Cone {
        /// Radius at z = 0.
        radius: f64,
        /// Radius at z = 1.
        radius_to: f64,
        /// Whether discs close the ends.
        capped: bool,
    },
    /// A ring around the z axis: radius 1 to the middle of the tube, whose radius is `tube` < 1.
    Torus {
        /// Radius of the tube.
        tube: f64,
    },
}

impl Canonical {
    /// Whether it has an inside that nothing gets into but through its surface.
    pub const fn is_closed(&self) -> bool {
        match self {
            Self::Sphere | Self::Box | Self::Torus { .. } => true,
            Self::Cylinder { capped } | Self::Cone { capped, .. } => *capped,
            Self::Disc | Self::Triangle => false,
        }
    }

    /// Whether it is closed, and a line enters it once and leaves it once.
    pub const fn is_convex(&self) -> bool {
        self.is_closed() && !matches!(self, Self::Torus { .. })
    }
}
