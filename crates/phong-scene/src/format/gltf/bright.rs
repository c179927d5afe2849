//! Lights in lumens and lux: the format says how bright they are, but not how long a camera looks.

use crate::bounds::{Bounds, bounds_with};
use crate::fragment::Fragment;
use crate::light::{Light, LightKind};

/// How much more light than makes white white may reach the middle of what is drawn.
const MOST: f64 = 10.0;

/// Dims all lights by the same factor, so that white in the middle of the model is white, where they
/// would leave next to nothing of it but white; what they are divided by, where they are.
///
/// Blender writes a sun as 683 times what it shows, and a lamp of 1000 watts as 54,351 candela.
pub(super) fn dim(fragment: &mut Fragment) -> Option<f64> {
    let bounds = bounds_with(&fragment.objects, &fragment.groups);
    if bounds.is_empty() {
        return None;
    }
    let sum: f64 = fragment.lights.iter().map(|light| reaching(light, bounds)).sum();
    if !(sum > MOST && sum.is_finite()) {
        return None;
    }
    for light in &mut fragment.lights {
        light.color *= sum.recip() as f32;
        light.specular_color *= sum.recip() as f32;
    }
    Some(sum)
}

/// What reaches the middle of this box, from a lamp within it as far as half of its half diagonal.
fn reaching(light: &Light, bounds: Bounds) -> f64 {
    let brightest = f64::from(light.color.max_channel());
    match light.kind {
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
            let least = bounds.size().length() / 4.0;
            let distance = position.distance(bounds.center()).max(least).max(1e-9);
            brightest / (distance * distance)
        }
        _ => brightest,
    }
}
