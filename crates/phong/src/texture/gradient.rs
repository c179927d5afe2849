//! Colours that run into one another along an axis, or from a point outwards.

use glam::DVec3;
use phong_scene::{GradientBy, Rgb};

use super::ramp::Ramp;

#[derive(Clone, Debug)]
pub(super) struct Gradient {
    /// Unit; `None`: by the distance from the origin.
    axis: Option<DVec3>,
    from: f64,
    to: f64,
    ramp: Ramp,
}

impl Gradient {
    /// `axis` may have any length.
    pub(super) fn new(
        (by, axis): (GradientBy, DVec3),
        from: f64,
        to: f64,
        stops: &[(f32, Rgb)],
    ) -> Self {
        let axis = (by == GradientBy::Axis).then(|| axis.normalize_or(DVec3::Y));
        Self { axis, from, to, ramp: Ramp::new(stops) }
    }

    /// Black where there are no stops.
    pub(super) fn value(&self, p: DVec3) -> Rgb {
        let along = self.axis.map_or_else(|| p.length(), |axis| axis.dot(p));
        let t = ((along - self.from) / (self.to - self.from)).clamp(0.0, 1.0) as f32;
        self.ramp.at(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_linearly_between_stops_and_stay_beyond_them() {
        let stops = [(0.25, Rgb::BLACK), (0.5, Rgb::WHITE), (0.5, Rgb::grey(3.0))];
        let gradient =
            Gradient::new((GradientBy::Axis, DVec3::new(0.0, 4.0, 0.0)), 2.0, 6.0, &stops);
        let at = |y: f64| gradient.value(DVec3::new(7.0, y, -3.0)).r;
        for (y, want) in [(-9.0, 0.0), (3.0, 0.0), (3.5, 0.5), (3.75, 0.75), (4.0, 3.0), (9.0, 3.0)]
        {
            assert_eq!(at(y), want, "y = {y}");
        }
        assert_eq!(
            Gradient::new((GradientBy::Axis, DVec3::Y), 0.0, 1.0, &[]).value(DVec3::ZERO),
            Rgb::BLACK
        );
    }

    #[test]
    fn a_gradient_may_run_outwards() {
        let stops = [(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)];
        let gradient = Gradient::new((GradientBy::Radius, DVec3::Y), 0.0, 10.0, &stops);
        assert_eq!(gradient.value(DVec3::new(-3.0, 0.0, 4.0)), Rgb::grey(0.5));
    }

    #[test]
    fn a_gradient_may_run_backwards() {
        let gradient = Gradient::new(
            (GradientBy::Axis, DVec3::Y),
            1.0,
            0.0,
            &[(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)],
        );
        assert_eq!(gradient.value(DVec3::new(0.0, 0.25, 0.0)), Rgb::grey(0.75));
    }
}
