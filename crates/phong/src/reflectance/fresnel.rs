//! Fresnel reflectance: the share of light that a smooth boundary mirrors, unpolarised.

use std::f32::consts::FRAC_2_PI;

use phong_bvh::Lanes;
use phong_scene::Rgb;

use crate::math::acos;

/// The Fresnel reflectance of microfacets at a point.
pub type Fresnel = phong_scene::Fresnel<f32, Rgb>;

/// The share of light that facets of this kind mirror, per channel, in [0, 1], at the angle of
/// incidence whose cosine is `cos`.
pub fn mirrored(facets: Fresnel, cos: f32) -> Rgb {
    match facets {
        Fresnel::None => Rgb::WHITE,
        Fresnel::Schlick { f0 } => f0.map(|f0| schlick(cos, f0)),
        Fresnel::Conductor { eta, k } => Rgb::new(
            conductor(cos, eta.r, k.r),
            conductor(cos, eta.g, k.g),
            conductor(cos, eta.b, k.b),
        ),
        Fresnel::Dielectric { eta } => Rgb::grey(dielectric(cos, eta)),
    }
}

/// `F₀ + (1 − F₀)(1 − cos)⁵`: Schlick's approximation (1994).
pub fn schlick(cos: f32, f0: f32) -> f32 {
    let x = 1.0 - cos;
    let x2 = x * x;
    f0 + (1.0 - f0) * (x2 * x2 * x)
}

/// POV-Ray's fit to a metal's reflectance, which its `metallic` highlights go by:
/// `0.014567225/(x − 1.12)² − 0.011612903` in [0, 1], `x` the angle of incidence in right angles.
///
/// 0 face on, 1 at grazing angles.
pub fn pov_ray(cos: f32) -> f32 {
    let x = FRAC_2_PI * acos(cos.clamp(0.0, 1.0)) - 1.12;
    (0.014_567_225 / (x * x) - 0.011_612_903).clamp(0.0, 1.0)
}

/// The exact reflectance between two dielectrics; `eta = n_t / n_i`, inside over outside as the
/// light meets them. 1 under total internal reflection.
///
/// `F = (r∥² + r⊥²)/2` with `r∥ = (η c − c_t)/(η c + c_t)`, `r⊥ = (c − η c_t)/(c + η c_t)`, and by
/// Snell `sin θ_t = sin θ / η`.
pub fn dielectric(cos: f32, eta: f32) -> f32 {
    boundary(cos, eta)
}

/// [`dielectric`] of one ray, or of eight.
#[inline(always)]
pub(crate) fn boundary<F: Lanes<Scalar = f32>>(cos: F, eta: F) -> F {
    let one = cos.splat(1.0);
    let sin2_t = (one - cos) * (one + cos) / (eta * eta);
    let cos_t = (one - sin2_t).at_least(0.0).sqrt();
    let parallel = (eta * cos - cos_t) / (eta * cos + cos_t);
    let perpendicular = (cos - eta * cos_t) / (cos + eta * cos_t);
    let share = (parallel * parallel + perpendicular * perpendicular) * 0.5;
    F::select(sin2_t.lt(one), share, one)
}

/// The exact reflectance of a conductor whose index, relative to the outside, is `η + i k`.
///
/// With `a + i b = √((η + i k)² − sin² θ)`: `R⊥ = ((a − c)² + b²)/((a + c)² + b²)`,
/// `R∥ = R⊥ ((a c − s²)² + b² c²)/((a c + s²)² + b² c²)`, `F = (R⊥ + R∥)/2`.
pub fn conductor(cos: f32, eta: f32, k: f32) -> f32 {
    if cos <= 0.0 {
        return 1.0;
    }
    let sin2 = (1.0 - cos) * (1.0 + cos);
    let (a, b) = complex_sqrt((eta - k) * (eta + k) - sin2, 2.0 * eta * k);
    let norm2 = |re: f32, im: f32| re * re + im * im;
    let perpendicular = norm2(a - cos, b) / norm2(a + cos, b);
    let parallel = perpendicular * norm2(a * cos - sin2, b * cos) / norm2(a * cos + sin2, b * cos);
    0.5 * (perpendicular + parallel)
}

/// The root of `re + i im` (`im` ≥ 0) in the first quadrant; neither part by a difference of
/// nearly equal numbers.
fn complex_sqrt(re: f32, im: f32) -> (f32, f32) {
    let larger = (0.5 * ((re * re + im * im).sqrt() + re.abs())).sqrt();
    if larger == 0.0 {
        return (0.0, 0.0);
    }
    let smaller = 0.5 * im / larger;
    if re >= 0.0 { (larger, smaller) } else { (smaller, larger) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_mirrors_four_percent_face_on() {
        // ((1.5 − 1)/(1.5 + 1))² = 0.04
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-8);
        assert!((conductor(1.0, 1.5, 0.0) - 0.04).abs() < 1e-8);
        assert!((dielectric(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-7);
    }

    #[test]
    fn at_brewsters_angle_half_of_one_polarisation_is_all_that_is_left() {
        // tan θ = 1.5: cos θ = 2/√13. r∥ = 0; r⊥ = (1 − η²)/(1 + η²) = −5/13: F = 25/338.
        let cos = 2.0 / 13.0_f32.sqrt();
        assert!((dielectric(cos, 1.5) - 25.0 / 338.0).abs() < 1e-7);
    }

    #[test]
    fn beyond_the_critical_angle_all_light_stays_inside() {
        // sin θ > 1/1.5, so cos θ < √5/3 = 0.7454
        assert_eq!(dielectric(0.74, 1.0 / 1.5), 1.0);
        assert!(dielectric(0.75, 1.0 / 1.5) < 1.0);
    }

    #[test]
    fn grazing_light_is_mirrored_whole() {
        assert_eq!(dielectric(0.0, 1.5), 1.0);
        assert_eq!(dielectric(0.0, 1.0), 1.0);
        assert_eq!(conductor(0.0, 0.2, 3.9), 1.0);
        assert_eq!(conductor(0.0, 1.0, 0.0), 1.0);
        assert_eq!(schlick(0.0, 0.04), 1.0);
    }

    #[test]
    fn a_metal_face_on_follows_the_textbook() {
        // ((η − 1)² + k²)/((η + 1)² + k²) for gold's red, η = 0.143, k = 3.98: 0.9653
        let (eta, k) = (0.143_f32, 3.98_f32);
        let (low, high, k2) = (eta - 1.0, eta + 1.0, k * k);
        let expected = (low * low + k2) / (high * high + k2);
        assert!((conductor(1.0, eta, k) - expected).abs() < 1e-6);
    }

    #[test]
    fn a_conductor_that_absorbs_nothing_is_a_dielectric() {
        for eta in [0.5, 0.9, 1.1, 1.5, 2.4] {
            for i in 1..=50 {
                let cos = i as f32 / 50.0;
                let (a, b) = (conductor(cos, eta, 0.0), dielectric(cos, eta));
                assert!((a - b).abs() < 2e-6, "eta {eta}, cos {cos}: {a} and {b}");
            }
        }
    }

    #[test]
    fn pov_rays_fit_runs_from_0_to_1() {
        assert!(pov_ray(1.0).abs() < 1e-6);
        assert!((pov_ray(0.0) - 1.0).abs() < 1e-6);
        // 60° is x = 2/3: 0.014567225/0.45333² − 0.011612903 = 0.05927
        assert!((pov_ray(0.5) - 0.059_269).abs() < 1e-5);
    }

    #[test]
    fn schlick_runs_from_f0_to_1() {
        assert_eq!(schlick(1.0, 0.04), 0.04);
        // 0.04 + 0.96/32
        assert!((schlick(0.5, 0.04) - 0.07).abs() < 1e-8);
    }
}
