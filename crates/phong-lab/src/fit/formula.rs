//! What one would work out on paper, and what programs do.

use std::f64::consts::LN_2;

use super::lobe::{Base, Lobe, Model};

/// A number by formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    /// B's number.
    pub value: f64,
    /// The formula, to read.
    pub text: &'static str,
    /// What it makes equal.
    pub why: &'static str,
}

/// What one program makes of an exponent where it wants a roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InUse {
    /// Who does so.
    pub source: &'static str,
    /// The formula, to read.
    pub text: &'static str,
    /// The perceptual roughness, α = roughness², as glTF has it.
    pub roughness: f64,
}

/// The number of `to` that is `from`'s on paper.
pub(super) fn formula(from: Lobe, to: Model) -> Option<Formula> {
    /// Two lobes of the same shape, each in its own units.
    const SAME: (&str, &str) = ("the same number, in other units", "the same lobe");
    const SLOPE: (&str, &str) = ("the same number", "the same curvature at the peak");
    const HALF: &str = "the same half width at half the peak, in the plane of incidence";
    let (value, (text, why)) = match (from.model.base(from.number), to.base(1.0)) {
        (Base::Phong(number), Base::Phong(_))
        | (Base::Blinn(number), Base::Blinn(_))
        | (Base::Ggx(number), Base::Ggx(_))
        | (Base::Ward(number), Base::Ward(_))
        | (
            Base::Beckmann(number) | Base::CookTorrance(number),
            Base::Beckmann(_) | Base::CookTorrance(_),
        ) => (number, SAME),
        (Base::Phong(p), Base::Blinn(_)) => {
            let n = -2.0 * LN_2 / libm::log(0.5 * (1.0 + libm::exp2(-1.0 / p)));
            (n, ("n = −2 ln 2 / ln((1 + 2^(−1/α))/2) = 4α + ln 2 + O(1/α)", HALF))
        }
        (Base::Blinn(n), Base::Phong(_)) => {
            // Backwards; below n = 2 Blinn's lobe is above half its peak at the horizon.
            let cos = 2.0 * libm::exp2(-2.0 / n) - 1.0;
            if cos <= 0.0 {
                return None;
            }
            (-LN_2 / libm::log(cos), ("α = −ln 2 / ln(2·2^(−2/n) − 1) = n/4 − O(1)", HALF))
        }
        (from, to) => {
            // All by way of the slope m of the facets: m² = 2/(n + 2), n = 4α for Phong's lobe.
            let m = match from {
                Base::Phong(p) => (2.0 / (4.0 * p + 2.0)).sqrt(),
                Base::Blinn(n) => (2.0 / (n + 2.0)).sqrt(),
                Base::CookTorrance(m) | Base::Beckmann(m) | Base::Ggx(m) | Base::Ward(m) => m,
            };
            let why = "the same curvature at the peak (Walter and others 2007)";
            let n = 2.0 / (m * m) - 2.0;
            match (from, to) {
                (Base::Phong(_), _) => (m, ("m² = 2/(4α + 2)", why)),
                (Base::Blinn(_), _) => (m, ("m² = 2/(n + 2)", why)),
                (_, Base::Phong(_)) if n > 0.0 => (n / 4.0, ("α = (2/m² − 2)/4", why)),
                (_, Base::Blinn(_)) if n > 0.0 => (n, ("n = 2/m² − 2", why)),
                (_, Base::Phong(_) | Base::Blinn(_)) => return None,
                _ => (m, SLOPE),
            }
        }
    };
    Some(Formula { value: to.number_of(value), text, why })
}

/// What programs make of an exponent `Ns`, where a roughness is wanted.
pub(super) fn in_use(from: Lobe, to: Model) -> Vec<InUse> {
    let (ns, phong) = match from.model.base(from.number) {
        Base::Phong(p) => (p, true),
        Base::Blinn(n) => (n, false),
        _ => return Vec::new(),
    };
    if to.quantity() != "roughness" || to == Model::PovSpecular {
        return Vec::new();
    }
    let say = |source, text, roughness: f64| InUse { source, text, roughness };
    let theory = |n: f64| libm::pow(2.0 / (n + 2.0), 0.25);
    vec![
        if phong {
            say("theory, Phong's lobe", "(2/(4Ns + 2))^¼", theory(4.0 * ns))
        } else {
            say("theory, Blinn's lobe; trimesh", "(2/(Ns + 2))^¼", theory(ns))
        },
        say("several, as α or as roughness", "√(2/(Ns + 2))", (2.0 / (ns + 2.0)).sqrt()),
        say("Blender's OBJ importer", "1 − √(Ns/1000)", 1.0 - (ns.min(1000.0) / 1000.0).sqrt()),
        say("obj2gltf", "1 − Ns/1000", 1.0 - ns.min(1000.0) / 1000.0),
        say("FBX", "1 − log₂(Ns)/10", (1.0 - libm::log2(ns) / 10.0).clamp(0.0, 1.0)),
    ]
}
