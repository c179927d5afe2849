//! The renderer's own formulas at vectors of your choosing.
//!
//! For checking a hand calculation, a student's code, or us: every answer comes from the very
//! functions that the integrator calls, in f32. There is no second implementation.
//!
//! ```
//! use phong_lab::eval::{Query, Value};
//! // cos(60°)³
//! let query = Query::CosPower { x_deg: 60.0, i: 3.0 };
//! assert_eq!(query.value(), Ok(Value::Number(0.125)));
//! ```

mod answer;
mod line;
mod query;
mod table;

use std::f32::consts::FRAC_1_PI;

use phong::math::{Dir3, lobe};
use phong::reflectance::microfacet::Lean;
use phong::reflectance::{
    BlinnPhong, Distribution, Fresnel, Incident, Lambert, Microfacet, NARROWEST, OrenNayar,
    OrenNayarForm, Phong, Reflectance, Shadowing, Switches, Ward, WardForm, blinn_phong, fresnel,
    phong as phong_model,
};
use phong::terms::Terms;
use phong_scene::Rgb;
use thiserror::Error;

pub use answer::answer;
pub use query::read;
pub use table::{Column, Table, WrongRow};

/// N, L and E: all unit, all away from the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directions {
    /// The normal.
    pub n: Dir3,
    /// To the light.
    pub l: Dir3,
    /// To the eye.
    pub e: Dir3,
}

/// The lobe of the lecture's highlight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// `(R·E)^α`.
    Phong,
    /// `(N·H)^α`.
    Blinn,
}

/// A formula, and where to evaluate it.
///
/// Lobes are 0 where N·L ≤ 0, and where their cosine is ≤ 0, also at α = 0. BRDFs, per steradian
/// and without the cosine, are 0 where N·L ≤ 0 or N·E ≤ 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Query {
    /// `R = 2(L·N)N − L`.
    Reflect {
        /// The normal.
        n: Dir3,
        /// To the light.
        l: Dir3,
    },
    /// `H = (L+E)/‖L+E‖`.
    Half {
        /// To the light.
        l: Dir3,
        /// To the eye.
        e: Dir3,
    },
    /// `max(0, N·L)`.
    Lambert {
        /// The normal.
        n: Dir3,
        /// To the light.
        l: Dir3,
    },
    /// `(R·E)^α` or `(N·H)^α`.
    Specular {
        /// Which of the two.
        lobe: Lobe,
        /// Where.
        at: Directions,
        /// The exponent, ≥ 0.
        alpha: f32,
    },
    /// The lecture's equation, for any number of lights.
    Sum {
        /// Which lobe.
        lobe: Lobe,
        /// The normal.
        n: Dir3,
        /// To the eye.
        e: Dir3,
        /// `k_a`.
        k_a: f32,
        /// `k_d`.
        k_d: f32,
        /// `k_s`.
        k_s: f32,
        /// The exponent, ≥ 0.
        alpha: f32,
        /// `C_a`, light times material.
        c_a: Rgb,
        /// L, `C_d` and `C_s` of each light, light times material.
        lights: Vec<Incident>,
    },
    /// `cos(x)^i`, clamped.
    CosPower {
        /// The angle, degrees.
        x_deg: f32,
        /// The exponent, ≥ 0.
        i: f32,
    },
    /// `k_d/π + k_s (n+2)/2π (R·E)^n`.
    ModifiedPhongBrdf {
        /// Where.
        at: Directions,
        /// Diffuse albedo.
        k_d: f32,
        /// Specular albedo at normal incidence.
        k_s: f32,
        /// The exponent, ≥ 0.
        n: f32,
    },
    /// `k_d/π + k_s (n+2)(n+4)/(8π(2^(−n/2)+n)) (N·H)^n`, or the short form `(n+8)/8π`.
    BlinnPhongBrdf {
        /// Where.
        at: Directions,
        /// Diffuse albedo.
        k_d: f32,
        /// Specular albedo at normal incidence.
        k_s: f32,
        /// The exponent, ≥ 0.
        n: f32,
        /// The exact factor, else the short one.
        exact: bool,
    },
    /// `F₀ + (1 − F₀)(1 − cos)⁵`.
    Schlick {
        /// Cosine of the angle of incidence, in [0, 1].
        cos: f32,
        /// Reflectance at normal incidence.
        f0: f32,
    },
    /// The exact reflectance between dielectrics.
    Dielectric {
        /// Cosine of the angle of incidence, in [0, 1].
        cos: f32,
        /// `n_t / n_i`, > 0.
        eta: f32,
    },
    /// The exact reflectance of a conductor.
    Conductor {
        /// Cosine of the angle of incidence, in [0, 1].
        cos: f32,
        /// Real part of the index, > 0.
        eta: f32,
        /// Imaginary part, ≥ 0.
        k: f32,
    },
    /// `D G F / (4 (N·L)(N·E))`.
    MicrofacetBrdf {
        /// Where.
        at: Directions,
        /// D.
        distribution: Distribution,
        /// G.
        shadowing: Shadowing,
        /// F.
        fresnel: Fresnel,
    },
    /// D, facets per steradian.
    Density {
        /// Which.
        distribution: Distribution,
        /// N·H, in [−1, 1].
        n_dot_h: f32,
    },
    /// Smith's Λ.
    Lambda {
        /// Of which distribution.
        distribution: Distribution,
        /// Cosine of the angle to the normal, in (0, 1].
        cos: f32,
    },
    /// Oren and Nayar's BRDF.
    OrenNayarBrdf {
        /// Where.
        at: Directions,
        /// ρ, the albedo of a facet.
        rho: f32,
        /// σ, radians, ≥ 0.
        sigma: f32,
        /// Qualitative or full.
        form: OrenNayarForm,
    },
    /// Ward's BRDF.
    WardBrdf {
        /// Where.
        at: Directions,
        /// Specular albedo.
        k_s: f32,
        /// X, along the grain.
        x: Dir3,
        /// Roughness along the grain, > 0.
        a_x: f32,
        /// Roughness across it, > 0.
        a_y: f32,
        /// Which denominator.
        form: WardForm,
    },
}

/// An answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f32),
    /// A unit vector.
    Direction(Dir3),
    /// A number per channel.
    Color(Rgb),
}

/// Why there is no answer: the caller's fault, each of them.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EvalError {
    /// A number that must not be negative is.
    #[error("{name} = {value} is negative")]
    Negative {
        /// Its name in the formula.
        name: &'static str,
        /// What it is.
        value: f32,
    },
    /// A number that must be positive is not.
    #[error("{name} = {value} is not positive")]
    NotPositive {
        /// Its name in the formula.
        name: &'static str,
        /// What it is.
        value: f32,
    },
    /// A roughness is smaller than f32 can follow.
    #[error("{name} = {value} is narrower than {NARROWEST}, the narrowest lobe there is")]
    TooNarrow {
        /// Its name in the formula.
        name: &'static str,
        /// What it is.
        value: f32,
    },
    /// A number is not the cosine of the angle that is asked for.
    #[error("{name} = {value} is not between {least} and 1")]
    NoCosine {
        /// Its name in the formula.
        name: &'static str,
        /// What it is.
        value: f32,
        /// The least it may be.
        least: i8,
    },
    /// L and E are opposite.
    #[error("L = −E: nothing is halfway between opposite directions")]
    Opposite,
    /// The value is no finite f32.
    #[error("the value is beyond the range of f32")]
    Overflow,
}

const LECTURE: Switches = Switches { times_cosine: false, normalize: false };

impl Query {
    /// The formula's value.
    ///
    /// # Errors
    ///
    /// An argument outside the formula's domain, or a value outside f32's.
    pub fn value(&self) -> Result<Value, EvalError> {
        self.check()?;
        let value = self.evaluate()?;
        let finite = match value {
            Value::Number(number) => number.is_finite(),
            Value::Direction(_) => true,
            Value::Color(color) => color.to_array().into_iter().all(f32::is_finite),
        };
        if finite { Ok(value) } else { Err(EvalError::Overflow) }
    }

    fn evaluate(&self) -> Result<Value, EvalError> {
        let number = match *self {
            Self::Reflect { n, l } => return Ok(Value::Direction(n.mirror(l))),
            Self::Half { l, e } => {
                return l.halfway(e).map(Value::Direction).ok_or(EvalError::Opposite);
            }
            Self::Sum { lobe, n, e, k_a, k_d, k_s, alpha, c_a, ref lights } => {
                let model = lobe.model(k_d, k_s, alpha);
                let mut terms = Terms { ambient: k_a * c_a, ..Terms::default() };
                for light in lights {
                    terms += model.shade_light(n, Dir3::X, e, *light);
                }
                return Ok(Value::Color(terms.total()));
            }
            Self::MicrofacetBrdf { at, distribution, shadowing, fresnel } => {
                let facets = Microfacet { k_d: 0.0, k_s: 1.0, distribution, shadowing, fresnel };
                return Ok(Value::Color(facets.brdf(at.n, at.l, at.e)));
            }
            Self::Lambert { n, l } => {
                let model = Reflectance::Lambert(Lambert { k_d: 1.0 });
                model.shade_light(n, Dir3::X, n, white(l)).diffuse.r
            }
            Self::Specular { lobe, at, alpha } => lobe.at(at, alpha),
            Self::CosPower { x_deg, i } => lobe(libm::cos(f64::from(x_deg).to_radians()) as f32, i),
            Self::ModifiedPhongBrdf { at, k_d, k_s, n } if at.are_above() => {
                let factor = phong_model::normalization(n, true);
                FRAC_1_PI * (k_d + k_s * factor * Lobe::Phong.at(at, n))
            }
            Self::BlinnPhongBrdf { at, k_d, k_s, n, exact } if at.are_above() => {
                let factor = if exact {
                    blinn_phong::normalization(n, true)
                } else {
                    blinn_phong::short_normalization(n)
                };
                FRAC_1_PI * (k_d + k_s * factor * Lobe::Blinn.at(at, n))
            }
            Self::ModifiedPhongBrdf { .. } | Self::BlinnPhongBrdf { .. } => 0.0,
            Self::Schlick { cos, f0 } => fresnel::schlick(cos, f0),
            Self::Dielectric { cos, eta } => fresnel::dielectric(cos, eta),
            Self::Conductor { cos, eta, k } => fresnel::conductor(cos, eta, k),
            Self::Density { distribution, n_dot_h } => {
                distribution.density(Lean::from_cos(n_dot_h))
            }
            Self::Lambda { distribution, cos } => distribution.lambda(Lean::from_cos(cos)),
            Self::OrenNayarBrdf { at, rho, sigma, form } => {
                let model = OrenNayar { k_d: rho, sigma, form };
                let shape = model.shape(at.n, at.l, at.e);
                FRAC_1_PI * rho * (shape.direct + rho * shape.interreflected)
            }
            Self::WardBrdf { at, k_s, x, a_x, a_y, form } => {
                let model = Ward { k_d: 0.0, k_s, a_x, a_y, form };
                k_s * model.brdf(at.n, x, at.l, at.e)
            }
        };
        Ok(Value::Number(number))
    }

    /// Whether every argument is in its formula's domain.
    fn check(&self) -> Result<(), EvalError> {
        match *self {
            Self::Reflect { .. } | Self::Half { .. } | Self::Lambert { .. } => Ok(()),
            Self::Specular { alpha, .. } | Self::Sum { alpha, .. } => at_least_0("alpha", alpha),
            Self::CosPower { i, .. } => at_least_0("i", i),
            Self::ModifiedPhongBrdf { n, .. } | Self::BlinnPhongBrdf { n, .. } => {
                at_least_0("n", n)
            }
            Self::Schlick { cos, .. } => cosine("cos", cos, 0),
            Self::Dielectric { cos, eta } => cosine("cos", cos, 0).and(positive("eta", eta)),
            Self::Conductor { cos, eta, k } => {
                cosine("cos", cos, 0).and(positive("eta", eta)).and(at_least_0("k", k))
            }
            Self::MicrofacetBrdf { distribution, fresnel, .. } => {
                match fresnel {
                    Fresnel::None | Fresnel::Schlick { .. } => {}
                    Fresnel::Dielectric { eta } => positive("eta", eta)?,
                    Fresnel::Conductor { eta, k } => {
                        eta.to_array().into_iter().try_for_each(|eta| positive("eta", eta))?;
                        k.to_array().into_iter().try_for_each(|k| at_least_0("k", k))?;
                    }
                }
                width(distribution, ["a"; 3])
            }
            Self::Density { distribution, n_dot_h } => {
                cosine("NH", n_dot_h, -1).and(width(distribution, ["n", "m", "a"]))
            }
            Self::Lambda { distribution, cos } => {
                cosine("cos", cos, 0).and(width(distribution, ["n", "m", "a"]))
            }
            Self::OrenNayarBrdf { sigma, .. } => at_least_0("sigma", sigma),
            Self::WardBrdf { a_x, a_y, .. } => {
                not_too_narrow("ax", a_x).and(not_too_narrow("ay", a_y))
            }
        }
    }
}

impl Directions {
    /// Whether light and eye are above the horizon.
    fn are_above(self) -> bool {
        self.n.dot(self.l) > 0.0 && self.n.dot(self.e) > 0.0
    }
}

impl Lobe {
    fn model(self, k_d: f32, k_s: f32, alpha: f32) -> Reflectance {
        match self {
            Self::Phong => Reflectance::Phong(Phong::new(k_d, k_s, alpha, LECTURE)),
            Self::Blinn => Reflectance::BlinnPhong(BlinnPhong::new(k_d, k_s, alpha, LECTURE)),
        }
    }

    fn at(self, at: Directions, alpha: f32) -> f32 {
        self.model(0.0, 1.0, alpha).shade_light(at.n, Dir3::X, at.e, white(at.l)).specular.r
    }
}

fn white(l: Dir3) -> Incident {
    Incident { l, c_d: Rgb::WHITE, c_s: Rgb::WHITE, color: Rgb::WHITE }
}

fn at_least_0(name: &'static str, value: f32) -> Result<(), EvalError> {
    if value >= 0.0 { Ok(()) } else { Err(EvalError::Negative { name, value }) }
}

fn positive(name: &'static str, value: f32) -> Result<(), EvalError> {
    if value > 0.0 { Ok(()) } else { Err(EvalError::NotPositive { name, value }) }
}

fn not_too_narrow(name: &'static str, value: f32) -> Result<(), EvalError> {
    positive(name, value)?;
    if value >= NARROWEST { Ok(()) } else { Err(EvalError::TooNarrow { name, value }) }
}

fn cosine(name: &'static str, value: f32, least: i8) -> Result<(), EvalError> {
    let within = (f32::from(least)..=1.0).contains(&value);
    if within { Ok(()) } else { Err(EvalError::NoCosine { name, value, least }) }
}

/// Checks the width of a distribution, whose name is that of Blinn, Beckmann and GGX in turn.
fn width(
    distribution: Distribution,
    [blinn, beckmann, ggx]: [&'static str; 3],
) -> Result<(), EvalError> {
    match distribution {
        Distribution::Blinn { n } => at_least_0(blinn, n),
        Distribution::Beckmann { m } => not_too_narrow(beckmann, m),
        Distribution::Ggx { alpha } => not_too_narrow(ggx, alpha),
    }
}
