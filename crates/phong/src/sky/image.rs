//! A sky that is an image of all directions.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use phong_scene::{Rgb, TexelValues, Texels};

use crate::math;

/// The part of the angle between rays that each is the mean over: more would be smooth and wash out what
/// things hide of the sky, less would be noise.
const SHARE: f32 = 0.5;

/// An image of all directions, ready for rays.
#[derive(Clone, Debug)]
pub(super) struct SkyImage {
    texels: Arc<Texels>,
    /// The same, halved as often as the rays by which surfaces find out about its light are few.
    halved: Arc<Texels>,
    up: Vec3,
    /// Towards its middle, and to the right of that.
    forward: Vec3,
    right: Vec3,
    /// How far it is turned, in turns.
    turn: f32,
    color: Rgb,
    srgb: bool,
}

impl SkyImage {
    /// `up` is unit; `rays` are those by which each surface finds out about its light.
    pub(super) fn new(
        texels: &Arc<Texels>,
        up: DVec3,
        rotation: f64,
        color: Rgb,
        rays: u32,
    ) -> Self {
        let ahead = if up.z.abs() > 0.999 { DVec3::Y } else { -DVec3::Z };
        let forward = (ahead - ahead.dot(up) * up).normalize_or(DVec3::X);
        let srgb = !matches!(texels.values(), TexelValues::Floats(_));
        // Rays share half of all directions; an image's height is half a turn.
        let angle = SHARE * (std::f32::consts::TAU / rays as f32).sqrt();
        let rows = std::f32::consts::PI / angle;
        let mut halved = Arc::clone(texels);
        while halved.size()[1] as f32 >= 2.0 * rows {
            let Some(half) = halved.half(srgb).cloned() else { break };
            halved = half;
        }
        Self {
            texels: Arc::clone(texels),
            halved,
            up: up.as_vec3(),
            forward: forward.as_vec3(),
            right: forward.cross(up).as_vec3(),
            turn: (rotation / 360.0).rem_euclid(1.0) as f32,
            color,
            srgb,
        }
    }

    /// What comes from a unit direction. Linear.
    pub(super) fn at(&self, dir: Vec3) -> Rgb {
        self.look_up(&self.texels, dir)
    }

    /// What comes from about a unit direction, as far around it as rays are apart. Linear.
    pub(super) fn around(&self, dir: Vec3) -> Rgb {
        self.look_up(&self.halved, dir)
    }

    /// The value between the four pixels about a direction: columns go on all around, rows end.
    fn look_up(&self, texels: &Texels, dir: Vec3) -> Rgb {
        use std::f32::consts::{PI, TAU};
        let around = math::atan2(dir.dot(self.right), dir.dot(self.forward)) / TAU;
        let [width, height] = texels.size();
        let x = (0.5 + around + self.turn) * width as f32 - 0.5;
        let y = (0.5 - math::asin(dir.dot(self.up)) / PI) * height as f32 - 0.5;
        let (left, upper) = (x.floor(), y.floor());
        let (across, down) = (x - left, y - upper);
        let texel = |x: i64, y: i64| {
            let column = x.rem_euclid(i64::from(width)) as u32;
            let row = y.clamp(0, i64::from(height) - 1) as u32;
            let [r, g, b, _] = texels.get([column, row], self.srgb);
            // A ray brings no less than nothing.
            Rgb::new(r.max(0.0), g.max(0.0), b.max(0.0))
        };
        let (left, upper) = (left as i64, upper as i64);
        let row = |y: i64| (1.0 - across) * texel(left, y) + across * texel(left + 1, y);
        let light = (1.0 - down) * row(upper) + down * row(upper + 1);
        light * self.color
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four columns and two rows of floats: 1 to 4 above, 5 to 8 below.
    fn image(up: DVec3, rotation: f64, rays: u32) -> SkyImage {
        let values = (1..=8).map(|i| i as f32).collect();
        let texels = Arc::new(Texels::new([4, 2], 1, TexelValues::Floats(values)).unwrap());
        SkyImage::new(&texels, up, rotation, Rgb::WHITE, rays)
    }

    /// The direction that is so far to the right of the middle, and so high.
    fn dir(right: f32, height: f32) -> Vec3 {
        let (sin, cos) = math::sin_cos(right.to_radians());
        let (up, level) = math::sin_cos(height.to_radians());
        Vec3::new(sin * level, up, -cos * level)
    }

    #[test]
    fn the_middle_is_ahead_the_right_is_right_and_the_upper_edge_straight_up() {
        let image = image(DVec3::Y, 0.0, 1_000_000);
        let at = |right, height| image.at(dir(right, height)).g;
        let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-4, "{a} is not {b}");
        near(at(45.0, 45.0), 3.0);
        near(at(-45.0, 45.0), 2.0);
        near(at(135.0, -45.0), 8.0);
        near(at(-135.0, -45.0), 5.0);
        // Between the last column and the first; above the middle of the first row.
        near(at(180.0, 45.0), 2.5);
        near(at(0.0, 80.0), 2.5);
        near(at(0.0, 0.0), 4.5);
    }

    #[test]
    fn an_image_is_turned_about_up_whichever_way_that_is() {
        // A quarter to the left, as seen from within: what was to the right of the middle is left of it.
        let turned = image(DVec3::Y, 90.0, 1_000_000);
        assert!((turned.at(dir(-45.0, 45.0)).g - 3.0).abs() < 1e-4);
        // Where Z is up, ahead is Y.
        let upright = image(DVec3::Z, 0.0, 1_000_000);
        let dir = Vec3::new(1.0, 1.0, std::f32::consts::SQRT_2).normalize_or_zero();
        assert!((upright.at(dir).g - 3.0).abs() < 1e-4);
    }

    #[test]
    fn few_rays_see_the_mean_of_much_and_many_the_image_itself() {
        let squares = (0..128).map(|i| ((i + i / 16) % 2) as f32).collect();
        let texels = Arc::new(Texels::new([16, 8], 1, TexelValues::Floats(squares)).unwrap());
        let few = SkyImage::new(&texels, DVec3::Y, 0.0, Rgb::WHITE, 1);
        assert_eq!(few.around(dir(40.0, 50.0)), Rgb::grey(0.5));
        let many = image(DVec3::Y, 0.0, 4096);
        assert_eq!(many.around(dir(45.0, 45.0)), many.at(dir(45.0, 45.0)));
    }

    #[test]
    fn every_direction_has_a_value_that_is_a_number() {
        let image = image(DVec3::new(0.0, 1.0, 0.0), 359.9, 16);
        for dir in [Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z, Vec3::X] {
            assert!(image.at(dir).g.is_finite() && image.around(dir).g >= 0.0, "{dir}");
        }
    }
}
