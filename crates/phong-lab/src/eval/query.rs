//! A query, from JSON or a row of arrays.

use std::fmt;

use phong::math::Dir3;
use phong::reflectance::{Distribution, Fresnel, Incident, OrenNayarForm, Shadowing, WardForm};
use phong_scene::{Rgb, closest};
use serde_json::{Map, Value as Json};

use super::{Directions, Lobe, Query};

/// Every model by name.
const MODELS: [&str; 23] = [
    "reflect",
    "half",
    "lambert",
    "phong_spec",
    "blinn_spec",
    "phong",
    "blinn_phong",
    "phong_multi",
    "cos_power",
    "modified_phong_brdf",
    "blinn_phong_brdf",
    "F_schlick",
    "F_dielectric",
    "F_conductor",
    "microfacet_brdf",
    "D_blinn",
    "D_beckmann",
    "D_ggx",
    "lambda_ggx",
    "lambda_beckmann",
    "oren_nayar_qualitative",
    "oren_nayar_full",
    "ward_brdf",
];

/// The vectors of a query.
const VECTORS: [&str; 3] = ["N", "L", "E"];

/// Keys of a query, beside its `id`.
const KEYS: [&str; 5] = ["model", "N", "L", "E", "params"];

/// How far a vector's length may be from 1.
const SLACK: f64 = 1e-3;

/// The query that a JSON object asks, without its `id`; and whether all its colours are greys,
/// given as one number each.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read(object: &Map<String, Json>) -> Result<(Query, bool), String> {
    if let Some(key) = object.keys().find(|key| !KEYS.contains(&key.as_str())) {
        let way_out = closest(key, KEYS)
            .map_or_else(|| format!("it has id, {}", KEYS.join(", ")), did_you_mean);
        return Err(format!("a query has no `{key}`; {way_out}"));
    }
    let model = match object.get("model") {
        Some(Json::String(model)) => model.as_str(),
        Some(other) => return Err(format!("model is a text, not {}", kind(Given::Json(other)))),
        None => return Err("a query needs a model; `phong eval --help` lists them".to_owned()),
    };
    let none = Map::new();
    let params = match object.get("params") {
        Some(Json::Object(params)) => params,
        Some(other) => {
            return Err(format!("params is an object, not {}", kind(Given::Json(other))));
        }
        None => &none,
    };
    query(&Parts { model, object, params, row: &[] })
}

/// The query that some parts make; and whether all its colours are greys.
pub(super) fn query(parts: &Parts<'_>) -> Result<(Query, bool), String> {
    let mut fields = Fields { model: parts.model, parts, asked: Vec::new(), grey: true };
    let query = fields.query()?;
    fields.nothing_is_left()?;
    Ok((query, fields.grey))
}

/// What a query is made of.
pub(super) struct Parts<'a> {
    pub(super) model: &'a str,
    /// N, L and E, as far as they are no arrays.
    pub(super) object: &'a Map<String, Json>,
    /// The params, as far as they are no arrays.
    pub(super) params: &'a Map<String, Json>,
    /// A row of each array, by the name of a vector or a param.
    pub(super) row: &'a [(&'a str, &'a [f64])],
}

impl<'a> Parts<'a> {
    fn in_row(&self, name: &str) -> Option<Given<'a>> {
        self.row.iter().find(|(of, _)| *of == name).map(|(_, numbers)| Given::Row(numbers))
    }

    fn vector(&self, name: &str) -> Option<Given<'a>> {
        self.in_row(name).or_else(|| self.object.get(name).map(Given::Json))
    }

    fn param(&self, name: &str) -> Option<Given<'a>> {
        self.in_row(name).or_else(|| self.params.get(name).map(Given::Json))
    }

    /// The names of all params.
    fn params(&self) -> impl Iterator<Item = &'a str> {
        let of_arrays =
            self.row.iter().map(|(name, _)| *name).filter(|name| !VECTORS.contains(name));
        self.params.keys().map(String::as_str).chain(of_arrays)
    }
}

/// A part of a query: JSON, or the row of an array, where one number is a number and several are a
/// list.
#[derive(Clone, Copy)]
enum Given<'a> {
    Json(&'a Json),
    Row(&'a [f64]),
}

impl<'a> Given<'a> {
    fn number(self) -> Option<f64> {
        match self {
            Self::Json(value) => value.as_f64(),
            Self::Row(&[one]) => Some(one),
            Self::Row(_) => None,
        }
    }

    fn json(self) -> Option<&'a Json> {
        match self {
            Self::Json(value) => Some(value),
            Self::Row(_) => None,
        }
    }
}

impl fmt::Display for Given<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Json(value) => value.fmt(f),
            Self::Row([one]) => one.fmt(f),
            Self::Row(more) => write!(f, "{more:?}"),
        }
    }
}

/// The parts of a query, and which of them have been asked for.
struct Fields<'a> {
    model: &'a str,
    parts: &'a Parts<'a>,
    /// Params that the model has.
    asked: Vec<&'static str>,
    /// Whether no colour has been a list so far.
    grey: bool,
}

impl<'a> Fields<'a> {
    fn query(&mut self) -> Result<Query, String> {
        Ok(match self.model {
            "reflect" => Query::Reflect { n: self.vector("N")?, l: self.vector("L")? },
            "half" => Query::Half { l: self.vector("L")?, e: self.vector("E")? },
            "lambert" => Query::Lambert { n: self.vector("N")?, l: self.vector("L")? },
            "phong_spec" => self.specular(Lobe::Phong)?,
            "blinn_spec" => self.specular(Lobe::Blinn)?,
            "phong" => self.sum(Lobe::Phong, Self::one_light)?,
            "blinn_phong" => self.sum(Lobe::Blinn, Self::one_light)?,
            "phong_multi" => self.sum(Lobe::Phong, Self::lights)?,
            "cos_power" => Query::CosPower { x_deg: self.number("x_deg")?, i: self.number("i")? },
            "modified_phong_brdf" => Query::ModifiedPhongBrdf {
                at: self.directions()?,
                k_d: self.number("kd")?,
                k_s: self.number("ks")?,
                n: self.number("n")?,
            },
            "blinn_phong_brdf" => Query::BlinnPhongBrdf {
                at: self.directions()?,
                k_d: self.number("kd")?,
                k_s: self.number("ks")?,
                n: self.number("n")?,
                exact: self.choice(
                    "normalisation",
                    &[("exact", true), ("approx", false)],
                    Some(true),
                )?,
            },
            "F_schlick" => Query::Schlick { cos: self.number("cos")?, f0: self.number("F0")? },
            "F_dielectric" => {
                Query::Dielectric { cos: self.number("cos")?, eta: self.number("eta")? }
            }
            "F_conductor" => Query::Conductor {
                cos: self.number("cos")?,
                eta: self.number("eta")?,
                k: self.number("k")?,
            },
            "microfacet_brdf" => Query::MicrofacetBrdf {
                at: self.directions()?,
                distribution: self.distribution()?,
                shadowing: self.choice(
                    "G",
                    &[
                        ("separable", Shadowing::Separable),
                        ("correlated", Shadowing::Correlated),
                        ("vcavity", Shadowing::VCavity),
                        ("implicit", Shadowing::Implicit),
                    ],
                    Some(Shadowing::Separable),
                )?,
                fresnel: self.fresnel()?,
            },
            "D_blinn" => Query::Density {
                n_dot_h: self.number("NH")?,
                distribution: Distribution::Blinn { n: self.number("n")? },
            },
            "D_beckmann" => Query::Density {
                n_dot_h: self.number("NH")?,
                distribution: Distribution::Beckmann { m: self.number("m")? },
            },
            "D_ggx" => Query::Density {
                n_dot_h: self.number("NH")?,
                distribution: Distribution::Ggx { alpha: self.number("a")? },
            },
            "lambda_beckmann" => Query::Lambda {
                cos: self.number("cos")?,
                distribution: Distribution::Beckmann { m: self.number("m")? },
            },
            "lambda_ggx" => Query::Lambda {
                cos: self.number("cos")?,
                distribution: Distribution::Ggx { alpha: self.number("a")? },
            },
            "oren_nayar_qualitative" => {
                self.flag("interreflection", false)?;
                self.oren_nayar(OrenNayarForm::Qualitative)?
            }
            "oren_nayar_full" => {
                let interreflection = self.flag("interreflection", true)?;
                self.oren_nayar(OrenNayarForm::Full { interreflection })?
            }
            "ward_brdf" => Query::WardBrdf {
                at: self.directions()?,
                k_s: self.number("ks")?,
                x: self.grain()?,
                a_x: self.number("ax")?,
                a_y: self.number("ay")?,
                form: self.choice(
                    "form",
                    &[("ward", WardForm::Ward), ("gmd", WardForm::Gmd)],
                    Some(WardForm::Ward),
                )?,
            },
            unknown => {
                let way_out = closest(unknown, MODELS)
                    .map_or_else(|| "`phong eval --help` lists them".to_owned(), did_you_mean);
                return Err(format!("no model `{unknown}`; {way_out}"));
            }
        })
    }

    fn specular(&mut self, lobe: Lobe) -> Result<Query, String> {
        Ok(Query::Specular { lobe, at: self.directions()?, alpha: self.number("alpha")? })
    }

    fn sum(
        &mut self,
        lobe: Lobe,
        lights: fn(&mut Self) -> Result<Vec<Incident>, String>,
    ) -> Result<Query, String> {
        Ok(Query::Sum {
            lobe,
            n: self.vector("N")?,
            e: self.vector("E")?,
            k_a: self.number("ka")?,
            k_d: self.number("kd")?,
            k_s: self.number("ks")?,
            alpha: self.number("alpha")?,
            c_a: self.color("Ca")?,
            lights: lights(self)?,
        })
    }

    fn one_light(&mut self) -> Result<Vec<Incident>, String> {
        let l = self.vector("L")?;
        let (c_d, c_s) = (self.color("Cd")?, self.color("Cs")?);
        Ok(vec![Incident { l, c_d, c_s, color: c_d }])
    }

    fn lights(&mut self) -> Result<Vec<Incident>, String> {
        let given = self.param("lights")?;
        let Some(Json::Array(lights)) = given.json() else {
            return Err(format!("lights is a list of objects, not {}", kind(given)));
        };
        lights.iter().enumerate().map(|(i, light)| self.light(i, light)).collect()
    }

    fn light(&mut self, i: usize, light: &Json) -> Result<Incident, String> {
        const PARTS: [&str; 3] = ["L", "Cd", "Cs"];
        let Json::Object(light) = light else {
            return Err(format!("lights[{i}] is an object, not {}", kind(Given::Json(light))));
        };
        if let Some(key) = light.keys().find(|key| !PARTS.contains(&key.as_str())) {
            return Err(format!("lights[{i}] has no `{key}`; it has {}", PARTS.join(", ")));
        }
        let part = |name| {
            let value = light.get(name).ok_or_else(|| format!("lights[{i}] needs {name}"))?;
            Ok::<_, String>((format!("lights[{i}].{name}"), Given::Json(value)))
        };
        let [l, c_d, c_s] = [part("L")?, part("Cd")?, part("Cs")?];
        let l = unit(&l.0, l.1)?;
        let (c_d, c_s) = (self.color_of(&c_d.0, c_d.1)?, self.color_of(&c_s.0, c_s.1)?);
        Ok(Incident { l, c_d, c_s, color: c_d })
    }

    fn oren_nayar(&mut self, form: OrenNayarForm) -> Result<Query, String> {
        Ok(Query::OrenNayarBrdf {
            at: self.directions()?,
            rho: self.number("rho")?,
            sigma: self.number("sigma")?,
            form,
        })
    }

    fn distribution(&mut self) -> Result<Distribution, String> {
        let of: fn(f32) -> Distribution = self.choice(
            "ndf",
            &[
                ("blinn", (|n| Distribution::Blinn { n }) as fn(f32) -> Distribution),
                ("beckmann", |m| Distribution::Beckmann { m }),
                ("ggx", |alpha| Distribution::Ggx { alpha }),
            ],
            None,
        )?;
        Ok(of(self.number("a")?))
    }

    fn fresnel(&mut self) -> Result<Fresnel, String> {
        let list = match self.optional("fresnel").map(Given::json) {
            None | Some(Some(Json::Null)) => return Ok(Fresnel::None),
            Some(Some(Json::Array(list))) => list.as_slice(),
            Some(_) => &[],
        };
        match list {
            [Json::String(name), f0] if name == "schlick" => {
                Ok(Fresnel::Schlick { f0: self.color_of("F0", Given::Json(f0))? })
            }
            [Json::String(name), eta] if name == "dielectric" => {
                Ok(Fresnel::Dielectric { eta: number("eta", Given::Json(eta))? })
            }
            [Json::String(name), eta, k] if name == "conductor" => Ok(Fresnel::Conductor {
                eta: self.color_of("eta", Given::Json(eta))?,
                k: self.color_of("k", Given::Json(k))?,
            }),
            _ => Err("fresnel is null, [\"schlick\", F0], [\"dielectric\", eta] or \
                      [\"conductor\", eta, k]"
                .to_owned()),
        }
    }

    fn directions(&self) -> Result<Directions, String> {
        Ok(Directions { n: self.vector("N")?, l: self.vector("L")?, e: self.vector("E")? })
    }

    /// The direction X of a brushed surface's grain, which must have a share along the surface.
    fn grain(&mut self) -> Result<Dir3, String> {
        let (n, x) = (self.vector("N")?, unit("X", self.param("X")?)?);
        if n.to_vec().cross(x.to_vec()).length() < SLACK as f32 {
            return Err("X is along N: it must lead along the surface".to_owned());
        }
        Ok(x)
    }

    /// One of N, L, E.
    fn vector(&self, name: &str) -> Result<Dir3, String> {
        let value = self.parts.vector(name);
        unit(name, value.ok_or_else(|| format!("`{}` needs the vector {name}", self.model))?)
    }

    /// A param that need not be there.
    fn optional(&mut self, name: &'static str) -> Option<Given<'a>> {
        self.asked.push(name);
        self.parts.param(name)
    }

    /// A param that must be there.
    fn param(&mut self, name: &'static str) -> Result<Given<'a>, String> {
        let model = self.model;
        self.optional(name).ok_or_else(|| format!("`{model}` needs params.{name}"))
    }

    fn number(&mut self, name: &'static str) -> Result<f32, String> {
        number(name, self.param(name)?)
    }

    fn color(&mut self, name: &'static str) -> Result<Rgb, String> {
        let value = self.param(name)?;
        self.color_of(name, value)
    }

    /// A colour: one number for all channels, or a list of three.
    fn color_of(&mut self, name: &str, value: Given<'_>) -> Result<Rgb, String> {
        match value {
            Given::Json(Json::Number(_)) | Given::Row([_]) => number(name, value).map(Rgb::grey),
            Given::Json(Json::Array(_)) | Given::Row(_) => {
                self.grey = false;
                let [r, g, b] = three(name, value)?;
                Ok(Rgb::new(to_f32(name, r)?, to_f32(name, g)?, to_f32(name, b)?))
            }
            other @ Given::Json(_) => {
                Err(format!("{name} is a number or a list of 3 numbers, not {}", kind(other)))
            }
        }
    }

    fn flag(&mut self, name: &'static str, default: bool) -> Result<bool, String> {
        match self.optional(name) {
            None => Ok(default),
            Some(Given::Json(Json::Bool(flag))) => Ok(*flag),
            Some(other) => Err(format!("{name} is true or false, not {}", kind(other))),
        }
    }

    /// One of the `choices`; without a `default` it must be there.
    fn choice<T: Copy>(
        &mut self,
        name: &'static str,
        choices: &[(&str, T)],
        default: Option<T>,
    ) -> Result<T, String> {
        let value = match (self.optional(name), default) {
            (None, Some(default)) => return Ok(default),
            (None, None) => self.param(name)?,
            (Some(value), _) => value,
        };
        let text = value.json().and_then(Json::as_str);
        let found = choices.iter().find(|(choice, _)| text == Some(choice));
        found.map(|(_, meaning)| *meaning).ok_or_else(|| {
            let names: Vec<String> =
                choices.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            let (last, others) = names.split_last().map_or(("", &names[..]), |(l, o)| (l, o));
            format!("{name} is {} or {last}, not {value}", others.join(", "))
        })
    }

    /// Refuses params that nothing asked for.
    fn nothing_is_left(&self) -> Result<(), String> {
        let Some(key) = self.parts.params().find(|key| !self.asked.contains(key)) else {
            return Ok(());
        };
        let way_out = match (closest(key, self.asked.iter().copied()), self.asked.is_empty()) {
            (Some(name), _) => did_you_mean(name),
            (None, true) => "it has none".to_owned(),
            (None, false) => format!("it has {}", self.asked.join(", ")),
        };
        Err(format!("`{}` has no params.{key}; {way_out}", self.model))
    }
}

/// A unit vector, normalised from what is nearly one.
fn unit(name: &str, value: Given<'_>) -> Result<Dir3, String> {
    let v = three(name, value)?;
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    Some(v.map(|c| (c / length) as f32))
        .filter(|_| (length - 1.0).abs() <= SLACK)
        .and_then(Dir3::from_array)
        .ok_or_else(|| format!("{name} is not a unit vector: its length is {length}"))
}

fn three(name: &str, value: Given<'_>) -> Result<[f64; 3], String> {
    let list = match value {
        Given::Row(&[x, y, z]) => return Ok([x, y, z]),
        Given::Row(row) => return Err(format!("{name} has 3 components, not {}", row.len())),
        Given::Json(Json::Array(list)) => list,
        Given::Json(_) => {
            return Err(format!("{name} is a list of 3 numbers, not {}", kind(value)));
        }
    };
    let [x, y, z] = list.as_slice() else {
        return Err(format!("{name} has 3 components, not {}", list.len()));
    };
    let component = |i: usize, value: &Json| {
        let wrong = || format!("{name}[{i}] is a number, not {}", kind(Given::Json(value)));
        value.as_f64().ok_or_else(wrong)
    };
    Ok([component(0, x)?, component(1, y)?, component(2, z)?])
}

fn number(name: &str, value: Given<'_>) -> Result<f32, String> {
    let number =
        value.number().ok_or_else(|| format!("{name} is a number, not {}", kind(value)))?;
    to_f32(name, number)
}

fn to_f32(name: &str, number: f64) -> Result<f32, String> {
    let narrowed = number as f32;
    if narrowed.is_finite() {
        Ok(narrowed)
    } else if number.is_finite() {
        Err(format!("{name} = {number:e} is beyond f32"))
    } else {
        Err(format!("{name} is {number}: it must be finite"))
    }
}

/// What a value is, with its article.
fn kind(value: Given<'_>) -> &'static str {
    let value = match value {
        Given::Json(value) => value,
        Given::Row([_]) => return "a number",
        Given::Row(_) => return "a list",
    };
    match value {
        Json::Null => "null",
        Json::Bool(_) => "true or false",
        Json::Number(_) => "a number",
        Json::String(_) => "a text",
        Json::Array(_) => "a list",
        Json::Object(_) => "an object",
    }
}

fn did_you_mean(name: &str) -> String {
    format!("did you mean `{name}`?")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_of_the_list_is_one_that_can_be_asked() {
        for model in MODELS {
            let object = Json::from_iter([("model", Json::from(model))]);
            let told = read(object.as_object().unwrap()).unwrap_err();
            assert!(told.starts_with(&format!("`{model}` needs ")), "{told}");
        }
    }
}
