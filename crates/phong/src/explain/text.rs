//! An explanation for a terminal: the equation with the numbers put in.

use std::fmt::{self, Display, Formatter, Write};

use glam::DVec3;
use phong_scene::{Model, Rgb, Viewer};

use super::{Encoded, End, Explanation, Lit, Onward, RayTold, Sample, Surface};
use crate::math::{Dir3, lobe};
use crate::reflectance::Terms;
use crate::reflectance::blinn_phong::rational_lobe;

/// Half a level of 255, where the curve is steepest.
const NOTICED: f32 = 0.5 / 255.0 / 12.92;

impl Explanation {
    /// The explanation in lines of text. Of several samples all are listed and `sample` (from 0)
    /// is told in full; `None`: each is. Mirror and glass rays that bring the sample less than
    /// half a level of 255 are only summed up, unless `full`.
    pub fn text(&self, sample: Option<usize>, full: bool) -> String {
        let mut out = Page { full, weight: 1.0, ..Page::default() };
        let ([x, y], [width, height]) = (self.pixel, self.size);
        out.line(format_args!("pixel ({x}, {y}) of {width} × {height}"));
        if self.samples.len() > 1 {
            out.blank();
            for (i, sample) in self.samples.iter().enumerate() {
                out.line(format_args!("{}", listed(i, sample)));
            }
        }
        for (i, told) in self.samples.iter().enumerate() {
            if sample.is_none_or(|wanted| wanted == i) {
                out.blank();
                out.sample(i, self.samples.len(), told);
            }
        }
        out.blank();
        out.sum(self);
        out.text
    }
}

/// One line about a sample.
fn listed(i: usize, sample: &Sample) -> String {
    let [x, y] = sample.place;
    let met = match sample.ray.as_ref().map(|ray| &ray.end) {
        None => "outside the image circle".to_owned(),
        Some(End::Background(_)) => "background".to_owned(),
        Some(End::Surface(surface)) => named(&surface.object, surface.element),
    };
    format!("sample {:<4} at ({x}, {y})  {met}  {}", i + 1, Color(sample.terms.total()))
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
            "ray      from {} towards {}",
            Position(ray.origin),
            Direction(ray.dir)
        ));
        match &ray.end {
            End::Background(background) => {
                self.line(format_args!("hit      nothing: background {}", Color(*background)));
            }
            End::Surface(surface) => self.surface(surface),
        }
    }

    fn surface(&mut self, s: &Surface) {
        let side = if s.from_outside { "outside" } else { "inside" };
        self.line(format_args!(
            "hit      {} ({}), at t = {}, from {side}",
            named(&s.object, s.element),
            s.at,
            s.t
        ));
        self.line(format_args!("material {}: {}", s.material.name, described(&s.material)));
        self.line(format_args!("p      = {}", Position(s.p)));
        self.line(format_args!("uv     = ({}, {})", s.uv[0], s.uv[1]));
        self.line(format_args!("n_g    = {}", Direction(s.ng)));
        self.line(format_args!("N      = {}", Direction(s.n)));
        self.line(format_args!("E      = {}", Direction(s.e)));
        self.line(format_args!("colour = {}", Color(s.color)));
        self.blank();
        self.line(format_args!(
            "ambient      k_a C_a = {} × {} = {}",
            s.material.k_a,
            Color(s.c_a),
            Color(s.ambient)
        ));
        for light in &s.lights {
            self.blank();
            self.light(s, light);
        }
        for (name, onward) in [("reflection", &s.reflection), ("transmission", &s.transmission)] {
            if let Some(onward) = onward {
                self.blank();
                self.onward(name, onward);
            }
        }
        self.blank();
        self.terms(s.terms);
    }

    fn light(&mut self, s: &Surface, lit: &Lit) {
        if lit.distance.is_finite() {
            self.line(format_args!("{} ({}), {} away", lit.name, lit.at, lit.distance));
        } else {
            self.line(format_args!("{} ({}), distant", lit.name, lit.at));
        }
        self.indent += 2;
        self.vectors(lit);
        let m = &s.material;
        if !lit.ambient.is_black() {
            self.line(format_args!("ambient of this light = {}", Color(lit.ambient)));
        }
        let Some(why) = hidden(lit) else {
            self.line(format_args!(
                "diffuse  = {} = {}",
                diffuse_equation(s, lit),
                Color(lit.diffuse)
            ));
            if has_highlight(m) {
                self.line(format_args!(
                    "specular = {} = {}",
                    specular_equation(s, lit),
                    Color(lit.specular)
                ));
            }
            self.indent -= 2;
            return;
        };
        self.line(format_args!("{why}: diffuse and specular are 0"));
        self.indent -= 2;
    }

    fn vectors(&mut self, lit: &Lit) {
        let Some(l) = lit.l else { return };
        self.line(format_args!("L = {}   N·L = {}", Direction(l), lit.n_dot_l));
        if let Some(r) = lit.r {
            self.line(format_args!("R = {}   R·E = {}", Direction(r), lit.r_dot_e));
        }
        if let Some(h) = lit.h {
            self.line(format_args!("H = {}   N·H = {}", Direction(h), lit.n_dot_h));
        }
        match (&lit.blocker, lit.tested) {
            (Some(b), _) => self.line(format_args!(
                "shadow   {} ({}) stands between, {} away",
                named(&b.object, b.element),
                b.at,
                b.t
            )),
            (None, true) => self.line(format_args!("shadow   nothing stands between")),
            (None, false) => {}
        }
    }

    fn onward(&mut self, name: &str, onward: &Onward) {
        let fresnel = onward.fresnel.map(|f| format!(", F = {f}")).unwrap_or_default();
        self.line(format_args!("{name}, weight {}{fresnel}", Color(onward.weight)));
        self.indent += 2;
        let outer = self.weight;
        self.weight *= onward.weight.max_channel();
        match &onward.ray {
            Some(_) if !self.full && self.weight * onward.light.max_channel() < NOTICED => {
                self.line(format_args!("it brings less than half a level: not told (--full does)"));
            }
            Some(ray) => self.ray(ray),
            None => self.line(format_args!("the depth is used up: black")),
        }
        self.weight = outer;
        self.indent -= 2;
        self.line(format_args!(
            "{name} = {} × {} = {}",
            Color(onward.weight),
            Color(onward.light),
            Color(onward.weight * onward.light)
        ));
    }

    fn terms(&mut self, terms: Terms) {
        for (name, term) in Terms::NAMES.iter().zip(terms.to_array()) {
            if !term.is_black() {
                self.line(format_args!("{name:<12} {}", Color(term)));
            }
        }
        self.line(format_args!("{:<12} {}", "sum", Color(terms.total())));
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
        let Encoded { clamped, curve, bytes: [r, g, b] } = e.encoded(0.0);
        self.line(format_args!("{:<12} {}", "clamped", Color(clamped)));
        let [x, y, z] = curve;
        self.line(format_args!("{:<12} ({x:.6}, {y:.6}, {z:.6})", "sRGB"));
        self.line(format_args!("{:<12} ({r}, {g}, {b})  #{r:02x}{g:02x}{b:02x}", "bytes"));
        self.indent -= 2;
    }
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

fn has_highlight(material: &phong_scene::Material) -> bool {
    !matches!(material.model, Model::Lambert | Model::OrenNayar { .. })
}

fn diffuse_equation(s: &Surface, lit: &Lit) -> String {
    let k_d = s.material.k_d;
    match s.material.model {
        Model::OrenNayar { .. } => {
            format!("k_d π f (N·L) C_d, k_d = {k_d}, C_d = {}", Color(lit.c_d))
        }
        _ => format!("k_d (N·L) C_d = {k_d} × {} × {}", lit.n_dot_l, Color(lit.c_d)),
    }
}

fn specular_equation(s: &Surface, lit: &Lit) -> String {
    let m = &s.material;
    let (cosine, name) = match m.model {
        Model::Phong => (lit.r_dot_e, "R·E"),
        Model::BlinnPhong => (lit.n_dot_h, "N·H"),
        Model::BlinnFast => {
            let (x, alpha) = (lit.n_dot_h, m.shininess);
            return format!(
                "k_s x/(α − αx + x) C_s{} = {} × {} × {}{}, x = N·H = {x}, α = {alpha}",
                factors(m),
                m.k_s,
                Digits(rational_lobe(x, alpha)),
                Color(lit.c_s),
                factors(m),
            );
        }
        _ => return format!("k_s π f (N·L) C_s, k_s = {}, C_s = {}", m.k_s, Color(lit.c_s)),
    };
    let alpha = m.shininess;
    let power = lobe(cosine.max(0.0), alpha);
    let factors = factors(m);
    format!(
        "k_s ({name})^{alpha} C_s{factors} = {} × {} × {}{factors}",
        m.k_s,
        Digits(power),
        Color(lit.c_s)
    )
}

/// What multiplies the lobe besides, by the material's switches.
pub(super) fn factors(m: &phong_scene::Material) -> &'static str {
    match (m.normalize, m.times_cosine) {
        (false, false) => "",
        (true, false) => " × normalisation",
        (false, true) => " × N·L",
        (true, true) => " × normalisation × N·L",
    }
}

/// A material's model and numbers in a few words.
pub(super) fn described(m: &phong_scene::Material) -> String {
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

/// A number with all its digits, in powers of ten where they would begin with many zeros.
pub(super) struct Digits(pub(super) f32);

impl Display for Digits {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let v = self.0;
        if v == 0.0 || (1e-4..1e9).contains(&v.abs()) {
            write!(f, "{v}")
        } else {
            write!(f, "{v:e}")
        }
    }
}

/// A point in the world; f32s, moved in f64 only where the scene was far from the origin.
struct Position(DVec3);

impl Display for Position {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let number = |v: f64| {
            if f64::from(v as f32) == v { (v as f32).to_string() } else { v.to_string() }
        };
        let DVec3 { x, y, z } = self.0;
        write!(f, "({}, {}, {})", number(x), number(y), number(z))
    }
}

/// A colour with all its digits.
pub(super) struct Color(pub(super) Rgb);

impl Display for Color {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0.to_array();
        write!(f, "({}, {}, {})", Digits(r), Digits(g), Digits(b))
    }
}

/// A direction with all its digits.
pub(super) struct Direction(pub(super) Dir3);

impl Display for Direction {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.to_array();
        write!(f, "({}, {}, {})", Digits(x), Digits(y), Digits(z))
    }
}
