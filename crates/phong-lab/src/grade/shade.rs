//! The sum as a program with a mistake computes it.
//!
//! With [`Wrong::default`] nothing is wrong, and the sum is the integrator's, which a test holds.

use phong::light::LightSample;
use phong::math::{Dir3, lobe, pow};
use phong::reflectance::{blinn_phong, phong as phong_model};
use phong::terms::Terms;
use phong_scene::{Model, Rgb};

use super::points::{LightPoint, MaterialHere, Point, Surface};

/// What may be wrong with a renderer's sum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent mistake")]
pub(super) struct Wrong {
    /// What the ambient term is multiplied by.
    pub(super) ambient: Ambient,
    pub(super) diffuse: bool,
    pub(super) specular: bool,
    pub(super) shadows: Shadows,
    /// Diffuse below the horizon is negative.
    pub(super) unclamped_diffuse: bool,
    /// R·E below 0 is raised to the power all the same.
    pub(super) unclamped_specular: bool,
    /// The highlight is not cut where the light is behind the surface.
    pub(super) uncut_specular: bool,
    /// Of R, or of E: the sign.
    pub(super) mirrored: bool,
    pub(super) half: Half,
    pub(super) lobe: Option<Lobe>,
    /// What the exponent is multiplied by.
    pub(super) exponent: f32,
    /// The normal points the other way.
    pub(super) inside_out: bool,
    /// L keeps the length of the way to the light.
    pub(super) long_l: bool,
    /// What the highlight is tinted by besides.
    pub(super) tinted: bool,
    pub(super) times_cosine: bool,
    /// Only the first light counts.
    pub(super) first_light: bool,
    /// Light is divided by the square of its distance.
    pub(super) inverse_square: bool,
    /// Each light's sum is clamped to 1 before it is added.
    pub(super) clamped_lights: bool,
    /// Mirror and glass rays bring nothing.
    pub(super) no_secondary: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ambient {
    Right,
    Missing,
    PerLight,
    NotInShadow,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shadows {
    Right,
    Missing,
    /// Things behind a point light cast shadows too.
    Endless,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Half {
    Right,
    /// L + E, as it is.
    Sum,
    /// (L + E) / 2.
    Mean,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lobe {
    Phong,
    Blinn,
}

impl Default for Wrong {
    fn default() -> Self {
        Self {
            ambient: Ambient::Right,
            diffuse: true,
            specular: true,
            shadows: Shadows::Right,
            unclamped_diffuse: false,
            unclamped_specular: false,
            uncut_specular: false,
            mirrored: false,
            half: Half::Right,
            lobe: None,
            exponent: 1.0,
            inside_out: false,
            long_l: false,
            tinted: false,
            times_cosine: false,
            first_light: false,
            inverse_square: false,
            clamped_lights: false,
            no_secondary: false,
        }
    }
}

/// The sum at a point, computed with a mistake.
pub(super) fn shade(point: &Point, wrong: &Wrong) -> Terms {
    let Some(surface) = &point.surface else {
        return point.terms;
    };
    let mut sum = Terms { ambient: ambient(surface, wrong), ..point.terms };
    if wrong.no_secondary {
        (sum.reflection, sum.transmission) = (Rgb::BLACK, Rgb::BLACK);
    }
    let lights = if wrong.first_light { 1 } else { surface.lights.len() };
    for light in surface.lights.iter().take(lights) {
        let (mut diffuse, mut specular) = one_light(surface, light, wrong);
        if wrong.clamped_lights {
            diffuse = diffuse.map(|v| v.min(1.0));
            let total = (diffuse + specular).map(|v| v.min(1.0));
            specular = total - diffuse;
        }
        if wrong.diffuse {
            sum.diffuse += diffuse;
        }
        if wrong.specular {
            sum.specular += specular;
        }
    }
    sum
}

fn ambient(surface: &Surface, wrong: &Wrong) -> Rgb {
    match wrong.ambient {
        Ambient::Right => surface.ambient,
        Ambient::Missing => Rgb::BLACK,
        Ambient::PerLight => surface.ambient * surface.lights.len() as f32,
        Ambient::NotInShadow => {
            let blocked = |light: &LightPoint| light.above && !light.visible;
            if surface.lights.iter().any(blocked) && !surface.lights.iter().any(|l| l.visible) {
                Rgb::BLACK
            } else {
                surface.ambient
            }
        }
    }
}

/// Diffuse and specular of one light.
fn one_light(surface: &Surface, light: &LightPoint, wrong: &Wrong) -> (Rgb, Rgb) {
    let seen = match wrong.shadows {
        Shadows::Right => light.visible,
        Shadows::Missing => light.above,
        Shadows::Endless => light.clear,
    };
    // Of a light behind the surface our own picture says nothing, so nothing stands in its way.
    let behind = !light.above;
    let reaches_behind = wrong.unclamped_diffuse
        || wrong.unclamped_specular
        || wrong.uncut_specular
        || wrong.inside_out;
    if !(seen || behind && reaches_behind || wrong.inside_out) {
        return (Rgb::BLACK, Rgb::BLACK);
    }
    let factor = if wrong.inverse_square && light.distance.is_finite() {
        1.0 / (light.distance * light.distance)
    } else {
        1.0
    };
    let sample = LightSample {
        l: light.l,
        distance: light.distance,
        color: light.color * factor,
        specular_color: light.specular_color * factor,
    };
    let MaterialHere { written, ready: material } = &*surface.material;
    let n = if wrong.inside_out { -surface.ng } else { surface.n };
    if !matches!(
        written.model,
        Model::Lambert | Model::Phong | Model::BlinnPhong | Model::BlinnFast
    ) {
        let e = if wrong.mirrored { -surface.e } else { surface.e };
        let terms = material.shade_light(n, surface.tangent, e, surface.color, &sample);
        return (terms.diffuse, terms.specular);
    }
    let incident = material.incident(n, surface.color, &sample);
    let length = if wrong.long_l && light.distance.is_finite() { light.distance } else { 1.0 };
    let n_dot_l = n.dot(light.l) * length;
    let cosine = if wrong.unclamped_diffuse { n_dot_l } else { n_dot_l.max(0.0) };
    let diffuse = written.k_d * cosine * incident.c_d;
    let cut = n_dot_l <= 0.0 && !(wrong.uncut_specular || wrong.unclamped_specular);
    if cut || written.model == Model::Lambert {
        return (diffuse, Rgb::BLACK);
    }
    let tint = if wrong.tinted { surface.color } else { Rgb::WHITE };
    let own = if written.model == Model::Phong { Lobe::Phong } else { Lobe::Blinn };
    let e = material.eye(surface.e);
    let base = base(n, light.l, e, length, wrong.lobe.unwrap_or(own), wrong);
    let alpha = written.shininess * wrong.exponent;
    let power = match (written.model, wrong.lobe) {
        (Model::BlinnFast, None) => blinn_phong::rational_lobe(base, alpha),
        _ => raised(base, alpha, wrong.unclamped_specular),
    };
    let mut scale = written.k_s;
    if written.times_cosine || wrong.times_cosine {
        scale *= n_dot_l.max(0.0);
    }
    if written.normalize {
        scale *= match own {
            Lobe::Phong => phong_model::normalization(written.shininess, written.times_cosine),
            Lobe::Blinn => blinn_phong::normalization(written.shininess, written.times_cosine),
        };
    }
    (diffuse, scale * power * incident.c_s * tint)
}

/// R·E or N·H.
fn base(n: Dir3, l: Dir3, e: Dir3, length: f32, lobe: Lobe, wrong: &Wrong) -> f32 {
    let sign = if wrong.mirrored { -1.0 } else { 1.0 };
    match lobe {
        Lobe::Phong => sign * length * n.mirror(l).dot(e),
        Lobe::Blinn => {
            let sum = length * l.to_vec() + sign * e.to_vec();
            let along = n.to_vec().dot(sum);
            match wrong.half {
                Half::Right => along / sum.length().max(f32::MIN_POSITIVE),
                Half::Sum => along,
                Half::Mean => 0.5 * along,
            }
        }
    }
}

/// A power as a program takes it that does, or does not, clamp its base first.
fn raised(base: f32, alpha: f32, unclamped: bool) -> f32 {
    if base > 1.0 {
        // Not a cosine: a vector was not normalised.
        return pow(base, alpha);
    }
    if base > 0.0 || !unclamped {
        return lobe(base, alpha);
    }
    // std::pow of a negative base: its sign for an odd exponent, NaN for a fraction.
    match alpha {
        a if a.fract() != 0.0 => 0.0,
        a if a % 2.0 == 0.0 => lobe(-base, a),
        a => -lobe(-base, a),
    }
}
