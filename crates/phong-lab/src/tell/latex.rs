//! An explanation for a page of mathematics.

use std::fmt::{self, Write};

use glam::DVec3;
use phong::explain::{End, Explanation, LightFrom, Lit, Onward, RayTold, Surface};
use phong::math::Dir3;
use phong_scene::{Model, Rgb};

use super::Telling;
use super::product::{self, Number, Power, Product};
use super::text::{NOTICED, Toned, cut, hidden, named, toned};

/// What all the rest stands in: narrow margins, and equations that may go on over the page's end.
const HEAD: &str = "\\documentclass[10pt]{article}\n\\usepackage[a4paper,margin=20mm]{geometry}\n\
                    \\usepackage{amsmath}\n\\usepackage[T1]{fontenc}\n\
                    \\usepackage[utf8]{inputenc}\n\\allowdisplaybreaks\n\\begin{document}\n";

/// Digits of a number where nothing else is asked for.
const DIGITS: usize = 5;

/// A whole LaTeX document (amsmath): the sum with the numbers of one sample put in, and of what its
/// mirror and glass rays met, each on its own.
pub fn latex(told: &Explanation, telling: &Telling) -> String {
    let sample = telling.sample.unwrap_or(0);
    let mut out = Document {
        text: HEAD.to_owned(),
        digits: telling.digits.unwrap_or(DIGITS).max(1),
        full: telling.full,
        weight: 1.0,
    };
    let ([x, y], [width, height]) = (told.pixel, told.size);
    out.line(format_args!(
        "\\section*{{Pixel $({x}, {y})$ of ${width} \\times {height}$, sample {} of {}}}",
        sample + 1,
        told.samples.len()
    ));
    match told.samples.get(sample).and_then(|sample| sample.ray.as_ref()) {
        Some(ray) => out.ray(ray),
        None => out.line(format_args!("The sample lies outside the image circle: it is black.")),
    }
    let [r, g, b] = told.encoded().shown;
    let linear = out.color(told.linear);
    let mut steps = String::new();
    for Toned { name, color, .. } in toned(told) {
        // Writing to a string cannot fail.
        let _ = write!(steps, " \\;\\xrightarrow{{\\text{{{name}}}}}\\; {}", out.color(color));
    }
    out.line(format_args!(
        "\\[ \\text{{pixel}} = {linear}{steps} \\;\\to\\; \\text{{sRGB bytes }} ({r}, {g}, {b}) \\]"
    ));
    out.line(format_args!("\\end{{document}}"));
    out.text
}

/// The text so far, and how it goes on.
struct Document {
    text: String,
    /// Significant digits.
    digits: usize,
    /// Whether everything is told, however little it brings.
    full: bool,
    /// What the ray being told weighs in the sample.
    weight: f32,
}

impl Document {
    fn line(&mut self, line: fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.text, "{line}");
    }

    fn ray(&mut self, ray: &RayTold) {
        let (from, towards) = (self.point(ray.origin), self.dir(ray.dir));
        let road = format!("The ray from $o = {from}$ towards $d = {towards}$");
        match &ray.end {
            End::Background(background) => {
                let seen = self.color(*background);
                self.line(format_args!("{road} meets nothing and sees ${seen}$."));
            }
            End::Light { name, t, emission, .. } => {
                let (name, t, seen) = (escaped(name), self.n(*t), self.color(*emission));
                self.line(format_args!(
                    "{road} meets {name} itself at $t = {t}$ and sees ${seen}$."
                ));
            }
            End::Surface(s) => {
                let object = escaped(&named(&s.object, s.element));
                let t = self.n(s.t);
                self.line(format_args!("{road} meets {object} at $t = {t}$."));
                self.surface(s);
            }
        }
    }

    fn surface(&mut self, s: &Surface) {
        self.line(format_args!("\\begin{{align*}}"));
        let (p, n, e) = (self.point(s.p), self.dir(s.n), self.dir(s.e));
        self.line(format_args!("p &= o + t d = {p} \\\\"));
        self.line(format_args!("N &= {n} & E &= -d = {e} \\\\"));
        for (_, term) in product::own_terms(s) {
            self.product(&term);
        }
        self.end();
        for lit in &s.lights {
            self.light(s, lit);
        }
        let branches = [
            ("Reflection", &s.reflection),
            ("Transmission", &s.transmission),
            ("Through", &s.through),
        ];
        for (name, onward) in branches {
            if let Some(onward) = onward {
                self.onward(name, onward);
            }
        }
        self.line(format_args!("\\begin{{align*}}"));
        for (term, value) in s.terms.iter().filter(|(_, value)| !value.is_black()) {
            let value = self.color(value);
            self.line(format_args!("\\text{{{}}} &= {value} \\\\", term.name()));
        }
        let sum = self.color(s.terms.total());
        self.line(format_args!("\\text{{sum}} &= {sum}\n\\end{{align*}}"));
    }

    /// A mirror or glass ray: what it met, set in from the left, and what it brings.
    fn onward(&mut self, name: &str, onward: &Onward) {
        self.line(format_args!("\\paragraph{{{name}}}"));
        let outer = self.weight;
        self.weight *= onward.weight.max_channel();
        match &onward.ray {
            Some(_) if !self.full && self.weight * onward.light.max_channel() < NOTICED => {
                self.line(format_args!("It brings less than half a level of 255."));
            }
            Some(ray) => {
                self.line(format_args!("\\begin{{quote}}"));
                self.ray(ray);
                self.line(format_args!("\\end{{quote}}"));
            }
            None => {
                let why = escaped(&cut(onward.cut));
                self.line(format_args!("No ray is sent: {why}."));
            }
        }
        self.weight = outer;
        let brought = onward.weight * onward.light;
        let (weight, light, brought) =
            (self.color(onward.weight), self.color(onward.light), self.color(brought));
        self.line(format_args!(
            "\\begin{{align*}}\n\\text{{{}}} &= \\text{{weight}} \\cdot \\text{{light}} = {weight} \\cdot \
             {light} \\\\\n&= {brought}\n\\end{{align*}}",
            name.to_lowercase()
        ));
    }

    fn light(&mut self, s: &Surface, lit: &Lit) {
        let from = match lit.from {
            LightFrom::Point(p) => format!("at ${}$", self.point(p)),
            LightFrom::Direction(d) => format!("far away, shining along ${}$", self.point(d)),
        };
        self.line(format_args!("\\paragraph{{{}}} {from}.", escaped(&lit.name)));
        let m = &s.material;
        let ambient = product::ambient_of_light(s, lit);
        if let Some(why) = hidden(lit) {
            let why = why.replace("N·L ≤ 0", "$N \\cdot L \\le 0$");
            let what = if ambient.is_some() { "nothing but ambient light" } else { "nothing" };
            self.line(format_args!("{why}: it adds {what}."));
            if let Some(ambient) = ambient {
                self.line(format_args!("\\begin{{align*}}"));
                self.product(&ambient);
                self.end();
            }
            return;
        }
        self.line(format_args!("\\begin{{align*}}"));
        if let Some(l) = lit.l {
            self.line(format_args!(
                "L &= {} & N \\cdot L &= {} \\\\",
                self.dir(l),
                self.n(lit.n_dot_l)
            ));
        }
        if let (Model::Phong, Some(r)) = (m.model, lit.r) {
            self.line(format_args!(
                "R &= 2(L \\cdot N)N - L = {} & R \\cdot E &= {} \\\\",
                self.dir(r),
                self.n(lit.r_dot_e)
            ));
        } else if let Some(h) = lit.h {
            self.line(format_args!(
                "H &= \\frac{{L + E}}{{\\lVert L + E \\rVert}} = {} & N \\cdot H &= {} \\\\",
                self.dir(h),
                self.n(lit.n_dot_h)
            ));
        }
        let terms = [ambient, Some(product::diffuse(s, lit)), product::specular(s, lit)];
        for term in terms.into_iter().flatten() {
            self.product(&term);
        }
        self.end();
    }

    /// Ends lines of equations; a break behind the last would be one line more.
    fn end(&mut self) {
        let kept = self.text.trim_end_matches(" \\\\\n").len();
        self.text.truncate(kept);
        self.text.push_str("\n\\end{align*}\n");
    }

    /// A term: a line for its power, and one for the whole, which multiplies out.
    fn product(&mut self, product: &Product) {
        for factor in &product.factors {
            if let (Some(Power { cosine, exponent }), Number::One(value)) =
                (factor.power, factor.number)
            {
                let base = if cosine < 0.0 {
                    format!("\\max(0, {})", self.n(cosine))
                } else {
                    self.n(cosine)
                };
                let (exponent, value) = (self.n(exponent), self.n(value));
                self.line(format_args!("{} &= {base}^{{{exponent}}} = {value} \\\\", factor.latex));
            }
        }
        let letters: Vec<&str> = product.factors.iter().map(|factor| factor.latex).collect();
        let numbers = product.factors.iter().map(|factor| match factor.number {
            Number::One(value) => self.n(value),
            Number::Color(value) => self.color(value),
        });
        let numbers: Vec<String> = numbers.collect();
        self.line(format_args!(
            "{} &= {} \\\\\n&= {} \\\\",
            letters.join("\\, "),
            numbers.join(" \\cdot "),
            self.color(product.value)
        ));
    }

    fn dir(&self, d: Dir3) -> String {
        self.tuple(d.to_array())
    }

    fn color(&self, c: Rgb) -> String {
        self.tuple(c.to_array())
    }

    fn tuple(&self, [a, b, c]: [f32; 3]) -> String {
        format!("({}, {}, {})", self.n(a), self.n(b), self.n(c))
    }

    /// A number, as a power of ten where plain digits would be many.
    fn n(&self, v: f32) -> String {
        if v == 0.0 || !v.is_finite() {
            return if v == 0.0 { "0".to_owned() } else { "\\infty".to_owned() };
        }
        let scientific = format!("{v:.*e}", self.digits - 1);
        let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
        match exponent.parse::<i32>() {
            Ok(exponent) if !(-4..self.digits.max(5) as i32).contains(&exponent) => {
                format!("{} \\cdot 10^{{{exponent}}}", trimmed(mantissa))
            }
            Ok(exponent) => {
                let decimals = usize::try_from(self.digits as i32 - 1 - exponent).unwrap_or(0);
                trimmed(&format!("{v:.decimals$}")).to_owned()
            }
            Err(_) => format!("\\text{{{v}}}"),
        }
    }

    /// A point in the world.
    fn point(&self, p: DVec3) -> String {
        self.tuple(p.as_vec3().to_array())
    }
}

/// Without trailing zeros behind a point.
fn trimmed(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// Text in which nothing means anything to LaTeX.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => {
                out.push('\\');
                out.push(c);
            }
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_five_digits_and_no_more() {
        for (v, want) in [
            (0.0, "0"),
            (0.1, "0.1"),
            (-0.333_333_34, "-0.33333"),
            (12.345_678, "12.346"),
            (0.000_123_456, "0.00012346"),
            (1.5e-9, "1.5 \\cdot 10^{-9}"),
            (123_456.0, "1.2346 \\cdot 10^{5}"),
            (32.0, "32"),
            (f32::INFINITY, "\\infty"),
        ] {
            let text = String::new();
            let five = Document { text, digits: 5, full: false, weight: 1.0 };
            assert_eq!(five.n(v), want);
        }
    }

    #[test]
    fn names_mean_nothing_to_latex() {
        assert_eq!(escaped(r"a_b \c {50 %}"), r"a\_b \textbackslash{}c \{50 \%\}");
    }
}
