//! A student's ray tracer: spheres, planes, point and distant lights, in f64, by itself. It shares
//! no code with the project, and can be told to make a mistake.

pub(crate) type V = [f64; 3];

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Slip {
    None,
    ReflectionSign,
    EyeBackwards,
    HalfSum,
    HalfMean,
    NoDiffuseClamp,
    NoSpecularClamp,
    AmbientPerLight,
    NoAmbient,
    NoAmbientInShadow,
    NoDiffuse,
    NoSpecular,
    InsideOut,
    SunReversed,
    NoGamma,
    GammaTwice,
    Gamma22,
    UpsideDown,
    LeftRight,
    BlueFirst,
    NoShadows,
    EndlessShadowRay,
    Acne,
    BlinnForPhong,
    ExponentHalf,
    LongL,
    TintedHighlight,
    HighlightTimesCosine,
    FirstLightOnly,
    InverseSquare,
    HorizontalFov,
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
pub(crate) struct Thing {
    pub(crate) body: Body,
    pub(crate) color: V,
    pub(crate) k_a: f64,
    pub(crate) k_d: f64,
    pub(crate) k_s: f64,
    pub(crate) alpha: f64,
    pub(crate) blinn: bool,
}

pub(crate) enum Lamp {
    Point { at: V, color: f64 },
    Sun { travels: V, color: f64 },
}

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
fn sub(a: V, b: V) -> V {
    add(a, mul(b, -1.0))
}
fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn unit(a: V) -> V {
    mul(a, 1.0 / dot(a, a).sqrt())
}

fn hit(body: Body, o: V, d: V) -> Option<f64> {
    let t = match body {
        Body::Sphere { c, r } => {
            let oc = sub(o, c);
            let b = dot(oc, d);
            let disc = b * b - dot(oc, oc) + r * r;
            if disc < 0.0 {
                return None;
            }
            let near = -b - disc.sqrt();
            if near > 1e-6 { near } else { -b + disc.sqrt() }
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

fn pow(x: f64, alpha: f64, clamp: bool) -> f64 {
    if x <= 0.0 && clamp {
        return 0.0;
    }
    // A student's loop, or std::pow: alpha is a whole number here.
    let mut power = 1.0;
    for _ in 0..alpha as u32 {
        power *= x;
    }
    power
}

fn shade(w: &World, slip: Slip, thing: &Thing, p: V, d: V, seed: u64) -> V {
    let outward = match thing.body {
        Body::Sphere { c, r } => mul(sub(p, c), 1.0 / r),
        Body::Floor { .. } => [0.0, 1.0, 0.0],
    };
    let e = mul(d, if slip == Slip::EyeBackwards { 1.0 } else { -1.0 });
    let mut n = if dot(outward, d) > 0.0 { mul(outward, -1.0) } else { outward };
    if slip == Slip::InsideOut {
        n = mul(outward, -1.0);
    }
    let c_a = mul(thing.color, thing.k_a);
    let mut out = match slip {
        Slip::NoAmbient | Slip::AmbientPerLight => [0.0; 3],
        _ => c_a,
    };
    let (mut lit, mut blocked_any) = (false, false);
    for (i, lamp) in w.lamps.iter().enumerate() {
        if i > 0 && slip == Slip::FirstLightOnly {
            break;
        }
        let (to, color, far) = match *lamp {
            Lamp::Point { at, color } => {
                let to = sub(at, p);
                let far = dot(to, to).sqrt();
                let color = if slip == Slip::InverseSquare { color / (far * far) } else { color };
                (to, color, far)
            }
            Lamp::Sun { travels, color } => {
                let sign = if slip == Slip::SunReversed { 1.0 } else { -1.0 };
                (unit(mul(travels, sign)), color, f64::INFINITY)
            }
        };
        if slip == Slip::AmbientPerLight {
            out = add(out, c_a);
        }
        let l = if slip == Slip::LongL { to } else { unit(to) };
        let n_dot_l = dot(n, l);
        let forgiving = matches!(slip, Slip::NoDiffuseClamp | Slip::NoSpecularClamp);
        if n_dot_l <= 0.0 && !forgiving {
            continue;
        }
        let start = add(p, mul(outward, 1e-5));
        let far = if slip == Slip::EndlessShadowRay { f64::INFINITY } else { far };
        let looks = n_dot_l > 0.0 && !matches!(slip, Slip::NoShadows | Slip::InsideOut);
        let mut blocked =
            looks && w.things.iter().any(|t| hit(t.body, start, unit(l)).is_some_and(|t| t < far));
        if slip == Slip::Acne && noise(seed * 3 + i as u64) < 0.3 {
            blocked = true;
        }
        if blocked {
            blocked_any = true;
            continue;
        }
        lit = true;
        let diffuse = if slip == Slip::NoDiffuseClamp { n_dot_l } else { n_dot_l.max(0.0) };
        if slip != Slip::NoDiffuse {
            out = add(out, mul(thing.color, thing.k_d * diffuse * color));
        }
        if slip == Slip::NoSpecular || n_dot_l <= 0.0 && slip != Slip::NoSpecularClamp {
            continue;
        }
        let alpha = if slip == Slip::ExponentHalf { thing.alpha / 2.0 } else { thing.alpha };
        let base = if thing.blinn || slip == Slip::BlinnForPhong {
            let sum = add(l, e);
            match slip {
                Slip::HalfSum => dot(n, sum),
                Slip::HalfMean => dot(n, mul(sum, 0.5)),
                _ => dot(n, unit(sum)),
            }
        } else {
            let r = sub(mul(n, 2.0 * n_dot_l), l);
            dot(if slip == Slip::ReflectionSign { mul(r, -1.0) } else { r }, e)
        };
        let mut specular = thing.k_s * pow(base, alpha, slip != Slip::NoSpecularClamp) * color;
        if slip == Slip::HighlightTimesCosine {
            specular *= n_dot_l;
        }
        let tint = if slip == Slip::TintedHighlight { thing.color } else { [1.0; 3] };
        out = add(out, mul(tint, specular));
    }
    if slip == Slip::NoAmbientInShadow && blocked_any && !lit {
        out = [0.0; 3];
    }
    out
}

fn curve(v: f64) -> f64 {
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// The picture in levels of 255, row by row.
pub(crate) fn draw(w: &World, slip: Slip) -> Vec<[u8; 3]> {
    let [width, height] = w.size;
    let (fw, fh) = (f64::from(width), f64::from(height));
    let forward = unit(sub(w.at, w.eye));
    let right = unit(cross(forward, [0.0, 1.0, 0.0]));
    let up = cross(right, forward);
    let mut half = (w.fov.to_radians() / 2.0).tan();
    if slip == Slip::HorizontalFov {
        half *= fh / fw;
    }
    let mut out = Vec::new();
    for row in 0..height {
        for column in 0..width {
            let y = if slip == Slip::UpsideDown { height - 1 - row } else { row };
            let x = if slip == Slip::LeftRight { width - 1 - column } else { column };
            let u = (2.0 * (f64::from(x) + 0.5) - fw) / fh * half;
            let v = (fh - 2.0 * (f64::from(y) + 0.5)) / fh * half;
            let d = unit(add(forward, add(mul(right, u), mul(up, v))));
            let nearest = w
                .things
                .iter()
                .filter_map(|thing| hit(thing.body, w.eye, d).map(|t| (t, thing)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let color = nearest.map_or(w.background, |(t, thing)| {
                let p = add(w.eye, mul(d, t));
                shade(w, slip, thing, p, d, u64::from(y * width + x))
            });
            let mut level = color.map(|v| {
                let v = v.clamp(0.0, 1.0);
                let encoded = match slip {
                    Slip::NoGamma => v,
                    Slip::GammaTwice => curve(curve(v)),
                    Slip::Gamma22 => v.powf(1.0 / 2.2),
                    _ => curve(v),
                };
                (encoded * 255.0 + 0.5) as u8
            });
            if slip == Slip::BlueFirst {
                level.reverse();
            }
            out.push(level);
        }
    }
    out
}
