//! The sum as a program with a mistake computes it.
//!
//! With [`Fault::default`] nothing is wrong, and the sum is the integrator's, which a test holds.

use glam::{DVec3, Vec3};
use phong::light::LightSample;
use phong::math::{Dir3, lobe, pow};
use phong::reflectance::{blinn_phong, phong as phong_model};
use phong::terms::Terms;
use phong_scene::{Model, Rgb, Scene, Shape};

use super::fault::Fault;
use super::points::{LightPoint, MaterialHere, Point, Surface};
use super::wrong::{
    Ambient, Below, Clamp, Eye, Falloff, Half, LightColor, Lobe, Normal, Reversed, Shadows, Wrong,
};

/// What a wrong sum needs to know of the scene besides the point.
#[derive(Clone, Debug)]
pub(super) struct Facts {
    eye: DVec3,
    backward: Dir3,
    /// How many lights there are.
    pub(super) lights: usize,
    /// Of each light: its constants of attenuation; `None` for distant ones.
    attenuation: Vec<Option<[f64; 3]>>,
    /// The lights' own colours, not attenuated.
    colors: Vec<[Rgb; 2]>,
    /// Of each object: how long its normal is if nobody makes it 1. Empty where objects of groups
    /// make the numbers other than the text's.
    normal_lengths: Vec<f32>,
}

impl Facts {
    pub(super) fn new(scene: &Scene, backward: Dir3) -> Self {
        let length = |object: &phong_scene::Object| {
            let length = match &object.shape {
                Shape::Sphere { radius, .. } => *radius,
                Shape::Plane { normal, .. } | Shape::Disc { normal, .. } => normal.length(),
                _ => 1.0,
            };
            length as f32
        };
        let known = scene.groups.is_empty();
        Self {
            eye: scene.camera.eye,
            backward,
            lights: scene.lights.len(),
            attenuation: scene.lights.iter().map(|light| light.kind.attenuation()).collect(),
            colors: scene.lights.iter().map(|l| [l.color, l.specular_color]).collect(),
            normal_lengths: scene.objects.iter().filter(|_| known).map(length).collect(),
        }
    }

    fn is_distant(&self, light: usize) -> bool {
        self.attenuation.get(light).is_none_or(Option::is_none)
    }
}

/// The sum at a point, computed with a mistake.
pub(super) fn shade(point: &Point, fault: &Fault, facts: &Facts) -> Terms {
    let terms = before_fog(point, fault, facts);
    match point.fog {
        Some((clear, fog)) => Terms { fog, ..Terms::from_fn(|term| terms[term] * clear) },
        None => terms,
    }
}

/// The sum before fog fades it.
fn before_fog(point: &Point, fault: &Fault, facts: &Facts) -> Terms {
    let Some(surface) = &point.surface else {
        return match fault.look.as_ref().and_then(|look| look.background) {
            Some(background) => Terms { background, ..point.terms },
            None => point.terms,
        };
    };
    if !fault.is_of(surface.object) {
        return sum(point.terms, surface, &Wrong::default(), None, facts);
    }
    match &fault.look {
        Some(look) => {
            let surface = look.dress(surface);
            sum(point.terms, &surface, &fault.wrong, fault.light.as_ref(), facts)
        }
        None => sum(point.terms, surface, &fault.wrong, fault.light.as_ref(), facts),
    }
}

fn sum(
    terms: Terms,
    surface: &Surface,
    wrong: &Wrong,
    of_light: Option<&(usize, Wrong)>,
    facts: &Facts,
) -> Terms {
    let mut sum = Terms { ambient: ambient(surface, wrong, facts), ..terms };
    if wrong.no_secondary {
        (sum.reflection, sum.transmission) = (Rgb::BLACK, Rgb::BLACK);
    }
    for light in &surface.lights {
        if wrong.first_light && light.number > 0 {
            continue;
        }
        let wrong = match of_light {
            Some((number, wrong)) if *number == light.number => wrong,
            _ => wrong,
        };
        let (mut diffuse, mut specular) = one_light(surface, light, wrong, facts);
        if wrong.clamped_lights {
            diffuse = diffuse.map(|v| v.min(1.0));
            let total = (diffuse + specular).map(|v| v.min(1.0));
            specular = total - diffuse;
        }
        sum.diffuse += diffuse * wrong.diffuse_factor;
        sum.specular += specular * wrong.specular_factor;
    }
    if wrong.averaged && facts.lights > 0 {
        let share = 1.0 / facts.lights as f32;
        (sum.diffuse, sum.specular) = (sum.diffuse * share, sum.specular * share);
    }
    if let Shadows::Whole(left) = wrong.shadows
        && surface.lights.iter().any(|light| light.above && !light.visible)
    {
        for term in [&mut sum.ambient, &mut sum.diffuse, &mut sum.specular] {
            *term *= left;
        }
    }
    sum
}

fn ambient(surface: &Surface, wrong: &Wrong, facts: &Facts) -> Rgb {
    let seen = surface.lights.iter().filter(|light| light.visible).count();
    let blocked = surface.lights.iter().any(|light| light.above && !light.visible);
    let kept = |gone: bool| if gone { Rgb::BLACK } else { surface.ambient };
    let ambient = match wrong.ambient {
        Ambient::Right => surface.ambient,
        Ambient::Missing => Rgb::BLACK,
        Ambient::PerLight => surface.ambient * facts.lights as f32,
        Ambient::PerSeenLight => surface.ambient * seen as f32,
        Ambient::NotInShadow => kept(blocked && seen == 0),
        Ambient::NotUnlit => kept(seen == 0),
        Ambient::NotWhereBlocked => kept(blocked),
        Ambient::WithoutWeight => match surface.material.written.k_a {
            k_a if k_a > 0.0 => surface.ambient / k_a,
            _ => surface.ambient,
        },
    };
    ambient * wrong.ambient_factor
}

/// L, its length, and the shares of diffuse and specular light that pass what stands in the way.
fn arriving(
    surface: &Surface,
    light: &LightPoint,
    wrong: &Wrong,
    facts: &Facts,
) -> (Dir3, f32, [f32; 2]) {
    let share = |seen: bool| [f32::from(u8::from(seen)); 2];
    let distant = facts.is_distant(light.number);
    let length = if wrong.long_l && !distant { light.distance } else { 1.0 };
    let reversed = if distant { wrong.reversed_distant } else { wrong.reversed_points };
    if let Some(reversed) = reversed {
        let seen = match reversed {
            Reversed::Untested => true,
            Reversed::Away => light.away,
            Reversed::AwayEndless => light.away_endless,
            Reversed::Between => light.reached,
        };
        return (-light.l, length, share(seen || wrong.shadows == Shadows::Missing));
    }
    let seen = if light.above {
        match wrong.shadows {
            Shadows::Missing | Shadows::Whole(_) => share(true),
            Shadows::Endless => share(light.clear),
            Shadows::Through(diffuse, specular) if !light.visible => [diffuse, specular],
            Shadows::Right | Shadows::Through(..) => share(light.visible),
        }
    } else {
        let open = wrong.below == Below::Open || wrong.shadows == Shadows::Missing;
        // A normal never turned to the ray: what is above for it is asked for as usual.
        let turned = wrong.normal == Normal::Outward && surface.ng.dot(light.l) > 0.0;
        share(if turned { light.reached } else { open || light.reached })
    };
    (light.l, length, seen)
}

/// Diffuse and specular of one light.
fn one_light(surface: &Surface, light: &LightPoint, wrong: &Wrong, facts: &Facts) -> (Rgb, Rgb) {
    let dark = (Rgb::BLACK, Rgb::BLACK);
    let (l, length, shares) = arriving(surface, light, wrong, facts);
    if shares == [0.0; 2] {
        return dark;
    }
    let [color, specular_color] = colors(light, wrong, facts);
    let sample = LightSample { l, distance: light.distance, color, specular_color };
    let MaterialHere { written, ready: material } = &*surface.material;
    let n = match wrong.normal {
        Normal::Right | Normal::Long => surface.n,
        Normal::Outward => surface.ng,
        Normal::Inward => -surface.ng,
    };
    if !matches!(
        written.model,
        Model::Lambert | Model::Phong | Model::BlinnPhong | Model::BlinnFast
    ) {
        if !light.above && n == surface.n && l == light.l {
            return dark;
        }
        let e = if wrong.mirrored { -surface.e } else { surface.e };
        let terms = material.shade_light(n, surface.tangent, e, surface.color, &sample);
        return (terms.diffuse * shares[0], terms.specular * shares[1]);
    }
    // A light above the shading normal's horizon and below the geometric one gives nothing.
    if !light.above && n == surface.n && l == light.l && n.dot(l) > 0.0 {
        return dark;
    }
    let incident = material.incident(n, surface.color, &sample);
    let n_length = match wrong.normal {
        Normal::Long => facts.normal_lengths.get(surface.object as usize).copied().unwrap_or(1.0),
        _ => 1.0,
    };
    let n_dot_l = n.dot(l) * length * n_length;
    let cosine = match wrong.diffuse_clamp {
        Clamp::Right => n_dot_l.max(0.0),
        Clamp::Missing | Clamp::MissingWhereLit => n_dot_l,
        Clamp::Abs | Clamp::AbsWhereLit => n_dot_l.abs(),
    };
    let k_d = if wrong.k_d_ignored { 1.0 } else { written.k_d };
    let diffuse = k_d * cosine * incident.c_d;
    let cut = n_dot_l <= 0.0
        && !(wrong.uncut_specular || matches!(wrong.specular_clamp, Clamp::Missing | Clamp::Abs));
    if cut || written.model == Model::Lambert {
        return (diffuse * shares[0], Rgb::BLACK);
    }
    let tint = if wrong.tinted { surface.color } else { Rgb::WHITE };
    let own = if written.model == Model::Phong { Lobe::Phong } else { Lobe::Blinn };
    let (e, e_length) = eye(surface, material.eye(surface.e), wrong, facts);
    let vectors = Vectors { n, n_length, l, length, e, e_length };
    let base = base(&vectors, wrong.lobe.unwrap_or(own), wrong);
    let alpha = written.shininess * wrong.exponent;
    let power = match (written.model, wrong.lobe) {
        (Model::BlinnFast, None) => blinn_phong::rational_lobe(base, alpha),
        _ => raised(base, alpha, wrong.specular_clamp),
    };
    let mut scale = if wrong.k_s_ignored { 1.0 } else { written.k_s };
    if written.times_cosine || wrong.times_cosine {
        scale *= n_dot_l.max(0.0);
    }
    if written.normalize {
        scale *= match own {
            Lobe::Phong => phong_model::normalization(written.shininess, written.times_cosine),
            Lobe::Blinn => blinn_phong::normalization(written.shininess, written.times_cosine),
        };
    }
    (diffuse * shares[0], scale * power * shares[1] * incident.c_s * tint)
}

/// The light's diffuse and specular colours as they arrive.
fn colors(light: &LightPoint, wrong: &Wrong, facts: &Facts) -> [Rgb; 2] {
    let mut colors = [light.color, light.specular_color];
    let d = light.distance;
    if wrong.light_color != LightColor::Right {
        let own = facts.colors.get(light.number).copied().unwrap_or([Rgb::WHITE; 2]);
        let grey = |c: Rgb| match wrong.light_color {
            LightColor::Brightest => Rgb::grey(c.max_channel()),
            LightColor::Mean => Rgb::grey((c.r + c.g + c.b) / 3.0),
            LightColor::Luminance => Rgb::grey(c.luminance()),
            LightColor::Right | LightColor::White | LightColor::WhiteSpecular => Rgb::WHITE,
        };
        // Whatever attenuates the light attenuates its wrong colour too.
        let left = |here: Rgb, own: Rgb| match own.max_channel() {
            most if most > 0.0 => here.max_channel() / most,
            _ => 0.0,
        };
        for (which, (color, own)) in colors.iter_mut().zip(own).enumerate() {
            if which == 1 || wrong.light_color != LightColor::WhiteSpecular {
                *color = grey(own) * left(*color, own);
            }
        }
    }
    let Some(Some([c, linear, square])) = facts.attenuation.get(light.number) else {
        return colors;
    };
    let factor = match wrong.falloff {
        Falloff::Right => return colors,
        Falloff::Missing => (c + linear * f64::from(d) + square * f64::from(d * d)) as f32,
        Falloff::Linear => 1.0 / d,
        Falloff::Square => 1.0 / (d * d),
    };
    colors.map(|color| color * factor)
}

/// E and its length.
fn eye(surface: &Surface, right: Dir3, wrong: &Wrong, facts: &Facts) -> (Dir3, f32) {
    let unit = |v: DVec3| Dir3::new(v.as_vec3()).unwrap_or(right);
    match wrong.eye {
        Eye::Right => (right, 1.0),
        Eye::Axis => (facts.backward, 1.0),
        Eye::FromOrigin => (unit(facts.eye), 1.0),
        Eye::AlongZ => (Dir3::Z, 1.0),
        Eye::AtOrigin => (unit(-surface.p), 1.0),
        Eye::Long => (right, surface.to_eye),
        Eye::LongRay => (right, 1.0 / surface.e.dot(facts.backward).max(1e-3)),
    }
}

struct Vectors {
    n: Dir3,
    n_length: f32,
    l: Dir3,
    length: f32,
    e: Dir3,
    e_length: f32,
}

/// R·E or N·H.
fn base(vectors: &Vectors, lobe: Lobe, wrong: &Wrong) -> f32 {
    let &Vectors { n, n_length, l, length, e, e_length } = vectors;
    let sign = if wrong.mirrored { -1.0 } else { 1.0 };
    match lobe {
        Lobe::Phong if n_length == 1.0 => sign * length * e_length * n.mirror(l).dot(e),
        Lobe::Phong => {
            let (n, l): (Vec3, Vec3) = (n_length * n.to_vec(), length * l.to_vec());
            sign * e_length * (2.0 * n.dot(l) * n - l).dot(e.to_vec())
        }
        Lobe::Blinn => {
            let sum = length * l.to_vec() + sign * e_length * e.to_vec();
            let along = n_length * n.to_vec().dot(sum);
            match wrong.half {
                Half::Right => along / sum.length().max(f32::MIN_POSITIVE),
                Half::Sum => along,
                Half::Mean => 0.5 * along,
            }
        }
    }
}

/// A power as a program takes it that does, or does not, clamp its base first.
fn raised(base: f32, alpha: f32, clamp: Clamp) -> f32 {
    if base > 1.0 {
        // Not a cosine: a vector was not normalised.
        return pow(base, alpha).min(1e9);
    }
    if base > 0.0 || clamp == Clamp::Right {
        return lobe(base, alpha);
    }
    // std::pow of a negative base: its sign for an odd exponent, NaN for a fraction.
    match alpha {
        a if matches!(clamp, Clamp::Abs | Clamp::AbsWhereLit) || a % 2.0 == 0.0 => lobe(-base, a),
        a if a.fract() != 0.0 => 0.0,
        a => -lobe(-base, a),
    }
}
