//! Shapes: what a ray can meet. All in the object's own space; the object's transform places them.
//!
//! # `[[sphere]]`
//!
//! ```toml
//! [[sphere]]
//! center = [0, 1, 0]
//! radius = 1
//! material = "plastic"
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `center` | three numbers, `[x, y, z]` | required | The middle. |
//! | `radius` | a number above 0 | required | Distance of the surface from the middle. |
//!
//! # `[[plane]]`
//!
//! ```toml
//! [[plane]]
//! point = [0, 0, 0]
//! normal = [0, 1, 0]
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `point` | three numbers, `[x, y, z]` | required | Any point on it. |
//! | `normal` | three numbers, `[x, y, z]`, not all 0 | required | Its normal; any length. |
//!
//! # `[[triangle]]`
//!
//! ```toml
//! [[triangle]]
//! points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `points` | three points, `[[x, y, z], [x, y, z], [x, y, z]]` | required | The corners, not on one line. |
//! | `normals` | three directions, `[[x, y, z], [x, y, z], [x, y, z]]` | the geometric normal | Shading normals at the corners; any length. |
//! | `uv` | three pairs, `[[u, v], [u, v], [u, v]]` | (0, 0), (1, 0), (1, 1) | Texture coordinates at the corners. |
//!
//! # `[[disc]]`
//!
//! ```toml
//! [[disc]]
//! center = [0, 0, 0]
//! normal = [0, 1, 0]
//! radius = 1
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `center` | three numbers, `[x, y, z]` | required | The middle. |
//! | `normal` | three numbers, `[x, y, z]`, not all 0 | required | Its normal; any length. |
//! | `radius` | a number above 0 | required | Radius. |
//!
//! # `[[box]]`
//!
//! ```toml
//! [[box]]
//! min = [-1, 0, -1]
//! max = [1, 2, 1]
//! rotate = [0, 1, 0, 30]
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `min` | three numbers, `[x, y, z]` | required | The corner with the smallest coordinates. |
//! | `max` | three numbers, `[x, y, z]` | required | The corner with the largest; above `min` in each. |
//!
//! # `[[cylinder]]`
//!
//! ```toml
//! [[cylinder]]
//! from = [0, 0, 0]
//! to = [0, 2, 0]
//! radius = 0.5
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `from` | three numbers, `[x, y, z]` | required | One end of the axis. |
//! | `to` | three numbers, `[x, y, z]` | required | The other end. |
//! | `radius` | a number above 0 | required | Radius. |
//! | `capped` | `true` or `false` | `true` | Whether discs close the ends. |
//!
//! # `[[cone]]`
//!
//! ```toml
//! [[cone]]
//! from = [0, 0, 0]
//! to = [0, 2, 0]
//! radius = 1
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `from` | three numbers, `[x, y, z]` | required | One end of the axis. |
//! | `to` | three numbers, `[x, y, z]` | required | The other end. |
//! | `radius` | a number 0 or above | required | Radius at `from`. |
//! | `radius_to` | a number 0 or above | `0` | Radius at `to`; not both are 0. |
//! | `capped` | `true` or `false` | `true` | Whether discs close the ends. |
//!
//! # `[[torus]]`
//!
//! ```toml
//! [[torus]]
//! center = [0, 1, 0]
//! axis = [0, 0, 1]
//! radius = 1
//! tube = 0.25
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `center` | three numbers, `[x, y, z]` | required | The middle. |
//! | `axis` | three numbers, `[x, y, z]`, not all 0 | required | The axis it runs around; any length. |
//! | `radius` | a number above 0 | required | From the middle to the middle of the tube. |
//! | `tube` | a number above 0 | required | Radius of the tube; below `radius`. |
//!
//! # `[[mesh]]`
//!
//! ```toml
//! [[mesh]]
//! file = "dragon.ply"
//! scale = 2.0
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `file` | the path of a file, in quotes | required | A model file. |
//! | `smooth` | `true`, `false` or an angle from 0 to 180 degrees | the file's normals, else 60 | Shading normals: `false`: none, flat triangles; `true`: the default; an angle: area-weighted normals where faces meet under it, degrees, in place of the file's. |
//! | `material` | the name of a material, in quotes | the file's own, else the default material | The name of its material; replaces the file's own. |
//!
//! # `[[points]]`
//!
//! ```toml
//! [[points]]
//! file = "atoms.ply"
//! radius = 0.5
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `file` | the path of a file, in quotes | required | A file of points. |
//! | `radius` | a number above 0 | the file's own; an error where it has none | Radius of the spheres; the file's own per point win. |
//! | `material` | the name of a material, in quotes | the file's own, else the default material | The name of its material; replaces the file's own. |
//!
//! # `[[cylinders]]`
//!
//! ```toml
//! [[cylinders]]
//! file = "bonds.ply"
//! radius = 0.1
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `file` | the path of a file, in quotes | required | A file of segments: a PLY with an element `edge` of `vertex1` and `vertex2`. |
//! | `radius` | a number above 0 | that of the vertices; an error where they have none | Radius of the cylinders; the file's own per edge (`radius`, or `radius1` and `radius2` for its ends) win. |
//! | `caps` | `round`, `flat` or `none` | `"round"` | What the ends look like: half spheres, discs, or open. |
//! | `material` | the name of a material, in quotes | the file's own, else the default material | The name of its material; replaces the file's own. |
//!
//! Colours of the edges replace the material's. Without, colours of the vertices do: each half of a cylinder is of the
//! colour of its end, as bonds are drawn.
//!
//! # `[[molecule]]`
//!
//! ```toml
//! [[molecule]]
//! file = "1abc.pdb"
//! style = "sticks"
//! select = "chain A and not hydrogen"
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `file` | the path of a file, in quotes | required | A file of atoms or particles: PDB, CIF, XYZ, GRO or LAMMPS. |
//! | `trajectory` | the path of a file, in quotes | none: the file's own places | A DCD or XTC file of the same atoms, whose places are drawn: its first frame, or those of `--frames`. |
//! | `style` | `spacefill`, `ball-and-stick`, `sticks` or `tube` | `"ball-and-stick"` for up to 400 atoms with bonds, else `"spacefill"` | Spheres of the van der Waals radii; balls of a quarter of them, and sticks for bonds; sticks alone; a tube along the backbone of each chain, and balls and sticks for the rest. |
//! | `select` | text | all but water, if there is anything else | What is drawn: `chain A and not water`, `residue ALA 10-20 or z < 5`. |
//! | `color_by` | text | the file's colours, else `element`, else `type` | `element`, or a column of the file: `chain`, `residue`, `number`, `b-factor`, `charge`, `type`, …. |
//! | `color_map` | `viridis`, `blue-white-red` or `grey` | `"viridis"`, for `charge` `"blue-white-red"` | The colours of a column of numbers. |
//! | `color_range` | a number or a list of numbers | the least and the largest number of the column | The two numbers that the ends of the colours stand for, `[low, high]`. |
//! | `radius` | a number above 0 | the file's own, else those of the elements, else neighbours touch | Radius of all spheres. |
//! | `radius_by` | text | none | A column of numbers above 0, which are the radii. |
//! | `radius_scale` | a number above 0 | `1` | What all radii of spheres are multiplied by. |
//! | `bond_radius` | a number above 0 | 0.13, for sticks alone 0.22, for tubes 0.5 | Radius of the sticks, or of the tubes, in Å. |
//! | `vectors` | a list of names, in quotes | none | Three columns of numbers, like `["vx", "vy", "vz"]`: an arrow at every atom. |
//! | `vector_scale` | a number above 0 | that at which the longest of the frame is 2.5 times as long as neighbours are apart | Length of the arrow of a vector of length 1. |
//! | `vector_radius` | a number above 0 | 0.03 times the longest | Radius of the arrows' shafts. |
//! | `images` | `[a, b, c]`, whole numbers from 1 to 1000 | `[1, 1, 1]` | How many cells are drawn along each edge of the cell. |
//! | `image_layer` | a number 0 or above | `0` | How far around the cells more images of atoms are drawn. |
//! | `cell` | `true` or `false` | `false` | Whether the edges of the cell are drawn. |
//! | `material` | the name of a material, in quotes | the file's own, else the default material | The name of its material; replaces the file's own. |
//!
//! Selections are made of `all`, `none`, `protein`, `nucleic`, `water`, `ion`, `backbone` and `hydrogen`; of `element`,
//! `chain`, `name`, `residue` and the names of columns, each with one or more values (`chain A B`, `residue ALA 10-20`);
//! of comparisons (`z < 5`, `b-factor >= 50`); joined by `not`, `and`, `or` and parentheses. Of alternate locations
//! those of the highest occupancy are drawn, and of several models the first.
//!
//! A slice is `select = "z > 4 and z < 6"`, which keeps whole atoms, or a `[[clip]]`, which cuts through them. What is
//! selected is what has images. A tube goes through the Cα atoms of proteins and the phosphorus atoms of nucleic acids,
//! and ends where residues are too far apart to be bound.
//!
//! # `[[instance]]`
//!
//! ```toml
//! [[instance]]
//! group = "snowman"
//! translate = [3, 0, 0]
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `group` | the name of a group, in quotes | required | The name of the group. |
//!
//! # Any shape
//!
//! These go with every shape; an instance has no `material` of its own.
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `material` | the name of a material, in quotes | the default material | The name of its material. |
//! | `name` | text | the kind and a number from 1 | What `explain` calls it. |
//! | `scale` | a number or `[x, y, z]`, none 0 | 1 | First of the transform: a factor, or one along each axis. |
//! | `rotate` | `[ax, ay, az, degrees]`, or a list of them | none | Then: `[ax, ay, az, degrees]`, right-handed about an axis; or a list of them, in order. |
//! | `translate` | three numbers, `[x, y, z]` | `[0, 0, 0]` | Then: the shift. |
//! | `matrix` | four rows of four numbers | the three above | Instead of all three: four rows of four, for column vectors. |

use std::array::from_fn;

use glam::{BVec3, DVec2, DVec3};

use crate::mesh::{Caps, Cylinders, Field, Mesh, Points};
use crate::wording::{Word, words};

/// Index into [`Scene::groups`](crate::Scene::groups).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct GroupId(pub u32);

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
    /// A cylinder along every segment.
    Cylinders(Box<Cylinders>),
    /// All objects of a group, placed by the object's transform.
    Instance(GroupId),
}

impl Default for Shape {
    /// The sphere of radius 1 about the origin.
    fn default() -> Self {
        Self::Sphere { center: DVec3::ZERO, radius: 1.0 }
    }
}

impl From<Mesh> for Shape {
    fn from(mesh: Mesh) -> Self {
        Self::Mesh(Box::new(mesh))
    }
}

impl From<Points> for Shape {
    fn from(points: Points) -> Self {
        Self::Points(Box::new(points))
    }
}

impl From<Cylinders> for Shape {
    fn from(cylinders: Cylinders) -> Self {
        Self::Cylinders(Box::new(cylinders))
    }
}

words!(Shape {
    "sphere" = Sphere { center: DVec3::ZERO, radius: 1.0 },
    "plane" = Plane { point: DVec3::ZERO, normal: DVec3::Y },
    "triangle" = Triangle { points: [DVec3::ZERO, DVec3::X, DVec3::Y], normals: None, uv: None },
    "disc" = Disc { center: DVec3::ZERO, normal: DVec3::Y, radius: 1.0 },
    "box" = Box { min: -DVec3::ONE, max: DVec3::ONE },
    "cylinder" = Cylinder { from: DVec3::ZERO, to: DVec3::Y, radius: 1.0, capped: true },
    "cone" = Cone { from: DVec3::ZERO, to: DVec3::Y, radius: 1.0, radius_to: 0.0, capped: true },
    "torus" = Torus { center: DVec3::ZERO, axis: DVec3::Y, radius: 1.0, tube: 0.25 },
    "mesh" = Mesh(Box::default()),
    "points" = Points(Box::default()),
    "cylinders" = Cylinders(Box::default()),
    "instance" = Instance(GroupId::default()),
});

impl Shape {
    /// Whether it encloses what is inside: not a plane, a disc, a triangle, an open tube, or a mesh with
    /// a hole. An instance is not asked: its objects are.
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Sphere { .. } | Self::Box { .. } | Self::Torus { .. } | Self::Points(_) => true,
            Self::Cylinder { capped, .. } | Self::Cone { capped, .. } => *capped,
            Self::Cylinders(cylinders) => cylinders.caps != Caps::Open,
            Self::Mesh(mesh) => mesh.is_closed(),
            Self::Plane { .. } | Self::Triangle { .. } | Self::Disc { .. } | Self::Instance(_) => {
                false
            }
        }
    }

    /// The name of its table in the scene text: `sphere`, `mesh`, ….
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.word()
    }

    /// The radius of all of its spheres or lines, in the object's unit, if nobody gave one and the reader guessed
    /// it: [`Scene::frame`](crate::Scene::frame) may give them a larger one.
    #[must_use]
    pub fn guessed(&self) -> Option<f32> {
        match self {
            Self::Points(points) => points.guessed,
            Self::Cylinders(cylinders) => cylinders.guessed,
            _ => None,
        }
    }

    /// The numbers that its points have besides their place.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        match self {
            Self::Mesh(mesh) => &mesh.fields,
            Self::Points(points) => &points.fields,
            Self::Cylinders(cylinders) => &cylinders.fields,
            _ => &[],
        }
    }

    /// Whether its points or faces have colours of their own, in place of their material's.
    #[must_use]
    pub fn has_colors(&self) -> bool {
        match self {
            Self::Mesh(mesh) => !mesh.colors.is_empty(),
            Self::Points(points) => !points.colors.is_empty(),
            Self::Cylinders(cylinders) => !cylinders.colors.is_empty(),
            _ => false,
        }
    }

    /// The largest `p · n` of all its points p, for each n of `along`; `None` if it has no end, or is
    /// made of arrays or a group.
    pub(crate) fn own_reach<const N: usize>(&self, along: [DVec3; N]) -> Option<[f64; N]> {
        let disc = |center: DVec3, normal: DVec3, radius: f64| disc(along, center, normal, radius);
        Some(match *self {
            Self::Sphere { center, radius } => along.map(|n| center.dot(n) + radius * n.length()),
            Self::Triangle { ref points, .. } => farthest(along, points),
            Self::Disc { center, normal, radius } => disc(center, normal, radius),
            Self::Box { min, max } => {
                let corner = |i: usize| {
                    let high = |bit: usize| i >> bit & 1 != 0;
                    DVec3::select(BVec3::new(high(0), high(1), high(2)), max, min)
                };
                farthest(along, &from_fn::<_, 8, _>(corner))
            }
            Self::Cylinder { from, to, radius, .. } => {
                farther(disc(from, to - from, radius), disc(to, to - from, radius))
            }
            Self::Cone { from, to, radius, radius_to, .. } => {
                farther(disc(from, to - from, radius), disc(to, to - from, radius_to))
            }
            Self::Torus { center, axis, radius, tube } => {
                let ring = disc(center, axis, radius);
                from_fn(|i| ring[i] + tube * along[i].length())
            }
            Self::Plane { .. }
            | Self::Mesh(_)
            | Self::Points(_)
            | Self::Cylinders(_)
            | Self::Instance(_) => return None,
        })
    }
}

/// How far a disc reaches.
pub(crate) fn disc<const N: usize>(
    along: [DVec3; N],
    center: DVec3,
    normal: DVec3,
    radius: f64,
) -> [f64; N] {
    let axis = normal.normalize_or_zero();
    along.map(|n| center.dot(n) + radius * (n - axis * axis.dot(n)).length())
}

/// How far some points reach.
pub(crate) fn farthest<const N: usize>(along: [DVec3; N], points: &[DVec3]) -> [f64; N] {
    let reaches = points.iter().map(|p| along.map(|n| p.dot(n)));
    reaches.fold([f64::NEG_INFINITY; N], farther)
}

pub(crate) fn farther<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    from_fn(|i| a[i].max(b[i]))
}
