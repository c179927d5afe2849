//! Cylinders and capsules in bulk.

use glam::{DVec3, Vec3};

use super::{Field, Shared};
use crate::color::Rgb;
use crate::wording::words;

/// A cylinder along every segment. Radii > 0, every number finite; unless the ends are round, no
/// segment is without length.
#[derive(Clone, Debug, Default)]
pub struct Cylinders {
    /// Added, in f64, to every end.
    pub origin: DVec3,
    /// The two ends of each, `[x, y, z, radius]`, on the axis and relative to `origin`.
    pub segments: Shared<[[f32; 4]; 2]>,
    /// Two linear colours a segment, which replace the material's: of the half at the first end and
    /// of the half at the second; empty: none.
    pub colors: Shared<[Rgb; 2]>,
    /// What the ends look like.
    pub caps: Caps,
    /// The radius of all, if nobody gave one and the reader guessed it: a picture that cannot show lines so thin
    /// may draw thicker ones. `None`: the radii are as they were meant.
    pub guessed: Option<f32>,
    /// Numbers that the ends have, two a segment, which maps show; most have none.
    pub fields: Vec<Field>,
}

/// What the ends of cylinders look like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Caps {
    /// Round: the surface is that of a sphere which goes from end to end, while its radius changes
    /// evenly. Between equal radii, a capsule.
    #[default]
    Round,
    /// Discs close the ends.
    Flat,
    /// The ends are open: tubes.
    Open,
}

words!(Caps { "round" = Round, "flat" = Flat, "none" = Open });

impl Cylinders {
    /// Bytes that the arrays take in memory.
    pub fn bytes(&self) -> u64 {
        (32 * self.segments.len() + 24 * self.colors.len()) as u64 + Field::bytes(&self.fields)
    }

    /// Gives all ends this radius, if it is one.
    pub(crate) fn set_radius(&mut self, radius: Option<f32>) {
        if let Some(radius) = radius.filter(|r| self.segments.iter().flatten().any(|e| e[3] != *r))
        {
            self.segments.iter_mut().flatten().for_each(|end| end[3] = radius);
        }
    }

    /// Whether both ends of a segment are at one place.
    pub(crate) fn is_empty([[ax, ay, az, _], [bx, by, bz, _]]: &[[f32; 4]; 2]) -> bool {
        (Vec3::new(*bx, *by, *bz) - Vec3::new(*ax, *ay, *az)).as_dvec3().try_normalize().is_none()
    }

    /// Takes the segments without length away, unless the ends are round; how many there were.
    pub(crate) fn drop_empty(&mut self) -> u64 {
        let before = self.segments.len();
        if self.caps != Caps::Round && self.segments.iter().any(Self::is_empty) {
            let mut keep = self.segments.iter().map(|segment| !Self::is_empty(segment));
            self.colors.retain(|_| keep.next().unwrap_or(true));
            let segments = &self.segments;
            let keep = |i: usize| segments.get(i).is_none_or(|segment| !Self::is_empty(segment));
            Field::retain(&mut self.fields, 2, keep);
            self.segments.retain(|segment| !Self::is_empty(segment));
        }
        (before - self.segments.len()) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_round_cylinders_may_be_without_length() {
        let segment = |x: f32| [[0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0, 1.0]];
        let mut cylinders = Cylinders {
            segments: [segment(0.0), segment(1.0)].into(),
            colors: [[Rgb::BLACK; 2], [Rgb::WHITE; 2]].into(),
            ..Cylinders::default()
        };
        assert_eq!((cylinders.drop_empty(), cylinders.bytes()), (0, 112));
        cylinders.caps = Caps::Flat;
        assert_eq!(cylinders.drop_empty(), 1);
        assert_eq!(
            (cylinders.segments, cylinders.colors),
            ([segment(1.0)].into(), [[Rgb::WHITE; 2]].into())
        );
    }
}
