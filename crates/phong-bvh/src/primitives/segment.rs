//! How near a line comes to a segment: capsules, and what lies within them, are missed by most lines, and that
//! is known sooner than where a line would cross.
//!
//! Let `c` lead from the ray's origin to the segment's middle, `h` from there to its second end, and
//! `n = d × h`. The two lines pass each other by `|c·n| / |n|`, and on the axis that is at `s h`, where
//! `s = (f·h) (d·d) / n·n` with `f = c − (c·d / d·d) d`. The line sees the segment's half as
//! `p = n·n / d·d` long, squared: `√p` is `|h|` times the sine of the angle between them. Beyond an end,
//! `|s| > 1`, the line is farther from the end than from the axis by what it sees of the rest. So it is
//! `√((c·n)² / d·d + max(0, |f·h| − p)²) / √p` away from the segment, and that needs no division.

use crate::lanes::{Lanes, cross, dot};

/// No square of a distance that matters is less.
const TINY: f32 = 1e-37;
/// Twice the share of lengths that rounding is sure to stay below.
const ROUNDED: f32 = 2e-5;

/// What [`misses`] takes for a radius: twice that, and more than what it rounds because of the segment `h`.
pub(super) fn reach(radius: f32, h: [f32; 3]) -> f32 {
    radius * 2.002 + (h[0].abs() + h[1].abs() + h[2].abs()) * ROUNDED
}

/// Whether a line surely comes nowhere as near to a segment as a radius whose [`reach`] is given. It is sure only by far more than
/// rounding does here, and never of a line that goes nearly along the axis.
///
/// `scale` is 1 / d·d, `c` leads to the segment's middle, and `h` from there to its second end.
#[inline(always)]
pub(super) fn misses<F: Lanes<Scalar = f32>>(
    dir: [F; 3],
    scale: F,
    c: [F; 3],
    h: [F; 3],
    reach: F,
) -> F::Mask {
    let n = cross(dir, h);
    let b = dot(c, dir) * scale;
    let dh = dot(dir, h);
    let between = dot(c, n);
    let square = dot(n, n) * scale;
    let reach = reach + (c[0].abs() + c[1].abs() + c[2].abs()) * ROUNDED;
    // All twice as long, for `x + |x|` is twice what is above 0, and sooner there than a choice.
    let over = (dot(c, h) - b * dh).abs() - square;
    let beyond = over + over.abs();
    // Of what is NaN nothing is sure, and of the smallest numbers neither.
    let misses =
        (between * (scale * 4.0) * between + beyond * beyond).gt(reach * reach * square + TINY);
    // Within six degrees of the axis.
    misses & !(square * 99.0).lt(dh * dh * scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(origin: [f32; 3], dir: [f32; 3], radius: f32) -> bool {
        // From (0, 0, −2) to (0, 0, 2).
        let c = origin.map(|x| -x);
        let scale = 1.0 / dot(dir, dir);
        let h = [0.0, 0.0, 2.0];
        !misses(dir, scale, c, h, reach(radius, h))
    }

    #[test]
    fn a_line_is_near_the_segment_and_not_its_axis_alone() {
        for long in [1.0, 0.01, 300.0] {
            let across = [0.0, long, 0.0];
            assert!(near([0.49, 9.0, 1.0], across, 0.5));
            assert!(!near([0.51, 9.0, 1.0], across, 0.5), "beside");
            assert!(near([0.0, -9.0, 2.49], across, 0.5));
            assert!(!near([0.0, -9.0, 2.51], across, 0.5), "beyond the end");
            assert!(near([0.3, 9.0, -2.39], across, 0.5));
            assert!(!near([0.3, 9.0, -2.42], across, 0.5), "beyond the end and beside");
            let slanting = [long, 0.0, long];
            assert!(near([-5.0, 0.0, -2.3], slanting, 0.5), "above the end");
            assert!(!near([-4.0, 0.0, 0.75 - 2.0], slanting, 0.5), "by 0.75 / √2");
        }
    }

    #[test]
    fn a_line_along_the_axis_and_what_has_no_length_are_left_to_the_exact_test() {
        assert!(near([3.0, 0.0, -9.0], [0.0, 0.0, 1.0], 0.5));
        assert!(near([3.0, 0.0, -9.0], [0.0, 0.05, 1.0], 0.5));
        assert!(!misses([1.0, 0.0, 0.0], 1.0_f32, [0.0, 5.0, 0.0], [0.0; 3], 1.0));
        assert!(near([f32::NAN; 3], [0.0, 1.0, 0.0], 0.5));
        assert!(near([1e30; 3], [0.0, 1.0, 0.0], 1e20), "what overflows");
    }
}
