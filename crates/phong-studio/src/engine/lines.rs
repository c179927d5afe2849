//! The vectors and rays of an explanation as they are seen in the picture.

use phong::explain::{End, Explanation, Surface};
use phong::glam::DVec3;
use phong::view::View;

use crate::protocol::Line;

/// How long a unit vector is seen, in heights of the picture, were it across the view.
const LENGTH: f64 = 0.22;

/// Mirror and glass rays are drawn over so many bounces.
const MOST_BOUNCES: usize = 4;

/// The lines of the first sample; none where its ray meets nothing, or the camera looks around.
pub(super) fn of(told: &Explanation, view: &View) -> Vec<Line> {
    let mut lines = Lines { view, size: told.size, seen: Vec::new() };
    let end = told.samples.first().and_then(|sample| sample.ray.as_ref()).map(|ray| &ray.end);
    if let Some(End::Surface(surface)) = end {
        lines.vectors(surface);
        lines.onward(surface, MOST_BOUNCES);
    }
    lines.seen
}

struct Lines<'a> {
    view: &'a View,
    size: [u32; 2],
    seen: Vec<Line>,
}

impl Lines<'_> {
    fn vectors(&mut self, surface: &Surface) {
        let p = surface.p;
        let Some(unit) = self.unit(p) else { return };
        let length = LENGTH * f64::from(self.size[1]) / unit;
        let mut vector = |name, light, v: phong::math::Dir3| {
            let [x, y, z] = v.to_array().map(f64::from);
            self.line(name, light, p, p + length * DVec3::new(x, y, z));
        };
        vector("n", None, surface.n);
        vector("e", None, surface.e);
        for (i, lit) in surface.lights.iter().enumerate() {
            let light = Some(i + 1);
            for (name, v) in [("l", lit.l), ("r", lit.r), ("h", lit.h)] {
                if let Some(v) = v {
                    vector(name, light, v);
                }
            }
        }
        for (i, lit) in surface.lights.iter().enumerate() {
            if let (Some(l), Some(blocker)) = (lit.l, &lit.blocker) {
                let [x, y, z] = l.to_array().map(f64::from);
                let to = p + f64::from(blocker.t) * DVec3::new(x, y, z);
                self.line("shadow", Some(i + 1), p, to);
            }
        }
    }

    /// The rays that go on from a surface, to where they meet another.
    fn onward(&mut self, surface: &Surface, bounces: usize) {
        for (name, onward) in [
            ("mirror", &surface.reflection),
            ("glass", &surface.transmission),
            ("glass", &surface.through),
        ] {
            let ray = onward.as_ref().and_then(|onward| onward.ray.as_ref());
            let Some(ray) = ray.filter(|_| bounces > 0) else { continue };
            match &ray.end {
                End::Surface(met) => {
                    self.line(name, None, surface.p, met.p);
                    self.onward(met, bounces - 1);
                }
                End::Light { t, .. } => {
                    let way = f64::from(*t) * ray.dir.to_vec().as_dvec3();
                    self.line(name, None, surface.p, ray.origin + way);
                }
                End::Background(_) => {
                    let [x, y, z] = ray.dir.to_array().map(f64::from);
                    if let Some(unit) = self.unit(surface.p) {
                        let length = f64::from(self.size[1]) / unit;
                        self.line(name, None, surface.p, surface.p + length * DVec3::new(x, y, z));
                    }
                }
            }
        }
    }

    /// Pixels of a unit across the view at a point.
    fn unit(&self, p: DVec3) -> Option<f64> {
        let camera = self.view.camera();
        let [x, y, z] = camera.up().to_array().map(f64::from);
        // The step is small: a large one may end behind the eye.
        let step = 1e-3 * (p - self.view.look().camera.eye).length().max(1e-9);
        let beside = camera.place(p + step * DVec3::new(x, y, z), self.size)?;
        let unit = (beside - camera.place(p, self.size)?).length() / step;
        (unit > 0.0 && unit.is_finite()).then_some(unit)
    }

    fn line(&mut self, name: &'static str, light: Option<usize>, from: DVec3, to: DVec3) {
        let camera = self.view.camera();
        let (from, to) = (camera.place(from, self.size), camera.place(to, self.size));
        if let (Some(from), Some(to)) = (from, to) {
            self.seen.push(Line { name, light, from: from.to_array(), to: to.to_array() });
        }
    }
}
