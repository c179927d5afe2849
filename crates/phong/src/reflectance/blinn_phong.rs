//! Blinn's halfway vector: a highlight where the normal is near the bisector of L and E.

use std::f32::consts::SQRT_2;

use super::Incident;
use super::scale::{Scale, Switches};
use crate::math::lanes::{add, dot, normalize};
use crate::math::{Dir3, Lobe, pow};
use crate::terms::Terms;

/// `k_d (L·N) C_d + k_s (N·H)^α C_s`, with `H = (L+E)/‖L+E‖`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlinnPhong {
    k_d: f32,
    k_s: f32,
    alpha: f32,
    falloff: Falloff,
    scale: Scale,
}

/// How the highlight falls off with `x = N·H`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Falloff {
    /// `x^α`.
    #[default]
    Power,
    /// `x / (α − α x + x)`: Schlick's cheap stand-in (Graphics Gems IV, 1994), with the same peak
    /// and slope there, and a longer tail; Tachyon's "fast" lobe. It has no normalisation of its
    /// own, and takes the power's.
    Rational,
}

impl BlinnPhong {
    /// The model of diffuse weight `k_d` ≥ 0, specular weight `k_s` ≥ 0 and exponent `alpha` ≥ 0.
    ///
    /// `Switches::default()` is the lecture's equation, with H for R.
    pub fn new(k_d: f32, k_s: f32, alpha: f32, switches: Switches) -> Self {
        let scale = Scale::new(switches, || normalization(alpha, switches.times_cosine));
        Self { k_d, k_s, alpha, falloff: Falloff::Power, scale }
    }

    /// The same model with another falloff.
    #[must_use]
    pub fn with_falloff(self, falloff: Falloff) -> Self {
        Self { falloff, ..self }
    }

    /// What one light above the horizon adds: `k_d (L·N) C_d` and `k_s (N·H)^α C_s`.
    #[inline]
    pub(super) fn shade_light(self, n: Dir3, e: Dir3, incident: Incident) -> Terms {
        let Incident { l, c_d, c_s, .. } = incident;
        let [diffuse, specular] = self.weights(n.to_array(), e.to_array(), l.to_array());
        Terms { diffuse: diffuse * c_d, specular: specular * c_s, ..Terms::default() }
    }

    /// `k_d (L·N)` and `k_s (N·H)^α`, for one light or eight.
    #[inline(always)]
    pub(super) fn weights<F: Lobe>(self, n: [F; 3], e: [F; 3], l: [F; 3]) -> [F; 2] {
        let Self { k_d, k_s, alpha, falloff, scale } = self;
        let n_dot_l = dot(n, l).at_least(0.0);
        let n_dot_h = dot(n, normalize(add(l, e))).at_least(0.0);
        let lobe = match falloff {
            Falloff::Power => n_dot_h.lobe(alpha),
            Falloff::Rational => n_dot_h.map(|x| rational_lobe(x, alpha)),
        };
        [n_dot_l * k_d, scale.at(n_dot_l) * k_s * lobe]
    }
}

/// `x / (α − α x + x)` for a cosine `x`, and 0 for `x ≤ 0`; 1 for `x ≥ 1`.
pub fn rational_lobe(x: f32, alpha: f32) -> f32 {
    if x <= 0.0 { 0.0 } else { x.min(1.0) / (alpha * (1.0 - x).max(0.0) + x.min(1.0)) }
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

/// The short form of [`normalization`] times the cosine that many programs use: `(n+8)/8`.
///
/// 2.4 % too bright at n = 1, 7.5 % at 9, 1 % at 200.
pub fn short_normalization(alpha: f32) -> f32 {
    (alpha + 8.0) / 8.0
}

#[cfg(test)]
mod tests {
    use super::super::tests::{dir, white};
    use super::*;

    const LECTURE: Switches = Switches { times_cosine: false, normalize: false };

    fn specular(model: BlinnPhong, l: Dir3, e: Dir3) -> f32 {
        model.shade_light(Dir3::Z, e, white(l)).specular.r
    }

    #[test]
    fn a_worked_example() {
        // L = (0.6, 0, 0.8), E = N: L + E = (0.6, 0, 1.8), N·H = 1.8/√3.6 = √0.9.
        let model = BlinnPhong::new(0.5, 0.25, 4.0, LECTURE);
        let terms = model.shade_light(Dir3::Z, Dir3::Z, white(dir(0.6, 0.0, 0.8)));
        assert!((terms.diffuse.r - 0.4).abs() < 1e-7); // 0.5 × 0.8
        assert!((terms.specular.r - 0.2025).abs() < 1e-7); // 0.25 × 0.9²
    }

    #[test]
    fn the_peak_is_k_s_where_the_normal_halves_light_and_eye() {
        let model = BlinnPhong::new(0.0, 0.75, 200.0, LECTURE);
        let peak = specular(model, dir(3.0, 0.0, 4.0), dir(-3.0, 0.0, 4.0));
        assert!((peak - 0.75).abs() < 1e-5, "{peak}");
    }

    #[test]
    fn light_and_eye_may_change_places_but_for_the_cosine() {
        let model = BlinnPhong::new(0.0, 1.0, 30.0, LECTURE);
        let (a, b) = (dir(0.5, 0.1, 0.8), dir(-0.3, 0.2, 0.4));
        assert_eq!(specular(model, a, b), specular(model, b, a));
    }

    #[test]
    fn the_rational_falloff_keeps_the_peak_and_lengthens_the_tail() {
        let power = BlinnPhong::new(0.0, 1.0, 10.0, LECTURE);
        let rational = power.with_falloff(Falloff::Rational);
        assert_eq!(specular(rational, Dir3::Z, Dir3::Z), 1.0);
        // N·H = √0.9: x/(10 − 9x) = 0.948683/1.461851
        let found = specular(rational, dir(0.6, 0.0, 0.8), Dir3::Z);
        assert!((found - 0.648_960).abs() < 1e-5, "{found}");
        assert!(found > specular(power, dir(0.6, 0.0, 0.8), Dir3::Z));
        assert_eq!([rational_lobe(0.0, 0.0), rational_lobe(-1.0, 5.0)], [0.0, 0.0]);
        assert_eq!(rational_lobe(0.3, 0.0), 1.0);
    }

    #[test]
    fn normalized_face_on_the_factors_are_seen_bare() {
        let at_peak = |n, times_cosine| {
            let switches = Switches { times_cosine, normalize: true };
            specular(BlinnPhong::new(0.0, 1.0, n, switches), Dir3::Z, Dir3::Z)
        };
        assert_eq!(at_peak(0.0, false), 0.5); // 2/(4 (2 − 1))
        assert_eq!(at_peak(2.0, false), 4.0 / 6.0); // 4/(4 (2 − ½))
        assert_eq!(at_peak(0.0, true), 1.0); // 2·4/(8 (1 + 0))
        assert_eq!(at_peak(2.0, true), 1.2); // 4·6/(8 (½ + 2))
    }
}
