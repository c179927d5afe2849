//! One offline page: the picture, and behind every pixel its explanation.
//!
//! Bands of rows are packed, deflated and in base 64; the page unpacks the band that is asked for. What
//! belongs to many pixels (objects, lights, materials) is written once. The page computes nothing
//! that it states: it only lays out the numbers, which it has to four digits.

use glam::DVec3;
use phong::explain::{End, Explanation, Lit, Onward, RayTold, Surface, explain};
use phong::finish::Finished;
use phong::render::{Cancel, Cancelled, RenderOptions};
use phong::terms::Term;
use phong::view::View;
use phong_scene::{AmbientRule, ConstantMaterial, Light, LightKind, Model, Rgb};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::json::{dir, list, number, rgb};
use super::packed::pack;
use super::product::{self, Number, Product};
use super::text::{NOTICED, cut, described, hidden, named, toned};
use crate::markup::{data_url, escaped};

const PAGE: &str = include_str!("page.html");

/// Rows that are packed together.
const BAND: u32 = 12;

/// The most pixels a page may have: a few MB, which a browser still opens at once.
pub const MAX_PIXELS: u32 = 65_536;

/// Every pixel of a picture of at most [`MAX_PIXELS`] explained in one HTML file. `png` is the
/// picture rendered with the same options, and `finished` how it came out. `watch` is called with the rows done, by any thread.
///
/// # Errors
/// [`Cancelled`].
///
/// # Panics
/// If the picture has more than [`MAX_PIXELS`].
pub fn page(
    scene: &View,
    options: &RenderOptions,
    title: &str,
    (png, finished): (&[u8], &Finished<'_>),
    watch: &(dyn Fn(u32) + Sync),
    cancel: &Cancel,
) -> Result<String, Cancelled> {
    let [width, height] = options.size();
    assert!(u64::from(width) * u64::from(height) <= u64::from(MAX_PIXELS), "too many pixels");
    let shared = Shared { scene };
    let row = |y: u32| {
        if cancel.is_cancelled() {
            return Err(Cancelled);
        }
        // Within the picture, so there is nothing that can be outside.
        let pixels = (0..width).filter_map(|x| explain(scene, options, [x, y]).ok());
        let pixels = pixels.map(|mut told| {
            told.finish_as(finished);
            told
        });
        let row: Vec<Value> = pixels.map(|told| shared.pixel(&told)).collect();
        watch(1);
        Ok(row)
    };
    let band = |band: u32| {
        let rows = (band * BAND..height.min((band + 1) * BAND)).map(row);
        Ok(pack(rows.collect::<Result<_, Cancelled>>()?))
    };
    let bands = (0..height.div_ceil(BAND)).into_par_iter().map(band);
    let bands = bands.collect::<Result<Vec<String>, Cancelled>>()?;
    let samples = options.samples();
    let note = format!(
        "{width} × {height}, {samples} {}.",
        if samples == 1 { "sample a pixel" } else { "samples a pixel" }
    );
    let mut out = PAGE.to_owned();
    for (slot, text) in [
        ("{{title}}", escaped(title)),
        ("{{note}}", note),
        ("{{size}}", json!(options.size()).to_string()),
        ("{{shared}}", in_script(&shared.json().to_string())),
        ("{{bands}}", json!(bands).to_string()),
        ("{{band}}", BAND.to_string()),
        ("{{picture}}", data_url("image/png", png)),
    ] {
        out = out.replace(slot, &text);
    }
    Ok(out)
}

/// What belongs to many pixels.
struct Shared<'a> {
    scene: &'a View,
}

impl Shared<'_> {
    fn json(&self) -> Value {
        let scene = self.scene;
        // Numbered from 1, so that 0 is nothing.
        let mut objects = vec![Value::Null];
        objects.extend(scene.objects().iter().map(|o| json!([o.name, o.place.to_string()])));
        json!({
            "terms": Term::ALL.map(Term::name),
            "objects": objects,
            "lights": scene
                .written_lights()
                .iter()
                .map(|l| json!([l.name, l.place.to_string(), where_from(l)]))
                .collect::<Vec<_>>(),
            "eye": scene.look().camera.eye.to_array(),
            // Where textures vary one, each surface brings its own.
            "materials": scene
                .written_materials()
                .iter()
                .map(|m| material(&m.at(|_| Rgb::WHITE)))
                .collect::<Vec<_>>(),
        })
    }

    fn pixel(&self, told: &Explanation) -> Value {
        let term = |c: Rgb| if c.is_black() { json!(0) } else { rgb(c) };
        let mut out = json!({
            "samples": told
                .samples
                .iter()
                .map(|s| s.ray.as_ref().map(|ray| self.ray(ray, 1.0)))
                .collect::<Vec<_>>(),
            "terms": told.terms.iter().map(|(_, value)| term(value)).collect::<Vec<_>>(),
            "linear": rgb(told.linear),
            "bytes": told.encoded().bytes,
        });
        let steps = toned(told);
        if !steps.is_empty() {
            out["tone"] = steps.iter().map(|step| json!([step.name, rgb(step.color)])).collect();
        }
        out
    }

    /// A ray that weighs `weight` in its sample.
    fn ray(&self, told: &RayTold, weight: f32) -> Value {
        match &told.end {
            End::Background(background) => json!({ "hit": 0, "bg": rgb(*background) }),
            // Shown as what is behind everything: the page tells surfaces.
            End::Light { emission, .. } => json!({ "hit": 0, "bg": rgb(*emission) }),
            End::Surface(surface) => self.surface(surface, weight),
        }
    }

    fn surface(&self, s: &Surface, weight: f32) -> Value {
        let mut out = json!({
            "hit": s.object_number + 1,
            "m": s.material_number,
            "t": number(s.t),
            "out": s.from_outside,
            "eta": s.eta.map(number),
            "p": list(&s.p.as_vec3().to_array()),
            // Mostly the shading normal itself.
            "ng": if s.ng == s.n { Value::Null } else { dir(s.ng) },
            "n": dir(s.n),
            "e": dir(s.e),
            "own": product::own_terms(s)
                .iter()
                .map(|(term, product)| json!([term.name(), written(product)]))
                .collect::<Vec<_>>(),
            "lights": s.lights.iter().map(|lit| light(s, lit)).collect::<Vec<_>>(),
        });
        if !s.textures.is_empty() {
            out["mat"] = material(&s.material);
        }
        if let Some(element) = s.element {
            out["el"] = json!(element + 1);
        }
        for (key, onward) in
            [("refl", &s.reflection), ("trans", &s.transmission), ("through", &s.through)]
        {
            if let Some(onward) = onward {
                out[key] = self.onward(onward, weight * onward.weight.max_channel());
            }
        }
        out
    }

    /// What brings less than one sees is only summed up: glass would fill the page with it.
    fn onward(&self, onward: &Onward, weight: f32) -> Value {
        let mut out = json!({
            "w": rgb(onward.weight),
            "f": onward.fresnel.map(number),
            "c": rgb(onward.weight * onward.light),
        });
        match &onward.ray {
            Some(_) if weight * onward.light.max_channel() < NOTICED => out["small"] = json!(true),
            Some(ray) => out["ray"] = self.ray(ray, weight),
            None => out["cut"] = json!(format!("{}: black", cut(onward.cut))),
        }
        out
    }
}

/// Where a light is, or which way it shines.
fn where_from(light: &Light) -> String {
    let triple = |v: DVec3| format!("({}, {}, {})", v.x, v.y, v.z);
    if let LightKind::Mesh { .. } = light.kind {
        return format!("the mesh {}", light.object);
    }
    match light.kind.direction() {
        Some(direction) => format!("distant, shines along {}", triple(direction)),
        None => format!("at {}", triple(light.kind.position().unwrap_or_default())),
    }
}

/// A term whose factors the page cannot tell from the rest: letters, numbers, and what it comes to.
fn written(term: &Product) -> Value {
    let letters: Vec<&str> = term.factors.iter().map(|factor| &*factor.words).collect();
    let numbers = term.factors.iter().map(|factor| match factor.number {
        Number::One(value) => number(value),
        Number::Color(color) => rgb(color),
    });
    json!([letters.join(" "), numbers.collect::<Vec<_>>(), rgb(term.value)])
}

fn light(s: &Surface, lit: &Lit) -> Value {
    let mut out = Map::new();
    let mut put = |key: &str, value| out.insert(key.to_owned(), value);
    if let Some(why) = hidden(lit) {
        put("why", json!(why));
    }
    if let Some(l) = lit.l {
        put("l", dir(l));
        put("nl", number(lit.n_dot_l));
    }
    if let Some(r) = lit.r {
        put("r", dir(r));
        put("re", number(lit.r_dot_e));
    }
    if let Some(h) = lit.h {
        put("h", dir(h));
        put("nh", number(lit.n_dot_h));
    }
    if let Some(b) = &lit.blocker {
        put("block", json!([named(&b.object, b.element), b.at.to_string(), number(b.t)]));
    }
    if let Some(ambient) = product::ambient_of_light(s, lit) {
        put("a", written(&ambient));
    }
    if lit.visible {
        put("cd", rgb(lit.c_d));
        put("cs", rgb(lit.c_s));
        put("d", rgb(lit.diffuse));
        put("s", rgb(lit.specular));
        if let Some(power) = product::power(s, lit) {
            put("pw", number(power));
        }
        // Of the models that are π f (N·L), the page knows no more, and of opacity nothing.
        let model = s.material.model;
        if !model.is_lambertian() || s.cover < 1.0 {
            put("dp", written(&product::diffuse(s, lit)));
        }
        if (!model.is_power() || s.cover < 1.0)
            && let Some(term) = product::specular(s, lit)
        {
            put("sp", written(&term));
        }
    }
    Value::Object(out)
}

/// What the page must know of a material.
fn material(m: &ConstantMaterial) -> Value {
    let lobe = match m.model {
        Model::Phong => Some("R·E"),
        Model::BlinnPhong | Model::BlinnFast => Some("N·H"),
        _ => None,
    };
    json!({
        "name": m.name,
        "model": described(m),
        "k_d": number(m.k_d),
        "k_s": number(m.k_s),
        "shininess": number(m.shininess),
        "lobe": lobe,
        "fast": m.model == Model::BlinnFast,
        "norm": product::normalization(m).map(number),
        "cosine": m.times_cosine,
        "per_light": m.ambient_rule == AmbientRule::PerLight,
    })
}

/// JSON that stands in a script element: nothing in it may end the element.
fn in_script(json: &str) -> String {
    json.replace("</", "<\\/").replace("<!--", "<\\!--")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_end_the_script() {
        assert_eq!(in_script("{\"n\":\"</script>\"}"), "{\"n\":\"<\\/script>\"}");
    }
}
