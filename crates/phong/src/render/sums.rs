//! A pixel's samples, summed in f64.

use phong_scene::{Background, Rgb};

use crate::integrator::Radiance;
use crate::reflectance::Terms;

/// The sums of one pixel.
#[derive(Clone, Copy, Default)]
pub(crate) struct Sums {
    terms: [[f64; 3]; 6],
    alpha: f64,
    weight: f64,
}

impl Sums {
    /// Adds a sample; outside a fisheye's image circle, one that brought nothing.
    #[inline]
    pub(crate) fn add(&mut self, radiance: &Radiance, weight: f32) {
        let weight = f64::from(weight);
        self.weight += weight;
        let Terms { background, ambient, diffuse, specular, reflection, transmission } =
            radiance.terms;
        let [to_background, to_ambient, to_diffuse, to_specular, to_reflection, to_transmission] =
            &mut self.terms;
        // A ray brings the background or a surface's terms; what is black changes no sum.
        if !radiance.met {
            add(to_background, weight, background);
            return;
        }
        add(to_ambient, weight, ambient);
        add(to_diffuse, weight, diffuse);
        add(to_specular, weight, specular);
        if !(reflection.is_black() && transmission.is_black()) {
            add(to_reflection, weight, reflection);
            add(to_transmission, weight, transmission);
        }
        self.alpha += weight;
    }

    /// The terms, each resolved to f32, and the coverage.
    #[inline]
    pub(crate) fn resolve(&self, samples: u32, background: Background) -> (Terms, f32) {
        // Signed weights that all but cancel would blow up what little is left.
        let total = self.weight.max(0.25 * f64::from(samples));
        let terms = self
            .terms
            .map(|[r, g, b]| Rgb::new((r / total) as f32, (g / total) as f32, (b / total) as f32));
        let alpha = (self.alpha / total).clamp(0.0, 1.0) as f32;
        (Terms::from_array(terms), coverage(alpha, background))
    }
}

#[inline]
fn add(sum: &mut [f64; 3], weight: f64, term: Rgb) {
    sum[0] += weight * f64::from(term.r);
    sum[1] += weight * f64::from(term.g);
    sum[2] += weight * f64::from(term.b);
}

/// The alpha of a pixel of which surfaces cover `share`.
pub(super) fn coverage(share: f32, background: Background) -> f32 {
    match background {
        Background::Transparent => share,
        Background::Color(_) | Background::Gradient { .. } => 1.0,
    }
}
