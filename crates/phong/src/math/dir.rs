//! Unit directions.

use std::ops::Neg;

use glam::Vec3;

/// Squares between these are far enough from both ends of f32 to lose nothing.
pub(super) const SMALL: f32 = 1e-20;
pub(super) const LARGE: f32 = 1e20;

/// A direction: a vector of unit length, to rounding, because only this module makes one.
///
/// N, L, E, R and H are of this type, and all of them point *away* from the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Dir3(Vec3);

impl Dir3 {
    /// Along x.
    pub const X: Self = Self(Vec3::X);
    /// Along y.
    pub const Y: Self = Self(Vec3::Y);
    /// Along z.
    pub const Z: Self = Self(Vec3::Z);

    /// The direction of `v`; `None` where `v` is zero or not finite. Never under- or overflows.
    #[inline]
    pub fn new(v: Vec3) -> Option<Self> {
        let square = v.dot(v);
        if square > SMALL && square < LARGE {
            return Some(Self(v / square.sqrt()));
        }
        Self::of_extreme(v)
    }

    /// [`Dir3::new`] for vectors whose squares may under- or overflow, or that are none.
    #[cold]
    fn of_extreme(v: Vec3) -> Option<Self> {
        let scale = v.abs().max_element();
        if !(scale > 0.0 && scale.is_finite() && v.is_finite()) {
            return None;
        }
        let v = v / scale;
        Some(Self(v / v.dot(v).sqrt()))
    }

    /// Takes a vector of unit length as it is, to the bit; `None` where its length is off by more than
    /// 1e-5, or not a number.
    ///
    /// ```
    /// use phong::math::Dir3;
    /// assert_eq!(Dir3::from_array([0.0, 0.0, 1.0]), Some(Dir3::Z));
    /// assert_eq!(Dir3::from_array([0.0, 0.0, 1.1]), None);
    /// ```
    pub fn from_array(v: [f32; 3]) -> Option<Self> {
        let v = Vec3::from(v);
        ((v.length() - 1.0).abs() <= 1e-5).then_some(Self(v))
    }

    /// Takes `v`, which the caller knows to be of unit length to rounding, as it is.
    #[inline]
    pub(crate) const fn from_unit(v: Vec3) -> Self {
        Self(v)
    }

    /// As a plain vector.
    #[inline]
    pub const fn to_vec(self) -> Vec3 {
        self.0
    }

    /// Components in the order x, y, z.
    #[inline]
    pub const fn to_array(self) -> [f32; 3] {
        self.0.to_array()
    }

    /// The dot product with any vector or direction.
    #[inline]
    pub fn dot(self, other: Self) -> f32 {
        self.0.dot(other.0)
    }

    /// The cosine of the angle between two directions, clamped below at 0.
    #[inline]
    pub fn cos(self, other: Self) -> f32 {
        self.dot(other).max(0.0)
    }

    /// `R = 2(L·N)N − L`: with `self` the normal, the mirror image of a direction *to* the light.
    #[inline]
    #[must_use]
    pub fn mirror(self, to_light: Self) -> Self {
        let n = self.0;
        Self(2.0 * to_light.0.dot(n) * n - to_light.0)
    }

    /// `H = (L + E) / ‖L + E‖`, halfway between two directions; `None` where they are opposite.
    #[inline]
    pub fn halfway(self, other: Self) -> Option<Self> {
        Self::new(self.0 + other.0)
    }

    /// This direction, or its opposite, whichever is on the side of `other`.
    #[inline]
    #[must_use]
    pub fn facing(self, other: Self) -> Self {
        if self.dot(other) < 0.0 { -self } else { self }
    }
}

impl Neg for Dir3 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// Where an *incident* direction (pointing at the surface) goes on after a mirror of normal `n`:
/// `I − 2(I·N)N`. The same ray as [`Dir3::mirror`] of `−I`, written from the other side.
#[inline]
pub fn reflect(incident: Dir3, n: Dir3) -> Dir3 {
    Dir3(incident.0 - 2.0 * incident.0.dot(n.0) * n.0)
}
