//! The ways in which each known mistake may have been made.
//!
//! Programs make one mistake in more than one way: `E` may be the same everywhere since it is the
//! camera's axis, or the way from the origin to the eye. Every way is tried; the name is the same.

use std::sync::Arc;

use glam::DVec3;
use phong::math::wide;
use phong_scene::{CameraKind, MaterialId, Param, Rgb, Scene, srgb_encode};

use super::elsewhere::{Lens, Way};
use super::fault::{Change, OtherLook};
use super::mistakes::Mistake;
use super::picture::Layout;
use super::prepared::Prepared;
use super::tone::Tone;
use super::wrong::{
    Ambient, Below, Clamp, Eye, Falloff, Half, LightColor, Lobe, Normal, Reversed, Shadows, Wrong,
};

/// A mistake, made in one way, that changes what is computed at the points of the right picture.
#[derive(Clone, Debug)]
pub(super) struct Hypothesis {
    pub(super) mistake: &'static Mistake,
    pub(super) change: Change,
    /// What it is about, where that is not all: a light, two objects, a factor.
    pub(super) of: Option<String>,
}

impl Hypothesis {
    pub(super) fn new(cause: &str, change: Change) -> Self {
        Self { mistake: Mistake::named(cause), change, of: None }
    }

    pub(super) fn of(cause: &str, change: Change, of: String) -> Self {
        Self { of: Some(of), ..Self::new(cause, change) }
    }
}

type Ways = (&'static str, &'static [fn(&mut Wrong)]);

/// Mistakes in the sum, each with its ways.
const SUMS: &[Ways] = &[
    ("ambient-missing", &[|w| w.ambient = Ambient::Missing]),
    (
        "ambient-per-light",
        &[|w| w.ambient = Ambient::PerLight, |w| w.ambient = Ambient::PerSeenLight],
    ),
    (
        "ambient-not-in-shadow",
        &[
            |w| w.ambient = Ambient::NotInShadow,
            |w| w.ambient = Ambient::NotUnlit,
            |w| w.ambient = Ambient::NotWhereBlocked,
            |w| w.shadows = Shadows::Whole(0.0),
        ],
    ),
    ("ambient-factor", &[|w| w.ambient = Ambient::WithoutWeight]),
    ("diffuse-missing", &[|w| w.diffuse_factor = 0.0]),
    ("specular-missing", &[|w| w.specular_factor = 0.0]),
    (
        "shadows-missing",
        &[
            |w| w.shadows = Shadows::Missing,
            |w| {
                w.shadows = Shadows::Missing;
                w.below = Below::Open;
            },
        ],
    ),
    ("shadow-ray-endless", &[|w| w.shadows = Shadows::Endless]),
    (
        "shadow-half",
        &[
            |w| w.shadows = Shadows::Through(0.5, 0.5),
            |w| w.shadows = Shadows::Through(0.5, 0.0),
            |w| w.shadows = Shadows::Whole(0.5),
        ],
    ),
    (
        "reflection-sign",
        &[
            |w| w.mirrored = true,
            |w| {
                w.mirrored = true;
                w.uncut_specular = true;
            },
        ],
    ),
    ("half-unnormalized", &[|w| w.half = Half::Sum]),
    ("half-mean", &[|w| w.half = Half::Mean]),
    ("phong-not-blinn", &[|w| w.lobe = Some(Lobe::Phong)]),
    ("blinn-not-phong", &[|w| w.lobe = Some(Lobe::Blinn)]),
    ("exponent-quarter", &[|w| w.exponent = 0.25]),
    ("exponent-half", &[|w| w.exponent = 0.5]),
    ("exponent-double", &[|w| w.exponent = 2.0]),
    ("exponent-fourfold", &[|w| w.exponent = 4.0]),
    (
        "clamp-missing-diffuse",
        &[
            |w| w.diffuse_clamp = Clamp::Missing,
            |w| {
                w.diffuse_clamp = Clamp::Missing;
                w.below = Below::Open;
            },
        ],
    ),
    (
        "clamp-missing-specular",
        &[
            |w| w.specular_clamp = Clamp::Missing,
            |w| w.specular_clamp = Clamp::MissingWhereLit,
            |w| {
                w.specular_clamp = Clamp::Missing;
                w.below = Below::Open;
            },
        ],
    ),
    (
        "highlight-behind",
        &[
            |w| w.uncut_specular = true,
            |w| {
                w.uncut_specular = true;
                w.below = Below::Open;
            },
        ],
    ),
    (
        "clamp-missing-both",
        &[
            |w| {
                w.diffuse_clamp = Clamp::Missing;
                w.specular_clamp = Clamp::Missing;
            },
            |w| {
                w.diffuse_clamp = Clamp::Missing;
                w.specular_clamp = Clamp::Missing;
                w.below = Below::Open;
            },
            |w| {
                w.diffuse_clamp = Clamp::Missing;
                w.uncut_specular = true;
                w.below = Below::Open;
            },
        ],
    ),
    (
        "clamp-abs",
        &[
            |w| w.diffuse_clamp = Clamp::Abs,
            |w| {
                w.diffuse_clamp = Clamp::Abs;
                w.below = Below::Open;
            },
            |w| {
                w.diffuse_clamp = Clamp::Abs;
                w.uncut_specular = true;
            },
            |w| {
                w.diffuse_clamp = Clamp::Abs;
                w.uncut_specular = true;
                w.below = Below::Open;
            },
            |w| w.specular_clamp = Clamp::Abs,
            |w| w.specular_clamp = Clamp::AbsWhereLit,
            |w| {
                w.diffuse_clamp = Clamp::Abs;
                w.specular_clamp = Clamp::AbsWhereLit;
            },
            |w| {
                w.specular_clamp = Clamp::Abs;
                w.below = Below::Open;
            },
            |w| {
                w.diffuse_clamp = Clamp::Abs;
                w.specular_clamp = Clamp::Abs;
            },
            |w| {
                w.diffuse_clamp = Clamp::Abs;
                w.specular_clamp = Clamp::Abs;
                w.below = Below::Open;
            },
        ],
    ),
    (
        "normal-inside-out",
        &[
            |w| w.normal = Normal::Inward,
            |w| {
                w.normal = Normal::Inward;
                w.below = Below::Open;
            },
        ],
    ),
    ("normal-unnormalized", &[|w| w.normal = Normal::Long]),
    ("light-unnormalized", &[|w| w.long_l = true]),
    (
        "light-reversed",
        &[
            |w| w.reversed_points = Some(Reversed::Untested),
            |w| w.reversed_points = Some(Reversed::Away),
            |w| w.reversed_points = Some(Reversed::AwayEndless),
            |w| w.reversed_points = Some(Reversed::Between),
        ],
    ),
    (
        "distant-reversed",
        &[
            |w| w.reversed_distant = Some(Reversed::AwayEndless),
            |w| w.reversed_distant = Some(Reversed::Untested),
            |w| w.reversed_distant = Some(Reversed::Between),
        ],
    ),
    (
        "eye-constant",
        &[|w| w.eye = Eye::Axis, |w| w.eye = Eye::FromOrigin, |w| w.eye = Eye::AlongZ],
    ),
    ("eye-at-origin", &[|w| w.eye = Eye::AtOrigin]),
    ("eye-unnormalized", &[|w| w.eye = Eye::Long]),
    ("ray-unnormalized", &[|w| w.eye = Eye::LongRay]),
    ("specular-tinted", &[|w| w.tinted = true]),
    ("specular-times-cosine", &[|w| w.times_cosine = true]),
    ("k_d-ignored", &[|w| w.k_d_ignored = true]),
    ("k_s-ignored", &[|w| w.k_s_ignored = true]),
    ("first-light-only", &[|w| w.first_light = true]),
    ("lights-averaged", &[|w| w.averaged = true]),
    (
        "light-color-ignored",
        &[
            |w| w.light_color = LightColor::White,
            |w| w.light_color = LightColor::Brightest,
            |w| w.light_color = LightColor::Mean,
            |w| w.light_color = LightColor::Luminance,
            |w| w.light_color = LightColor::WhiteSpecular,
        ],
    ),
    ("inverse-square", &[|w| w.falloff = Falloff::Square]),
    ("falloff-linear", &[|w| w.falloff = Falloff::Linear]),
    ("attenuation-missing", &[|w| w.falloff = Falloff::Missing]),
    ("clamped-too-early", &[|w| w.clamped_lights = true]),
    ("reflection-missing", &[|w| w.no_secondary = true]),
];

/// Everything that can be tried at the points of the right picture without looking at theirs.
pub(super) fn at_points(scene: &Scene, right: &Prepared) -> Vec<Hypothesis> {
    let mut all = Vec::new();
    for &(cause, ways) in SUMS {
        all.extend(ways.iter().map(|&way| Hypothesis::new(cause, Change::Sum(way))));
    }
    let tones = [
        ("gamma-missing", Tone::Missing),
        ("gamma-twice", Tone::Twice),
        ("gamma-2.2", Tone::Power22),
        ("tone-mapped", Tone::Reinhard),
        ("tone-mapped", Tone::ReinhardLuminance),
        ("tone-mapped", Tone::Exponential),
        ("tone-mapped", Tone::Filmic),
        ("tone-mapped", Tone::ByLargest),
        ("byte-overflow", Tone::Overflow),
        ("byte-overflow", Tone::OverflowCut),
        ("byte-overflow", Tone::OverflowBefore),
    ];
    all.extend(tones.map(|(cause, tone)| Hypothesis::new(cause, Change::Tone(tone))));
    let layouts = [
        ("upside-down", Layout::UpsideDown),
        ("left-right", Layout::LeftRight),
        ("turned", Layout::Turned),
        ("blue-first", Layout::BlueFirst),
    ];
    all.extend(layouts.map(|(cause, layout)| Hypothesis::new(cause, Change::Layout(layout))));
    all.push(Hypothesis::new("background-wrong", Change::AnyBackground));
    for (number, light) in scene.lights.iter().enumerate().take(MOST_LIGHTS) {
        let of = || format!("the light `{}`", light.name);
        let missing: fn(&mut Wrong) = |w| (w.diffuse_factor, w.specular_factor) = (0.0, 0.0);
        let unshadowed: fn(&mut Wrong) = |w| w.shadows = Shadows::Missing;
        all.push(Hypothesis::of("one-light-missing", Change::Light(number, missing), of()));
        // Of a single light, that is no shadows at all.
        if scene.lights.len() > 1 {
            let change = Change::Light(number, unshadowed);
            all.push(Hypothesis::of("one-light-no-shadow", change, of()));
        }
    }
    all.extend(hex(scene, right));
    all
}

/// More lights than these are not tried one by one.
const MOST_LIGHTS: usize = 16;

/// Mistakes of the sum, for one light at a time.
pub(super) fn of_single_lights(scene: &Scene) -> Vec<Hypothesis> {
    let mut all = Vec::new();
    for (number, light) in scene.lights.iter().enumerate().take(MOST_LIGHTS) {
        for &(cause, ways) in SUMS {
            let whole = cause.starts_with("ambient")
                || cause.ends_with("only")
                || cause == "lights-averaged";
            if whole || scene.lights.len() == 1 {
                continue;
            }
            let of = || format!("the light `{}`", light.name);
            all.extend(
                ways.iter().map(|&way| Hypothesis::of(cause, Change::Light(number, way), of())),
            );
        }
    }
    all
}

/// Colours whose channels are whole bytes on the sRGB curve taken as if they were linear: hex and
/// names are such colours.
fn hex(scene: &Scene, right: &Prepared) -> Vec<Hypothesis> {
    let is_hex = |color: Rgb| {
        let levels = color.to_array().map(|v| 255.0 * srgb_encode(f64::from(v)));
        let whole = levels.iter().all(|l| (l - l.round()).abs() < 2e-3 && *l < 255.5);
        whole && levels.iter().any(|l| (0.5..254.5).contains(l))
    };
    let raw = |color: Rgb| {
        let undecoded = |v: f32| srgb_encode(f64::from(v)) as f32;
        if is_hex(color) { color.map(undecoded) } else { color }
    };
    let undecoded = |color: &Param<Rgb>| match color {
        Param::Constant(color) => Param::Constant(raw(*color)),
        Param::Textured(_) => *color,
    };
    let with = |materials: bool, others: bool| {
        let mut changed = scene.clone();
        for material in changed.materials.iter_mut().filter(|_| materials) {
            material.color = undecoded(&material.color);
            material.specular_color = material.specular_color.as_ref().map(undecoded);
            material.ambient_color = material.ambient_color.as_ref().map(undecoded);
        }
        if others {
            for light in &mut changed.lights {
                light.color = raw(light.color);
                light.specular_color = raw(light.specular_color);
            }
            changed.ambient = raw(changed.ambient);
            if let phong_scene::Background::Color(color) = &mut changed.image.background {
                *color = raw(*color);
            }
        }
        changed
    };
    [with(true, true), with(true, false), with(false, true)]
        .into_iter()
        .filter(|changed| {
            (&changed.materials, &changed.lights, changed.image.background)
                != (&scene.materials, &scene.lights, scene.image.background)
        })
        .filter_map(|changed| OtherLook::new(&right.view, &changed, Vec::new()).ok())
        .map(|look| Hypothesis::new("hex-not-decoded", Change::Look(Arc::new(look))))
        .collect()
}

/// Objects with each other's materials: each two of those that look wrong, and all, moved on by one.
pub(super) fn swapped(scene: &Scene, right: &Prepared, wrong: &[bool]) -> Vec<Hypothesis> {
    if !scene.groups.is_empty() {
        return Vec::new();
    }
    let own: Vec<u32> = scene.objects.iter().map(|object| object.material.0).collect();
    let name = |i: usize| &scene.objects[i].name;
    let mut ways: Vec<(Vec<u32>, String)> = Vec::new();
    let suspects: Vec<usize> =
        (0..own.len()).filter(|&i| wrong.get(i).copied().unwrap_or(false)).take(12).collect();
    for (k, &a) in suspects.iter().enumerate() {
        for &b in suspects.iter().skip(k + 1).filter(|&&b| own[a] != own[b]) {
            let mut way = own.clone();
            way.swap(a, b);
            ways.push((way, format!("`{}` and `{}`", name(a), name(b))));
            // All objects of both materials.
            let way = own.iter().map(|&m| match m {
                m if m == own[a] => own[b],
                m if m == own[b] => own[a],
                m => m,
            });
            ways.push((
                way.collect(),
                format!("all objects made as `{}` and `{}`", name(a), name(b)),
            ));
        }
    }
    if own.len() > 2 && suspects.len() > 2 {
        for by in [1, own.len() - 1] {
            let mut way = own.clone();
            way.rotate_left(by);
            ways.push((way, "each has that of the object before or after it".to_owned()));
        }
        let way = own.iter().rev().copied().collect();
        ways.push((way, "the materials' order is reversed".to_owned()));
        for &material in &own {
            ways.push((vec![material; own.len()], "all objects are of one material".to_owned()));
        }
    }
    ways.sort();
    ways.dedup_by(|a, b| a.0 == b.0);
    ways.retain(|(way, _)| *way != own);
    ways.into_iter()
        .filter_map(|(way, of)| {
            let mut changed = scene.clone();
            for (object, &material) in changed.objects.iter_mut().zip(&way) {
                object.material = MaterialId(material);
            }
            let look = OtherLook::new(&right.view, &changed, way).ok()?;
            Some(Hypothesis::of("materials-swapped", Change::Look(Arc::new(look)), of))
        })
        .collect()
}

/// Ways in which rays may go elsewhere. None where a sky, fog or occlusion has part in the sum, which is
/// known only of the points that the right rays meet.
pub(super) fn elsewhere(scene: &Scene) -> Vec<(&'static Mistake, Way)> {
    if scene.sky.is_some() || scene.fog.is_some() || scene.ambient_occlusion.is_some() {
        return Vec::new();
    }
    let [width, height] = scene.image.size.map(f64::from);
    let mut all = Vec::new();
    let mut lens = |cause: &str, lens: Lens| {
        if lens != Lens::default() {
            all.push((Mistake::named(cause), Way::Lens(lens)));
        }
    };
    let right = Lens::default();
    for shift in [[-0.5, -0.5], [0.5, 0.5], [-0.5, 0.0], [0.0, -0.5], [-0.5, 0.5], [0.5, -0.5]] {
        lens("half-pixel", Lens { shift, ..right });
    }
    // The first and last pixels are put on the picture's border.
    lens(
        "half-pixel",
        Lens { scale: [width / (width - 1.0).max(1.0), height / (height - 1.0).max(1.0)], ..right },
    );
    lens("fov-horizontal", Lens { scale: [height / width; 2], ..right });
    for scale in [
        [height / width, 1.0],
        [1.0, width / height],
        [1.0, height / width],
        [(height / width) * (height / width), 1.0],
    ] {
        lens("aspect-ignored", Lens { scale, ..right });
    }
    if let CameraKind::Perspective { fov } = scene.camera.kind {
        let half = |degrees: f64| wide::tan(degrees.to_radians() / 2.0);
        for wrong in [2.0 * fov, fov / 2.0] {
            if wrong < 179.0 {
                lens("fov-half", Lens { scale: [half(wrong) / half(fov); 2], ..right });
            }
        }
    }
    if scene.camera.up.normalize_or(DVec3::Y) != DVec3::Y {
        let mut changed = scene.camera.clone();
        changed.up = DVec3::Y;
        all.push((Mistake::named("up-ignored"), Way::Camera(changed)));
    }
    for outward in [true, false] {
        all.push((Mistake::named("far-root"), Way::FarRoot { outward }));
    }
    all
}
