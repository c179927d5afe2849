//! Fog, ready for rays.

use glam::DVec3;
use phong_scene::{Background, FogDistance, FogKind, Rgb};

use crate::camera::Camera;
use crate::math;
use crate::sky::Sky;

/// Fog, ready for rays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fog {
    pub(crate) color: Rgb,
    kind: Kind,
    strength: f32,
    /// The camera's axis, where distances are taken along that.
    axis: Option<DVec3>,
    eye: DVec3,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Where it begins, and what it grows by over a scene unit.
    Linear(f32, f32),
    Exponential(f32),
    Squared(f32),
}

impl Fog {
    /// `sky` is what is seen in place of the background, if there is one.
    pub(super) fn new(
        fog: &phong_scene::Fog,
        background: Background,
        sky: Option<&Sky>,
        camera: &Camera,
    ) -> Self {
        let behind = || match (sky, background) {
            (Some(sky), _) => sky.horizon(),
            (None, Background::Color(color)) => color,
            (None, Background::Gradient { top, bottom }) => 0.5 * (top + bottom),
            (None, Background::Transparent) => Rgb::BLACK,
        };
        let axis = -camera.backward().to_vec().as_dvec3();
        Self {
            color: fog.color.unwrap_or_else(behind),
            kind: match fog.kind {
                FogKind::Linear { start, end } => {
                    Kind::Linear(start as f32, (1.0 / (end - start)) as f32)
                }
                FogKind::Exponential { density } => Kind::Exponential(density as f32),
                FogKind::Squared { density } => Kind::Squared(density as f32),
            },
            strength: fog.strength as f32,
            axis: (fog.distance == FogDistance::Planar).then_some(axis),
            eye: camera.eye(),
        }
    }

    /// How far a point is that a ray from the camera met, and what the ray's way counts as it goes straight
    /// on.
    pub(crate) fn distance(&self, p: DVec3, dir: glam::Vec3) -> (f32, f32) {
        let way = p - self.eye;
        match self.axis {
            Some(axis) => {
                let along = dir.as_dvec3().dot(axis).max(0.0);
                (way.dot(axis).max(0.0) as f32, along as f32)
            }
            None => (way.length() as f32, 1.0),
        }
    }

    /// What is left of light on a way from one distance to another.
    pub(crate) fn clear(&self, from: f32, to: f32) -> f32 {
        let (near, far) = (self.clear_to(from), self.clear_to(to));
        if near > 0.0 { (far / near).min(1.0) } else { 0.0 }
    }

    fn clear_to(&self, distance: f32) -> f32 {
        let clear = match self.kind {
            Kind::Linear(start, slope) => 1.0 - ((distance - start) * slope).clamp(0.0, 1.0),
            Kind::Exponential(density) => math::exp(-density * distance),
            Kind::Squared(density) => math::exp(-(density * distance) * (density * distance)),
        };
        1.0 - self.strength * (1.0 - clear)
    }
}
