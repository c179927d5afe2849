//! The stochastic experiment: facets are drawn from `D(m)(n·m)`, and a fixed light is mirrored.
//!
//! A facet of normal m catches `(l·m)/((n·m)(n·l))` of the light, for each unit of its shadow on
//! the ground; mirrored, a steradian of m becomes `4 l·m` steradians of directions. So the
//! weighted density of mirrored directions is `D(h)(n·h) · (l·h)/((n·h)(n·l)) / (4 l·h)`, which is
//! `D(h)/(4 n·l)`.

use glam::Vec3;
use phong::math::{Dir3, wide};
use phong::reflectance::{Distribution, microfacet::Lean};

/// The angle of incidence, degrees.
pub(super) const THETA: f64 = 55.0;
/// Blinn's exponent of the facets' distribution.
const EXPONENT: f32 = 24.0;
/// Directions near the plane of incidence, by their angle from the normal: so many bands …
pub(super) const BANDS: usize = 24;
/// … from here, negative on the light's side, to here, below the horizon, degrees.
pub(super) const RANGE: [f64; 2] = [-30.0, 120.0];
/// How far a counted direction may stand out of the plane of incidence: the sine of 10°.
const OUT_OF_PLANE: f64 = 0.173_648_177_666_930_35;
/// How many runs an error is the mean of.
const RUNS: u64 = 16;

/// What the facets should add up to.
pub(super) struct Experiment {
    /// The angle of incidence, degrees.
    theta: f64,
    l: Dir3,
    /// `D(h)/(4 n·l)`, the mean over each band, per steradian.
    pub(super) lobe: [f64; BANDS],
}

/// Densities of mirrored directions in each band, per steradian.
pub(super) struct Tally {
    pub(super) weighted: [f64; BANDS],
    /// Every facet counted as one.
    pub(super) plain: [f64; BANDS],
}

impl Experiment {
    pub(super) fn new(theta: f64) -> Self {
        let l = direction(-theta, 0.0);
        Self { theta, l, lobe: std::array::from_fn(|band| mean(middle(band), l, STEPS)) }
    }

    /// The densities that `count` facets give.
    pub(super) fn tally(&self, count: u32, run: u64) -> Tally {
        let (mut weighted, mut plain) = ([0.0; BANDS], [0.0; BANDS]);
        let n_dot_l = f64::from(self.l.dot(Dir3::Z));
        for index in 0..u64::from(count) {
            let m = facet(run << 32 | index);
            if let Some(band) = band(m.mirror(self.l)) {
                weighted[band] += f64::from(self.l.cos(m)) / (f64::from(m.dot(Dir3::Z)) * n_dot_l);
                plain[band] += 1.0;
            }
        }
        // In these coordinates, dω = dψ dy.
        let steradians = width().to_radians() * 2.0 * OUT_OF_PLANE;
        let density = |sum: f64| sum / (f64::from(count) * steradians);
        Tally { weighted: weighted.map(density), plain: plain.map(density) }
    }

    /// The root mean square distance of densities from the lobe, in units of its peak.
    pub(super) fn distance(&self, densities: &[f64; BANDS]) -> f64 {
        let peak = self.lobe.iter().copied().fold(0.0, f64::max);
        let squares = densities.iter().zip(self.lobe).map(|(a, b)| (a - b) * (a - b));
        (squares.sum::<f64>() / BANDS as f64).sqrt() / peak
    }

    /// The error with `count` facets: the root mean square of several independent runs.
    pub(super) fn error(&self, count: u32) -> f64 {
        let squares = (1..=RUNS).map(|run| {
            let distance = self.distance(&self.tally(count, run).weighted);
            distance * distance
        });
        (squares.sum::<f64>() / RUNS as f64).sqrt()
    }
}

/// Steps each way of a mean over a band.
const STEPS: usize = 32;

impl Experiment {
    /// The mean over a band's width about `psi`: a smooth curve through the means of the bands.
    pub(super) fn smooth(&self, psi: f64) -> f64 {
        mean(psi, self.l, 12)
    }

    /// The angle of incidence, degrees.
    pub(super) fn theta(&self) -> f64 {
        self.theta
    }
}

/// `D(h)/(4 n·l)` for an eye in the plane of incidence, `psi` degrees from the normal.
pub(super) fn lobe(theta: f64, psi: f64) -> f64 {
    reflected(direction(-theta, 0.0), direction(psi, 0.0))
}

fn reflected(l: Dir3, out: Dir3) -> f64 {
    let h = l.halfway(out).map_or(0.0, |h| distribution().density(Lean::of(Dir3::Z, h)));
    f64::from(h / (4.0 * l.dot(Dir3::Z)))
}

/// The direction `psi` degrees from the normal z in the plane of x and z, and `y` out of it.
fn direction(psi: f64, y: f64) -> Dir3 {
    let (sin, cos) = wide::sin_cos(psi.to_radians());
    let flat = (1.0 - y * y).sqrt();
    Dir3::new(Vec3::new((flat * sin) as f32, y as f32, (flat * cos) as f32)).unwrap_or(Dir3::Z)
}

/// The width of a band, degrees.
fn width() -> f64 {
    (RANGE[1] - RANGE[0]) / BANDS as f64
}

/// The angle in the middle of a band, degrees.
fn middle(band: usize) -> f64 {
    RANGE[0] + width() * (band as f64 + 0.5)
}

/// The mean of `D(h)/(4 n·l)` over a band's width about `at`, by the midpoint rule.
fn mean(at: f64, l: Dir3, steps: usize) -> f64 {
    let middle = |step: usize| (step as f64 + 0.5) / steps as f64;
    let mut sum = 0.0;
    for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
        let psi = at + width() * (middle(i) - 0.5);
        let y = OUT_OF_PLANE * (2.0 * middle(j) - 1.0);
        sum += reflected(l, direction(psi, y));
    }
    sum / (steps * steps) as f64
}

/// The band of a direction; `None` for one out of the plane or the range.
fn band(out: Dir3) -> Option<usize> {
    let [x, y, z] = out.to_array().map(f64::from);
    let band = (wide::atan2(x, z).to_degrees() - RANGE[0]) / width();
    let near = y.abs() < OUT_OF_PLANE && (0.0..BANDS as f64).contains(&band);
    near.then_some(band as usize)
}

fn distribution() -> Distribution {
    Distribution::Blinn { n: EXPONENT }
}

/// A facet normal drawn from `D(m)(n·m)`: for Blinn's D, `cos^(n+2)` of its tilt is uniform.
fn facet(seed: u64) -> Dir3 {
    let [u, v] = uniform(seed);
    let cos = wide::pow(u, 1.0 / f64::from(EXPONENT + 2.0));
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let (y, x) = wide::sin_cos(std::f64::consts::TAU * v);
    Dir3::new(Vec3::new((sin * x) as f32, (sin * y) as f32, cos as f32)).unwrap_or(Dir3::Z)
}

/// The slope of a drawn facet, in the plane of the drawing.
pub(super) fn facet_slope(index: u32) -> f64 {
    let m = facet(0x5eed << 32 | u64::from(index)).to_vec();
    f64::from(-m.x / m.z)
}

/// Two independent numbers in (0, 1), by splitmix64: points of a net would converge faster than
/// chance, which is what this experiment is about.
fn uniform(seed: u64) -> [f64; 2] {
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    [1, 2].map(|draw: u64| {
        let state = (2 * seed + draw).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        ((mix(state) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_cast_as_much_shadow_on_the_ground_as_there_is_ground() {
        // 1/(n·m) is a facet's area over its shadow; its mean under D(m)(n·m) is ∫ D.
        let areas = (0..100_000).map(|seed| 1.0 / f64::from(facet(seed).dot(Dir3::Z)));
        let mean = areas.sum::<f64>() / 100_000.0;
        let expected = f64::from((EXPONENT + 2.0) / (EXPONENT + 1.0));
        assert!((mean - expected).abs() < 5e-4, "{mean} for {expected}");
    }
}
