//! A model with its number, as a lobe to look at.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;
use phong::math::Dir3;
use phong::reflectance::{
    BlinnPhong, Distribution, Fresnel, Incident, Microfacet, Phong, Reflectance, Shadowing,
    Switches, Ward, WardForm,
};
use phong_scene::Rgb;

use super::FitError;

/// Lobes, each with one number, in the units of whoever uses them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// `(R·E)^α`.
    Phong,
    /// `(N·H)^α`.
    BlinnPhong,
    /// Wavefront MTL: `(N·H)^Ns`.
    Mtl,
    /// X3D and VRML97: `(N·H)^(128 s)`.
    X3d,
    /// `OSPRay`'s `obj` material: `(N·H)^(4 ns)`.
    Ospray,
    /// POV-Ray's `specular`: `(N·H)^(1/roughness)`.
    PovSpecular,
    /// Beckmann's facets in V-cavities; m.
    CookTorrance,
    /// Beckmann's facets, Smith's shadowing; m.
    Beckmann,
    /// GGX facets, Smith's shadowing; α.
    Ggx,
    /// glTF's roughness: GGX with α = roughness².
    Gltf,
    /// Ward's lobe, mended, the same along and across the grain; a.
    Ward,
}

/// The lobe beneath a [`Model`], and its number in the formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Base {
    Phong(f64),
    Blinn(f64),
    CookTorrance(f64),
    Beckmann(f64),
    Ggx(f64),
    Ward(f64),
}

impl Model {
    /// Every model, the lecture's first.
    pub const ALL: [Self; 11] = [
        Self::Phong,
        Self::BlinnPhong,
        Self::Mtl,
        Self::X3d,
        Self::Ospray,
        Self::PovSpecular,
        Self::CookTorrance,
        Self::Beckmann,
        Self::Ggx,
        Self::Gltf,
        Self::Ward,
    ];

    /// Its name on a command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Phong => "phong",
            Self::BlinnPhong => "blinn-phong",
            Self::Mtl => "mtl",
            Self::X3d => "x3d",
            Self::Ospray => "ospray",
            Self::PovSpecular => "pov-specular",
            Self::CookTorrance => "cook-torrance",
            Self::Beckmann => "beckmann",
            Self::Ggx => "ggx",
            Self::Gltf => "gltf",
            Self::Ward => "ward",
        }
    }

    /// All names, for messages.
    pub fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }

    /// What its number is: "exponent", "shininess" or "roughness".
    pub const fn quantity(self) -> &'static str {
        match self {
            Self::Phong | Self::BlinnPhong | Self::Mtl | Self::Ospray => "exponent",
            Self::X3d => "shininess",
            Self::PovSpecular
            | Self::CookTorrance
            | Self::Beckmann
            | Self::Ggx
            | Self::Gltf
            | Self::Ward => "roughness",
        }
    }

    /// What its number may be: what f32 directions can show, and no wider than a hemisphere.
    pub const fn range(self) -> [f64; 2] {
        match self {
            Self::Phong | Self::BlinnPhong | Self::Mtl => [0.01, 1e6],
            Self::X3d => [0.01 / 128.0, 1e6 / 128.0],
            Self::Ospray => [0.01 / 4.0, 1e6 / 4.0],
            Self::PovSpecular => [1e-6, 100.0],
            Self::CookTorrance | Self::Beckmann | Self::Ggx | Self::Ward => [0.001, 4.0],
            Self::Gltf => [0.032, 2.0],
        }
    }

    /// A number for an example.
    pub(super) const fn example(self) -> f64 {
        match self {
            Self::Phong => 32.0,
            Self::BlinnPhong => 128.0,
            Self::Mtl => 200.0,
            Self::Ospray => 10.0,
            Self::X3d | Self::CookTorrance | Self::Beckmann | Self::Ggx | Self::Ward => 0.2,
            Self::PovSpecular => 0.05,
            Self::Gltf => 0.5,
        }
    }

    pub(super) fn base(self, number: f64) -> Base {
        match self {
            Self::Phong => Base::Phong(number),
            Self::BlinnPhong | Self::Mtl => Base::Blinn(number),
            Self::X3d => Base::Blinn(128.0 * number),
            Self::Ospray => Base::Blinn(4.0 * number),
            Self::PovSpecular => Base::Blinn(1.0 / number),
            Self::CookTorrance => Base::CookTorrance(number),
            Self::Beckmann => Base::Beckmann(number),
            Self::Ggx => Base::Ggx(number),
            Self::Gltf => Base::Ggx(number * number),
            Self::Ward => Base::Ward(number),
        }
    }

    /// The number that has this one in the formula; undoes [`Model::base`].
    pub(super) fn number_of(self, in_formula: f64) -> f64 {
        match self {
            Self::Phong
            | Self::BlinnPhong
            | Self::Mtl
            | Self::CookTorrance
            | Self::Beckmann
            | Self::Ggx
            | Self::Ward => in_formula,
            Self::X3d => in_formula / 128.0,
            Self::Ospray => in_formula / 4.0,
            Self::PovSpecular => 1.0 / in_formula,
            Self::Gltf => in_formula.sqrt(),
        }
    }
}

impl FromStr for Model {
    type Err = FitError;

    /// A model from its name; `blinn` is `blinn-phong`.
    fn from_str(name: &str) -> Result<Self, FitError> {
        if name == "blinn" {
            return Ok(Self::BlinnPhong);
        }
        let found = Self::ALL.into_iter().find(|model| model.name() == name);
        found.ok_or_else(|| FitError::UnknownModel { name: name.to_owned() })
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A model with its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// The model.
    pub model: Model,
    /// Its exponent or roughness, in the model's own units.
    pub number: f64,
}

/// Eyes in a plane through the mirror direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slice {
    /// The plane of incidence, through light and normal.
    InPlane,
    /// The plane across it.
    Across,
}

impl Lobe {
    /// A model with its number.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`].
    pub fn new(model: Model, number: f64) -> Result<Self, FitError> {
        let [least, most] = model.range();
        if (least..=most).contains(&number) {
            Ok(Self { model, number })
        } else {
            Err(FitError::OutOfRange { model, number })
        }
    }

    /// The exponent that is applied, whatever the model's units; `None` where there is none.
    pub fn exponent(self) -> Option<f64> {
        match self.model.base(self.number) {
            Base::Phong(n) | Base::Blinn(n) => Some(n),
            _ => None,
        }
    }

    /// The lobe as a surface: the renderer's own model, without a diffuse part.
    pub fn reflectance(self) -> Reflectance {
        let facets = |distribution, shadowing| {
            let fresnel = Fresnel::None;
            let facets = Microfacet { k_d: 0.0, k_s: 1.0, distribution, shadowing, fresnel };
            Reflectance::Microfacet(facets)
        };
        match self.model.base(self.number) {
            Base::Phong(alpha) => {
                Reflectance::Phong(Phong::new(0.0, 1.0, alpha as f32, Switches::default()))
            }
            Base::Blinn(alpha) => Reflectance::BlinnPhong(BlinnPhong::new(
                0.0,
                1.0,
                alpha as f32,
                Switches::default(),
            )),
            Base::CookTorrance(m) => {
                facets(Distribution::Beckmann { m: m as f32 }, Shadowing::VCavity)
            }
            Base::Beckmann(m) => {
                facets(Distribution::Beckmann { m: m as f32 }, Shadowing::Correlated)
            }
            Base::Ggx(alpha) => {
                facets(Distribution::Ggx { alpha: alpha as f32 }, Shadowing::Correlated)
            }
            Base::Ward(a) => Reflectance::Ward(Ward {
                k_d: 0.0,
                k_s: 1.0,
                a_x: a as f32,
                a_y: a as f32,
                form: WardForm::Gmd,
            }),
        }
    }

    /// The specular term under white light at `theta` degrees, for an eye turned `phi` degrees
    /// from the mirror direction: in the plane of incidence away from the normal, or across it.
    /// 0 below the horizon.
    pub fn at(self, theta: f64, slice: Slice, phi: f64) -> f64 {
        LitLobe::new(self, theta).at(slice, phi)
    }

    /// Half the width at half the peak, degrees, for light at `theta` degrees.
    pub(super) fn half_width(self, theta: f64, slice: Slice) -> Option<f64> {
        let lobe = LitLobe::new(self, theta);
        let [from, to] = slice.ends(theta);
        // The peak may lie off the mirror direction: look for it.
        let steps = 2000;
        let place = |i: i32| from + (to - from) * f64::from(i) / f64::from(steps);
        let value = |i: i32| lobe.at(slice, place(i));
        let coarse = (0..=steps).max_by(|a, b| value(*a).total_cmp(&value(*b)))?;
        let mirror = lobe.at(slice, 0.0);
        let (top, peak) =
            if mirror >= value(coarse) { (0.0, mirror) } else { (place(coarse), value(coarse)) };
        let side = |end: f64| {
            let (mut above, mut below) = (top, end);
            if lobe.at(slice, below) > 0.5 * peak {
                return None;
            }
            for _ in 0..50 {
                let middle = 0.5 * (above + below);
                if lobe.at(slice, middle) > 0.5 * peak { above = middle } else { below = middle }
            }
            Some(above)
        };
        Some(0.5 * (side(to)? - side(from)?))
    }
}

impl Slice {
    /// From where to where the eye is above the horizon, degrees from the mirror direction.
    pub(super) fn ends(self, theta: f64) -> [f64; 2] {
        match self {
            Self::InPlane => [-90.0 - theta, 90.0 - theta],
            Self::Across => [-90.0, 90.0],
        }
    }
}

impl FromStr for Lobe {
    type Err = FitError;

    /// `model:number`, as `phong:32`.
    fn from_str(text: &str) -> Result<Self, FitError> {
        let (name, number) = match text.split_once(':') {
            Some((name, number)) => (name, Some(number)),
            None => (text, None),
        };
        let model: Model = name.parse()?;
        let number = number.ok_or(FitError::NoNumber { model })?;
        let value: f64 =
            number.parse().map_err(|_| FitError::NotANumber { text: number.to_owned() })?;
        Self::new(model, value)
    }
}

impl fmt::Display for Lobe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.model, short(self.number))
    }
}

/// A number to four digits or so, for reading.
fn short(number: f64) -> String {
    let decimals = match number.abs() {
        1000.0.. => 0,
        100.0.. => 1,
        10.0.. => 2,
        1.0.. => 3,
        _ => 4,
    };
    let text = format!("{number:.decimals$}");
    if decimals == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

/// A vector of unit length as a direction.
fn direction(v: DVec3) -> Dir3 {
    Dir3::from_array(v.as_vec3().to_array()).expect("made of sine and cosine of one angle")
}

/// A lobe under light from one direction.
pub(super) struct LitLobe {
    reflectance: Reflectance,
    light: Incident,
    mirror: DVec3,
    aside: DVec3,
}

impl LitLobe {
    /// Under white light at `theta` degrees from the normal, z, towards −x.
    pub(super) fn new(lobe: Lobe, theta: f64) -> Self {
        let (sin, cos) = libm::sincos(theta.to_radians());
        let l = direction(DVec3::new(-sin, 0.0, cos));
        Self {
            reflectance: lobe.reflectance(),
            light: Incident { l, c_d: Rgb::BLACK, c_s: Rgb::WHITE, color: Rgb::BLACK },
            mirror: DVec3::new(sin, 0.0, cos),
            aside: DVec3::new(cos, 0.0, -sin),
        }
    }

    pub(super) fn at(&self, slice: Slice, phi: f64) -> f64 {
        let (sin, cos) = libm::sincos(phi.to_radians());
        let aside = match slice {
            Slice::InPlane => self.aside,
            Slice::Across => DVec3::Y,
        };
        let e = direction(cos * self.mirror + sin * aside);
        if e.dot(Dir3::Z) <= 0.0 {
            return 0.0;
        }
        let terms = self.reflectance.shade_light(Dir3::Z, Dir3::X, e, self.light);
        f64::from(terms.specular.r)
    }
}
