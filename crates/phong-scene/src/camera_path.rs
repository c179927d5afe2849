//! A way that the camera goes, in a file of its own: so that it goes with any scene, and with bare models.
//!
//! ```toml
//! version = 1
//! pictures = 100
//!
//! [[key]]
//! time = 0
//! eye = [0, 2, 8]
//! look_at = [0, 1, 0]
//!
//! [[key]]
//! time = 1
//! eye = [8, 3, 0]
//! look_at = [0, 1, 0]
//! fov = 25
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `pictures` | a whole number from 1 to 1000000 | required | Pictures at even times from the first key to the last, both counted. |
//! | `key` | a list of tables | required | Where the camera is at which time; two at least. |
//!
//! Of each key:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `time` | a number 0 or above | required | When it is there, in any unit; later than the key before. |
//! | `eye` | three numbers, `[x, y, z]` | required | Position of the eye, in scene units. |
//! | `look_at` | three numbers, `[x, y, z]` | required | The point in the middle of the picture. |
//! | `up` | three numbers, `[x, y, z]`, not all 0 | `[0, 1, 0]` | The direction that points up in the picture; any length. |
//! | `fov` | a number above 0 and below 180 | the camera's own | Vertical field of view of a perspective camera, degrees. |
//! | `height` | a number above 0 | the camera's own | The picture's height of an orthographic camera, scene units. |
//!
//! Between keys every number runs along a cubic that passes through each key at its time, with the slope
//! there of the parabola through it and its two neighbours (Catmull and Rom's spline for uneven times): the
//! camera neither stops nor turns sharply at a key. Angles and heights stay between their least and largest.

use glam::DVec3;

use crate::camera::{Camera, CameraKind};
use crate::diagnostic::{Diagnostic, Place, Span};

/// A way that the camera goes. It has two keys at least, their times rise, and each looks somewhere.
#[derive(Clone, Debug)]
pub struct CameraPath {
    /// Pictures at even times from the first key to the last, at least 1.
    pub pictures: u32,
    /// Where the camera is at which time.
    pub keys: Vec<CameraKey>,
}

/// Where the camera is at one time.
#[derive(Clone, Debug)]
pub struct CameraKey {
    /// When, in any unit, ≥ 0.
    pub time: f64,
    /// Position of the eye, in scene units.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub look_at: DVec3,
    /// The direction that points up in the picture; any length.
    pub up: DVec3,
    /// Vertical field of view, degrees; `None`: the camera's own.
    pub fov: Option<f64>,
    /// The picture's height, scene units; `None`: the camera's own.
    pub height: Option<f64>,
    /// Where it was written.
    pub place: Place,
}

/// What is read of a file.
#[derive(Clone, Debug)]
pub struct CameraPathReading {
    /// `None`: there are errors.
    pub path: Option<CameraPath>,
    /// Everything there is to say.
    pub diagnostics: Vec<Diagnostic>,
}

impl CameraPath {
    /// What keys say of the picture's width that cameras like this one do not have, and where no picture can
    /// be between two keys.
    pub fn unfit(&self, camera: &Camera) -> Option<Diagnostic> {
        let (fov, height) = match camera.kind {
            CameraKind::Perspective { .. } => (true, false),
            CameraKind::Orthographic { .. } => (false, true),
            CameraKind::Fisheye { .. } | CameraKind::Panorama => (false, false),
        };
        let unfit = self.keys.iter().find_map(|key| {
            let (name, kind) = match (key.fov, key.height) {
                (Some(_), _) if !fov => ("fov", "a perspective"),
                (_, Some(_)) if !height => ("height", "an orthographic"),
                _ => return None,
            };
            let message = format!("`{name}` is for {kind} camera, which the scene's is not");
            Some(Diagnostic::error(message, Span { place: key.place.clone(), ..Span::default() }))
        });
        // Keys are sound each by itself; the way between them may still lead through what is looked at.
        let lost = |picture: &u32| {
            let Camera { eye, look_at, up, .. } = self.camera(camera, *picture);
            let (view, up) = ((look_at - eye).try_normalize(), up.try_normalize());
            !view.zip(up).is_some_and(|(view, up)| view.cross(up).length() >= 1e-8)
        };
        unfit.or_else(|| {
            let picture = (0..self.pictures).find(lost)?;
            let message = format!(
                "at picture {picture}, between two keys, the eye meets `look_at` or `up` points along the view"
            );
            let place = self.keys.first()?.place.clone();
            let error = Diagnostic::error(message, Span { place, ..Span::default() });
            Some(error.with_help("add a key there that leads the camera around it"))
        })
    }

    /// The camera of a picture, counted from 0; what keys do not say is that of `camera`.
    ///
    /// ```
    /// use glam::DVec3;
    /// use phong_scene::{Camera, Limits, Memory, read_camera_path};
    /// let text = "version = 1\npictures = 3\n[[key]]\ntime = 0\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
    ///             [[key]]\ntime = 4\neye = [2, 0, 5]\nlook_at = [2, 0, 0]\n";
    /// let files = Memory::new().with("way.toml", text.as_bytes());
    /// let path = read_camera_path("way.toml", &files, &Limits::default()).path.expect("a way");
    /// assert_eq!(path.camera(&Camera::default(), 1).eye, DVec3::new(1.0, 0.0, 5.0));
    /// ```
    #[must_use]
    pub fn camera(&self, camera: &Camera, picture: u32) -> Camera {
        let [Some(first), Some(last)] = [self.keys.first(), self.keys.last()] else {
            return camera.clone();
        };
        let share = f64::from(picture) / f64::from(self.pictures.saturating_sub(1).max(1));
        let time = first.time + share.min(1.0) * (last.time - first.time);
        // The key before, if it is not the last one.
        let after = self.keys.partition_point(|key| key.time <= time);
        let at = after.saturating_sub(1).min(self.keys.len().saturating_sub(2));
        let own = match camera.kind {
            CameraKind::Perspective { fov } | CameraKind::Fisheye { fov } => fov,
            CameraKind::Orthographic { height } => height,
            CameraKind::Panorama => 1.0,
        };
        let wide = |key: &CameraKey| key.fov.or(key.height).unwrap_or(own);
        let numbers = |key: &CameraKey| {
            let [e, l, u] = [key.eye, key.look_at, key.up.normalize_or(DVec3::Y)];
            [e.x, e.y, e.z, l.x, l.y, l.z, u.x, u.y, u.z, wide(key)]
        };
        let [ex, ey, ez, lx, ly, lz, ux, uy, uz, width] = self.between(at, time, numbers);
        let least = self.keys.iter().map(wide).fold(f64::INFINITY, f64::min);
        let most = self.keys.iter().map(wide).fold(0.0, f64::max);
        let width = width.clamp(least, most);
        let kind = match camera.kind {
            CameraKind::Perspective { .. } => CameraKind::Perspective { fov: width },
            CameraKind::Orthographic { .. } => CameraKind::Orthographic { height: width },
            other => other,
        };
        let (eye, look_at) = (DVec3::new(ex, ey, ez), DVec3::new(lx, ly, lz));
        Camera { kind, eye, look_at, up: DVec3::new(ux, uy, uz), ..camera.clone() }
    }

    /// Numbers at a time between the key `at` and the next.
    fn between<const N: usize>(
        &self,
        at: usize,
        time: f64,
        numbers: impl Fn(&CameraKey) -> [f64; N],
    ) -> [f64; N] {
        let [from, to] = [at, at + 1].map(|i| &self.keys[i.min(self.keys.len() - 1)]);
        let step = to.time - from.time;
        let (begin, end) = (numbers(from), numbers(to));
        if step <= 0.0 || time <= from.time {
            return begin;
        }
        if time >= to.time {
            return end;
        }
        let secant = |a: &CameraKey, b: &CameraKey, i: usize| {
            (numbers(b)[i] - numbers(a)[i]) / (b.time - a.time)
        };
        // The slope at a key of the parabola through it and its neighbours; at an end, the secant's.
        let slope = |key: usize, i: usize| {
            let before = key.checked_sub(1).map(|before| &self.keys[before]);
            let (this, after) = (&self.keys[key], self.keys.get(key + 1));
            match (before, after) {
                (Some(before), Some(after)) => {
                    let [left, right] = [this.time - before.time, after.time - this.time];
                    (secant(before, this, i) * right + secant(this, after, i) * left)
                        / (left + right)
                }
                (Some(before), None) => secant(before, this, i),
                (None, Some(after)) => secant(this, after, i),
                (None, None) => 0.0,
            }
        };
        let t = (time - from.time) / step;
        let (square, cube) = (t * t, t * t * t);
        std::array::from_fn(|i| {
            (2.0 * cube - 3.0 * square + 1.0) * begin[i]
                + (cube - 2.0 * square + t) * step * slope(at, i)
                + (3.0 * square - 2.0 * cube) * end[i]
                + (cube - square) * step * slope(at + 1, i)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(times: &[f64]) -> CameraPath {
        let key = |time: &f64| CameraKey {
            time: *time,
            eye: DVec3::new(time * time, 0.0, 5.0),
            look_at: DVec3::new(time * time, 0.0, 0.0),
            up: 3.0 * DVec3::Y,
            fov: None,
            height: None,
            place: Place::default(),
        };
        CameraPath { pictures: 11, keys: times.iter().map(key).collect() }
    }

    #[test]
    fn the_camera_is_at_each_key_at_its_time_and_goes_smoothly_between() {
        let path = path(&[0.0, 2.0, 5.0, 6.0, 10.0]);
        let at = |picture: u32| path.camera(&Camera::default(), picture).eye.x;
        assert_eq!([0, 2, 5, 6, 10].map(at), [0.0, 4.0, 25.0, 36.0, 100.0]);
        // Between inner keys a parabola is itself.
        assert!((at(3) - 9.0).abs() < 1e-12 && (at(4) - 16.0).abs() < 1e-12, "{} {}", at(3), at(4));
        assert!(at(9) > 64.0 && at(9) < 100.0);
        let camera = path.camera(&Camera::default(), 3);
        assert_eq!((camera.kind, camera.up), (CameraKind::default(), DVec3::Y));
    }

    #[test]
    fn one_picture_is_that_of_the_first_key() {
        let path = CameraPath { pictures: 1, ..path(&[1.0, 2.0]) };
        assert_eq!(path.camera(&Camera::default(), 0).eye.x, 1.0);
    }

    #[test]
    fn angles_stay_between_the_keys_and_fit_the_camera() {
        let mut path = path(&[0.0, 1.0, 2.0, 3.0]);
        for (key, fov) in path.keys.iter_mut().zip([60.0, 60.0, 20.0, 20.0]) {
            key.fov = Some(fov);
        }
        for picture in 0..11 {
            let CameraKind::Perspective { fov } = path.camera(&Camera::default(), picture).kind
            else {
                panic!("in perspective")
            };
            assert!((20.0..=60.0).contains(&fov));
        }
        assert!(path.unfit(&Camera::default()).is_none());
        let kind = CameraKind::Orthographic { height: 2.0 };
        let told = path.unfit(&Camera { kind, ..Camera::default() }).expect("unfit");
        assert!(told.message.contains("`fov` is for a perspective camera"), "{told}");
    }
}
