//! An explanation for programs.

use phong::explain::{
    Blocker, End, Explanation, LightFrom, Lit, Onward, Openness, RayTold, Sample, Surface,
    TextureTold,
};
use phong::math::Dir3;
use phong::terms::Terms;
use phong::texture::ImageLookUp;
use phong::witness::{CutReason, Faded};
use phong_scene::{ConstantMaterial, Place, Rgb, TextureSpace};
use serde_json::{Map, Value, json};

use super::text::{Toned, hidden, share, toned};

/// The explanation as one JSON object. Numbers are f32 with all their digits: read as f64 and
/// rounded to f32 they are the very bits. What is infinite, or not there, is null.
pub fn json(told: &Explanation) -> Value {
    let encoded = told.encoded();
    let mut out = json!({
        "pixel": told.pixel,
        "size": told.size,
        "eye": told.eye.to_array(),
        "samples": told.samples.iter().map(sample).collect::<Vec<_>>(),
        "terms": terms(told.terms),
        "linear": rgb(told.linear),
        "alpha": number(told.alpha),
        "tone": toned(told).iter().map(tone).collect::<Vec<_>>(),
        "srgb8": encoded.shown,
    });
    if !told.furniture.is_empty() {
        let over = |&[r, g, b, a]: &[u8; 4]| json!({ "srgb8": [r, g, b], "cover": share(a) });
        let pieces = told.furniture.iter().flat_map(|piece| &piece.pixels);
        out["furniture"] = json!({
            "over": encoded.bytes,
            "pieces": pieces.map(over).collect::<Vec<_>>(),
        });
    }
    if let [only] = told.samples.as_slice()
        && let Some(RayTold { end: End::Surface(surface), .. }) = &only.ray
    {
        out["material"] = material(&surface.material);
    }
    out
}

pub(super) fn tone(step: &Toned) -> Value {
    json!({ "step": step.name, "how": step.how, "linear": rgb(step.color) })
}

fn sample(sample: &Sample) -> Value {
    let mut out = Map::new();
    out.insert("place".to_owned(), list(&sample.place));
    out.insert("weight".to_owned(), number(sample.weight));
    match &sample.ray {
        Some(told) => ray_into(&mut out, told),
        None => {
            out.insert("hit".to_owned(), Value::Null);
        }
    }
    out.insert("terms".to_owned(), terms(sample.terms));
    Value::Object(out)
}

fn ray(told: &RayTold) -> Value {
    let mut out = Map::new();
    ray_into(&mut out, told);
    out.insert("terms".to_owned(), terms(told.terms()));
    Value::Object(out)
}

fn ray_into(out: &mut Map<String, Value>, told: &RayTold) {
    let mut put = |key: &str, value| out.insert(key.to_owned(), value);
    put("origin", json!(told.origin.to_array()));
    put("dir", dir(told.dir));
    if let Some(Faded { distance, clear, color, light }) = told.fog {
        let fog = json!({
            "distance": number(distance),
            "clear": number(clear),
            "color": rgb(color),
            "light": rgb(light),
        });
        put("fog", fog);
    }
    match &told.end {
        End::Background(background) => {
            put("hit", Value::Null);
            put("background", rgb(*background));
        }
        End::Light { name, at, t, emission } => {
            put("hit", Value::Null);
            put("light", json!({ "name": name, "at": self::at(at), "t": number(*t) }));
            put("emission", rgb(*emission));
        }
        End::Surface(s) => {
            put("hit", hit(s));
            put("e", dir(s.e));
            put("ambient", rgb(s.ambient));
            put("c_a", rgb(s.c_a));
            if let Some(Openness { share, rays, distance, sky }) = s.openness {
                let told = json!({
                    "share": number(share), "rays": rays, "distance": number(distance),
                });
                put("openness", told);
                if let Some(sky) = sky {
                    put("sky", rgb(sky));
                }
            }
            put("emission", rgb(s.terms.emission));
            put("c_e", rgb(s.c_e()));
            put("material", material(&s.material));
            put("textures", s.textures.iter().map(texture).collect());
            put("lights", s.lights.iter().map(|lit| light(s, lit)).collect());
            put("reflection", s.reflection.as_ref().map_or(Value::Null, onward));
            put("transmission", s.transmission.as_ref().map_or(Value::Null, onward));
            if s.cover < 1.0 {
                put("opacity", number(s.cover));
                put("through", s.through.as_ref().map_or(Value::Null, onward));
            }
        }
    }
}

fn hit(s: &Surface) -> Value {
    let mut told = json!({
        "object": s.object,
        "at": at(&s.at),
        "element": s.element,
        "material": s.material.name,
        "t": number(s.t),
        "p": s.p.to_array(),
        "n": dir(s.n),
        "ng": dir(s.ng),
        "uv": list(&s.uv),
        "from_outside": s.from_outside,
        "eta": s.eta.map(number),
        "color": rgb(s.color),
    });
    if let Some(clip) = s.cap {
        told["cap"] = json!(format!("clip {}", clip + 1));
    }
    told
}

fn material(m: &ConstantMaterial) -> Value {
    json!({
        "name": m.name,
        "model": super::text::described(m),
        "k_a": number(m.k_a),
        "k_d": number(m.k_d),
        "k_s": number(m.k_s),
        "k_e": number(m.k_e),
        "shininess": number(m.shininess),
        "at": at(&m.place),
    })
}

fn texture(told: &TextureTold) -> Value {
    json!({
        "parameter": told.parameter,
        "texture": told.texture,
        "space": match told.space {
            TextureSpace::Object => "object",
            TextureSpace::World => "world",
            TextureSpace::Uv => "uv",
        },
        "place": told.place.to_array(),
        "image": told.image.map(|ImageLookUp { level, taps }| json!({ "level": number(level), "taps": taps })),
        "number": told.number.as_ref().map(|(of, number)| json!({ "of": of, "value": number.is_finite().then_some(number) })),
        "value": rgb(told.value),
    })
}

fn light(s: &Surface, lit: &Lit) -> Value {
    let power = super::product::power(s, lit);
    json!({
        "name": lit.name,
        "at": at(&lit.at),
        "position": match lit.from {
            LightFrom::Point(p) => json!(p.to_array()),
            LightFrom::Direction(_) => Value::Null,
        },
        "direction": match lit.from {
            LightFrom::Point(_) => Value::Null,
            LightFrom::Direction(d) => json!(d.to_array()),
        },
        "l": lit.l.map_or(Value::Null, dir),
        "r": lit.r.map_or(Value::Null, dir),
        "h": lit.h.map_or(Value::Null, dir),
        "distance": number(lit.distance),
        "n_dot_l": number(lit.n_dot_l),
        "r_dot_e": number(lit.r_dot_e),
        "n_dot_h": number(lit.n_dot_h),
        "visible": lit.visible,
        "visibility": rgb(lit.visibility),
        "lifted": lit.lifted.map_or(Value::Null, |start| json!(start.to_array())),
        "why_not": hidden(lit),
        "blocker": lit.blocker.as_ref().map_or(Value::Null, blocker),
        "color": rgb(lit.color),
        "c_d": rgb(lit.c_d),
        "c_s": rgb(lit.c_s),
        "power": power.map_or(Value::Null, number),
        "ambient": rgb(lit.ambient),
        "diffuse": rgb(lit.diffuse),
        "specular": rgb(lit.specular),
    })
}

fn blocker(b: &Blocker) -> Value {
    json!({ "object": b.object, "at": at(&b.at), "element": b.element, "t": number(b.t) })
}

fn onward(onward: &Onward) -> Value {
    json!({
        "weight": rgb(onward.weight),
        "fresnel": onward.fresnel.map(number),
        "ray": onward.ray.as_ref().map(ray),
        "cut": onward.cut.map(|reason| match reason {
            CutReason::Depth => "depth",
            CutReason::Weight(_) => "weight",
        }),
        "path_weight": rgb(onward.path_weight),
        "light": rgb(onward.light),
    })
}

fn terms(terms: Terms) -> Value {
    Value::Object(terms.iter().map(|(term, value)| (term.name().to_owned(), rgb(value))).collect())
}

fn at(place: &Place) -> Value {
    if place.file.is_empty() { Value::Null } else { json!(place.to_string()) }
}

pub(super) fn rgb(color: Rgb) -> Value {
    list(&color.to_array())
}

pub(super) fn dir(dir: Dir3) -> Value {
    list(&dir.to_array())
}

pub(super) fn list(values: &[f32]) -> Value {
    values.iter().copied().map(number).collect()
}

/// The shortest decimal that is this f32: as an f64 it would show digits that nobody computed.
pub(super) fn number(v: f32) -> Value {
    v.to_string().parse::<f64>().map_or(Value::Null, |v| json!(v))
}
