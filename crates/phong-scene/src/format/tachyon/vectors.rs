//! Places and directions, of which z is negated.

use glam::{DVec3, Vec3};

use crate::format::text::{Parsed, Words};

impl Words<'_> {
    /// A place or a direction: z is negated.
    #[inline]
    pub(super) fn vector(&mut self) -> Parsed<Vec3> {
        let [x, y, z] = self.three()?;
        Ok(Vec3::new(x, y, -z))
    }

    /// A key and the vector behind it.
    #[inline]
    pub(super) fn keyed(&mut self, key: &str) -> Parsed<Vec3> {
        self.key(key)?;
        self.vector()
    }

    /// The same in double precision, for what there are few of.
    pub(super) fn keyed_double(&mut self, key: &str) -> Parsed<DVec3> {
        self.keyed(key).map(Vec3::as_dvec3)
    }
}
