//! What is turned about an axis: rings, and the bands between them.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::count::{Size, parts_of_circle, whole};
use crate::color::Rgb;
use crate::mesh::Caps;

/// A ring about the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    /// How far along the axis it is.
    pub(super) along: f64,
    /// Its radius; 0: a point on the axis.
    pub(super) radius: f64,
    pub(super) color: Option<Rgb>,
}

/// What lies between two rings that follow one another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    /// The first of the two; the other is the next.
    pub(super) ring: usize,
    /// The unit normals at both: along the axis, and away from it.
    pub(super) normals: [[f64; 2]; 2],
}

/// Rings from the begin of the axis to its end, in such an order that bands show their outer side.
#[derive(Debug, Default)]
pub(super) struct Profile {
    /// How many corners a ring has.
    pub(super) around: u32,
    pub(super) rings: Vec<Ring>,
    pub(super) bands: Vec<Band>,
    /// Whether a last band leads from the last ring to the first, and its normals.
    pub(super) closing: Option<[[f64; 2]; 2]>,
}

const BACK: [f64; 2] = [-1.0, 0.0];
const FORTH: [f64; 2] = [1.0, 0.0];

impl Profile {
    /// A disc, which shows the side that its axis points to.
    pub(super) fn disc(radius: f64, within: f64) -> Self {
        let mut profile = Self { around: parts_of_circle(radius, within), ..Self::default() };
        profile.ring(0.0, radius, None);
        profile.band(0.0, 0.0, None, [FORTH; 2]);
        profile
    }

    /// A cylinder or a cone; of two colours, a half of each.
    pub(super) fn straight(
        radii: [f64; 2],
        length: f64,
        caps: Caps,
        colors: Option<[Rgb; 2]>,
        within: f64,
    ) -> Self {
        let [first, last] = radii;
        let [begin, end] = halves(colors);
        let around = parts_of_circle(first.max(last), within);
        let mut profile = Self { around, ..Self::default() };
        let steep = ((first - last) * (first - last) + length * length).sqrt();
        let out = [(first - last) / steep, length / steep];
        if caps == Caps::Flat && first > 0.0 {
            profile.ring(0.0, 0.0, begin);
            profile.band(0.0, first, begin, [BACK; 2]);
        } else {
            profile.ring(0.0, first, begin);
        }
        if begin != end {
            let (half, wide) = (0.5 * length, 0.5 * (first + last));
            profile.band(half, wide, begin, [out; 2]);
            profile.ring(half, wide, end);
        }
        profile.band(length, last, end, [out; 2]);
        if caps == Caps::Flat && last > 0.0 {
            profile.band(length, 0.0, end, [FORTH; 2]);
        }
        profile
    }

    /// The surface of a sphere that goes from end to end while its radius changes evenly.
    pub(super) fn capsule(
        radii: [f64; 2],
        length: f64,
        colors: Option<[Rgb; 2]>,
        within: f64,
    ) -> Self {
        let [first, last] = radii;
        let [begin, end] = halves(colors);
        let step = (2.0 * within / first.max(last)).sqrt();
        let around = whole(TAU / step).max(6);
        let mut profile = Self { around, ..Self::default() };
        if length <= (first - last).abs() {
            // One of the balls is within the other.
            let (along, radius, color) =
                if first >= last { (0.0, first, begin) } else { (length, last, end) };
            profile.ring(along - radius, 0.0, color);
            profile.arc(along, radius, [-FRAC_PI_2, FRAC_PI_2], step, color);
            return profile;
        }
        // Where the cone touches the balls.
        let touch = libm::asin((first - last) / length);
        let out = [libm::sin(touch), libm::cos(touch)];
        profile.ring(-first, 0.0, begin);
        profile.arc(0.0, first, [-FRAC_PI_2, touch], step, begin);
        let [low, high] = [first * out[0], length + last * out[0]];
        if begin != end {
            let along = (0.5 * length).min(high).max(low);
            let share = if high > low { (along - low) / (high - low) } else { 0.0 };
            let wide = out[1] * (first + share * (last - first));
            profile.band(along, wide, begin, [out; 2]);
            profile.ring(along, wide, end);
        }
        profile.band(high, last * out[1], end, [out; 2]);
        profile.arc(length, last, [touch, FRAC_PI_2], step, end);
        profile
    }

    /// A torus.
    pub(super) fn torus(radius: f64, tube: f64, within: f64) -> Self {
        let around = whole(TAU / (2.0 * within / (radius + tube)).sqrt()).max(6);
        let parts = whole(TAU / (2.0 * within / tube).sqrt()).max(6);
        let mut profile = Self { around, ..Self::default() };
        let normal = |part: u32| {
            let angle = TAU * f64::from(part % parts) / f64::from(parts);
            [libm::sin(angle), libm::cos(angle)]
        };
        let at = |part: u32| normal(part).map(|n| tube * n);
        profile.ring(at(0)[0], radius + at(0)[1], None);
        for part in 1..parts {
            let [along, wide] = at(part);
            profile.band(along, radius + wide, None, [normal(part - 1), normal(part)]);
        }
        profile.closing = Some([normal(parts - 1), normal(0)]);
        profile
    }

    /// How many corners and triangles it makes.
    pub(super) fn size(&self) -> Size {
        let around = u64::from(self.around);
        let point = |ring: &Ring| ring.radius <= 0.0;
        let corners = self.rings.iter().map(|ring| if point(ring) { 1 } else { around });
        let of = |a: &Ring, b: &Ring| if point(a) || point(b) { around } else { 2 * around };
        let bands =
            self.bands.iter().map(|band| of(&self.rings[band.ring], &self.rings[band.ring + 1]));
        let closing = if self.closing.is_some() { 2 * around } else { 0 };
        Size { vertices: corners.sum(), triangles: bands.sum::<u64>() + closing }
    }

    fn ring(&mut self, along: f64, radius: f64, color: Option<Rgb>) {
        self.rings.push(Ring { along, radius, color });
    }

    /// A band from the last ring to a new one.
    fn band(&mut self, along: f64, radius: f64, color: Option<Rgb>, normals: [[f64; 2]; 2]) {
        self.bands.push(Band { ring: self.rings.len() - 1, normals });
        self.ring(along, radius, color);
    }

    /// Bands along a ball, from the last ring, which is at the first latitude, to the second.
    fn arc(
        &mut self,
        center: f64,
        radius: f64,
        latitudes: [f64; 2],
        step: f64,
        color: Option<Rgb>,
    ) {
        let [from, to] = latitudes;
        let parts = whole((to - from) / step).max(2);
        let normal = |part: u32| {
            let latitude = from + (to - from) * f64::from(part) / f64::from(parts);
            let [sine, cosine] = [libm::sin(latitude), libm::cos(latitude)];
            // At the poles the cosine is only nearly 0.
            if latitude.abs() >= FRAC_PI_2 - 1e-9 { [sine.signum(), 0.0] } else { [sine, cosine] }
        };
        for part in 1..=parts {
            let [along, wide] = normal(part).map(|n| radius * n);
            self.band(center + along, wide, color, [normal(part - 1), normal(part)]);
        }
    }
}

/// The colours of both halves.
fn halves(colors: Option<[Rgb; 2]>) -> [Option<Rgb>; 2] {
    colors.map_or([None; 2], |colors| colors.map(Some))
}
