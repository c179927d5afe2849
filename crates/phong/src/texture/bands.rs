//! Lines and stripes: what of a sample of the picture they cover.

use glam::DVec3;
use phong_scene::Rgb;

/// How far below a border a place counts as above it, in stripes: as the checker has it.
const BORDER: f64 = 1e-4;

/// Lines along planes in which one coordinate is a whole number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// That of the lines, and that of what is between them.
    pub(super) colors: [Rgb; 2],
    /// Cells a unit.
    pub(super) scale: f64,
    /// How much of a cell a line takes.
    pub(super) share: f64,
    /// Along which axes cells are counted.
    pub(super) axes: [bool; 3],
}

/// Two colours in turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stripes {
    /// That where stripes are counted even, and odd.
    pub(super) colors: [Rgb; 2],
    /// Stripes a unit.
    pub(super) scale: f64,
    /// Unit; `None`: by the distance from the origin.
    pub(super) axis: Option<DVec3>,
}

impl Grid {
    /// The mean over a parallelogram about `p` with these sides.
    pub(super) fn value(&self, p: DVec3, sides: [DVec3; 2]) -> Rgb {
        let mut between = 1.0;
        for axis in (0..3).filter(|axis| self.axes[*axis]) {
            let width = reach(sides.map(|side| side[axis])) * self.scale;
            // A line reaches half its width to either side.
            let at = p[axis] * self.scale + 0.5 * self.share;
            between *= 1.0 - covered(at, width, self.share);
        }
        mix(self.colors, between)
    }
}

impl Stripes {
    /// The mean over a parallelogram about `p` with these sides.
    pub(super) fn value(&self, p: DVec3, sides: [DVec3; 2]) -> Rgb {
        let axis = self.axis.unwrap_or_else(|| p.normalize_or(DVec3::Y));
        let width = reach(sides.map(|side| side.dot(axis))) * self.scale;
        let at = axis.dot(p) * self.scale + BORDER;
        // Two stripes, one of each colour.
        mix(self.colors, 1.0 - covered(0.5 * at, 0.5 * width, 0.5))
    }
}

fn mix([a, b]: [Rgb; 2], part: f64) -> Rgb {
    a + part.clamp(0.0, 1.0) as f32 * (b - a)
}

/// How wide both sides of a parallelogram reach together: a range of this width is as far from its middle
/// on the mean as the parallelogram is.
fn reach([a, b]: [f64; 2]) -> f64 {
    (a * a + b * b).sqrt()
}

/// How much of a range of this width about `x` is in the first `share` of a period of 1.
fn covered(x: f64, width: f64, share: f64) -> f64 {
    let share = share.min(1.0);
    if !(x.is_finite() && width < 1e6) {
        return share; // so many periods, or none that is left
    }
    if width < 1e-9 {
        return if x - x.floor() < share { 1.0 } else { 0.0 };
    }
    // Of the periods from 0 to x.
    let up_to = |x: f64| {
        let whole = x.floor();
        whole * share + (x - whole).min(share)
    };
    let [from, to] = [x - 0.5 * width, x + 0.5 * width];
    // Counted from near by, so that places far out lose nothing.
    let base = from.floor();
    (up_to(to - base) - up_to(from - base)) / width
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_range_covers_is_the_mean_of_its_places() {
        for share in [0.1, 0.5, 0.93] {
            for (x, width) in [(0.2, 0.5), (-3.4, 0.07), (17.05, 3.3), (-0.01, 1.0), (1e6, 0.4)] {
                let count = 10_000;
                let place = |i: i32| x + width * ((f64::from(i) + 0.5) / f64::from(count) - 0.5);
                let inside = (0..count).filter(|i| covered(place(*i), 0.0, share) > 0.5).count();
                let want = inside as f64 / f64::from(count);
                assert!((covered(x, width, share) - want).abs() < 1e-3, "{share} {x} ± {width}");
            }
        }
        assert_eq!(covered(0.3, 1e300, 0.25), 0.25);
        assert_eq!(covered(f64::NAN, 0.1, 0.25), 0.25);
        assert_eq!(covered(0.3, f64::NAN, 0.25), 0.25);
    }

    #[test]
    fn a_line_lies_about_a_whole_number_and_is_as_wide_as_stated() {
        let grid = Grid {
            colors: [Rgb::BLACK, Rgb::WHITE],
            scale: 2.0,
            share: 0.2,
            axes: [true, false, true],
        };
        let at = |x: f64, z: f64| grid.value(DVec3::new(x, 0.0, z), [DVec3::ZERO; 2]).r;
        for (x, want) in [(0.0, 0.0), (0.049, 0.0), (-0.049, 0.0), (0.051, 1.0), (0.25, 1.0)] {
            assert_eq!([at(x, 0.25), at(0.25, x)], [want; 2], "{x}");
        }
        let wide = grid.value(DVec3::new(0.3, 0.0, 0.7), [DVec3::X * 50.0, DVec3::Z * 50.0]).r;
        assert!((wide - 0.64).abs() < 0.01, "{wide}");
    }

    #[test]
    fn stripes_come_in_turn_and_may_be_rings() {
        let stripes =
            Stripes { colors: [Rgb::WHITE, Rgb::BLACK], scale: 1.0, axis: Some(DVec3::X) };
        let at = |x: f64| stripes.value(DVec3::new(x, 9.0, 9.0), [DVec3::ZERO; 2]).r;
        assert_eq!([at(0.5), at(1.5), at(-0.5), at(-1e-7)], [1.0, 0.0, 0.0, 1.0]);
        let rings = Stripes { axis: None, ..stripes };
        let at = |x: f64| rings.value(DVec3::new(0.0, x, 0.0), [DVec3::ZERO; 2]).r;
        assert_eq!([at(0.5), at(1.5), at(-1.5), at(2.5)], [1.0, 0.0, 0.0, 1.0]);
    }
}
