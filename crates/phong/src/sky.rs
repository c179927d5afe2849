//! A sky, ready for rays.

mod image;

use std::f32::consts::TAU;

use glam::{DVec3, Vec3};
use phong_scene::{Rgb, SkyKind};

use crate::math::{self, wide};
use image::SkyImage;

/// A sky, ready for rays.
#[derive(Clone, Debug)]
pub(crate) struct Sky {
    up: Vec3,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Constant(Rgb),
    Gradient { zenith: Rgb, horizon: Rgb, ground: Rgb },
    Daylight(Box<Daylight>),
    Image(Box<SkyImage>),
}

impl Sky {
    /// A sky whose light each surface finds out about by so many rays.
    pub(crate) fn new(sky: &phong_scene::Sky, rays: u32) -> Self {
        let up = sky.up.normalize_or(DVec3::Y);
        let kind = match &sky.kind {
            SkyKind::Constant => Kind::Constant(sky.color),
            &SkyKind::Gradient { zenith, horizon, ground } => {
                let [zenith, horizon, ground] =
                    [zenith, horizon, ground.unwrap_or(horizon)].map(|color| color * sky.color);
                Kind::Gradient { zenith, horizon, ground }
            }
            &SkyKind::SunAndSky { sun, turbidity, ground } => {
                let ground = ground.unwrap_or(Rgb::grey(0.2)) * sky.color;
                let sun = sun.normalize_or(up);
                Kind::Daylight(Box::new(Daylight::new(sun, up, turbidity, sky.color, ground)))
            }
            SkyKind::Image { texels, rotation, .. } => {
                let image = SkyImage::new(texels, up, *rotation, sky.color, rays);
                Kind::Image(Box::new(image))
            }
        };
        Self { up: up.as_vec3(), kind }
    }

    /// What comes from about a unit direction, as one of the rays by which a surface finds out about the
    /// sky's light has it: of an image the mean over a part of what lies between the rays. Linear.
    pub(crate) fn light(&self, dir: Vec3) -> Rgb {
        match &self.kind {
            Kind::Image(image) => image.around(dir),
            _ => self.radiance(dir),
        }
    }

    /// What comes from a unit direction. Linear.
    pub(crate) fn radiance(&self, dir: Vec3) -> Rgb {
        // Beyond 1, as rounding may have it, the horizon's colour would be taken off.
        let height = dir.dot(self.up).min(1.0);
        match &self.kind {
            Kind::Constant(color) => *color,
            Kind::Gradient { ground, .. } if height < 0.0 => *ground,
            Kind::Gradient { zenith, horizon, .. } => (1.0 - height) * *horizon + height * *zenith,
            Kind::Image(image) => image.at(dir),
            Kind::Daylight(daylight) if height < 0.0 => daylight.ground,
            Kind::Daylight(daylight) => daylight.radiance(height, dir.dot(daylight.sun)),
        }
    }
    /// The mean of what comes from all around the horizon. Linear.
    pub(crate) fn horizon(&self) -> Rgb {
        const DIRECTIONS: u32 = 256;
        let mean = |of: &dyn Fn(Vec3) -> Rgb| {
            let (aside, across) = self.up.any_orthonormal_pair();
            let sum = (0..DIRECTIONS).fold(Rgb::BLACK, |sum, i| {
                let (sin, cos) = math::sin_cos(TAU * i as f32 / DIRECTIONS as f32);
                sum + of(cos * aside + sin * across)
            });
            (1.0 / DIRECTIONS as f32) * sum
        };
        match &self.kind {
            Kind::Constant(color) => *color,
            Kind::Gradient { horizon, .. } => *horizon,
            Kind::Daylight(daylight) => mean(&|dir| daylight.radiance(0.0, dir.dot(daylight.sun))),
            Kind::Image(image) => mean(&|dir| image.at(dir)),
        }
    }
}

/// The model of Preetham, Shirley and Smits, *A Practical Analytic Model for Daylight*, 1999: luminance and
/// chromaticities x and y, each that of the zenith times Perez's function of the heights and the angle to the
/// sun.
#[derive(Clone, Debug)]
struct Daylight {
    sun: Vec3,
    /// Of Y, x and y the five coefficients of Perez's function.
    perez: [[f32; 5]; 3],
    /// Of Y, x and y what the function is multiplied by.
    scale: [f32; 3],
    color: Rgb,
    ground: Rgb,
}

impl Daylight {
    fn new(sun: DVec3, up: DVec3, turbidity: f64, color: Rgb, ground: Rgb) -> Self {
        /// Places along and around, of those that the mean is taken over.
        const RINGS: u32 = 48;
        let t = turbidity;
        let line = |[a, b]: [f64; 2]| (a * t + b) as f32;
        // Their table 2.
        let perez = [
            [
                [0.1787, -1.4630],
                [-0.3554, 0.4275],
                [-0.0227, 5.3251],
                [0.1206, -2.5771],
                [-0.0670, 0.3703],
            ],
            [
                [-0.0193, -0.2592],
                [-0.0665, 0.0008],
                [-0.0004, 0.2125],
                [-0.0641, -0.8989],
                [-0.0033, 0.0452],
            ],
            [
                [-0.0167, -0.2608],
                [-0.0950, 0.0092],
                [-0.0079, 0.2102],
                [-0.0441, -1.6537],
                [-0.0109, 0.0529],
            ],
        ]
        .map(|of| of.map(line));
        let height = sun.dot(up).clamp(0.0, 1.0);
        let angle = wide::acos(height);
        let cubic = |rows: [[f64; 4]; 3]| {
            let at = |[a, b, c, d]: [f64; 4]| ((a * angle + b) * angle + c) * angle + d;
            (at(rows[0]) * t + at(rows[1])) * t + at(rows[2])
        };
        let x = cubic([
            [0.001_66, -0.003_75, 0.002_09, 0.0],
            [-0.029_03, 0.063_77, -0.032_02, 0.003_94],
            [0.116_93, -0.211_96, 0.060_52, 0.258_86],
        ]);
        let y = cubic([
            [0.002_75, -0.006_10, 0.003_17, 0.0],
            [-0.042_14, 0.089_70, -0.041_53, 0.005_16],
            [0.153_46, -0.267_56, 0.066_70, 0.266_88],
        ]);
        let straight_up = perez.map(|of| function(of, 1.0, height as f32));
        let mut sky = Self { sun: sun.as_vec3(), perez, scale: [1.0; 3], color, ground };
        // The mean that a level surface meets is 1: the places are even in the square of the sine.
        let mut sum = 0.0;
        let aside = up.any_orthonormal_vector();
        let across = up.cross(aside);
        for ring in 0..RINGS {
            let square = (f64::from(ring) + 0.5) / f64::from(RINGS);
            let (radius, height) = (square.sqrt(), (1.0 - square).sqrt());
            for turn in 0..RINGS {
                let angle = f64::from(turn) / f64::from(RINGS) * std::f64::consts::TAU;
                let (sin, cos) = wide::sin_cos(angle);
                let dir = height * up + radius * (cos * aside + sin * across);
                let gamma = dir.as_vec3().dot(sky.sun);
                sum += f64::from(function(perez[0], height as f32, gamma));
            }
        }
        let mean = sum / f64::from(RINGS * RINGS);
        sky.scale = [
            (1.0 / mean) as f32,
            (x / f64::from(straight_up[1])) as f32,
            (y / f64::from(straight_up[2])) as f32,
        ];
        sky
    }

    /// What comes from a direction, by the sine of its height and the cosine of its angle to the sun.
    fn radiance(&self, height: f32, cos_sun: f32) -> Rgb {
        let [luminance, x, y] =
            std::array::from_fn(|i| self.scale[i] * function(self.perez[i], height, cos_sun));
        // From Y, x and y to X, Y and Z, and on to Rec. 709.
        let y = y.max(1e-3);
        let (cx, cz) = (x / y * luminance, (1.0 - x - y) / y * luminance);
        let rgb = [
            3.240_97 * cx - 1.537_383 * luminance - 0.498_611 * cz,
            -0.969_244 * cx + 1.875_968 * luminance + 0.041_555 * cz,
            0.055_63 * cx - 0.203_977 * luminance + 1.056_972 * cz,
        ];
        self.color * Rgb::from(rgb.map(|v| v.max(0.0)))
    }
}

/// Perez's function, by the cosine of the angle to the zenith and that of the angle to the sun.
fn function([a, b, c, d, e]: [f32; 5], cos_zenith: f32, cos_sun: f32) -> f32 {
    let gamma = math::acos(cos_sun);
    let low = 1.0 + a * math::exp(b / cos_zenith.max(1e-3));
    low * (1.0 + c * math::exp(d * gamma) + e * cos_sun * cos_sun)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn daylight(turbidity: f64) -> Sky {
        let kind = SkyKind::SunAndSky { sun: DVec3::new(1.0, 1.0, 0.0), turbidity, ground: None };
        Sky::new(&phong_scene::Sky { kind, ..phong_scene::Sky::default() }, 16)
    }

    #[test]
    fn a_gradient_runs_from_the_horizon_to_the_zenith() {
        let [zenith, horizon] = [Rgb::new(0.0, 0.0, 1.0), Rgb::new(1.0, 0.0, 0.0)];
        let kind = SkyKind::Gradient { zenith, horizon, ground: Some(Rgb::grey(0.5)) };
        let sky = phong_scene::Sky { kind, up: DVec3::Z, ..phong_scene::Sky::default() };
        let sky = Sky::new(&sky, 16);
        assert_eq!(sky.radiance(Vec3::Z), zenith);
        assert_eq!(sky.radiance(Vec3::X), horizon);
        assert_eq!(sky.radiance(Vec3::new(0.8, 0.0, 0.6)), Rgb::new(1.0 - 0.6, 0.0, 0.6));
        assert_eq!(sky.radiance(-Vec3::Z), Rgb::grey(0.5));
        let rounded = Vec3::new(0.0, 0.0, 1.0 + f32::EPSILON);
        assert_eq!(sky.radiance(rounded), zenith, "nothing is negative");
    }

    #[test]
    fn a_clear_sky_is_blue_above_bright_at_the_sun_and_white_in_haze() {
        let clear = daylight(2.0);
        let above = clear.radiance(Vec3::Y);
        assert!(above.b > 1.5 * above.r, "{above:?}");
        let at_sun = clear.radiance(Vec3::new(1.0, 1.0, 0.0).normalize_or_zero()).luminance();
        let opposite = clear.radiance(Vec3::new(-1.0, 1.0, 0.0).normalize_or_zero()).luminance();
        assert!(at_sun > 3.0 * opposite, "{at_sun} {opposite}");
        let hazy = daylight(9.0).radiance(Vec3::Y);
        assert!(hazy.b / hazy.r < above.b / above.r, "{hazy:?}");
    }

    #[test]
    fn a_level_surface_meets_a_mean_luminance_of_1_by_day() {
        for turbidity in [2.0, 4.0] {
            let sky = daylight(turbidity);
            let (mut sum, n) = (0.0, 60_u32);
            for i in 0..n * n {
                let place = [i % n, i / n].map(|k| (k as f32 + 0.5) / n as f32);
                let [x, z] = crate::sampling::concentric_disc(place);
                let dir = Vec3::new(x, (1.0 - x * x - z * z).sqrt(), z);
                sum += f64::from(sky.radiance(dir).luminance());
            }
            let mean = sum / f64::from(n * n);
            assert!((mean - 1.0).abs() < 0.01, "turbidity {turbidity}: {mean}");
        }
    }
}
