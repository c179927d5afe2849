//! The shapes' keys.

use super::field::{Access, Field, field, keyed};
use super::value::Stored;
use super::{Default, Key, Kind, Table};
use crate::limits::Range;
use crate::mesh::Caps;
use crate::molecule::{ColorMap, Style};
use crate::shape::Shape;
use crate::wording::Word;

keyed!(Shape, |shape| table_of(shape.word()));

/// Where any shape is placed: scale, then rotate, then translate; or a matrix alone.
pub(super) static PLACED: [Key; 5] = [
    Key::new(
        "name",
        Kind::Text,
        Default::Said("the kind and a number from 1"),
        "What `explain` calls it.",
    ),
    Key::new(
        "scale",
        Kind::Scale,
        Default::Said("1"),
        "First of the transform: a factor, or one along each axis.",
    ),
    Key::new(
        "rotate",
        Kind::Rotate,
        Default::Said("none"),
        "Then: `[ax, ay, az, degrees]`, right-handed about an axis; or a list of them, in order.",
    ),
    Key::new("translate", Kind::Point, Default::Vector([0.0; 3]), "Then: the shift."),
    Key::new(
        "matrix",
        Kind::Matrix,
        Default::Said("the three above"),
        "Instead of all three: four rows of four, for column vectors.",
    ),
];

/// What any shape is made of.
pub(super) static MADE_OF: [Key; 1] = [Key::new(
    "material",
    Kind::Material,
    Default::Said("the default material"),
    "The name of its material.",
)];

/// What a shape read from a file is made of.
static FILE_MATERIAL: [Key; 1] = [Key::new(
    "material",
    Kind::Material,
    Default::Said("the file's own, else the default material"),
    "The name of its material; replaces the file's own.",
)];

/// `[[sphere]]`.
pub(crate) static SPHERE: Table = Table {
    name: "sphere",
    doc: "All points at `radius` from `center`; scaled unevenly, an ellipsoid.",
    select: None,
    keys: &[
        &[
            Key::new("center", Kind::Point, Default::Required, "The middle.")
                .of(field!(Shape = Shape::{Sphere}.center)),
            Key::new(
                "radius",
                Kind::Number(Range::POSITIVE),
                Default::Required,
                "Distance of the surface from the middle.",
            )
            .of(field!(Shape = Shape::{Sphere}.radius)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[plane]]`.
pub(crate) static PLANE: Table = Table {
    name: "plane",
    doc: "An infinite plane.",
    select: None,
    keys: &[
        &[
            Key::new("point", Kind::Point, Default::Required, "Any point on it.")
                .of(field!(Shape = Shape::{Plane}.point)),
            Key::new("normal", Kind::Direction, Default::Required, "Its normal; any length.")
                .of(field!(Shape = Shape::{Plane}.normal)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[triangle]]`.
pub(crate) static TRIANGLE: Table = Table {
    name: "triangle",
    doc: "One triangle, counter-clockwise seen from outside.",
    select: None,
    keys: &[
        &[
            Key::new("points", Kind::Points, Default::Required, "The corners, not on one line.")
                .of(field!(Shape = Shape::{Triangle}.points)),
            Key::new(
                "normals",
                Kind::Directions,
                Default::Said("the geometric normal"),
                "Shading normals at the corners; any length.",
            )
            .of(field!(Shape = Shape::{Triangle}.normals)),
            Key::new(
                "uv",
                Kind::Uvs,
                Default::Said("(0, 0), (1, 0), (1, 1)"),
                "Texture coordinates at the corners.",
            )
            .of(field!(Shape = Shape::{Triangle}.uv)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[disc]]`.
pub(crate) static DISC: Table = Table {
    name: "disc",
    doc: "A flat disc.",
    select: None,
    keys: &[
        &[
            Key::new("center", Kind::Point, Default::Required, "The middle.")
                .of(field!(Shape = Shape::{Disc}.center)),
            Key::new("normal", Kind::Direction, Default::Required, "Its normal; any length.")
                .of(field!(Shape = Shape::{Disc}.normal)),
            Key::new("radius", Kind::Number(Range::POSITIVE), Default::Required, "Radius.")
                .of(field!(Shape = Shape::{Disc}.radius)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[box]]`.
pub(crate) static BOX: Table = Table {
    name: "box",
    doc: "A box with faces along the axes.",
    select: None,
    keys: &[
        &[
            Key::new(
                "min",
                Kind::Point,
                Default::Required,
                "The corner with the smallest coordinates.",
            )
            .of(field!(Shape = Shape::{Box}.min)),
            Key::new(
                "max",
                Kind::Point,
                Default::Required,
                "The corner with the largest; above `min` in each.",
            )
            .of(field!(Shape = Shape::{Box}.max)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[cylinder]]`.
pub(crate) static CYLINDER: Table = Table {
    name: "cylinder",
    doc: "A cylinder around the line from `from` to `to`.",
    select: None,
    keys: &[
        &[
            Key::new("from", Kind::Point, Default::Required, "One end of the axis.")
                .of(field!(Shape = Shape::{Cylinder}.from)),
            Key::new("to", Kind::Point, Default::Required, "The other end.")
                .of(field!(Shape = Shape::{Cylinder}.to)),
            Key::new("radius", Kind::Number(Range::POSITIVE), Default::Required, "Radius.")
                .of(field!(Shape = Shape::{Cylinder}.radius)),
            Key::new("capped", Kind::Flag, Default::Flag(true), "Whether discs close the ends.")
                .of(field!(Shape = Shape::{Cylinder}.capped)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[cone]]`.
pub(crate) static CONE: Table = Table {
    name: "cone",
    doc: "A cone or frustum around the line from `from` to `to`.",
    select: None,
    keys: &[
        &[
            Key::new("from", Kind::Point, Default::Required, "One end of the axis.")
                .of(field!(Shape = Shape::{Cone}.from)),
            Key::new("to", Kind::Point, Default::Required, "The other end.")
                .of(field!(Shape = Shape::{Cone}.to)),
            Key::new(
                "radius",
                Kind::Number(Range::NOT_NEGATIVE),
                Default::Required,
                "Radius at `from`.",
            )
            .of(field!(Shape = Shape::{Cone}.radius)),
            Key::new(
                "radius_to",
                Kind::Number(Range::NOT_NEGATIVE),
                Default::Number(0.0),
                "Radius at `to`; not both are 0.",
            )
            .of(field!(Shape = Shape::{Cone}.radius_to)),
            Key::new("capped", Kind::Flag, Default::Flag(true), "Whether discs close the ends.")
                .of(field!(Shape = Shape::{Cone}.capped)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[torus]]`.
pub(crate) static TORUS: Table = Table {
    name: "torus",
    doc: "A ring with a round section.",
    select: None,
    keys: &[
        &[
            Key::new("center", Kind::Point, Default::Required, "The middle.")
                .of(field!(Shape = Shape::{Torus}.center)),
            Key::new(
                "axis",
                Kind::Direction,
                Default::Required,
                "The axis it runs around; any length.",
            )
            .of(field!(Shape = Shape::{Torus}.axis)),
            Key::new(
                "radius",
                Kind::Number(Range::POSITIVE),
                Default::Required,
                "From the middle to the middle of the tube.",
            )
            .of(field!(Shape = Shape::{Torus}.radius)),
            Key::new(
                "tube",
                Kind::Number(Range::POSITIVE),
                Default::Required,
                "Radius of the tube; below `radius`.",
            )
            .of(field!(Shape = Shape::{Torus}.tube)),
        ],
        &MADE_OF,
        &PLACED,
    ],
};

/// `[[mesh]]`.
pub(crate) static MESH: Table = Table {
    name: "mesh",
    doc: "The triangles of a file.",
    select: None,
    keys: &[
        &[
            Key::new("file", Kind::File, Default::Required, "A model file."),
            Key::new(
                "smooth",
                Kind::Smooth,
                Default::Said("the file's normals, else 60"),
                "Shading normals: `false`: none, flat triangles; `true`: the default; an angle: \
             area-weighted normals where faces meet under it, degrees, in place of the \
             file's.",
            ),
        ],
        &FILE_MATERIAL,
        &PLACED,
    ],
};

/// `[[points]]`.
pub(crate) static POINTS: Table = Table {
    name: "points",
    doc: "A sphere at every point of a file.",
    select: None,
    keys: &[
        &[
            Key::new("file", Kind::File, Default::Required, "A file of points."),
            Key::new(
                "radius",
                Kind::Number(Range::POSITIVE),
                Default::Said("the file's own; an error where it has none"),
                "Radius of the spheres; the file's own per point win.",
            ),
        ],
        &FILE_MATERIAL,
        &PLACED,
    ],
};

/// `[[cylinders]]`.
pub(crate) static CYLINDERS: Table = Table {
    name: "cylinders",
    doc: "A cylinder along every segment of a file.",
    select: None,
    keys: &[
        &[
            Key::new(
                "file",
                Kind::File,
                Default::Required,
                "A file of segments: a PLY with an element `edge` of `vertex1` and `vertex2`.",
            ),
            Key::new(
                "radius",
                Kind::Number(Range::POSITIVE),
                Default::Said("that of the vertices; an error where they have none"),
                "Radius of the cylinders; the file's own per edge (`radius`, or `radius1` and \
                 `radius2` for its ends) win.",
            ),
            Key::new(
                "caps",
                Kind::Word(Caps::WORDS),
                Default::Word("round"),
                "What the ends look like: half spheres, discs, or open.",
            )
            .of(CAPS),
        ],
        &FILE_MATERIAL,
        &PLACED,
    ],
};

/// `[[molecule]]`.
pub(crate) static MOLECULE: Table = Table {
    name: "molecule",
    doc: "The atoms or particles of a file, and the bonds between them.",
    select: None,
    keys: &[
        &[
            Key::new(
                "file",
                Kind::File,
                Default::Required,
                "A file of atoms or particles: PDB, CIF, XYZ, GRO or LAMMPS.",
            ),
            Key::new(
                "trajectory",
                Kind::File,
                Default::Said("none: the file's own places"),
                "A DCD or XTC file of the same atoms, whose places are drawn: its first frame, or those of `--frames`.",
            ),
            Key::new(
                "style",
                Kind::Word(Style::WORDS),
                Default::Said(
                    "`\"ball-and-stick\"` for up to 400 atoms with bonds, else `\"spacefill\"`",
                ),
                "Spheres of the van der Waals radii; balls of a quarter of them, and sticks for bonds; \
                 sticks alone; a tube along the backbone of each chain, and balls and sticks for the rest.",
            ),
            Key::new(
                "select",
                Kind::Text,
                Default::Said("all but water, if there is anything else"),
                "What is drawn: `chain A and not water`, `residue ALA 10-20 or z < 5`.",
            ),
            Key::new(
                "color_by",
                Kind::Text,
                Default::Said("the file's colours, else `element`, else `type`"),
                "`element`, or a column of the file: `chain`, `residue`, `number`, `b-factor`, \
                 `charge`, `type`, ….",
            ),
            Key::new(
                "color_map",
                Kind::Word(ColorMap::WORDS),
                Default::Said("`\"viridis\"`, for `charge` `\"blue-white-red\"`"),
                "The colours of a column of numbers.",
            ),
            Key::new(
                "color_range",
                Kind::Numbers,
                Default::Said("the least and the largest number of the column"),
                "The two numbers that the ends of the colours stand for, `[low, high]`.",
            ),
            Key::new(
                "radius",
                Kind::Number(Range::POSITIVE),
                Default::Said("the file's own, else those of the elements, else neighbours touch"),
                "Radius of all spheres.",
            ),
            Key::new(
                "radius_by",
                Kind::Text,
                Default::Said("none"),
                "A column of numbers above 0, which are the radii.",
            ),
            Key::new(
                "radius_scale",
                Kind::Number(Range::POSITIVE),
                Default::Number(1.0),
                "What all radii of spheres are multiplied by.",
            ),
            Key::new(
                "bond_radius",
                Kind::Number(Range::POSITIVE),
                Default::Said("0.13, for sticks alone 0.22, for tubes 0.5"),
                "Radius of the sticks, or of the tubes, in Å.",
            ),
            Key::new(
                "vectors",
                Kind::Names,
                Default::Said("none"),
                "Three columns of numbers, like `[\"vx\", \"vy\", \"vz\"]`: an arrow at every atom.",
            ),
            Key::new(
                "vector_scale",
                Kind::Number(Range::POSITIVE),
                Default::Said(
                    "that at which the longest of the frame is 2.5 times as long as neighbours are apart",
                ),
                "Length of the arrow of a vector of length 1.",
            ),
            Key::new(
                "vector_radius",
                Kind::Number(Range::POSITIVE),
                Default::Said("0.03 times the longest"),
                "Radius of the arrows' shafts.",
            ),
            Key::new(
                "images",
                Kind::Counts(1000),
                Default::Said("`[1, 1, 1]`"),
                "How many cells are drawn along each edge of the cell.",
            ),
            Key::new(
                "image_layer",
                Kind::Number(Range::NOT_NEGATIVE),
                Default::Number(0.0),
                "How far around the cells more images of atoms are drawn.",
            ),
            Key::new(
                "cell",
                Kind::Flag,
                Default::Flag(false),
                "Whether the edges of the cell are drawn.",
            ),
        ],
        &FILE_MATERIAL,
        &PLACED,
    ],
};

/// `[[instance]]`.
pub(crate) static INSTANCE: Table = Table {
    name: "instance",
    doc: "A group, placed.",
    select: None,
    keys: &[
        &[Key::new("group", Kind::Group, Default::Required, "The name of the group.")],
        &PLACED,
    ],
};

/// All shapes: at the scene's top level, and in groups.
pub(crate) const SHAPES: &[Key] = &[
    shapes(&SPHERE),
    shapes(&PLANE),
    shapes(&TRIANGLE),
    shapes(&DISC),
    shapes(&BOX),
    shapes(&CYLINDER),
    shapes(&CONE),
    shapes(&TORUS),
    shapes(&MESH),
    shapes(&POINTS),
    shapes(&CYLINDERS),
    shapes(&MOLECULE),
    shapes(&INSTANCE),
];

const CAPS: Field = Field::Shape(Access {
    get: |shape| match shape {
        Shape::Cylinders(cylinders) => cylinders.caps.value(),
        _ => None,
    },
    set: |shape, value| {
        if let Shape::Cylinders(cylinders) = shape {
            cylinders.caps = Stored::of(value)?;
        }
        Some(())
    },
});

/// The table of the shapes of this word.
fn table_of(word: &str) -> &'static Table {
    let tables = SHAPES.iter().filter_map(|key| match key.kind {
        Kind::Tables(table) => Some(table),
        _ => None,
    });
    tables.into_iter().find(|table| table.name == word).unwrap_or(&SPHERE)
}

/// `[groups.NAME]`.
pub(crate) static GROUP: Table = Table {
    name: "group",
    doc: "Shapes to be placed together by `[[instance]]`.",
    select: None,
    keys: &[SHAPES],
};

const fn shapes(table: &'static Table) -> Key {
    Key::new(table.name, Kind::Tables(table), Default::Said("none"), table.doc)
}
