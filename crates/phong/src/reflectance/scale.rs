//! What programs that say "Phong" multiply the lobe by, beside `k_s`.

use phong_bvh::Lanes;

/// The two of the four dialect switches that concern the lobe. The lecture: both off.
///
/// (The other two, tint and ambient, concern colours, and are the integrator's.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switches {
    /// Whether the specular term is multiplied by N·L, as the diffuse one is.
    pub times_cosine: bool,
    /// Whether the lobe is scaled so that a higher exponent is narrower *and brighter*, with the
    /// same energy in it.
    pub normalize: bool,
}

/// A factor on the lobe, and whether N·L is one more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    factor: f32,
    times_cosine: bool,
}

impl Scale {
    /// The scale that `switches` ask for; `factor` is the model's normalisation.
    pub(super) fn new(switches: Switches, factor: impl Fn() -> f32) -> Self {
        let factor = if switches.normalize { factor() } else { 1.0 };
        Self { factor, times_cosine: switches.times_cosine }
    }

    /// The scale under light that falls in at cosine `n_dot_l`.
    #[inline(always)]
    pub(super) fn at<F: Lanes<Scalar = f32>>(self, n_dot_l: F) -> F {
        if self.times_cosine { n_dot_l * self.factor } else { n_dot_l.splat(self.factor) }
    }
}
