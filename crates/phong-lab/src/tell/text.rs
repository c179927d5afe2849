//! An explanation for a terminal: the equation with the numbers put in.

use std::fmt::{self, Write};

use glam::DVec3;
use phong::explain::{
    Encoded, End, Explanation, LightFrom, Lit, Onward, Openness, RayTold, Sample, Surface,
    TextureTold,
};
use phong::terms::Terms;
use phong::texture::ImageLookUp;
use phong::witness::{CutReason, Faded};
use phong_scene::{AmbientRule, ConstantMaterial, Model, Rgb, TextureSpace, ToneCurve, Viewer};

use super::Telling;
use super::numbers::{Numbers, columns};
use super::product::{self, Factor, Number, Power, Product};

/// Half a level of 255, where the curve is steepest.
pub(super) const NOTICED: f32 = 0.5 / 255.0 / 12.92;

/// Why a ray was not sent.
pub(super) fn cut(reason: Option<CutReason>) -> String {
    match reason {
        Some(CutReason::Weight(least)) => format!("not followed, for it counts less than {least}"),
        Some(CutReason::Depth) | None => "the depth is used up".to_owned(),
    }
}

/// The explanation in lines of text. Of several samples all are listed. Mirror and glass rays that
/// bring a sample less than half a level of 255 are only summed up, unless all is to be told.
pub fn text(told: &Explanation, telling: &Telling) -> String {
    let Telling { sample, full, digits } = *telling;
    let numbers = Numbers { digits };
    let mut out = Page { full, numbers, eye: told.eye, weight: 1.0, ..Page::default() };
    let ([x, y], [width, height]) = (told.pixel, told.size);
    out.line(format_args!("pixel ({x}, {y}) of {width} × {height}"));
    if told.samples.len() > 1 {
        out.blank();
        for (i, sample) in told.samples.iter().enumerate() {
            out.line(format_args!("{}", listed(i, sample, numbers)));
        }
    }
    for (i, one) in told.samples.iter().enumerate() {
        if sample.is_none_or(|wanted| wanted == i) {
            out.blank();
            out.sample(i, told.samples.len(), one);
        }
    }
    out.blank();
    out.sum(told);
    out.text
}

/// One line about a sample.
fn listed(i: usize, sample: &Sample, numbers: Numbers) -> String {
    let [x, y] = sample.place;
    let met = match sample.ray.as_ref().map(|ray| &ray.end) {
        None => "outside the image circle".to_owned(),
        Some(End::Background(_)) => "background".to_owned(),
        Some(End::Light { name, .. }) => name.clone(),
        Some(End::Surface(surface)) => named(&surface.object, surface.element),
    };
    format!("sample {:<4} at ({x}, {y})  {met}  {}", i + 1, numbers.color(sample.terms.total()))
}

/// An object's name, with the face or point of it.
pub(super) fn named(object: &str, element: Option<u32>) -> String {
    match element {
        Some(element) => format!("{object}, element {}", element + 1),
        None => object.to_owned(),
    }
}

/// Lines with an indentation.
#[derive(Default)]
struct Page {
    text: String,
    indent: usize,
    /// Whether everything is told, however little it brings.
    full: bool,
    numbers: Numbers,
    /// The camera's eye.
    eye: DVec3,
    /// What the ray being told weighs in the sample.
    weight: f32,
}

impl Page {
    fn line(&mut self, line: fmt::Arguments<'_>) {
        let indent = self.indent;
        // Writing to a String cannot fail.
        let _ = writeln!(self.text, "{:indent$}{line}", "");
    }

    fn blank(&mut self) {
        self.text.push('\n');
    }

    fn sample(&mut self, i: usize, of: usize, sample: &Sample) {
        let [x, y] = sample.place;
        self.line(format_args!("sample {} of {of} at ({x}, {y}), weight {}", i + 1, sample.weight));
        self.indent += 2;
        match &sample.ray {
            Some(ray) => self.ray(ray),
            None => self.line(format_args!("outside the image circle: black")),
        }
        self.indent -= 2;
    }

    fn ray(&mut self, ray: &RayTold) {
        self.line(format_args!(
            "ray      from {}o = {} towards d = {}",
            if ray.origin == self.eye { "the eye, " } else { "" },
            self.numbers.position(ray.origin),
            self.numbers.direction(ray.dir)
        ));
        match &ray.end {
            End::Background(background) => {
                self.line(format_args!(
                    "hit      nothing: background {}",
                    self.numbers.color(*background)
                ));
            }
            End::Light { name, t, emission, .. } => {
                let seen = self.numbers.color(*emission);
                self.line(format_args!("hit      {name} itself, at t = {t}: emission {seen}"));
            }
            End::Surface(surface) => self.surface(surface),
        }
        if let Some(fog) = &ray.fog {
            self.fog(fog, ray.terms());
        }
    }

    fn fog(&mut self, fog: &Faded, terms: Terms) {
        let Faded { distance, clear, color, light } = *fog;
        self.blank();
        let f = self.numbers.one(1.0 - clear);
        self.line(format_args!(
            "fog, f = {f} at a distance of {}: each term counts {}",
            self.numbers.one(distance),
            self.numbers.one(clear),
        ));
        let color = self.numbers.color(color);
        self.equation(
            "fog      = f × colour",
            &[format!("{f} × {color}"), self.numbers.color(light)],
        );
        self.terms(terms);
    }

    fn surface(&mut self, s: &Surface) {
        let side = if s.from_outside { "outside" } else { "inside" };
        self.line(format_args!(
            "hit      {} ({}), at t = {}, from {side}",
            named(&s.object, s.element),
            s.at,
            self.numbers.one(s.t)
        ));
        if let Some(clip) = s.cap {
            self.line(format_args!("cap      it is cut there by clip {}", clip + 1));
        }
        let m = &s.material;
        let place = if m.place.file.is_empty() {
            " (the default material)".to_owned()
        } else {
            format!(" ({})", m.place)
        };
        self.line(format_args!("material {}{place}: {}", m.name, described(m)));
        if let Some(eta) = s.eta {
            let eta = self.numbers.one(eta);
            self.line(format_args!("glass    meets glass: the index beyond is {eta} of that here"));
        }
        for told in &s.textures {
            let TextureTold { parameter, texture, space, place, image, number, value } = told;
            let space = spaced(*space);
            self.line(format_args!(
                "texture  {parameter}: {texture} at {} in {space}{}{} is {}",
                self.numbers.position(*place),
                image.map_or(String::new(), looked_up),
                number.as_ref().map_or(String::new(), |(of, number)| shown(of, *number)),
                self.numbers.color(*value)
            ));
        }
        let [u, v] = s.uv.map(|v| self.numbers.one(v));
        self.line(format_args!("uv       ({u}, {v})"));
        self.table(&[
            ("colour  ", self.numbers.color(s.color)),
            ("p       ", self.numbers.position(s.p) + "   = o + t d"),
            ("n_g     ", self.numbers.direction(s.ng)),
            ("N       ", self.numbers.direction(s.n)),
            ("E       ", self.numbers.direction(s.e) + "   = -d"),
        ]);
        self.blank();
        if let Some(Openness { share, rays, distance, sky }) = s.openness {
            let met = (share * rays as f32).round();
            let distance = self.numbers.one(distance);
            self.line(format_args!(
                "openness = {met} of {rays} rays meet nothing within {distance}"
            ));
            if let Some(sky) = sky {
                let mean = self.numbers.color(sky);
                self.line(format_args!(
                    "sky      = {mean}: its mean over these rays, 0 where they meet"
                ));
            }
        }
        if s.material.ambient_rule == AmbientRule::PerLight {
            self.line(format_args!("ambient  is added by each light"));
        }
        for (term, product) in product::own_terms(s) {
            self.product(term.name(), s, &product);
        }
        for light in &s.lights {
            self.blank();
            self.light(s, light);
        }
        for (name, onward) in [
            ("reflection", &s.reflection),
            ("transmission", &s.transmission),
            ("through", &s.through),
        ] {
            if let Some(onward) = onward {
                self.blank();
                self.onward(name, onward);
            }
        }
        self.blank();
        self.terms(s.terms);
    }

    fn light(&mut self, s: &Surface, lit: &Lit) {
        let from = match lit.from {
            LightFrom::Point(p) => {
                let (p, distance) = (self.numbers.position(p), self.numbers.one(lit.distance));
                format!("at {p}, {distance} away from p")
            }
            LightFrom::Direction(d) => {
                format!("distant, shines along {}", self.numbers.position(d))
            }
        };
        self.line(format_args!("{} ({}), {from}", lit.name, lit.at));
        self.indent += 2;
        self.vectors(lit);
        if let Some(ambient) = product::ambient_of_light(s, lit) {
            self.product("ambient", s, &ambient);
        }
        if let Some(why) = hidden(lit) {
            self.line(format_args!("{why}: diffuse and specular are 0"));
        } else {
            let (light, color) = (self.numbers.color(lit.color), self.numbers.color(s.color));
            if lit.visibility == Rgb::WHITE {
                self.line(format_args!("C_d      = light × colour = {light} × {color}"));
            } else {
                let left = self.numbers.color(lit.visibility);
                self.line(format_args!(
                    "C_d      = light × visibility × colour = {light} × {left} × {color}"
                ));
            }
            self.product("diffuse", s, &product::diffuse(s, lit));
            if let Some(specular) = product::specular(s, lit) {
                self.product("specular", s, &specular);
            }
        }
        self.indent -= 2;
    }

    fn vectors(&mut self, lit: &Lit) {
        let Some(l) = lit.l else { return };
        let mut rows = vec![("L", l, "N·L", lit.n_dot_l)];
        rows.extend(lit.r.map(|r| ("R", r, "R·E", lit.r_dot_e)));
        rows.extend(lit.h.map(|h| ("H", h, "N·H", lit.n_dot_h)));
        let written: Vec<String> = rows.iter().map(|row| self.numbers.direction(row.1)).collect();
        for ((name, _, product, cosine), vector) in rows.iter().zip(columns(&written)) {
            let cosine = self.numbers.one(*cosine);
            self.line(format_args!("{name}        = {vector}   {product} = {cosine}"));
        }
        match (&lit.blocker, lit.tested) {
            (Some(b), _) => self.line(format_args!(
                "shadow   : {} ({}) stands between, {} away",
                named(&b.object, b.element),
                b.at,
                self.numbers.one(b.t)
            )),
            (None, true) => self.line(format_args!("shadow   : nothing stands between")),
            (None, false) if lit.visible => self.line(format_args!("shadow   : not looked for")),
            (None, false) => {}
        }
        if let Some(start) = lit.lifted {
            let start = self.numbers.position(start);
            self.line(format_args!("           looked for from {start}, above the face"));
        }
    }

    fn onward(&mut self, name: &str, onward: &Onward) {
        let fresnel =
            onward.fresnel.map(|f| format!(", F = {}", self.numbers.one(f))).unwrap_or_default();
        self.line(format_args!("{name}, weight {}{fresnel}", self.numbers.color(onward.weight)));
        self.indent += 2;
        let outer = self.weight;
        self.weight *= onward.weight.max_channel();
        match &onward.ray {
            Some(_) if !self.full && self.weight * onward.light.max_channel() < NOTICED => {
                self.line(format_args!("it brings less than half a level: not told (--full does)"));
            }
            Some(ray) => self.ray(ray),
            None => {
                let (why, most) = (cut(onward.cut), self.numbers.color(onward.path_weight));
                self.line(format_args!("{why}: black; light of 1 there would have added {most}"));
            }
        }
        self.weight = outer;
        self.indent -= 2;
        self.equation(
            &format!("{name:<12} = weight × light"),
            &[
                format!(
                    "{} × {}",
                    self.numbers.color(onward.weight),
                    self.numbers.color(onward.light)
                ),
                self.numbers.color(onward.weight * onward.light),
            ],
        );
    }

    fn product(&mut self, name: &str, s: &Surface, term: &Product) {
        let (letters, steps) = product(name, &s.material, term, self.numbers);
        self.equation(&letters, &steps);
    }

    /// An equation, and under its sign of equality what it comes to.
    fn equation(&mut self, equation: &str, steps: &[String]) {
        self.line(format_args!("{equation}"));
        let before = equation.find('=').unwrap_or(0);
        for step in steps {
            self.line(format_args!("{:before$}= {step}", ""));
        }
    }

    fn table(&mut self, rows: &[(&str, String)]) {
        let triples: Vec<String> = rows.iter().map(|row| row.1.clone()).collect();
        for ((name, _), triple) in rows.iter().zip(columns(&triples)) {
            self.line(format_args!("{name} = {}", triple.trim_end()));
        }
    }

    fn terms(&mut self, terms: Terms) {
        let shown = terms.iter().filter(|(_, value)| !value.is_black());
        let mut rows: Vec<_> = shown.map(|(term, value)| (term.name(), value)).collect();
        rows.push(("sum", terms.total()));
        let written: Vec<String> = rows.iter().map(|row| self.numbers.color(row.1)).collect();
        for ((name, _), triple) in rows.iter().zip(columns(&written)) {
            self.line(format_args!("{name:<12} {}", triple.trim_end()));
        }
    }

    fn bytes(&mut self, name: &str, [r, g, b]: [u8; 3], how: &str) {
        self.line(format_args!("{name:<12} ({r}, {g}, {b})  #{r:02x}{g:02x}{b:02x}{how}"));
    }

    fn sum(&mut self, e: &Explanation) {
        self.line(format_args!(
            "the pixel: {} in f64, each term rounded to f32",
            match e.samples.len() {
                1 => "its sample".to_owned(),
                n => format!("the weighted mean of {n} samples"),
            }
        ));
        self.indent += 2;
        self.terms(e.terms);
        if e.alpha < 1.0 {
            self.line(format_args!("{:<12} {}", "alpha", e.alpha));
        }
        for Toned { name, how, color } in toned(e) {
            self.line(format_args!("{name:<12} {}   {how}", self.numbers.color(color)));
        }
        let Encoded { clamped, curve, bytes, shown, .. } = e.encoded();
        self.line(format_args!("{:<12} {}", "clamped", self.numbers.color(clamped)));
        let [x, y, z] = curve;
        self.line(format_args!("{:<12} ({x:.6}, {y:.6}, {z:.6})", "sRGB"));
        self.bytes("bytes", bytes, "");
        for &[r, g, b, a] in e.furniture.iter().flat_map(|piece| &piece.pixels) {
            let how = format!("   furniture that covers {} of it", share(a));
            self.bytes("covered", [r, g, b], &how);
        }
        if !e.furniture.is_empty() {
            self.bytes("shown", shown, "");
        }
        self.indent -= 2;
    }
}

/// How much of a pixel something of this opacity covers.
pub(super) fn share(opacity: u8) -> f32 {
    f32::from(opacity) / 255.0
}

/// A step of a pixel's light on its way into a PNG.
pub(super) struct Toned {
    pub(super) name: &'static str,
    /// What was done to what was there before.
    pub(super) how: String,
    /// What came of it. Linear.
    pub(super) color: Rgb,
}

/// What steps of luminance, lines and tone do to a pixel, one after the other; nothing where light stays as it is.
pub(super) fn toned(told: &Explanation) -> Vec<Toned> {
    let Encoded { stepped, tone: steps, .. } = told.encoded();
    let stops = told.tone.stops();
    let from = match told.lined {
        Some(_) => "outlined",
        None if stepped.is_some() => "stepped",
        None => "linear",
    };
    let scale = told.cel.unwrap_or(1.0);
    let stepped = stepped
        .map(|color| ("stepped", format!("= linear × {scale}: the step of its luminance"), color));
    let outlined = told.lined.map(|lined| {
        let how = format!("a line of the outline covers {} of it", lined.share);
        ("outlined", how, lined.linear)
    });
    let exposed =
        (stops != 0.0).then(|| ("exposed", format!("= {from} × 2^{stops}"), steps.exposed));
    let balanced = steps.balanced.map(|color| ("balanced", "white balance".to_owned(), color));
    let curve = match told.tone.curve() {
        ToneCurve::Clamp => String::new(),
        ToneCurve::Reinhard { white } => format!("Reinhard's curve, white at {white}"),
        ToneCurve::Filmic => "filmic curve".to_owned(),
    };
    let curved = steps.curved.map(|color| ("toned", curve, color));
    let steps = stepped.into_iter().chain(outlined).chain(exposed).chain(balanced).chain(curved);
    steps.map(|(name, how, color)| Toned { name, how, color }).collect()
}

/// Why a light adds nothing; `None` if it does.
pub(super) fn hidden(lit: &Lit) -> Option<&'static str> {
    if lit.visible {
        None
    } else if lit.l.is_none() {
        Some("the point is where the light is")
    } else if lit.n_dot_l <= 0.0 {
        Some("N·L ≤ 0, the light is behind the surface")
    } else if !lit.above {
        Some("the light is below the geometric horizon")
    } else if !lit.tested {
        Some("no light comes this way")
    } else {
        Some("in shadow")
    }
}

/// A term in letters, and step by step in numbers.
fn product(
    name: &str,
    m: &ConstantMaterial,
    product: &Product,
    numbers: Numbers,
) -> (String, Vec<String>) {
    let letters: Vec<&str> = product.factors.iter().map(|factor| &*factor.words).collect();
    let mut letters = format!("{name:<8} = {}", letters.join(" "));
    if name == "specular" && m.model == Model::BlinnFast {
        let _ = write!(letters, ", x = N·H, α = {}", m.shininess);
    }
    let number = |factor: &Factor| match factor.number {
        Number::One(number) => numbers.one(number),
        Number::Color(color) => numbers.color(color),
    };
    let raised = |factor: &Factor| match factor.power {
        None => number(factor),
        Some(Power { cosine, exponent }) if cosine < 0.0 => {
            format!("max(0, {})^{exponent}", numbers.one(cosine))
        }
        Some(Power { cosine, exponent }) => format!("{}^{exponent}", numbers.one(cosine)),
    };
    let line = |of: &dyn Fn(&Factor) -> String| {
        product.factors.iter().map(of).collect::<Vec<String>>().join(" × ")
    };
    let mut steps = vec![line(&raised)];
    if product.factors.iter().any(|factor| factor.power.is_some()) {
        steps.push(line(&number));
    }
    steps.push(numbers.color(product.value));
    (letters, steps)
}

/// How an image is looked up.
fn looked_up(ImageLookUp { level, taps }: ImageLookUp) -> String {
    match (level, taps) {
        (0.0, 1) => String::new(),
        (level, 1) => format!(" (halved {level:.2} times)"),
        (level, taps) => format!(" (halved {level:.2} times, {taps} places)"),
    }
}

/// What a map shows.
fn shown(of: &str, number: f64) -> String {
    if number.is_finite() { format!(", {of} {number:.6}") } else { format!(", no {of}") }
}

/// The space that a texture lies in.
fn spaced(space: TextureSpace) -> &'static str {
    match space {
        TextureSpace::Object => "the object's space",
        TextureSpace::World => "the world",
        TextureSpace::Uv => "uv",
    }
}

/// A material's model and numbers in a few words.
pub(super) fn described(m: &ConstantMaterial) -> String {
    match m.model {
        Model::Lambert => format!("Lambert, k_a {}, k_d {}", m.k_a, m.k_d),
        Model::Phong | Model::BlinnPhong | Model::BlinnFast => {
            let name = match m.model {
                Model::Phong => "Phong",
                Model::BlinnFast => "Blinn, fast",
                _ => "Blinn–Phong",
            };
            let viewer = match m.viewer {
                Viewer::Local => "",
                Viewer::Distant => ", seen from far along the camera's axis",
            };
            format!(
                "{name}, k_a {}, k_d {}, k_s {}, α {}{viewer}",
                m.k_a, m.k_d, m.k_s, m.shininess
            )
        }
        Model::Microfacet { distribution, roughness, shadowing, fresnel } => format!(
            "microfacets ({distribution:?} {roughness}, {shadowing:?} shadowing, {fresnel:?}), \
             k_a {}, k_d {}, k_s {}",
            m.k_a, m.k_d, m.k_s
        ),
        Model::OrenNayar { sigma, .. } => {
            format!("Oren–Nayar, σ {sigma} rad, k_a {}, k_d {}", m.k_a, m.k_d)
        }
        Model::Ward { roughness_x, roughness_y, .. } => format!(
            "Ward, roughness {roughness_x} × {roughness_y}, k_a {}, k_d {}, k_s {}",
            m.k_a, m.k_d, m.k_s
        ),
    }
}
