//! Hands on the picture: what turning, moving and coming nearer lay over a scene's camera.

use phong::camera::Camera;
use phong::glam::{DQuat, DVec3};
use phong::math::wide;
use phong::scene::CameraKind;
use serde_json::json;

use super::look::laid_over;
use super::opened::{Files, Opened};

/// How near to looking straight up or down the eye may be turned, degrees.
const POLE: f64 = 2.0;

impl Opened {
    fn camera(&self) -> Result<phong::scene::Camera, String> {
        Ok(laid_over(self.base()?, self.set())?.0.camera)
    }

    fn place(&mut self, eye: DVec3, look_at: DVec3, files: Files<'_>) -> Result<(), String> {
        let list = |v: DVec3| json!(v.to_array());
        let values = [("camera.eye", list(eye)), ("camera.look_at", list(look_at))];
        self.lay(values.into_iter().map(|(path, value)| (path.to_owned(), value)).collect(), files)
    }

    /// Turns the eye about the point that is looked at; a camera that looks around turns about itself.
    pub(super) fn turn(&mut self, by: [f64; 2], files: Files<'_>) -> Result<(), String> {
        let [right, down] = finite(by)?;
        let camera = self.camera()?;
        let around = matches!(camera.kind, CameraKind::Fisheye { .. } | CameraKind::Panorama);
        let (center, moved) =
            if around { (camera.eye, camera.look_at) } else { (camera.look_at, camera.eye) };
        let up = camera.up.normalize_or(DVec3::Y);
        let offset = moved - center;
        let side = up.cross(offset).normalize_or(up.any_orthonormal_vector());
        let half_turn = std::f64::consts::PI;
        let height = wide::acos((offset.normalize_or(up).dot(up)).clamp(-1.0, 1.0));
        let pole = POLE.to_radians();
        let wanted = (height - down * half_turn).clamp(pole, half_turn - pole);
        let tilt = rotation(side, wanted - height);
        let offset = rotation(up, -right * half_turn) * (tilt * offset);
        if around {
            self.place(center, center + offset, files)
        } else {
            self.place(center + offset, center, files)
        }
    }

    /// Moves the eye and `look_at` across the view, so that the scene follows the pointer.
    pub(super) fn shift(&mut self, by: [f64; 2], files: Files<'_>) -> Result<(), String> {
        let [right, down] = finite(by)?;
        let camera = self.camera()?;
        let ready = Camera::new(&camera);
        let forward = (camera.look_at - camera.eye).normalize_or(-DVec3::Z);
        let x = forward.cross(camera.up).normalize_or(forward.any_orthonormal_vector());
        let y = x.cross(forward);
        // A picture of one pixel: places in it are heights.
        let middle = ready.place(camera.look_at, [1, 1]);
        let beside = ready.place(camera.look_at + x, [1, 1]);
        let unit = match (middle, beside) {
            (Some(middle), Some(beside)) => (beside - middle).length(),
            _ => 1.0 / (camera.look_at - camera.eye).length(),
        };
        let way = (y * down - x * right) / unit;
        self.place(camera.eye + way, camera.look_at + way, files)
    }

    /// Brings the eye nearer or further away.
    pub(super) fn zoom(&mut self, by: f64, files: Files<'_>) -> Result<(), String> {
        if !(by.is_finite() && by > 0.0) {
            return Err("a zoom is by a number above 0".to_owned());
        }
        let camera = self.camera()?;
        if let CameraKind::Orthographic { height } = camera.kind {
            let set = [("camera.height".to_owned(), json!(height * by))];
            return self.lay(set.into_iter().collect(), files);
        }
        self.place(camera.look_at + (camera.eye - camera.look_at) * by, camera.look_at, files)
    }
}

fn finite(by: [f64; 2]) -> Result<[f64; 2], String> {
    if by.iter().all(|n| n.is_finite() && n.abs() <= 100.0) {
        Ok(by)
    } else {
        Err("a turn or a move is by at most 100".to_owned())
    }
}

/// By an angle about a unit axis. (glam's own takes the platform's sine.)
fn rotation(axis: DVec3, angle: f64) -> DQuat {
    let (sin, cos) = wide::sin_cos(angle / 2.0);
    let v = axis * sin;
    DQuat::from_xyzw(v.x, v.y, v.z, cos)
}
