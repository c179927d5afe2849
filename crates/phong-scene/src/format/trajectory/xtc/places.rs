//! The packed places of a frame: whole multiples of a step, told from the least of them, or from the one before.

use glam::DVec3;

use super::super::frame::Fault;
use super::bits::Bits;

/// By how much places that are told from another one may differ from it, in both directions together; the index is
/// also how many bits three such differences take. The table is the format's own, whose powers of ∛2 are not
/// all rounded in the same way.
const SPANS: [u32; 73] = [
    0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 10, 12, 16, 20, 25, 32, 40, 50, 64, 80, 101, 128, 161, 203, 256,
    322, 406, 512, 645, 812, 1024, 1290, 1625, 2048, 2580, 3250, 4096, 5060, 6501, 8192, 10321,
    13003, 16384, 20642, 26007, 32768, 41285, 52015, 65536, 82570, 104_031, 131_072, 165_140,
    208_063, 262_144, 330_280, 416_127, 524_287, 660_561, 832_255, 1_048_576, 1_321_122, 1_664_510,
    2_097_152, 2_642_245, 3_329_021, 4_194_304, 5_284_491, 6_658_042, 8_388_607, 10_568_983,
    13_316_085, 16_777_216,
];

/// The first index of the table that may be used.
const FIRST: u32 = 9;

/// Beyond so many steps an axis is told by itself.
const LARGE: u32 = 0xff_ffff;

/// What stands before the packed places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packing {
    /// Steps in a nanometre.
    pub(super) precision: f32,
    /// The least and the greatest place along each axis, in steps.
    pub(super) least: [i32; 3],
    pub(super) greatest: [i32; 3],
    /// The index of the table that counts at first.
    pub(super) index: u32,
}

/// How places are told that are told by themselves.
enum Whole {
    /// Three numbers in so many bits.
    Together(u32),
    /// One after another.
    Apart([u32; 3]),
}

fn broken<T>(message: String) -> Result<T, Fault> {
    Err(Fault::Broken(message))
}

impl Packing {
    /// How many steps there are along each axis.
    fn sizes(&self) -> Result<[u32; 3], Fault> {
        let mut sizes = [0; 3];
        for ((size, least), greatest) in sizes.iter_mut().zip(self.least).zip(self.greatest) {
            let steps = i64::from(greatest) - i64::from(least) + 1;
            let Some(steps) = u32::try_from(steps).ok().filter(|steps| *steps > 0) else {
                return broken(format!("its places reach from {least} to {greatest} steps"));
            };
            *size = steps;
        }
        Ok(sizes)
    }

    /// Unpacks all places, in ångström.
    pub(super) fn unpack(&self, bits: &mut Bits<'_>, places: &mut [DVec3]) -> Result<(), Fault> {
        let precision = f64::from(self.precision);
        if !(precision.is_finite() && precision > 0.0) {
            return broken(format!("a nanometre has {precision} steps"));
        }
        let sizes = self.sizes()?;
        let length = |size: u32| u32::BITS - size.leading_zeros();
        let whole = if sizes.iter().any(|size| *size > LARGE) {
            Whole::Apart(sizes.map(length))
        } else {
            let product: u128 = sizes.iter().map(|size| u128::from(*size)).product();
            Whole::Together(u128::BITS - product.leading_zeros())
        };
        let place = |steps: [i64; 3]| DVec3::from(steps.map(|n| n as f64 / precision * 10.0));
        let mut index = span_of(self.index)?;
        let mut run = 0;
        let mut next = 0;
        while next < places.len() {
            let mut steps = match whole {
                Whole::Together(count) => split(bits.take_packed(count)?, sizes),
                Whole::Apart(counts) => {
                    let mut steps = [0; 3];
                    for (step, count) in steps.iter_mut().zip(counts) {
                        *step = bits.take(count)?;
                    }
                    steps
                }
            };
            if steps.iter().zip(sizes).any(|(step, size)| *step >= size) {
                return broken(format!(
                    "the place of atom {} is beyond those that it says",
                    next + 1
                ));
            }
            let first: [i64; 3] =
                std::array::from_fn(|i| i64::from(self.least[i]) + i64::from(steps[i]));
            let mut change = 0;
            if bits.take(1)? == 1 {
                let told = bits.take(5)?;
                run = told / 3;
                change = told as i32 % 3 - 1;
            }
            let (span, half) = (SPANS[index as usize], i64::from(SPANS[index as usize] / 2));
            let mut put = |steps: [i64; 3]| {
                let to = places.get_mut(next).ok_or_else(|| {
                    Fault::Broken("it tells more places than it has atoms".to_owned())
                })?;
                *to = place(steps);
                next += 1;
                Ok::<(), Fault>(())
            };
            let mut before = first;
            for number in 0..run {
                steps = split(bits.take_packed(index)?, [span; 3]);
                let told: [i64; 3] =
                    std::array::from_fn(|i| before[i] + i64::from(steps[i]) - half);
                put(told)?;
                // The first two stand in turned order, so that of a water the oxygen tells of both hydrogens.
                if number == 0 {
                    put(first)?;
                }
                before = told;
            }
            if run == 0 {
                put(first)?;
            }
            index = span_of(index.wrapping_add_signed(change))?;
        }
        Ok(())
    }
}

/// An index of the table, if it is one.
fn span_of(index: u32) -> Result<u32, Fault> {
    if (FIRST..SPANS.len() as u32).contains(&index) {
        return Ok(index);
    }
    broken(format!("places are packed by span {index}, which there is not"))
}

/// Three numbers out of one.
fn split(packed: u128, sizes: [u32; 3]) -> [u32; 3] {
    let [_, b, c] = sizes.map(u64::from);
    // Three numbers of 24 bits are at most.
    let (first, rest) = if let Ok(packed) = u64::try_from(packed) {
        (packed / (b * c), packed % (b * c))
    } else {
        let both = u128::from(b * c);
        ((packed / both) as u64, (packed % both) as u64)
    };
    [u32::try_from(first).unwrap_or(u32::MAX), (rest / c) as u32, (rest % c) as u32]
}
