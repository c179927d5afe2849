//! Phong's model: a highlight around the mirror image of the light.

use super::scale::{Scale, Switches};
use super::{Incident, Terms};
use crate::math::{Dir3, lobe};

/// `k_d (L·N) C_d + k_s (R·E)^α C_s`, with `R = 2(L·N)N − L`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    k_d: f32,
    k_s: f32,
    alpha: f32,
    scale: Scale,
}

impl Phong {
    /// The model of diffuse weight `k_d` ≥ 0, specular weight `k_s` ≥ 0 and exponent `alpha` ≥ 0.
    ///
    /// `Switches::default()` is the lecture's equation.
    pub fn new(k_d: f32, k_s: f32, alpha: f32, switches: Switches) -> Self {
        let scale = Scale::new(switches, || normalization(alpha, switches.times_cosine));
        Self { k_d, k_s, alpha, scale }
    }

    /// What one light above the horizon adds: `k_d (L·N) C_d` and `k_s (R·E)^α C_s`.
    pub(super) fn shade_light(self, n: Dir3, e: Dir3, Incident { l, c_d, c_s }: Incident) -> Terms {
        let Self { k_d, k_s, alpha, scale } = self;
        let n_dot_l = n.cos(l);
        let r = n.mirror(l);
        Terms {
            diffuse: k_d * n_dot_l * c_d,
            specular: k_s * scale.at(n_dot_l) * lobe(r.cos(e), alpha) * c_s,
            ..Terms::default()
        }
    }
}

/// π times the factor that gives Phong's lobe the energy 1 at normal incidence.
///
/// Times the cosine, `(n+2)/2`: modified Phong, the BRDF `(n+2)/2π (R·E)^n`; alone, `(n+1)/2`:
/// POV-Ray's `albedo`. The π is there because a light's colour is what white Lambert gives back.
pub fn normalization(alpha: f32, times_cosine: bool) -> f32 {
    0.5 * (alpha + if times_cosine { 2.0 } else { 1.0 })
}
