//! Cubes of two colours in turn.

use glam::DVec3;
use phong_scene::Rgb;

/// How far below a border a coordinate counts as above it: a surface that lies in a border is of
/// one colour then, although rounding puts its points on either side.
const BORDER: f64 = 1e-4;

#[derive(Clone, Copy, Debug)]
pub(super) struct Checker {
    /// Where ⌊x⌋ + ⌊y⌋ + ⌊z⌋ is even, and where it is odd.
    pub(super) colors: [Rgb; 2],
    /// Squares a unit.
    pub(super) scale: f64,
}

impl Checker {
    pub(super) fn value(&self, p: DVec3) -> Rgb {
        let [x, y, z] = (p * self.scale + BORDER).to_array().map(f64::floor);
        // Of each by itself: the sum of large numbers would lose their last digit.
        let odd = [x, y, z].into_iter().filter(|cell| cell.rem_euclid(2.0) != 0.0).count() % 2;
        self.colors[odd]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHECKER: Checker = Checker { colors: [Rgb::WHITE, Rgb::BLACK], scale: 2.0 };

    #[test]
    fn neighbouring_squares_differ_on_either_side_of_0() {
        for (x, want) in [(0.25, Rgb::WHITE), (0.75, Rgb::BLACK), (-0.25, Rgb::BLACK)] {
            for p in [DVec3::new(x, 0.1, 0.1), DVec3::new(0.1, x, 0.1), DVec3::new(0.1, 0.1, x)] {
                assert_eq!(CHECKER.value(p), want, "{p}");
            }
        }
        assert_eq!(CHECKER.value(DVec3::new(-0.25, 0.75, 0.1)), Rgb::WHITE);
    }

    #[test]
    fn a_surface_in_a_border_is_of_one_colour() {
        let at = |y: f64| CHECKER.value(DVec3::new(0.25, y, 0.25));
        assert_eq!([at(-1e-7), at(0.0), at(1e-7)], [Rgb::WHITE; 3]);
        assert_eq!(at(-1e-3), Rgb::BLACK);
    }
}
