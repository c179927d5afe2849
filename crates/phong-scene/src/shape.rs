//! Shapes: what a ray can meet. All in the object's own space; the object's transform places them.

use glam::{DVec2, DVec3};

use crate::{GroupId, Mesh, Points};

/// One shape, in its object's own space. All numbers are finite, radii > 0, directions not zero.
#[derive(Clone, Debug)]
pub enum Shape {
    /// All points at `radius` from `center`. Under an uneven transform, an ellipsoid.
    Sphere {
        /// The middle.
        center: DVec3,
        /// Distance of the surface from the middle.
        radius: f64,
    },
    /// An infinite plane.
    Plane {
        /// Any point on it.
        point: DVec3,
        /// Its geometric normal; any length.
        normal: DVec3,
    },
    /// One triangle, counter-clockwise seen from the side its geometric normal points to.
    Triangle {
        /// The corners.
        points: [DVec3; 3],
        /// Shading normals at the corners; `None`: the geometric normal.
        normals: Option<[DVec3; 3]>,
        /// Texture coordinates at the corners; `None`: (0, 0), (1, 0), (1, 1).
        uv: Option<[DVec2; 3]>,
    },
    /// A flat disc.
    Disc {
        /// The middle.
        center: DVec3,
        /// Its geometric normal; any length.
        normal: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A box with faces along the axes; `min < max` in each.
    Box {
        /// The corner with the smallest coordinates.
        min: DVec3,
        /// The corner with the largest coordinates.
        max: DVec3,
    },
    /// A cylinder around the segment from `from` to `to`.
    Cylinder {
        /// One end of the axis.
        from: DVec3,
        /// The other end.
        to: DVec3,
        /// Radius.
        radius: f64,
        /// Whether discs close the ends.
        capped: bool,
    },
    /// A cone, or a frustum, around the segment from `from` to `to`.
    Cone {
        /// One end of the axis.
        from: DVec3,
        /// The other end.
        to: DVec3,
        /// Radius at `from`, ≥ 0.
        radius: f64,
        /// Radius at `to`, ≥ 0, not both 0.
        radius_to: f64,
        /// Whether discs close the ends.
        capped: bool,
    },
    /// A ring with a round section.
    Torus {
        /// The middle.
        center: DVec3,
        /// The axis it runs around; any length.
        axis: DVec3,
        /// From the middle to the middle of the tube.
        radius: f64,
        /// Radius of the tube; less than `radius`.
        tube: f64,
    },
    /// Indexed triangles.
    Mesh(Box<Mesh>),
    /// A sphere at every point.
    Points(Box<Points>),
    /// All objects of a group, placed by the object's transform.
    Instance(GroupId),
}
