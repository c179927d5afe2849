//! Blinn's halfway vector: a highlight where the normal is near the bisector of L and E.

use std::f32::consts::SQRT_2;

use super::scale::{Scale, Switches};
use super::{Incident, Terms};
use crate::math::{Dir3, lobe, pow};

/// `k_d (L·N) C_d + k_s (N·H)^α C_s`, with `H = (L+E)/‖L+E‖`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlinnPhong {
    k_d: f32,
    k_s: f32,
    alpha: f32,
    scale: Scale,
}

impl BlinnPhong {
    /// The model of diffuse weight `k_d` ≥ 0, specular weight `k_s` ≥ 0 and exponent `alpha` ≥ 0.
    ///
    /// `Switches::default()` is the lecture's equation, with H for R.
    pub fn new(k_d: f32, k_s: f32, alpha: f32, switches: Switches) -> Self {
        let scale = Scale::new(switches, || normalization(alpha, switches.times_cosine));
        Self { k_d, k_s, alpha, scale }
    }

    /// What one light above the horizon adds: `k_d (L·N) C_d` and `k_s (N·H)^α C_s`.
    pub(super) fn shade_light(self, n: Dir3, e: Dir3, Incident { l, c_d, c_s }: Incident) -> Terms {
        let Self { k_d, k_s, alpha, scale } = self;
        let n_dot_l = n.cos(l);
        let n_dot_h = l.halfway(e).map_or(0.0, |h| n.cos(h));
        Terms {
            diffuse: k_d * n_dot_l * c_d,
            specular: k_s * scale.at(n_dot_l) * lobe(n_dot_h, alpha) * c_s,
            ..Terms::default()
        }
    }
}

/// π times the factor that gives Blinn's lobe the energy 1 at normal incidence, exactly.
///
/// Times the cosine, `(n+2)(n+4)/(8(2^(−n/2)+n))`: the BRDF of Giesen's derivation; alone,
/// `(n+2)/(4(2−2^(−n/2)))`: `OSPRay`, POV-Ray's `albedo`.
pub fn normalization(alpha: f32, times_cosine: bool) -> f32 {
    let n = alpha;
    let tail = pow(1.0 / SQRT_2, n); // 2^(−n/2)
    if times_cosine {
        (n + 2.0) / 8.0 * ((n + 4.0) / (tail + n))
    } else {
        (n + 2.0) / (4.0 * (2.0 - tail))
    }
}
