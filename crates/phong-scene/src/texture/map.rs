//! Colours of numbers: which number of a place, and between which two the colours run.

/// Which number of a place a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapSource<'a> {
    /// How far along the map's axis, else along the camera's `up`.
    Height,
    /// How far from the place where the texture is.
    Radius,
    /// The first coordinate; in `uv` u.
    X,
    /// The second; in `uv` v.
    Y,
    /// The third.
    Z,
    /// How far in front of the camera, along its view.
    Depth,
    /// The cosine between the normal, outwards, and the map's axis, else the camera's `up`.
    Normal,
    /// The property of this name that points of a file have.
    Property(&'a str),
}

impl<'a> MapSource<'a> {
    /// What a word or name stands for.
    #[must_use]
    pub fn of(word: &'a str) -> Self {
        match word {
            "height" => Self::Height,
            "radius" => Self::Radius,
            "x" => Self::X,
            "y" => Self::Y,
            "z" => Self::Z,
            "depth" => Self::Depth,
            "normal" => Self::Normal,
            name => Self::Property(name),
        }
    }

    /// The name of the property, if it is one.
    #[must_use]
    pub fn property(self) -> Option<&'a str> {
        match self {
            Self::Property(name) => Some(name),
            _ => None,
        }
    }
}

/// Between which numbers the colours of a map run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MapRange {
    /// The least and the largest of what it is on; of shapes without points that of their boxes.
    #[default]
    Auto,
    /// The number of the first colour, and another one, of the last.
    Between([f64; 2]),
}
