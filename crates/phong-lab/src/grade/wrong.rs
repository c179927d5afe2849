//! What may be wrong with a renderer's sum at a point.

/// Everything that may be wrong with the sum; by default nothing is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent mistake")]
pub(super) struct Wrong {
    pub(super) ambient: Ambient,
    /// What the ambient term is multiplied by.
    pub(super) ambient_factor: f32,
    pub(super) diffuse_factor: f32,
    pub(super) specular_factor: f32,
    pub(super) shadows: Shadows,
    /// What lights below the horizon meet.
    pub(super) below: Below,
    pub(super) diffuse_clamp: Clamp,
    pub(super) specular_clamp: Clamp,
    /// The highlight is not cut where the light is behind the surface.
    pub(super) uncut_specular: bool,
    /// Of R: the sign.
    pub(super) mirrored: bool,
    pub(super) eye: Eye,
    pub(super) half: Half,
    pub(super) lobe: Option<Lobe>,
    /// What the exponent is multiplied by.
    pub(super) exponent: f32,
    pub(super) normal: Normal,
    /// L keeps the length of the way to the light.
    pub(super) long_l: bool,
    /// L points away from point lights and spots.
    pub(super) reversed_points: Option<Reversed>,
    /// L points away from distant lights.
    pub(super) reversed_distant: Option<Reversed>,
    /// What the highlight is tinted by besides.
    pub(super) tinted: bool,
    pub(super) times_cosine: bool,
    /// Only the first light counts.
    pub(super) first_light: bool,
    pub(super) falloff: Falloff,
    pub(super) light_color: LightColor,
    /// Each light's sum is clamped to 1 before it is added.
    pub(super) clamped_lights: bool,
    /// The lights' sum is divided by their number.
    pub(super) averaged: bool,
    pub(super) k_d_ignored: bool,
    pub(super) k_s_ignored: bool,
    /// Mirror and glass rays bring nothing.
    pub(super) no_secondary: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ambient {
    Right,
    Missing,
    PerLight,
    /// Once for each light that is seen.
    PerSeenLight,
    /// Not where every light above the horizon is blocked.
    NotInShadow,
    /// Not where no light is seen.
    NotUnlit,
    /// Not where any light is blocked.
    NotWhereBlocked,
    /// `k_a` is taken for 1.
    WithoutWeight,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shadows {
    Right,
    Missing,
    /// Things behind a point light cast shadows too.
    Endless,
    /// In shadow these shares of a light's diffuse and specular terms are left.
    Through(f32, f32),
    /// Where a light is blocked this share of the whole sum is left.
    Whole(f32),
}

/// What stands in the way of lights below the horizon, of which our own picture says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Below {
    /// Nothing.
    Open,
    /// What a ray to them meets, the surface's own object included.
    Traced,
}

/// What becomes of a cosine below 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clamp {
    Right,
    Missing,
    Abs,
    /// Of R·E: missing, but only where the light is above the horizon.
    MissingWhereLit,
    /// Of R·E: the absolute value, but only where the light is above the horizon.
    AbsWhereLit,
}

/// Where E leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Eye {
    Right,
    /// Against the camera's axis, everywhere.
    Axis,
    /// From the origin to the eye, everywhere.
    FromOrigin,
    /// Along z, everywhere.
    AlongZ,
    /// The origin.
    AtOrigin,
    /// The eye, and keeps the length of the way.
    Long,
    /// The eye, and keeps the length of the ray through the screen at distance 1.
    LongRay,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Normal {
    Right,
    /// As the surface has it, never turned to the ray.
    Outward,
    Inward,
    /// `p − c`, or as it was written: not of length 1.
    Long,
}

/// What stands in the way of a light whose L is reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reversed {
    /// Nothing.
    Untested,
    /// What a ray along the wrong L meets, as far as the light is away.
    Away,
    /// What a ray along the wrong L meets.
    AwayEndless,
    /// What stands between the point and the light.
    Between,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Falloff {
    Right,
    Missing,
    Linear,
    Square,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightColor {
    Right,
    White,
    /// Grey, as bright as its brightest channel, its mean, or its luminance.
    Brightest,
    Mean,
    Luminance,
    /// The specular colour is white.
    WhiteSpecular,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Half {
    Right,
    /// L + E, as it is.
    Sum,
    /// (L + E) / 2.
    Mean,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lobe {
    Phong,
    Blinn,
}

impl Default for Wrong {
    fn default() -> Self {
        Self {
            ambient: Ambient::Right,
            ambient_factor: 1.0,
            diffuse_factor: 1.0,
            specular_factor: 1.0,
            shadows: Shadows::Right,
            below: Below::Traced,
            diffuse_clamp: Clamp::Right,
            specular_clamp: Clamp::Right,
            uncut_specular: false,
            mirrored: false,
            eye: Eye::Right,
            half: Half::Right,
            lobe: None,
            exponent: 1.0,
            normal: Normal::Right,
            long_l: false,
            reversed_points: None,
            reversed_distant: None,
            tinted: false,
            times_cosine: false,
            first_light: false,
            falloff: Falloff::Right,
            light_color: LightColor::Right,
            clamped_lights: false,
            averaged: false,
            k_d_ignored: false,
            k_s_ignored: false,
            no_secondary: false,
        }
    }
}
