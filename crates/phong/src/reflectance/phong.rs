//! Phong's model: a highlight around the mirror image of the light.

use super::Incident;
use super::scale::{Scale, Switches};
use crate::math::lanes::{dot, mirror};
use crate::math::{Dir3, Lobe};
use crate::terms::Terms;

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
    #[inline]
    pub(super) fn shade_light(self, n: Dir3, e: Dir3, incident: Incident) -> Terms {
        let Incident { l, c_d, c_s, .. } = incident;
        let [diffuse, specular] = self.weights(n.to_array(), e.to_array(), l.to_array());
        Terms { diffuse: diffuse * c_d, specular: specular * c_s, ..Terms::default() }
    }

    /// `k_d (L·N)` and `k_s (R·E)^α`, for one light or eight.
    #[inline(always)]
    pub(super) fn weights<F: Lobe>(self, n: [F; 3], e: [F; 3], l: [F; 3]) -> [F; 2] {
        let Self { k_d, k_s, alpha, scale } = self;
        let n_dot_l = dot(n, l).at_least(0.0);
        let r_dot_e = dot(mirror(n, l), e).at_least(0.0);
        [n_dot_l * k_d, scale.at(n_dot_l) * k_s * r_dot_e.lobe(alpha)]
    }
}

/// π times the factor that gives Phong's lobe the energy 1 at normal incidence.
///
/// Times the cosine, `(n+2)/2`: modified Phong, the BRDF `(n+2)/2π (R·E)^n`; alone, `(n+1)/2`:
/// POV-Ray's `albedo`. The π is there because a light's colour is what white Lambert gives back.
pub fn normalization(alpha: f32, times_cosine: bool) -> f32 {
    0.5 * (alpha + if times_cosine { 2.0 } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use phong_scene::Rgb;

    use super::super::tests::{dir, white};
    use super::*;

    const LECTURE: Switches = Switches { times_cosine: false, normalize: false };

    fn specular(k_s: f32, alpha: f32, switches: Switches, l: Dir3, e: Dir3) -> f32 {
        Phong::new(0.0, k_s, alpha, switches).shade_light(Dir3::Z, e, white(l)).specular.r
    }

    #[test]
    fn a_worked_example() {
        // L = (0.6, 0, 0.8), so R = (−0.6, 0, 0.8); E = N: R·E = L·N = 0.8.
        let model = Phong::new(0.5, 0.25, 2.0, LECTURE);
        let terms = model.shade_light(Dir3::Z, Dir3::Z, white(dir(0.6, 0.0, 0.8)));
        assert!((terms.diffuse.r - 0.4).abs() < 1e-7); // 0.5 × 0.8
        assert!((terms.specular.r - 0.16).abs() < 1e-7); // 0.25 × 0.8²
    }

    #[test]
    fn the_peak_is_k_s_and_lies_opposite_the_light_at_the_same_height() {
        let l = dir(3.0, 0.0, 4.0);
        for alpha in [0.0, 3.0, 9.0, 200.0] {
            let peak = specular(0.75, alpha, LECTURE, l, dir(-3.0, 0.0, 4.0));
            assert!((peak - 0.75).abs() < 1e-7 * (1.0 + alpha), "{peak}");
        }
    }

    #[test]
    fn with_the_wrong_sign_of_r_an_even_exponent_would_hide_it_but_not_here() {
        // −R·E is −1 where R·E is 1: clamped, not raised to an even power.
        let l = dir(3.0, 0.0, 4.0);
        assert_eq!(specular(1.0, 2.0, LECTURE, l, dir(3.0, 0.0, -4.0)), 0.0);
    }

    #[test]
    fn exponent_0_is_a_constant_in_front_of_r_and_0_behind() {
        let l = dir(3.0, 0.0, 4.0);
        assert_eq!(specular(0.5, 0.0, LECTURE, l, dir(-1.0, 1.0, 0.0)), 0.5);
        assert_eq!(specular(0.5, 0.0, LECTURE, l, dir(1.0, 1.0, 0.0)), 0.0);
    }

    #[test]
    fn times_cosine_multiplies_the_highlight_and_leaves_diffuse() {
        let times_cosine = Switches { times_cosine: true, normalize: false };
        let incident = white(dir(0.6, 0.0, 0.8));
        let plain = Phong::new(0.5, 0.25, 2.0, LECTURE).shade_light(Dir3::Z, Dir3::Z, incident);
        let times =
            Phong::new(0.5, 0.25, 2.0, times_cosine).shade_light(Dir3::Z, Dir3::Z, incident);
        assert_eq!(times.diffuse, plain.diffuse);
        assert!((times.specular.r - 0.8 * plain.specular.r).abs() < 1e-8);
    }

    #[test]
    fn normalized_it_is_pov_rays_albedo_or_modified_phong() {
        // Face on every lobe is 1, so that the factors are seen bare.
        let at_peak = |times_cosine| {
            let switches = Switches { times_cosine, normalize: true };
            specular(1.0, 9.0, switches, Dir3::Z, Dir3::Z)
        };
        assert_eq!(at_peak(false), 5.0); // (9 + 1)/2
        assert_eq!(at_peak(true), 5.5); // (9 + 2)/2
    }

    #[test]
    fn moving_the_eye_moves_the_highlight_and_leaves_diffuse() {
        let model = Phong::new(0.5, 0.25, 9.0, LECTURE);
        let l = white(dir(0.6, 0.0, 0.8));
        let [a, b] = [Dir3::Z, dir(-0.5, 0.2, 0.8)].map(|e| model.shade_light(Dir3::Z, e, l));
        assert_eq!(a.diffuse, b.diffuse);
        assert_ne!(a.specular, b.specular);
        assert_eq!(a.ambient, Rgb::BLACK);
    }
}
