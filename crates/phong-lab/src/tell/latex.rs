//! An explanation for a page of mathematics.

use std::fmt::Write;

use phong::explain::{End, Explanation, Lit, RayTold, Surface};
use phong::math::Dir3;
use phong_scene::{Model, Rgb};

use super::product::{self, Number, Power, Product};
use super::text::{hidden, named};

/// What all the rest stands in.
const HEAD: &str = "\\documentclass{article}\n\\usepackage{amsmath}\n\\usepackage[T1]{fontenc}\n\
                    \\begin{document}\n";

/// A whole LaTeX document (amsmath): the sum with the numbers of sample `sample` (from 0) put
/// in, five significant digits each.
pub fn latex(told: &Explanation, sample: usize) -> String {
    let mut out = HEAD.to_owned();
    let ([x, y], [width, height]) = (told.pixel, told.size);
    // Writing to a String cannot fail.
    let _ = writeln!(
        out,
        "\\section*{{Pixel $({x}, {y})$ of ${width} \\times {height}$, sample {} of {}}}",
        sample + 1,
        told.samples.len()
    );
    match told.samples.get(sample).and_then(|sample| sample.ray.as_ref()) {
        Some(ray) => of_ray(&mut out, ray),
        None => out.push_str("The sample lies outside the image circle: it is black.\n"),
    }
    let [r, g, b] = told.encoded(0.0).bytes;
    let _ = writeln!(
        out,
        "\\[ \\text{{pixel}} = {} \\;\\to\\; \\text{{sRGB bytes }} ({r}, {g}, {b}) \\]",
        color(told.linear)
    );
    out.push_str("\\end{document}\n");
    out
}

fn of_ray(out: &mut String, ray: &RayTold) {
    match &ray.end {
        End::Background(background) => {
            let _ = writeln!(out, "The ray meets nothing and sees ${}$.", color(*background));
        }
        End::Surface(s) => surface(out, s),
    }
}

fn surface(out: &mut String, s: &Surface) {
    let _ = writeln!(
        out,
        "The ray meets {} at $t = {}$.\n\\begin{{align*}}",
        escaped(&named(&s.object, s.element)),
        n(s.t)
    );
    let _ = writeln!(out, "N &= {} & E &= {} \\\\", dir(s.n), dir(s.e));
    for (_, term) in product::own_terms(s) {
        product(out, &term);
    }
    end(out);
    for lit in &s.lights {
        light(out, s, lit);
    }
    for (name, onward) in [("reflection", &s.reflection), ("transmission", &s.transmission)] {
        let Some(onward) = onward else { continue };
        let _ = writeln!(
            out,
            "\\[ \\text{{{name}}} = {} \\cdot {} = {} \\]",
            color(onward.weight),
            color(onward.light),
            color(onward.weight * onward.light)
        );
    }
    let _ = writeln!(out, "\\begin{{align*}}");
    for (term, value) in s.terms.iter().filter(|(_, value)| !value.is_black()) {
        let _ = writeln!(out, "\\text{{{}}} &= {} \\\\", term.name(), color(value));
    }
    let _ = writeln!(out, "\\text{{sum}} &= {}\n\\end{{align*}}", color(s.terms.total()));
}

fn light(out: &mut String, s: &Surface, lit: &Lit) {
    let _ = writeln!(out, "\\paragraph{{{}}}", escaped(&lit.name));
    let m = &s.material;
    let ambient = product::ambient_of_light(s, lit);
    if let Some(why) = hidden(lit) {
        let why = why.replace("N·L ≤ 0", "$N \\cdot L \\le 0$");
        let what = if ambient.is_some() { "nothing but ambient light" } else { "nothing" };
        let _ = writeln!(out, "{why}: it adds {what}.");
        if let Some(ambient) = ambient {
            out.push_str("\\begin{align*}\n");
            product(out, &ambient);
            end(out);
        }
        return;
    }
    let _ = writeln!(out, "\\begin{{align*}}");
    if let Some(l) = lit.l {
        let _ = writeln!(out, "L &= {} & N \\cdot L &= {} \\\\", dir(l), n(lit.n_dot_l));
    }
    if let (Model::Phong, Some(r)) = (m.model, lit.r) {
        let _ = writeln!(
            out,
            "R &= 2(L \\cdot N)N - L = {} & R \\cdot E &= {} \\\\",
            dir(r),
            n(lit.r_dot_e)
        );
    } else if let Some(h) = lit.h {
        let _ = writeln!(
            out,
            "H &= \\frac{{L + E}}{{\\lVert L + E \\rVert}} = {} & N \\cdot H &= {} \\\\",
            dir(h),
            n(lit.n_dot_h)
        );
    }
    let terms = [ambient, Some(product::diffuse(s, lit)), product::specular(s, lit)];
    for term in terms.into_iter().flatten() {
        product(out, &term);
    }
    end(out);
}

/// Ends lines of equations; a break behind the last would be one line more.
fn end(out: &mut String) {
    let kept = out.trim_end_matches(" \\\\\n").len();
    out.truncate(kept);
    out.push_str("\n\\end{align*}\n");
}

/// A term: a line for its power, and one for the whole, which multiplies out.
fn product(out: &mut String, product: &Product) {
    for factor in &product.factors {
        if let (Some(Power { cosine, exponent }), Number::One(value)) =
            (factor.power, factor.number)
        {
            let base = if cosine < 0.0 { format!("\\max(0, {})", n(cosine)) } else { n(cosine) };
            let (exponent, value) = (n(exponent), n(value));
            let _ = writeln!(out, "{} &= {base}^{{{exponent}}} = {value} \\\\", factor.latex);
        }
    }
    let letters: Vec<&str> = product.factors.iter().map(|factor| factor.latex).collect();
    let numbers = product.factors.iter().map(|factor| match factor.number {
        Number::One(value) => n(value),
        Number::Color(value) => color(value),
    });
    let numbers: Vec<String> = numbers.collect();
    let _ = writeln!(
        out,
        "{} &= {} = {} \\\\",
        letters.join("\\, "),
        numbers.join(" \\cdot "),
        color(product.value)
    );
}

fn dir(d: Dir3) -> String {
    tuple(d.to_array())
}

fn color(c: Rgb) -> String {
    tuple(c.to_array())
}

fn tuple([a, b, c]: [f32; 3]) -> String {
    format!("({}, {}, {})", n(a), n(b), n(c))
}

/// Five significant digits, as a power of ten where plain digits would be many.
fn n(v: f32) -> String {
    if v == 0.0 || !v.is_finite() {
        return if v == 0.0 { "0".to_owned() } else { "\\infty".to_owned() };
    }
    let scientific = format!("{v:.4e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    match exponent.parse::<i32>() {
        Ok(exponent) if !(-4..5).contains(&exponent) => {
            format!("{} \\cdot 10^{{{exponent}}}", trimmed(mantissa))
        }
        Ok(exponent) => {
            let decimals = usize::try_from(4 - exponent).unwrap_or(0);
            trimmed(&format!("{v:.decimals$}")).to_owned()
        }
        Err(_) => format!("\\text{{{v}}}"),
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
            assert_eq!(n(v), want);
        }
    }

    #[test]
    fn names_mean_nothing_to_latex() {
        assert_eq!(escaped(r"a_b \c {50 %}"), r"a\_b \textbackslash{}c \{50 \%\}");
    }
}
