//! How many facets are hidden, from the light or from the eye, by others.

use phong_scene::Shadowing;

use super::{Distribution, Lean};

/// G: the share of the facets facing `h` that light reaches and eye sees, in [0, 1].
///
/// `l`, `e`, `h` are leans from the normal, all above the horizon; `e_dot_h` = E·H = L·H > 0.
///
/// - separable, light and eye independent: `1/((1+Λ(L))(1+Λ(E)))` (Smith 1967)
/// - correlated, by height: `1/(1+Λ(L)+Λ(E))`
/// - V-cavities: `min(1, 2(N·H)(N·E)/(E·H), 2(N·H)(N·L)/(E·H))` (Cook and Torrance 1982)
/// - implicit: `(N·L)(N·E)`, which cancels the BRDF's denominator
pub fn visible(
    shadowing: Shadowing,
    facets: Distribution,
    [l, e, h]: [Lean; 3],
    e_dot_h: f32,
) -> f32 {
    match shadowing {
        Shadowing::Separable => 1.0 / ((1.0 + facets.lambda(l)) * (1.0 + facets.lambda(e))),
        Shadowing::Correlated => 1.0 / (1.0 + facets.lambda(l) + facets.lambda(e)),
        Shadowing::VCavity => (2.0 * h.cos * e.cos.min(l.cos) / e_dot_h).min(1.0),
        Shadowing::Implicit => l.cos * e.cos,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smiths_two_forms_from_the_same_lambdas() {
        // α tan θ = 1 for both: Λ = (√2 − 1)/2.
        let facets = Distribution::Ggx { alpha: 0.25 };
        let v = Lean { cos: (1.0_f32 / 17.0).sqrt(), sin2: 16.0 / 17.0 };
        let lambda = 0.5 * (2.0_f32.sqrt() - 1.0);
        let visible = |g| visible(g, facets, [v, v, Lean::from_cos(1.0)], v.cos);
        let separable = 1.0 / ((1.0 + lambda) * (1.0 + lambda));
        assert!((visible(Shadowing::Separable) - separable).abs() < 1e-6);
        assert!((visible(Shadowing::Correlated) - 1.0 / (1.0 + 2.0 * lambda)).abs() < 1e-6);
    }

    #[test]
    fn grooves_hide_nothing_until_the_geometry_says_so() {
        let facets = Distribution::Ggx { alpha: 0.25 };
        let visible = |l: f32, e: f32, h: f32, e_dot_h: f32| {
            visible(Shadowing::VCavity, facets, [l, e, h].map(Lean::from_cos), e_dot_h)
        };
        assert_eq!(visible(0.9, 0.9, 1.0, 0.9), 1.0);
        assert!((visible(0.2, 0.9, 0.8, 0.5) - 0.64).abs() < 1e-6); // 2 · 0.8 · 0.2/0.5
        assert!((visible(0.9, 0.1, 0.8, 0.5) - 0.32).abs() < 1e-6); // 2 · 0.8 · 0.1/0.5
    }

    #[test]
    fn the_implicit_form_cancels_the_denominator() {
        let facets = Distribution::Blinn { n: 30.0 };
        let leans = [0.5, 0.25, 0.9].map(Lean::from_cos);
        assert_eq!(visible(Shadowing::Implicit, facets, leans, 0.7), 0.125);
    }
}
