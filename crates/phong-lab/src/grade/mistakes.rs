//! The library of known mistakes.

use phong_scene::{CameraKind, LightKind, Scene};

use super::shade::{Ambient, Half, Lobe, Shadows, Wrong};

/// One known mistake.
#[derive(Clone, Copy, Debug)]
pub struct Mistake {
    /// What `cause` says.
    pub cause: &'static str,
    /// What is wrong, and what would be right, in a sentence.
    pub says: &'static str,
    pub(super) kind: Kind,
}

/// How a mistake changes the picture.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// The sum at each point.
    Sum(fn(&mut Wrong)),
    /// The scene itself: rays go elsewhere.
    Scene(fn(&mut Scene)),
    /// How values become levels.
    Curve(Curve),
    /// Where pixels are put.
    Layout(Layout),
    /// Lit points in shadow, at random.
    Acne,
    /// Values that are no numbers.
    NotNumbers,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Curve {
    Right,
    Missing,
    Twice,
    Power22,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    UpsideDown,
    LeftRight,
    Turned,
    BlueFirst,
}

const fn sum(cause: &'static str, says: &'static str, change: fn(&mut Wrong)) -> Mistake {
    Mistake { cause, says, kind: Kind::Sum(change) }
}

const fn scene(cause: &'static str, says: &'static str, change: fn(&mut Scene)) -> Mistake {
    Mistake { cause, says, kind: Kind::Scene(change) }
}

/// Every mistake that `grade` knows. Where two explain a picture equally well the earlier is named.
pub const MISTAKES: &[Mistake] = &[
    Mistake {
        cause: "not-a-number",
        says: "values are NaN: 0/0 (a vector of length 0 was normalised), or a fractional power or \
               the root of a number below 0",
        kind: Kind::NotNumbers,
    },
    Mistake {
        cause: "gamma-missing",
        says: "linear values were written as they are; encode them with the sRGB curve last",
        kind: Kind::Curve(Curve::Missing),
    },
    Mistake {
        cause: "gamma-twice",
        says: "the sRGB curve was applied twice",
        kind: Kind::Curve(Curve::Twice),
    },
    Mistake {
        cause: "gamma-2.2",
        says: "the power 1/2.2 was used for the sRGB curve, which has a straight piece at its foot",
        kind: Kind::Curve(Curve::Power22),
    },
    Mistake {
        cause: "upside-down",
        says: "rows run from bottom to top; pixel (0, 0) is the upper left",
        kind: Kind::Layout(Layout::UpsideDown),
    },
    Mistake {
        cause: "left-right",
        says: "columns run from right to left: the camera's right vector has the wrong sign",
        kind: Kind::Layout(Layout::LeftRight),
    },
    Mistake {
        cause: "turned",
        says: "the picture is turned by 180°: both the right and the up vector have the wrong sign",
        kind: Kind::Layout(Layout::Turned),
    },
    Mistake {
        cause: "blue-first",
        says: "red and blue are exchanged",
        kind: Kind::Layout(Layout::BlueFirst),
    },
    sum("ambient-missing", "the ambient term k_a C_a is missing", |w| w.ambient = Ambient::Missing),
    sum("ambient-per-light", "the ambient term is added once for every light", |w| {
        w.ambient = Ambient::PerLight;
    }),
    sum("ambient-not-in-shadow", "a point in shadow loses its ambient term too", |w| {
        w.ambient = Ambient::NotInShadow;
    }),
    sum("diffuse-missing", "the diffuse term is missing", |w| w.diffuse = false),
    sum("specular-missing", "the specular term is missing", |w| w.specular = false),
    sum("shadows-missing", "nothing casts a shadow", |w| w.shadows = Shadows::Missing),
    sum(
        "shadow-ray-endless",
        "things behind a point light cast shadows: a shadow ray ends at the light",
        |w| w.shadows = Shadows::Endless,
    ),
    Mistake {
        cause: "shadow-acne",
        says: "surfaces shadow themselves at random points: start the shadow ray off the surface",
        kind: Kind::Acne,
    },
    sum(
        "reflection-sign",
        "R, or E, points the wrong way: R = 2(L·N)N − L, E towards the eye",
        |w| {
            w.mirrored = true;
        },
    ),
    sum("half-unnormalized", "H = L + E was not normalised", |w| w.half = Half::Sum),
    sum("half-mean", "H = (L + E)/2 was not normalised", |w| w.half = Half::Mean),
    sum(
        "phong-not-blinn",
        "the lobe is Phong's (R·E)^α where the scene says Blinn–Phong",
        |w| {
            w.lobe = Some(Lobe::Phong);
        },
    ),
    sum("blinn-not-phong", "the lobe is Blinn's (N·H)^α where the scene says Phong", |w| {
        w.lobe = Some(Lobe::Blinn);
    }),
    sum("exponent-quarter", "the exponent is a quarter of the scene's", |w| w.exponent = 0.25),
    sum("exponent-half", "the exponent is half of the scene's", |w| w.exponent = 0.5),
    sum("exponent-double", "the exponent is twice the scene's", |w| w.exponent = 2.0),
    sum("exponent-fourfold", "the exponent is four times the scene's", |w| w.exponent = 4.0),
    sum("clamp-missing-diffuse", "L·N below 0 takes light away: clamp it at 0", |w| {
        w.unclamped_diffuse = true;
    }),
    sum("clamp-missing-specular", "R·E below 0 is raised to the power: clamp it at 0", |w| {
        w.unclamped_specular = true;
    }),
    sum("highlight-behind", "highlights show where L·N ≤ 0: cut them there", |w| {
        w.uncut_specular = true;
    }),
    sum("clamp-missing-both", "neither L·N nor R·E is clamped at 0", |w| {
        w.unclamped_diffuse = true;
        w.unclamped_specular = true;
    }),
    sum("normal-inside-out", "normals point into the objects: n = p − c, not c − p", |w| {
        w.inside_out = true;
    }),
    sum("light-unnormalized", "L was not normalised: far lights are too strong", |w| {
        w.long_l = true;
    }),
    sum("specular-tinted", "the highlight is multiplied by the object's colour", |w| {
        w.tinted = true;
    }),
    sum("specular-times-cosine", "the highlight is multiplied by L·N", |w| w.times_cosine = true),
    sum("first-light-only", "only the first light counts", |w| w.first_light = true),
    scene("distant-reversed", "a distant light's direction was taken as the way to it", |scene| {
        for light in &mut scene.lights {
            if let LightKind::Distant { direction, .. } = &mut light.kind {
                *direction = -*direction;
            }
        }
    }),
    sum("inverse-square", "light falls off with the square of its distance, unasked", |w| {
        w.inverse_square = true;
    }),
    sum("clamped-too-early", "each light's sum is clamped before the lights are added", |w| {
        w.clamped_lights = true;
    }),
    sum("reflection-missing", "mirror and glass rays bring nothing", |w| w.no_secondary = true),
    scene("attenuation-missing", "lights do not fall off with distance", |scene| {
        for light in &mut scene.lights {
            if let LightKind::Point { attenuation, .. } | LightKind::Spot { attenuation, .. } =
                &mut light.kind
            {
                *attenuation = [1.0, 0.0, 0.0];
            }
        }
    }),
    scene("fov-horizontal", "the field of view was taken as horizontal: it is vertical", |scene| {
        let [width, height] = scene.image.size.map(f64::from);
        if let CameraKind::Perspective { fov } = &mut scene.camera.kind {
            let half = phong::math::wide::tan(fov.to_radians() / 2.0) * height / width;
            *fov = 2.0 * phong::math::wide::atan(half).to_degrees();
        }
    }),
    scene("fov-half", "the field of view was taken as its half: use tan(fov / 2)", |scene| {
        if let CameraKind::Perspective { fov } = &mut scene.camera.kind {
            *fov = (2.0 * *fov).min(179.0);
        }
    }),
    scene("up-ignored", "the camera's up vector was not used", |scene| {
        scene.camera.up = glam::DVec3::Y;
    }),
];
