//! The pixels of an image that are about a place in it or beside it.

use fearless_simd::{Simd, f64x4, prelude::*};
use phong_bvh::Lanes;
use phong_scene::Wrap;

/// The column or row of what is beside an image with a border.
pub(super) const BESIDE: u32 = u32::MAX;

/// The columns of an image, or its rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<F> {
    /// How many there are.
    pub(super) count: F,
    /// 1 over that.
    pub(super) share: F,
}

impl Side<f64> {
    pub(super) fn new(count: u32) -> Self {
        let count = f64::from(count);
        Self { count, share: 1.0 / count }
    }
}

/// The columns of the pixels before and behind four places, each of an image of its own; and how far each is from the
/// one towards the other. Or rows.
#[inline(always)]
pub(super) fn neighbours<S: Simd>(
    simd: S,
    at: &[f64; 4],
    sides: [Side<f64>; 4],
    wrap: Wrap,
) -> ([[f64; 4]; 2], [f64; 4]) {
    let [a, b, c, d] = sides;
    let four = |all: [f64; 4]| f64x4::load_array(simd, all);
    let count = four([a.count, b.count, c.count, d.count]);
    let share = four([a.share, b.share, c.share, d.share]);
    let (before, part) = split(f64x4::load_array_ref(simd, at) * count - 0.5);
    let [before, behind] = wrapped(before, Side { count, share }, wrap);
    ([before.into(), behind.into()], part.into())
}

/// From here on `f64` has no parts of whole numbers: the last bits of what is about this one are a whole number.
const WHOLE: f64 = (3_u64 << 51) as f64;

/// A number as the largest whole one that is not above it, and the part in [0, 1) beyond that: 0 of what is farther
/// away than 2^50, or NaN.
#[inline(always)]
pub(super) fn split<F: Lanes<Scalar = f64>>(x: F) -> (F, F) {
    let is_near = x.abs().lt(x.splat((1_u64 << 50) as f64));
    let x = F::select(is_near, x, x.splat(0.0));
    let whole = floor(x);
    (whole, x - whole)
}

/// The largest whole number that is not above `x`, which is less than 2^51.
#[inline(always)]
fn floor<F: Lanes<Scalar = f64>>(x: F) -> F {
    let nearest = (x + WHOLE) - WHOLE;
    nearest - F::select(nearest.gt(x), x.splat(1.0), x.splat(0.0))
}

/// The least whole number that is not below `x`, which is less than 2^51.
#[inline(always)]
pub(super) fn ceil<F: Lanes<Scalar = f64>>(x: F) -> F {
    -floor(-x)
}

/// A whole number from −1 on, which is [`BESIDE`].
#[inline(always)]
pub(super) fn number(x: f64) -> u32 {
    (x + WHOLE).to_bits() as u32
}

/// The column or row that stands for a whole number which may be beside the image, or [`BESIDE`]: [`wrapped`] of one by
/// itself, which most often is inside.
#[inline(always)]
pub(super) fn wrapped_alone(i: f64, count: u32, wrap: Wrap) -> u32 {
    let (i, n) = ((i + WHOLE).to_bits().wrapping_sub(WHOLE.to_bits()) as i64, i64::from(count));
    (match wrap {
        _ if (0..n).contains(&i) => i,
        // Without a division where it does.
        Wrap::Repeat if count.is_power_of_two() => i & (n - 1),
        Wrap::Repeat => i.rem_euclid(n),
        Wrap::Mirror => {
            let i = i.rem_euclid(2 * n);
            i.min(2 * n - 1 - i)
        }
        Wrap::Clamp => i.clamp(0, n - 1),
        Wrap::Border => return BESIDE,
    }) as u32
}

/// The columns or rows that stand for one which may be beside the image, and for the next; −1: its border. All are
/// whole numbers.
#[inline(always)]
pub(super) fn wrapped<F: Lanes<Scalar = f64>>(i: F, side: Side<F>, wrap: Wrap) -> [F; 2] {
    let Side { count, share } = side;
    let (none, next) = (i.splat(0.0), i + 1.0);
    let least = |a: F, b: F| F::select(a.lt(b), a, b);
    match wrap {
        Wrap::Repeat => rest(i, side),
        Wrap::Mirror => {
            let [a, b] = rest(i, Side { count: count * 2.0, share: share * 0.5 });
            let last = count * 2.0 - 1.0;
            [least(a, last - a), least(b, last - b)]
        }
        Wrap::Clamp => {
            let last = count - 1.0;
            [least(i, last).max(none), least(next, last).max(none)]
        }
        Wrap::Border => {
            let or_beside = |i: F| F::select(i.gt(i.splat(-1.0)) & i.lt(count), i, i.splat(-1.0));
            [or_beside(i), or_beside(next)]
        }
    }
}

/// What is left of a whole number, and of the next, without full periods.
#[inline(always)]
fn rest<F: Lanes<Scalar = f64>>(i: F, Side { count, share }: Side<F>) -> [F; 2] {
    // How many these are may be off by one, but not what is taken away for them.
    let rest = i - count * floor(i * share);
    let none = i.splat(0.0);
    let rest = F::select(rest.lt(none), rest + count, rest);
    let rest = F::select(rest.lt(count), rest, rest - count);
    let next = rest + 1.0;
    [rest, F::select(next.lt(count), next, none)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_split_as_the_standard_library_does() {
        for x in [0.0_f64, 0.25, 0.5, 1.0, 1.5, 2.999, 1e9 + 0.5, 7e14 + 0.25] {
            for x in [x, -x] {
                assert_eq!(split(x), (x.floor(), x - x.floor()), "{x}");
                assert_eq!(ceil(x), x.ceil(), "{x}");
            }
        }
        for far in [2e15, -2e15, 1e300, f64::INFINITY, f64::NAN] {
            assert_eq!(split(far), (0.0, 0.0), "{far}");
        }
    }

    #[test]
    fn columns_are_wrapped_alike_side_by_side_and_alone() {
        let far = (1_i64 << 50) - 1;
        let places = (-40..40).chain([far, far - 1, -far, 999_999_937]);
        for (i, count) in places.flat_map(|i| [1, 2, 3, 7, 8, 1000].map(|count| (i, count))) {
            for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Border] {
                let both = wrapped(i as f64, Side::new(count), wrap).map(number);
                let alone = [i, i + 1].map(|i| wrapped_alone(i as f64, count, wrap));
                assert_eq!(both, alone, "{wrap:?}: {i}, {count}");
            }
        }
        let repeated = [-9, -8, -1, 8].map(|i| wrapped_alone(f64::from(i), 8, Wrap::Repeat));
        assert_eq!(repeated, [7, 0, 7, 0]);
        let mirrored = [-4, -1, 3, 6].map(|i| wrapped_alone(f64::from(i), 3, Wrap::Mirror));
        assert_eq!(mirrored, [2, 0, 2, 0]);
        let clamped = [-4, 1, 3].map(|i| wrapped_alone(f64::from(i), 3, Wrap::Clamp));
        assert_eq!(clamped, [0, 1, 2]);
        let beside = [-1, 2, 3].map(|i| wrapped_alone(f64::from(i), 3, Wrap::Border));
        assert_eq!(beside, [BESIDE, 2, BESIDE]);
        assert_eq!([number(0.0), number(70_000.0), number(-1.0)], [0, 70_000, BESIDE]);
    }
}
