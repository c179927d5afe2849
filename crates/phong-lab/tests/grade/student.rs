//! A student's ray tracer: spheres, planes, point and distant lights, in f64, by itself. It shares
//! no code with the project, and can be told to make mistakes, each by its name.

pub(crate) type V = [f64; 3];

/// Mistakes, by name; see the uses of `Slips::has` below.
#[derive(Clone, Copy)]
pub(crate) struct Slips<'a>(pub(crate) &'a [&'a str]);

impl Slips<'_> {
    fn has(self, slip: &str) -> bool {
        self.0.contains(&slip)
    }
}

#[derive(Clone, Copy)]
pub(crate) enum Body {
    Sphere {
        c: V,
        r: f64,
    },
    /// y = height.
    Floor {
        height: f64,
    },
}

#[derive(Clone, Copy)]
pub(crate) struct Stuff {
    /// Levels of 255 on the sRGB curve.
    pub(crate) hex: [u8; 3],
    pub(crate) k_a: f64,
    pub(crate) k_d: f64,
    pub(crate) k_s: f64,
    pub(crate) alpha: f64,
    pub(crate) blinn: bool,
}

#[derive(Clone, Copy)]
pub(crate) struct Thing {
    pub(crate) body: Body,
    pub(crate) stuff: Stuff,
}

#[derive(Clone, Copy)]
pub(crate) enum From {
    Point(V),
    /// The way it travels.
    Sun(V),
}

#[derive(Clone, Copy)]
pub(crate) struct Lamp {
    pub(crate) from: From,
    pub(crate) color: V,
    pub(crate) shadows: bool,
    /// Divides the light by 1 + this · distance.
    pub(crate) fades: f64,
}

#[derive(Clone)]
pub(crate) struct World {
    pub(crate) size: [u32; 2],
    pub(crate) eye: V,
    pub(crate) at: V,
    pub(crate) fov: f64,
    pub(crate) background: V,
    pub(crate) things: Vec<Thing>,
    pub(crate) lamps: Vec<Lamp>,
}

fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}
fn mul(a: V, k: f64) -> V {
    a.map(|x| x * k)
}
fn times(a: V, b: V) -> V {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}
fn sub(a: V, b: V) -> V {
    add(a, mul(b, -1.0))
}
pub(crate) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn unit(a: V) -> V {
    mul(a, 1.0 / dot(a, a).sqrt())
}

fn hit(body: Body, o: V, d: V, far: bool) -> Option<f64> {
    let t = match body {
        Body::Sphere { c, r } => {
            let oc = sub(o, c);
            let b = dot(oc, d);
            let disc = b * b - dot(oc, oc) + r * r;
            if disc < 0.0 {
                return None;
            }
            let near = -b - disc.sqrt();
            if near > 1e-6 && !far { near } else { -b + disc.sqrt() }
        }
        Body::Floor { height } => (height - o[1]) / d[1],
    };
    (t > 1e-6 && t.is_finite()).then_some(t)
}

/// A number in [0, 1) that looks random.
fn noise(seed: u64) -> f64 {
    let mut x = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x ^= x >> 29;
    x = x.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((x ^ (x >> 32)) & 0xffff) as f64 / 65536.0
}

fn linear(hex: [u8; 3]) -> V {
    hex.map(|level| {
        let v = f64::from(level) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    })
}

/// The colour of a material.
pub(crate) fn color(stuff: &Stuff, slips: Slips) -> V {
    if slips.has("hex as it is") {
        stuff.hex.map(|level| f64::from(level) / 255.0)
    } else {
        linear(stuff.hex)
    }
}

/// A ray's hit, as shading sees it.
struct Met {
    p: V,
    d: V,
    /// Of the ray through the screen, before it was made 1.
    long: f64,
    number: usize,
    seed: u64,
}

fn shade(w: &World, slips: Slips, met: &Met) -> V {
    let is = |slip: &str| slips.has(slip);
    let Met { p, d, number, .. } = *met;
    let mut stuff = w.things[number].stuff;
    if is("first two materials swapped") && number < 2 {
        stuff = w.things[1 - number].stuff;
    }
    let only = |slip: &str| is(&format!("{slip}, first ball")) && number == 0;
    if is("k_d ignored") {
        stuff.k_d = 1.0;
    }
    if is("k_s ignored") || only("k_s ignored") {
        stuff.k_s = 1.0;
    }
    if is("k_a ignored") {
        stuff.k_a = 1.0;
    }
    let own = color(&stuff, slips);
    let (outward, raw) = match w.things[number].body {
        Body::Sphere { c, r } => (mul(sub(p, c), 1.0 / r), sub(p, c)),
        Body::Floor { .. } => ([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
    };
    let e = match () {
        () if is("E towards the surface") => d,
        () if is("E is the axis") => unit(sub(w.eye, w.at)),
        () if is("E from the origin to the eye") => unit(w.eye),
        () if is("E to the origin") => unit(mul(p, -1.0)),
        () if is("E not normalised") => sub(w.eye, p),
        () if is("ray not normalised") => mul(d, -met.long),
        () => mul(d, -1.0),
    };
    let mut n = if dot(outward, d) > 0.0 && !is("far root") { mul(outward, -1.0) } else { outward };
    if is("normals inside out") || only("normals inside out") {
        n = mul(outward, -1.0);
    }
    if is("N not normalised") {
        n = raw;
    }
    let c_a = mul(own, stuff.k_a);
    let mut out = match () {
        () if is("no ambient") || is("ambient per light") => [0.0; 3],
        () if is("ambient doubled") => mul(c_a, 2.0),
        () => c_a,
    };
    let (mut lit, mut blocked_any) = (false, false);
    let mut lights = [0.0; 3];
    for (i, lamp) in w.lamps.iter().enumerate() {
        if i > 0 && is("first light only") || i == 1 && is("second light missing") {
            continue;
        }
        let mut light = if is("white light") { [1.0; 3] } else { lamp.color };
        let (to, far) = match lamp.from {
            From::Point(at) => {
                let to = sub(at, p);
                let far = dot(to, to).sqrt();
                let fades = if is("no attenuation") { 0.0 } else { lamp.fades };
                light = mul(light, 1.0 / (1.0 + fades * far));
                if is("inverse square") {
                    light = mul(light, 1.0 / (far * far));
                }
                if is("linear falloff") {
                    light = mul(light, 1.0 / far);
                }
                (if is("L reversed") { mul(to, -1.0) } else { to }, far)
            }
            From::Sun(travels) => {
                (unit(mul(travels, if is("sun reversed") { 1.0 } else { -1.0 })), f64::INFINITY)
            }
        };
        if is("ambient per light") {
            out = add(out, c_a);
        }
        let l = if is("L not normalised") { to } else { unit(to) };
        let n_dot_l = dot(n, l);
        let forgiving = is("N·L not clamped")
            || is("R·E not clamped")
            || is("|N·L|")
            || is("highlight behind")
            || is("R = L − 2(L·N)N");
        if n_dot_l <= 0.0 && !forgiving {
            continue;
        }
        let start = add(p, mul(outward, 1e-5));
        let far = if is("endless shadow ray") { f64::INFINITY } else { far };
        let unshadowed = is("no shadows")
            || is("normals inside out")
            || i == 0 && is("no shadows of the first light");
        let looks = lamp.shadows && !unshadowed;
        let blocks = |t: &Thing| hit(t.body, start, unit(l), false).is_some_and(|t| t < far);
        let mut blocked = looks && w.things.iter().any(blocks);
        if is("shadow acne") && noise(met.seed * 3 + i as u64) < 0.3 {
            blocked = true;
        }
        if blocked {
            blocked_any = true;
            if is("shadows half") {
                light = mul(light, 0.5);
            } else {
                continue;
            }
        }
        lit = true;
        let mut of_light = [0.0; 3];
        let cosine = match () {
            () if is("N·L not clamped") => n_dot_l,
            () if is("|N·L|") => n_dot_l.abs(),
            () => n_dot_l.max(0.0),
        };
        if !is("no diffuse") {
            let k_d = if is("diffuse halved") { stuff.k_d / 2.0 } else { stuff.k_d };
            of_light = add(of_light, times(mul(own, k_d * cosine), light));
        }
        let alpha = stuff.alpha
            * match () {
                () if is("half the exponent") => 0.5,
                () if is("a quarter of the exponent") => 0.25,
                () if is("twice the exponent") => 2.0,
                () if is("four times the exponent") => 4.0,
                () => 1.0,
            };
        let base = if (stuff.blinn || is("Blinn's lobe")) && !is("Phong's lobe") {
            let sum = add(l, e);
            match () {
                () if is("H = L + E") => dot(n, sum),
                () if is("H = (L + E)/2") => dot(n, mul(sum, 0.5)),
                () => dot(n, unit(sum)),
            }
        } else {
            let r = sub(mul(n, 2.0 * n_dot_l), l);
            dot(if is("R = L − 2(L·N)N") { mul(r, -1.0) } else { r }, e)
        };
        let shines = n_dot_l > 0.0
            || is("R·E not clamped")
            || is("highlight behind")
            || is("R = L − 2(L·N)N");
        if !is("no specular") && shines {
            let signed = is("R·E not clamped") || is("R·E not clamped where lit");
            let power = if base <= 0.0 && !signed { 0.0 } else { base.powf(alpha) };
            let mut specular = mul(light, stuff.k_s * power);
            if is("highlight × N·L") {
                specular = mul(specular, n_dot_l);
            }
            let tint = if is("highlight × colour") { own } else { [1.0; 3] };
            of_light = add(of_light, times(tint, specular));
        }
        if is("lights clamped") {
            of_light = of_light.map(|v| v.min(1.0));
        }
        lights = add(lights, of_light);
    }
    if is("lights averaged") {
        lights = mul(lights, 1.0 / w.lamps.len() as f64);
    }
    if is("no ambient in shadow") && blocked_any && !lit {
        return [0.0; 3];
    }
    add(out, lights)
}

fn curve(v: f64) -> f64 {
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

fn level(v: f64, slips: Slips) -> u8 {
    let is = |slip: &str| slips.has(slip);
    let v = v * if is("twice as bright") { 2.0 } else { 1.0 };
    let v = if is("tone curve") { v / (1.0 + v) } else { v };
    let v = if is("tone curve, exponential") { 1.0 - (-v).exp() } else { v };
    if is("byte overflows") {
        return ((curve(v.max(0.0)) * 255.0 + 0.5) as u32 & 255) as u8;
    }
    let v = v.clamp(0.0, 1.0);
    let encoded = match () {
        () if is("no sRGB curve") => v,
        () if is("sRGB curve twice") => curve(curve(v)),
        () if is("gamma 2.2") => v.powf(1.0 / 2.2),
        () => curve(v),
    };
    (encoded * 255.0 + if is("levels cut") { 0.0 } else { 0.5 }) as u8
}

/// The picture in levels of 255, row by row.
pub(crate) fn draw(w: &World, slips: &[&str]) -> Vec<[u8; 3]> {
    let slips = Slips(slips);
    let is = |slip: &str| slips.has(slip);
    let [width, height] = w.size;
    let (fw, fh) = (f64::from(width), f64::from(height));
    let forward = unit(sub(w.at, w.eye));
    let right = unit(cross(forward, [0.0, 1.0, 0.0]));
    let up = cross(right, forward);
    let fov = w.fov * if is("fov twice") { 2.0 } else { 1.0 };
    let mut half = (fov.to_radians() / 2.0).tan();
    if is("fov horizontal") {
        half *= fh / fw;
    }
    let middle = if is("half a pixel off") { 0.0 } else { 0.5 };
    let aspect = if is("aspect ignored") { 1.0 } else { fw / fh };
    let mut out = Vec::new();
    for row in 0..height {
        for column in 0..width {
            let y = if is("rows upside down") { height - 1 - row } else { row };
            let x = if is("columns reversed") { width - 1 - column } else { column };
            let x = f64::from(x) - if is("shifted") { 2.0 } else { 0.0 };
            let u = (2.0 * (x + middle) / fw - 1.0) * aspect * half;
            let v = (1.0 - 2.0 * (f64::from(y) + middle) / fh) * half;
            let through = add(forward, add(mul(right, u), mul(up, v)));
            let d = unit(through);
            let met = |(number, thing): (usize, &Thing)| {
                hit(thing.body, w.eye, d, is("far root")).map(|t| (t, number))
            };
            let nearest =
                w.things.iter().enumerate().filter_map(met).min_by(|a, b| a.0.total_cmp(&b.0));
            let background =
                if is("another background") { [0.02, 0.02, 0.02] } else { w.background };
            let color = nearest.map_or(background, |(t, number)| {
                let p = add(w.eye, mul(d, t));
                let long = dot(through, through).sqrt();
                let seed = (f64::from(y) * fw + x) as u64;
                shade(w, slips, &Met { p, d, long, number, seed })
            });
            let mut pixel = color.map(|v| level(v, slips));
            if is("blue first") {
                pixel.reverse();
            }
            out.push(pixel);
        }
    }
    out
}
