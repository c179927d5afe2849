//! Where samples are drawn: a pure function of pixel, sample index and seed.
//!
//! Every pair of coordinates is a two-dimensional Sobol sequence, Owen-scrambled by hashing, its
//! index shuffled for each pair so that pairs do not correlate (after Burley, *Practical
//! Hash-based Owen Scrambling*, 2020). Any power of two of samples is stratified in every
//! elementary interval. One sample is the middle of everything.

use phong_bvh::Lanes;

use crate::math::lanes::sin_cos_of_eighth;

/// What the coordinates of a pair are used for. Every use has its own, uncorrelated pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// The place in the pixel.
    Pixel,
    /// The place on the lens.
    Lens,
    /// The place on light number `0…`.
    Light(u32),
    /// Where a ray goes that looks around for what takes ambient light away.
    Around,
}

/// The source of the coordinates of one sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampler {
    key: u32,
    index: u32,
    centred: bool,
}

impl Sampler {
    /// Sample `index` of `count` at a pixel of the full picture.
    #[inline]
    pub(crate) fn new([x, y]: [u32; 2], index: u32, count: u32, seed: u64) -> Self {
        let centred = count <= 1;
        let seed = hash(seed as u32 ^ hash((seed >> 32) as u32));
        Self { key: hash(x ^ hash(y ^ seed)), index, centred }
    }

    /// Another sample of the same pixel.
    pub(crate) fn at(&self, index: u32) -> Self {
        Self { index, ..*self }
    }

    /// The sampler of a mirror or glass ray that left a surface: as good, but uncorrelated.
    #[must_use]
    pub(crate) fn branch(&self, number: u32) -> Self {
        Self { key: hash(self.key ^ hash(number + 1)), ..*self }
    }

    /// A point of the unit square [0, 1)².
    pub(crate) fn pair(&self, purpose: Use) -> [f32; 2] {
        if self.centred { [0.5, 0.5] } else { self.scrambled(purpose) }
    }

    #[inline(always)]
    fn scrambled(&self, purpose: Use) -> [f32; 2] {
        Keys::new(self.key, purpose.mixed()).pair(self.index)
    }
}

impl Use {
    /// A number for each, far apart.
    #[inline(always)]
    fn mixed(self) -> u32 {
        let dimension = match self {
            Self::Pixel => 0,
            Self::Lens => 1,
            Self::Light(number) => 2 + number,
            Self::Around => u32::MAX,
        };
        hash(dimension ^ 0x9e37_79b9)
    }
}

/// What the samples of a pixel are scrambled with, for one use.
#[derive(Clone, Copy, Debug)]
struct Keys {
    index: u32,
    x: u32,
    y: u32,
}

impl Keys {
    #[inline(always)]
    fn new(pixel: u32, purpose: u32) -> Self {
        let index = hash(pixel ^ purpose);
        Self { index, x: hash(index ^ 0x68bc_21eb), y: hash(index ^ 0x02e5_be93) }
    }

    #[inline(always)]
    fn pair(self, index: u32) -> [f32; 2] {
        // Scrambling the index as a number sends every aligned block of a power of two of
        // samples to another such block, which fills its strata as well.
        let index = scramble(index, self.index);
        let x = scramble(index.reverse_bits(), self.x);
        let y = scramble(sobol(index), self.y);
        [unit(x), unit(y)]
    }
}

/// Eight samplers of pictures with as many samples, side by side.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Samplers8 {
    key: [u32; 8],
    index: [u32; 8],
    centred: bool,
}

impl Samplers8 {
    /// The same one eight times.
    pub(crate) fn splat(Sampler { key, index, centred }: Sampler) -> Self {
        Self { key: [key; 8], index: [index; 8], centred }
    }

    /// Puts another into one lane, below 8, of a picture with as many samples.
    #[inline]
    pub(crate) fn set(&mut self, lane: usize, sampler: Sampler) {
        (self.key[lane], self.index[lane]) = (sampler.key, sampler.index);
    }

    /// The one in a lane, below 8.
    #[inline]
    pub(crate) fn get(&self, lane: usize) -> Sampler {
        Sampler { key: self.key[lane], index: self.index[lane], centred: self.centred }
    }

    /// Other samples of the same pixels: those of number `index`.
    #[inline]
    #[must_use]
    pub(crate) fn at(&self, index: u32) -> Self {
        Self { index: [index; 8], ..*self }
    }

    /// [`Sampler::pair`] of each.
    #[inline(always)]
    pub(crate) fn pair(&self, purpose: Use) -> [[f32; 8]; 2] {
        Places8::new(self, purpose).at(self.index)
    }

    /// Several places for each sample. All of a pixel's samples fill the square evenly; those of one sample do as well, and
    /// are not its middle.
    #[inline(always)]
    pub(crate) fn several(&self, purpose: Use) -> Several8 {
        let places = Places8::new(&Self { centred: false, ..*self }, purpose);
        Several8 { places, index: self.index }
    }
}

/// [`Samplers8::pair`] of each. The loop does nothing else, so that the processor works on several at a time; those of
/// the same pixels, which follow one another, share what they have in common.
#[inline(always)]
pub(crate) fn pairs(samplers: &[Samplers8], purpose: Use, to: &mut Vec<[[f32; 8]; 2]>) {
    to.resize(samplers.len(), [[0.5; 8]; 2]);
    let Some(mut last) = samplers.first() else { return };
    let mut places = Places8::new(last, purpose);
    for (samplers, to) in samplers.iter().zip(to) {
        if samplers.key != last.key {
            places = Places8::new(samplers, purpose);
            last = samplers;
        }
        *to = places.at(samplers.index);
    }
}

/// Several places for each of eight samples.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Several8 {
    places: Places8,
    index: [u32; 8],
}

impl Several8 {
    /// Of `count` places for each sample the one of this number.
    #[inline(always)]
    pub(crate) fn at(&self, number: u32, count: u32) -> [[f32; 8]; 2] {
        self.places.at(self.index.map(|index| index.wrapping_mul(count).wrapping_add(number)))
    }
}

/// Where the samples of eight pixels fall, for one use: what they have in common.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Places8 {
    index: [u32; 8],
    x: [u32; 8],
    y: [u32; 8],
    centred: bool,
}

impl Places8 {
    #[inline(always)]
    pub(crate) fn new(samplers: &Samplers8, purpose: Use) -> Self {
        let Samplers8 { key, centred, .. } = *samplers;
        let mut places = Self { index: key, x: key, y: key, centred };
        if !centred {
            let purpose = purpose.mixed();
            for (lane, &key) in key.iter().enumerate() {
                let Keys { index, x, y } = Keys::new(key, purpose);
                (places.index[lane], places.x[lane], places.y[lane]) = (index, x, y);
            }
        }
        places
    }

    /// The places of the samples `index`: straight code, which the compiler makes vector code of.
    #[inline(always)]
    pub(crate) fn at(&self, index: [u32; 8]) -> [[f32; 8]; 2] {
        let mut out = [[0.5; 8]; 2];
        if !self.centred {
            let [x, y] = &mut out;
            for (lane, (x, y)) in x.iter_mut().zip(y).enumerate() {
                let keys = Keys { index: self.index[lane], x: self.x[lane], y: self.y[lane] };
                [*x, *y] = keys.pair(index[lane]);
            }
        }
        out
    }
}

/// A point of the unit disc from one of the unit square, areas kept (Shirley and Chiu 1997).
/// (½, ½) is the middle.
#[inline(always)]
pub(crate) fn concentric_disc<F: Lanes<Scalar = f32>>([u, v]: [F; 2]) -> [F; 2] {
    let (a, b) = (u * 2.0 - 1.0, v * 2.0 - 1.0);
    let across = a.abs().gt(b.abs());
    // In the quarters above and below, x and y change their parts.
    let (r, other) = (F::select(across, a, b), F::select(across, b, a));
    let zero = r.splat(0.0);
    let turn = F::select(r.abs().gt(zero), other / r, zero) * std::f32::consts::FRAC_PI_4;
    let (sin, cos) = sin_cos_of_eighth(turn);
    [r * F::select(across, cos, sin), r * F::select(across, sin, cos)]
}

/// The 24 highest bits as a number in [0, 1).
#[inline(always)]
fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// The second Sobol dimension. Its generator matrix is Pascal's triangle modulo 2, whose entry at
/// row r, column j is 1 where the bits of r are among those of j (Lucas): the five-fold product of
/// the 2 × 2 triangle with itself, applied one factor at a time.
#[inline(always)]
fn sobol(index: u32) -> u32 {
    let mut x = index;
    x ^= x >> 1 & 0x5555_5555;
    x ^= x >> 2 & 0x3333_3333;
    x ^= x >> 4 & 0x0f0f_0f0f;
    x ^= x >> 8 & 0x00ff_00ff;
    x ^= x >> 16 & 0x0000_ffff;
    x.reverse_bits()
}

/// Owen scrambling of a fraction's bits (highest first): a bit is flipped by a hash of all bits
/// above it. On reversed bits that is a hash in which a bit depends on lower bits only, which
/// additions, even multiplications and exclusive-or with them give. (The multipliers are those of
/// Laine and Karras, *Stratified sampling for stochastic transparency*, 2011.)
#[inline(always)]
fn scramble(bits: u32, key: u32) -> u32 {
    let mut x = bits.reverse_bits();
    x = x.wrapping_add(key);
    x ^= x.wrapping_mul(0x6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638);
    x ^= x.wrapping_mul(0x8d22_f6e6);
    x.reverse_bits()
}

/// A 32-bit mixer: each bit of the input changes about half of the output's.
#[inline(always)]
fn hash(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;

    fn points(count: u32, purpose: Use) -> Vec<[f32; 2]> {
        (0..count).map(|i| Sampler::new([3, 7], i, count, 1).pair(purpose)).collect()
    }

    #[test]
    fn one_sample_is_the_middle() {
        assert_eq!(points(1, Use::Pixel), [[0.5, 0.5]]);
        assert_eq!(points(1, Use::Light(3)), [[0.5, 0.5]]);
    }

    #[test]
    fn several_places_of_each_sample_fill_the_square_evenly_even_of_one_sample() {
        for (samples, several) in [(1, 64), (4, 16)] {
            let mut columns = [0; 64];
            for index in 0..samples {
                let samplers = Samplers8::splat(Sampler::new([3, 7], index, samples, 1));
                for number in 0..several {
                    let [x, _] = samplers.several(Use::Around).at(number, several);
                    columns[(x[5] * 64.0) as usize] += 1;
                }
            }
            assert_eq!(columns, [1; 64], "{samples} samples of {several}");
        }
    }

    #[test]
    fn every_elementary_interval_holds_its_share() {
        for purpose in [Use::Pixel, Use::Lens, Use::Light(0), Use::Light(5)] {
            let points = points(64, purpose);
            for bits in 0..=6 {
                let (across, down) = (1 << bits, 64 >> bits);
                let mut cells = vec![0; 64];
                for [x, y] in &points {
                    let cell = |v: f32, n: usize| (v * n as f32) as usize;
                    cells[cell(*y, down) * across + cell(*x, across)] += 1;
                }
                assert!(cells.iter().all(|&n| n == 1), "{purpose:?}, {across} × {down}");
            }
        }
    }

    #[test]
    fn the_second_dimension_is_the_product_with_pascals_triangle() {
        let by_definition = |index: u32| {
            let (mut direction, mut out) = (0x8000_0000_u32, 0);
            for bit in 0..32 {
                if index >> bit & 1 != 0 {
                    out ^= direction;
                }
                direction ^= direction >> 1;
            }
            out
        };
        for i in 0..4096 {
            let index = hash(i);
            assert_eq!(sobol(index), by_definition(index));
            assert_eq!(sobol(i), by_definition(i));
        }
    }

    #[test]
    fn pixels_seeds_and_uses_differ() {
        let base = Sampler::new([3, 7], 5, 16, 1);
        let p = base.pair(Use::Pixel);
        assert_ne!(p, base.pair(Use::Lens));
        assert_ne!(p, base.branch(0).pair(Use::Pixel));
        assert_ne!(p, Sampler::new([4, 7], 5, 16, 1).pair(Use::Pixel));
        assert_ne!(p, Sampler::new([3, 7], 5, 16, 2).pair(Use::Pixel));
        assert_ne!(p, Sampler::new([3, 7], 5, 16, 1 << 32).pair(Use::Pixel));
    }

    #[test]
    fn eight_pairs_have_the_bits_of_one() {
        for count in [1, 16] {
            let own = |i: usize| Sampler::new([i as u32, 9], i as u32 % 3, count, 5);
            let mut samplers = Samplers8::splat(own(0));
            (0..8).for_each(|i| samplers.set(i, own(i)));
            let [x, y] = samplers.pair(Use::Pixel);
            let [u, v] = Places8::new(&samplers, Use::Pixel).at([7; 8]);
            for i in 0..8 {
                assert_eq!([x[i], y[i]], own(i).pair(Use::Pixel));
                assert_eq!([u[i], v[i]], own(i).at(7).pair(Use::Pixel));
            }
        }
    }

    #[test]
    fn the_disc_is_filled_evenly_from_its_middle_to_its_rim() {
        assert_eq!(concentric_disc([0.5_f32; 2]), [0.0; 2]);
        let n = 100_u16;
        let at = |k: u16| (f32::from(k) + 0.5) / f32::from(n);
        let mut within = 0;
        for i in 0..n * n {
            let [x, y] = concentric_disc([at(i % n), at(i / n)]);
            assert!(x * x + y * y < 1.0);
            within += u16::from(x * x + y * y < 0.49);
        }
        assert!((f32::from(within) / f32::from(n * n) - 0.49).abs() < 0.005);
        let [x, y] = concentric_disc([1.0, 0.75]);
        let (sin, cos) = sin_cos(std::f32::consts::FRAC_PI_8);
        assert!((x - cos).abs() < 1e-7 && (y - sin).abs() < 1e-7);
    }

    #[test]
    fn two_uses_do_not_correlate() {
        let n = 1024;
        let (a, b) = (points(n, Use::Pixel), points(n, Use::Lens));
        let product: f32 = a.iter().zip(&b).map(|(a, b)| (a[0] - 0.5) * (b[0] - 0.5)).sum();
        assert!((product / n as f32).abs() < 0.01, "{}", product / n as f32);
    }
}
