//! Orthonormal bases.

use glam::Vec3;

use super::Dir3;

/// A right-handed orthonormal basis: `x × y = z`, with z a given direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Along the grain.
    pub x: Dir3,
    /// Across the grain.
    pub y: Dir3,
    /// The direction the frame was made around, a normal as a rule.
    pub z: Dir3,
}

impl Frame {
    /// Some basis around `z`, the same one for the same `z`, and without a jump but at `z.z = 0`.
    ///
    /// The Householder reflection of the coordinate axes that brings the z axis onto ∓`z`,
    /// whichever is on its far side, so that nothing cancels; being a reflection it is left-handed,
    /// which one sign mends.
    pub fn around(z: Dir3) -> Self {
        let [nx, ny, nz] = z.to_array();
        let side = 1.0_f32.copysign(nz);
        let s = 1.0 / (1.0 + nz.abs());
        let x = Vec3::new(1.0 - nx * nx * s, -nx * ny * s, -side * nx);
        let y = Vec3::new(-nx * ny * s, 1.0 - ny * ny * s, -side * ny) * side;
        Self { x: Dir3::from_unit(x), y: Dir3::from_unit(y), z }
    }

    /// The basis around `z` whose x is `tangent` made perpendicular to it; some basis where the
    /// two are parallel.
    pub fn with_tangent(z: Dir3, tangent: Dir3) -> Self {
        let n = z.to_vec();
        let flat = |v: Vec3| v - n * v.dot(n);
        let once = flat(tangent.to_vec());
        // What is left of a parallel tangent is rounding, and points anywhere.
        if once.length_squared() < 1e-10 {
            return Self::around(z);
        }
        // A second time takes off what rounding left along n, which scaling up makes plain.
        let twice = Dir3::new(once).and_then(|x| Dir3::new(flat(x.to_vec())));
        let Some(x) = twice else { return Self::around(z) };
        Self { x, y: Dir3::from_unit(n.cross(x.to_vec())), z }
    }

    /// The direction whose components along x, y, z are `local`, a unit vector.
    pub fn to_world(self, local: Dir3) -> Dir3 {
        let [x, y, z] = local.to_array();
        Dir3::from_unit(x * self.x.to_vec() + y * self.y.to_vec() + z * self.z.to_vec())
    }

    /// The components of a direction along x, y, z.
    pub fn to_local(self, world: Dir3) -> Dir3 {
        Dir3::from_unit(Vec3::new(world.dot(self.x), world.dot(self.y), world.dot(self.z)))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn directions() -> impl Strategy<Value = Dir3> {
        let c = -1.0_f32..1.0;
        (c.clone(), c.clone(), c)
            .prop_filter_map("not zero", |(x, y, z)| Dir3::new(Vec3::new(x, y, z)))
    }

    fn assert_right_handed_and_orthonormal(frame: Frame) {
        let [x, y, z] = [frame.x, frame.y, frame.z].map(Dir3::to_vec);
        let gram = [x.dot(y), y.dot(z), z.dot(x)];
        assert!(gram.iter().all(|d| d.abs() < 1e-6), "{frame:?}: {gram:?}");
        for v in [x, y, z] {
            assert!((v.length() - 1.0).abs() < 1e-6, "{frame:?}");
        }
        assert!((x.cross(y) - z).length() < 1e-6, "{frame:?}");
    }

    proptest! {
        #[test]
        fn every_frame_is_right_handed_and_orthonormal(z in directions(), t in directions()) {
            assert_right_handed_and_orthonormal(Frame::around(z));
            assert_right_handed_and_orthonormal(Frame::with_tangent(z, t));
        }

        #[test]
        fn to_local_undoes_to_world(z in directions(), v in directions()) {
            let frame = Frame::around(z);
            let back = frame.to_local(frame.to_world(v));
            prop_assert!((back.to_vec() - v.to_vec()).length() < 1e-6);
        }
    }

    #[test]
    fn the_poles_and_a_parallel_tangent_have_frames_too() {
        for z in [Dir3::Z, -Dir3::Z, Dir3::X, -Dir3::X, Dir3::Y] {
            assert_right_handed_and_orthonormal(Frame::around(z));
            assert_right_handed_and_orthonormal(Frame::with_tangent(z, z));
            assert_right_handed_and_orthonormal(Frame::with_tangent(z, -z));
        }
    }

    #[test]
    fn the_tangent_is_kept_but_for_its_part_along_the_normal() {
        let slanted = Dir3::new(Vec3::new(1.0, 0.0, 1.0)).unwrap();
        let frame = Frame::with_tangent(Dir3::Z, slanted);
        assert_eq!((frame.x, frame.y), (Dir3::X, Dir3::Y));
    }
}
