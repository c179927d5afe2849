//! Which branches of the binary tree become children of one node: dynamic programming.
//!
//! With `A` half the surface of a branch, a forest of at most `i` trees under it costs
//! `C(1) = A + min C_left(k) + C_right(8 − k)` as a node and
//! `C(i) = min(C(i − 1), min C_left(k) + C_right(i − k))` as several (Ylitie, Karras and Laine,
//! *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs*, 2017).

use fearless_simd::{Simd, f32x8, i32x8, prelude::*};

/// The least costs of forests of at most one to seven trees, and nothing.
pub(super) type Costs = [f32; 8];

/// For two to eight trees: how many of them are on the left; 0: the same as for one fewer. The first
/// entry is for eight trees, the children of a node here.
pub(super) type Split = [u8; 8];

/// The costs of what is not opened: a leaf costs the same wherever it hangs.
pub(super) const CLOSED: Costs = [0.0; 8];

/// The least costs over two branches under a box of half the surface `area`, and how to divide them.
#[inline(always)]
pub(super) fn gather<S: Simd>(simd: S, area: f32, left: &Costs, right: &Costs) -> (Costs, Split) {
    // Lane t: the least of C_left(k) + C_right(t + 2 − k), and the first k it is for. For each k
    // the costs on the right stand one lane farther. What the last lane holds does not count.
    let infinity = f32x8::splat(simd, f32::INFINITY);
    let mut several = infinity;
    let mut first = i32x8::splat(simd, 0);
    let mut shifted = f32x8::load_array_ref(simd, right);
    for k in 1..=7 {
        let cost = f32x8::splat(simd, left[k - 1]) + shifted;
        let less = cost.simd_lt(several);
        several = less.select(cost, several);
        first = less.select(i32x8::splat(simd, k as i32), first);
        shifted = infinity.slide::<7>(shifted);
    }
    let (several, first) = (several.to_array(), first.to_array());
    let (mut costs, mut split) = (CLOSED, [0; 8]);
    costs[0] = area + several[6];
    split[0] = first[6] as u8;
    for trees in 2..8 {
        let (one_fewer, cost) = (costs[trees - 2], several[trees - 2]);
        costs[trees - 1] = if cost < one_fewer { cost } else { one_fewer };
        split[trees - 1] = if cost < one_fewer { first[trees - 2] as u8 } else { 0 };
    }
    (costs, split)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Level,
        level::{Kernel, Token},
    };

    struct Gather(f32, Costs, Costs);

    impl Kernel for Gather {
        type Output = (Costs, Split);

        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            gather(simd, self.0, &self.1, &self.2)
        }
    }

    /// The equations at the top, to the letter.
    fn by_definition(area: f32, left: &Costs, right: &Costs) -> Costs {
        let several = |trees: usize| {
            let ways = (1..trees).filter(|&k| k < 8 && trees - k < 8);
            ways.map(|k| left[k - 1] + right[trees - k - 1]).fold(f32::INFINITY, f32::min)
        };
        let mut costs = CLOSED;
        costs[0] = area + several(8);
        for trees in 2..8 {
            costs[trees - 1] = costs[trees - 2].min(several(trees));
        }
        costs
    }

    #[test]
    fn every_level_finds_the_least_costs_and_how_they_come_about() {
        let mut state = 1_u32;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 1e6
        };
        let mut costs = || {
            let mut costs: Costs = std::array::from_fn(|_| number());
            // More trees never cost more.
            costs.sort_by(|a, b| b.total_cmp(a));
            costs
        };
        for round in 0..200 {
            let (left, right) = (costs(), if round % 3 == 0 { CLOSED } else { costs() });
            let expected = by_definition(2.0, &left, &right);
            for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
                let token = Token::of(level).unwrap();
                let (found, split) = token.run(Gather(2.0, left, right));
                assert_eq!(found[..7], expected[..7], "{level:?}");
                for trees in 2..8 {
                    let way = match usize::from(split[trees - 1]) {
                        0 => found[trees - 2],
                        k => left[k - 1] + right[trees - k - 1],
                    };
                    assert_eq!(found[trees - 1], way, "{level:?}, {trees} trees");
                }
                let k = usize::from(split[0]);
                assert_eq!(found[0], 2.0 + (left[k - 1] + right[7 - k]), "{level:?}");
            }
        }
    }
}
