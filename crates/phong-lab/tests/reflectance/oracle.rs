//! The same formulas once more, in f64, from other ends: angles where the renderer has vectors,
//! tangents where it has cosines, complex numbers where it has their parts.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

use phong::math::Dir3;
use phong_lab::eval::Directions;

pub(crate) type V = [f64; 3];

/// N, L and E in f64, made unit once more.
#[derive(Clone, Copy)]
pub(crate) struct Nle {
    pub(crate) n: V,
    pub(crate) l: V,
    pub(crate) e: V,
}

impl Nle {
    /// The same directions with one component of one of them changed by `step`, in all nine ways.
    pub(crate) fn swayed(self, step: f64) -> impl Iterator<Item = Self> {
        (0..9).map(move |i| {
            let mut all = [self.n, self.l, self.e];
            all[i / 3][i % 3] += step;
            let [n, l, e] = all.map(unit);
            Self { n, l, e }
        })
    }
}

impl From<Directions> for Nle {
    fn from(d: Directions) -> Self {
        Self { n: wide(d.n), l: wide(d.l), e: wide(d.e) }
    }
}

pub(crate) fn wide(d: Dir3) -> V {
    unit(d.to_array().map(f64::from))
}

pub(crate) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn times(k: f64, a: V) -> V {
    a.map(|c| k * c)
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn unit(a: V) -> V {
    times(1.0 / dot(a, a).sqrt(), a)
}

/// The part of `v` in the plane of normal `n`.
fn flat(n: V, v: V) -> V {
    add(v, times(-dot(n, v), n))
}

/// The angle between two unit vectors, well conditioned everywhere.
fn angle(a: V, b: V) -> f64 {
    let c = cross(a, b);
    libm::atan2(dot(c, c).sqrt(), dot(a, b))
}

fn power(x: f64, alpha: f64) -> f64 {
    if x <= 0.0 { 0.0 } else { libm::exp(alpha * libm::log(x)) }
}

fn squared(x: f64) -> f64 {
    x * x
}

/// The part of L along N kept, that across it turned round.
pub(crate) fn mirrored(n: V, l: V) -> V {
    add(times(dot(n, l), n), times(-1.0, flat(n, l)))
}

pub(crate) fn phong_lobe(Nle { n, l, e }: Nle, alpha: f64) -> f64 {
    power(dot(mirrored(n, l), e), alpha)
}

/// `N·H = (N·L + N·E) / (2 cos(γ/2))`, γ the angle between L and E.
fn n_dot_h(Nle { n, l, e }: Nle) -> f64 {
    (dot(n, l) + dot(n, e)) / (2.0 * libm::cos(0.5 * angle(l, e)))
}

pub(crate) fn blinn_lobe(at: Nle, alpha: f64) -> f64 {
    power(n_dot_h(at), alpha)
}

pub(crate) fn modified_phong(at: Nle, k_d: f64, k_s: f64, n: f64) -> f64 {
    k_d / PI + k_s * (n + 2.0) / (2.0 * PI) * phong_lobe(at, n)
}

pub(crate) fn blinn_phong_brdf(at: Nle, k_d: f64, k_s: f64, n: f64, exact: bool) -> f64 {
    let factor = if exact {
        (n + 2.0) * (n + 4.0) / (8.0 * PI * (libm::exp2(-n / 2.0) + n))
    } else {
        (n + 8.0) / (8.0 * PI)
    };
    k_d / PI + k_s * factor * blinn_lobe(at, n)
}

pub(crate) fn schlick(cos: f64, f0: f64) -> f64 {
    f0 + (1.0 - f0) * libm::pow(1.0 - cos, 5.0)
}

/// By Fresnel's own law of angles: `sin(θ−θ')/sin(θ+θ')`, `tan(θ−θ')/tan(θ+θ')`.
pub(crate) fn dielectric(cos: f64, eta: f64) -> f64 {
    let theta = libm::acos(cos);
    let sin_t = libm::sin(theta) / eta;
    if sin_t >= 1.0 {
        return 1.0;
    }
    let theta_t = libm::asin(sin_t);
    let (minus, plus) = (theta - theta_t, theta + theta_t);
    if plus < 1e-6 {
        return squared((eta - 1.0) / (eta + 1.0));
    }
    let perpendicular = libm::sin(minus) / libm::sin(plus);
    let parallel = libm::tan(minus) / libm::tan(plus);
    0.5 * (squared(perpendicular) + squared(parallel))
}

/// A complex number.
#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Complex {
    fn times(self, o: Self) -> Self {
        Self(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }
    fn plus(self, o: Self) -> Self {
        Self(self.0 + o.0, self.1 + o.1)
    }
    fn minus(self, o: Self) -> Self {
        Self(self.0 - o.0, self.1 - o.1)
    }
    fn norm2(self) -> f64 {
        squared(self.0) + squared(self.1)
    }
    fn root(self) -> Self {
        let (r, phi) = (self.norm2().sqrt(), libm::atan2(self.1, self.0));
        Self(r.sqrt() * libm::cos(phi / 2.0), r.sqrt() * libm::sin(phi / 2.0))
    }
}

/// Snell's and Fresnel's laws with a complex index.
pub(crate) fn conductor(cos: f64, eta: f64, k: f64) -> f64 {
    let index2 = Complex(eta, k).times(Complex(eta, k));
    let c = Complex(cos, 0.0);
    let inside = index2.minus(Complex(1.0 - squared(cos), 0.0)).root(); // index × cos θ_t
    let perpendicular = c.minus(inside).norm2() / c.plus(inside).norm2();
    let bent = index2.times(c);
    let parallel = bent.minus(inside).norm2() / bent.plus(inside).norm2();
    0.5 * (perpendicular + parallel)
}

/// Distributions and their Λ, by the angle to the normal.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Facets {
    Blinn(f64),
    Beckmann(f64),
    Ggx(f64),
}

impl Facets {
    pub(crate) fn density(self, theta: f64) -> f64 {
        if theta >= FRAC_PI_2 {
            return 0.0;
        }
        let (tan2, cos4) = (squared(libm::tan(theta)), squared(squared(libm::cos(theta))));
        match self {
            Self::Blinn(n) => (n + 2.0) * FRAC_1_PI / 2.0 * power(libm::cos(theta), n),
            Self::Beckmann(m) => libm::exp(-tan2 / squared(m)) / (PI * squared(m) * cos4),
            Self::Ggx(a) => 1.0 / (PI * squared(a) * cos4 * squared(1.0 + tan2 / squared(a))),
        }
    }

    pub(crate) fn lambda(self, theta: f64) -> f64 {
        match self {
            Self::Blinn(n) => Self::Beckmann((2.0 / (n + 2.0)).sqrt()).lambda(theta),
            Self::Beckmann(m) => {
                let a = 1.0 / (m * libm::tan(theta));
                (libm::erf(a) - 1.0) / 2.0 + libm::exp(-squared(a)) / (2.0 * a * PI.sqrt())
            }
            Self::Ggx(a) => ((1.0 + squared(a * libm::tan(theta))).sqrt() - 1.0) / 2.0,
        }
    }

    /// G of the four kinds: separable, correlated, V-cavity.
    pub(crate) fn shadowing(self, kind: usize, at: Nle) -> f64 {
        let Nle { n, l, e } = at;
        let [a, b] = [l, e].map(|v| self.lambda(angle(n, v)));
        match kind {
            0 => 1.0 / (1.0 + a) / (1.0 + b),
            1 => 1.0 / (1.0 + a + b),
            _ => {
                let e_dot_h = libm::cos(0.5 * angle(l, e));
                let groove = |v| 2.0 * n_dot_h(at) * dot(n, v) / e_dot_h;
                1.0_f64.min(groove(l)).min(groove(e))
            }
        }
    }

    /// `D G F / (4 (N·L)(N·E))` for an F of 1.
    pub(crate) fn brdf(self, kind: usize, at: Nle) -> f64 {
        let h = unit(add(at.l, at.e));
        self.density(angle(at.n, h)) * self.shadowing(kind, at)
            / (4.0 * dot(at.n, at.l) * dot(at.n, at.e))
    }
}

/// θ of L and E, and the azimuth between them.
fn angles(Nle { n, l, e }: Nle) -> (f64, f64, f64) {
    (angle(n, l), angle(n, e), angle(unit(flat(n, l)), unit(flat(n, e))))
}

pub(crate) fn oren_nayar_qualitative(at: Nle, rho: f64, sigma: f64) -> f64 {
    let (theta_l, theta_e, dphi) = angles(at);
    let s2 = squared(sigma);
    let a = 1.0 - s2 / (2.0 * (s2 + 0.33));
    let b = 0.45 * s2 / (s2 + 0.09);
    let (alpha, beta) = (theta_l.max(theta_e), theta_l.min(theta_e));
    rho / PI * (a + b * libm::cos(dphi).max(0.0) * libm::sin(alpha) * libm::tan(beta))
}

pub(crate) fn oren_nayar_full(at: Nle, rho: f64, sigma: f64, interreflection: bool) -> f64 {
    let (theta_l, theta_e, dphi) = angles(at);
    let (alpha, beta) = (theta_l.max(theta_e), theta_l.min(theta_e));
    let (s2, c) = (squared(sigma), libm::cos(dphi));
    let part = s2 / (s2 + 0.09);
    let c1 = 1.0 - 0.5 * s2 / (s2 + 0.33);
    let c2 = if c >= 0.0 {
        0.45 * part * libm::sin(alpha)
    } else {
        0.45 * part * (libm::sin(alpha) - libm::pow(2.0 * beta / PI, 3.0))
    };
    let c3 = 0.125 * part * squared(4.0 * alpha * beta / squared(PI));
    let half_sum = 0.5 * (alpha + beta);
    let l1 =
        rho / PI * (c1 + c * c2 * libm::tan(beta) + (1.0 - c.abs()) * c3 * libm::tan(half_sum));
    let l2 = 0.17 * squared(rho) / PI * s2 / (s2 + 0.13) * (1.0 - c * squared(2.0 * beta / PI));
    if interreflection { l1 + l2 } else { l1 }
}

/// Ward's own form, by the half vector's angles; or the mended one, by its unnormalised vector.
pub(crate) fn ward(at: Nle, x: V, [a_x, a_y]: [f64; 2], mended: bool) -> f64 {
    let Nle { n, l, e } = at;
    let along = unit(flat(n, x));
    let across = cross(n, along);
    let h = add(l, e);
    let delta = angle(n, unit(h));
    let phi = libm::atan2(dot(h, across), dot(h, along));
    let spread = squared(libm::cos(phi) / a_x) + squared(libm::sin(phi) / a_y);
    let gaussian = libm::exp(-squared(libm::tan(delta)) * spread);
    if mended {
        gaussian / (PI * a_x * a_y) * dot(h, h) / squared(squared(dot(h, n)))
    } else {
        gaussian / (4.0 * PI * a_x * a_y) / (dot(n, l) * dot(n, e)).sqrt()
    }
}
