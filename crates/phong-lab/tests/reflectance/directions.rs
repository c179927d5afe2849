//! Directions to try formulas at: the same ones every time.

use std::f64::consts::TAU;

use glam::Vec3;
use phong::math::{Dir3, Frame};
use phong_lab::eval::{Directions, Query, Value};

/// A pattern of numbers without a pattern (splitmix64).
pub(crate) struct Dice(u64);

impl Dice {
    /// Dice that fall differently for every `seed`.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number in [low, high].
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        (f64::from(low) + self.unit() * f64::from(high - low)) as f32
    }

    /// One of 0 .. `count`.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Any direction, all equally likely.
    pub(crate) fn direction(&mut self) -> Dir3 {
        let z = self.between(-1.0, 1.0);
        self.around(Frame::around(Dir3::Z), z)
    }

    /// A normal, a light and an eye over its horizon, by a degree at least.
    pub(crate) fn directions(&mut self) -> Directions {
        let frame = Frame::around(self.direction());
        let [l, e] = [(); 2].map(|()| {
            let cos = self.between(0.02, 1.0);
            self.around(frame, cos)
        });
        Directions { n: frame.z, l, e }
    }

    /// A direction of cosine `cos` to the frame's z, turned at random.
    fn around(&mut self, frame: Frame, cos: f32) -> Dir3 {
        let (sin, phi) = (((1.0 - cos) * (1.0 + cos)).sqrt(), TAU * self.unit());
        let [x, y, z] = [frame.x, frame.y, frame.z].map(Dir3::to_vec);
        let (sin_p, cos_p) = libm::sincos(phi);
        Dir3::new(sin * cos_p as f32 * x + sin * sin_p as f32 * y + cos * z).unwrap()
    }
}

/// The unit vector at `theta` degrees from z towards x, and turned by `phi` degrees.
pub(crate) fn polar(theta: f64, phi: f64) -> Dir3 {
    let ((sin_t, cos_t), (sin_p, cos_p)) =
        (libm::sincos(theta.to_radians()), libm::sincos(phi.to_radians()));
    Dir3::new(Vec3::new((sin_t * cos_p) as f32, (sin_t * sin_p) as f32, cos_t as f32)).unwrap()
}

/// The number that answers a query; the red channel of a colour.
#[track_caller]
pub(crate) fn number(query: &Query) -> f64 {
    match query.value() {
        Ok(Value::Number(number)) => f64::from(number),
        Ok(Value::Color(color)) => f64::from(color.r),
        other => panic!("{query:?} gave {other:?}"),
    }
}
